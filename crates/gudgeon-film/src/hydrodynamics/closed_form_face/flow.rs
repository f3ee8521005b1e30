//! The problem of one film and the stretches of full film that solve it.

use super::moments::Moments;

/// One film problem in the frame where the liner moves along `+x` (`u >= 0`). Pressures are above `p_cav`, over `12 μ`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flow {
    /// Half the sliding velocity.
    pub u: f64,
    pub v: f64,
    pub pa: f64,
    pub pb: f64,
}

/// A stretch of full film: flux law `q0 - v s` with `q0 = q + u h`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Island {
    pub ia: usize,
    pub xa: f64,
    pub pa: f64,
    pub ib: usize,
    pub xb: f64,
    pub pb: f64,
    pub q: f64,
    /// `∂q/∂v`
    pub w: f64,
    /// `∂p/∂v` at the ends.
    pub ra: f64,
    pub rb: f64,
    /// The film begins at 0, and its pressure is counted from there; otherwise from the upper end.
    pub upwards: bool,
    pub m: Moments,
}
