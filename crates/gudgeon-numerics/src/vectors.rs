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
    let (whole, rest) = values.as_chunks();
    widest(Zeros(whole)) == [0.0; LANES] && rest.iter().all(|v| v.is_finite())
}

/// The least of some numbers, none of which is NaN; infinite when there are none.
#[must_use]
pub fn least(values: &[f64]) -> f64 {
    let (whole, rest) = values.as_chunks();
    let lesser = |a: f64, b: f64| if b < a { b } else { a };
    widest(Least(whole)).into_iter().chain(rest.iter().copied()).fold(f64::INFINITY, lesser)
}

/// The least of some numbers when all are finite, infinite when there are none; nothing when one is not finite.
#[must_use]
pub fn finite_least(values: &[f64]) -> Option<f64> {
    let (whole, rest) = values.as_chunks();
    let [zeros, lowest] = widest(FiniteLeast(whole));
    let is_finite = zeros == [0.0; LANES] && rest.iter().all(|v| v.is_finite());
    let lesser = |a: f64, b: f64| if b < a { b } else { a };
    is_finite.then(|| lowest.into_iter().chain(rest.iter().copied()).fold(f64::INFINITY, lesser))
}

/// Inner products of a field with others of its length, each in [`PARTS`] partial sums.
///
/// # Panics
/// When one of the others is shorter: a mistake of the program.
#[must_use]
pub fn dots<const N: usize>(of: &[f64], with: [&[f64]; N]) -> [f64; N] {
    let (whole, rest) = of.as_chunks();
    let n = whole.len() * PARTS;
    let parts = widest(Dots { of: whole, with: with.map(|field| field[..n].as_chunks().0) });
    let mut sums = [0.0; N];
    for ((sum, s), field) in sums.iter_mut().zip(parts).zip(with) {
        let last: f64 = rest.iter().zip(&field[n..]).map(|(a, b)| a * b).sum();
        *sum = ((s[0] + s[1]) + (s[2] + s[3])) + last;
    }
    sums
}

/// Numbers that are looked at side by side.
const LANES: usize = 8;
/// Partial sums of an inner product.
pub const PARTS: usize = 4;

// Lanes are returned as they are: what is stored side by side the compiler keeps side by side, what is added up at the end it does not.

/// Zero times every number: what is not finite leaves something else.
struct Zeros<'v>(&'v [[f64; LANES]]);

impl Vectorised for Zeros<'_> {
    type Output = [f64; LANES];

    #[inline(always)]
    fn run(self) -> [f64; LANES] {
        let mut sums = [0.0; LANES];
        for values in self.0 {
            for l in 0..LANES {
                sums[l] += 0.0 * values[l];
            }
        }
        sums
    }
}

struct Least<'v>(&'v [[f64; LANES]]);

impl Vectorised for Least<'_> {
    type Output = [f64; LANES];

    #[inline(always)]
    fn run(self) -> [f64; LANES] {
        let mut least = [f64::INFINITY; LANES];
        for values in self.0 {
            for l in 0..LANES {
                least[l] = if values[l] < least[l] { values[l] } else { least[l] };
            }
        }
        least
    }
}

/// Both.
struct FiniteLeast<'v>(&'v [[f64; LANES]]);

impl Vectorised for FiniteLeast<'_> {
    type Output = [[f64; LANES]; 2];

    #[inline(always)]
    fn run(self) -> [[f64; LANES]; 2] {
        let mut out = [[0.0; LANES], [f64::INFINITY; LANES]];
        for values in self.0 {
            for l in 0..LANES {
                out[0][l] += 0.0 * values[l];
                out[1][l] = if values[l] < out[1][l] { values[l] } else { out[1][l] };
            }
        }
        out
    }
}

struct Dots<'v, const N: usize> {
    of: &'v [[f64; PARTS]],
    with: [&'v [[f64; PARTS]]; N],
}

impl<const N: usize> Vectorised for Dots<'_, N> {
    type Output = [[f64; PARTS]; N];

    #[inline(always)]
    fn run(self) -> [[f64; PARTS]; N] {
        let Self { of, mut with } = self;
        for field in &mut with {
            *field = &field[..of.len()];
        }
        let mut parts = [[0.0; PARTS]; N];
        for k in 0..of.len() {
            for f in 0..N {
                for l in 0..PARTS {
                    parts[f][l] += with[f][k][l] * of[k][l];
                }
            }
        }
        parts
    }
}
