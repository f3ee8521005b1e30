use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The film cannot become thinner than a given thickness; friction stays viscous.
///
/// The lower end of the search interval of a film that is found by bisection: what load the film does not carry there is
/// taken up without friction, and the film shears on at the floor thickness (Zottin 1992, section 3 and listing).
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilmFloor {
    /// Smallest film thickness.
    #[serde(default = "tenth_of_a_micrometre")]
    pub thickness: PosLength,
    /// Coefficient of friction of the load that the floor carries, added to the shear of the film.
    #[serde(default = "none")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn tenth_of_a_micrometre() -> PosLength {
    quantity(1e-7)
}
fn none() -> Ratio<NonNegative> {
    quantity(0.0)
}

impl Default for FilmFloor {
    fn default() -> Self {
        Self { thickness: tenth_of_a_micrometre(), friction_coefficient: none() }
    }
}

#[register_model(
    name = "film_floor",
    summary = "a smallest film thickness that carries the remaining load without rubbing",
    equations = "h >= thickness;  friction is that of the film at h, plus friction_coefficient times the load on the floor (0)",
    validity = "A numerical stop, not a surface: underestimates friction wherever the floor carries load.",
    references = ["zottin1992"],
    example = "thickness = \"0.1 um\"\n",
)]
impl ContactSpec for FilmFloor {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        Ok(Box::new(Floor {
            thickness: self.thickness.si(),
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

#[derive(Debug)]
struct Floor {
    thickness: f64,
    friction_coefficient: f64,
}

impl Contact for Floor {
    fn pressure(&self, _: &[f64], pressure: &mut [f64]) {
        pressure.fill(0.0);
    }
    fn range(&self) -> f64 {
        0.0
    }
    fn floor(&self) -> Option<f64> {
        Some(self.thickness)
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
}
