//! The passages around a ring: what a gas-flow model of the ring pack says beside the law of a single passage.

use gudgeon_core::geometry::RingGeometry;

/// The openings around one ring at an instant, from which a [`PassageModel`] makes passages.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Openings {
    /// Film thickness that counts \[m\]: that of the instant, or the nominal one.
    pub h: f64,
    /// Liner radius \[m\], distortion included.
    pub liner_radius: f64,
    /// Axial distance from the lower groove flank \[m\], not negative unless the pack is unbound.
    pub lower: f64,
    /// Axial distance from the upper groove flank \[m\], likewise.
    pub upper: f64,
    /// Position in the groove, 0 lower flank, 1 upper flank.
    pub e: f64,
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
    /// Past the upper flank: land above to the space behind (drained groove: to the land below). Not used for a sealed ring.
    pub upper: P,
    /// Past the lower flank: space behind to land below. Not used for a sealed ring or a drained groove.
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

    /// Whether an opening below zero means something (an area does, a height whose cube counts does not). Only then does
    /// [`GasFlow::unbound`](gudgeon_core::kinds::GasFlow::unbound) change anything.
    const SIGNED: bool = false;

    /// The passages of ring `ring`, counted from 0 at the crown.
    fn ring_passages(&self, ring: usize, geometry: &RingGeometry, openings: &Openings) -> RingPassages<P>;

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
