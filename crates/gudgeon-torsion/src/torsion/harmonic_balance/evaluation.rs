//! The motion under given torques, the torques that it makes, and how both change.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::OrderResponse;
use gudgeon_numerics::linalg::Complex;

use super::solver::Solver;

impl Solver {
    /// The motion under the torques `x`, and the torques that it makes.
    pub(super) fn evaluate(&mut self, base_mean: &[f64], g: &mut [Complex]) -> Result<(), EvalError> {
        self.take_mean(base_mean);
        self.spread(true);
        self.solve_orders()?;
        for (i, node) in self.nonlinear.active.iter().enumerate() {
            let at = i * self.nonlinear.orders();
            self.angle[at] = Complex::new(self.steady.mean_angle[*node], 0.0);
        }
        let omega = self.steady.speed * self.base;
        self.nonlinear.take_motion(&self.angle, omega);
        self.nonlinear.torques(&self.steady, &self.tangents, g);
        g.iter_mut().for_each(|g| *g = *g * Complex::new(self.fraction, 0.0));
        Ok(())
    }

    /// The mean state under the mean torques in `x`.
    fn take_mean(&mut self, base_mean: &[f64]) {
        let mut mean = base_mean.to_vec();
        for (i, node) in self.nonlinear.active.iter().enumerate() {
            mean[*node] += self.x[i * self.nonlinear.orders()].re;
        }
        self.steady.take_mean(&mean);
    }

    /// Puts torques of `x`, with those that are given where `given` says so, in the place of the right-hand sides.
    fn spread(&mut self, given: bool) {
        let (tree, m) = (&self.steady.tree, self.nonlinear.harmonics);
        let [re, im] = &mut self.receptance.field;
        if given {
            for (k, o) in self.steady.excitation.orders.iter().enumerate() {
                for p in 0..tree.len() {
                    let t = o.torque[tree.node[p]];
                    (re[p * m + k], im[p * m + k]) = (tree.ratio[p] * t.re, tree.ratio[p] * t.im);
                }
            }
        } else {
            re.fill(0.0);
            im.fill(0.0);
        }
        for (own, node) in self.x.chunks_exact(m + 1).zip(&self.nonlinear.active) {
            let p = tree.position[*node];
            let ratio = tree.ratio[p];
            for (k, x) in own[1..].iter().enumerate() {
                re[p * m + k] += ratio * x.re;
                im[p * m + k] += ratio * x.im;
            }
        }
    }

    /// Solves what [`Self::spread`] put there: the angles of the active nodes.
    fn solve_orders(&mut self) -> Result<(), EvalError> {
        let m = self.nonlinear.harmonics;
        if let Err((k, _)) = self.receptance.solve(&mut self.steady) {
            // The careful elimination says it in its own words.
            let order = self.steady.excitation.orders[k].clone();
            self.steady.respond(&order)?;
            return Err(EvalError::fatal("harmonic_balance", "an undamped resonance is hit"));
        }
        let (tree, [re, im]) = (&self.steady.tree, &self.receptance.field);
        for (own, node) in self.angle.chunks_exact_mut(m + 1).zip(&self.nonlinear.active) {
            let p = tree.position[*node];
            let ratio = tree.ratio[p];
            for (k, x) in own[1..].iter_mut().enumerate() {
                *x = Complex::new(ratio * re[p * m + k], ratio * im[p * m + k]);
            }
        }
        Ok(())
    }

    /// Derivatives at the motion of the last evaluation.
    pub(super) fn linearise(&mut self, base_mean: &[f64], scale: f64) {
        self.nonlinear.linearise(&self.steady, &self.tangents);
        let active = &self.nonlinear.active;
        let (n, links) = (active.len(), self.tangents.len());
        self.angle_by_torque.resize(n * n, 0.0);
        self.link_by_torque.resize(links * n, 0.0);
        let [angle, torque] = [self.steady.mean_angle.clone(), self.steady.mean_torque.clone()];
        let mut mean = base_mean.to_vec();
        for (i, node) in active.iter().enumerate() {
            mean[*node] += self.x[i * self.nonlinear.orders()].re;
        }
        // The mean state goes straight with the torque, but for couplings that stiffen.
        let h = 1e-3 * scale;
        for j in 0..n {
            let before = mean[active[j]];
            mean[active[j]] = before + h;
            self.steady.take_mean(&mean);
            mean[active[j]] = before;
            for (i, node) in active.iter().enumerate() {
                self.angle_by_torque[i * n + j] = (self.steady.mean_angle[*node] - angle[*node]) / h;
            }
            for l in 0..links {
                self.link_by_torque[l * n + j] = (self.steady.mean_torque[l] - torque[l]) / h;
            }
        }
        (self.steady.mean_angle, self.steady.mean_torque) = (angle, torque);
    }

    /// What torques `x` beside those of the last evaluation change in the torques.
    pub(super) fn torque_change(&mut self, made: &mut [Complex]) {
        let orders = self.nonlinear.orders();
        let n = self.nonlinear.active.len();
        self.spread(false);
        // The evaluation before has met no resonance in the same systems.
        if self.solve_orders().is_err() {
            made.fill(Complex::default());
            return;
        }
        let by = |matrix: &[f64], i: usize, x: &[Complex]| -> f64 {
            (0..n).map(|j| matrix[i * n + j] * x[j * orders].re).sum()
        };
        for i in 0..n {
            self.angle[i * orders] = Complex::new(by(&self.angle_by_torque, i, &self.x), 0.0);
        }
        let load: Vec<f64> = (0..self.tangents.len()).map(|l| by(&self.link_by_torque, l, &self.x)).collect();
        let omega = self.steady.speed * self.base;
        self.nonlinear.change(&self.angle, omega, &load, made);
        made.iter_mut().for_each(|g| *g = *g * Complex::new(self.fraction, 0.0));
    }

    /// The whole answer of each order.
    pub(super) fn responses(&mut self) -> Result<Vec<OrderResponse>, EvalError> {
        let orders = self.nonlinear.orders();
        let mut out = Vec::with_capacity(orders);
        for k in 1..orders {
            let mut o = self.steady.excitation.orders[k - 1].clone();
            for (i, node) in self.nonlinear.active.iter().enumerate() {
                o.torque[*node] = o.torque[*node] + self.x[i * orders + k];
            }
            out.push(self.steady.respond(&o)?);
        }
        Ok(out)
    }

    /// Puts what nonlinear links carry beside their tangents into their torques, and their loss.
    pub(super) fn add_nonlinear_torques(
        &mut self,
        orders: &mut [OrderResponse],
        rest: &[(usize, Vec<Complex>)],
    ) {
        let line = &self.steady.line;
        for (l, c) in rest {
            let [a, b] = line.links[*l].nodes;
            let gear = line.nodes[a].ratio / line.nodes[b].ratio;
            self.steady.mean_torque[*l] += c[0].re;
            for (o, c) in orders.iter_mut().zip(&c[1..]) {
                let t = &mut o.torque[*l];
                *t = [t[0] + c.re, t[1] + c.im];
                // Mean of torque times rate of twist: an order may take power from another, the sum is the loss.
                let twist = [o.angle[a][0] - gear * o.angle[b][0], o.angle[a][1] - gear * o.angle[b][1]];
                let rate = o.order * self.steady.speed;
                o.heat[*l] = 0.5 * rate * (t[1] * twist[0] - t[0] * twist[1]);
            }
        }
    }
}
