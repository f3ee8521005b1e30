//! Profiles of lines, with nodes on their steps.

use gudgeon_core::BuildError;
use gudgeon_numerics::elementary;

/// A gap along a line, linear in each panel.
///
/// A curved gap is replaced in each panel by the parallel to its chord that encloses the same volume (Simpson's rule): the
/// integrals of a film over it are then of fourth order in the length of the panels, and the steps that this leaves between
/// panels are of third order.
#[derive(Debug, Clone, PartialEq)]
pub struct LineProfile {
    /// Nodes \[m\], rising.
    pub x: Vec<f64>,
    /// Gap \[m\] at the beginning of each panel.
    pub h_a: Vec<f64>,
    /// Gap \[m\] at the end of each panel.
    pub h_b: Vec<f64>,
}

/// Maximum number of panels of a line.
const MAX_PANELS: usize = 1_000_000;

fn positive(field: &str, v: f64) -> Result<(), BuildError> {
    if v.is_finite() && v > 0.0 {
        Ok(())
    } else {
        Err(BuildError::at(field, format!("must be finite and greater than zero, not {v}")))
    }
}

impl LineProfile {
    /// The gap `h(piece, x)` on pieces between `breaks` \[m\], each divided into equal panels, at least one, some `panels` in all.
    ///
    /// # Errors
    /// Breaks that do not rise, no panels or more than a million, a gap that is not finite and positive.
    pub fn pieces(breaks: &[f64], panels: usize, h: impl Fn(usize, f64) -> f64) -> Result<Self, BuildError> {
        if breaks.len() < 2
            || breaks.windows(2).any(|w| w[1].partial_cmp(&w[0]) != Some(std::cmp::Ordering::Greater))
        {
            return Err(BuildError::at("breaks", "two or more rising places are needed"));
        }
        let length = breaks[breaks.len() - 1] - breaks[0];
        positive("length", length)?;
        if panels == 0 || panels.max(breaks.len()) > MAX_PANELS {
            return Err(BuildError::at(
                "panels",
                format!("between 1 and {MAX_PANELS} panels are possible, not {panels}"),
            ));
        }
        let mut line = Self { x: vec![breaks[0]], h_a: Vec::new(), h_b: Vec::new() };
        for (k, w) in breaks.windows(2).enumerate() {
            let share = ((w[1] - w[0]) / length * panels as f64).round().max(1.0);
            let at = |i: f64| if i == share { w[1] } else { w[0] + (w[1] - w[0]) * (i / share) };
            for i in 0..share as usize {
                let (a, b) = (at(i as f64), at(i as f64 + 1.0));
                line.x.push(b);
                line.panel(h(k, a), h(k, 0.5 * (a + b)), h(k, b));
            }
        }
        line.checked()
    }

    /// Adds a panel with the gaps at its ends and in its middle.
    fn panel(&mut self, a: f64, middle: f64, b: f64) {
        // No lower than half of what there is: a panel far too long for its bend keeps a gap.
        let shift = (2.0 / 3.0 * (middle - 0.5 * (a + b))).max(-0.5 * a.min(b));
        self.h_a.push(a + shift);
        self.h_b.push(b + shift);
    }

    fn checked(self) -> Result<Self, BuildError> {
        for h in self.h_a.iter().chain(&self.h_b) {
            positive("gap", *h)?;
        }
        Ok(self)
    }

    /// Straight slider from `h_in` to `h_out` \[m\].
    ///
    /// # Errors
    /// As [`LineProfile::pieces`].
    pub fn linear(length: f64, h_in: f64, h_out: f64, panels: usize) -> Result<Self, BuildError> {
        Self::pieces(&[0.0, length], panels, |_, x| h_in + (h_out - h_in) * (x / length))
    }

    /// Rayleigh step: `h_in` up to `step` \[m\], `h_out` behind it.
    ///
    /// # Errors
    /// As [`LineProfile::pieces`].
    pub fn step(length: f64, step: f64, h_in: f64, h_out: f64, panels: usize) -> Result<Self, BuildError> {
        Self::pieces(&[0.0, step, length], panels, |k, _| if k == 0 { h_in } else { h_out })
    }

    /// Exponential slider, `h = h_in (h_out/h_in)^(x/length)`.
    ///
    /// # Errors
    /// As [`LineProfile::pieces`].
    pub fn exponential(length: f64, h_in: f64, h_out: f64, panels: usize) -> Result<Self, BuildError> {
        Self::pieces(&[0.0, length], panels, |_, x| h_in * elementary::powf(h_out / h_in, x / length))
    }

    /// Barrel face, `h = h_0 + κ (x - apex)²` from `0` to `length`. `graded` puts the nodes closer together where the film is
    /// thin: with `x = apex + √(h_0/κ) sinh s` equally spaced in `s`. For a flat or hollow face they are equally spaced.
    ///
    /// # Errors
    /// As [`LineProfile::pieces`].
    pub fn parabola(
        length: f64,
        curvature: f64,
        apex: f64,
        h_0: f64,
        panels: usize,
        graded: bool,
    ) -> Result<Self, BuildError> {
        let h = |x: f64| h_0 + curvature * (x - apex) * (x - apex);
        let mut line = Self::pieces(&[0.0, length], panels, |_, x| h(x))?;
        let l = (h_0 / curvature).sqrt();
        if graded && l.is_finite() && l > 0.0 {
            let (a, b) = (elementary::asinh(-apex / l), elementary::asinh((length - apex) / l));
            let n = line.h_a.len();
            for i in 1..n {
                line.x[i] = apex + l * elementary::sinh(a + (b - a) * (i as f64 / n as f64));
            }
            line.h_a.clear();
            line.h_b.clear();
            for i in 0..n {
                let (a, b) = (line.x[i], line.x[i + 1]);
                line.panel(h(a), h(0.5 * (a + b)), h(b));
            }
        }
        line.checked()
    }

    /// Straight slider with a pocket of constant depth \[m\] between `pocket.0` and `pocket.1` \[m\].
    ///
    /// # Errors
    /// As [`LineProfile::pieces`].
    pub fn pocket(
        length: f64,
        h_in: f64,
        h_out: f64,
        pocket: (f64, f64),
        depth: f64,
        panels: usize,
    ) -> Result<Self, BuildError> {
        Self::pieces(&[0.0, pocket.0, pocket.1, length], panels, |k, x| {
            h_in + (h_out - h_in) * (x / length) + if k == 1 { depth } else { 0.0 }
        })
    }

    /// Straight slider with `count` rectangular dimples of equal pitch, each over the middle `fraction` of its pitch.
    ///
    /// # Errors
    /// No dimples, a fraction outside 0 to 1, or as [`LineProfile::pieces`].
    pub fn textured(
        length: f64,
        h_in: f64,
        h_out: f64,
        count: usize,
        fraction: f64,
        depth: f64,
        panels: usize,
    ) -> Result<Self, BuildError> {
        if !(count > 0 && count <= MAX_PANELS) {
            return Err(BuildError::at("count", format!("must be between 1 and {MAX_PANELS}, not {count}")));
        }
        if !(fraction > 0.0 && fraction < 1.0) {
            return Err(BuildError::at("fraction", format!("must lie between 0 and 1, not {fraction}")));
        }
        let pitch = length / count as f64;
        let mut breaks = vec![0.0];
        for k in 0..count {
            breaks.push((k as f64 + 0.5 * (1.0 - fraction)) * pitch);
            breaks.push((k as f64 + 0.5 * (1.0 + fraction)) * pitch);
        }
        breaks.push(length);
        Self::pieces(&breaks, panels, |k, x| {
            h_in + (h_out - h_in) * (x / length) + if k % 2 == 1 { depth } else { 0.0 }
        })
    }

    /// Straight pieces through points `(x, h)` \[m\], `x` rising; two points at one `x` are a step.
    ///
    /// # Errors
    /// Fewer than two points or points out of order, or as [`LineProfile::pieces`].
    pub fn table(points: &[(f64, f64)], panels: usize) -> Result<Self, BuildError> {
        let mut breaks: Vec<f64> = Vec::new();
        let mut ends: Vec<(f64, f64)> = Vec::new();
        for w in points.windows(2) {
            if w[1].0.is_nan() || w[1].0 < w[0].0 {
                return Err(BuildError::at("points", format!("{} m comes after {} m", w[1].0, w[0].0)));
            }
            if w[1].0 > w[0].0 {
                if breaks.is_empty() {
                    breaks.push(w[0].0);
                }
                breaks.push(w[1].0);
                ends.push((w[0].1, w[1].1));
            }
        }
        if ends.is_empty() {
            return Err(BuildError::at("points", "two or more points at different places are needed"));
        }
        Self::pieces(&breaks, panels, |k, x| {
            let (a, b) = ends[k];
            a + (b - a) * ((x - breaks[k]) / (breaks[k + 1] - breaks[k]))
        })
    }

    /// Unrolled journal bearing, `h = clearance (1 + ε cos φ)`, `x = radius φ` from `phi.0` to `phi.1` \[rad\], φ from the widest
    /// gap in the direction of rotation.
    ///
    /// # Errors
    /// As [`LineProfile::pieces`].
    pub fn journal(
        radius: f64,
        clearance: f64,
        eccentricity: f64,
        phi: (f64, f64),
        panels: usize,
    ) -> Result<Self, BuildError> {
        positive("radius", radius)?;
        Self::pieces(&[radius * phi.0, radius * phi.1], panels, |_, x| {
            clearance * (1.0 + eccentricity * elementary::cos(x / radius))
        })
    }

    /// Number of panels.
    #[must_use]
    pub fn panels(&self) -> usize {
        self.h_a.len()
    }

    /// The same line seen from the other side: `x` from `-x.last` to `-x.first`.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let back = |v: &[f64]| v.iter().rev().copied().collect::<Vec<_>>();
        Self { x: self.x.iter().rev().map(|x| -x).collect(), h_a: back(&self.h_b), h_b: back(&self.h_a) }
    }

    /// Moves the profile away by `dh` \[m\].
    pub fn lift(&mut self, dh: f64) {
        self.h_a.iter_mut().chain(&mut self.h_b).for_each(|h| *h += dh);
    }
}
