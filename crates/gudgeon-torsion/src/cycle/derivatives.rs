//! A sum of orders and its derivatives at one angle.

use gudgeon_numerics::elementary;
use std::f64::consts::PI;

/// Multiples of the order of the period side by side.
const LANES: usize = 8;
/// Blocks after which turning starts afresh, so that rounding does not add up.
const AFRESH: usize = 4;

/// Phasors and orders of neighbouring multiples.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    re: [f64; LANES],
    im: [f64; LANES],
    order: [f64; LANES],
}

/// Orders with their phasors. Multiples of one order are turned from one to the next, several side by side.
#[derive(Debug, Clone)]
pub(super) struct Derivatives {
    orders: Vec<f64>,
    phasors: Vec<[f64; 2]>,
    /// Angular frequency of the period.
    base: f64,
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
        }
        let (orders, base) = (orders.to_vec(), 2.0 * PI / period);
        Self { orders, phasors: Vec::new(), base, places, blocks }
    }

    /// The orders.
    pub fn orders(&self) -> &[f64] {
        &self.orders
    }

    /// The phasors.
    pub fn phasors(&self) -> &[[f64; 2]] {
        &self.phasors
    }

    /// Takes other phasors.
    pub fn take(&mut self, phasors: impl Fn(usize) -> [f64; 2]) {
        self.phasors.clear();
        self.phasors.extend((0..self.orders.len()).map(phasors));
        for (place, [re, im]) in self.places.iter().zip(&self.phasors) {
            let block = &mut self.blocks[place / LANES];
            (block.re[place % LANES], block.im[place % LANES]) = (*re, *im);
        }
    }

    /// The sum at an angle \[rad\], and its first three derivatives.
    pub fn at(&self, angle: f64) -> [f64; 4] {
        if self.blocks.is_empty() { self.one_by_one(angle) } else { self.side_by_side(angle) }
    }

    fn one_by_one(&self, angle: f64) -> [f64; 4] {
        let mut sums = [0.0; 4];
        for (o, [re, im]) in self.orders.iter().zip(&self.phasors) {
            let (sin, cos) = elementary::sin_cos(o * angle);
            let own = wave([*re, *im, *o], cos, sin);
            sums.iter_mut().zip(own).for_each(|(s, w)| *s += w);
        }
        sums
    }

    fn side_by_side(&self, angle: f64) -> [f64; 4] {
        let (sin, cos) = elementary::sin_cos(self.base * angle);
        // Cosines and sines of the first multiples.
        let mut first = [[cos; LANES], [sin; LANES]];
        for l in 1..LANES {
            [first[0][l], first[1][l]] = turned([first[0][l - 1], first[1][l - 1]], [cos, sin]);
        }
        let by = first.map(|lanes| lanes[LANES - 1]);
        let mut lanes = first;
        let mut sums = [[0.0; LANES]; 4];
        for (b, block) in self.blocks.iter().enumerate() {
            if b > 0 && b % AFRESH == 0 {
                let (sin, cos) = elementary::sin_cos(self.base * (b * LANES) as f64 * angle);
                lanes = turned_together(&first, [cos, sin]);
            }
            block.add(&lanes, &mut sums);
            lanes = turned_together(&lanes, by);
        }
        sums.map(|lanes| lanes.iter().sum())
    }
}

impl Block {
    /// Adds its waves and their derivatives at angles whose cosines and sines are given.
    #[inline(always)]
    fn add(&self, [cos, sin]: &[[f64; LANES]; 2], sums: &mut [[f64; LANES]; 4]) {
        for l in 0..LANES {
            let own = wave([self.re[l], self.im[l], self.order[l]], cos[l], sin[l]);
            for d in 0..4 {
                sums[d][l] += own[d];
            }
        }
    }
}

/// A wave and its first three derivatives.
#[inline(always)]
fn wave([re, im, order]: [f64; 3], cos: f64, sin: f64) -> [f64; 4] {
    let (x, y) = (re * cos - im * sin, order * (re * sin + im * cos));
    let square = order * order;
    [x, -y, -square * x, square * y]
}

/// The product of two complex numbers.
#[inline(always)]
fn turned([x, y]: [f64; 2], [cos, sin]: [f64; 2]) -> [f64; 2] {
    [x * cos - y * sin, x * sin + y * cos]
}

/// The products of several with one.
#[inline(always)]
fn turned_together([x, y]: &[[f64; LANES]; 2], by: [f64; 2]) -> [[f64; LANES]; 2] {
    let mut out = [[0.0; LANES]; 2];
    for l in 0..LANES {
        [out[0][l], out[1][l]] = turned([x[l], y[l]], by);
    }
    out
}
