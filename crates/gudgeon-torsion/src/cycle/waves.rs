//! A sum of orders at equidistant points of its period.

use gudgeon_numerics::elementary;
use std::f64::consts::PI;

/// Numbers of a table that are kept.
const KEPT: usize = 1 << 21;
/// Numbers of a vector.
const LANES: usize = 4;
/// Points that are summed up side by side.
const BLOCK: usize = 2 * LANES;

/// Cosines and sines of one order at neighbouring points, by vectors: arrays of more numbers than these would be added up in vectors of two.
type Row = [[[f64; LANES]; 2]; 2];

/// Place of an order that is not there.
const NONE: usize = usize::MAX;

/// The points of a period, the first half a step from its beginning.
#[derive(Debug, Clone)]
pub(super) struct Waves {
    period: f64,
    points: usize,
    orders: Vec<f64>,
    /// The same as multiples of the order of the period, or nothing.
    multiples: Vec<usize>,
    /// Cosines and sines of half a turn, a point in each half step, where orders are multiples.
    turns: Vec<[f64; 2]>,
    /// Places of the orders, an odd multiple of that of the period and an even one side by side, so that all sums of a pair stay in registers; any two where
    /// they are no multiples. Where there are more of one kind, [`NONE`] of the other.
    pairs: Vec<[usize; 2]>,
    /// Whether these are the orders one after the other.
    in_order: bool,
    /// Rows of all pairs, block by block of points; empty where they would be too large.
    table: Vec<[Row; 2]>,
    /// Phasors by pair.
    own: Vec<[[f64; 2]; 2]>,
}

impl Waves {
    /// `points`, a multiple of four blocks, over a period \[rad\]; `multiples` of the order of the period that the orders are, or nothing.
    pub fn new(orders: &[f64], period: f64, points: usize, multiples: &[usize]) -> Self {
        let kind = |odd: usize| {
            let own = move |k: &usize| multiples.get(*k).map_or(*k, |m| m + 1) % 2 != odd;
            (0..orders.len()).filter(own).collect::<Vec<usize>>()
        };
        let (odd, even) = (kind(1), kind(0));
        let at = |all: &[usize], j: usize| all.get(j).copied().unwrap_or(NONE);
        let pairs: Vec<_> = (0..odd.len().max(even.len())).map(|j| [at(&odd, j), at(&even, j)]).collect();
        let mut own = Self {
            period,
            points,
            orders: orders.to_vec(),
            in_order: pairs.as_flattened().iter().enumerate().all(|(k, place)| k == *place),
            turns: (0..if multiples.is_empty() { 0 } else { points })
                .map(|j| elementary::sin_cos(PI * j as f64 / points as f64))
                .map(|(sin, cos)| [cos, sin])
                .collect(),
            multiples: multiples.to_vec(),
            table: Vec::new(),
            own: vec![Default::default(); pairs.len()],
            pairs,
        };
        if 4 * BLOCK * own.blocks() * own.pairs.len() <= KEPT {
            let rows = (0..own.blocks()).flat_map(|b| own.pairs.iter().map(move |pair| (pair, b)));
            own.table = rows.map(|(pair, b)| own.rows(pair, b)).collect();
        }
        own
    }

    /// Whether a quarter of the period is summed up, from whose even and odd multiples and cosines and sines the others follow.
    const fn folded(&self) -> bool {
        !self.multiples.is_empty()
    }

    /// Blocks of points at which orders are summed up.
    const fn blocks(&self) -> usize {
        self.points / if self.folded() { 4 * BLOCK } else { BLOCK }
    }

    /// Rows of a pair of orders; one that is not there has no phasor, whatever its row.
    fn rows(&self, pair: &[usize; 2], block: usize) -> [Row; 2] {
        let mut rows = <[Row; 2]>::default();
        for (row, place) in rows.iter_mut().zip(pair) {
            if *place == NONE {
                continue;
            }
            for i in 0..BLOCK {
                let [cos, sin] = self.wave(*place, block * BLOCK + i);
                (row[0][i / LANES][i % LANES], row[1][i / LANES][i % LANES]) = (cos, sin);
            }
        }
        rows
    }

    /// Cosine and sine of the order at a place, at a point.
    fn wave(&self, place: usize, point: usize) -> [f64; 2] {
        let Some(multiple) = self.multiples.get(place) else {
            let angle = self.orders[place] * self.period * (point as f64 + 0.5) / self.points as f64;
            let (sin, cos) = elementary::sin_cos(angle);
            return [cos, sin];
        };
        // Points are half steps apart from the beginning, and half a turn is as many half steps as there are points.
        let half_steps = multiple * (2 * point + 1);
        let [cos, sin] = self.turns[half_steps % self.points];
        if (half_steps / self.points).is_multiple_of(2) { [cos, sin] } else { [-cos, -sin] }
    }

    /// Takes phasors, real and imaginary parts of all orders.
    #[inline(always)]
    fn take(&mut self, [re, im]: [&[f64]; 2]) {
        if self.in_order {
            let parts = re.as_chunks::<2>().0.iter().zip(im.as_chunks::<2>().0);
            for (own, (re, im)) in self.own.iter_mut().zip(parts) {
                *own = [[re[0], im[0]], [re[1], im[1]]];
            }
            return;
        }
        let part = |part: &[f64], place: usize| part.get(place).copied().unwrap_or(0.0);
        for (own, [odd, even]) in self.own.iter_mut().zip(&self.pairs) {
            *own = [[part(re, *odd), part(im, *odd)], [part(re, *even), part(im, *even)]];
        }
    }

    /// `Σ Re(a_k e^{i n_k θ})` at the points.
    #[inline(always)]
    pub fn sum(&mut self, phasors: [&[f64]; 2], wave: &mut [f64]) {
        self.take(phasors);
        if !self.folded() {
            for (b, place) in wave.as_chunks_mut::<BLOCK>().0.iter_mut().enumerate() {
                let [odd, even] = self.block(b);
                for i in 0..BLOCK {
                    let (h, l) = (i / LANES, i % LANES);
                    place[i] = (even[0][h][l] + odd[0][h][l]) - (even[1][h][l] + odd[1][h][l]);
                }
            }
            return;
        }
        let (first, last) = wave.split_at_mut(self.points / 2);
        let ((first, second), (third, fourth)) =
            (first.split_at_mut(self.points / 4), last.split_at_mut(self.points / 4));
        let forward = first.as_chunks_mut::<LANES>().0.iter_mut().zip(third.as_chunks_mut::<LANES>().0);
        let backward = second.as_chunks_mut::<LANES>().0.iter_mut().zip(fourth.as_chunks_mut::<LANES>().0);
        let mut places = forward.zip(backward.rev());
        for b in 0..self.blocks() {
            let [odd, even] = self.block(b);
            for h in 0..2 {
                let Some(((first, third), (second, fourth))) = places.next() else { return };
                let sums = [even[0][h], odd[0][h], even[1][h], odd[1][h]];
                [*first, *second, *third, *fourth] = quarters(sums);
            }
        }
    }

    /// Sums of cosines and of sines of odd and of even orders at a block of points.
    #[inline(always)]
    fn block(&self, b: usize) -> [Row; 2] {
        let mut sums = <[Row; 2]>::default();
        let n = self.own.len();
        match self.table.get(b * n..(b + 1) * n) {
            Some(rows) => {
                for (rows, own) in rows.iter().zip(&self.own) {
                    add(&rows[0], &own[0], &mut sums[0]);
                    add(&rows[1], &own[1], &mut sums[1]);
                }
            }
            None => {
                for (pair, own) in self.pairs.iter().zip(&self.own) {
                    let rows = self.rows(pair, b);
                    add(&rows[0], &own[0], &mut sums[0]);
                    add(&rows[1], &own[1], &mut sums[1]);
                }
            }
        }
        sums
    }
}

/// The sum at some points of the first quarter of a period and at those that mirror them in the others, from the sums of cosines of even and odd multiples and
/// those of sines. In the second and fourth quarter the points run backwards.
#[inline(always)]
fn quarters([cos_even, cos_odd, sin_even, sin_odd]: [[f64; LANES]; 4]) -> [[f64; LANES]; 4] {
    let mut out = [[0.0; LANES]; 4];
    for l in 0..LANES {
        let (cos, sin) = (cos_even[l] + cos_odd[l], sin_even[l] + sin_odd[l]);
        // Half a period on, odd multiples have turned their sign.
        let (cos_on, sin_on) = (cos_even[l] - cos_odd[l], sin_even[l] - sin_odd[l]);
        out[0][l] = cos - sin;
        out[1][LANES - 1 - l] = cos_on + sin_on;
        out[2][l] = cos_on - sin_on;
        out[3][LANES - 1 - l] = cos + sin;
    }
    out
}

/// Adds the waves of an order at a block of points.
#[inline(always)]
fn add(row: &Row, [re, im]: &[f64; 2], sums: &mut Row) {
    // One by one, so that the sums stay in registers.
    add_vector(&row[0][0], *re, &mut sums[0][0]);
    add_vector(&row[0][1], *re, &mut sums[0][1]);
    add_vector(&row[1][0], *im, &mut sums[1][0]);
    add_vector(&row[1][1], *im, &mut sums[1][1]);
}

#[inline(always)]
fn add_vector(wave: &[f64; LANES], by: f64, sum: &mut [f64; LANES]) {
    for l in 0..LANES {
        sum[l] += by * wave[l];
    }
}

/// Orders as ascending multiples of that of the period; nothing where one is none.
pub(super) fn multiples(orders: &[f64], period: f64) -> Vec<usize> {
    let base = 2.0 * PI / period;
    let whole: Vec<f64> = orders.iter().map(|o| (o / base).round()).collect();
    let same = orders.iter().zip(&whole).all(|(o, w)| (w * base - o).abs() <= 4.0 * f64::EPSILON * o);
    let ascending = whole.windows(2).all(|w| w[0] < w[1]) && whole.first().is_none_or(|w| *w >= 0.0);
    if same && ascending { whole.into_iter().map(|w| w as usize).collect() } else { Vec::new() }
}
