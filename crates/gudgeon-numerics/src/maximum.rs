//! The largest value of a function of one variable, from samples that show where its tops are.

/// Tops lower than this part of the highest sample are not looked at: a sample beside a top misses less of it.
const WORTH: f64 = 0.7;
/// Width to which a top is narrowed down, by the distance of the samples beside it. Where the function is smooth the value is then
/// right to its square.
const NARROW: f64 = 1e-7;
/// Distance of the points through which the last parabola goes, by that of the samples.
const WIDE: f64 = 1e-3;
/// Samples closer than this part of the whole range are one: no top lies between them, and none may hide behind such a pair.
const SAME: f64 = 1e-9;
/// Maximum number of evaluations for one top.
const MAX_EVALUATIONS: usize = 80;

/// Place and largest value of `f` between the first and the last of `samples`, `(x, f(x))` with x ascending.
///
/// Every local top among the samples is narrowed down by Brent's method (parabolas, golden sections). A parabola through three points a
/// little apart then gives the place, which the values alone would leave to their rounding. A top that no sample shows is not found.
/// Without samples, and where `f` gives nothing but NaN, the value is minus infinity.
pub fn maximise(samples: &[(f64, f64)], mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    let span = samples.last().zip(samples.first()).map_or(0.0, |(b, a)| b.0 - a.0);
    let mut best = (f64::NAN, f64::NEG_INFINITY);
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(samples.len());
    for p in samples {
        if p.1 > best.1 {
            best = *p;
        }
        match points.last_mut() {
            Some(last) if p.0 - last.0 <= SAME * span => {
                if p.1 > last.1 {
                    *last = *p;
                }
            }
            _ => points.push(*p),
        }
    }
    let n = points.len();
    let value = |i: usize| points[i].1;
    let mut tops: Vec<usize> = (0..n)
        .filter(|&i| value(i) >= WORTH * best.1)
        .filter(|&i| (i == 0 || value(i) >= value(i - 1)) && (i + 1 == n || value(i) > value(i + 1)))
        .collect();
    tops.sort_by(|a, b| value(*b).total_cmp(&value(*a)));
    for i in tops {
        let found = if n < 2 {
            points[i]
        } else if i == 0 || i + 1 == n {
            at_end(points[i], points[if i == 0 { 1 } else { n - 2 }], &mut f)
        } else {
            narrowed(points[i - 1].0, points[i], points[i + 1].0, &mut f)
        };
        if found.1 > best.1 {
            best = found;
        }
    }
    best
}

/// The end itself, unless the function rises from it first.
fn at_end(end: (f64, f64), next: (f64, f64), f: &mut impl FnMut(f64) -> f64) -> (f64, f64) {
    let x = end.0 + WIDE * (next.0 - end.0);
    let inside = (x, f(x));
    if inside.1 > end.1 { narrowed(end.0.min(next.0), inside, end.0.max(next.0), f) } else { end }
}

/// Brent's method for the top between `a` and `b` from a point between them that is higher than both.
fn narrowed(a: f64, top: (f64, f64), b: f64, f: &mut impl FnMut(f64) -> f64) -> (f64, f64) {
    let golden = 0.5 * (3.0 - 5.0_f64.sqrt());
    let (mut low, mut high) = (a, b);
    // Highest, second, third; the last two steps.
    let (mut x, mut w, mut v) = (top, top, top);
    let (mut step, mut before) = (0.0_f64, 0.0_f64);
    let tolerance = NARROW * (b - a);
    for _ in 0..MAX_EVALUATIONS {
        let middle = 0.5 * (low + high);
        if (x.0 - middle).abs() <= 2.0 * tolerance - 0.5 * (high - low) {
            break;
        }
        let r = (x.0 - w.0) * (x.1 - v.1);
        let q = (x.0 - v.0) * (x.1 - w.1);
        let (mut p, mut q) = ((x.0 - v.0) * q - (x.0 - w.0) * r, 2.0 * (q - r));
        if q > 0.0 {
            p = -p;
        }
        q = q.abs();
        let last = std::mem::replace(&mut before, step);
        let parabola = last.abs() > tolerance
            && p.abs() < (0.5 * q * last).abs()
            && p > q * (low - x.0)
            && p < q * (high - x.0);
        if parabola {
            step = p / q;
            let u = x.0 + step;
            if u - low < 2.0 * tolerance || high - u < 2.0 * tolerance {
                step = tolerance.copysign(middle - x.0);
            }
        } else {
            before = if x.0 >= middle { low - x.0 } else { high - x.0 };
            step = golden * before;
        }
        let u = x.0 + if step.abs() >= tolerance { step } else { tolerance.copysign(step) };
        let u = (u, f(u));
        if u.1 >= x.1 {
            if u.0 >= x.0 {
                low = x.0
            } else {
                high = x.0
            }
            (v, w, x) = (w, x, u);
        } else {
            if u.0 < x.0 {
                low = u.0
            } else {
                high = u.0
            }
            if u.1 >= w.1 || w.0 == x.0 {
                (v, w) = (w, u);
            } else if u.1 >= v.1 || v.0 == x.0 || v.0 == w.0 {
                v = u;
            }
        }
    }
    let h = (WIDE * (b - a)).min(x.0 - a).min(b - x.0);
    if h > 10.0 * tolerance {
        let (left, right) = (f(x.0 - h), f(x.0 + h));
        let curve = left - 2.0 * x.1 + right;
        if curve < 0.0 {
            let at = x.0 + (0.5 * h * (left - right) / curve).clamp(-h, h);
            let placed = (at, f(at));
            // Not where the top is too sharp for a parabola of this width.
            if placed.1 >= x.1 - 1e-9 * x.1.abs() {
                return placed;
            }
        }
    }
    x
}
