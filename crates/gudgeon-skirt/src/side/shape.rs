//! The gap of one side at a place, and what of its film depends on the place alone.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::RoughShear;
use gudgeon_numerics::vectors::{Vectorised, least, widest};

use super::gap::{Gap, held_above};
use super::kept::room_of;
use super::{MODEL, Side};

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
            gap.full_drag = self.over.drag(&gap.drag);
        }
        Ok(())
    }

    /// Distance of the surfaces at nodes and faces.
    fn open_gap(&mut self, gap: &mut Gap, e: [f64; 2], q: &[f64]) {
        let [x, y] = &self.face_shapes;
        let fields = [&mut gap.h, &mut gap.face_x, &mut gap.face_y].into_iter().zip([&self.shapes, x, y]);
        for ((out, shapes), drop) in fields.zip(&self.drop) {
            widest(Opened { c: self.clearance, e, q, shapes, drop, out });
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
        let [own, flow, _] = &mut self.work;
        let Gap { lever, moment, .. } = gap;
        widest(Levers { across: &self.over.across, arms: &self.over.arms, own, flow, lever, moment });
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

/// Distance of the surfaces: the clearance `c`, changed by the displacements `e` of both edges and the amplitudes `q` in their shapes, and the drop of the
/// profile where there is one.
struct Opened<'a> {
    c: f64,
    e: [f64; 2],
    q: &'a [f64],
    shapes: &'a [f64],
    drop: &'a [f64],
    out: &'a mut [f64],
}

impl Vectorised for Opened<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { c, e, q, shapes, drop, out } = self;
        let n = out.len();
        let (edges, elastic) = shapes.split_at(2 * n);
        let (top, bottom) = edges.split_at(n);
        for (h, (top, bottom)) in out.iter_mut().zip(top.iter().zip(bottom)) {
            *h = c + (e[0] * top + e[1] * bottom);
        }
        for (h, drop) in out.iter_mut().zip(drop) {
            *h += drop;
        }
        for (q, shape) in q.iter().zip(elastic.chunks_exact(n)) {
            for (h, s) in out.iter_mut().zip(shape) {
                *h += q * s;
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

/// Axial force per pressure of every node, and the same times `R cos φ`, from the levers `own` of the nodes: a pressure pushes against the slope of the film,
/// through the mean lever of the sides before and after its node.
struct Levers<'a> {
    /// A quarter of the width of the side to the next node; none at the end of a line.
    across: &'a [f64],
    /// `R cos φ`.
    arms: &'a [f64],
    own: &'a [f64],
    flow: &'a mut [f64],
    lever: &'a mut [f64],
    moment: &'a mut [f64],
}

impl Vectorised for Levers<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { across, arms, own, flow, lever, moment } = self;
        let last = own.len() - 1;
        for (flow, (width, (a, b))) in flow.iter_mut().zip(across.iter().zip(own.iter().zip(&own[1..]))) {
            *flow = width * (a + b);
        }
        flow[last] = 0.0;
        lever[0] = -flow[0];
        for (lever, (before, after)) in lever[1..].iter_mut().zip(flow.iter().zip(&flow[1..])) {
            *lever = before - after;
        }
        for (moment, (lever, arm)) in moment.iter_mut().zip(lever.iter().zip(arms)) {
            *moment = lever * arm;
        }
    }
}
