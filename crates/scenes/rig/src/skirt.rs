use gudgeon_core::kinds::{Film2dSpec, Rig, RigCtx, RigOut, RigSpec, RoughnessSpec, named};
use gudgeon_core::quantity::{
    Length, NonNegative, PosAngle, PosLength, PosViscosity, Pressure, Ratio, Velocity, quantity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_film::SmoothSurfaces;
use gudgeon_numerics::elementary;
use gudgeon_skirt::{CROWDING, Panel};
use serde::{Deserialize, Serialize};

use crate::along;
use crate::sheet::{self, Conditions, Sheet};
use crate::validity;

/// The film between one side of a piston skirt and the liner at one instant.
///
/// `h = clearance - (e_top (1 - s) + e_bottom s) cos φ + barrel (2 s - 1)²`, with `s` from 0 at the upper edge to 1 at the lower
/// edge and `φ` from the middle of the side.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SkirtRig {
    /// Radius of the skirt.
    pub radius: PosLength,
    /// Height of the skirt, from its upper edge to its lower edge.
    pub length: PosLength,
    /// Angle that the side covers to the left and to the right of its middle, below 90 degrees.
    pub half_angle: PosAngle,
    /// Radial clearance of the centred skirt.
    pub clearance: PosLength,
    /// Drop of the barrel shape at both edges.
    #[serde(default = "nothing")]
    pub barrel: Length<NonNegative>,
    /// Displacement of the upper edge towards this side of the liner.
    #[serde(default = "centred")]
    pub e_top: Length,
    /// Displacement of the lower edge towards this side of the liner.
    #[serde(default = "centred")]
    pub e_bottom: Length,
    /// Velocity of `e_top`.
    #[serde(default = "still")]
    pub e_top_rate: Velocity,
    /// Velocity of `e_bottom`.
    #[serde(default = "still")]
    pub e_bottom_rate: Velocity,
    /// Velocity of the piston, towards the head positive.
    pub speed: Velocity,
    /// Viscosity.
    pub viscosity: PosViscosity,
    /// Absolute pressure on all edges.
    #[serde(default = "vacuum")]
    pub p_edge: Pressure,
    /// Absolute cavitation pressure.
    #[serde(default = "vacuum")]
    pub p_cav: Pressure,
    /// Height below the upper edge about which the moment is taken; half the length when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pin: Option<Length>,
    /// Number of intervals between nodes along the height.
    #[serde(default = "along")]
    #[schemars(range(min = 2, max = 2000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub intervals_x: u32,
    /// Number of intervals along the circumference. With an even number, one half of the film is solved.
    #[serde(default = "across")]
    #[schemars(range(min = 2, max = 2000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub intervals_y: u32,
    /// How much closer nodes lie at half the height than in the mean, 0 for equal spacings, at most 0.5, or below 0, at least -0.5, at both edges:
    /// `x = L/2 (1 + t (1 - g + g t²))` with `t` equally spaced from -1 to 1.
    #[serde(default = "equal")]
    pub crowding: Ratio,
    /// Flow and shear factors of rough or wavy surfaces; the skirt is the body.
    #[serde(default = "smooth")]
    pub roughness: Box<dyn RoughnessSpec>,
    /// The model.
    pub film_2d: Box<dyn Film2dSpec>,
}

fn nothing() -> Length<NonNegative> {
    quantity(0.0)
}
fn centred() -> Length {
    quantity(0.0)
}
fn still() -> Velocity {
    quantity(0.0)
}
fn vacuum() -> Pressure {
    quantity(0.0)
}
fn equal() -> Ratio {
    quantity(0.0)
}
fn along() -> u32 {
    64
}
fn across() -> u32 {
    48
}
fn smooth() -> Box<dyn RoughnessSpec> {
    Box::new(SmoothSurfaces {})
}

#[register_model(
    name = "skirt",
    summary = "film of one side of a piston skirt at one instant: thrust force, moment, friction and pressure map",
    equations = "h = c - (e_t (1 - s) + e_b s) cos phi + B (2 s - 1)^2;  thrust = int (p - p_edge) cos phi dA;  \
                moment = int (p - p_edge) (x_pin - x) cos phi dA;  \
                liner_shear = int (theta mu u/h (phi_f + phi_fs) + phi_fp h/2 dp/dx) dA",
    validity = "The piston feels the opposite of liner_shear: skirt_shear, and the pressure on what is tilted. Rigid skirt, flooded on all edges, no history. The gap must be open everywhere, or held open by the roughness model.",
    references = ["loureiro2009"],
    example = "radius = \"43 mm\"\nlength = \"50 mm\"\nhalf_angle = \"50 deg\"\nclearance = \"30 um\"\nbarrel = \"20 um\"\ne_top = \"18 um\"\n\
              e_bottom = \"10 um\"\nspeed = \"-8 m/s\"\nviscosity = \"10 mPa s\"\nfilm_2d = { model = \"multigrid\" }\n",
)]
impl RigSpec for SkirtRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("film_2d", self.film_2d.typetag_name()), ("roughness", self.roughness.typetag_name())]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        if self.half_angle.si() >= std::f64::consts::FRAC_PI_2 {
            let what = format!("must be below 90 degrees, not {}", self.half_angle.si().to_degrees());
            errors.push(BuildError::at("half_angle", what));
        }
        if !CROWDING.contains(&self.crowding.si()) {
            let (least, most) = (CROWDING.start(), CROWDING.end());
            let what = format!("must be between {least} and {most}, not {}", self.crowding.si());
            errors.push(BuildError::at("crowding", what));
        }
        errors.extend(along::cavitation_below(self.p_cav.si(), &[self.p_edge.si()]));
        let nx = sheet::intervals("intervals_x", self.intervals_x);
        let ny = sheet::intervals("intervals_y", self.intervals_y);
        match (nx, ny) {
            (Ok(nx), Ok(ny)) if errors.is_empty() => {
                let panel = self.panel();
                let grid = panel.grid(nx, ny, self.crowding.si());
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

impl SkirtRig {
    fn panel(&self) -> Panel {
        Panel { radius: self.radius.si(), length: self.length.si(), half_angle: self.half_angle.si() }
    }
}

struct Bench {
    sheet: Sheet,
    spec: SkirtRig,
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&["thrust", "moment", "p_max", "film_min", "liner_shear", "skirt_shear", "cavity", "residual"])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let spec = &self.spec;
        let (radius, length, edge) = (spec.radius.si(), spec.length.si(), spec.p_edge.si());
        let panel = spec.panel();
        let (e, v) = ((spec.e_top.si(), spec.e_bottom.si()), (spec.e_top_rate.si(), spec.e_bottom_rate.si()));
        let gap = |x: f64, y: f64| {
            let barrel = spec.barrel.si() * (2.0 * x / length - 1.0).powi(2);
            panel.gap(spec.clearance.si(), e.0, e.1, x, y / radius) + barrel
        };
        let rate = |x: f64, y: f64| panel.gap(0.0, v.0, v.1, x, y / radius);
        let found = self.sheet.solve(
            &Conditions {
                u: spec.speed.si(),
                mu: spec.viscosity.si(),
                p_cav: spec.p_cav.si(),
                edge_pressure: [edge; 4],
                edge_fill: [1.0; 4],
                between: true,
            },
            &gap,
            if v == (0.0, 0.0) { None } else { Some(&rate) },
        )?;
        let o = found.out;
        let pin = spec.pin.map_or(0.5 * length, |p| p.si());
        let thrust = self.sheet.integral(|k, _, y| (found.p[k] - edge) * elementary::cos(y / radius));
        let moment =
            self.sheet.integral(|k, x, y| (found.p[k] - edge) * (pin - x) * elementary::cos(y / radius));
        out.result("thrust", thrust, "N", "force that presses the skirt away from this side of the liner");
        out.result("moment", moment, "N m", "moment about the pin, pushing the upper edge away positive");
        out.result("p_max", o.p_max / 1e5, "bar", "highest pressure");
        let thinnest = found.h.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        out.result("film_min", 1e6 * thinnest, "um", "smallest gap");
        out.result(
            "liner_shear",
            o.shear_lower,
            "N",
            "viscous force on the liner, towards the head positive",
        );
        out.result(
            "skirt_shear",
            o.shear_upper,
            "N",
            "viscous force on the skirt, away from the head positive",
        );
        let grid = &self.sheet.whole;
        let area = length * 2.0 * spec.half_angle.si() * radius;
        out.result("cavity", 100.0 * o.cavity / area, "%", "share of the area that is not filled");
        sheet::account(&o, self.sheet.nodes(), out);
        // From the lower edge up, as the skirt stands.
        let nx = grid.x.len();
        let up = |f: &[f64]| f.iter().rev().copied().collect::<Vec<f64>>();
        out.axis("height", "m", grid.x.iter().rev().map(|x| length - x).collect());
        out.column("p", "Pa", up(&self.sheet.middle(&found.p)));
        out.column("h", "m", up(&self.sheet.middle(&found.h)));
        out.curves(
            "Pressure along the middle of the side",
            "absolute; from the lower edge to the upper edge",
            &[("pressure", "p")],
        );
        out.curves("Gap along the middle of the side", "", &[("gap", "h")]);
        let (xs, ys) = (up_nodes(nx), sheet::drawn(grid.y.len()));
        let pick = |f: &[f64]| -> Vec<f64> {
            xs.iter().flat_map(|i| ys.iter().map(move |j| f[j * nx + i])).collect()
        };
        let mut maps = vec![("p", "Pa", "Pressure", pick(&found.p)), ("h", "m", "Gap", pick(&found.h))];
        if found.fill.iter().any(|f| *f < 1.0) {
            maps.push(("fill", "", "Filling", pick(&found.fill)));
        }
        out.maps(
            "film",
            ("angle", "deg", ys.iter().map(|j| (grid.y[*j] / radius).to_degrees()).collect()),
            ("height", "m", xs.iter().map(|i| length - grid.x[*i]).collect()),
            maps,
        );
        validity::note_limits(out);
        sheet::finite("skirt", out)
    }
}

/// Nodes along the height that a map shows, from the lower edge up.
fn up_nodes(n: usize) -> Vec<usize> {
    let mut nodes = sheet::drawn(n);
    nodes.reverse();
    nodes
}
