//! The running face of a ring as case files describe it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::BuildError;
use crate::geometry::FaceProfile;
use crate::quantity::{Length, NonNegative, PosLength, quantity};

/// Shape of the running face. Drops are measured away from the liner.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Face {
    /// Which of the shapes.
    pub shape: FaceShape,
    /// Axial length of the running face (of one land of a twin-land ring). The ring's height when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<PosLength>,
    /// `parabola`: drop at half a face length from the apex (the barrel height of a symmetric face). `taper`: drop at the
    /// top edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drop: Option<Length<NonNegative>>,
    /// `taper`: width of the flat land at the bottom edge that lapping and the first hours of running leave, 0.1 to 0.3 mm on rings in
    /// service; 0.2 mm when absent, on faces shorter than 2 mm a tenth of the length. 0 for the sharp edge of a ring as drawn, on which
    /// all of its load stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub land: Option<Length<NonNegative>>,
    /// `parabola`: height of the apex above the middle of the face.
    #[serde(default = "zero_length")]
    pub offset: Length,
    /// `table`: drops at equal spacings, bottom edge first, at least two.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drops: Vec<Length>,
}

/// Shapes of a running face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FaceShape {
    /// Barrel: `drop * ((x - middle - offset) / (length / 2))^2`.
    Parabola,
    /// Straight, the bottom edge touching with a narrow flat `land`.
    Taper,
    /// Straight lines between given drops.
    Table,
}

/// Width of the land of a taper face when none is given \[m\]: the middle of what is usual.
const LAND: f64 = 0.2e-3;

fn zero_length() -> Length {
    quantity(0.0)
}

impl Face {
    /// The profile on a ring of the given height \[m\].
    ///
    /// # Errors
    /// Keys that do not belong to the shape or are missing for it, or a face longer than its ring is high.
    pub fn profile(&self, height: f64) -> Result<FaceProfile, BuildError> {
        let length = self.length.map_or(height, |l| l.si());
        if length > height * (1.0 + 1e-9) {
            return Err(BuildError::at(
                "length",
                format!(
                    "a face of {:.4} mm is longer than its ring is thick ({:.4} mm)",
                    1e3 * length,
                    1e3 * height
                ),
            ));
        }
        let only = |unwanted: bool, field: &str, shape: &str| {
            if unwanted {
                Err(BuildError::at(field, format!("`{field}` has no meaning for a face of shape `{shape}`")))
            } else {
                Ok(())
            }
        };
        match self.shape {
            FaceShape::Parabola => {
                only(!self.drops.is_empty(), "drops", "parabola")?;
                only(self.land.is_some(), "land", "parabola")?;
                let drop =
                    self.drop.ok_or_else(|| BuildError::at("shape", "a `parabola` needs its `drop`"))?.si();
                let half = length / 2.0;
                if self.offset.si().abs() > half {
                    let what = format!(
                        "the crown would stand beside the face: from its middle to its edge there are {} mm",
                        1e3 * half
                    );
                    return Err(BuildError::at("offset", what));
                }
                Ok(FaceProfile::Parabola {
                    length,
                    curvature: drop / (half * half),
                    apex: half + self.offset.si(),
                })
            }
            FaceShape::Taper => {
                only(!self.drops.is_empty(), "drops", "taper")?;
                only(self.offset.si() != 0.0, "offset", "taper")?;
                let drop =
                    self.drop.ok_or_else(|| BuildError::at("shape", "a `taper` needs its `drop`"))?.si();
                let land = self.land.map_or_else(|| LAND.min(0.1 * length), |l| l.si());
                if land >= length {
                    return Err(BuildError::at(
                        "land",
                        format!(
                            "a land of {:.4} mm leaves no taper on a face of {:.4} mm",
                            1e3 * land,
                            1e3 * length
                        ),
                    )
                    .help("the flat part of a taper face is a few tenths of a millimetre wide"));
                }
                Ok(if land > 0.0 {
                    FaceProfile::Taper { length, land, drop }
                } else {
                    FaceProfile::Table { length, drops: vec![0.0, drop] }
                })
            }
            FaceShape::Table => {
                only(self.drop.is_some(), "drop", "table")?;
                only(self.land.is_some(), "land", "table")?;
                only(self.offset.si() != 0.0, "offset", "table")?;
                if self.drops.len() < 2 {
                    return Err(BuildError::at(
                        "drops",
                        format!("a table needs at least two drops, not {}", self.drops.len()),
                    ));
                }
                let drops: Vec<f64> = self.drops.iter().map(|d| d.si()).collect();
                if let Some(i) = drops.iter().position(|d| *d < 0.0) {
                    return Err(BuildError::at(
                        format!("drops.{i}"),
                        "a drop is measured away from the liner and cannot be negative",
                    ));
                }
                Ok(FaceProfile::Table { length, drops })
            }
        }
    }
}
