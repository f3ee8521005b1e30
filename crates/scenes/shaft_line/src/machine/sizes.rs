//! Sizes of the numbers of an answer, many at once.

use gudgeon_core::kinds::{OrderResponses, PhasorRow};
use gudgeon_numerics::elementary;
use gudgeon_numerics::vectors::{Vectorised, widest};

/// Torque amplitudes by link and order \[N m\].
pub(super) fn torque_amplitudes(orders: &OrderResponses) -> Vec<f64> {
    let [_, _, re, im] = orders.values();
    let mut out = vec![0.0; re.len()];
    if !widest(Moduli { re, im, out: &mut out }) {
        let parts = re.iter().zip(im);
        out.iter_mut().zip(parts).for_each(|(size, (re, im))| *size = elementary::hypot(*re, *im));
    }
    out
}

/// Order of the largest of some phasors, the last of several; zero without any.
pub(super) fn strongest(orders: &[f64], phasors: PhasorRow<'_>) -> f64 {
    widest(Strongest { orders, phasors })
}

/// Takes the larger of each two numbers.
pub(crate) fn raise(most: &mut [f64], by: &[f64]) {
    widest(Raise { most, by });
}

/// Bounds of the angle \[rad\] of each inertia, times the order and alone: the sums over all orders and inertias.
pub(super) fn angle_bounds(orders: &OrderResponses, nodes: usize) -> [f64; 2] {
    widest(Bounds { orders, nodes })
}

/// Numbers side by side.
const LANES: usize = 4;
/// Numbers whose squares are far from the smallest and the largest of all.
const SQUARED: (f64, f64) = (1e-150, 1e150);

/// Whether all of the moduli are [`SQUARED`].
struct Moduli<'v> {
    re: &'v [f64],
    im: &'v [f64],
    out: &'v mut [f64],
}

impl Vectorised for Moduli<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        for ((size, re), im) in self.out.iter_mut().zip(self.re).zip(self.im) {
            *size = (re * re + im * im).sqrt();
        }
        let (mut least, mut most) = ([f64::INFINITY; LANES], [0.0; LANES]);
        let (whole, rest) = self.out.as_chunks::<LANES>();
        for sizes in whole {
            for l in 0..LANES {
                least[l] = if sizes[l] < least[l] { sizes[l] } else { least[l] };
            }
            for l in 0..LANES {
                most[l] = if sizes[l] > most[l] { sizes[l] } else { most[l] };
            }
        }
        let squared = |size: &f64| *size > SQUARED.0 && *size < SQUARED.1;
        (whole.is_empty() || least.iter().all(|s| *s > SQUARED.0) && most.iter().all(|s| *s < SQUARED.1))
            && rest.iter().all(squared)
    }
}

struct Strongest<'v> {
    orders: &'v [f64],
    phasors: PhasorRow<'v>,
}

impl Vectorised for Strongest<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let [re, im] = self.phasors;
        let ((whole_re, rest_re), (whole_im, rest_im)) = (re.as_chunks::<LANES>(), im.as_chunks::<LANES>());
        let (orders, rest_orders) = self.orders.as_chunks::<LANES>();
        let rest = || rest_re.iter().zip(rest_im).map(|(re, im)| re * re + im * im);
        let mut most = [0.0; LANES];
        for (re, im) in whole_re.iter().zip(whole_im) {
            for l in 0..LANES {
                let square = re[l] * re[l] + im[l] * im[l];
                most[l] = if square > most[l] { square } else { most[l] };
            }
        }
        let most = rest().chain(most).fold(0.0, f64::max);
        // Orders ascend: of equals the last is the largest.
        if let Some((_, order)) = rest().zip(rest_orders).rfind(|(square, _)| *square == most) {
            return *order;
        }
        let mut order = [0.0; LANES];
        for ((own, re), im) in orders.iter().zip(whole_re).zip(whole_im) {
            for l in 0..LANES {
                let square = re[l] * re[l] + im[l] * im[l];
                order[l] = if square == most { own[l] } else { order[l] };
            }
        }
        order.into_iter().fold(0.0, f64::max)
    }
}

struct Raise<'v> {
    most: &'v mut [f64],
    by: &'v [f64],
}

impl Vectorised for Raise<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (most, own) in self.most.iter_mut().zip(self.by) {
            *most = if *own > *most { *own } else { *most };
        }
    }
}

struct Bounds<'v> {
    orders: &'v OrderResponses,
    nodes: usize,
}

impl Vectorised for Bounds<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run(self) -> [f64; 2] {
        let (whole, rest) = self.orders.orders().as_chunks::<LANES>();
        let (mut rates, mut angles) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..self.nodes {
            let [re, im] = self.orders.angle(i);
            let (re, im) = (re.as_chunks::<LANES>(), im.as_chunks::<LANES>());
            for ((order, re), im) in whole.iter().zip(re.0).zip(im.0) {
                let mut size = [0.0; LANES];
                for l in 0..LANES {
                    size[l] = re[l].abs() + im[l].abs();
                }
                for l in 0..LANES {
                    rates[l] += order[l] * size[l];
                }
                for l in 0..LANES {
                    angles[l] += size[l];
                }
            }
            for ((order, re), im) in rest.iter().zip(re.1).zip(im.1) {
                let size = re.abs() + im.abs();
                (rates[0], angles[0]) = (rates[0] + order * size, angles[0] + size);
            }
        }
        totals(&rates, &angles)
    }
}

/// The sums of all lanes. A function of its own: beside the loops the compiler would add the two sums side by side instead of the lanes.
#[inline(never)]
fn totals(a: &[f64; LANES], b: &[f64; LANES]) -> [f64; 2] {
    [a.iter().sum(), b.iter().sum()]
}
