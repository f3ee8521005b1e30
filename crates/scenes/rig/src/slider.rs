use gudgeon_core::kinds::{
    Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dSpec, FilmEnd, FilmFront, FilmTime, PanelFactors,
    Piezoviscosity, PiezoviscositySpec, Rig, RigCtx, RigOut, RigSpec, RoughFlow, RoughShear, Roughness,
    RoughnessSpec, ShearThinning, ShearThinningSpec, named,
};
use gudgeon_core::quantity::{Length, NonNegative, PosViscosity, Pressure, Velocity, quantity};
use gudgeon_core::result::{Column, Note, Series};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_film::film_1d::{LineProfile, ViscosityLoop};
use gudgeon_film::{Isoviscous, Newtonian, SmoothSurfaces};
use serde::{Deserialize, Serialize};

use crate::profile::{self, Profile};
use crate::{along, validity};

/// A steady film along a line: any profile, flooded or starved, smooth or rough.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SliderRig {
    /// Gap along the line.
    pub profile: Profile,
    /// Number of panels that the line is divided into, about.
    #[serde(default = "panels")]
    #[schemars(range(min = 1, max = 100_000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub panels: u32,
    /// Velocity of the plane surface, along `x` positive.
    pub speed: Velocity,
    /// What there is at the beginning of the line.
    pub left: LineEnd,
    /// What there is at the end of the line.
    pub right: LineEnd,
    /// Absolute cavitation pressure.
    #[serde(default = "vacuum")]
    pub p_cav: Pressure,
    /// Absolute ambient pressure, from which the pressure of `piezoviscosity` counts.
    #[serde(default = "ambient")]
    pub p_ambient: Pressure,
    /// Viscosity at ambient pressure and low shear rate.
    pub viscosity: PosViscosity,
    /// Rise of viscosity with pressure.
    #[serde(default = "isoviscous")]
    pub piezoviscosity: Box<dyn PiezoviscositySpec>,
    /// Fall of viscosity with the shear rate of sliding.
    #[serde(default = "newtonian")]
    pub shear_thinning: Box<dyn ShearThinningSpec>,
    /// Flow and shear factors of rough surfaces; the profiled surface is the body, the plane one the liner.
    #[serde(default = "smooth")]
    pub roughness: Box<dyn RoughnessSpec>,
    /// The model.
    pub film_1d: Box<dyn Film1dSpec>,
}

/// What there is at an end of the line.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineEnd {
    /// Absolute pressure.
    pub p: Pressure,
    /// Thickness of the layer of oil that arrives on the plane surface where that enters the gap; a bath of oil when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oil_film: Option<Length<NonNegative>>,
}

impl LineEnd {
    fn end(&self) -> FilmEnd {
        let p = self.p.si();
        match self.oil_film {
            Some(h) => FilmEnd::Starved { p, h_oil: h.si() },
            None => FilmEnd::Flooded { p },
        }
    }
}

fn panels() -> u32 {
    200
}
fn vacuum() -> Pressure {
    quantity(0.0)
}
fn ambient() -> Pressure {
    quantity(1e5)
}
fn isoviscous() -> Box<dyn PiezoviscositySpec> {
    Box::new(Isoviscous {})
}
fn newtonian() -> Box<dyn ShearThinningSpec> {
    Box::new(Newtonian {})
}
fn smooth() -> Box<dyn RoughnessSpec> {
    Box::new(SmoothSurfaces {})
}

#[register_model(
    name = "slider",
    summary = "steady film along a line of any profile: load, friction, flux, pressure and cavities",
    equations = "load = int (p - p_cav) dx;  load_gauge = int p dx - (p_left + p_right) L/2;  centre = int (p - p_cav) x dx/load;  \
                shear = int (mu u/h +- h p'/2) dx;  mu = mu0 f_p(p - p_ambient) f_s(u/h)",
    validity = "Narrow gap, no flow across the line, steady, incompressible, isothermal. Factors of roughness and viscosity are \
               constant in each panel.",
    references = ["reynolds1886"],
    example = "profile = { shape = \"linear\", length = \"1.5 mm\", h_in = \"2 um\", h_out = \"1 um\" }\nspeed = \"12 m/s\"\n\
              left = { p = \"1 bar\" }\nright = { p = \"1 bar\" }\nviscosity = \"8 mPa s\"\n\
              film_1d = { model = \"complementarity\" }\n",
)]
impl RigSpec for SliderRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![
            ("film_1d", self.film_1d.typetag_name()),
            ("roughness", self.roughness.typetag_name()),
            ("piezoviscosity", self.piezoviscosity.typetag_name()),
            ("shear_thinning", self.shear_thinning.typetag_name()),
        ]
    }
    fn same_equations(&self) -> Option<(&'static str, &'static [&'static str])> {
        Some(("film_1d", self.film_1d.same_equations()))
    }
    fn headline(&self) -> &'static [&'static str] {
        &["load", "moving_shear", "flux_in", "p_max"]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        errors.extend(along::cavitation_below(self.p_cav.si(), &[self.left.p.si(), self.right.p.si()]));
        let mut keep = |e: BuildError| errors.push(e);
        let line = profile::panels(self.panels)
            .and_then(|n| self.profile.line(n).map_err(|e| e.within("profile")))
            .map_err(&mut keep)
            .ok();
        let film = line.as_ref().and_then(|l| {
            self.film_1d.build(&Film1dCtx { x: &l.x }).map_err(|e| keep(e.within("film_1d"))).ok()
        });
        let rough = self.roughness.build().map_err(|e| keep(e.within("roughness"))).ok();
        let piezo = self.piezoviscosity.build().map_err(|e| keep(e.within("piezoviscosity"))).ok();
        let thin = self.shear_thinning.build().map_err(|e| keep(e.within("shear_thinning"))).ok();
        // The surface enters the gap at one end; what the other one is given has no meaning.
        let (inlet, place) =
            if self.speed.si() >= 0.0 { (&self.left, "left") } else { (&self.right, "right") };
        if inlet.oil_film.is_some() && !self.film_1d.scope().starved {
            let what =
                format!("`{}` as it is set here knows no inlet that starves", self.film_1d.typetag_name());
            keep(
                BuildError::at(format!("{place}.oil_film"), what)
                    .help("a model that conserves mass does: `complementarity`, `front_tracking`; without `oil_film` there is a bath"),
            );
            return Err(errors);
        }
        match (line, film, rough, piezo, thin) {
            (Some(line), Some(film), Some(rough), Some(piezo), Some(thin)) if errors.is_empty() => {
                Ok(Box::new(Bench {
                    line,
                    film,
                    rough,
                    piezo,
                    thin,
                    u: self.speed.si(),
                    ends: [self.left.end(), self.right.end()],
                    p_cav: self.p_cav.si(),
                    p_ends: 0.5 * (self.left.p.si() + self.right.p.si()),
                    p_ambient: self.p_ambient.si(),
                    mu: self.viscosity.si(),
                }))
            }
            _ => Err(errors),
        }
    }
}

struct Bench {
    line: LineProfile,
    film: Box<dyn Film1d>,
    rough: Box<dyn Roughness>,
    piezo: Box<dyn Piezoviscosity>,
    thin: Box<dyn ShearThinning>,
    u: f64,
    ends: [FilmEnd; 2],
    p_cav: f64,
    /// Mean of the pressures at both ends.
    p_ends: f64,
    p_ambient: f64,
    mu: f64,
}

/// Factors of the panels of a rough line, from the gap in the middle of each.
fn factors(rough: &dyn Roughness, line: &LineProfile) -> Result<Vec<PanelFactors>, EvalError> {
    let h: Vec<f64> = line.h_a.iter().zip(&line.h_b).map(|(a, b)| 0.5 * (a + b)).collect();
    let (mut flow, mut shear) = (RoughFlow::new(h.len()), RoughShear::new(h.len()));
    rough.flow(&h, &mut flow)?;
    rough.shear(&h, &mut shear)?;
    Ok(h.iter()
        .enumerate()
        .map(|(i, h)| {
            let (film, part) = (flow.film[i] / h, shear.film[i] / h);
            PanelFactors {
                pressure_flow: flow.phi_x[i] * film * film * film,
                sliding_flow: flow.transport[i] / h,
                sliding_shear: shear.phi_f[i] / part,
                pressure_shear: shear.phi_fp[i] * part,
                shear_difference: shear.phi_fs[i] / part,
            }
        })
        .collect())
}

/// Viscosities along the line, beside the film and the number of solutions it took.
type Found = (Film1dOut, usize, Option<Vec<f64>>);

impl Bench {
    fn solve(&mut self, factors: Option<&[PanelFactors]>) -> Result<Found, EvalError> {
        let mu = vec![self.mu; self.line.panels()];
        let inp = Film1dIn {
            h_a: &self.line.h_a,
            h_b: &self.line.h_b,
            mu: &mu,
            factors,
            u: self.u,
            ends: self.ends,
            p_cav: self.p_cav,
            time: FilmTime::Steady,
        };
        if self.piezo.is_off() && self.thin.is_off() {
            return Ok((self.film.solve(&inp)?, 1, None));
        }
        let (piezo, thin, mu0, ambient) = (&*self.piezo, &*self.thin, self.mu, self.p_ambient);
        let mut refused = None;
        let mut around = ViscosityLoop::new(mu.len());
        let found = around.solve(&mut *self.film, &inp, |p, rate| {
            let (mut thick, mut less, mut slope) = ([1.0], [1.0], [0.0]);
            let law = piezo
                .factor(mu0, &[p - ambient], &mut thick, &mut slope)
                .and_then(|()| thin.factor(&[rate], &mut less, &mut slope));
            match law {
                Ok(()) => mu0 * thick[0] * less[0],
                Err(e) => {
                    refused.get_or_insert(e);
                    f64::NAN
                }
            }
        });
        let (out, rounds) = match (found, refused) {
            (Ok(found), None) => found,
            (_, Some(e)) | (Err(e), None) => return Err(e),
        };
        Ok((out, rounds, Some(around.viscosity().to_vec())))
    }

    /// Loads, shear forces, centre of pressure.
    fn forces(&self, o: &Film1dOut, out: &mut RigOut) {
        let (first, last) = (self.line.x[0], self.line.x[self.line.panels()]);
        out.result("load", o.load, "N/m", "load above the cavitation pressure, per metre of width");
        let above = |p: f64| o.load + (self.p_cav - p) * (last - first);
        out.result("load_absolute", above(0.0), "N/m", "integral of the absolute pressure");
        let what = "load above the straight line between the pressures at the ends";
        out.result("load_gauge", above(self.p_ends), "N/m", what);
        out.result("p_max", o.p_max / 1e5, "bar", "highest pressure");
        out.result("x_p_max", 1e3 * o.x_p_max, "mm", "place of the highest pressure");
        out.result(
            "moving_shear",
            o.moving_shear,
            "N/m",
            "viscous force on the plane, moving surface, against x positive",
        );
        out.result(
            "fixed_shear",
            o.fixed_shear,
            "N/m",
            "viscous force on the profiled, stationary surface, along x positive",
        );
        out.result(
            "slope_force",
            o.slope_force,
            "N/m",
            "pressure force on slopes and steps of the profiled surface, along x positive",
        );
        if let Some(centre) = o.centre() {
            out.result("centre", 1e3 * centre, "mm", "centre of pressure");
            out.result(
                "friction_coefficient",
                o.moving_shear / o.load,
                "",
                "friction of the moving surface over load",
            );
        }
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&[
            "load",
            "load_absolute",
            "load_gauge",
            "p_max",
            "x_p_max",
            "moving_shear",
            "fixed_shear",
            "slope_force",
            "centre",
            "friction_coefficient",
            "flux_in",
            "flux_out",
            "ruptures",
            "x_rupture",
            "x_reform",
            "starved",
            "flux_error",
            "iterations",
        ])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let factors = if self.rough.is_smooth() { None } else { Some(factors(&*self.rough, &self.line)?) };
        let (o, rounds, mu) = self.solve(factors.as_deref())?;
        let field = self.film.field();
        self.forces(&o, out);
        flows(&o, field.fronts, self.u >= 0.0, out);
        out.counters.insert("panels".into(), self.line.panels() as u64);
        out.counters.insert("iterations".into(), o.iterations as u64);
        out.counters.insert("film_evaluations".into(), rounds as u64);
        out.balance.oil_mass = along::oil_balance(&o);
        if o.starved {
            out.notes.push(Note::caution(
                "starved_inlet",
                "the inlet is starved: less oil arrives than a bath would give",
            ));
        }

        let rows = along::rows(&self.line, &field, self.u, self.p_cav, o.starved, |i| {
            factors.as_ref().map_or(1.0, |f| f[i].sliding_flow)
        });
        series(&rows, field.flux, out);
        if let Some(mu) = mu {
            out.column("mu", "Pa s", rows.iter().map(|r| mu[r.panel]).collect());
            out.curves("Viscosity", "constant in each panel", &[("viscosity", "mu")]);
        }
        if let Some(f) = &factors {
            draw_factors(&rows, f, out);
        }
        if !field.fronts.is_empty() {
            front_table(field.fronts, out);
        }
        validity::note_limits(out);
        along::finite(out, "slider")
    }
}

/// Flow of oil, places where films end and begin; `forwards` along `x`.
fn flows(o: &Film1dOut, fronts: &[FilmFront], forwards: bool, out: &mut RigOut) {
    out.result("flux_in", o.flux_in, "m2/s", "flux of oil at the beginning of the line, along x positive");
    out.result("flux_out", o.flux_out, "m2/s", "flux of oil at the end of the line, along x positive");
    let of = |film_before: bool| fronts.iter().filter(move |f| f.film_before == film_before);
    let first = |film_before: bool| {
        let mut all = of(film_before);
        if forwards { all.next() } else { all.next_back() }
    };
    out.result(
        "ruptures",
        of(forwards).count() as f64,
        "",
        "number of places where a film ends along the sliding",
    );
    if let Some(f) = first(forwards) {
        out.result("x_rupture", 1e3 * f.x, "mm", "place where the film ruptures first along the sliding");
    }
    if let Some(f) = first(!forwards) {
        out.result("x_reform", 1e3 * f.x, "mm", "place where the film forms first along the sliding");
    }
    out.result("starved", f64::from(u8::from(o.starved)), "", "1 when the inlet is not filled");
    out.result(
        "flux_error",
        o.flux_error,
        "",
        "largest imbalance of oil at a node over the flux there: zero when mass is conserved",
    );
    out.result("iterations", o.iterations as f64, "", "passes over the line that the solution took");
}

/// The film as rows of the series.
fn series(rows: &[along::Row], flux: &[f64], out: &mut RigOut) {
    out.axis("x", "m", rows.iter().map(|r| r.x).collect());
    out.column("p", "Pa", rows.iter().map(|r| r.p).collect());
    out.column("h", "m", rows.iter().map(|r| r.h).collect());
    out.column("oil", "m", rows.iter().map(|r| r.fill * r.h).collect());
    out.column("fill", "", rows.iter().map(|r| r.fill).collect());
    out.column("flux", "m2/s", rows.iter().map(|r| flux[r.panel]).collect());
    out.curves("Pressure along the line", "absolute", &[("pressure", "p")]);
    out.curves("Gap and oil in it", "", &[("gap", "h"), ("oil", "oil")]);
    if rows.iter().any(|r| r.fill < 1.0) {
        out.curves("Filled fraction of the gap", "", &[("fill", "fill")]);
    }
}

fn draw_factors(rows: &[along::Row], f: &[PanelFactors], out: &mut RigOut) {
    out.column("phi_p", "", rows.iter().map(|r| f[r.panel].pressure_flow).collect());
    out.column("phi_u", "", rows.iter().map(|r| f[r.panel].sliding_flow).collect());
    out.column("phi_f", "", rows.iter().map(|r| f[r.panel].sliding_shear).collect());
    out.curves(
        "Factors of the rough surfaces",
        "on the flow that pressure drives, on the flow that sliding drives, on the shear of sliding",
        &[("pressure flow", "phi_p"), ("sliding flow", "phi_u"), ("sliding shear", "phi_f")],
    );
}

/// Places of the fronts as a table.
fn front_table(fronts: &[FilmFront], out: &mut RigOut) {
    let column =
        |name: &str, unit: &str, values: Vec<f64>| Column { name: name.into(), unit: unit.into(), values };
    out.tables.insert(
        "fronts".into(),
        Series {
            axis: column("x", "m", fronts.iter().map(|f| f.x).collect()),
            columns: vec![column(
                "film_before",
                "",
                fronts.iter().map(|f| f64::from(u8::from(f.film_before))).collect(),
            )],
        },
    );
}
