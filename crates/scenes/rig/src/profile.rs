//! Profiles of lines as case files describe them.

use gudgeon_core::BuildError;
use gudgeon_core::quantity::{Fraction, Length, NonNegative, PosLength, PosRatio, Ratio, quantity};
use gudgeon_film::film_1d::LineProfile;
use serde::{Deserialize, Serialize};

/// Gap between a profiled surface and a plane along a line, `x` from 0 to `length`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(tag = "shape", rename_all = "snake_case", deny_unknown_fields)]
pub enum Profile {
    /// Straight from `h_in` to `h_out`.
    Linear {
        /// Length of the line.
        length: PosLength,
        /// Gap at the beginning.
        h_in: PosLength,
        /// Gap at the end.
        h_out: PosLength,
    },
    /// Rayleigh step: `h_in`, from the step on `h_out`.
    Step {
        /// Length of the line.
        length: PosLength,
        /// Gap before the step.
        h_in: PosLength,
        /// Gap behind the step.
        h_out: PosLength,
        /// Where the step is, as a part of the length; Rayleigh's optimum when absent.
        #[serde(default = "rayleigh")]
        step: PosRatio,
    },
    /// `h_in (h_out/h_in)^(x/length)`.
    Exponential {
        /// Length of the line.
        length: PosLength,
        /// Gap at the beginning.
        h_in: PosLength,
        /// Gap at the end.
        h_out: PosLength,
    },
    /// Barrel, `film + drop ((x - length/2 - offset)/(length/2))²`.
    Parabola {
        /// Length of the line.
        length: PosLength,
        /// Smallest gap.
        film: PosLength,
        /// Drop at half a length from the apex.
        drop: Length<NonNegative>,
        /// Distance of the apex from the middle of the line.
        #[serde(default = "nothing")]
        offset: Length,
        /// Nodes closer together where the film is thin.
        #[serde(default)]
        graded: bool,
    },
    /// Straight from `h_in` to `h_out`, with a pocket of constant depth.
    Pocket {
        /// Length of the line.
        length: PosLength,
        /// Gap at the beginning.
        h_in: PosLength,
        /// Gap at the end.
        h_out: PosLength,
        /// Where the pocket begins.
        from: PosLength,
        /// Where the pocket ends.
        to: PosLength,
        /// Depth of the pocket below the surface around it.
        depth: Length<NonNegative>,
    },
    /// Straight from `h_in` to `h_out`, with rectangular dimples of equal pitch.
    Textured {
        /// Length of the line.
        length: PosLength,
        /// Gap at the beginning.
        h_in: PosLength,
        /// Gap at the end.
        h_out: PosLength,
        /// Number of dimples.
        #[schemars(range(min = 1, max = 10_000))]
        count: u32,
        /// Part of its pitch that a dimple covers.
        fraction: Ratio<Fraction>,
        /// Depth of the dimples below the surface around them.
        depth: Length<NonNegative>,
    },
    /// Straight pieces between points.
    Table {
        /// Places of the points, rising; two points at one place are a step.
        x: Vec<Length>,
        /// Gap at each of them.
        h: Vec<PosLength>,
    },
}

fn rayleigh() -> PosRatio {
    // n = K√K/(1 + K√K) at K = 1 + √3/2.
    quantity(0.718_233_512_793_083_8)
}
fn nothing() -> Length {
    quantity(0.0)
}

/// Maximum number of panels.
pub(crate) const MAX_PANELS: u32 = 100_000;

/// Whether the number of panels makes sense.
pub(crate) fn panels(n: u32) -> Result<usize, BuildError> {
    if (1..=MAX_PANELS).contains(&n) {
        Ok(n as usize)
    } else {
        Err(BuildError::at("panels", format!("must be between 1 and {MAX_PANELS}, not {n}")))
    }
}

impl Profile {
    /// The line of about `panels` panels.
    ///
    /// # Errors
    /// Values that contradict each other.
    pub fn line(&self, panels: usize) -> Result<LineProfile, BuildError> {
        let ends = |length: &PosLength, a: &PosLength, b: &PosLength| (length.si(), a.si(), b.si());
        match self {
            Self::Linear { length, h_in, h_out } => {
                let (l, a, b) = ends(length, h_in, h_out);
                LineProfile::linear(l, a, b, panels)
            }
            Self::Step { length, h_in, h_out, step } => {
                let (l, a, b) = ends(length, h_in, h_out);
                if step.si() >= 1.0 {
                    return Err(BuildError::at(
                        "step",
                        format!("the step must lie inside the line, below 1, not at {}", step.si()),
                    ));
                }
                LineProfile::step(l, l * step.si(), a, b, panels)
            }
            Self::Exponential { length, h_in, h_out } => {
                let (l, a, b) = ends(length, h_in, h_out);
                LineProfile::exponential(l, a, b, panels)
            }
            Self::Parabola { length, film, drop, offset, graded } => {
                let (l, half) = (length.si(), length.si() / 2.0);
                let curvature = drop.si() / (half * half);
                LineProfile::parabola(l, curvature, half + offset.si(), film.si(), panels, *graded)
            }
            Self::Pocket { length, h_in, h_out, from, to, depth } => {
                let (l, a, b) = ends(length, h_in, h_out);
                let pocket = (from.si(), to.si());
                if pocket.1 <= pocket.0 {
                    return Err(BuildError::at("to", "the pocket must end behind its beginning, `from`"));
                }
                if pocket.1 >= l {
                    return Err(BuildError::at(
                        "to",
                        format!("the pocket must end before the line does, at {} mm", 1e3 * l),
                    ));
                }
                LineProfile::pocket(l, a, b, pocket, depth.si(), panels)
            }
            Self::Textured { length, h_in, h_out, count, fraction, depth } => {
                let (l, a, b) = ends(length, h_in, h_out);
                if *count > 10_000 {
                    return Err(BuildError::at("count", format!("at most 10000 dimples, not {count}")));
                }
                LineProfile::textured(l, a, b, *count as usize, fraction.si(), depth.si(), panels)
            }
            Self::Table { x, h } => {
                if x.len() != h.len() {
                    return Err(BuildError::at(
                        "h",
                        format!("{} gaps are given for {} places", h.len(), x.len()),
                    ));
                }
                let points: Vec<(f64, f64)> = x.iter().zip(h).map(|(x, h)| (x.si(), h.si())).collect();
                LineProfile::table(&points, panels).map_err(|e| match e.field.as_str() {
                    "points" => BuildError { field: "x".into(), ..e },
                    _ => e,
                })
            }
        }
        // What only the line knows by a name has none in the case.
        .map_err(|e| match e.field.as_str() {
            "gap" | "breaks" => BuildError { field: String::new(), ..e },
            _ => e,
        })
    }
}
