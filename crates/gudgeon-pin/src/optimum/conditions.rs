//! The conditions of Karush, Kuhn and Tucker at the end of a search.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::PIN_QUANTITIES;
use gudgeon_numerics::elementary;

use super::program::{Expansion, Multipliers, Program, slack};
use super::result::{KktResiduals, Optimum};

/// An active constraint: normal, multiplier, what is left of it.
struct Active {
    normal: [f64; 3],
    multiplier: f64,
    slack: f64,
}

/// The limits and bounds with a multiplier.
fn active(
    p: &Program<'_, '_>,
    x: &[f64; 3],
    at: &Expansion,
    mu: &Multipliers,
) -> impl Iterator<Item = Active> {
    let limits = at.limits.iter().zip(mu).filter(|(_, mu)| **mu > 0.0);
    let limits = limits.map(|(l, mu)| Active { normal: l.g, multiplier: *mu, slack: l.v });
    let bounds = p.bounds.iter().zip(&mu[PIN_QUANTITIES..]).filter(|(_, mu)| **mu > 0.0);
    let bounds = bounds.filter_map(|(b, mu)| {
        b.as_ref().map(|b| Active { normal: b.a, multiplier: *mu, slack: slack(b, x) })
    });
    limits.chain(bounds)
}

/// Evaluates the conditions at a point.
pub fn conditions(
    p: &Program<'_, '_>,
    x: &[f64; 3],
    at: &Expansion,
    mu: &Multipliers,
    iterations: u32,
) -> Result<Optimum, EvalError> {
    let size = p.size(x);
    let utilisation = p.design.utilisation(&size)?;
    let masses = p.design.masses(&size);
    let mut kkt = KktResiduals { infeasibility: infeasibility(p, x, &utilisation), ..Default::default() };
    // Gradient of the Lagrangian, normals that hold the point.
    let mut rest = at.mass.g;
    let (mut normals, mut count) = ([[0.0; 3]; 3], 0);
    for a in active(p, x, at, mu) {
        for i in 0..3 {
            rest[i] += a.multiplier * a.normal[i];
        }
        kkt.complementarity = kkt.complementarity.max((a.multiplier * a.slack * p.mass / masses.pin).abs());
        if count < 3 {
            normals[count] = p.free(&a.normal);
            count += 1;
        }
    }
    let free = || (0..3).filter(|i| !p.fixed[*i]);
    let scale = free().fold(1e-300, |a: f64, i| a.max(at.mass.g[i].abs()));
    kkt.stationarity = free().fold(0.0, |a: f64, i| a.max(rest[i].abs())) / scale;
    let w = p.lagrangian_hessian(at, mu);
    kkt.curvature = min_curvature(&w, &normals[..count], &p.fixed).map(|c| c * p.mass / masses.pin);
    Ok(Optimum {
        size,
        masses,
        utilisation,
        multipliers: std::array::from_fn(|k| mu[k] * p.mass),
        bounds: std::array::from_fn(|k| mu[PIN_QUANTITIES + k] * p.mass / p.unit),
        kkt,
        iterations,
    })
}

/// The largest amount by which a limit or a bound is exceeded.
fn infeasibility(p: &Program<'_, '_>, x: &[f64; 3], utilisation: &[f64; PIN_QUANTITIES]) -> f64 {
    let limits = utilisation.iter().map(|u| u - 1.0);
    let bounds = p.bounds.iter().flatten().map(|b| -slack(b, x));
    limits.chain(bounds).fold(f64::NEG_INFINITY, f64::max)
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Minimum eigenvalue of `w` on the directions that are free and orthogonal to `normals`; `None` when no direction is left.
#[doc(hidden)]
#[must_use]
pub fn min_curvature(w: &[[f64; 3]; 3], normals: &[[f64; 3]], fixed: &[bool; 3]) -> Option<f64> {
    let (directions, held) = directions(normals, fixed);
    let left = &directions[held..];
    let mut m = [[0.0; 3]; 3];
    for (i, u) in left.iter().enumerate() {
        for (j, v) in left.iter().enumerate() {
            let wv: [f64; 3] = std::array::from_fn(|k| dot(&w[k], v));
            m[i][j] = dot(u, &wv);
        }
    }
    min_eigenvalue(m, left.len())
}

/// Orthonormal basis by Gram-Schmidt, and how many of its first directions are those of fixed dimensions and of `normals`: the others are free.
fn directions(normals: &[[f64; 3]], fixed: &[bool; 3]) -> ([[f64; 3]; 3], usize) {
    let unit = |i: usize| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
    let (mut taken, mut count) = ([[0.0; 3]; 3], 0);
    let mut extend = |mut v: [f64; 3]| {
        let before = dot(&v, &v).sqrt();
        for t in &taken[..count] {
            let c = dot(&v, t);
            for i in 0..3 {
                v[i] -= c * t[i];
            }
        }
        let len = dot(&v, &v).sqrt();
        if len > 1e-9 * before && count < 3 {
            taken[count] = v.map(|c| c / len);
            count += 1;
        }
        count
    };
    let mut held = 0;
    for v in (0..3).filter(|i| fixed[*i]).map(unit).chain(normals.iter().copied()) {
        held = extend(v);
    }
    for i in 0..3 {
        extend(unit(i));
    }
    (taken, held)
}

/// Minimum eigenvalue of the leading `n × n` part of a symmetric matrix: of three rows by Jacobi rotations. None of no row.
fn min_eigenvalue(mut m: [[f64; 3]; 3], n: usize) -> Option<f64> {
    if n == 2 {
        let (mean, half) = (0.5 * (m[0][0] + m[1][1]), 0.5 * (m[0][0] - m[1][1]));
        return Some(mean - elementary::hypot(half, m[0][1]));
    }
    for _ in 0..12 {
        for i in 0..n {
            for j in i + 1..n {
                if m[i][j] == 0.0 {
                    continue;
                }
                let t = 0.5 * elementary::atan2(2.0 * m[i][j], m[i][i] - m[j][j]);
                let (s, c) = elementary::sin_cos(t);
                for k in 0..n {
                    let (a, b) = (m[i][k], m[j][k]);
                    (m[i][k], m[j][k]) = (c * a + s * b, c * b - s * a);
                }
                for row in m.iter_mut().take(n) {
                    let (a, b) = (row[i], row[j]);
                    (row[i], row[j]) = (c * a + s * b, c * b - s * a);
                }
            }
        }
    }
    (0..n).map(|i| m[i][i]).reduce(f64::min)
}
