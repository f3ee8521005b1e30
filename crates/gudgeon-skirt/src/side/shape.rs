//! The gap of one side at a place, and what of its film depends on the place alone.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::RoughShear;
use gudgeon_numerics::vectors::{Vectorised, least, widest};

use super::gap::{Gap, held_above};
use super::kept::room_of;
use super::nodes::Nodes;
use super::{MODEL, Side};
use crate::geometry::between;

/// How deep a skirt may stand inside the liner \[m\]: far beyond what contact allows, and yet within a start that is given wrongly.
const DEEPEST: f64 = 1e-4;

impl Side {
    /// Gap and factors at the displacements `e` of both edges and the elastic amplitudes `q`.
    pub(super) fn shape_gap(
        &mut self,
        trial: bool,
        e: [f64; 2],
        q: &[f64],
        speed: f64,
    ) -> Result<(), EvalError> {
        if !(e.iter().all(|e| e.is_finite()) && q.iter().all(|q| q.is_finite())) {
            return Err(EvalError::recoverable(MODEL, "a displacement is not finite"));
        }
        // Work arrays and a gap of the same side: taken apart for the while.
        let mut gap = std::mem::take(if trial { &mut self.trial } else { &mut self.now });
        self.open_gap(&mut gap, e, q);
        let outcome = self.fill_gap(&mut gap, speed);
        *(if trial { &mut self.trial } else { &mut self.now }) = gap;
        outcome
    }

    /// The film in a gap that is open, and what depends on it.
    fn fill_gap(&mut self, gap: &mut Gap, speed: f64) -> Result<(), EvalError> {
        gap.smallest = least(&gap.h);
        if gap.smallest < -DEEPEST {
            let what = format!("the skirt would stand {:.0} um inside the liner", -1e6 * gap.smallest);
            return Err(EvalError::recoverable(MODEL, what));
        }
        if self.rough.is_smooth() {
            self.smooth_film(gap)
        } else {
            self.rough_film(gap)?
        }
        if let Some(kept) = &self.kept {
            let n = gap.h.len();
            gap.fill.resize(n, 1.0);
            gap.engaged.resize(n, 1.0);
            kept.fill(room_of(&gap.flow, gap.is_rough), &mut gap.fill, &mut gap.engaged);
        }
        self.axial_levers(gap);
        self.thin(gap, speed)?;
        if self.is_full() {
            gap.full_drag = self.over.full_drag(gap);
        }
        Ok(())
    }

    /// Distance of the surfaces at nodes and faces.
    fn open_gap(&mut self, gap: &mut Gap, e: [f64; 2], q: &[f64]) {
        let n = self.nodes.len();
        let (c, top, bottom) = (self.clearance, self.sign * e[0], self.sign * e[1]);
        widest(Tilted { nodes: &self.nodes, c, top, bottom, gap });
        if !self.drop[0].is_empty() {
            for (f, d) in [(&mut gap.h, 0), (&mut gap.face_x, 1), (&mut gap.face_y, 2)] {
                f.iter_mut().zip(&self.drop[d]).for_each(|(f, d)| *f += d);
            }
        }
        for (m, q) in q.iter().enumerate() {
            let shapes = [
                &self.shapes[(2 + m) * n..(3 + m) * n],
                &self.face_shapes[0][m * n..(m + 1) * n],
                &self.face_shapes[1][m * n..(m + 1) * n],
            ];
            for (f, shape) in [&mut gap.h, &mut gap.face_x, &mut gap.face_y].into_iter().zip(shapes) {
                f.iter_mut().zip(shape).for_each(|(f, s)| *f += q * s);
            }
        }
    }

    /// Film between smooth surfaces; the axial lever of the pressure into `work[0]`.
    fn smooth_film(&mut self, gap: &mut Gap) {
        let floor = self.floor;
        let held = |h: f64| held_above(h, floor);
        let lever = &mut self.work[0];
        for k in 0..lever.len() {
            let film = held(gap.h[k]);
            gap.flow.film[k] = film;
            gap.flow.transport[k] = film;
            gap.flow.content_derivative[k] = 1.0;
            gap.drag[k] = 1.0 / film;
            lever[k] = film;
        }
        if gap.smallest < 2.0 * floor {
            gap.face_x.iter_mut().chain(&mut gap.face_y).for_each(|h| *h = held(*h));
        }
    }

    /// Film between rough surfaces; the axial lever of the pressure into `work[0]`.
    fn rough_film(&mut self, gap: &mut Gap) -> Result<(), EvalError> {
        self.rough.flow(&gap.h, &mut gap.flow)?;
        self.rough.shear(&gap.h, &mut self.shear)?;
        let (shear, lever) = (&self.shear, &mut self.work[0][..]);
        widest(Stresses { shear, drag: &mut gap.drag, lever });
        if widest(Differ(&gap.flow.film, &gap.h)) {
            // Where the model holds the film above contact, it does so between the nodes too.
            for k in 0..self.nodes.len() {
                let (east, north) = self.nodes.next(k);
                let (film, h) = (&gap.flow.film, &gap.h);
                let raise = |a: usize, b: usize| 0.5 * ((film[a] - h[a]) + (film[b] - h[b]));
                let least = |a: usize, b: usize| 0.5 * film[a].min(film[b]);
                gap.face_x[k] = (gap.face_x[k] + raise(k, east)).max(least(k, east));
                gap.face_y[k] = (gap.face_y[k] + raise(k, north)).max(least(k, north));
            }
        }
        Ok(())
    }

    /// Axial force per pressure of every node, from the levers in `work[0]`.
    fn axial_levers(&mut self, gap: &mut Gap) {
        let [own, mean, _] = &mut self.work;
        widest(Levers { nodes: &self.nodes, arm: &self.over.arm, own, mean, gap });
    }

    /// Viscosity that falls with the shear rate of sliding.
    fn thin(&mut self, gap: &mut Gap, speed: f64) -> Result<(), EvalError> {
        let Some(model) = &self.thinning else { return Ok(()) };
        let [rate, slope, _] = &mut self.work;
        gap.thinning.resize(rate.len(), 1.0);
        for (rate, film) in rate.iter_mut().zip(&gap.flow.film) {
            *rate = speed / film;
        }
        model.factor(rate, &mut gap.thinning, slope)?;
        gap.drag.iter_mut().zip(&gap.thinning).for_each(|(d, t)| *d *= t);
        Ok(())
    }
}

/// Distance of the surfaces of a cylinder whose edges are displaced towards the liner by `top` and `bottom`, at nodes and faces.
struct Tilted<'a> {
    nodes: &'a Nodes,
    c: f64,
    top: f64,
    bottom: f64,
    gap: &'a mut Gap,
}

impl Vectorised for Tilted<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { nodes, c, top, bottom, gap } = self;
        let nx = nodes.nx;
        let (s, s_face) = (&nodes.s[..nx], &nodes.s_face[..nx]);
        for (j, (cos, cos_face)) in nodes.cos.iter().zip(&nodes.cos_face).enumerate() {
            let line = j * nx..(j + 1) * nx;
            let (h, x, y) = (&mut gap.h[line.clone()], &mut gap.face_x[line.clone()], &mut gap.face_y[line]);
            for i in 0..nx {
                let own = between(top, bottom, s[i]);
                h[i] = c + own * cos;
                x[i] = c + between(top, bottom, s_face[i]) * cos;
                y[i] = c + own * cos_face;
            }
        }
    }
}

/// Drag of a film between rough surfaces per viscosity and speed, and the axial lever of its pressure.
struct Stresses<'a> {
    shear: &'a RoughShear,
    drag: &'a mut [f64],
    lever: &'a mut [f64],
}

impl Vectorised for Stresses<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let RoughShear { film, phi_f, phi_fs, phi_fp } = self.shear;
        for (((drag, f), fs), film) in self.drag.iter_mut().zip(phi_f).zip(phi_fs).zip(film) {
            *drag = (f + fs) / film;
        }
        for ((lever, fp), film) in self.lever.iter_mut().zip(phi_fp).zip(film) {
            *lever = fp * film;
        }
    }
}

/// Whether two fields differ.
struct Differ<'a>(&'a [f64], &'a [f64]);

impl Vectorised for Differ<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let mut differ = false;
        for (a, b) in self.0.iter().zip(self.1) {
            differ |= a != b;
        }
        differ
    }
}

/// Axial force per pressure of every node, and the same times `R cos φ`, from the levers `own` of the nodes.
struct Levers<'a> {
    nodes: &'a Nodes,
    arm: &'a [f64],
    own: &'a [f64],
    mean: &'a mut [f64],
    gap: &'a mut Gap,
}

impl Vectorised for Levers<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { nodes, arm, own, mean, gap } = self;
        let nx = nodes.nx;
        // Half the mean of both neighbours, for the face before and for the face after; none beyond the ends of a line.
        let mean = &mut mean[..=nx];
        (mean[0], mean[nx]) = (0.0, 0.0);
        for (j, (weight, arm)) in nodes.line_weight.iter().zip(arm).enumerate() {
            let line = j * nx..(j + 1) * nx;
            let own = &own[line.clone()];
            for i in 1..nx {
                mean[i] = 0.5 * (own[i - 1] + own[i]);
            }
            let w = 0.5 * weight;
            let (lever, moment) = (&mut gap.lever[line.clone()], &mut gap.moment[line]);
            for i in 0..nx {
                lever[i] = w * (mean[i] - mean[i + 1]);
                moment[i] = lever[i] * arm;
            }
        }
    }
}
