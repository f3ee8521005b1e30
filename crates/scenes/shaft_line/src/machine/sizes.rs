//! Sizes of the numbers of an answer, many at once.

use gudgeon_core::kinds::OrderResponses;
use gudgeon_numerics::elementary;
use gudgeon_numerics::vectors::{Vectorised, widest};

/// Whether all numbers are finite.
pub(super) fn all_finite(values: &[f64]) -> bool {
    widest(Finite(values))
}

/// Torque amplitudes by link and order \[N m\].
pub(super) fn torque_amplitudes(orders: &OrderResponses) -> Vec<f64> {
    /// Numbers whose squares are far from the smallest and the largest of all.
    const SQUARED: (f64, f64) = (1e-150, 1e150);
    let [_, _, re, im] = orders.values();
    let mut out = vec![0.0; re.len()];
    widest(Moduli { re, im, out: &mut out });
    if !out.iter().fold(true, |all, size| all & (*size > SQUARED.0) & (*size < SQUARED.1)) {
        let parts = re.iter().zip(im);
        out.iter_mut().zip(parts).for_each(|(size, (re, im))| *size = elementary::hypot(*re, *im));
    }
    out
}

/// Sum over the orders of a bound of the largest angle \[rad\] of the inertias, times the order and alone.
pub(super) fn largest_angles(orders: &OrderResponses, nodes: usize) -> [f64; 2] {
    let mut most = vec![0.0; orders.len()];
    widest(Largest { orders, nodes, most: &mut most });
    let mut sums = [0.0; 2];
    for (order, most) in orders.orders().iter().zip(most) {
        sums = [sums[0] + order * (2.0 * most), sums[1] + 2.0 * most];
    }
    sums
}

/// Zero times any number that is not finite is not zero: no branch for each of them.
struct Finite<'v>(&'v [f64]);

impl Vectorised for Finite<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let mut sums = [0.0; 8];
        let (whole, rest) = self.0.as_chunks::<8>();
        for values in whole {
            for l in 0..8 {
                sums[l] += 0.0 * values[l];
            }
        }
        sums == [0.0; 8] && rest.iter().all(|v| v.is_finite())
    }
}

struct Moduli<'v> {
    re: &'v [f64],
    im: &'v [f64],
    out: &'v mut [f64],
}

impl Vectorised for Moduli<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for ((size, re), im) in self.out.iter_mut().zip(self.re).zip(self.im) {
            *size = (re * re + im * im).sqrt();
        }
    }
}

/// Largest part of the angles, by order.
struct Largest<'v> {
    orders: &'v OrderResponses,
    nodes: usize,
    most: &'v mut [f64],
}

impl Vectorised for Largest<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for part in (0..self.nodes).flat_map(|i| self.orders.angle(i)) {
            for (most, x) in self.most.iter_mut().zip(part) {
                *most = if x.abs() > *most { x.abs() } else { *most };
            }
        }
    }
}
