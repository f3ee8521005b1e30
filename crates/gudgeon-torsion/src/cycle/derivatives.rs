//! A sum of orders and its derivatives at one angle.

use gudgeon_numerics::elementary;
use std::f64::consts::PI;

/// Multiples of the order of the period side by side: more would not leave their sums in the registers of every processor.
const LANES: usize = 4;
/// Blocks after which turning starts afresh, so that rounding does not add up.
const AFRESH: usize = 16;
/// Places of a turn whose cosines and sines are kept.
const PLACES: usize = 64;
/// Their distance \[rad\].
const PLACE: f64 = 2.0 * PI / PLACES as f64;

/// A number for each of some neighbouring multiples.
type Lane = [f64; LANES];

/// Phasors, orders and their squares of neighbouring multiples.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    re: Lane,
    im: Lane,
    order: Lane,
    square: Lane,
}

/// Sum of the squares of the amplitudes, and bounds of the second to sixth derivative.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sizes {
    pub square: f64,
    pub second: f64,
    pub third: f64,
    pub fourth: f64,
    pub fifth: f64,
    pub sixth: f64,
}

/// Orders with their phasors. Multiples of one order are turned from one to the next, several side by side.
#[derive(Debug, Clone)]
pub(super) struct Derivatives {
    orders: Vec<f64>,
    phasors: [Vec<f64>; 2],
    /// Angular frequency of the period.
    base: f64,
    /// Cosines and sines of [`PLACES`].
    turns: Vec<[f64; 2]>,
    /// Place of each order in the blocks; empty where orders are no multiples, or few of many.
    places: Vec<usize>,
    blocks: Vec<Block>,
}

impl Derivatives {
    /// Of `orders`, which are `multiples` of that of `period` \[rad\], or of nothing.
    pub fn new(orders: &[f64], period: f64, multiples: &[usize]) -> Self {
        let highest = multiples.last().copied().unwrap_or(0);
        let dense = multiples.first().is_some_and(|m| *m > 0) && highest <= 2 * orders.len() + LANES;
        let places: Vec<usize> = multiples.iter().filter(|_| dense).map(|m| m - 1).collect();
        let mut blocks = vec![Block::default(); if dense { highest.div_ceil(LANES) } else { 0 }];
        for (place, order) in places.iter().zip(orders) {
            blocks[place / LANES].order[place % LANES] = *order;
            blocks[place / LANES].square[place % LANES] = order * order;
        }
        let turns = (0..if dense { PLACES } else { 0 }).map(|i| {
            let (sin, cos) = elementary::sin_cos(i as f64 * PLACE);
            [cos, sin]
        });
        let (orders, base) = (orders.to_vec(), 2.0 * PI / period);
        Self { orders, phasors: Default::default(), base, turns: turns.collect(), places, blocks }
    }

    /// The orders.
    pub fn orders(&self) -> &[f64] {
        &self.orders
    }

    /// Real and imaginary parts of the phasors.
    pub fn phasors(&self) -> [&[f64]; 2] {
        [&self.phasors[0], &self.phasors[1]]
    }

    /// Takes other phasors, real and imaginary parts.
    pub fn take(&mut self, [re, im]: [&[f64]; 2]) {
        re.clone_into(&mut self.phasors[0]);
        im.clone_into(&mut self.phasors[1]);
        if self.orders.len() == self.blocks.len() * LANES {
            // Every multiple is there.
            let parts = re.chunks_exact(LANES).zip(im.chunks_exact(LANES));
            for (block, (re, im)) in self.blocks.iter_mut().zip(parts) {
                block.re.copy_from_slice(re);
                block.im.copy_from_slice(im);
            }
            return;
        }
        for (place, (re, im)) in self.places.iter().zip(re.iter().zip(im)) {
            let block = &mut self.blocks[place / LANES];
            (block.re[place % LANES], block.im[place % LANES]) = (*re, *im);
        }
    }

    /// The size of the sum: each derivative is at most that of all waves at once.
    #[inline(always)]
    pub fn sizes(&self) -> Sizes {
        let mut sums = [[0.0; LANES]; 6];
        if self.blocks.is_empty() {
            let [re, im] = &self.phasors;
            for ((re, im), o) in re.iter().zip(im).zip(&self.orders) {
                let mut own = Block::default();
                (own.re[0], own.im[0], own.order[0], own.square[0]) = (*re, *im, *o, o * o);
                own.add_sizes(&mut sums);
            }
        }
        for block in &self.blocks {
            block.add_sizes(&mut sums);
        }
        let [square, second, third, fourth, fifth, sixth] = totals(&sums);
        Sizes { square, second, third, fourth, fifth, sixth }
    }

    /// The sum at an angle \[rad\], and its first five derivatives.
    #[inline(always)]
    pub fn at(&self, angle: f64) -> [f64; 6] {
        if self.blocks.is_empty() {
            return self.one_by_one(angle);
        }
        let mut sums = [[0.0; LANES]; 6];
        self.each(angle, |block, lanes| block.add(lanes, &mut sums));
        totals(&sums)
    }

    /// The sum at an angle \[rad\].
    #[inline(always)]
    pub fn value(&self, angle: f64) -> f64 {
        if self.blocks.is_empty() {
            return self.one_by_one(angle)[0];
        }
        let mut sum = [0.0; LANES];
        self.each(angle, |Block { re, im, .. }, [cos, sin]| {
            for l in 0..LANES {
                sum[l] += re[l] * cos[l] - im[l] * sin[l];
            }
        });
        total_of(&sum)
    }

    #[inline(never)]
    fn one_by_one(&self, angle: f64) -> [f64; 6] {
        let mut sums = [0.0; 6];
        let [re, im] = &self.phasors;
        for (o, (re, im)) in self.orders.iter().zip(re.iter().zip(im)) {
            let (sin, cos) = elementary::sin_cos(o * angle);
            let own = wave([*re, *im, *o], cos, sin);
            sums.iter_mut().zip(own).for_each(|(s, w)| *s += w);
        }
        sums
    }

    /// Goes through the blocks with the cosines and sines of their multiples of an angle.
    #[inline(always)]
    fn each(&self, angle: f64, mut take: impl FnMut(&Block, &[Lane; 2])) {
        let first = self.first(angle);
        let by = [first[0][LANES - 1], first[1][LANES - 1]];
        let mut lanes = first;
        for (b, block) in self.blocks.iter().enumerate() {
            if b > 0 {
                lanes = if b % AFRESH == 0 {
                    let (sin, cos) = elementary::sin_cos(self.base * (b * LANES) as f64 * angle);
                    turned_together(&first, [cos, sin])
                } else {
                    turned_together(&lanes, by)
                };
            }
            take(block, &lanes);
        }
    }

    /// Cosines and sines of the first multiples of an angle. A function of its own: beside it the compiler would take the lanes apart again in the loop
    /// over the blocks.
    #[inline(never)]
    fn first(&self, angle: f64) -> [Lane; 2] {
        let one = self.turn(angle);
        let two = turned(one, one);
        let (three, four) = (turned(two, one), turned(two, two));
        [0, 1].map(|part| [one[part], two[part], three[part], four[part]])
    }

    /// Cosine and sine of the order of the period at an angle: those of the nearest place, turned by what is left, of which the powers beyond these are below
    /// rounding.
    #[inline]
    fn turn(&self, angle: f64) -> [f64; 2] {
        let at = self.base * angle;
        let near = at * (1.0 / PLACE) + 0.5;
        // The floor, which is no machine instruction everywhere.
        let place = near as i64 - i64::from(near < 0.0);
        let Some(known) = self.turns.get((place & (PLACES as i64 - 1)) as usize) else {
            let (sin, cos) = elementary::sin_cos(at);
            return [cos, sin];
        };
        let x = at - place as f64 * PLACE;
        let y = x * x;
        let sin = x * (1.0 - y * (1.0 / 6.0) * (1.0 - y * (1.0 / 20.0) * (1.0 - y * (1.0 / 42.0))));
        let rest = 1.0 - y * (1.0 / 30.0) * (1.0 - y * (1.0 / 56.0));
        let cos = 1.0 - 0.5 * y * (1.0 - y * (1.0 / 12.0) * rest);
        turned(*known, [cos, sin])
    }
}

impl Block {
    /// Adds the squares of its amplitudes, and the largest second to sixth derivatives of its waves.
    #[inline(always)]
    fn add_sizes(&self, sums: &mut [Lane; 6]) {
        for l in 0..LANES {
            let square = self.re[l] * self.re[l] + self.im[l] * self.im[l];
            let second = square.sqrt() * self.square[l];
            let third = second * self.order[l];
            sums[0][l] += square;
            sums[1][l] += second;
            sums[2][l] += third;
            let fourth = second * self.square[l];
            sums[3][l] += fourth;
            sums[4][l] += third * self.square[l];
            sums[5][l] += fourth * self.square[l];
        }
    }

    /// Adds its waves and their derivatives at angles whose cosines and sines are given.
    #[inline(always)]
    fn add(&self, [cos, sin]: &[Lane; 2], sums: &mut [Lane; 6]) {
        let (mut even, mut odd) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            even[l] = self.re[l] * cos[l] - self.im[l] * sin[l];
            odd[l] = self.order[l] * (self.re[l] * sin[l] + self.im[l] * cos[l]);
        }
        for l in 0..LANES {
            sums[0][l] += even[l];
            sums[1][l] -= odd[l];
        }
        for l in 0..LANES {
            even[l] *= self.square[l];
            odd[l] *= self.square[l];
            sums[2][l] -= even[l];
            sums[3][l] += odd[l];
            sums[4][l] += even[l] * self.square[l];
            sums[5][l] -= odd[l] * self.square[l];
        }
    }
}

/// The sums of all lanes. A function of its own: beside the loops that make the lanes, the compiler would add the six sums side by side instead of the lanes.
#[inline(never)]
fn totals([a, b, c, d, e, f]: &[Lane; 6]) -> [f64; 6] {
    [total(a), total(b), total(c), total(d), total(e), total(f)]
}

/// The sum of all lanes, a function of its own likewise.
#[inline(never)]
fn total_of(lanes: &Lane) -> f64 {
    total(lanes)
}

/// The sum of all lanes.
#[inline(always)]
fn total([a, b, c, d]: &Lane) -> f64 {
    (a + c) + (b + d)
}

/// A wave and its first five derivatives.
fn wave([re, im, order]: [f64; 3], cos: f64, sin: f64) -> [f64; 6] {
    let (x, y) = (re * cos - im * sin, order * (re * sin + im * cos));
    let square = order * order;
    [x, -y, -square * x, square * y, square * square * x, -square * square * y]
}

/// The product of two complex numbers.
#[inline(always)]
fn turned([x, y]: [f64; 2], [cos, sin]: [f64; 2]) -> [f64; 2] {
    [x * cos - y * sin, x * sin + y * cos]
}

/// The products of several with one.
#[inline(always)]
fn turned_together([x, y]: &[Lane; 2], [cos, sin]: [f64; 2]) -> [Lane; 2] {
    let mut out = [[0.0; LANES]; 2];
    for l in 0..LANES {
        out[0][l] = x[l] * cos - y[l] * sin;
        out[1][l] = x[l] * sin + y[l] * cos;
    }
    out
}
