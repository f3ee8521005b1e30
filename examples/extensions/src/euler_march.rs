//! A solver of the ring pack: the linearly implicit Euler method at fixed steps.

use gudgeon_core::quantity::{PosRatio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::linalg::{lu_factor, lu_solve};
use gudgeon_scene::{MethodSetting, RunError, Stopped};
use gudgeon_scene_ring_pack::jacobian::Base;
use gudgeon_scene_ring_pack::marching::{Books, Ended, unsettled};
use gudgeon_scene_ring_pack::pack::Pack;
use gudgeon_scene_ring_pack::record::Totals;
use gudgeon_scene_ring_pack::solver::{RingPackSolverSpec, Solution, Wanted};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// `(1/Δθ - ∂f/∂y) Δy = f(θ, y)`, cycle after cycle.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EulerMarch {
    /// Cycles.
    #[schemars(range(max = 100))]
    pub cycles: u32,
    /// Steps per crank degree.
    #[schemars(range(max = 10_000), extend("x-refine" = { "group": "crank-angle step", "factor": 2 }))]
    pub steps_per_degree: u32,
    /// Relative change of the stored gas over the last cycle below which it counts as periodic.
    pub periodicity: PosRatio,
}

impl Default for EulerMarch {
    fn default() -> Self {
        Self { cycles: 3, steps_per_degree: 4, periodicity: quantity(1e-2) }
    }
}

#[register_model(
    name = "euler_march",
    summary = "the linearly implicit Euler method at fixed steps",
    equations = "(1/h - df/dy) dy = f(theta, y)",
    validity = "First order. Rings that hit a flank need small steps, for nothing finds the instant.",
    references = ["hairer1996"],
    example = "cycles = 3\nsteps_per_degree = 4\n",
)]
impl RingPackSolverSpec for EulerMarch {
    fn refuses(&self, pack: &Pack) -> Vec<BuildError> {
        let mut errors = Vec::new();
        if self.cycles == 0 || self.steps_per_degree == 0 {
            errors.push(BuildError::at("solver.steps_per_degree", "a cycle has at least one step"));
        }
        if pack.oil_pack.is_some() || pack.decision_interval().is_some() {
            let what = "`euler_march` follows no oil and decides no seats";
            errors.push(BuildError::at("solver.method", what).help("use `method = \"implicit\"`"));
        }
        errors
    }

    fn solve(
        &self,
        pack: &mut Pack,
        start: f64,
        wanted: &Wanted<'_>,
        progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Solution, RunError> {
        let mut books = Books::open(pack, wanted);
        let ended = self.march(pack, start, &mut books, progress);
        books.close(pack, ended, |e| {
            unsettled(e.totals.periodicity_error, self.periodicity.si(), e.cycles, start, "cycles")
        })
    }

    fn settings(&self, _: &Pack, _: Option<&Value>) -> Vec<MethodSetting> {
        let setting = |steps: u32| MethodSetting {
            method: "euler_march".into(),
            setting: format!("{steps} steps per degree"),
            is_default: false,
            asked: None,
            set: vec![
                "solver.method=euler_march".into(),
                format!("solver.steps_per_degree={steps}"),
                "solver.cycles=4".into(),
            ],
        };
        [4, 8, 16].map(setting).into()
    }
}

impl EulerMarch {
    fn march(
        &self,
        pack: &mut Pack,
        start: f64,
        books: &mut Books,
        progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Ended, EvalError> {
        let (n, rings) = (pack.layout.n, pack.n_rings());
        let per_cycle = pack.period().to_degrees().round() as u32 * self.steps_per_degree;
        let h = pack.period() / f64::from(per_cycle);
        let mut y = vec![0.0; n];
        let mut step = Step::new(n, pack.layout.quads());
        pack.each_block(|b, _| b.set_accuracy(0.0));
        pack.initial(start, &mut y);
        let mut ended = Ended { totals: Totals::default(), steps: 0, cycles: self.cycles, period: 1 };
        for cycle in 1..=self.cycles {
            let last = cycle == self.cycles;
            if last {
                // What passes each passage of the gas is carried too.
                books.begin_recorded(pack);
                step = Step::new(n, pack.layout.quads());
            }
            step.sums.fill(0.0);
            let before: f64 = mass(pack, &y);
            for k in 0..per_cycle {
                let theta = h * f64::from(k);
                step.take(pack, theta, h, &mut y)?;
                if last {
                    books.watch.look(pack, h);
                    books.measures.march(theta, pack, pack.layout.passed(&step.sums));
                    if k % self.steps_per_degree == 0 {
                        books.record.push(theta, pack, &step.sums[..rings], step.sums[rings]);
                    }
                }
                ended.steps += 1;
            }
            let after: f64 = mass(pack, &y);
            ended.totals = step.totals(pack, after - before);
            progress(f64::from(cycle) / f64::from(self.cycles))?;
        }
        pack.evaluate(pack.period(), &y)?;
        books.measures.march(pack.period(), pack, pack.layout.passed(&step.sums));
        books.record.push(pack.period(), pack, &step.sums[..rings], step.sums[rings]);
        Ok(ended)
    }
}

/// Work arrays of a step.
struct Step {
    /// Rates of the states and, behind them, of the quadratures.
    f: Vec<f64>,
    jac: Vec<f64>,
    matrix: Vec<f64>,
    pivots: Vec<usize>,
    base: Base,
    /// Quadratures of the cycle, in the order of the layout.
    sums: Vec<f64>,
}

impl Step {
    fn new(n: usize, quads: usize) -> Self {
        Self {
            f: vec![0.0; n + quads],
            jac: vec![0.0; (n + quads) * n],
            matrix: vec![0.0; n * n],
            pivots: vec![0; n],
            base: Base::default(),
            sums: vec![0.0; quads],
        }
    }

    /// Takes a step of `h` \[rad\]; `pack` stands at its start.
    fn take(&mut self, pack: &mut Pack, theta: f64, h: f64, y: &mut [f64]) -> Result<(), EvalError> {
        let n = y.len();
        pack.rates(theta, y, &mut self.f)?;
        let increment = |k: usize| (y[k] + 1e-7 * y[k].abs().max(1e-3)) - y[k];
        pack.jacobian(y, increment, &mut self.jac, &mut self.base)?;
        for (m, j) in self.matrix.iter_mut().zip(&self.jac) {
            *m = -j;
        }
        for i in 0..n {
            self.matrix[i * n + i] += 1.0 / h;
        }
        let singular = |_| EvalError::fatal("euler_march", "the matrix of a step is singular");
        lu_factor(&mut self.matrix, n, &mut self.pivots).map_err(singular)?;
        let (rates, quads) = self.f.split_at_mut(n);
        lu_solve(&self.matrix, n, &self.pivots, rates);
        // Quadratures along the same step: `Δq = h (q' + ∂q'/∂y Δy)`.
        for (k, (sum, q)) in self.sums.iter_mut().zip(quads).enumerate() {
            let row = &self.jac[(n + k) * n..][..n];
            *sum += h * (*q + row.iter().zip(&*rates).map(|(j, d)| j * d).sum::<f64>());
        }
        for (y, d) in y.iter_mut().zip(rates) {
            *y += *d;
        }
        Ok(())
    }

    /// Totals of a cycle over which the stored gas changed by `stored` \[kg\].
    fn totals(&self, pack: &Pack, stored: f64) -> Totals {
        let mut t = Totals::of_cycle(pack, &self.sums);
        let through = t.flow_in[0].abs().max(t.blow_by.abs()).max(f64::MIN_POSITIVE);
        t.balance.gas_mass = Some(((t.flow_in[0] - t.blow_by) - stored).abs() / through);
        t.periodicity_error = (stored / through).abs();
        t
    }
}

/// Gas in all volumes for the states `y` \[kg\].
fn mass(pack: &Pack, y: &[f64]) -> f64 {
    let masses = y.iter().zip(&pack.gas_scale).take(pack.gas.n_masses());
    masses.map(|(y, scale)| y * scale).sum()
}
