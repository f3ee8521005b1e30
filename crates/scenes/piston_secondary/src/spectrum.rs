//! The slap in harmonics of the cycle: the lateral forces with which the skirt excites the liner.
//!
//! A force is known as a parabola over every step of the solver. That course is read in [`POINTS`] equal steps of crank angle and transformed. What
//! has kinks falls with the square of the harmonic, so of what lies beyond half of the points at most `(n/(POINTS - n))²` of a harmonic `n` is folded
//! back on it: 0.5 % of the last one of [`HARMONICS`]. What a step of the solver is too long for is missing: the solver chooses it for the motion, and a
//! tighter `solver.tolerance` tells how much.

use std::f64::consts::PI;

use gudgeon_core::result::{Column, Series};
use gudgeon_numerics::elementary;
use gudgeon_numerics::fourier::Fourier;
use gudgeon_numerics::linalg::Complex;

use super::row::{Row, index};
use super::survey::Survey;

/// Equal steps of a cycle that are transformed.
pub const POINTS: usize = 32768;
/// Harmonics of the cycle that are told at most.
pub const HARMONICS: usize = 2048;
/// Highest frequency that is told \[Hz\]. A skirt that yields has no inertia of its own, so higher ones are none of an engine.
pub const HIGHEST: f64 = 5000.0;
/// Frequency from which on a harmonic counts as slap \[Hz\]: the gas pressure and the rod make the lower ones.
pub const SLAP: f64 = 1000.0;

/// A value over a step: a parabola.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Crank angles at its ends \[rad\].
    pub ends: [f64; 2],
    /// Values at its start, halfway and at its end.
    pub values: [f64; 3],
}

impl Piece {
    fn at(&self, t: f64) -> f64 {
        let ([a, middle, b], s) = (self.values, (t - self.ends[0]) / (self.ends[1] - self.ends[0]));
        a + s * (b - a) + 4.0 * s * (1.0 - s) * (middle - 0.5 * (a + b))
    }
}

/// What follows itself over a cycle, in [`POINTS`] equal steps of it.
fn resampled(pieces: &[Piece]) -> Vec<f64> {
    let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return vec![0.0; POINTS] };
    let (from, period) = (first.ends[0], last.ends[1] - first.ends[0]);
    let mut k = 0;
    let at = |j: usize| {
        let t = from + period * j as f64 / POINTS as f64;
        while k + 1 < pieces.len() && pieces[k].ends[1] <= t {
            k += 1;
        }
        pieces[k].at(t)
    };
    (0..POINTS).map(at).collect()
}

/// Amplitudes of the first `count` harmonics of two courses over a cycle, half of peak to peak of each; the mean is none of them.
#[must_use]
pub fn amplitudes(one: &[Piece], other: &[Piece], count: usize) -> [Vec<f64>; 2] {
    let mut both = [vec![Complex::new(0.0, 0.0); count + 1], vec![Complex::new(0.0, 0.0); count + 1]];
    let [a, b] = &mut both;
    Fourier::new(POINTS).orders(&resampled(one), &resampled(other), a, b);
    both.map(|orders| orders[1..].iter().map(|c| elementary::hypot(c.re, c.im)).collect())
}

/// One-sided amplitude spectra of the lateral forces of film and contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Frequency of the cycle \[Hz\].
    pub cycle: f64,
    /// Turns of the crank in a cycle.
    pub turns: f64,
    /// Amplitude of every harmonic of the cycle on the thrust and the anti-thrust side \[N\].
    pub sides: [Vec<f64>; 2],
}

impl Spectrum {
    /// Of a cycle of `period` \[rad\] at `omega` \[rad/s\].
    #[must_use]
    pub fn new(survey: &Survey, period: f64, omega: f64) -> Self {
        let cycle = omega / period;
        let count = ((HIGHEST / cycle).floor() as usize).clamp(1, HARMONICS);
        let force = |side: &str| {
            let [film, contact] = ["film_force", "contact_force"].map(|f| index(&format!("{side}.{f}")));
            survey.pieces(move |r: &Row| r[film] + r[contact])
        };
        let sides = amplitudes(&force("thrust"), &force("anti_thrust"), count);
        Self { cycle, turns: period / (2.0 * PI), sides }
    }

    /// Frequency of harmonic `k`, counted from 0 \[Hz\].
    fn frequency(&self, k: usize) -> f64 {
        self.cycle * (k + 1) as f64
    }

    /// Root mean square of the slap on each side \[N\].
    #[must_use]
    pub fn slap(&self) -> [f64; 2] {
        self.sides.each_ref().map(|side| {
            let above = side.iter().enumerate().filter(|(k, _)| self.frequency(*k) >= SLAP);
            above.map(|(_, a)| 0.5 * a * a).sum::<f64>().sqrt()
        })
    }

    /// The table `slap_spectrum`: a row per harmonic.
    #[must_use]
    pub fn table(&self) -> Series {
        let count = self.sides[0].len();
        let of = |f: &dyn Fn(usize) -> f64| (0..count).map(f).collect::<Vec<f64>>();
        let column = |name: &str, unit: &str, values| Column { name: name.into(), unit: unit.into(), values };
        Series {
            axis: column("frequency", "Hz", of(&|k| self.frequency(k))),
            columns: vec![
                column("order", "1", of(&|k| (k + 1) as f64 / self.turns)),
                column("thrust.force", "N", self.sides[0].clone()),
                column("anti_thrust.force", "N", self.sides[1].clone()),
            ],
        }
    }
}
