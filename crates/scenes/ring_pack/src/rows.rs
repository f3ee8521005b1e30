//! Instants of a cycle that the series shows, kept as states and evaluated when everything else is done.
//!
//! A film finds its edges from where they were at the evaluation before. Rows that were evaluated while the cycle runs would change its
//! last digits, and so every result would depend on how many rows there are.

use gudgeon_core::EvalError;
use gudgeon_numerics::ode::StepView;

use super::films_between::Told;
use super::pack::Pack;
use super::record::Record;

/// States at the rows of a series.
#[derive(Debug, Clone)]
pub struct Rows {
    grid: Vec<f64>,
    /// Angle and states of every row so far, and the gas \[kg\] that has passed each ring and gone to the crankcase.
    theta: Vec<f64>,
    y: Vec<f64>,
    q: Vec<f64>,
    /// Flows \[kg/s\] past each ring and to the crankcase, of every row but the first.
    flows: Vec<f64>,
    /// What the models remember beside their states, of the first row and of every other whose films are not known; so many numbers of each.
    memory: Vec<f64>,
    remembered: usize,
    /// What the films did, of every row but the first, where that is known.
    films: Vec<Told>,
    /// What has passed on either side of a row, scratch.
    beside: [Vec<f64>; 2],
}

/// A row at the end of a step is its end, \[rad\].
const SLACK: f64 = 1e-9;
/// Part of a step over which a slope is taken to either side.
const BESIDE: f64 = 1e-3;

impl Rows {
    /// Rows `step` \[rad\] apart, or the nearest whole part of a cycle.
    #[must_use]
    pub fn new(pack: &Pack, step: f64) -> Self {
        let period = pack.period();
        let rows = (period / step).round().max(1.0) as usize;
        let (flows, count) = (pack.n_rings() + 1, rows + 1);
        Self {
            grid: (0..=rows).map(|k| period * k as f64 / rows as f64).collect(),
            theta: Vec::with_capacity(count),
            y: Vec::with_capacity(count * pack.layout.n),
            q: Vec::with_capacity(count * flows),
            flows: Vec::with_capacity(count * flows),
            memory: Vec::new(),
            remembered: 0,
            films: Vec::new(),
            beside: [vec![0.0; flows], vec![0.0; flows]],
        }
    }

    /// Keeps the start of the cycle.
    pub fn start(&mut self, pack: &mut Pack, y: &[f64]) {
        self.keep(pack, 0.0, |to| to.copy_from_slice(y), |q| q.fill(0.0));
        pack.save(&mut self.memory);
        self.remembered = self.memory.len();
    }

    /// Keeps the rows of an accepted step. To be called before its oil is booked.
    pub fn step(&mut self, pack: &mut Pack, v: &dyn StepView) {
        while let Some(&row) = self.grid.get(self.theta.len())
            && row <= v.t1() + SLACK
        {
            let t = row.min(v.t1());
            self.keep(pack, t, |y| v.interpolate(t, y), |q| v.interpolate_quad(t, q));
            self.keep_flows(pack, v, t);
            match &pack.between {
                Some(films) => self.films.extend(films.at(t)),
                None => pack.save(&mut self.memory),
            }
        }
    }

    /// Keeps the flows at `t` as slopes of what has passed: next to a wide passage a flow that is evaluated magnifies what dense output lacks.
    fn keep_flows(&mut self, pack: &Pack, v: &dyn StepView, t: f64) {
        let beside = BESIDE * (v.t1() - v.t0());
        let (from, to) = ((t - beside).max(v.t0()), (t + beside).min(v.t1()));
        for (q, t) in self.beside.iter_mut().zip([from, to]) {
            v.interpolate_quad(t, q);
        }
        let [before, after] = &self.beside;
        let slopes = before.iter().zip(after).map(|(a, b)| (b - a) / (to - from) * pack.omega);
        self.flows.extend(slopes);
    }

    fn keep(
        &mut self,
        pack: &mut Pack,
        t: f64,
        states: impl FnOnce(&mut [f64]),
        passed: impl FnOnce(&mut [f64]),
    ) {
        self.theta.push(self.grid[self.theta.len()]);
        let (y, q) = (self.y.len(), self.q.len());
        self.y.resize(y + pack.layout.n, 0.0);
        self.q.resize(q + pack.n_rings() + 1, 0.0);
        states(&mut self.y[y..]);
        passed(&mut self.q[q..]);
        if let Some(oil) = &mut pack.oil_pack {
            oil.place(&self.y[y..][pack.layout.oil.clone()], pack.kinematics.motion(t).y);
        }
    }

    /// Evaluates the rows.
    ///
    /// # Errors
    /// What a sub-model refuses.
    pub fn record(&self, pack: &mut Pack) -> Result<Record, EvalError> {
        let mut record = Record::new(pack, self.theta.len());
        let (n, dim) = (pack.n_rings(), pack.layout.n);
        for (k, &theta) in self.theta.iter().enumerate() {
            let y = &self.y[k * dim..][..dim];
            if let Some(films) = k.checked_sub(1).and_then(|k| self.films.get(k * n..(k + 1) * n)) {
                pack.evaluate_beside(films.iter().copied(), theta, y)?;
            } else {
                pack.evaluate_again(theta, y, Some(&self.memory[k * self.remembered..][..self.remembered]))?;
                (0..n).try_for_each(|i| pack.film_peak(i))?;
            }
            let passed = &self.q[k * (n + 1)..][..=n];
            if let Some(first) = k.checked_sub(1) {
                let flows = &self.flows[first * (n + 1)..][..=n];
                pack.at.gas.flow_in.copy_from_slice(&flows[..n]);
                pack.at.gas.flow_out[n - 1] = flows[n];
            }
            record.push(theta, pack, &passed[..n], passed[n]);
        }
        Ok(record)
    }
}
