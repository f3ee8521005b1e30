//! Loops in the widest vector instructions that the processor at hand is known to have.
//!
//! A program for x86-64 may use no more than vectors of two numbers. Nearly every processor has those of four (AVX2), in which a loop over neighbouring numbers takes half the
//! instructions. Such a loop is compiled twice, and the processor decides which of the two runs. Both give the same bits: the compiler neither
//! changes the order of operations nor makes one rounding of two.

/// Something with loops over neighbouring numbers.
pub trait Vectorised {
    /// What it gives.
    type Output;

    /// Runs it. Whatever has such loops must be `#[inline(always)]`, this method too: what stays a function of its own is compiled once, for vectors of two.
    /// That may be the closure of a `fold` or `for_each`: plain loops are safe.
    fn run(self) -> Self::Output;
}

/// Runs `work` in the widest vectors.
///
/// ```
/// use gudgeon_numerics::vectors::{Vectorised, widest};
///
/// struct Scale<'a>(&'a mut [f64], f64);
/// impl Vectorised for Scale<'_> {
///     type Output = ();
///     #[inline(always)]
///     fn run(self) {
///         for x in self.0 {
///             *x *= self.1;
///         }
///     }
/// }
///
/// let mut x = [1.0, 2.0, 3.0, 4.0];
/// widest(Scale(&mut x, 0.5));
/// assert_eq!(x, [0.5, 1.0, 1.5, 2.0]);
/// ```
#[inline]
pub fn widest<W: Vectorised>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if std::is_x86_feature_detected!("avx2") {
        // The one requirement is that the processor has these instructions, which was asked just before.
        #[allow(unsafe_code)]
        return unsafe { in_fours(work) };
    }
    work.run()
}

/// Compiled for vectors of four numbers.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn in_fours<W: Vectorised>(work: W) -> W::Output {
    work.run()
}

/// Whether all numbers are finite.
#[must_use]
pub fn all_finite(values: &[f64]) -> bool {
    widest(Finite(values))
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

/// The least of some numbers, none of which is NaN; infinite when there are none.
#[inline(always)]
#[must_use]
pub fn least(values: &[f64]) -> f64 {
    let mut least = [f64::INFINITY; 8];
    let (whole, rest) = values.as_chunks::<8>();
    for values in whole {
        for l in 0..8 {
            least[l] = if values[l] < least[l] { values[l] } else { least[l] };
        }
    }
    least.into_iter().chain(rest.iter().copied()).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
}
