//! The scheme of tomanik1993: degree by degree, three seats, gas explicit in sub-steps.
//!
//! At each whole degree the seats follow from the axial balance with the pressures and the film force known there; the
//! gas network is marched explicitly over the degree with that geometry; then the film of each ring is found at the end
//! of the degree by bisection between the floor and `solver.limits.thickest_film`, 60 µm in the source, with `dh/dt = (h - h_old)/Δt`. Cycles repeat until the state
//! does, or for the number asked.

use gudgeon_core::EvalError;

use super::measure::Measures;
use super::pack::Pack;
use super::record::{Record, Totals};
use super::watch::Watch;

/// Settings; see [`crate::case::Solver`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Cycles; 0 until periodic.
    pub cycles: u32,
    /// Most cycles when running until periodic.
    pub max_cycles: u32,
    /// Marching steps per degree (the source has one).
    pub steps: u32,
    /// Gas steps per marching step.
    pub gas_steps: u32,
    /// Relative change of the state over a cycle that ends the run.
    pub tolerance: f64,
}

/// Interval at which the bisection stops \[m\].
const RESOLUTION: f64 = 1e-13;

/// What a run found.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    /// Totals of the last cycle.
    pub totals: Totals,
    /// Marching steps.
    pub steps: u64,
    /// Cycles run.
    pub cycles: u32,
    /// Cycles after which the state repeats: 1 normally, more for a periodic state of higher order, 0 when none was seen.
    pub period: u32,
}

/// Runs the scheme; calls `progress` with the fraction done.
///
/// # Errors
/// What a sub-model refuses.
pub fn run(
    pack: &mut Pack,
    set: Settings,
    start: f64,
    (record, measures, watch): (&mut Record, &mut Measures, &mut Watch),
    progress: &mut dyn FnMut(f64),
) -> Result<Outcome, EvalError> {
    let n = pack.n_rings();
    let mut y = vec![0.0; pack.layout.n];
    pack.initial(start, &mut y);
    let mut h: Vec<f64> = (0..n).map(|i| pack.at.places[i].h).collect();
    let per_cycle = (pack.period().to_degrees().round() as u32) * set.steps;
    let step = pack.period() / f64::from(per_cycle);
    let dt = step / pack.omega;
    let dt_gas = dt / f64::from(set.gas_steps);
    let limit = if set.cycles > 0 { set.cycles } else { set.max_cycles };
    let mut out = Outcome::default();
    // States at the starts of the last cycles, to see when one comes back.
    let mut history: Vec<Vec<f64>> = Vec::new();
    let mut recording = set.cycles == 1;
    for cycle in 1..=limit {
        let mut totals = Totals { flow_in: vec![0.0; n], friction_work: vec![0.0; n], ..Totals::default() };
        let before: f64 = pack.masses.iter().sum();
        if recording {
            *watch = Watch::new(pack);
        }
        for k in 0..per_cycle {
            let theta = f64::from(k) * step;
            instant(pack, theta, &h);
            pack.gas_pressures(pack.cylinder.pressure(theta))?;
            pack.decide_seats();
            instant(pack, theta, &h);
            if recording {
                pack.gas(None)?;
                record.push(theta, pack, &totals.flow_in, totals.blow_by);
                measures.march(theta, pack, totals.flow_in[0]);
            }
            for g in 0..set.gas_steps {
                let p =
                    pack.cylinder.pressure(theta + step * (f64::from(g) + 0.5) / f64::from(set.gas_steps));
                pack.gas_step(p)?;
                for (m, dm) in pack.masses.iter_mut().zip(&pack.at.dm) {
                    *m += dm * dt_gas;
                }
                for (sum, w) in totals.flow_in.iter_mut().zip(&pack.at.gas.flow_in) {
                    *sum += w * dt_gas;
                }
                totals.blow_by += pack.at.gas.flow_out[n - 1] * dt_gas;
            }
            let end = theta + step;
            instant(pack, end, &h);
            pack.gas_pressures(pack.cylinder.pressure(end))?;
            if pack.plan.film {
                for (i, h) in h.iter_mut().enumerate() {
                    let old = *h;
                    *h = bisect(pack, i, old, dt)?;
                    pack.set_place(i, *h, None);
                    pack.friction_at(i, (*h - old) / dt)?;
                    totals.friction_work[i] += pack.at.rings[i].power * dt;
                    // Held at the end of the interval against what presses it further off.
                    if *h >= pack.limits.thickest_film - 2.0 * RESOLUTION {
                        let r = &mut pack.at.rings[i];
                        r.limited.thickest = (r.film.load + r.contact - r.load).max(0.0);
                    }
                }
            }
            if recording {
                watch.look(pack, step);
            }
            out.steps += 1;
        }
        if recording {
            pack.gas(None)?;
            record.push(pack.period(), pack, &totals.flow_in, totals.blow_by);
            measures.march(pack.period(), pack, totals.flow_in[0]);
        }
        let after: f64 = pack.masses.iter().sum();
        let through = totals.flow_in[0].abs().max(totals.blow_by.abs()).max(f64::MIN_POSITIVE);
        totals.balance.gas_mass =
            Some(((totals.flow_in[0] - totals.blow_by) - (after - before)).abs() / through);
        let state: Vec<f64> = pack
            .masses
            .iter()
            .zip(&pack.mass_scale)
            .map(|(m, s)| m / s)
            .chain(h.iter().map(|h| h / 1e-6))
            .chain(pack.rings.iter().flat_map(|r| r.motion.decided().iter().copied()))
            .collect();
        let change = |a: &[f64]| {
            a.iter().zip(&state).map(|(a, b)| (a - b).abs() / b.abs().max(0.1)).fold(0.0, f64::max)
        };
        totals.periodicity_error = history.last().map_or(1.0, |h| change(h));
        let back = history.iter().rev().position(|h| change(h) <= set.tolerance).map(|p| p as u32 + 1);
        history.push(state);
        out.totals = totals;
        out.cycles = cycle;
        out.period = back.unwrap_or(0);
        progress(f64::from(cycle) / f64::from(limit));
        if recording {
            break;
        }
        // The recorded cycle comes last: when the state repeats, or when the number of cycles is reached.
        recording = if set.cycles > 0 {
            cycle + 1 == set.cycles
        } else {
            (cycle >= 3 && back.is_some()) || cycle + 1 >= limit
        };
    }
    Ok(out)
}

fn instant(pack: &mut Pack, theta: f64, h: &[f64]) {
    pack.at.theta = theta;
    pack.at.piston = pack.kinematics.motion(theta);
    pack.counters.instants += 1;
    for (i, h) in h.iter().enumerate() {
        pack.refresh_ring(i, *h, None);
    }
}

fn bisect(pack: &mut Pack, i: usize, old: f64, dt: f64) -> Result<f64, EvalError> {
    let floor = pack.lowest(i).max(RESOLUTION);
    let needed = pack.radial_load(i);
    let excess = |p: &mut Pack, h: f64| -> Result<f64, EvalError> {
        p.set_place(i, h, None);
        let solid = p.rings[i].contact.load(h);
        Ok(p.film(i, (h - old) / dt)?.load + solid - needed)
    };
    if excess(pack, floor)? <= 0.0 {
        return Ok(floor);
    }
    let (mut low, mut high) = (floor, pack.limits.thickest_film);
    while high - low > RESOLUTION {
        let mid = 0.5 * (low + high);
        if excess(pack, mid)? > 0.0 { low = mid } else { high = mid }
    }
    Ok(0.5 * (low + high))
}
