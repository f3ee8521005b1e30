mod evaluation;
mod nonlinear;
mod partials;
mod solved_speeds;
mod solver;
mod spectrum;

use std::f64::consts::PI;

use gudgeon_core::kinds::{Line, Torsion, TorsionAnswer, TorsionCtx, TorsionSpec};
use gudgeon_core::quantity::{Positive, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::independent_orders::IndependentOrders;
use crate::steady::Steady;
use nonlinear::active;
use solver::Solver;

/// The periodic motion at constant mean speed with all that is not linear: variable inertia with its velocity-squared term, gas torques and
/// drives at the true angle and speed, couplings that stiffen.
///
/// Each order is solved by elimination along the tree; what the linear line does not have is put on its right-hand side,
///
/// ```text
/// T_nl = Q(α) - Q(α₀) - (I(α) - Ī) θ'' - ½ I'(α) θ'²,   α = angle of the throw;
/// of a coupling: its torque less that of its tangent at the mean torque,
/// ```
///
/// evaluated over the cycle and taken apart into orders again. That is an equation for the torques of all orders at once, solved by
/// Newton's method; its linear systems are known by what they do to a motion and solved in a Krylov space (saad1986). It ends when the
/// torques of a motion are those that made it, to `tolerance`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HarmonicBalance {
    /// Change of the torques at which it ends, by the largest torque.
    #[serde(default = "tolerance")]
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub tolerance: Ratio<Positive>,
    /// Maximum number of evaluations of the motion.
    #[serde(default = "rounds")]
    #[schemars(range(min = 1, max = 100_000))]
    pub rounds: usize,
}

fn tolerance() -> Ratio<Positive> {
    quantity(1e-10)
}
fn rounds() -> usize {
    300
}

impl Default for HarmonicBalance {
    fn default() -> Self {
        Self { tolerance: tolerance(), rounds: rounds() }
    }
}

impl HarmonicBalance {
    /// The model that tells how much models by independent orders leave out of a line, where that is anything.
    pub(crate) fn of_what_is_left_out(line: &Line) -> Option<Box<dyn TorsionSpec>> {
        /// The difference is told in hundredths of a per cent; a resonance magnifies an error of the torques some ten times.
        const TOLERANCE: f64 = 1e-6;
        let own = Self { tolerance: quantity(TOLERANCE), ..Self::default() };
        (!active(line).is_empty()).then(|| Box::new(own) as Box<dyn TorsionSpec>)
    }
}

#[register_model(
    name = "harmonic_balance",
    summary = "periodic motion with variable inertia and nonlinear couplings, by orders",
    equations = "(K + i omega C - omega^2 J) a_n = T_n + T_nl,n;  T_nl = dQ - (I - I_m) theta'' - I' theta'^2/2",
    validity = "Constant mean speed; all orders multiples of one. One periodic motion, not the choice between several.",
    references = ["gomes2021", "saad1986"],
    example = "tolerance = 1e-10\n",
)]
impl TorsionSpec for HarmonicBalance {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        if self.tolerance.si() < 1e-14 {
            return Err(BuildError::at("tolerance", "cannot be below 1e-14"));
        }
        if active(ctx.line).is_empty() {
            // What is linear is solved once, whatever its orders are.
            return Ok(Box::new(IndependentOrders::new(ctx)?));
        }
        let mut steady = Steady::new(ctx)?;
        let base = 2.0 * PI / ctx.period;
        check_period(ctx.line, &steady, base)?;
        let harmonics = ((ctx.orders / base) + 1e-9).floor() as usize;
        check_size(harmonics, active(ctx.line).len())?;
        // The moving masses are part of what is evaluated here.
        steady.whole_orders_without_masses(base, harmonics);
        let scales = [self.tolerance.si(), base, ctx.period];
        Ok(Box::new(Solver::new(steady, scales, harmonics, self.rounds.max(2))))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Periodic
    }
    fn same_equations(&self) -> &'static [&'static str] {
        &["implicit"]
    }
}

/// Refuses orders and throws that do not repeat with the cycle, whose first order is `base`.
fn check_period(line: &Line, steady: &Steady, base: f64) -> Result<(), BuildError> {
    let whole = |step: f64| (step - step.round()).abs() <= 1e-6;
    for o in &steady.excitation.orders {
        if !whole(o.order / base) {
            let what = format!("order {} is no multiple of {base}: the motion is not periodic", o.order);
            return Err(BuildError::at("model", what).help("use `orders` for gears of any ratio"));
        }
    }
    for t in line.throws.iter().filter(|t| !t.inertia.is_constant()) {
        if !whole(line.nodes[t.node].ratio.abs() / base) {
            let what = "a geared throw does not repeat with the cycle";
            return Err(BuildError::at("model", what).help("use `orders` for gears of any ratio"));
        }
    }
    Ok(())
}

/// Bounds the memory of a run: the Krylov space holds many motions at once.
fn check_size(harmonics: usize, places: usize) -> Result<(), BuildError> {
    if harmonics == 0 || harmonics > 4000 || harmonics * harmonics * places > 25_000_000 {
        let what = format!(
            "{harmonics} harmonics of {places} nonlinear places; between 1 and 4000 are possible, and less for many places"
        );
        return Err(BuildError::at("orders", what));
    }
    Ok(())
}
