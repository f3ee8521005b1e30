//! A face in one sliding direction, with what its searches remember of the last film.

use super::flow::{Flow, Island};
use super::moments::Moments;
use super::shape::Shape;

/// Where the last cavity was and at which squeeze velocity, and how its ends move with that: a start for the next search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Warm {
    pub v: f64,
    pub xr: f64,
    pub xf: f64,
    pub xr_v: f64,
    pub xf_v: f64,
}

/// A place and the integrals of the film between it and the edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Anchor {
    pub i: usize,
    pub x: f64,
    pub m: Moments,
}

/// What a search is asked for: the film at a squeeze velocity, or that under a load. Each starts where it ended last; a ring
/// that does not move as its film asks has two different films.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ask {
    Rate = 0,
    Load = 1,
}

/// A face in one sliding direction.
#[derive(Debug)]
pub(super) struct Side<S> {
    pub face: S,
    pub islands: Vec<Island>,
    /// Where the search for either began and the safe search begins.
    pub warm: Option<Warm>,
    pub starts: [Option<Warm>; 2],
    /// Ends of films of the present thickness.
    pub lead: Option<Anchor>,
    pub trail: Option<Anchor>,
    /// Where the full film was cut last, and the last squeeze velocity of one.
    pub cuts: [f64; 2],
    pub v_cut: Option<f64>,
    /// Where the part of the face that is covered with oil begins.
    pub from: f64,
}

impl<S: Shape> Side<S> {
    pub(super) fn new(face: S) -> Self {
        let islands = Vec::with_capacity(2 * face.pieces() + 2);
        Self {
            face,
            islands,
            warm: None,
            starts: [None; 2],
            lead: None,
            trail: None,
            cuts: [f64::NAN; 2],
            v_cut: None,
            from: 0.0,
        }
    }

    /// Confines the film to the face between `from` and `to` of the whole.
    pub(super) fn set_extent(&mut self, from: f64, to: f64) {
        self.face.crop(from, to);
        (self.lead, self.trail) = (None, None);
        // Places of the last film, seen from the new beginning.
        let (shift, len) = (self.from - from, to - from);
        for start in &mut self.starts {
            *start = start
                .map(|w| Warm { xr: w.xr + shift, xf: (w.xf + shift).min(len), ..w })
                .filter(|w| w.xr > 0.0 && w.xr < len && w.xf > w.xr);
        }
        self.warm = None;
        self.cuts = [f64::NAN; 2];
        self.from = from;
    }

    /// Tilts the face; the search of the next film starts anew.
    pub(super) fn tilt(&mut self, angle: f64) -> bool {
        (self.lead, self.trail, self.warm) = (None, None, None);
        self.starts = Default::default();
        self.cuts = [f64::NAN; 2];
        self.face.tilt(angle)
    }

    pub(super) fn set_film(&mut self, h: f64) {
        if self.face.film().to_bits() != h.to_bits() {
            self.face.set_film(h);
            (self.lead, self.trail) = (None, None);
        }
    }

    /// Integrals from 0 to `x` in piece `i`.
    // Inlined so that no caller sums what it does not use.
    #[inline(always)]
    pub(super) fn lead_to(&mut self, i: usize, x: f64) -> Moments {
        if let Some(a) = &self.lead
            && a.i == i
            && let Some(m) = self.face.nearby(&a.m, x, i, a.x, x)
        {
            return m;
        }
        self.lead_anew(i, x)
    }

    #[inline(never)]
    pub(super) fn lead_anew(&mut self, i: usize, x: f64) -> Moments {
        let m = self.face.span(0, 0.0, i, x);
        self.lead = Some(Anchor { i, x, m });
        m
    }

    /// Integrals from `x` in piece `i` to the end.
    #[inline(always)]
    pub(super) fn trail_from(&mut self, i: usize, x: f64) -> Moments {
        if let Some(a) = &self.trail
            && a.i == i
            && let Some(m) = self.face.nearby(&a.m, self.face.length() - x, i, x, a.x)
        {
            return m;
        }
        self.trail_anew(i, x)
    }

    #[inline(never)]
    pub(super) fn trail_anew(&mut self, i: usize, x: f64) -> Moments {
        let m = self.face.span(i, x, self.face.pieces() - 1, self.face.length());
        self.trail = Some(Anchor { i, x, m });
        m
    }

    /// `U d + V s - q`, the pressure gradient times `h³`.
    #[inline]
    pub(super) fn n(&self, f: &Flow, i: usize, x: f64, q: f64) -> f64 {
        f.u * self.face.drop(i, x) + f.v * self.face.s(x) - q
    }

    pub(super) fn full_q(&mut self, f: &Flow) -> f64 {
        let w = self.face.whole();
        (f.pa - f.pb + f.u * w.d2 + f.v * w.x3) / w.i3
    }
}
