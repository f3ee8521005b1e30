//! Cycles of the gas network of `benches/gas_network.rs` by diffsol's BDF, as one JSON array for `race.py`: the same evaluation of rates and partial
//! derivatives, with the blow-by as a sixth state within the error control.

use std::cell::RefCell;
use std::time::Instant;

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use gudgeon_numerics::ode::OdeSystem;

#[path = "../../problems/gas_network.rs"]
mod problem;

use problem::{CYCLE, GasNet, N, fan};

/// The volumes and the blow-by.
const STATES: usize = N + 1;

/// The network with its last Jacobian: diffsol asks for products with it, one column after the other.
struct Cached {
    net: GasNet,
    at: (f64, [f64; N]),
    jacobian: [f64; N * (N + 2)],
}

impl Cached {
    fn rates(&mut self, t: f64, y: &[f64], out: &mut [f64]) {
        let mut f = [0.0; N + 2];
        match self.net.rhs(t, &y[..N], &mut f) {
            Ok(()) => out.copy_from_slice(&f[..STATES]),
            Err(_) => out.fill(f64::NAN),
        }
    }

    fn product(&mut self, t: f64, y: &[f64], v: &[f64], out: &mut [f64]) {
        if self.at.0 != t || self.at.1 != y[..N] {
            if self.net.jacobian(t, &y[..N], &[], &mut self.jacobian).is_err() {
                self.jacobian.fill(f64::NAN);
            }
            self.at.0 = t;
            self.at.1.copy_from_slice(&y[..N]);
        }
        for (out, row) in out.iter_mut().zip(self.jacobian.chunks_exact(N)) {
            *out = row.iter().zip(v).map(|(j, v)| j * v).sum();
        }
    }
}

/// Blow-by, steps and iterations of a cycle, and its time \[µs\] with the making of the solver.
fn cycle(rtol: f64) -> Result<(f64, usize, usize, f64), String> {
    let start = GasNet::start();
    let system =
        RefCell::new(Cached { net: GasNet::new(), at: (f64::NAN, [0.0; N]), jacobian: [0.0; N * (N + 2)] });
    let atol = start.iter().copied().chain([1e-6]).map(|s| rtol * s);
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(rtol)
        .atol(atol)
        .rhs_implicit(
            |y, _, t, out| system.borrow_mut().rates(t, y, out),
            |y, _, t, v, out| system.borrow_mut().product(t, y, v, out),
        )
        .init(
            |_, _, y| {
                y[..N].copy_from_slice(&start);
                y[N] = 0.0;
            },
            STATES,
        )
        .h0(1e-6)
        .build()
        .map_err(|e| e.to_string())?;
    let begin = Instant::now();
    let mut solver = problem.bdf::<NalgebraLU<f64>>().map_err(|e| e.to_string())?;
    solver.set_stop_time(CYCLE).map_err(|e| e.to_string())?;
    while !matches!(solver.step().map_err(|e| e.to_string())?, OdeSolverStopReason::TstopReached) {}
    let microseconds = begin.elapsed().as_secs_f64() * 1e6;
    let stats = solver.get_statistics();
    let counts = (stats.number_of_steps, stats.number_of_nonlinear_solver_iterations);
    Ok((solver.state().y[N], counts.0, counts.1, microseconds))
}

fn main() {
    let mut rows = Vec::new();
    for rtol in fan() {
        let mut runs: Vec<_> = (0..15).filter_map(|_| cycle(rtol).ok()).collect();
        if runs.len() < 15 {
            continue;
        }
        runs.sort_by(|a, b| a.3.total_cmp(&b.3));
        let (blow_by, steps, rhs, microseconds) = runs[7];
        rows.push(
            serde_json::json!({ "code": "diffsol BDF J, compiled", "rtol": rtol, "steps": steps, "rhs": rhs,
            "blow_by": blow_by, "microseconds": microseconds }),
        );
    }
    println!("{}", serde_json::Value::Array(rows));
}
