//! A gas flow with a state that is no mass, an event and a column of its own: the scene integrates, switches and records it like any other.

use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec, GasIn, GasOut, GasPassage};
use gudgeon_core::states::{ColumnInfo, Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model, spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::common::{column, run_case, value};

/// The built-in network beside a gauge in the cylinder.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Gauged {}

#[register_model(
    name = "gauged",
    summary = "orifice network beside a slow pressure gauge",
    equations = "tau dx/dt = p_cylinder/1 bar - x",
    validity = "Tests.",
    references = [],
    example = "",
)]
impl GasFlowSpec for Gauged {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        let spec = spec::plain_model::<dyn GasFlowSpec>("orifice_network")
            .map_err(|e| BuildError::new(e.to_string()))?;
        let gas = spec.build(ctx)?;
        let mut states = gas.states().to_vec();
        states.push(StateInfo::new("reading of the gauge").over_cycle(1.0, true));
        Ok(Box::new(Running { gas, states, reading: 0.0, high: false, times: 0 }))
    }
}

/// Time constant of the gauge [s]: a tenth of a cycle at 1900 rpm.
const TAU: f64 = 6e-3;
/// Reading [bar] above which the gauge counts.
const ALARM: f64 = 20.0;

struct Running {
    gas: Box<dyn GasFlow>,
    states: Vec<StateInfo>,
    reading: f64,
    high: bool,
    times: u32,
}

impl Stateful for Running {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
    fn reads(&self) -> Signals {
        self.gas.reads()
    }
    fn n_events(&self) -> usize {
        1
    }
    fn event(&self, _: usize) -> f64 {
        if self.high { ALARM - self.reading } else { self.reading - ALARM }
    }
    fn switch(&mut self, _: usize, _: &mut [f64]) {
        self.high = !self.high;
        self.times += u32::from(self.high);
    }
    fn save(&self, out: &mut Vec<f64>) {
        out.extend([f64::from(u8::from(self.high)), f64::from(self.times)]);
    }
    fn restore(&mut self, saved: &[f64]) -> usize {
        (self.high, self.times) = (saved[0] != 0.0, saved[1] as u32);
        2
    }
    fn columns(&self) -> Vec<ColumnInfo> {
        vec![ColumnInfo::new("reading", "bar"), ColumnInfo::new("high", "1")]
    }
    fn record(&self, y: &[f64], row: &mut Vec<f64>) {
        row.extend([y[self.n_masses()], f64::from(u8::from(self.high))]);
    }
}

impl GasFlow for Running {
    fn passages(&self) -> &[GasPassage] {
        self.gas.passages()
    }
    fn n_masses(&self) -> usize {
        self.gas.n_masses()
    }
    fn uses_film_height(&self) -> bool {
        self.gas.uses_film_height()
    }
    fn at_pressures(&self, inp: &GasIn<'_>, p_land: &[f64], state: &mut [f64]) {
        let (masses, reading) = state.split_at_mut(self.n_masses());
        self.gas.at_pressures(inp, p_land, masses);
        reading[0] = inp.p_cylinder / 1e5;
    }
    fn pressures(&mut self, inp: &GasIn<'_>, state: &[f64], out: &mut GasOut) -> Result<(), EvalError> {
        let masses = self.n_masses();
        self.gas.pressures(inp, &state[..masses], out)
    }
    fn rates(
        &mut self,
        inp: &GasIn<'_>,
        state: &[f64],
        d: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        let (masses, reading) = d.split_at_mut(self.n_masses());
        self.reading = state[masses.len()];
        reading[0] = (inp.p_cylinder / 1e5 - self.reading) / TAU;
        self.gas.rates(inp, &state[..masses.len()], masses, out)
    }
}

#[test]
fn a_gas_flow_has_states_events_and_columns_of_its_own() {
    let plain = run_case("turbo-diesel-120/flooded", &["models.gas_flow.model=orifice_network"]);
    let gauged = run_case("turbo-diesel-120/flooded", &["models.gas_flow.model=gauged"]);
    // Other steps, to the tolerance of the run (1e-4) each.
    let blow_by = |r| value(r, "blow_by");
    assert!(
        (blow_by(&gauged) / blow_by(&plain) - 1.0).abs() < 1e-3,
        "{} {}",
        blow_by(&gauged),
        blow_by(&plain)
    );

    let (p, reading, high) =
        (column(&gauged, "cylinder.p"), column(&gauged, "gas.reading"), column(&gauged, "gas.high"));
    let mean =
        |x: &[f64]| (x[1..].iter().sum::<f64>() + 0.5 * (x[0] - x[x.len() - 1])) / (x.len() - 1) as f64;
    // Over a cycle `∫ dx/dt = 0`: the mean reading is the mean pressure, but for what the trapezoidal rule over rows makes of the peak.
    assert!((mean(reading) / (mean(p) / 1e5) - 1.0).abs() < 2e-3, "{} {}", mean(reading), mean(p) / 1e5);
    for (x, above) in reading.iter().zip(high) {
        // Between rows the event is found to the accuracy of the step.
        assert!((x - ALARM).abs() < 1e-2 || (*above != 0.0) == (*x > ALARM), "{x} {above}");
    }
    assert!(high.contains(&1.0) && high.contains(&0.0));
}
