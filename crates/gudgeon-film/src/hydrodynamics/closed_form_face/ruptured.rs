//! A ruptured film with one cavity, as the quick searches find it.

use super::flow::Flow;
use super::reformation::Start;
use super::shape::Shape;
use super::side::Side;

/// A ruptured film: its squeeze velocity, the end of the film at the leading edge and the beginning of that at the trailing
/// edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ruptured {
    pub v: f64,
    pub i: usize,
    pub x: f64,
    pub q: f64,
    pub front: Option<Start>,
}

impl<S: Shape> Side<S> {
    /// Whether the film that ends at `r.x` would, if it went on, need more than the pressure there is at the trailing edge:
    /// whether it has ruptured.
    pub(super) fn has_ruptured(&self, f: &Flow, r: &Ruptured) -> bool {
        self.face.tail(r.i, r.x).rise(f.u, f.v, r.q) >= f.pb
    }
}
