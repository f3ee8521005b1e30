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
