use gudgeon_core::kinds::{Edge, Film2dGrid, Film2dSpec, Rig, RigCtx, RigOut, RigSpec, RoughnessSpec, named};
use gudgeon_core::quantity::{
    Fraction, Length, NonNegative, PosLength, PosViscosity, Pressure, Ratio, Velocity, quantity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_film::SmoothSurfaces;
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::along;
use crate::sheet::{self, Conditions, Sheet, SheetFilm};
use crate::validity;

/// A rectangular pad above a plane that slides along its length: any profile, with or without dimples, smooth or rough, squeezed or not.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slider2dRig {
    /// Length of the pad, along the motion.
    pub length: PosLength,
    /// Width of the pad, across the motion.
    pub width: PosLength,
    /// Gap along the motion.
    pub profile: PadProfile,
    /// Dimples in the pad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dimples: Option<Dimples>,
    /// Velocity of the plane, from the beginning of the profile to its end positive.
    #[serde(default = "still")]
    pub speed: Velocity,
    /// Squeeze velocity, opening positive.
    #[serde(default = "still")]
    pub squeeze: Velocity,
    /// Viscosity.
    pub viscosity: PosViscosity,
    /// Absolute pressure at the beginning of the profile.
    #[serde(default = "vacuum")]
    pub p_inlet: Pressure,
    /// Absolute pressure at the end of the profile.
    #[serde(default = "vacuum")]
    pub p_outlet: Pressure,
    /// Absolute pressure at both sides.
    #[serde(default = "vacuum")]
    pub p_side: Pressure,
    /// What the sides are.
    #[serde(default)]
    pub sides: Sides,
    /// Absolute cavitation pressure.
    #[serde(default = "vacuum")]
    pub p_cav: Pressure,
    /// Filling of the gap at the inlet: below 1 it is starved. Only where `p_inlet` is `p_cav`, and for a mass-conserving film.
    #[serde(default = "full")]
    pub inlet_fill: Ratio<Fraction>,
    /// Number of intervals between nodes along the motion.
    #[serde(default = "sixty_four")]
    #[schemars(range(min = 2, max = 2000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub intervals_x: u32,
    /// Number of intervals across; as many as along when absent. With an even number, one half of the film is solved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 2000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub intervals_y: Option<u32>,
    /// What is known of the gap between the nodes.
    #[serde(default)]
    pub between_nodes: BetweenNodes,
    /// Flow and shear factors of rough surfaces; the pad is the body, the plane the liner.
    #[serde(default = "smooth")]
    pub roughness: Box<dyn RoughnessSpec>,
    /// The model.
    pub film_2d: Box<dyn Film2dSpec>,
}

/// Gap between pad and plane along the motion.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(tag = "shape", rename_all = "snake_case", deny_unknown_fields)]
pub enum PadProfile {
    /// Straight from `h_in` to `h_out`.
    Linear {
        /// Gap at the beginning.
        h_in: PosLength,
        /// Gap at the end.
        h_out: PosLength,
    },
    /// `h_in (h_out/h_in)^(x/length)`.
    Exponential {
        /// Gap at the beginning.
        h_in: PosLength,
        /// Gap at the end.
        h_out: PosLength,
    },
    /// `h_in`, from the step on `h_out`. A node on the step has the mean of both.
    Step {
        /// Gap before the step.
        h_in: PosLength,
        /// Gap behind the step.
        h_out: PosLength,
        /// Where the step is, as a part of the length.
        step: Ratio<Fraction>,
    },
    /// Barrel, `film + drop (2 x/length - 1)²`.
    Parabola {
        /// Smallest gap.
        film: PosLength,
        /// Drop at both ends.
        drop: Length<NonNegative>,
    },
}

/// Rectangular dimples in rows of equal pitch.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dimples {
    /// Number of dimples along the motion.
    #[schemars(range(min = 1, max = 1000))]
    pub along: u32,
    /// Number of dimples across.
    #[schemars(range(min = 1, max = 1000))]
    pub across: u32,
    /// Depth below the surface around them.
    pub depth: Length<NonNegative>,
    /// Part of its pitch that a dimple covers, along as across. A node on the edge of a dimple has half its depth.
    pub fraction: Ratio<Fraction>,
    /// Width of a rim round all of them, outside the first and the last pitch.
    #[serde(default = "nothing")]
    pub rim: Length<NonNegative>,
}

/// Sides of a pad.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sides {
    /// Oil leaves there against `p_side`.
    #[default]
    Open,
    /// No flow across: the pad is a strip of an infinitely wide one.
    Closed,
}

/// The gap between nodes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BetweenNodes {
    /// That of the profile.
    #[default]
    Profile,
    /// What the model makes of the gaps at the nodes, as in programs that know no other.
    Nodes,
}

fn still() -> Velocity {
    quantity(0.0)
}
fn vacuum() -> Pressure {
    quantity(0.0)
}
fn full() -> Ratio<Fraction> {
    quantity(1.0)
}
fn nothing() -> Length<NonNegative> {
    quantity(0.0)
}
fn sixty_four() -> u32 {
    64
}
fn smooth() -> Box<dyn RoughnessSpec> {
    Box::new(SmoothSurfaces {})
}

impl PadProfile {
    /// Gap \[m\] at `s`, the part of the length that lies before.
    fn gap(&self, s: f64) -> f64 {
        match self {
            Self::Linear { h_in, h_out } => h_in.si() + (h_out.si() - h_in.si()) * s,
            Self::Exponential { h_in, h_out } => h_in.si() * elementary::powf(h_out.si() / h_in.si(), s),
            Self::Step { h_in, h_out, step } => {
                let behind = past(s - step.si());
                h_in.si() + (h_out.si() - h_in.si()) * behind
            }
            Self::Parabola { film, drop } => film.si() + drop.si() * (2.0 * s - 1.0).powi(2),
        }
    }
}

/// 0 before an edge, 1 behind it, ½ on it. Places of nodes and edges are rounded each in its own way.
fn past(d: f64) -> f64 {
    const ON: f64 = 1e-9;
    if d > ON {
        1.0
    } else if d < -ON {
        0.0
    } else {
        0.5
    }
}

impl Dimples {
    fn check(&self, length: f64, width: f64) -> Vec<BuildError> {
        let mut errors = Vec::new();
        for (field, n) in [("along", self.along), ("across", self.across)] {
            if !(1..=1000).contains(&n) {
                errors.push(BuildError::at(field, format!("must be between 1 and 1000, not {n}")));
            }
        }
        if 2.0 * self.rim.si() >= length.min(width) {
            errors.push(BuildError::at("rim", "the rim leaves no room for dimples"));
        }
        errors
    }

    /// Depth \[m\] at a place of the pad.
    fn depth(&self, x: f64, y: f64, length: f64, width: f64) -> f64 {
        let inside = |v: f64, l: f64, n: u32| {
            let pitches = (v - self.rim.si()) / (l - 2.0 * self.rim.si()) * f64::from(n);
            let own = pitches.floor().clamp(0.0, f64::from(n - 1));
            past(0.5 * self.fraction.si() - (pitches - own - 0.5).abs())
        };
        let both = [inside(x, length, self.along), inside(y, width, self.across)];
        self.depth.si() * both[0].min(both[1])
    }
}

#[register_model(
    name = "slider_2d",
    summary = "film of a rectangular pad along and across the motion: load, friction, side flow, pressure and cavities",
    equations = "load = int (p - p_cav) dA;  load_gauge = int (p - p_side) dA;  load_nodes = sum (p - p_cav) dx dy;  centre = int (p - p_cav) x dA/load;  \
                shear = int (theta mu u/h (phi_f +- phi_fs) +- phi_fp h/2 dp/dx) dA",
    validity = "One instant; the film has no history. A step or the edge of a dimple is best on a node or halfway between two.",
    references = ["reynolds1886"],
    example = "length = \"80 mm\"\nwidth = \"80 mm\"\nprofile = { shape = \"linear\", h_in = \"30 um\", h_out = \"15 um\" }\nspeed = \"5 m/s\"\n\
              viscosity = \"30 mPa s\"\nfilm_2d = { model = \"multigrid\" }\n",
)]
impl RigSpec for Slider2dRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("film_2d", self.film_2d.typetag_name()), ("roughness", self.roughness.typetag_name())]
    }
    fn headline(&self) -> &'static [&'static str] {
        &["load_gauge", "p_max", "plane_shear", "inflow"]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        let (length, width) = (self.length.si(), self.width.si());
        if let Some(d) = &self.dimples {
            errors.extend(d.check(length, width).into_iter().map(|e| e.within("dimples")));
        }
        let sides = if self.sides == Sides::Closed { self.p_inlet.si() } else { self.p_side.si() };
        let edges = [self.p_inlet.si(), self.p_outlet.si(), sides];
        errors.extend(along::cavitation_below(self.p_cav.si(), &edges));
        if self.inlet_fill.si() < 1.0 && self.p_inlet.si() > self.p_cav.si() {
            errors.push(BuildError::at("inlet_fill", "a gap at a pressure above `p_cav` is full"));
        }
        let nx = sheet::intervals("intervals_x", self.intervals_x);
        let ny = sheet::intervals("intervals_y", self.intervals_y.unwrap_or(self.intervals_x));
        match (nx, ny) {
            (Ok(nx), Ok(ny)) => {
                let mut grid = Film2dGrid::uniform(nx + 1, ny + 1, length, width);
                if self.sides == Sides::Closed {
                    grid.edges[2..].fill(Edge::Wall);
                }
                // The profile knows nothing of y, dimples lie in rows: always its own mirror image.
                match Sheet::new(grid, true, &*self.film_2d, &*self.roughness) {
                    Ok(sheet) if errors.is_empty() => {
                        return Ok(Box::new(Bench { sheet, spec: self.clone() }));
                    }
                    Ok(_) => {}
                    Err(e) => errors.extend(e),
                }
            }
            (nx, ny) => errors.extend(nx.err().into_iter().chain(ny.err())),
        }
        Err(errors)
    }
}

struct Bench {
    sheet: Sheet,
    spec: Slider2dRig,
}

impl Bench {
    fn solve(&mut self) -> Result<SheetFilm, EvalError> {
        let spec = &self.spec;
        let (length, width) = (spec.length.si(), spec.width.si());
        let gap = |x: f64, y: f64| {
            let dimple = spec.dimples.as_ref().map_or(0.0, |d| d.depth(x, y, length, width));
            spec.profile.gap(x / length) + dimple
        };
        let squeeze = spec.squeeze.si();
        let rate = |_: f64, _: f64| squeeze;
        let side = spec.p_side.si();
        self.sheet.solve(
            &Conditions {
                u: spec.speed.si(),
                mu: spec.viscosity.si(),
                p_cav: spec.p_cav.si(),
                edge_pressure: [spec.p_inlet.si(), spec.p_outlet.si(), side, side],
                edge_fill: [spec.inlet_fill.si(), 1.0, 1.0, 1.0],
                between: spec.between_nodes == BetweenNodes::Profile,
            },
            &gap,
            if squeeze == 0.0 { None } else { Some(&rate) },
        )
    }

    /// Load, forces and flows.
    fn integrals(&self, found: &SheetFilm, out: &mut RigOut) {
        let (spec, o) = (&self.spec, &found.out);
        let (length, area) = (spec.length.si(), spec.length.si() * spec.width.si());
        out.result("load", o.load, "N", "load above the cavitation pressure");
        let around = match spec.sides {
            Sides::Closed => 0.5 * (spec.p_inlet.si() + spec.p_outlet.si()),
            _ => spec.p_side.si(),
        };
        let gauge = o.load + (spec.p_cav.si() - around) * area;
        let what = "load above the pressure at the sides; where they are closed, above the mean of both ends";
        out.result("load_gauge", gauge, "N", what);
        let sum = self.sheet.sum(|k, _, _| found.p[k] - spec.p_cav.si());
        out.result(
            "load_nodes",
            sum,
            "N",
            "load above the cavitation pressure, every node with the area of its control volume",
        );
        let centre = if o.load == 0.0 { 0.5 * length } else { o.moment_x / o.load };
        out.result("centre", 1e3 * centre, "mm", "centre of pressure behind the inlet");
        out.result("p_max", o.p_max / 1e5, "bar", "highest pressure");
        let thinnest = found.h.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        out.result("film_min", 1e6 * thinnest, "um", "smallest gap");
        out.result(
            "plane_shear",
            o.shear_lower,
            "N",
            "viscous force on the plane, against its motion along x positive",
        );
        out.result("pad_shear", o.shear_upper, "N", "viscous force on the pad, along x positive");
        out.result("cavity", 100.0 * o.cavity / area, "%", "share of the area that is not filled");
        out.result("fill_min", lowest_fill(found), "", "lowest filling");
        out.result("inflow", -6e4 * o.outflow[0], "l/min", "oil that enters at the inlet");
        out.result(
            "side_flow",
            6e4 * (o.outflow[2] + o.outflow[3]),
            "l/min",
            "oil that leaves at both sides",
        );
    }

    /// The film along one line: the middle, or where the pressure is highest between rows of dimples.
    fn line(&self, found: &SheetFilm, out: &mut RigOut) {
        let (spec, grid) = (&self.spec, &self.sheet.whole);
        out.axis("x", "m", grid.x.clone());
        // Between rows of dimples the middle shows little.
        let top = self.sheet.through_top(&found.p);
        let line = |f: &[f64]| match spec.dimples {
            Some(_) => f[top * grid.x.len()..(top + 1) * grid.x.len()].to_vec(),
            None => self.sheet.middle(f),
        };
        out.column("p", "Pa", line(&found.p));
        out.column("h", "m", line(&found.h));
        out.column("fill", "", line(&found.fill));
        let hint = match spec.dimples {
            Some(_) => format!(
                "absolute; on the line with the highest pressure, {:.3} mm from a side",
                1e3 * grid.y[top]
            ),
            None => "absolute; halfway between the sides".to_owned(),
        };
        out.curves("Pressure along the motion", &hint, &[("pressure", "p")]);
        out.curves("Gap along the motion", "on the same line", &[("gap", "h")]);
    }

    /// Maps of the whole film.
    fn maps(&self, found: &SheetFilm, out: &mut RigOut) {
        let grid = &self.sheet.whole;
        let (xs, ys) = (sheet::drawn(grid.x.len()), sheet::drawn(grid.y.len()));
        let pick = |f: &[f64]| -> Vec<f64> {
            ys.iter().flat_map(|j| xs.iter().map(move |i| f[j * grid.x.len() + i])).collect()
        };
        let mut maps = vec![("p", "Pa", "Pressure", pick(&found.p))];
        if self.spec.dimples.is_some() {
            maps.push(("h", "m", "Gap", pick(&found.h)));
        }
        if lowest_fill(found) < 1.0 {
            maps.push(("fill", "", "Filling", pick(&found.fill)));
        }
        out.maps(
            "film",
            ("x", "m", xs.iter().map(|i| grid.x[*i]).collect()),
            ("y", "m", ys.iter().map(|j| grid.y[*j]).collect()),
            maps,
        );
    }
}

fn lowest_fill(found: &SheetFilm) -> f64 {
    found.fill.iter().fold(1.0_f64, |a, &b| a.min(b))
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&[
            "load",
            "load_gauge",
            "load_nodes",
            "centre",
            "p_max",
            "film_min",
            "plane_shear",
            "pad_shear",
            "cavity",
            "fill_min",
            "inflow",
            "side_flow",
            "residual",
        ])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let found = self.solve()?;
        self.integrals(&found, out);
        sheet::account(&found.out, self.sheet.nodes(), out);
        self.line(&found, out);
        self.maps(&found, out);
        validity::note_limits(out);
        sheet::finite("slider_2d", out)
    }
}
