//! Floors, caps and drags of the scene: numbers that stand for physics left out, each a key of the case.

use gudgeon_core::kinds::RadialLimits;
use gudgeon_core::quantity::{PosAngle, PosLength, PosRatio, PosVelocity, PosViscosity, quantity};
use gudgeon_numerics::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Floors, caps and drags. What acted in the reported cycle is noted, with how much and for how long.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-renamed" = {
    "least_film": "min_film", "least_load": "min_load", "least_room": "min_room", "most_steps": "max_steps",
}))]
pub struct Limits {
    /// Film thickness at which there is no oil left between smooth surfaces: a molecule or two. With a contact model that has no roughness
    /// of its own (`off`, `linear_penalty`) a run in which a ring rests there under load fails.
    pub min_film: PosLength,
    /// Least load of a film over that of the ring's tension. A cavitating film cannot pull: a ring that gas presses off the liner moves away
    /// fast, not infinitely fast.
    pub min_load: PosRatio,
    /// Radial speed that a ring does not exceed. Gas that lifts a ring off the liner meets its inertia, which the radial balance leaves out;
    /// normal squeeze velocities are a thousand times smaller.
    pub radial_speed: PosVelocity,
    /// Drag per circumference of a ring off the liner, in place of its inertia: a dry ring of 0.05 kg/m crosses 0.1 mm in about the same time
    /// against ten to fifty times as much. Also what moves a ring with `hydrodynamics = "off"`.
    pub radial_drag: PosViscosity,
    /// Drag per circumference of surfaces in contact that move apart, at full contact. A film that is drawn apart cavitates and holds nothing, the
    /// same film resists an approach without bound, and a ring whose contact gives way rides on the corner between the two. The drag rounds it:
    /// 1e3 to 1e5 Pa s change the friction of a pack by 1e-4 of itself, and the small ones cost half as many steps again.
    pub contact_drag: PosViscosity,
    /// Part of the radial load that the drag has, at the velocity which the film alone allows, from which it counts: the squeeze of films that
    /// carry their ring is left as it is.
    pub drag_from: PosRatio,
    /// Part of the radial load from which the drag counts in full.
    pub drag_full: PosRatio,
    /// Film thickness over the range of contact from which the drag counts: films in contact are damped by their squeeze.
    pub drag_gap_from: PosRatio,
    /// Film thickness over the range of contact from which the drag counts in full.
    pub drag_gap_full: PosRatio,
    /// Part of the way of a retreating ring, before it is flush with its land or at the groove root, over which it comes to rest.
    pub retreat_band: PosRatio,
    /// Radial gap kept behind a ring at the groove root, so that its gas volume stays one.
    pub min_room: PosLength,
    /// Film thickness beyond which a ring has left the liner: flooded films of rings stay below 40 um. Events and notes know it, and the search of the periodic state, which does
    /// not go in halves where a ring is beyond it in the first cycle.
    pub off_the_liner: PosLength,
    /// Sliding speed over which boundary friction changes its sign, where no model of `boundary_friction` does that: a thousandth of a usual piston speed.
    pub friction_speed: PosVelocity,
    /// Film thickness that gas flows see under a ring whose film is not solved: a usual mean.
    pub nominal_film: PosLength,
    /// `degree_march`: upper end of the interval in which the source looks for a film.
    pub thickest_film: PosLength,
    /// Longest step: no pulse of pressure is jumped over.
    pub longest_step: PosAngle,
    /// Most steps of a cycle; a run that needs more fails. 0: 30 000, some thirty times what a pack needs; in proportion to `tolerance^(-1/4)`
    /// below the default tolerance, and to the duration of the cycle below 100 rad/s, because rings and gas have times of their own.
    #[schemars(range(max = 1_000_000_000))]
    pub max_steps: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            min_film: quantity(1e-9),
            min_load: quantity(1e-3),
            radial_speed: quantity(3.0),
            radial_drag: quantity(10.0),
            contact_drag: quantity(3e4),
            drag_from: quantity(1e-3),
            drag_full: quantity(1e-1),
            drag_gap_from: quantity(2.0),
            drag_gap_full: quantity(5.0),
            retreat_band: quantity(0.02),
            min_room: quantity(1e-6),
            off_the_liner: quantity(50e-6),
            friction_speed: quantity(0.01),
            nominal_film: quantity(2e-6),
            thickest_film: quantity(60e-6),
            longest_step: quantity(10f64.to_radians()),
            max_steps: 0,
        }
    }
}

impl From<&Limits> for RadialLimits {
    fn from(l: &Limits) -> Self {
        Self {
            min_load: l.min_load.si(),
            radial_speed: l.radial_speed.si(),
            radial_drag: l.radial_drag.si(),
            contact_drag: l.contact_drag.si(),
            drag_counts: (l.drag_from.si(), l.drag_full.si()),
            drag_gap: (l.drag_gap_from.si(), l.drag_gap_full.si()),
            retreat_band: l.retreat_band.si(),
        }
    }
}

/// Steps of a cycle at the default tolerance, that tolerance, and the crank speed \[rad/s\] below which time counts.
const STEPS: (f64, f64, f64) = (30_000.0, 1e-4, 100.0);

impl Limits {
    /// Most steps of a cycle at a tolerance and a crank speed \[rad/s\].
    #[must_use]
    pub fn steps_at(&self, tolerance: f64, omega: f64) -> u64 {
        if self.max_steps > 0 {
            return self.max_steps;
        }
        let (most, usual, slow) = STEPS;
        (most * elementary::powf((usual / tolerance).max(1.0), 0.25) * (slow / omega).max(1.0)) as u64
    }

    /// Every key with its value \[SI\] and its reason.
    #[must_use]
    pub fn explained(&self) -> Vec<(String, String, String)> {
        let schema = schemars::schema_for!(Limits);
        let values = serde_json::to_value(self).unwrap_or_default();
        let reason = |key: &str| {
            let text = schema.as_value()["properties"][key]["description"].as_str().unwrap_or_default();
            text.split_whitespace().collect::<Vec<_>>().join(" ")
        };
        values
            .as_object()
            .into_iter()
            .flatten()
            .map(|(k, v)| {
                let value = v.as_str().map_or_else(|| v.to_string(), str::to_owned);
                (format!("solver.limits.{k}"), value, reason(k))
            })
            .collect()
    }
}
