//! The five-volume gas network over a cycle: the problem of the bench and of the races.
#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use gudgeon_core::EvalError;
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{Network, Orifice, OrificeFormula, Passage};
use gudgeon_numerics::ode::{LinearInvariant, OdeSystem};

pub const N: usize = 5;
/// Node of the chamber.
const CH: usize = 5;
/// Node of the crankcase.
const CC: usize = 6;
/// Joined nodes and effective area \[m²\].
const LINKS: [((usize, usize), f64); 9] = [
    ((CH, 0), 3e-7),
    ((CH, 1), 1.2e-7),
    ((0, 1), 1.5e-7),
    ((1, 2), 3e-7),
    ((1, 3), 1.6e-7),
    ((2, 3), 1e-7),
    ((3, 4), 4e-7),
    ((3, CC), 1e-6),
    ((4, CC), 2e-6),
];
/// Sizes \[m³\].
const VOLUMES: [f64; N] = [1.2e-7, 6e-7, 1e-7, 5e-7, 2e-7];
/// Pressures \[Pa\] at the start of the periodic cycle.
const START: [f64; N] = [
    100018.5728228574880631641,
    100049.1854464881180319935,
    100046.3416580167831853032,
    100008.2727634799521183595,
    100001.4000864467234350741,
];
const R: f64 = 287.0;
const TEMPERATURE: f64 = 450.0;
const CRANKCASE: f64 = 1e5;
/// Crank speed \[deg/s\]: 3000 rpm.
const OMEGA: f64 = 18_000.0;
pub const CYCLE: f64 = 720.0 / OMEGA;
pub struct GasNet {
    net: Network,
    /// Time of the last Jacobian and the rates by time that came with it.
    at: f64,
    by_time: [f64; N + 2],
    invariants: Vec<LinearInvariant>,
}

impl GasNet {
    pub fn new() -> Self {
        let law = Orifice {
            discharge: quantity(1.0),
            law: OrificeFormula::Isentropic,
            laminar: quantity(1e-3),
            ..Orifice::default()
        }
        .build(1.33, R)
        .expect("the orifice law builds");
        let ends = LINKS.map(|l| l.0);
        let mut net = Network::new(law, R, &[TEMPERATURE; N + 2], N, &ends).expect("the network builds");
        for (l, (_, area)) in LINKS.into_iter().enumerate() {
            net.set_passage(l, Passage::Orifice { area });
        }
        net.set_pressure("bench", CC, CRANKCASE).expect("a pressure");
        // What leaves the chamber goes into the volumes or the crankcase.
        let terms = (0..=N).map(|row| (row, 1.0)).chain([(N + 1, -1.0)]).collect();
        Self {
            net,
            at: f64::NAN,
            by_time: [0.0; N + 2],
            invariants: vec![LinearInvariant { pivot: N + 1, terms }],
        }
    }

    fn set(&mut self, t: f64, y: &[f64]) -> Result<(), EvalError> {
        for (i, (&m, v)) in y.iter().zip(VOLUMES).enumerate() {
            self.net.set_mass("bench", i, m, v)?;
        }
        self.net.set_pressure("bench", CH, chamber(t * OMEGA).0)
    }

    pub fn start() -> [f64; N] {
        std::array::from_fn(|i| START[i] * VOLUMES[i] / (R * TEMPERATURE))
    }
}

/// Pressure in the chamber \[Pa\], compression and a combustion pulse, and its derivative \[Pa/deg\].
fn chamber(deg: f64) -> (f64, f64) {
    let (a, b) = ((deg - 360.0) / 55.0, (deg - 370.0) / 18.0);
    let (compression, combustion) = (11e5 * (-a * a).exp(), 68e5 * (-0.5 * b * b).exp());
    (1e5 + compression + combustion, -2.0 * a / 55.0 * compression - b / 18.0 * combustion)
}

impl OdeSystem for GasNet {
    fn dim(&self) -> usize {
        N
    }

    /// Into the crankcase, out of the chamber.
    fn quad_dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.set(t, y)?;
        self.net.update_flows();
        let (rates, quadratures) = f.split_at_mut(N);
        self.net.rates(rates);
        quadratures[0] = self.net.flow(7) + self.net.flow(8);
        quadratures[1] = self.net.flow(0) + self.net.flow(1);
        Ok(())
    }

    fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        self.set(t, y)?;
        self.net.update_partials();
        let (rates, quadratures) = jac.split_at_mut(N * N);
        self.net.jacobian(rates);
        quadratures.fill(0.0);
        for (row, link) in [(0, 7), (0, 8), (1, 0), (1, 1)] {
            self.net.add_flow_gradient(link, 1.0, &mut quadratures[row * N..row * N + N]);
        }
        // Time enters by the pressure in the chamber alone.
        let rate = chamber(t * OMEGA).1 * OMEGA;
        let into = [0, 1].map(|link| self.net.partials(link)[0] * rate);
        self.at = t;
        self.by_time = [into[0], into[1], 0.0, 0.0, 0.0, 0.0, into[0] + into[1]];
        Ok(true)
    }

    fn time_derivative(&mut self, t: f64, _: &[f64], _: &[f64], dfdt: &mut [f64]) -> Result<bool, EvalError> {
        // The integrator asks for it where it has just asked for the Jacobian.
        dfdt.copy_from_slice(&self.by_time);
        Ok(self.at == t)
    }

    fn invariants(&self) -> &[LinearInvariant] {
        &self.invariants
    }
}

/// Tolerances of the race: errors scatter from one to the next.
pub fn fan() -> Vec<f64> {
    (0..101).map(|k| 10f64.powf(-1.0 - 0.1 * f64::from(k))).collect()
}
