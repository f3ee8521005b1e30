//! A sum of orders at equidistant points of its period.

use gudgeon_numerics::elementary;
use std::f64::consts::PI;

/// Numbers of a table that are kept.
const KEPT: usize = 1 << 21;

/// Cosines and sines of one order at points from the beginning of the period on.
type Row = [Vec<f64>; 2];

/// The points of a period.
#[derive(Debug, Clone)]
pub(super) struct Waves {
    orders: Vec<f64>,
    period: f64,
    points: usize,
    /// Orders as multiples of that of the period; empty where they are none.
    multiples: Vec<usize>,
    /// Rows by order; empty where they would be too large.
    table: Vec<Row>,
    /// Sums of cosines and sines: of even multiples, and of odd ones.
    sums: [Row; 2],
}

impl Waves {
    /// `points`, a multiple of four, over a period \[rad\]; `multiples` of the order of the period that the orders are, or nothing.
    pub fn new(orders: &[f64], period: f64, points: usize, multiples: &[usize]) -> Self {
        let mut own = Self {
            orders: orders.to_vec(),
            period,
            points,
            multiples: multiples.to_vec(),
            table: Vec::new(),
            sums: Default::default(),
        };
        let looked = own.looked();
        own.sums = [0, 1].map(|_| [vec![0.0; looked], vec![0.0; looked]]);
        if 2 * looked * orders.len() <= KEPT {
            own.table = orders.iter().map(|o| own.row(*o)).collect();
        }
        own
    }

    /// Points at which orders are summed up: all of them, or a quarter of the period, from whose even and odd multiples and cosines
    /// and sines the others follow.
    fn looked(&self) -> usize {
        if self.multiples.is_empty() { self.points } else { self.points / 4 + 1 }
    }

    fn row(&self, order: f64) -> Row {
        let angle = |s: usize| order * self.period * s as f64 / self.points as f64;
        let (sin, cos) = (0..self.looked()).map(|s| elementary::sin_cos(angle(s))).unzip();
        [cos, sin]
    }

    /// `Σ Re(a_k e^{i n_k θ})` at the points.
    pub fn sum(&mut self, phasors: &[[f64; 2]], wave: &mut [f64]) {
        let mut sums = std::mem::take(&mut self.sums);
        sums.iter_mut().flatten().for_each(|s| s.fill(0.0));
        for parity in 0..2 {
            let own =
                |k: &usize| self.multiples.get(*k).map_or(0, |m| m % 2) == parity && phasors[*k] != [0.0; 2];
            let mut some = [0; TOGETHER];
            let mut count = 0;
            for k in (0..self.orders.len()).filter(own) {
                some[count] = k;
                count += 1;
                if count == TOGETHER {
                    self.add(&some, phasors, &mut sums[parity]);
                    count = 0;
                }
            }
            some[..count].iter().for_each(|k| self.add(&[*k], phasors, &mut sums[parity]));
        }
        let [[cos_even, sin_even], [cos_odd, sin_odd]] = &sums;
        if self.multiples.is_empty() {
            wave.iter_mut().zip(cos_even.iter().zip(sin_even)).for_each(|(w, (c, s))| *w = c - s);
        } else {
            let (half, last) = (self.points / 2, self.points - 1);
            for s in 0..cos_even.len() {
                let (cos, sin) = (cos_even[s] + cos_odd[s], sin_even[s] + sin_odd[s]);
                // Half a period on, odd multiples have turned their sign.
                let (cos_on, sin_on) = (cos_even[s] - cos_odd[s], sin_even[s] - sin_odd[s]);
                wave[s] = cos - sin;
                wave[(self.points - s) & last] = cos + sin;
                wave[half + s] = cos_on - sin_on;
                wave[half - s] = cos_on + sin_on;
            }
        }
        self.sums = sums;
    }

    /// Adds what some orders are at the points: several at once, which loads and stores the sums once for all of them.
    fn add<const N: usize>(&self, some: &[usize; N], phasors: &[[f64; 2]], sums: &mut Row) {
        let own: Vec<Row>;
        let rows: [&Row; N] = if self.table.is_empty() {
            own = some.iter().map(|k| self.row(self.orders[*k])).collect();
            std::array::from_fn(|j| &own[j])
        } else {
            some.map(|k| &self.table[k])
        };
        for (part, sum) in sums.iter_mut().enumerate() {
            let a = some.map(|k| phasors[k][part]);
            if let [one, two, three, four] = rows.map(|r| &r[part])[..] {
                let rows = one.iter().zip(two).zip(three.iter().zip(four));
                for (sum, ((x, y), (z, w))) in sum.iter_mut().zip(rows) {
                    *sum += (a[0] * x + a[1] * y) + (a[2] * z + a[3] * w);
                }
            } else {
                for (row, a) in rows.into_iter().zip(a) {
                    sum.iter_mut().zip(&row[part]).for_each(|(s, x)| *s += a * x);
                }
            }
        }
    }
}

/// Orders that are added at once.
const TOGETHER: usize = 4;

/// Orders as ascending multiples of that of the period; nothing where one is none.
pub(super) fn multiples(orders: &[f64], period: f64) -> Vec<usize> {
    let base = 2.0 * PI / period;
    let whole: Vec<f64> = orders.iter().map(|o| (o / base).round()).collect();
    let same = orders.iter().zip(&whole).all(|(o, w)| (w * base - o).abs() <= 4.0 * f64::EPSILON * o);
    let ascending = whole.windows(2).all(|w| w[0] < w[1]) && whole.first().is_none_or(|w| *w >= 0.0);
    if same && ascending { whole.into_iter().map(|w| w as usize).collect() } else { Vec::new() }
}
