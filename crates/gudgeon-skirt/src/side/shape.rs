//! The gap of one side at a place, and what of its film depends on the place alone.

use gudgeon_core::EvalError;

use super::gap::{Gap, held_above};
use super::kept::room_of;
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
        gap.smallest = gap.h.iter().fold(f64::INFINITY, |a, &b| a.min(b));
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
            gap.full_drag = self.over.drag(&self.nodes, gap, &self.fill);
        }
        Ok(())
    }

    /// Distance of the surfaces at nodes and faces.
    fn open_gap(&mut self, gap: &mut Gap, e: [f64; 2], q: &[f64]) {
        let nodes = &self.nodes;
        let (nx, n) = (nodes.nx, nodes.len());
        let (c, top, bottom) = (self.clearance, self.sign * e[0], self.sign * e[1]);
        let [own, next, _] = &mut self.work;
        let (own, next) = (&mut own[..nx], &mut next[..nx]);
        own.iter_mut().zip(&nodes.s).for_each(|(d, s)| *d = between(top, bottom, *s));
        next.iter_mut().zip(&nodes.s_face).for_each(|(d, s)| *d = between(top, bottom, *s));
        let lines = gap.h.chunks_exact_mut(nx).zip(gap.face_x.chunks_exact_mut(nx));
        for (((h, fx), fy), (cos, cos_next)) in
            lines.zip(gap.face_y.chunks_exact_mut(nx)).zip(nodes.cos.iter().zip(&nodes.cos_face))
        {
            h.iter_mut().zip(&*own).for_each(|(h, d)| *h = c + d * cos);
            fx.iter_mut().zip(&*next).for_each(|(h, d)| *h = c + d * cos);
            fy.iter_mut().zip(&*own).for_each(|(h, d)| *h = c + d * cos_next);
        }
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
        let (shear, lever) = (&self.shear, &mut self.work[0]);
        let factors = shear.phi_f.iter().zip(&shear.phi_fs).zip(&shear.film);
        gap.drag.iter_mut().zip(factors).for_each(|(drag, ((f, fs), film))| *drag = (f + fs) / film);
        let pressed = shear.phi_fp.iter().zip(&shear.film);
        lever.iter_mut().zip(pressed).for_each(|(lever, (fp, film))| *lever = fp * film);
        if gap.flow.film.iter().zip(&gap.h).any(|(f, h)| f != h) {
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
        let nx = self.nodes.nx;
        let [own, mean, _] = &mut self.work;
        // Half the mean of both neighbours, for the face before and for the face after; none beyond the ends of a line.
        let mean = &mut mean[..=nx];
        (mean[0], mean[nx]) = (0.0, 0.0);
        let lines = gap.lever.chunks_exact_mut(nx).zip(gap.moment.chunks_exact_mut(nx));
        let nodes = self.nodes.line_weight.iter().zip(&self.over.arm).zip(own.chunks_exact(nx));
        for ((lever, moment), ((weight, arm), own)) in lines.zip(nodes) {
            mean[1..nx].iter_mut().zip(own.iter().zip(&own[1..])).for_each(|(m, (a, b))| *m = 0.5 * (a + b));
            let w = 0.5 * weight;
            let faces = mean.iter().zip(&mean[1..]);
            for ((lever, moment), (before, after)) in lever.iter_mut().zip(moment).zip(faces) {
                *lever = w * (before - after);
                *moment = *lever * arm;
            }
        }
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
