//! The passages around a ring: what a gas-flow model of the ring pack says beside the law of a single passage.

use gudgeon_core::elementary;
use gudgeon_core::geometry::RingGeometry;

/// Gap between a ring and a flank of its groove: a wedge where the ring is twisted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlankGap {
    /// Height at the inner edge of the ring \[m\].
    pub inner: f64,
    /// Height at its outer edge \[m\].
    pub outer: f64,
}

impl FlankGap {
    /// A gap of the same height \[m\] everywhere.
    #[must_use]
    pub const fn parallel(height: f64) -> Self {
        Self { inner: height, outer: height }
    }

    /// A gap of a mean height \[m\] that opens outwards by `rise` \[m\] from its middle to its outer edge; ends that would be below zero are closed.
    #[must_use]
    pub fn wedge(mean: f64, rise: f64) -> Self {
        if rise == 0.0 {
            return Self::parallel(mean);
        }
        Self { inner: (mean - rise).max(0.0), outer: (mean + rise).max(0.0) }
    }

    /// The part `share` of the gap.
    #[must_use]
    pub fn times(&self, share: f64) -> Self {
        Self { inner: self.inner * share, outer: self.outer * share }
    }

    /// Smallest height \[m\]: what an orifice sees.
    #[must_use]
    pub fn narrowest(&self) -> f64 {
        self.inner.min(self.outer)
    }

    /// Height \[m\] of the parallel gap that lets the same laminar flow through: `h³ = 2 a² b²/(a + b)` for a wedge from `a` to `b`, the mean of
    /// `1/h³` over its width.
    #[must_use]
    pub fn laminar(&self) -> f64 {
        let (a, b) = (self.inner, self.outer);
        if a == b {
            return a;
        }
        if a <= 0.0 || b <= 0.0 { 0.0 } else { elementary::cbrt(2.0 * a * a * b * b / (a + b)) }
    }
}

/// The openings around one ring at an instant, from which a [`PassageModel`] makes passages.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Openings {
    /// Film thickness that counts \[m\]: that of the instant, or the nominal one.
    pub h: f64,
    /// Liner radius \[m\], distortion included.
    pub liner_radius: f64,
    /// Distance from the lower groove flank, not negative unless the pack is unbound; where oil closes a part of a gap, what is open of it.
    pub lower: FlankGap,
    /// Distance from the upper groove flank, likewise.
    pub upper: FlankGap,
    /// Leak heights of the seated lower and upper flank \[m\].
    pub leak: [f64; 2],
    /// Position in the groove, 0 lower flank, 1 upper flank.
    pub lift_fraction: f64,
    /// End-gap area \[m²\], with the chamfer.
    pub gap: f64,
    /// Volume behind the ring \[m³\].
    pub back_volume: f64,
}

/// The passages of one ring; all closed by default.
///
/// ```text
/// land above ──upper──> space behind ──lower──> land below
/// land above ──────────────gap────────────────> land below
/// land above ──────────────face───────────────> land below
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RingPassages<P> {
    /// Past the upper flank: land above to the space behind (a groove that is open to the land below: to that). Not used for a sealed ring or a
    /// groove that is open to the land above.
    pub upper: P,
    /// Past the lower flank: space behind to land below (a groove that is open to the land above: from that). Not used for a sealed ring or a
    /// groove that is open to the land below.
    pub lower: P,
    /// Directly from land to land through the end gap.
    pub gap: P,
    /// Directly from land to land past the face; used where [`PassageModel::HAS_FACE`] is set.
    pub face: P,
}

/// Which passages are around a ring. Together with the law of a passage `P` this is a gas-flow model, see
/// [`PackNetwork`](crate::PackNetwork). [`OrificeAreas`](crate::OrificeAreas) is one for any law of areas.
pub trait PassageModel<P>: Send {
    /// Whether any ring has a passage past its face of its own.
    const HAS_FACE: bool = false;

    /// Whether [`RingPassages::gap`] holds what passes between face and liner.
    const GAP_HOLDS_FACE: bool = false;

    /// Whether an opening below zero means something (an area does, a height whose cube counts does not). Only then does
    /// [`GasFlow::unbound`](gudgeon_core::kinds::GasFlow::unbound) change anything.
    const SIGNED: bool = false;

    /// The passages of ring `ring`, counted from 0 at the crown.
    fn ring_passages(&self, ring: usize, geometry: &RingGeometry, openings: &Openings) -> RingPassages<P>;

    /// The passage of a drain of an area \[m²\], by the discharge coefficient of the law; `None`, the default, where the model has no such passage:
    /// packs with a drain are refused.
    fn drain(&self, _area: f64) -> Option<P> {
        None
    }

    /// Time \[s\] within which the space behind a seated ring takes on the pressure of the land it faces, when the model couples
    /// the two by a linear leak; `None` when it does not.
    fn merge_time(&self) -> Option<f64> {
        None
    }

    /// Whether the passages themselves (not gap, clearance and volume) depend on [`Openings::h`]. `true` is always right; `false`
    /// lets a run without films be planned.
    fn uses_film_height(&self, _geometry: &RingGeometry) -> bool {
        true
    }
}
