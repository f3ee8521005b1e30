//! Vectors in blocks of one length. States are few: a loop over them costs as much for its remainder as for its numbers, and one over a block has none.

/// Numbers of a block.
pub(super) const WIDTH: usize = 8;
pub(super) type Block = [f64; WIDTH];

/// A vector of zeros with room for `len` numbers. What is beyond them stays zero.
pub(super) fn zeros(len: usize) -> Vec<Block> {
    vec![[0.0; WIDTH]; len.div_ceil(WIDTH)]
}

/// Sets the first numbers of a vector.
pub(super) fn set(x: &mut [Block], values: &[f64]) {
    x.as_flattened_mut()[..values.len()].copy_from_slice(values);
}

/// `x += a u`.
#[inline]
pub(super) fn add(x: &mut Block, a: f64, u: &Block) {
    for i in 0..WIDTH {
        x[i] += a * u[i];
    }
}

/// The largest of `|v_i| per_i`; NaN when one of them is.
#[inline]
pub(super) fn norm(v: &[Block], per: &[Block]) -> f64 {
    let mut most = [0.0; WIDTH];
    for (v, per) in v.iter().zip(per) {
        for i in 0..WIDTH {
            most[i] = larger(most[i], (v[i] * per[i]).abs());
        }
    }
    let four: [f64; 4] = std::array::from_fn(|i| larger(most[i], most[i + 4]));
    larger(larger(four[0], four[2]), larger(four[1], four[3]))
}

/// The larger of two numbers; a NaN wins.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if b <= a || a.is_nan() { a } else { b }
}
