//! The ledger of the energy of the gas between the rings.

use gudgeon_core::kinds::GasFlow;

/// What the gas of a pack with a balance of energy holds, and what it does to its walls, over the samples of a cycle.
///
/// The work `∮ p dV` is taken from pressures and volumes, between samples by the trapezium, and not from the rates of the states: the states of the
/// gas know nothing of it.
#[derive(Debug, Clone, Default)]
pub struct GasLedger {
    /// Pressure \[Pa\] and size \[m³\] of every volume at the last sample.
    spaces: Vec<(f64, f64)>,
    start: Option<f64>,
    now: f64,
    most: f64,
    work: f64,
}

impl GasLedger {
    /// Takes the instant that `gas` holds as the next sample.
    pub fn sample(&mut self, gas: &dyn GasFlow) {
        if !gas.has_energy() {
            return;
        }
        let (mut k, mut content, mut work) = (0, 0.0, 0.0);
        let spaces = &mut self.spaces;
        gas.each_space(&mut |p, volume, energy| {
            content += energy;
            match spaces.get_mut(k) {
                Some(before) => {
                    work += 0.5 * (before.0 + p) * (volume - before.1);
                    *before = (p, volume);
                }
                None => spaces.push((p, volume)),
            }
            k += 1;
        });
        self.start.get_or_insert(content);
        self.now = content;
        self.most = self.most.max(content);
        self.work += work;
    }

    /// How well the balance closes: what was `brought` \[J\] less the work on the walls and what is stored, by the most that was held. `None`
    /// without a balance of energy.
    #[must_use]
    pub fn closure(&self, brought: f64) -> Option<f64> {
        let start = self.start?;
        (self.most > 0.0).then(|| (brought - self.work - (self.now - start)).abs() / self.most)
    }
}
