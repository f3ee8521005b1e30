use gudgeon_core::kinds::{Line, Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::quantity::{Fraction, Ratio};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::linalg::Complex;
use serde::{Deserialize, Serialize};

use super::HarmonicBalance;
use crate::eigen;
use crate::steady::Steady;

/// Forced vibration by superposition of undamped modes.
///
/// `q_m = φ_mᵀ T/(ω_m² - ω² + i ω c_m)` with the modal damping `c_m = φᵀCφ` or `2 ζ ω_m`; what couples the modes in C is left out. The
/// modes left out follow statically where `static_correction` is set: their part of the answer to torque without acceleration.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Modal {
    /// Number of modes kept, the rigid one included.
    #[serde(default = "ten")]
    #[schemars(range(min = 1, max = 2000))]
    pub modes: usize,
    /// Damping ratio of all modes, instead of that of the dampers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_ratio: Option<Ratio<Fraction>>,
    /// Whether modes that are left out follow statically.
    #[serde(default = "yes")]
    pub static_correction: bool,
}

fn ten() -> usize {
    10
}
fn yes() -> bool {
    true
}

impl Default for Modal {
    fn default() -> Self {
        Self { modes: ten(), damping_ratio: None, static_correction: true }
    }
}

#[register_model(
    name = "modal",
    summary = "forced vibration by superposition of modes, with static correction",
    equations = "q_m = phi_m^T T/(omega_m^2 - omega^2 + i omega c_m);  theta = sum phi_m q_m",
    validity = "Light damping that hardly couples the modes. For long lines of which few modes matter.",
    references = ["gomes2021", "den_hartog1956"],
    example = "modes = 6\n",
)]
impl TorsionSpec for Modal {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        if self.modes == 0 {
            return Err(BuildError::at("modes", "at least one mode is needed"));
        }
        if let Some(l) = ctx.line.links.iter().position(|l| l.coupling.depends_on_frequency()) {
            let what = "modes need a stiffness that does not depend on the frequency; use `orders`";
            return Err(BuildError::at(format!("links.{l}"), what));
        }
        let steady = Steady::new(ctx)?;
        if steady.tree.is_grounded() && self.static_correction {
            return Err(BuildError::at("static_correction", "is for lines that turn freely; use `orders`"));
        }
        if self.static_correction {
            let part = eigen::parts(&steady.tree);
            let empty = |p: usize| {
                part[p] == p && (0..part.len()).all(|i| part[i] != p || steady.tree.inertia[i] == 0.0)
            };
            if let Some(p) = (0..part.len()).find(|p| empty(*p)) {
                let i = steady.tree.node[p];
                let what =
                    format!("`{}` has neither inertia nor stiffness; use `orders`", ctx.line.nodes[i].name);
                return Err(BuildError::at(format!("inertias.{i}"), what));
            }
        }
        Ok(Box::new(Solver { spec: self.clone(), steady }))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Periodic
    }
    fn fuller(&self, line: &Line) -> Option<Box<dyn TorsionSpec>> {
        HarmonicBalance::default().if_it_has_more(line)
    }
}

#[derive(Debug)]
struct Solver {
    spec: Modal,
    steady: Steady,
}

impl Torsion for Solver {
    fn set_speed(&mut self, speed: f64) -> Result<(), EvalError> {
        self.steady.set_speed(speed);
        Ok(())
    }
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        out.orders.clear();
        let t = &self.steady.tree;
        let n = t.len();
        let omega = eigen::natural_frequencies(t, self.spec.modes)?;
        let v = eigen::shapes(t, &omega);
        let damping: Vec<f64> = omega
            .iter()
            .zip(&v)
            .map(|(w, v)| match self.spec.damping_ratio {
                Some(z) => 2.0 * z.si() * w,
                None => eigen::modal_damping(t, *w, v),
            })
            .collect();
        let part = eigen::parts(t);
        let mut total = vec![0.0; n];
        for p in 0..n {
            total[part[p]] += t.inertia[p];
        }
        for o in &self.steady.excitation.orders {
            let w = o.order * self.steady.speed;
            let f: Vec<Complex> =
                (0..n).map(|p| o.torque[t.node[p]] * Complex::new(t.ratio[p], 0.0)).collect();
            let project = |v: &[f64]| {
                v.iter().zip(&f).fold(Complex::default(), |s, (v, f)| s + *f * Complex::new(*v, 0.0))
            };
            let mut phi = vec![Complex::default(); n];
            if self.spec.static_correction {
                // Torque less that of the rigid acceleration, through the springs alone, in each part that turns by itself.
                let mut sum = vec![Complex::default(); n];
                for p in 0..n {
                    sum[part[p]] = sum[part[p]] + f[p];
                }
                let mut load: Vec<Complex> = (0..n)
                    .map(|p| f[p] - sum[part[p]] * Complex::new(t.inertia[p] / total[part[p]], 0.0))
                    .collect();
                for p in 0..n - 1 {
                    let q = t.parent[p];
                    if part[p] == part[q] {
                        load[q] = load[q] + load[p];
                    }
                }
                for p in (0..n - 1).rev() {
                    if part[p] == part[t.parent[p]] {
                        phi[p] = phi[t.parent[p]] + load[p] * Complex::new(1.0 / t.k[p], 0.0);
                    }
                }
                let mut mean = vec![Complex::default(); n];
                for p in 0..n {
                    let share = Complex::new(t.inertia[p] / total[part[p]], 0.0);
                    mean[part[p]] = mean[part[p]] + phi[p] * share;
                }
                for p in 0..n {
                    phi[p] = phi[p] - mean[part[p]];
                }
            }
            for ((wm, c), v) in omega.iter().zip(&damping).zip(&v) {
                let d = Complex::new(wm * wm - w * w, w * c);
                if d == Complex::default() {
                    let what = format!("order {} hits an undamped natural frequency", o.order);
                    return Err(EvalError::fatal("modal", what));
                }
                let mut q = project(v) / d;
                if self.spec.static_correction && *wm > 0.0 {
                    q = q - project(v) * Complex::new(1.0 / (wm * wm), 0.0);
                }
                for (x, v) in phi.iter_mut().zip(v) {
                    *x = *x + q * Complex::new(*v, 0.0);
                }
            }
            let links = self.steady.line.links.len();
            let mut r = gudgeon_core::kinds::OrderResponse {
                order: o.order,
                angle: vec![[0.0; 2]; n],
                torque: vec![[0.0; 2]; links],
                heat: vec![0.0; links],
                excitation: o.torque.iter().map(|t| [t.re, t.im]).collect(),
            };
            // What each inertia needs beside its links, for those that are rigid.
            let mut load: Vec<Complex> = (0..n)
                .map(|p| f[p] - phi[p] * Complex::new(t.ground[p] - w * w * t.inertia[p], w * t.damping[p]))
                .collect();
            for p in 0..n {
                r.angle[t.node[p]] = [phi[p].re * t.ratio[p], phi[p].im * t.ratio[p]];
                let q = t.parent[p];
                if q >= n {
                    continue;
                }
                let s = if t.forward[p] { 1.0 } else { -1.0 } / t.link_ratio[p];
                let torque = if t.k[p].is_finite() {
                    let kappa = Complex::new(t.k[p], t.k[p] * t.eta[p] + w * t.c[p]);
                    let twist = phi[p] - phi[q];
                    r.heat[t.link[p]] = 0.5 * w * kappa.im * twist.abs() * twist.abs();
                    kappa * twist
                } else {
                    load[p]
                };
                load[q] = load[q] + torque;
                r.torque[t.link[p]] = [torque.re * s, torque.im * s];
            }
            out.orders.push(r);
        }
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("modes".into(), omega.len() as u64);
        self.steady.describe(out);
        Ok(())
    }
}
