//! Forced vibration over a range of speeds.

use gudgeon_core::kinds::TorsionCtx;
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::linalg::Complex;

use crate::forcing::Excitation;
use crate::steady::{Steady, drive_damping};
use crate::sweep::{LANES, Sweep};
use crate::tree::Tree;

/// Torques of the links at each speed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SpeedRange {
    /// The orders.
    pub orders: Vec<f64>,
    /// Phasors by speed, order and link \[N m\].
    pub torque: Vec<Vec<Vec<[f64; 2]>>>,
    /// Whether frequencies were solved side by side.
    pub lanes: bool,
    /// Linear systems solved.
    pub solutions: u64,
}

/// Forced vibration of the line of `ctx` at each of `speeds` \[rad/s\].
///
/// Lines whose coefficients depend on neither speed nor frequency are solved for several speeds at once.
///
/// # Errors
/// A line that cannot be; [`EvalError`] for an undamped resonance, as a message with order and speed.
pub fn speed_range(
    ctx: &TorsionCtx<'_>,
    speeds: &[f64],
) -> Result<Result<SpeedRange, EvalError>, BuildError> {
    let line = ctx.line;
    let parts = Excitation::parts(line, ctx.orders);
    let mut orders: Vec<f64> = parts.iter().flat_map(|p| p.orders.iter().map(|o| o.order)).collect();
    orders.sort_unstable_by(f64::total_cmp);
    orders.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let n = line.nodes.len();
    let torque: Vec<[Vec<Complex>; 2]> = orders
        .iter()
        .map(|o| {
            [0, 1].map(|k: usize| {
                let found = parts[k].orders.iter().find(|p| (p.order - o).abs() < 1e-9);
                found.map_or_else(|| vec![Complex::default(); n], |p| p.torque.clone())
            })
        })
        .collect();
    // Laws over the mean torque: that goes with the speed where drag or drives do.
    let plain =
        line.links.iter().all(|l| !l.coupling.depends_on_load() && !l.coupling.depends_on_frequency())
            && line.drives.iter().all(|d| d.drive.is_linear() || !d.drive.orders().is_empty());
    let mut out = SpeedRange { orders: orders.clone(), lanes: plain, ..SpeedRange::default() };
    if !plain {
        let mut s = Steady::new(ctx)?;
        for &speed in speeds {
            s.set_speed(speed);
            let excitation = std::mem::take(&mut s.excitation);
            let mut rows = Vec::with_capacity(orders.len());
            for o in &excitation.orders {
                match s.respond(o) {
                    Ok(r) => rows.push(r.torque),
                    Err(e) => return Ok(Err(e)),
                }
            }
            s.excitation = excitation;
            out.solutions += orders.len() as u64;
            out.torque.push(rows);
        }
        return Ok(Ok(out));
    }
    let mut tree = Tree::new(line)?;
    drive_damping(line, &mut tree, ctx.speed);
    let mut sweep = Sweep::new(n);
    out.torque = vec![vec![vec![[0.0; 2]; line.links.len()]; orders.len()]; speeds.len()];
    let mut by_position = vec![[0.0; 2]; n];
    for (k, (o, parts)) in orders.iter().zip(&torque).enumerate() {
        for (part, torque) in parts.iter().enumerate() {
            if torque.iter().all(|t| *t == Complex::default()) {
                continue;
            }
            for p in 0..n {
                let t = torque[tree.node[p]];
                by_position[p] = [t.re * tree.ratio[p], t.im * tree.ratio[p]];
            }
            for (first, chunk) in speeds.chunks(LANES).enumerate() {
                // A short last chunk repeats its last speed.
                let at = |l: usize| chunk[l.min(chunk.len() - 1)];
                let omega = std::array::from_fn(|l| o * at(l));
                if let Err((l, _)) = sweep.solve(&tree, &omega, &by_position) {
                    let what = format!(
                        "order {o} at {:.6} rpm hits an undamped natural frequency: without damping the vibration grows without bound",
                        at(l) * 30.0 / std::f64::consts::PI
                    );
                    return Ok(Err(EvalError::fatal("torsion", what)));
                }
                out.solutions += chunk.len() as u64;
                for (l, speed) in chunk.iter().enumerate() {
                    let weight = if part == 0 { 1.0 } else { speed * speed };
                    let row = &mut out.torque[first * LANES + l][k];
                    for p in 0..n {
                        if tree.parent[p] < n {
                            let s = weight * if tree.forward[p] { 1.0 } else { -1.0 } / tree.link_ratio[p];
                            let t = &mut row[tree.link[p]];
                            t[0] += sweep.transmitted[p][0][l] * s;
                            t[1] += sweep.transmitted[p][1][l] * s;
                        }
                    }
                }
            }
        }
    }
    Ok(Ok(out))
}
