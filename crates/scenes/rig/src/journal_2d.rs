use std::f64::consts::PI;

use gudgeon_core::kinds::{Film2dGrid, Film2dSpec, Rig, RigCtx, RigOut, RigSpec, RoughnessSpec, named};
use gudgeon_core::quantity::{PosAngularSpeed, PosLength, PosRatio, PosViscosity, Pressure, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_film::SmoothSurfaces;
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::along;
use crate::sheet::{self, Conditions, Sheet, SheetFilm};
use crate::slider_2d::Sides;
use crate::validity;

/// A journal bearing of finite width at a given eccentricity.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Journal2dRig {
    /// Radius of the journal.
    pub radius: PosLength,
    /// Width of the bearing.
    pub width: PosLength,
    /// Radial clearance.
    pub clearance: PosLength,
    /// Eccentricity over clearance, below 1.
    pub eccentricity: PosRatio,
    /// Speed of the journal.
    pub speed: PosAngularSpeed,
    /// Viscosity.
    pub viscosity: PosViscosity,
    /// How oil comes in.
    #[serde(default)]
    pub supply: JournalSupply,
    /// Absolute pressure of the supply groove.
    #[serde(default = "vacuum")]
    pub p_supply: Pressure,
    /// Absolute pressure at both sides.
    #[serde(default = "vacuum")]
    pub p_side: Pressure,
    /// What the sides are.
    #[serde(default)]
    pub sides: Sides,
    /// Absolute cavitation pressure.
    #[serde(default = "vacuum")]
    pub p_cav: Pressure,
    /// Number of intervals between nodes round the journal.
    #[serde(default = "around")]
    #[schemars(range(min = 3, max = 2000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub intervals_x: u32,
    /// Number of intervals across. With an even number, one half of the film is solved.
    #[serde(default = "across")]
    #[schemars(range(min = 2, max = 2000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub intervals_y: u32,
    /// Flow and shear factors of rough surfaces; the bearing is the body, the journal the liner.
    #[serde(default = "smooth")]
    pub roughness: Box<dyn RoughnessSpec>,
    /// The model.
    pub film_2d: Box<dyn Film2dSpec>,
}

/// Where a journal bearing gets its oil.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JournalSupply {
    /// From a groove along the widest gap, which keeps that line full at `p_supply`.
    #[default]
    WidestGap,
    /// From the sides alone: the film closes on itself.
    Sides,
}

fn vacuum() -> Pressure {
    quantity(0.0)
}
fn around() -> u32 {
    180
}
fn across() -> u32 {
    40
}
fn smooth() -> Box<dyn RoughnessSpec> {
    Box::new(SmoothSurfaces {})
}

#[register_model(
    name = "journal_2d",
    summary = "journal bearing of finite width: load, attitude, Sommerfeld number, friction and side flow over the eccentricity",
    equations = "h = c (1 + eps cos phi), phi from the widest gap in the direction of rotation;  W = (sum p cos phi dA, sum p sin phi dA);  \
                S = mu N L D/|W| (R/c)^2;  attitude = atan2(W_sin, -W_cos);  friction_number = T/(|W| c);  side_flow_number = Q_s/(R c N L)",
    validity = "Axes parallel, steady, c much smaller than R. The places where the film ends fall on nodes.",
    references = ["reynolds1886"],
    example = "radius = \"25 mm\"\nwidth = \"50 mm\"\nclearance = \"25 um\"\neccentricity = 0.6\nspeed = \"3000 rpm\"\nviscosity = \"10 mPa s\"\n\
              film_2d = { model = \"multigrid\" }\n",
)]
impl RigSpec for Journal2dRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("film_2d", self.film_2d.typetag_name()), ("roughness", self.roughness.typetag_name())]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        if self.eccentricity.si() >= 1.0 {
            let what = format!("must be below 1, not {}: the surfaces touch", self.eccentricity.si());
            errors.push(BuildError::at("eccentricity", what));
        }
        if self.supply == JournalSupply::Sides && self.sides == Sides::Closed {
            errors.push(BuildError::at("supply", "nothing gives the film a pressure: its sides are closed"));
        }
        if self.supply == JournalSupply::Sides && self.p_supply.si() != 0.0 {
            errors.push(BuildError::at("p_supply", "there is no groove that could have this pressure"));
        }
        let groove = self.supply == JournalSupply::WidestGap;
        let edges = [if groove { self.p_supply.si() } else { self.p_side.si() }, self.p_side.si()];
        let own = if self.sides == Sides::Closed { &edges[..1] } else { &edges[..] };
        errors.extend(along::cavitation_below(self.p_cav.si(), own));
        let nx = sheet::intervals("intervals_x", self.intervals_x);
        let ny = sheet::intervals("intervals_y", self.intervals_y);
        match (nx, ny) {
            (Ok(nx), Ok(ny)) if errors.is_empty() => {
                let (turn, width) = (2.0 * PI * self.radius.si(), self.width.si());
                let mut grid = match self.supply {
                    JournalSupply::WidestGap => Film2dGrid::uniform(nx + 1, ny + 1, turn, width),
                    JournalSupply::Sides => Film2dGrid::journal(nx, ny + 1, turn, width),
                };
                if self.sides == Sides::Closed {
                    grid.edges[2..].fill(gudgeon_core::kinds::Edge::Wall);
                }
                let sheet = Sheet::new(grid, true, &*self.film_2d, &*self.roughness)?;
                Ok(Box::new(Bench { sheet, spec: self.clone() }))
            }
            (nx, ny) => {
                errors.extend(nx.err().into_iter().chain(ny.err()));
                Err(errors)
            }
        }
    }
}

/// Load, in `mu omega L R^3/c^2`, below which a film carries nothing but the rounding of its pressures.
const NOTHING: f64 = 1e-9;

struct Bench {
    sheet: Sheet,
    spec: Journal2dRig,
}

impl Bench {
    fn solve(&mut self) -> Result<SheetFilm, EvalError> {
        let s = &self.spec;
        let (radius, clearance, eps) = (s.radius.si(), s.clearance.si(), s.eccentricity.si());
        let (side, supply, p_cav) = (s.p_side.si(), s.p_supply.si(), s.p_cav.si());
        let gap = |x: f64, _: f64| clearance * (1.0 + eps * elementary::cos(x / radius));
        self.sheet.solve(
            &Conditions {
                u: s.speed.si() * radius,
                mu: s.viscosity.si(),
                p_cav,
                edge_pressure: [supply, supply, side, side],
                edge_fill: [1.0; 4],
                between: true,
            },
            &gap,
            None,
        )
    }

    /// Load with its attitude, and friction.
    ///
    /// # Errors
    /// A bearing that carries nothing (Fatal).
    fn load_and_friction(&self, found: &SheetFilm, out: &mut RigOut) -> Result<(), EvalError> {
        let (s, o) = (&self.spec, &found.out);
        let (radius, width, clearance) = (s.radius.si(), s.width.si(), s.clearance.si());
        let eps = s.eccentricity.si();
        let along = self.sheet.sum(|k, x, _| found.p[k] * elementary::cos(x / radius));
        let across = self.sheet.sum(|k, x, _| found.p[k] * elementary::sin(x / radius));
        let load = elementary::hypot(along, across);
        let scale = s.viscosity.si() * s.speed.si() * width * radius.powi(3) / clearance.powi(2);
        if load < NOTHING * scale {
            return Err(EvalError::fatal(
                "journal_2d",
                format!(
                    "the bearing runs empty: its film carries {load:.1e} N where a full one carries some {scale:.1e} N, for nothing gives back what it loses over its sides. Sides at the cavitation pressure give no oil; raise `p_side` above `p_cav`, or use `supply = \"widest_gap\"`"
                ),
            ));
        }
        let per_second = s.speed.si() / (2.0 * PI);
        let sommerfeld =
            s.viscosity.si() * per_second * width * 2.0 * radius / load * (radius / clearance).powi(2);
        out.result("load", load, "N", "load");
        out.result("sommerfeld", sommerfeld, "", "Sommerfeld number S = mu N L D/W (R/c)^2");
        out.result(
            "attitude",
            elementary::atan2(across, -along).to_degrees(),
            "deg",
            "attitude angle, from the load to the line of centres",
        );
        out.result("p_max", o.p_max / 1e5, "bar", "highest pressure");
        let mean = load / (2.0 * radius * width);
        out.result("p_ratio", mean / o.p_max, "", "load per projected area over the highest pressure");
        out.result("film_min", 1e6 * clearance * (1.0 - eps), "um", "smallest gap");
        out.result("friction", o.shear_lower, "N", "viscous force on the journal, against its rotation");
        out.result(
            "friction_number",
            o.shear_lower * radius / (load * clearance),
            "",
            "coefficient of friction times R/c",
        );
        Ok(())
    }

    /// Oil that passes, area that is not filled.
    fn flows(&self, found: &SheetFilm, out: &mut RigOut) {
        let (s, o) = (&self.spec, &found.out);
        let (radius, width, clearance) = (s.radius.si(), s.width.si(), s.clearance.si());
        let per_second = s.speed.si() / (2.0 * PI);
        let leak = o.outflow[2] + o.outflow[3];
        let unit = radius * clearance * per_second * width;
        out.result("side_flow", 6e4 * leak, "l/min", "oil that leaves at both sides");
        out.result("side_flow_number", leak / unit, "", "side flow over R c N L");
        let inflow = if s.supply == JournalSupply::WidestGap { -o.outflow[0] } else { 0.0 };
        out.result("inflow_number", inflow / unit, "", "flow past the widest gap over R c N L");
        let area = 2.0 * PI * radius * width;
        out.result("cavity", 100.0 * o.cavity / area, "%", "share of the area that is not filled");
    }

    fn draw(&self, found: &SheetFilm, out: &mut RigOut) {
        let (radius, grid) = (self.spec.radius.si(), &self.sheet.whole);
        let degrees = |x: f64| (x / radius).to_degrees();
        out.axis("angle", "deg", grid.x.iter().map(|x| degrees(*x)).collect());
        out.column("p", "Pa", self.sheet.middle(&found.p));
        out.column("h", "m", self.sheet.middle(&found.h));
        out.column("fill", "", self.sheet.middle(&found.fill));
        let hint = "absolute; from the widest gap in the direction of rotation";
        out.curves("Pressure along the middle", hint, &[("pressure", "p")]);
        let (xs, ys) = (sheet::drawn(grid.x.len()), sheet::drawn(grid.y.len()));
        let pick = |f: &[f64]| -> Vec<f64> {
            ys.iter().flat_map(|j| xs.iter().map(move |i| f[j * grid.x.len() + i])).collect()
        };
        let mut maps = vec![("p", "Pa", "Pressure", pick(&found.p))];
        if found.fill.iter().any(|f| *f < 1.0) {
            maps.push(("fill", "", "Filling", pick(&found.fill)));
        }
        out.maps(
            "film",
            ("angle", "deg", xs.iter().map(|i| degrees(grid.x[*i])).collect()),
            ("y", "m", ys.iter().map(|j| grid.y[*j]).collect()),
            maps,
        );
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&[
            "load",
            "sommerfeld",
            "attitude",
            "p_max",
            "p_ratio",
            "film_min",
            "friction",
            "friction_number",
            "side_flow",
            "side_flow_number",
            "inflow_number",
            "cavity",
            "residual",
        ])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let found = self.solve()?;
        self.load_and_friction(&found, out)?;
        self.flows(&found, out);
        sheet::account(&found.out, self.sheet.nodes(), out);
        self.draw(&found, out);
        validity::note_limits(out);
        sheet::finite("journal_2d", out)
    }
}
