//! Maximum and minimum over the cycle of a sum of orders.

mod derivatives;
mod waves;

use std::f64::consts::PI;

use derivatives::{Derivatives, Sizes};
use gudgeon_numerics::elementary;
use gudgeon_numerics::vectors::{Vectorised, widest};
use waves::{Waves, multiples};

/// Least number of points per wave of the highest order on the finest grid.
const POINTS: usize = 8;
/// Grids: each has half the points of the one before.
const GRIDS: usize = 4;
/// Least number of points of a grid: a quarter of it is a block that is summed up at once.
const FEWEST: usize = 32;
/// Maximum over `[-1, 1]` of `|x (x² - 1)|/6`: what a parabola through three points misses of a third derivative of one.
const PARABOLA: f64 = 0.064_150_029_909_958_42;
/// What parabolas may miss on a grid that is coarser than the finest, by the root mean square of the sum: the most that they miss of any sum on
/// the finest one.
const MISSED: f64 = 0.02;

/// What a second difference may miss of the second derivative between the neighbours of a point, by the fourth one.
const CURVED: f64 = 1.0 / 12.0 + 1.0 / 8.0;

/// What a top may miss by the root of the sum of all squared amplitudes: some rounding errors.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Points in front of a period and behind it: two neighbours of every point are looked at.
const BESIDE: usize = 2;
/// Points that are looked at together for tops; a grid has a multiple of them.
const TOGETHER: usize = 8;

/// Finds the extremes of `m + Σ Re(a_k e^{i n_k θ})` over a period of θ.
#[derive(Debug, Clone)]
pub struct Cycle {
    sum: Derivatives,
    period: f64,
    /// The highest order by that of the period.
    highest: f64,
    multiples: Vec<usize>,
    /// Points of the finest grid.
    points: usize,
    /// From the finest on; made when they are first looked at.
    grids: [Option<Waves>; GRIDS],
    /// The sum at the points, the first half a step from the beginning, with the last [`BESIDE`] in front and the first ones behind.
    wave: Vec<f64>,
}

/// How the sum at hand is looked at.
#[derive(Debug, Clone, Copy)]
struct Look {
    /// Distance of the points \[rad\].
    step: f64,
    /// The most that a top can lie above the point next to it.
    above: f64,
    /// The most that it can lie above that of the parabola through three points.
    missed: f64,
    /// Second difference below which there is one top.
    one_top: f64,
    /// What a top may miss.
    admitted: f64,
    /// Bounds of the fifth and sixth derivative.
    fifth: f64,
    sixth: f64,
}

/// Maximum and minimum of the waves.
struct Search<'c>(&'c mut Cycle);

impl Vectorised for Search<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run(self) -> [f64; 2] {
        let sizes = self.0.sum.sizes();
        let mut grid = self.0.grid(&sizes);
        loop {
            if let Some(extremes) = self.0.on_grid(grid, &sizes) {
                return extremes;
            }
            grid -= 1;
        }
    }
}

impl Cycle {
    /// For some orders, and the period after which their sum repeats \[rad\].
    #[must_use]
    pub fn new(orders: &[f64], period: f64) -> Self {
        let highest = orders.iter().copied().fold(0.0, f64::max) * period / (2.0 * PI);
        let multiples = multiples(orders, period);
        Self {
            sum: Derivatives::new(orders, period, &multiples),
            period,
            highest,
            multiples,
            points: (POINTS * highest.ceil() as usize).next_power_of_two().max(64),
            grids: [const { None }; GRIDS],
            wave: Vec::new(),
        }
    }

    /// The orders it was made for.
    #[must_use]
    pub fn orders(&self) -> &[f64] {
        self.sum.orders()
    }

    /// Maximum and minimum, for a mean and the phasors of the orders: real and imaginary parts, one of each order.
    pub fn extremes(&mut self, mean: f64, phasors: [&[f64]; 2]) -> [f64; 2] {
        self.sum.take(phasors);
        let [high, low] = widest(Search(self));
        [mean + high, mean + low]
    }

    /// Maximum and minimum of the waves, looked for on a grid; none where it is too coarse, which the finest never is.
    #[inline(always)]
    fn on_grid(&mut self, grid: usize, sizes: &Sizes) -> Option<[f64; 2]> {
        self.sum_on(grid);
        let (low, high) = range(&self.wave);
        let half = 0.5 * (high - low);
        if half <= 0.0 {
            return Some([high.max(0.0), low.min(0.0)]);
        }
        let step = self.step(grid);
        let [above, missed] = self.above(half, step, sizes);
        let one_top = if grid == 0 { f64::INFINITY } else { -CURVED * sizes.fourth * step.powi(4) };
        let admitted = ROUNDING * sizes.square.sqrt();
        let look = Look { step, above, missed, one_top, admitted, fifth: sizes.fifth, sixth: sizes.sixth };
        self.tops(high, low, &look)
    }

    /// Distance of the points of a grid.
    #[inline(always)]
    fn step(&self, grid: usize) -> f64 {
        self.period / (self.points >> grid) as f64
    }

    /// The coarsest grid that is fine enough for most sums.
    #[inline(always)]
    fn grid(&self, sizes: &Sizes) -> usize {
        let admitted = MISSED * (0.5 * sizes.square).sqrt();
        let fine = |g: usize| PARABOLA * self.step(g).powi(3) * sizes.third <= admitted;
        (1..GRIDS).take_while(|g| self.points >> g >= FEWEST && fine(*g)).last().unwrap_or(0)
    }

    /// The sum at the points of a grid.
    #[inline(always)]
    fn sum_on(&mut self, g: usize) {
        let points = self.points >> g;
        let (orders, multiples) = (self.sum.orders(), &self.multiples);
        let waves = self.grids[g].get_or_insert_with(|| Waves::new(orders, self.period, points, multiples));
        self.wave.resize(points + 2 * BESIDE, 0.0);
        waves.sum(self.sum.phasors(), &mut self.wave[BESIDE..][..points]);
        self.wave.copy_within(points..points + BESIDE, 0);
        self.wave.copy_within(BESIDE..2 * BESIDE, points + BESIDE);
    }

    /// How far a top can lie above a point at most half a step away, and above the parabola through the three points about it.
    ///
    /// A sum of waves up to order n that swings by A about some mean falls no faster from its top than `A cos n x` would (a lemma of M. Riesz),
    /// so a point at half a step from the top is no lower than `A (1 - cos)` below it, and A is at most the swing of the points over
    /// that cosine. Its third derivative is at most `n³ A` (Bernstein): no top is higher than that of the parabola through three points by
    /// more than [`PARABOLA`] times that. Both derivatives are at most the sums of those of all waves as well, which is less where the
    /// high orders are small.
    #[inline(always)]
    fn above(&self, half: f64, step: f64, sizes: &Sizes) -> [f64; 2] {
        let turn = self.highest * 2.0 * PI / self.period * step;
        let own = [0.125 * sizes.second * step * step, PARABOLA * sizes.third * step.powi(3)];
        let cosine = elementary::cos(0.5 * turn);
        if turn >= 0.5 * PI {
            return own;
        }
        let swing = half / cosine;
        [own[0].min(swing * (1.0 - cosine)), own[1].min(PARABOLA * turn.powi(3) * swing)]
    }

    /// Maximum and minimum of the wave, whose highest and lowest point are `high` and `low`; none where two tops may stand between
    /// neighbours of a point.
    #[inline(always)]
    fn tops(&self, high: f64, low: f64, look: &Look) -> Option<[f64; 2]> {
        let n = self.wave.len() - 2 * BESIDE;
        let (top, bottom) = (high - look.above, low + look.above);
        let (mut best, mut least) = (high, -low);
        for (k, some) in self.wave[BESIDE..][..n].as_chunks::<TOGETHER>().0.iter().enumerate() {
            // Nearly everywhere there is nothing, which is found out without a branch.
            let mut found = [0; TOGETHER];
            for i in 0..TOGETHER {
                found[i] = u64::from((some[i] >= top) | (some[i] <= bottom));
            }
            if found == [0; TOGETHER] {
                continue;
            }
            for (i, here) in some.iter().enumerate() {
                if found[i] == 0 {
                    continue;
                }
                let s = BESIDE + k * TOGETHER + i;
                if *here >= top {
                    best = self.top(s, 1.0, best, look)?;
                }
                if *here <= bottom {
                    least = self.top(s, -1.0, least, look)?;
                }
            }
        }
        Some([best, -least])
    }

    /// The larger of `best` and the top of `sign` times the wave about point `s`, where there is one.
    #[inline(always)]
    fn top(&self, s: usize, sign: f64, best: f64, look: &Look) -> Option<f64> {
        let (before, here, after) = (sign * self.wave[s - 1], sign * self.wave[s], sign * self.wave[s + 1]);
        if here < before || here <= after {
            return Some(best);
        }
        let curve = before - 2.0 * here + after;
        let shift = if curve < 0.0 { 0.5 * (before - after) / curve } else { 0.0 };
        if here - 0.25 * (before - after) * shift + look.missed <= best {
            return Some(best);
        }
        if self.curve(s, sign) > look.one_top {
            return None;
        }
        Some(best.max(self.climb((s - BESIDE) as f64 + 0.5 + shift, sign, look)))
    }

    /// The largest second difference at a point and its neighbours.
    ///
    /// The second derivative at these points differs from it by at most a twelfth of the fourth one, and between them from the straight line by at
    /// most an eighth of it: [`CURVED`] is their sum.
    #[inline(always)]
    fn curve(&self, s: usize, sign: f64) -> f64 {
        let curve =
            |s: usize| sign * self.wave[s - 1] - 2.0 * (sign * self.wave[s]) + sign * self.wave[s + 1];
        curve(s - 1).max(curve(s)).max(curve(s + 1))
    }

    /// The top near a place between points, the first of which stands at one half, by Newton's method on the Taylor polynomial of degree four, at most one point away.
    ///
    /// A step of `x` ends once that of degree five leaves out no more than is admitted, `M x⁶/720` by the bound `M` of the sixth derivative; or once the top of
    /// the polynomial is so close to that of the sum, `M x⁴/24` of the fifth one by the second, that the sum there is no more lower than that.
    #[inline(always)]
    fn climb(&self, s: f64, sign: f64, look: &Look) -> f64 {
        let mut at = s * look.step;
        let (from, to) = (at - look.step, at + look.step);
        let mut best = f64::NEG_INFINITY;
        for _ in 0..20 {
            let mut derivatives = self.sum.at(at);
            derivatives.iter_mut().for_each(|d| *d *= sign);
            let [value, first, second, third, fourth, fifth] = derivatives;
            best = best.max(value);
            let slope = |x: f64| first + x * (second + x * (third / 2.0 + x * fourth / 6.0));
            let curve = |x: f64| second + x * (third + x * fourth / 2.0);
            let halley = first * second / (0.5 * first * third - second * second);
            let near = halley - slope(halley) / curve(halley);
            let top = near - slope(near) / curve(near);
            let by = if second < 0.0 && top.is_finite() { top } else { 0.25 * look.step * first.signum() };
            let next = (at + by).clamp(from, to);
            let by = next - at;
            if look.sixth * by.powi(6) <= 720.0 * look.admitted {
                let taylor = third / 6.0 + by * (fourth / 24.0 + by * fifth / 120.0);
                return best.max(value + by * (first + by * (second / 2.0 + by * taylor)));
            }
            let left = look.fifth * by.powi(4) / 24.0;
            if second < 0.0 && (slope(by).abs() + left).powi(2) <= 2.0 * look.admitted * curve(by).abs() {
                return best.max(sign * self.sum.value(next));
            }
            at = next;
        }
        best
    }
}

/// Minimum and maximum of some numbers, eight side by side.
#[inline(always)]
fn range(wave: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = ([f64::INFINITY; 8], [f64::NEG_INFINITY; 8]);
    let (whole, rest) = wave.as_chunks::<8>();
    for w in whole {
        for l in 0..8 {
            low[l] = if w[l] < low[l] { w[l] } else { low[l] };
        }
        for l in 0..8 {
            high[l] = if w[l] > high[l] { w[l] } else { high[l] };
        }
    }
    (extreme(&low, rest, |a, b| a < b), extreme(&high, rest, |a, b| a > b))
}

/// The one of some numbers that comes before all others. A function of its own, so that the lanes of [`range`] stay side by side.
#[inline(never)]
fn extreme(lanes: &[f64; 8], rest: &[f64], before: impl Fn(f64, f64) -> bool) -> f64 {
    let mut best = lanes[0];
    for some in [lanes.as_slice(), rest] {
        for w in some {
            best = if before(*w, best) { *w } else { best };
        }
    }
    best
}
