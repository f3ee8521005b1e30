use gudgeon_core::kinds::{Line, OrderResponse, Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::quantity::{Fraction, Ratio};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::linalg::Complex;
use serde::{Deserialize, Serialize};

use super::HarmonicBalance;
use crate::eigen;
use crate::forcing::Order;
use crate::steady::Steady;
use crate::tree::{Resonance, Tree};

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
            let part = eigen::connected_parts(&steady.tree);
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
        HarmonicBalance::of_what_is_left_out(line)
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
        let basis = Basis::new(&self.steady.tree, &self.spec)?;
        let mut found = Vec::with_capacity(self.steady.excitation.orders.len());
        for o in &self.steady.excitation.orders {
            let omega = o.order * self.steady.speed;
            let torque = torque_by_position(&self.steady.tree, o);
            let angle = basis.respond(omega, &torque).map_err(|Resonance| {
                let what = format!("order {} hits an undamped natural frequency", o.order);
                EvalError::fatal("modal", what)
            })?;
            found.push(response(&self.steady, o, omega, &torque, &angle));
        }
        out.orders = found.as_slice().into();
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("modes".into(), basis.omega.len() as u64);
        self.steady.describe(out);
        Ok(())
    }
}

fn real(v: f64) -> Complex {
    Complex::new(v, 0.0)
}

/// Torques of one order by position, counted at the reference shaft.
fn torque_by_position(t: &Tree, o: &Order) -> Vec<Complex> {
    (0..t.len()).map(|p| o.torque[t.node[p]] * real(t.ratio[p])).collect()
}

/// The modes that are kept, and what those that are left out need.
struct Basis<'a> {
    tree: &'a Tree,
    static_correction: bool,
    /// Angular frequencies \[rad/s\], dampings \[1/s\] and shapes of unit modal inertia.
    omega: Vec<f64>,
    damping: Vec<f64>,
    shapes: Vec<Vec<f64>>,
    /// Part of the line that turns by itself, by position, and share of each inertia in its part.
    part: Vec<usize>,
    share: Vec<f64>,
}

impl<'a> Basis<'a> {
    fn new(tree: &'a Tree, spec: &Modal) -> Result<Self, EvalError> {
        let omega = eigen::natural_frequencies(tree, spec.modes)?;
        let shapes = eigen::shapes(tree, &omega);
        let damping = omega
            .iter()
            .zip(&shapes)
            .map(|(w, v)| match spec.damping_ratio {
                Some(z) => 2.0 * z.si() * w,
                None => eigen::modal_damping(tree, *w, v),
            })
            .collect();
        let part = eigen::connected_parts(tree);
        let mut total = vec![0.0; tree.len()];
        for (part, j) in part.iter().zip(&tree.inertia) {
            total[*part] += j;
        }
        let share = part.iter().zip(&tree.inertia).map(|(part, j)| j / total[*part]).collect();
        let static_correction = spec.static_correction;
        Ok(Self { tree, static_correction, omega, damping, shapes, part, share })
    }

    /// Angles by position under torques of one frequency.
    fn respond(&self, w: f64, torque: &[Complex]) -> Result<Vec<Complex>, Resonance> {
        let mut angle = if self.static_correction {
            self.static_angle(torque)
        } else {
            vec![Complex::default(); torque.len()]
        };
        for ((wm, c), v) in self.omega.iter().zip(&self.damping).zip(&self.shapes) {
            let d = Complex::new(wm * wm - w * w, w * c);
            if d == Complex::default() {
                return Err(Resonance);
            }
            let modal_torque = v.iter().zip(torque).fold(Complex::default(), |s, (v, f)| s + *f * real(*v));
            let mut q = modal_torque / d;
            if self.static_correction && *wm > 0.0 {
                q = q - modal_torque * real(1.0 / (wm * wm));
            }
            for (x, v) in angle.iter_mut().zip(v) {
                *x = *x + q * real(*v);
            }
        }
        Ok(angle)
    }

    /// Angles under the torque less that of the rigid acceleration, through the springs alone, in each part that turns by itself; their
    /// mean over the inertias of a part is zero.
    fn static_angle(&self, torque: &[Complex]) -> Vec<Complex> {
        let (t, part, n) = (self.tree, &self.part, self.tree.len());
        let mut sum = vec![Complex::default(); n];
        for p in 0..n {
            sum[part[p]] = sum[part[p]] + torque[p];
        }
        let mut load: Vec<Complex> = (0..n).map(|p| torque[p] - sum[part[p]] * real(self.share[p])).collect();
        for p in 0..n - 1 {
            let q = t.parent[p];
            if part[p] == part[q] {
                load[q] = load[q] + load[p];
            }
        }
        let mut angle = vec![Complex::default(); n];
        for p in (0..n - 1).rev() {
            if part[p] == part[t.parent[p]] {
                angle[p] = angle[t.parent[p]] + load[p] * real(1.0 / t.k[p]);
            }
        }
        let mut mean = vec![Complex::default(); n];
        for p in 0..n {
            mean[part[p]] = mean[part[p]] + angle[p] * real(self.share[p]);
        }
        for p in 0..n {
            angle[p] = angle[p] - mean[part[p]];
        }
        angle
    }
}

/// Angles by node, and the torques and losses of the links that go with them.
fn response(steady: &Steady, o: &Order, w: f64, torque: &[Complex], angle: &[Complex]) -> OrderResponse {
    let t = &steady.tree;
    let (n, links) = (t.len(), steady.line.links.len());
    let mut r = OrderResponse {
        order: o.order,
        angle: vec![[0.0; 2]; n],
        torque: vec![[0.0; 2]; links],
        heat: vec![0.0; links],
        excitation: o.torque.iter().map(|t| [t.re, t.im]).collect(),
    };
    // What each inertia needs beside its links, for those that are rigid.
    let mut load: Vec<Complex> = (0..n)
        .map(|p| torque[p] - angle[p] * Complex::new(t.ground[p] - w * w * t.inertia[p], w * t.damping[p]))
        .collect();
    for p in 0..n {
        r.angle[t.node[p]] = [angle[p].re * t.ratio[p], angle[p].im * t.ratio[p]];
        let q = t.parent[p];
        if q >= n {
            continue;
        }
        let s = if t.forward[p] { 1.0 } else { -1.0 } / t.link_ratio[p];
        let torque = if t.k[p].is_finite() {
            let kappa = Complex::new(t.k[p], t.k[p] * t.eta[p] + w * t.c[p]);
            let twist = angle[p] - angle[q];
            r.heat[t.link[p]] = 0.5 * w * kappa.im * twist.abs() * twist.abs();
            kappa * twist
        } else {
            load[p]
        };
        load[q] = load[q] + torque;
        r.torque[t.link[p]] = [torque.re * s, torque.im * s];
    }
    r
}
