//! Options and array lengths that contradict the system, found before the first step.

use super::difference::all_finite;
use super::options::{IntegrateError, Options};
use super::system::{ColumnGroups, OdeSystem};

/// What an integrator was made for.
pub(crate) struct Shape<'a> {
    /// Number of states.
    pub n: usize,
    /// Number of quadratures.
    pub quad: usize,
    pub groups: Option<&'a ColumnGroups>,
}

type Check = Result<(), &'static str>;

fn refuse_if(bad: bool, what: &'static str) -> Check {
    if bad { Err(what) } else { Ok(()) }
}

/// Refuses what cannot be integrated.
pub(crate) fn check<S: OdeSystem + ?Sized>(
    shape: &Shape<'_>,
    sys: &S,
    interval: (f64, f64),
    breakpoints: &[f64],
    y: &[f64],
    q: &[f64],
    options: &Options,
) -> Result<(), IntegrateError> {
    start(shape, sys, interval, breakpoints, y, q)
        .and_then(|()| tolerances(shape, options))
        .and_then(|()| structure(shape, sys))
        .map_err(|what| IntegrateError::Input { what })
}

fn start<S: OdeSystem + ?Sized>(
    shape: &Shape<'_>,
    sys: &S,
    (t0, t1): (f64, f64),
    breakpoints: &[f64],
    y: &[f64],
    q: &[f64],
) -> Check {
    refuse_if(
        sys.dim() != shape.n || sys.quad_dim() != shape.quad,
        "the system's dimensions are not those the integrator was made for",
    )?;
    refuse_if(
        y.len() != shape.n || q.len() != shape.quad,
        "the state or the quadratures have the wrong length",
    )?;
    // Written so that a NaN fails.
    refuse_if(
        !(t0.is_finite() && t1.is_finite() && t1 >= t0),
        "the interval is not finite or runs backwards",
    )?;
    refuse_if(
        breakpoints.iter().any(|b| b.is_nan()) || breakpoints.windows(2).any(|w| w[1] < w[0]),
        "the breakpoints are not ascending",
    )?;
    refuse_if(!(all_finite(y) && all_finite(q)), "the initial state is not finite")
}

fn tolerances(shape: &Shape<'_>, o: &Options) -> Check {
    refuse_if(!(o.rtol >= 0.0 && o.rtol.is_finite()), "the relative tolerance is negative or not finite")?;
    let fits = |length: usize, n: usize| length == 0 || length == n;
    refuse_if(
        o.atol.len() != shape.n || !fits(o.absolute.len(), shape.n) || !fits(o.atol_quad.len(), shape.quad),
        "an absolute tolerance has the wrong length",
    )?;
    let all = o.atol.iter().chain(&o.atol_quad);
    refuse_if(
        all.clone().any(|a| !(*a >= 0.0 && a.is_finite())),
        "an absolute tolerance is negative or not finite",
    )?;
    refuse_if(
        all.clone().enumerate().any(|(i, a)| *a == 0.0 && o.relative(i) == 0.0),
        "relative and absolute tolerance are both zero",
    )
}

fn structure<S: OdeSystem + ?Sized>(shape: &Shape<'_>, sys: &S) -> Check {
    let rows = shape.n + shape.quad;
    if let Some(g) = shape.groups {
        refuse_if(
            g.rows.len() != shape.n
                || g.groups.iter().flatten().any(|&j| j >= shape.n)
                || g.rows.iter().flatten().any(|&r| r >= rows),
            "the column groups do not fit the system",
        )?;
    }
    for inv in sys.invariants() {
        let pivot: f64 = inv.terms.iter().filter(|t| t.0 == inv.pivot).map(|t| t.1).sum();
        refuse_if(
            inv.terms.iter().any(|t| t.0 >= rows || !t.1.is_finite()) || pivot == 0.0,
            "an invariant has a row outside the system or no pivot",
        )?;
    }
    Ok(())
}
