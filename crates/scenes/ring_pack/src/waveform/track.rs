//! Values over a cycle as polynomials over steps.

use std::cell::Cell;

use gudgeon_numerics::ode::StepView;

/// Places of the nodes of a cubic.
pub const THIRDS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
/// Most places in a step.
const MOST_PLACES: usize = 4;
/// Looks at a cycle, for means over it by which it is judged whether two are alike: these need be known to some parts in a hundred.
const LOOKS: usize = 240;

/// Some values over a cycle: in every step the polynomial through their values at some places in it.
#[derive(Debug, Clone)]
pub struct Track {
    width: usize,
    /// Places in a step, from 0 to 1, at most [`MOST_PLACES`], and for each one over the product of its distances from the others.
    places: &'static [f64],
    scale: [f64; MOST_PLACES],
    /// Ends of the steps, the start first.
    ends: Vec<f64>,
    /// Values at the places of each step.
    values: Vec<f64>,
    /// The step that was looked at last.
    last: Cell<usize>,
}

/// Means over a cycle.
#[derive(Debug, Clone, Copy)]
pub struct Change {
    /// Of the largest difference.
    pub change: f64,
    /// Of the largest value.
    pub size: f64,
}

/// Of no values.
impl Default for Track {
    fn default() -> Self {
        Self::new(0, &THIRDS)
    }
}

impl Track {
    pub fn new(width: usize, places: &'static [f64]) -> Self {
        debug_assert!(places.len() <= MOST_PLACES);
        let scale = |i: usize| {
            let others = places.iter().enumerate().filter(|(j, _)| *j != i);
            places.get(i).map_or(0.0, |at| 1.0 / others.map(|(_, p)| at - p).product::<f64>())
        };
        Self {
            width,
            places,
            scale: std::array::from_fn(scale),
            ends: Vec::new(),
            values: Vec::new(),
            last: Cell::new(0),
        }
    }

    /// Values at an instant.
    pub const fn width(&self) -> usize {
        self.width
    }

    pub const fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Ends of the steps, the start first.
    pub fn ends(&self) -> &[f64] {
        &self.ends
    }

    /// Forgets everything and begins anew at `t`, with as many values as `width` says.
    pub fn begin(&mut self, t: f64, width: usize) {
        self.width = width;
        self.ends.clear();
        self.values.clear();
        self.ends.push(t);
        self.last.set(0);
    }

    /// The same values all the time, zero where none is given.
    pub fn hold(&mut self, end: f64, values: impl Iterator<Item = f64> + Clone) {
        let width = self.width;
        self.begin(0.0, width);
        let all = || values.clone().chain(std::iter::repeat(0.0)).take(width);
        self.values.extend(self.places.iter().flat_map(|_| all()));
        self.ends.push(end);
    }

    /// Adds a step that ends at `t` with its values at all places.
    pub fn push(&mut self, t: f64, values: &[f64]) {
        self.values.extend_from_slice(values);
        self.ends.push(t);
    }

    /// Adds a step that ends at `t`, with the values that `at` gives for each place in it.
    pub fn add(&mut self, t: f64, mut at: impl FnMut(f64, &mut [f64])) {
        for x in self.places {
            let from = self.values.len();
            self.values.resize(from + self.width, 0.0);
            at(*x, &mut self.values[from..]);
        }
        self.ends.push(t);
    }

    /// Adds an accepted step, states and quadratures.
    pub fn step(&mut self, v: &dyn StepView) {
        let (t0, t1, n) = (v.t0(), v.t1(), v.y0().len());
        self.add(t1, |x, values| {
            let (y, q) = values.split_at_mut(n);
            if x == 0.0 {
                y.copy_from_slice(v.y0());
                q.copy_from_slice(v.q0());
            } else if x == 1.0 {
                y.copy_from_slice(v.y1());
                q.copy_from_slice(v.q1());
            } else {
                let t = t0 + x * (t1 - t0);
                v.interpolate(t, y);
                v.interpolate_quad(t, q);
            }
        });
    }

    /// Adds the steps of another, which begins where this one ends.
    pub fn append(&mut self, more: &Self) {
        self.values.extend_from_slice(&more.values);
        self.ends.extend_from_slice(&more.ends[1..]);
    }

    /// Its steps, the first `states` values being states, the others quadratures.
    pub fn steps(&self, states: usize) -> impl Iterator<Item = TrackStep<'_>> {
        (0..self.ends.len() - 1).map(move |step| TrackStep { track: self, step, states })
    }

    /// Values at `t` from number `first` on, as many as `out` holds.
    pub fn eval(&self, t: f64, first: usize, out: &mut [f64]) {
        self.eval_in(self.step_at(t), t, first, out);
    }

    /// Values at `t` by the polynomial of a step, from one of them on.
    fn eval_in(&self, step: usize, t: f64, first: usize, out: &mut [f64]) {
        let x = (t - self.ends[step]) / (self.ends[step + 1] - self.ends[step]);
        let (count, n) = (self.places.len(), out.len());
        let values = &self.values[step * count * self.width + first..];
        // Where there are fewer places the last one stands for those beyond, without a weight.
        let [a, b, c, d] = [0, 1, 2, 3].map(|i: usize| &values[i.min(count - 1) * self.width..][..n]);
        let w = self.weights(x);
        for (k, o) in out.iter_mut().enumerate() {
            *o = w[0] * a[k] + w[1] * b[k] + w[2] * c[k] + w[3] * d[k];
        }
    }

    /// Weights of the values at the places of a step for the part `x` of it (Lagrange).
    fn weights(&self, x: f64) -> [f64; MOST_PLACES] {
        let mut from = [1.0; MOST_PLACES];
        from.iter_mut().zip(self.places).for_each(|(d, p)| *d = x - p);
        let [a, b, c, d] = from;
        let (ab, cd) = (a * b, c * d);
        let products = [b * cd, a * cd, ab * d, ab * c];
        std::array::from_fn(|i| products[i] * self.scale[i])
    }

    /// The step that holds `t`, most often the last one or its neighbour.
    fn step_at(&self, t: f64) -> usize {
        let end = self.ends.len() - 2;
        let mut step = self.last.get().min(end);
        while step < end && t >= self.ends[step + 1] {
            step += 1;
        }
        while step > 0 && t < self.ends[step] {
            step -= 1;
        }
        self.last.set(step);
        step
    }

    /// Means over the cycle of the largest difference of the first `count` values from `other`, and of the largest of them.
    pub fn mean_change(&self, other: &Self, period: f64, count: usize) -> Change {
        let (mut a, mut b) = (vec![0.0; count], vec![0.0; count]);
        let mut sum = Change { change: 0.0, size: 0.0 };
        for k in 0..LOOKS {
            let t = period * (k as f64 + 0.5) / LOOKS as f64;
            self.eval(t, 0, &mut a);
            other.eval(t, 0, &mut b);
            let both = a.iter().zip(&b);
            sum.change += both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / LOOKS as f64;
            sum.size += a.iter().fold(0.0, |s: f64, a| s.max(a.abs())) / LOOKS as f64;
        }
        sum
    }
}

/// A step of a track.
pub struct TrackStep<'a> {
    track: &'a Track,
    step: usize,
    states: usize,
}

impl TrackStep<'_> {
    /// Values at one of the places in the step.
    fn at(&self, place: usize) -> &[f64] {
        let Track { width, places, values, .. } = self.track;
        &values[(self.step * places.len() + place) * width..][..*width]
    }
}

impl StepView for TrackStep<'_> {
    fn t0(&self) -> f64 {
        self.track.ends[self.step]
    }
    fn t1(&self) -> f64 {
        self.track.ends[self.step + 1]
    }
    fn y0(&self) -> &[f64] {
        &self.at(0)[..self.states]
    }
    fn y1(&self) -> &[f64] {
        &self.at(self.track.places.len() - 1)[..self.states]
    }
    fn q0(&self) -> &[f64] {
        &self.at(0)[self.states..]
    }
    fn q1(&self) -> &[f64] {
        &self.at(self.track.places.len() - 1)[self.states..]
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        self.track.eval_in(self.step, t, 0, y);
    }
    fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        self.track.eval_in(self.step, t, self.states, q);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_is_the_polynomial_through_its_places() {
        let cubic = |t: f64| 1.0 + t * (2.0 - t * (3.0 - 0.5 * t));
        let mut track = Track::new(1, &THIRDS);
        track.begin(0.0, 1);
        for (t0, t1) in [(0.0, 0.3), (0.3, 1.0)] {
            let values: Vec<f64> = THIRDS.iter().map(|x| cubic(t0 + x * (t1 - t0))).collect();
            track.push(t1, &values);
        }
        for t in [0.0, 0.1, 0.3, 0.95, 1.0, 0.2] {
            let mut out = [0.0];
            track.eval(t, 0, &mut out);
            // Four products of numbers of the order of one.
            assert!((out[0] - cubic(t)).abs() < 1e-14, "{t}: {} for {}", out[0], cubic(t));
        }
    }

    #[test]
    fn what_is_held_does_not_change() {
        let mut track = Track::new(2, &THIRDS);
        track.hold(4.0, [3.0].into_iter());
        let mut other = track.clone();
        other.hold(4.0, [5.0].into_iter());
        let change = track.mean_change(&other, 4.0, 2);
        // Sums of 240 equal numbers.
        assert!((change.change - 2.0).abs() < 1e-12 && (change.size - 3.0).abs() < 1e-12, "{change:?}");
    }
}
