use gudgeon_core::kinds::{
    Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dSpec, FilmEnd, FilmFront, FilmTime, Rig, RigCtx, RigOut,
    RigSpec, named,
};
use gudgeon_core::quantity::{
    Angle, AngularSpeed, Fraction, PosLength, PosViscosity, Pressure, Ratio, quantity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_film::film_1d::LineProfile;
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::{along, profile, validity};

/// A long journal bearing at a given eccentricity: the film around the shaft, unrolled.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Journal1dRig {
    /// Radius of the shaft.
    pub radius: PosLength,
    /// Radial clearance.
    pub clearance: PosLength,
    /// Eccentricity over clearance, below 1.
    pub eccentricity: Ratio<Fraction>,
    /// Speed of the shaft; the bearing stands still.
    pub speed: AngularSpeed,
    /// Viscosity.
    pub viscosity: PosViscosity,
    /// Angle of the supply groove from the widest gap, in the direction of positive rotation. The film begins and ends there.
    #[serde(default = "widest")]
    pub groove: Angle,
    /// Absolute pressure in the groove.
    pub p_supply: Pressure,
    /// Absolute cavitation pressure.
    #[serde(default = "vacuum")]
    pub p_cav: Pressure,
    /// Number of panels that the circumference is divided into.
    #[serde(default = "panels")]
    #[schemars(range(min = 1, max = 100_000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub panels: u32,
    /// The model.
    pub film_1d: Box<dyn Film1dSpec>,
}

fn widest() -> Angle {
    quantity(0.0)
}
fn vacuum() -> Pressure {
    quantity(0.0)
}
fn panels() -> u32 {
    720
}

#[register_model(
    name = "journal_1d",
    summary = "long journal bearing at a given eccentricity: load, attitude, friction, pressure and rupture around the shaft",
    equations = "h = c (1 + e cos phi);  W cos(attitude) = -int (p - p_supply) cos(phi) R dphi,  W sin(attitude) = int (p - p_supply) sin(phi) R dphi;  \
                load_number = W c^2/(mu omega R^3);  torque = R int (mu u/h + h p'/2) dx",
    validity = "Length far above the diameter, parallel axes, one axial groove as long as the bearing, steady, isothermal.",
    references = ["reynolds1886"],
    example = "radius = \"25 mm\"\nclearance = \"25 um\"\neccentricity = 0.6\nspeed = \"3000 rpm\"\nviscosity = \"10 mPa s\"\n\
              p_supply = \"1 bar\"\nfilm_1d = { model = \"complementarity\" }\n",
)]
impl RigSpec for Journal1dRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("film_1d", self.film_1d.typetag_name())]
    }
    fn same_equations(&self) -> Option<(&'static str, &'static [&'static str])> {
        Some(("film_1d", self.film_1d.same_equations()))
    }
    fn headline(&self) -> &'static [&'static str] {
        &["load", "attitude", "torque", "p_max"]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        let n = profile::panels(self.panels).map_err(|e| errors.push(e)).ok();
        if self.eccentricity.si() >= 1.0 {
            errors.push(BuildError::at("eccentricity", "must be below 1: at 1 shaft and bearing touch"));
        }
        errors.extend(along::cavitation_below(self.p_cav.si(), &[self.p_supply.si()]));
        let (Some(n), true) = (n, errors.is_empty()) else { return Err(errors) };
        let from = self.groove.si();
        let line = LineProfile::journal(
            self.radius.si(),
            self.clearance.si(),
            self.eccentricity.si(),
            (from, from + std::f64::consts::TAU),
            n,
        )
        .map_err(|e| vec![BuildError { field: String::new(), ..e }])?;
        let film = self.film_1d.build(&Film1dCtx { x: &line.x }).map_err(|e| vec![e.within("film_1d")])?;
        Ok(Box::new(Bench {
            line,
            film,
            radius: self.radius.si(),
            clearance: self.clearance.si(),
            omega: self.speed.si(),
            mu: self.viscosity.si(),
            p: self.p_supply.si(),
            p_cav: self.p_cav.si(),
        }))
    }
}

struct Bench {
    line: LineProfile,
    film: Box<dyn Film1d>,
    radius: f64,
    clearance: f64,
    omega: f64,
    mu: f64,
    p: f64,
    p_cav: f64,
}

/// Places and weights of Gauss's rule of four points between 0 and 1.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Bench {
    /// Components of `∫ (p - p_0) R e(φ) dφ` along the widest gap and a quarter turn on. Between two rows of full film the pressure
    /// is the cubic with their pressures and the gradients that the flux leaves there.
    fn load(&self, rows: &[along::Row], flux: &[f64]) -> (f64, f64) {
        let u = self.speed();
        let (mut a, mut b) = (0.0, 0.0);
        for w in rows.windows(2) {
            let (from, to) = (w[0], w[1]);
            let dx = to.x - from.x;
            if from.panel != to.panel || dx <= 0.0 {
                continue;
            }
            let straight = to.p - from.p;
            let slope = |r: along::Row| {
                let h = r.h;
                if r.film {
                    12.0 * self.mu * (0.5 * u * h - flux[r.panel]) / (h * h * h) * dx
                } else {
                    straight
                }
            };
            let (rise_a, rise_b) = (slope(from) - straight, slope(to) - straight);
            for (t, weight) in GAUSS {
                let bend = t * (1.0 - t) * ((1.0 - t) * rise_a - t * rise_b);
                let p = from.p + t * straight + bend - self.p;
                let (sin, cos) = elementary::sin_cos((from.x + t * dx) / self.radius);
                a += weight * dx * p * cos;
                b += weight * dx * p * sin;
            }
        }
        (a, b)
    }

    /// Velocity of the surface of the shaft \[m/s\].
    fn speed(&self) -> f64 {
        self.omega * self.radius
    }

    /// Angle from the widest gap \[deg\] of a place on the line.
    fn degrees(&self, x: f64) -> f64 {
        (x / self.radius).to_degrees()
    }

    fn solve(&mut self) -> Result<Film1dOut, EvalError> {
        let mu = vec![self.mu; self.line.panels()];
        let u = self.speed();
        self.film.solve(&Film1dIn {
            h_a: &self.line.h_a,
            h_b: &self.line.h_b,
            mu: &mu,
            factors: None,
            u,
            ends: [FilmEnd::Flooded { p: self.p }; 2],
            p_cav: self.p_cav,
            time: FilmTime::Steady,
        })
    }

    fn load_and_friction(&self, o: &Film1dOut, rows: &[along::Row], flux: &[f64], out: &mut RigOut) {
        let u = self.speed();
        let (along_gap, across) = self.load(rows, flux);
        let load = elementary::hypot(along_gap, across);
        let unit = self.mu * self.omega.abs() * (self.radius / self.clearance).powi(2) * self.radius;
        out.result("load", load, "N/m", "load per metre of width");
        if unit > 0.0 {
            out.result("load_number", load / unit, "", "load over mu omega R^3/c^2");
        }
        if load > 0.0 {
            // The shaft moves towards the narrowest gap; the load points where the film presses.
            out.result(
                "attitude",
                elementary::atan2(across * u.signum(), -along_gap).to_degrees(),
                "deg",
                "angle from the line of centres back to the load, against the rotation",
            );
        }
        out.result("p_max", o.p_max / 1e5, "bar", "highest pressure");
        out.result("phi_p_max", self.degrees(o.x_p_max), "deg", "its angle from the widest gap");
        out.result(
            "torque",
            o.moving_shear * self.radius,
            "N",
            "friction torque on the shaft, per metre of width",
        );
        if unit > 0.0 {
            let full = self.mu * u * self.radius * self.radius / self.clearance;
            out.result(
                "torque_number",
                o.moving_shear * self.radius / full,
                "",
                "torque over mu omega R^3/c",
            );
        }
        if load > 0.0 {
            out.result("friction_coefficient", o.moving_shear / load, "", "friction of the shaft over load");
        }
    }

    /// Oil that passes, places where the film ends and begins.
    fn flows(&self, o: &Film1dOut, fronts: &[FilmFront], out: &mut RigOut) {
        out.result("flux", o.flux_in, "m2/s", "flux of oil into the film behind the groove");
        let forwards = self.speed() >= 0.0;
        let front = |film_before: bool| fronts.iter().find(|f| f.film_before == film_before);
        if let Some(f) = front(forwards) {
            out.result(
                "phi_rupture",
                self.degrees(f.x),
                "deg",
                "angle from the widest gap where the film ruptures",
            );
        }
        if let Some(f) = front(!forwards) {
            out.result(
                "phi_reform",
                self.degrees(f.x),
                "deg",
                "angle from the widest gap where the film forms again",
            );
        }
        out.result(
            "flux_error",
            o.flux_error,
            "",
            "largest imbalance of oil at a node over the flux there: zero when mass is conserved",
        );
    }

    fn series(&self, rows: &[along::Row], out: &mut RigOut) {
        out.axis("phi", "deg", rows.iter().map(|r| self.degrees(r.x)).collect());
        out.column("p", "Pa", rows.iter().map(|r| r.p).collect());
        out.column("h", "m", rows.iter().map(|r| r.h).collect());
        out.column("oil", "m", rows.iter().map(|r| r.fill * r.h).collect());
        out.column("fill", "", rows.iter().map(|r| r.fill).collect());
        out.curves("Pressure around the shaft", "absolute; angle from the widest gap", &[("pressure", "p")]);
        out.curves("Gap and oil in it", "", &[("gap", "h"), ("oil", "oil")]);
        if rows.iter().any(|r| r.fill < 1.0) {
            out.curves("Filled fraction of the gap", "", &[("fill", "fill")]);
        }
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&[
            "load",
            "load_number",
            "attitude",
            "p_max",
            "phi_p_max",
            "torque",
            "torque_number",
            "friction_coefficient",
            "flux",
            "phi_rupture",
            "phi_reform",
            "flux_error",
        ])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let o = self.solve()?;
        let field = self.film.field();
        let rows = along::rows(&self.line, &field, self.speed(), self.p_cav, false, |_| 1.0);
        self.load_and_friction(&o, &rows, field.flux, out);
        self.flows(&o, field.fronts, out);
        out.counters.insert("panels".into(), self.line.panels() as u64);
        out.counters.insert("iterations".into(), o.iterations as u64);
        out.balance.oil_mass = along::oil_balance(&o);
        self.series(&rows, out);
        validity::note_limits(out);
        along::finite(out, "journal_1d")
    }
}
