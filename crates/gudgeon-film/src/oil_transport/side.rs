//! One side of a running face: what it holds up to a distance from the narrowest place, and how far a volume reaches.

use gudgeon_core::geometry::FaceProfile;

/// Bits of a double from which a third of the bits of `x` is taken to get `x^(-1/3)`.
const INVERSE_CUBE_ROOT: u64 = 0x553E_F0FF_289D_D796;

/// A side of a face, from the narrowest place to an edge. Distances are from that place.
///
/// Under a film `h` it holds, per circumference, up to the distance `t` with the drop `d`
///
/// `V = h t + ∫ d dt`,  `d = c (e + t)²` of a parabola,  `d = d_k + s_k (t - t_k)` between the nodes of a face of straight lines
///
/// for `h > 0` and drops that are not negative, SI units.
#[derive(Debug, Clone)]
pub struct Side {
    /// Distance of the edge \[m\].
    pub span: f64,
    /// Drop at the edge \[m\].
    pub edge_drop: f64,
    /// What the drops hold up to the edge \[m²\].
    over: f64,
    shape: Shape,
}

#[derive(Debug, Clone)]
enum Shape {
    /// Curvature `c` \[1/m\], and distance `e` \[m\] of the narrowest place from the apex, positive where the face falls from there.
    Parabola { curvature: f64, from: f64 },
    /// Pieces, the nearest first.
    Lines(Vec<Line>),
}

/// A straight piece.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// Distance at which it begins \[m\].
    from: f64,
    /// Drop there \[m\].
    drop: f64,
    slope: f64,
    /// What the drops hold up to there \[m²\].
    over: f64,
}

impl Side {
    /// The side of a face below its narrowest place (0) or above it (1).
    pub fn new(profile: &FaceProfile, side: usize) -> Self {
        let narrowest = profile.narrowest();
        let span = if side == 0 { narrowest } else { profile.length() - narrowest };
        let sign = if side == 0 { -1.0 } else { 1.0 };
        let shape = match profile {
            FaceProfile::Parabola { curvature, apex, .. } => {
                Shape::Parabola { curvature: *curvature, from: sign * (narrowest - apex) }
            }
            straight => Shape::Lines(lines(straight, narrowest, sign)),
        };
        let mut new = Self { span, edge_drop: 0.0, over: 0.0, shape };
        (new.edge_drop, new.over) = (new.drop_at(span), new.over(span));
        new
    }

    /// Drop \[m\] at a distance \[m\].
    pub fn drop_at(&self, t: f64) -> f64 {
        match &self.shape {
            Shape::Parabola { curvature, from } => curvature * (from + t) * (from + t),
            Shape::Lines(lines) => {
                let line = piece(lines, |line| line.from <= t);
                line.drop + line.slope * (t - line.from)
            }
        }
    }

    /// What the drops hold up to a distance \[m²\].
    fn over(&self, t: f64) -> f64 {
        match &self.shape {
            Shape::Parabola { curvature, from } => curvature * t * (from * from + t * (from + t / 3.0)),
            Shape::Lines(lines) => {
                let line = piece(lines, |line| line.from <= t);
                let x = t - line.from;
                line.over + x * (line.drop + 0.5 * line.slope * x)
            }
        }
    }

    /// Volume \[m²\] up to a distance \[m\] under a film of `h` \[m\].
    pub fn held(&self, h: f64, t: f64) -> f64 {
        h * t + self.over(t)
    }

    /// Volume up to the edge \[m²\] under a film of `h` \[m\].
    pub fn capacity(&self, h: f64) -> f64 {
        h * self.span + self.over
    }

    /// Distance \[m\] up to which a volume \[m²\], above zero and less than the capacity, fills the side under a film of `h` \[m\]; to a few
    /// roundings.
    pub fn distance(&self, h: f64, volume: f64) -> f64 {
        match &self.shape {
            Shape::Parabola { curvature, from } => under_parabola(h, volume, *curvature, *from),
            Shape::Lines(lines) => {
                let line = piece(lines, |line| h * line.from + line.over <= volume);
                let (gap, rest) = (h + line.drop, volume - (h * line.from + line.over));
                // The root that does not cancel; the gap squared where it ends is below the root sign, so a face may rise as well.
                line.from + 2.0 * rest / (gap + (gap * gap + 2.0 * line.slope * rest).max(0.0).sqrt())
            }
        }
    }
}

/// The last of the pieces that `begun` holds for, at least the first.
fn piece(lines: &[Line], begun: impl Fn(&Line) -> bool) -> &Line {
    let count = lines.partition_point(begun);
    &lines[count.saturating_sub(1)]
}

/// The straight pieces of a face from its narrowest place downwards (`sign` -1) or upwards.
fn lines(profile: &FaceProfile, narrowest: f64, sign: f64) -> Vec<Line> {
    let mut ends: Vec<(f64, f64)> = profile.nodes().unwrap_or_default();
    ends.iter_mut().for_each(|end| end.0 = sign * (end.0 - narrowest));
    ends.retain(|end| end.0 > 0.0);
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut line = Line { from: 0.0, drop: profile.drop_at(narrowest), slope: 0.0, over: 0.0 };
    let mut out = Vec::with_capacity(ends.len().max(1));
    for (t, drop) in ends {
        line.slope = (drop - line.drop) / (t - line.from);
        out.push(line);
        let over = line.over + 0.5 * (line.drop + drop) * (t - line.from);
        line = Line { from: t, drop, slope: 0.0, over };
    }
    // A narrowest place at the edge leaves nothing of this side.
    if out.is_empty() {
        out.push(line);
    }
    out
}

/// The distance of [`Side::distance`] under a parabola, where `V = g t + c t² (e + t/3)` with the gap `g = h + c e²` at the narrowest place.
///
/// Without the cube it would be `t_2 = 2 V/(g + √(g² + 4 c e V))`, of the cube alone `t_3 = (3 V/c)^(1/3)`. `t_2/√(1 + (t_2/t_3)²)` is within 9 % of the root for all
/// `h`, `V` and `e`, with 4 % from a cube root by the bits of the number. A step of the third order in Householder's family, which takes all derivatives there are,
/// leaves 1.2e-5 of that and a second one only rounding.
fn under_parabola(h: f64, volume: f64, c: f64, e: f64) -> f64 {
    let g = h + c * e * e;
    let quadratic = 2.0 * volume / (g + (g * g + 4.0 * c * e * volume).sqrt());
    let over = quadratic * inverse_cube_root(3.0 * volume / c);
    let mut t = quadratic / (1.0 + over * over).sqrt();
    for _ in 0..2 {
        let s = c * (e + t);
        let (f, d) = (t * (g + c * t * (e + t / 3.0)) - volume, h + s * (e + t));
        t -= f * (d * d - f * s) / (d * (d * d - 2.0 * f * s) + f * f * (c / 3.0));
    }
    t
}

/// `x^(-1/3)` of a positive number, to 4 %: the exponent is divided by three and the mantissa goes with it.
const fn inverse_cube_root(x: f64) -> f64 {
    f64::from_bits(INVERSE_CUBE_ROOT.wrapping_sub(x.to_bits() / 3))
}
