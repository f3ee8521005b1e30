//! Solid contact of a whole ring face, reduced to a function of one variable at build time.
//!
//! `load = ∫ p_c(s + drop(x)) dx` over the running lands \[N/m\], with the separation `s` of the mean planes at the nearest point. What the
//! film knows is its thickness there, the mean gap `h` of the rough surfaces ([`Contact::mean_gap`]), which stays above zero where the mean
//! planes overlap; load and separation are tabulated over
//!
//! ```text
//! w = ln(exp(h/S) - 1)        S ≈ one roughness;  h/S far from the surfaces, ln(h/S) where they overlap
//! ```
//!
//! in which both are smooth on either side of zero separation. The face never changes during a run, so the integral costs a few
//! nanoseconds afterwards.

use std::convert::Infallible;
use std::sync::Arc;

use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::Contact;
use gudgeon_numerics::elementary;
use gudgeon_numerics::quadrature::GaussLegendre;
use gudgeon_numerics::roots::itp;

/// Line load against film thickness.
#[derive(Debug, Clone, Default)]
pub struct ContactLine {
    /// `load^(1/4)`: the root keeps the table smooth where the load fades out.
    root: Spline,
    /// `area^(1/4)`, where friction asks for it.
    area: Spline,
    /// Separation of the mean planes.
    planes: Arc<MeanPlanes>,
    /// Film thickness above which there is no contact \[m\].
    pub range: f64,
    /// Whether the contact takes any load before the film is gone: its mean planes may overlap.
    pub open: bool,
    /// Film thickness at which the mean planes meet \[m\].
    meet: f64,
    /// Film thickness that the contact model names as the least one \[m\].
    pub floor: Option<f64>,
    /// Whether on the floor the film contributes no shear.
    pub floor_replaces_film: bool,
    /// Friction coefficient of the solid load.
    pub friction: f64,
}

/// Parts of a least film thickness over which the approach to it fades out: of one that a contact model names, and of another.
const BANDS: (f64, f64) = (0.02, 1.0);
/// Intervals of the tables below `w = EDGE` and above: cubic interpolation between them is good to about 1e-7 of the load.
const INTERVALS: [usize; 2] = [128, 208];
/// The table begins at `exp(DEEPEST)` of the unit: mean planes of Gaussian surfaces overlap by eight roughness heights there.
const DEEPEST: f64 = -37.0;
/// Below it separation and load bend little, for the one goes as the root of `-w`.
const EDGE: f64 = -2.0;
/// Part of the range that is the unit `S`: one roughness of Gaussian surfaces.
const UNIT: f64 = 0.152;
/// Part of the range over which a load that fades out with its sixth to eighth power changes by its own size, halfway.
pub const SCALE: f64 = 0.1;
/// Width of the bracket of a separation, over the larger of the film and the separation before.
const ROUNDING: f64 = 1e-15;
/// Panels of Gauss's rule on each straight or curved piece of a face: good to 1e-8 of the load.
const PANELS: usize = 6;

/// Separation of the mean planes against film thickness: of the rough surfaces alone, and so the same for all faces.
#[derive(Debug, Default)]
pub struct MeanPlanes {
    /// Film thickness above which there is no contact \[m\].
    range: f64,
    /// The length `S` \[m\].
    unit: f64,
    /// Points of the table, and of all that faces make of it.
    grid: Grid,
    /// Separation at the points of the table \[m\], as the contact model is asked.
    points: Vec<f64>,
    /// Distance of the mean planes there \[m\].
    separation: Spline,
}

impl MeanPlanes {
    /// Tabulates the separation; nothing for surfaces that do not touch.
    #[must_use]
    pub fn new(contact: &dyn Contact) -> Self {
        let range = contact.range();
        if range <= 0.0 {
            return Self::default();
        }
        let unit = UNIT * range;
        let top = elementary::ln(elementary::exp_m1(range / unit));
        let grid = Grid::up_to(top);
        let film = |k: usize| unit * elementary::ln_1p(elementary::exp(grid.at(k)));
        let mut last = below(contact, film(0));
        let next = |k: usize| {
            last = separation(contact, film(k), last);
            last
        };
        let points: Vec<f64> = (0..=grid.intervals()).map(next).collect();
        let planes: Vec<f64> = points.iter().map(|s| contact.mean_planes(*s)).collect();
        let separation = Spline::new(grid, &planes);
        Self { range, unit, grid, points, separation }
    }

    /// `ln(exp(h/S) - 1)`, away from thin films by functions that take half the time.
    fn place(&self, h: f64) -> f64 {
        let x = h / self.unit;
        if x > 0.5 {
            x + elementary::ln(1.0 - elementary::exp(-x))
        } else {
            elementary::ln(elementary::exp_m1(x))
        }
    }
}

impl ContactLine {
    /// Tabulates the contact of `lands` equal faces.
    #[must_use]
    pub fn new(contact: &dyn Contact, planes: &Arc<MeanPlanes>, face: &FaceProfile, lands: usize) -> Self {
        let (touch, meet) = (planes.range > 0.0, contact.mean_gap(0.0));
        let mut line = Self {
            planes: planes.clone(),
            range: planes.range,
            open: touch && meet > 0.0,
            meet,
            floor: contact.floor(),
            floor_replaces_film: contact.floor_replaces_film(),
            friction: contact.friction_coefficient(),
            ..Self::default()
        };
        if touch {
            line.root = line.roots(contact, face, lands, |c, s, pressure| c.pressure(s, pressure));
        }
        line
    }

    /// The same with the real area of contact, which the model has to know.
    #[must_use]
    pub fn with_area(mut self, contact: &dyn Contact, face: &FaceProfile, lands: usize) -> Self {
        if self.planes.range > 0.0 {
            self.area = self.roots(contact, face, lands, |c, s, area| {
                c.real_area(s, area);
            });
        }
        self
    }

    /// Table of the fourth roots of `∫ what dx` over all lands.
    fn roots(&self, contact: &dyn Contact, face: &FaceProfile, lands: usize, what: Field) -> Spline {
        let mut whole = WholeFace::new(contact, face, what);
        let root = |s: &f64| (lands as f64 * whole.sum(*s)).max(0.0).sqrt().sqrt();
        let roots: Vec<f64> = self.planes.points.iter().map(root).collect();
        Spline::new(self.planes.grid, &roots)
    }

    /// Load per circumference \[N/m\] at film thickness `h` \[m\].
    #[must_use]
    pub fn load(&self, h: f64) -> f64 {
        if h >= self.range {
            return 0.0;
        }
        fourth(self.root.at(self.planes.place(h)).0)
    }

    /// Real area of contact per circumference \[m\] at film thickness `h` \[m\]; zero where no friction asks for it.
    #[must_use]
    pub fn area(&self, h: f64) -> f64 {
        if h >= self.range { 0.0 } else { fourth(self.area.at(self.planes.place(h)).0) }
    }

    /// By how much the mean planes overlap at the nearest point \[m\]; 0 where they do not.
    #[must_use]
    pub fn overlap(&self, h: f64) -> f64 {
        if h >= self.meet { 0.0 } else { (-self.separation(h)).max(0.0) }
    }

    /// Separation of the mean planes at the nearest point \[m\].
    #[must_use]
    pub fn separation(&self, h: f64) -> f64 {
        if h >= self.range { h } else { self.planes.separation.at(self.planes.place(h)).0 }
    }

    /// Film thickness that a ring does not go below \[m\], where surfaces that do not take any load stop at `least`: the floor that the contact
    /// model names, `least`, or none.
    #[must_use]
    pub fn lowest(&self, least: f64) -> f64 {
        self.floor.unwrap_or(if self.open { 0.0 } else { least })
    }

    /// Whether contact could carry the ring.
    #[must_use]
    pub fn carries(&self) -> bool {
        self.range > 0.0 || self.floor.is_some()
    }

    /// Part of the least film thickness over which the approach to it fades out.
    #[must_use]
    pub fn band(&self) -> f64 {
        if self.floor.is_some() { BANDS.0 } else { BANDS.1 }
    }

    /// How much less well than to its own size the logarithm of a film need be known, at least 1: surfaces that touch carry by their
    /// separation, which has to be known to a tenth of the range.
    #[must_use]
    pub fn ease(&self, h: f64) -> f64 {
        if h >= self.range {
            return 1.0;
        }
        let x = h / self.planes.unit;
        // ds/d ln h = ds/dw dw/d ln h, dw/d ln h = x exp(x)/(exp(x) - 1).
        let rate = self.planes.separation.at(self.planes.place(h)).1 * x / -elementary::exp_m1(-x);
        (SCALE * self.range / rate).max(1.0)
    }
}

/// Fourth power of what is not negative.
fn fourth(root: f64) -> f64 {
    let r = root.max(0.0);
    (r * r) * (r * r)
}

/// Separation \[m\] at which the mean gap, which rises with it, is `film`; at least `least`.
fn separation(contact: &dyn Contact, film: f64, least: f64) -> f64 {
    // Where mean planes overlap the gap falls with the exponential of a square: its logarithm is a curve that secants follow.
    let lacks =
        |s: f64| Ok::<_, Infallible>(elementary::ln((contact.mean_gap(s) / film).max(f64::MIN_POSITIVE)));
    // A mean gap is never less than the separation.
    itp(lacks, least, film, ROUNDING * film.max(-least)).map_or(least, |root| root.x)
}

/// A separation \[m\] at which the mean gap is less than `film`.
fn below(contact: &dyn Contact, film: f64) -> f64 {
    let mut s = -film.max(contact.range());
    for _ in 0..40 {
        if contact.mean_gap(s) < film {
            break;
        }
        s *= 2.0;
    }
    s
}

/// What a contact model says for separations.
type Field = fn(&dyn Contact, &[f64], &mut [f64]);

/// `∫ p_c(s + drop(x)) dx` over a face \[N/m\], or that of the real area \[m\], piece by piece where it is within reach of the liner.
struct WholeFace<'a> {
    what: Field,
    contact: &'a dyn Contact,
    face: &'a FaceProfile,
    nodes: Option<Vec<(f64, f64)>>,
    rule: GaussLegendre,
    /// Separations of one piece, and the values there.
    separations: Vec<f64>,
    values: Vec<f64>,
}

impl<'a> WholeFace<'a> {
    fn new(contact: &'a dyn Contact, face: &'a FaceProfile, what: Field) -> Self {
        let (separations, values) = (Vec::new(), Vec::new());
        Self { what, contact, face, nodes: face.nodes(), rule: GaussLegendre::new(6), separations, values }
    }

    fn sum(&mut self, s: f64) -> f64 {
        let (face, reach) = (self.face, self.contact.range() - s);
        if let Some(nodes) = self.nodes.take() {
            let sum = nodes.windows(2).map(|n| self.straight(s, reach, n[0], n[1])).sum();
            self.nodes = Some(nodes);
            return sum;
        }
        match face {
            FaceProfile::Parabola { curvature, apex, length } if *curvature > 0.0 => {
                let half = (reach.max(0.0) / curvature).sqrt();
                let (a, b) = ((apex - half).max(0.0), (apex + half).min(*length));
                // The apex is a place like any other; a piece on either side of it, equal where neither end of the face is near.
                let mid = apex.clamp(a.min(b), b.max(a));
                if a > 0.0 && b < *length {
                    2.0 * self.piece(s, a, mid, PANELS / 2)
                } else if b > a {
                    self.piece(s, a, mid, PANELS / 2) + self.piece(s, mid, b, PANELS / 2)
                } else {
                    0.0
                }
            }
            _ => self.piece(s, 0.0, face.length(), PANELS),
        }
    }

    /// A straight piece between two nodes (`x`, drop).
    fn straight(&mut self, s: f64, reach: f64, (x0, d0): (f64, f64), (x1, d1): (f64, f64)) -> f64 {
        if d0 == d1 {
            return if d0 < reach { self.piece(s, x0, x1, 1) } else { 0.0 };
        }
        let end = x0 + (reach - d0) / (d1 - d0) * (x1 - x0);
        let (a, b) = if d1 > d0 { (x0, x1.min(end)) } else { (x0.max(end), x1) };
        if b > a { self.piece(s, a, b, PANELS) } else { 0.0 }
    }

    /// The piece from `a` to `b` by Gauss's rule on `panels` panels.
    fn piece(&mut self, s: f64, a: f64, b: f64, panels: usize) -> f64 {
        let width = (b - a) / panels as f64;
        let middle = |k: usize| a + (k as f64 + 0.5) * width;
        let (face, nodes) = (self.face, self.rule.nodes());
        self.separations.clear();
        for k in 0..panels {
            let mid = middle(k);
            self.separations.extend(nodes.iter().map(|x| s + face.drop_at(mid + 0.5 * width * x)));
        }
        self.values.resize(self.separations.len(), 0.0);
        (self.what)(self.contact, &self.separations, &mut self.values);
        let weights = self.rule.weights().iter().cycle();
        self.values.iter().zip(weights).fold(0.0, |sum, (p, w)| sum + 0.5 * width * w * p)
    }
}

/// Points that are equally spaced below an edge, and closer above it.
#[derive(Debug, Clone, Copy, Default)]
struct Grid {
    /// Intervals below the edge and above.
    steps: [f64; 2],
}

impl Grid {
    /// From the deepest point to `top`.
    fn up_to(top: f64) -> Self {
        Self { steps: [(EDGE - DEEPEST) / INTERVALS[0] as f64, (top - EDGE) / INTERVALS[1] as f64] }
    }

    const fn intervals(&self) -> usize {
        INTERVALS[0] + INTERVALS[1]
    }

    /// Point `k`.
    fn at(&self, k: usize) -> f64 {
        match k.checked_sub(INTERVALS[0]) {
            Some(above) => EDGE + self.steps[1] * above as f64,
            None => DEEPEST + self.steps[0] * k as f64,
        }
    }

    /// Length of interval `i`.
    fn step(&self, i: usize) -> f64 {
        self.steps[usize::from(i >= INTERVALS[0])]
    }

    /// The interval that holds `w`, the first or the last where none does, and the part of it that lies before `w`.
    fn find(&self, w: f64) -> (usize, f64) {
        let (first, from, zone) = if w < EDGE { (0, DEEPEST, 0) } else { (INTERVALS[0], EDGE, 1) };
        let t = (w - from) / self.steps[zone];
        let within = (t.max(0.0) as usize).min(INTERVALS[zone] - 1);
        (first + within, t - within as f64)
    }
}

/// A natural cubic spline: its second derivative is continuous.
#[derive(Debug, Clone, Default)]
struct Spline {
    grid: Grid,
    /// Coefficients of every interval in units of its length.
    pieces: Vec<[f64; 4]>,
}

impl Spline {
    fn new(grid: Grid, y: &[f64]) -> Self {
        let n = y.len();
        // Second derivatives over 6: g m_(i-1) + 2 (g + h) m_i + h m_(i+1) = (y_(i+1) - y_i)/h - (y_i - y_(i-1))/g between intervals g and h, zero at the
        // ends.
        let (mut m, mut c) = (vec![0.0; n], vec![0.0; n]);
        for i in 1..n - 1 {
            let (g, h) = (grid.step(i - 1), grid.step(i));
            let pivot = 2.0 * (g + h) - g * c[i - 1];
            c[i] = h / pivot;
            m[i] = ((y[i + 1] - y[i]) / h - (y[i] - y[i - 1]) / g - g * m[i - 1]) / pivot;
        }
        for i in (1..n - 1).rev() {
            m[i] -= c[i] * m[i + 1];
        }
        let pieces = (0..n - 1)
            .map(|i| {
                let square = grid.step(i) * grid.step(i);
                let (a, b) = (square * m[i], square * m[i + 1]);
                [y[i], y[i + 1] - y[i] - 2.0 * a - b, 3.0 * a, b - a]
            })
            .collect();
        Self { grid, pieces }
    }

    /// Value and slope; straight on below the table, zero where there is none.
    fn at(&self, w: f64) -> (f64, f64) {
        if self.pieces.is_empty() {
            return (0.0, 0.0);
        }
        let (i, f) = self.grid.find(w);
        let (c, step) = (self.pieces[i], self.grid.step(i));
        if f < 0.0 {
            return (c[0] + c[1] * f, c[1] / step);
        }
        let slope = c[1] + f * (2.0 * c[2] + 3.0 * f * c[3]);
        (c[0] + f * (c[1] + f * (c[2] + f * c[3])), slope / step)
    }
}
