//! Vectors in blocks of one length. States are few: a loop over them costs as much for its remainder as for its numbers, and one over a block has none.

/// Numbers of a block.
pub(super) const WIDTH: usize = 8;
pub(super) type Block = [f64; WIDTH];
pub(super) const ZERO: Block = [0.0; WIDTH];

/// A vector of zeros with room for `len` numbers. What is beyond them stays zero.
pub(super) fn zeros(len: usize) -> Vec<Block> {
    vec![ZERO; len.div_ceil(WIDTH)]
}

/// `x += a u`.
#[inline]
pub(super) fn add(x: &mut Block, a: f64, u: &Block) {
    for i in 0..WIDTH {
        x[i] += a * u[i];
    }
}

/// The largest of `|v_i| per_i` that are numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Norm(Block);

impl Norm {
    pub const ZERO: Self = Self(ZERO);

    #[inline]
    pub fn add(&mut self, v: &Block, per: &Block) {
        for i in 0..WIDTH {
            self.0[i] = larger((v[i] * per[i]).abs(), self.0[i]);
        }
    }

    #[inline]
    pub fn value(&self) -> f64 {
        reduced(&self.0, larger)
    }
}

/// A sum that is NaN where a number of it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sum(Block);

impl Sum {
    pub const ZERO: Self = Self(ZERO);

    #[inline]
    pub fn add(&mut self, v: &Block) {
        add(&mut self.0, 1.0, v);
    }

    #[inline]
    pub fn value(&self) -> f64 {
        reduced(&self.0, |a, b| a + b)
    }
}

/// The larger of two numbers; the second when one is NaN.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline]
fn reduced(x: &Block, f: impl Fn(f64, f64) -> f64) -> f64 {
    let four: [f64; 4] = std::array::from_fn(|i| f(x[i], x[i + 4]));
    f(f(four[0], four[2]), f(four[1], four[3]))
}
