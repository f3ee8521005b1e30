use gudgeon_core::kinds::{SkirtOil, SkirtOilSpec};
use gudgeon_core::quantity::{Area, Length, NonNegative, PosAngle, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The films keep the oil they have: `∂(θ h)/∂t + div q = 0` with `p ≥ 0`, `θ ≤ 1` and one of them an equality (Jakobsson, Floberg and Olsson).
///
/// The filling `θ` of every cell is a state. It is moved in steps of the crank angle, implicitly and without loss, on the grid of the film; within a step
/// a cell carries pressure as far as the oil that is foreseen there fills the gap of the instant, from nine tenths of it on. Oil comes with the liner: on the way down
/// the lower edge meets the film that splash leaves, on the way up the upper edge meets what the oil ring leaves and what waits before it. An edge takes up what
/// it has room for, `θ = 2 δ/h` of a gap `h` in a steady flow, and pushes the rest before it. The flanks are open: oil leaves over them and none comes back.
///
/// The liner carries `u h θ/2` through a gap that is not full, as of streamers that reach from the liner to the skirt. Gas stands at the pressure of the crankcase.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FillHistory {
    /// Film that splash leaves on the liner below the skirt.
    pub splash: Length<NonNegative>,
    /// Film that the oil ring leaves on the liner above the skirt on the way up. In a `power_cylinder` whose rings follow their oil it is theirs when it is absent
    /// here; 10 um otherwise, with what stands behind the ring.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub above: Option<Length<NonNegative>>,
    /// Cross-section of the room between the oil ring and the skirt, as of a chamfer on its upper edge: what leaves there on the way down waits in it and comes back on
    /// the way up. What it does not hold drains through the oil ring.
    pub room_above: Area<NonNegative>,
    /// Film in the gap at the start of the first cycle, where there is room for it.
    pub initial: Length<NonNegative>,
    /// Crank angle over which oil is moved and booked at once, 0.05 to 10 degrees; a whole number of them fits into the cycle. A skirt that runs short of oil crosses its
    /// clearance in flight, and the film that it meets fills within one step: its pressure needs steps in which an edge moves by less than a third of the clearance.
    #[schemars(extend("x-refine" = { "group": "oil step", "factor": 0.5 }))]
    pub step: PosAngle,
}

/// Film that an oil ring, and what stands behind it, leaves where nothing is known of it \[m\].
const BEHIND_OIL_RING: f64 = 10e-6;
/// Least and largest step \[rad\].
const STEPS: std::ops::RangeInclusive<f64> = 8.7e-4..=0.1746;

impl Default for FillHistory {
    fn default() -> Self {
        Self {
            splash: quantity(100e-6),
            above: None,
            room_above: quantity(0.3e-6),
            initial: quantity(20e-6),
            step: quantity(1f64.to_radians()),
        }
    }
}

#[register_model(
    name = "fill_history",
    summary = "films keep their oil from instant to instant, fed by splash and by the oil ring",
    equations = "d(theta h)/dt + div(u h theta/2 - h^3/(12 mu) grad p) = 0;  p >= 0, theta <= 1, p (1 - theta) = 0;  \
                at an edge that meets a film delta on the liner: theta = min(1, 2 delta/h);  flanks: p = 0, nothing comes in",
    validity = "Motions with inertia, or none: a gap that is not full resists nothing. Oil moves with the liner and in the gap only: no mist, no oil through holes of the skirt, no film kept on the skirt itself. \
               All oil in a gap that is not full moves at half the speed of the liner, so a stroke of two lengths of the skirt \
                empties a skirt that meets none on the way up. First order in the step and in the spacing of the film grid. Cavities at the pressure of the crankcase.",
    references = ["jakobsson1957", "elrod1981"],
    example = "splash = \"100 um\"\nabove = \"10 um\"\nroom_above = \"0.3 mm2\"\ninitial = \"20 um\"\nstep = \"1 deg\"\n",
)]
impl SkirtOilSpec for FillHistory {
    fn take_from_rings(&mut self, film: f64) -> bool {
        let takes = self.above.is_none();
        if takes {
            self.above = Some(quantity(film));
        }
        takes
    }

    fn build(&self) -> Result<Option<Box<dyn SkirtOil>>, BuildError> {
        let step = self.step.si();
        if !STEPS.contains(&step) {
            let what = format!("must be between 0.05 and 10 degrees, not {}", step.to_degrees());
            return Err(BuildError::at("step", what));
        }
        Ok(Some(Box::new(Supply {
            films: [self.above.map_or(BEHIND_OIL_RING, |f| f.si()), self.splash.si()],
            room_above: self.room_above.si(),
            initial: self.initial.si(),
            step,
        })))
    }
}

#[derive(Debug)]
struct Supply {
    films: [f64; 2],
    room_above: f64,
    initial: f64,
    step: f64,
}

impl SkirtOil for Supply {
    fn arriving(&self, _: f64) -> [f64; 2] {
        self.films
    }
    fn room_above(&self) -> f64 {
        self.room_above
    }
    fn initial(&self) -> f64 {
        self.initial
    }
    fn step(&self) -> f64 {
        self.step
    }
}
