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

/// The points of a period, the first half a step from its beginning.
#[derive(Debug, Clone)]
pub(super) struct Waves {
    period: f64,
    points: usize,
    /// Orders, and their places among all: even multiples of that of the period and odd ones; all together where they are no multiples.
    groups: [Vec<(f64, usize)>; 2],
    /// Whether orders are multiples: a quarter of the period is summed up, from whose even and odd multiples and cosines and sines the others
    /// follow.
    folded: bool,
    /// Rows of all orders of a group, block by block of points; empty where they would be too large.
    tables: [Vec<Row>; 2],
    /// Phasors of a group.
    own: [Vec<[f64; 2]>; 2],
}

impl Waves {
    /// `points`, a multiple of four blocks, over a period \[rad\]; `multiples` of the order of the period that the orders are, or nothing.
    pub fn new(orders: &[f64], period: f64, points: usize, multiples: &[usize]) -> Self {
        let mut groups = [Vec::new(), Vec::new()];
        for (k, order) in orders.iter().enumerate() {
            groups[multiples.get(k).map_or(0, |m| m % 2)].push((*order, k));
        }
        let folded = !multiples.is_empty();
        let mut own =
            Self { period, points, groups, folded, tables: Default::default(), own: Default::default() };
        if 2 * BLOCK * own.blocks() * orders.len() <= KEPT {
            let rows = |group: &[(f64, usize)]| {
                let blocks = 0..own.blocks();
                blocks
                    .flat_map(|b| group.iter().map(move |(o, _)| (*o, b)))
                    .map(|(o, b)| own.row(o, b))
                    .collect()
            };
            own.tables = [rows(&own.groups[0]), rows(&own.groups[1])];
        }
        own
    }

    /// Blocks of points at which orders are summed up.
    const fn blocks(&self) -> usize {
        self.points / if self.folded { 4 * BLOCK } else { BLOCK }
    }

    fn row(&self, order: f64, block: usize) -> Row {
        let mut row = Row::default();
        for i in 0..BLOCK {
            let angle = order * self.period * ((block * BLOCK + i) as f64 + 0.5) / self.points as f64;
            let (sin, cos) = elementary::sin_cos(angle);
            (row[0][i / LANES][i % LANES], row[1][i / LANES][i % LANES]) = (cos, sin);
        }
        row
    }

    /// `Σ Re(a_k e^{i n_k θ})` at the points.
    #[inline(always)]
    pub fn sum(&mut self, [re, im]: [&[f64]; 2], wave: &mut [f64]) {
        for (own, group) in self.own.iter_mut().zip(&self.groups) {
            own.clear();
            own.extend(group.iter().map(|(_, k)| [re[*k], im[*k]]));
        }
        let half = self.points / 2;
        for b in 0..self.blocks() {
            let [[cos_even, sin_even], [cos_odd, sin_odd]] = [self.block(0, b), self.block(1, b)];
            let first = b * BLOCK;
            if !self.folded {
                for i in 0..BLOCK {
                    wave[first + i] = cos_even[i] - sin_even[i];
                }
                continue;
            }
            let mut quarters = [[0.0; BLOCK]; 4];
            for i in 0..BLOCK {
                let (cos, sin) = (cos_even[i] + cos_odd[i], sin_even[i] + sin_odd[i]);
                // Half a period on, odd multiples have turned their sign.
                let (cos_on, sin_on) = (cos_even[i] - cos_odd[i], sin_even[i] - sin_odd[i]);
                quarters[0][i] = cos - sin;
                quarters[1][BLOCK - 1 - i] = cos_on + sin_on;
                quarters[2][i] = cos_on - sin_on;
                quarters[3][BLOCK - 1 - i] = cos + sin;
            }
            let last = first + BLOCK;
            let places = [first, half - last, half + first, 2 * half - last];
            for (quarter, place) in quarters.iter().zip(places) {
                wave[place..place + BLOCK].copy_from_slice(quarter);
            }
        }
    }

    /// Sums of cosines and of sines of a group at a block of points.
    #[inline(always)]
    fn block(&self, group: usize, b: usize) -> [[f64; BLOCK]; 2] {
        let phasors = &self.own[group];
        let mut sums = Row::default();
        let n = phasors.len();
        match self.tables[group].get(b * n..(b + 1) * n) {
            Some(rows) => {
                for (row, a) in rows.iter().zip(phasors) {
                    add(row, a, &mut sums);
                }
            }
            None => {
                for ((order, _), a) in self.groups[group].iter().zip(phasors) {
                    add(&self.row(*order, b), a, &mut sums);
                }
            }
        }
        let mut block = [[0.0; BLOCK]; 2];
        for l in 0..LANES {
            (block[0][l], block[0][LANES + l]) = (sums[0][0][l], sums[0][1][l]);
            (block[1][l], block[1][LANES + l]) = (sums[1][0][l], sums[1][1][l]);
        }
        block
    }
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
