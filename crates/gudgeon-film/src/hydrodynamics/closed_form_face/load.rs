//! Load and pressure of the films found last.

use super::flow::{Flow, Island};
use super::moments::PressureMoments;
use super::shape::Shape;
use super::side::Side;

/// Load over `12 μ`, its derivative, and the size of the terms it was summed from.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Carried {
    pub load: f64,
    pub rate: f64,
    pub size: f64,
}

impl<S: Shape> Side<S> {
    /// Load over `12 μ` of the films found last.
    pub(super) fn carried(&self, f: &Flow) -> Carried {
        let mut c = Carried::default();
        for l in &self.islands {
            self.carry(f, l, &mut c);
        }
        c
    }

    #[inline]
    pub(super) fn carry(&self, f: &Flow, l: &Island, c: &mut Carried) {
        let m = &l.m;
        let (sa, sb) = (self.face.s(l.xa), self.face.s(l.xb));
        // Integration by parts: ∫p dx = [s p] - ∫ s p' dx.
        let (edge, wedge, squeeze, flux) = (sb * l.pb - sa * l.pa, f.u * m.e2, f.v * m.xx3, l.q * m.x3);
        c.load += edge - (wedge + squeeze - flux);
        c.size += edge.abs() + wedge.abs() + squeeze.abs() + flux.abs();
        c.rate += sb * l.rb - sa * l.ra - (m.xx3 - l.w * m.x3);
    }

    /// Pressure over `12 μ` at `x`; zero outside the films.
    pub(super) fn pressure(&self, f: &Flow, i: usize, x: f64) -> f64 {
        for l in &self.islands {
            if x >= l.xa && x <= l.xb {
                return self.pressure_in(f, l, i, x);
            }
        }
        0.0
    }

    pub(super) fn pressure_in(&self, f: &Flow, l: &Island, i: usize, x: f64) -> f64 {
        if x >= l.xb {
            l.pb
        } else if x <= l.xa {
            l.pa
        } else if l.upwards {
            l.pa + self.face.front(i, x).rise(f.u, f.v, l.q)
        } else {
            let end = if l.xb >= self.face.length() {
                PressureMoments::default()
            } else {
                self.face.tail(l.ib, l.xb)
            };
            l.pb - self.face.tail(i, x).minus(end).rise(f.u, f.v, l.q)
        }
    }
}
