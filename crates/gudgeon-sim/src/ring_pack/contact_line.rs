//! Solid contact of a whole ring face, reduced to a function of one variable at build time.
//!
//! `load(h) = ∫ p_c(h + drop(x)) dx` over the running lands \[N/m\]: the face never changes during a run, so the integral
//! is tabulated once and costs a few nanoseconds afterwards.

use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::Contact;
use gudgeon_numerics::quadrature::GaussLegendre;

/// Line load against film thickness.
#[derive(Debug, Clone, Default)]
pub struct ContactLine {
    /// `load^(1/4)` at equal steps of `h` from 0 to `range`: the root keeps the table smooth where the load fades out.
    root: Vec<f64>,
    step: f64,
    /// Film thickness above which there is no contact \[m\].
    pub range: f64,
    /// Hard lower limit of the film thickness \[m\].
    pub floor: Option<f64>,
    /// Fraction of the floor over which the approach to it fades out.
    pub band: f64,
    /// Whether on the floor the film contributes no shear.
    pub floor_replaces_film: bool,
    /// Friction coefficient of the solid load.
    pub friction: f64,
}

/// Intervals of the table: cubic interpolation between them is good to about 1e-6 of the load.
const POINTS: usize = 512;
/// A pressure law loses its meaning when the mean planes touch: at this fraction of its range the surfaces carry whatever
/// load is left (an edge would wear until they do).
const TOUCHING: f64 = 0.01;
/// Fading out above a floor that the contact model itself names, and above [`TOUCHING`].
const BANDS: (f64, f64) = (0.02, 1.0);

/// Part of the range over which a load that fades out with its sixth to eighth power changes by its own size, halfway.
const SCALE: f64 = 0.1;

impl ContactLine {
    /// Film thickness over which the load of surfaces in contact changes by about its own size \[m\].
    #[must_use]
    pub fn scale(&self) -> f64 {
        SCALE * self.range
    }

    /// Tabulates the contact of `lands` equal faces.
    #[must_use]
    pub fn new(contact: &dyn Contact, face: &FaceProfile, lands: usize) -> Self {
        let range = contact.range();
        let mut line = Self {
            floor: contact.floor().or((range > 0.0).then_some(TOUCHING * range)),
            band: if contact.floor().is_some() { BANDS.0 } else { BANDS.1 },
            floor_replaces_film: contact.floor_replaces_film(),
            friction: contact.friction_coefficient(),
            ..Self::default()
        };
        if range <= 0.0 {
            return line;
        }
        // Where the face is within reach of the liner is all that is integrated, panel by panel with Gauss's rule.
        let panels = 24;
        let (mut xs, mut ws) = (Vec::new(), Vec::new());
        let rule = GaussLegendre::new(6);
        let length = face.length();
        let reach: Vec<f64> = (0..=4000)
            .map(|k| length * f64::from(k) / 4000.0)
            .filter(|x| face.drop_at(*x) <= range)
            .collect();
        let (Some(first), Some(last)) = (reach.first(), reach.last()) else { return line };
        let (a, b) = ((first - length / 4000.0).max(0.0), (last + length / 4000.0).min(length));
        let width = (b - a) / f64::from(panels);
        for k in 0..panels {
            let mid = a + (f64::from(k) + 0.5) * width;
            for (x, w) in rule.nodes().iter().zip(rule.weights()) {
                xs.push(mid + 0.5 * width * x);
                ws.push(0.5 * width * w);
            }
        }
        let drops: Vec<f64> = xs.iter().map(|x| face.drop_at(*x)).collect();
        let (mut gap, mut p) = (vec![0.0; xs.len()], vec![0.0; xs.len()]);
        line.step = range / POINTS as f64;
        line.range = range;
        line.root = (0..=POINTS + 2)
            .map(|k| {
                let h = line.step * k as f64;
                for (g, d) in gap.iter_mut().zip(&drops) {
                    *g = h + d;
                }
                contact.pressure(&gap, &mut p);
                let load: f64 = p.iter().zip(&ws).map(|(p, w)| p * w).sum();
                (load * lands as f64).max(0.0).sqrt().sqrt()
            })
            .collect();
        line
    }

    /// Load per circumference \[N/m\] at film thickness `h` \[m\].
    #[must_use]
    pub fn load(&self, h: f64) -> f64 {
        if self.root.is_empty() {
            return 0.0;
        }
        let t = h.max(0.0) / self.step;
        let i = t as usize;
        if i >= POINTS {
            return 0.0;
        }
        let f = t - i as f64;
        // Catmull-Rom through four neighbours, mirrored at the left end by extrapolation.
        let p1 = self.root[i];
        let p2 = self.root[i + 1];
        let p3 = self.root[i + 2];
        let p0 = if i == 0 { 3.0 * p1 - 3.0 * p2 + p3 } else { self.root[i - 1] };
        let m1 = 0.5 * (p2 - p0);
        let m2 = 0.5 * (p3 - p1);
        let d = p2 - p1;
        let r = p1 + f * (m1 + f * ((3.0 * d - 2.0 * m1 - m2) + f * (m1 + m2 - 2.0 * d)));
        let r2 = r.max(0.0) * r.max(0.0);
        r2 * r2
    }
}
