//! Nodes of one side, and what stands at them.

use gudgeon_core::kinds::{Film2dGrid, SkirtProfile};
use gudgeon_numerics::elementary;

use crate::geometry::Panel;

/// Nodes of a side, or of one half of a symmetric one.
pub(super) struct Nodes {
    pub(super) nx: usize,
    pub(super) ny: usize,
    /// Part of the height at nodes and halfway to the next ones.
    pub(super) s: Vec<f64>,
    pub(super) s_face: Vec<f64>,
    /// Angle from the middle of the side \[rad\].
    pub(super) angle: Vec<f64>,
    angle_face: Vec<f64>,
    pub(super) cos: Vec<f64>,
    pub(super) cos_face: Vec<f64>,
    /// Area of every node, both halves counted.
    pub(super) weight: Vec<f64>,
    pub(super) line_weight: Vec<f64>,
}

impl Nodes {
    /// Those of a grid over the panel; `is_half`: of one half of it.
    pub(super) fn new(grid: &Film2dGrid, panel: &Panel, is_half: bool) -> Self {
        let s: Vec<f64> = grid.x.iter().map(|x| x / panel.length).collect();
        let angle: Vec<f64> = grid.y.iter().map(|y| y / panel.radius).collect();
        let angle_face = halfway(&angle);
        let (wx, wy) = grid.weights();
        let both = if is_half { 2.0 } else { 1.0 };
        let line_weight: Vec<f64> = wy.iter().map(|w| both * w).collect();
        Self {
            nx: s.len(),
            ny: angle.len(),
            s_face: halfway(&s),
            cos: angle.iter().map(|&a| elementary::cos(a)).collect(),
            cos_face: angle_face.iter().map(|&a| elementary::cos(a)).collect(),
            weight: line_weight.iter().flat_map(|l| wx.iter().map(move |w| w * l)).collect(),
            s,
            angle,
            angle_face,
            line_weight,
        }
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.nx * self.ny
    }

    /// The next nodes along `x` and along `y`, or the node itself at the end of a line.
    pub(super) fn next(&self, k: usize) -> (usize, usize) {
        let (nx, n) = (self.nx, self.len());
        (if k % nx + 1 < nx { k + 1 } else { k }, if k + nx < n { k + nx } else { k })
    }

    /// Shapes of the gap's rates: upper edge, lower edge of a side of sign `sign`, then the elastic ones, given on a grid of `whole` nodes whose first part
    /// these are.
    pub(super) fn shapes(&self, sign: f64, elastic: &[f64], whole: usize) -> Vec<f64> {
        let mut shapes = edges(sign, &self.cos, &self.s);
        elastic.chunks_exact(whole).for_each(|shape| shapes.extend_from_slice(&shape[..self.len()]));
        shapes
    }

    /// The same at faces along `x` and along `y`; `elastic` ones are those at the nodes.
    pub(super) fn face_shapes(&self, sign: f64, elastic: &[f64]) -> [Vec<f64>; 2] {
        let mut faces = [edges(sign, &self.cos, &self.s_face), edges(sign, &self.cos_face, &self.s)];
        for f in elastic.chunks_exact(self.len()) {
            for k in 0..self.len() {
                let (east, north) = self.next(k);
                faces[0].push(0.5 * (f[k] + f[east]));
                faces[1].push(0.5 * (f[k] + f[north]));
            }
        }
        faces
    }

    /// Drop of a profile at nodes, at faces along `x` and along `y`.
    pub(super) fn drops(&self, panel: &Panel, profile: &dyn SkirtProfile) -> [Vec<f64>; 3] {
        let field = |x: &[f64], a: &[f64]| -> Vec<f64> {
            a.iter().flat_map(|&a| x.iter().map(move |&x| profile.depth(x * panel.length, a))).collect()
        };
        [field(&self.s, &self.angle), field(&self.s_face, &self.angle), field(&self.s, &self.angle_face)]
    }
}

/// How much the gap opens per displacement of the upper, then of the lower edge of a side of sign `sign`, at places of those cosines and parts of the
/// height.
fn edges(sign: f64, cos: &[f64], s: &[f64]) -> Vec<f64> {
    let top = cos.iter().flat_map(|c| s.iter().map(move |s| sign * c * (1.0 - s)));
    let bottom = cos.iter().flat_map(|c| s.iter().map(move |s| sign * c * s));
    top.chain(bottom).collect()
}

/// Values halfway between neighbours; the last one stands at the end.
fn halfway(v: &[f64]) -> Vec<f64> {
    let mut m: Vec<f64> = v.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    m.extend(v.last());
    m
}
