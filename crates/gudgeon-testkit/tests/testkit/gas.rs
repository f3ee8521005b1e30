//! A gas flow: one volume between cylinder and crankcase, each flow proportional to the pressure difference.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{GasFlow, GasIn, GasOut, GasPartials, gas_mass};
use gudgeon_core::states::{StateInfo, Stateful};
use gudgeon_testkit::{Tolerance, assert_none, gas_flow};

/// Pressure over mass \[Pa/kg\] and flow over pressure difference \[kg/(s Pa)\].
const STIFFNESS: f64 = 2e11;
const LEAK: f64 = 1e-9;

struct OneVolume {
    states: [StateInfo; 1],
    /// Gas that vanishes \[kg/s\].
    lost: f64,
    /// Factor of the partial derivatives, less one.
    off: f64,
    /// Part of the last cylinder pressure that is remembered.
    remembers: f64,
    last: f64,
    /// What `rates_moved` adds, and `rates_standing`.
    moved: f64,
    standing: f64,
}

impl Default for OneVolume {
    fn default() -> Self {
        let states = [gas_mass("ring1.back")];
        Self { states, lost: 0.0, off: 0.0, remembers: 0.0, last: 0.0, moved: 0.0, standing: 0.0 }
    }
}

impl Stateful for OneVolume {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
}

impl GasFlow for OneVolume {
    fn uses_film_height(&self) -> bool {
        false
    }
    fn at_pressures(&self, _: &GasIn<'_>, p_land: &[f64], state: &mut [f64]) {
        state[0] = 0.5 * (p_land[0] + p_land[1]) / STIFFNESS;
    }
    fn pressures(&mut self, inp: &GasIn<'_>, state: &[f64], out: &mut GasOut) -> Result<(), EvalError> {
        (out.p_land[0], out.p_land[1], out.p_back[0]) =
            (inp.p_cylinder, inp.p_crankcase, STIFFNESS * state[0]);
        Ok(())
    }
    fn rates(
        &mut self,
        inp: &GasIn<'_>,
        m: &[f64],
        d: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.pressures(inp, m, out)?;
        out.flow_in[0] = LEAK * (inp.p_cylinder + self.remembers * self.last - out.p_back[0]);
        out.flow_out[0] = LEAK * (out.p_back[0] - inp.p_crankcase);
        d[0] = out.flow_in[0] - out.flow_out[0] - self.lost;
        self.last = inp.p_cylinder;
        Ok(())
    }
    fn partials(&mut self, _: &GasIn<'_>, _: &[f64], p: &mut GasPartials) -> Result<bool, EvalError> {
        let k = (1.0 + self.off) * LEAK * STIFFNESS;
        p.d_state[0] = -2.0 * k;
        (p.p_back[0], p.flow_in[0], p.flow_out[0]) = (STIFFNESS, -k, k);
        p.p_land.fill(0.0);
        Ok(true)
    }
    fn rates_standing(
        &mut self,
        inp: &GasIn<'_>,
        m: &[f64],
        d: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.rates(inp, m, d, out)?;
        d[0] += self.standing;
        Ok(())
    }
    fn rates_moved(
        &mut self,
        _: usize,
        inp: &GasIn<'_>,
        m: &[f64],
        d: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.rates(inp, m, d, out)?;
        d[0] += self.moved;
        Ok(())
    }
}

#[test]
fn a_gas_flow_is_checked() {
    let rings = [RingPlace::default()];
    let inp = GasIn { p_cylinder: 30e5, p_crankcase: 1e5, rings: &rings };
    // A linear law: differences are exact but for rounding, over 2e-5 of the mass some 1e-16/2e-5 = 5e-12 of the value.
    let tolerance = Tolerance { relative: 1e-9, ..Tolerance::default() };
    let check = |mut m: OneVolume| gas_flow(&mut m, &inp, &[30e5, 1e5], tolerance);
    assert_none(check(OneVolume::default()));
    let spoiled = [
        ("the volumes gain", OneVolume { lost: 1e-9, ..OneVolume::default() }),
        ("the partial is", OneVolume { off: 1e-6, ..OneVolume::default() }),
        ("after another instant", OneVolume { remembers: 1e-9, ..OneVolume::default() }),
        ("rates_standing differs", OneVolume { standing: 1e-9, ..OneVolume::default() }),
        ("rates_moved of ring 0", OneVolume { moved: 1e-9, ..OneVolume::default() }),
        ("not finite", OneVolume { lost: f64::NAN, ..OneVolume::default() }),
    ];
    for (complaint, model) in spoiled {
        let found = check(model);
        assert!(found.iter().any(|c| c.contains(complaint)), "{complaint}: {found:?}");
    }
}
