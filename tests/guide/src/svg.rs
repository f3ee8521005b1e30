//! Small figures: curves over an axis, or bars, as SVG that reads on light and dark pages.

use gudgeon_core::elementary;
use std::fmt::Write as _;

/// A curve or a bar.
#[derive(Debug, Clone)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Abscissas.
    pub x: Vec<f64>,
    /// Ordinates.
    pub y: Vec<f64>,
}

/// Colours that differ for colour-blind readers too (Okabe and Ito's), and dashes where curves coincide.
const COLOURS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#9a6324"];
const DASHES: [&str; 4] = ["", "7 4", "2 3", "9 3 2 3"];

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 66.0;
const TOP: f64 = 14.0;
const RIGHT: f64 = 626.0;
const BOTTOM: f64 = 254.0;

/// What a plot shows besides its curves.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// Text under the abscissa.
    pub x: String,
    /// Text beside the ordinate.
    pub y: String,
    /// Logarithmic ordinate.
    pub log: bool,
}

/// Ends of both axes.
type Ends = [f64; 4];

/// Curves over their axis.
#[must_use]
pub fn curves(all: &[Curve], frame: &Frame) -> String {
    let up = |v: f64| if frame.log { elementary::log10(v.max(1e-300)) } else { v };
    let (x0, x1) = span(all.iter().flat_map(|c| c.x.iter().copied()));
    let (y0, y1) = span(all.iter().flat_map(|c| c.y.iter().map(|v| up(*v))));
    let mut s = head(HEIGHT + 18.0 * all.len().div_ceil(3) as f64);
    axes(&mut s, frame, [x0, x1, y0, y1]);
    for (n, c) in all.iter().enumerate() {
        let at = |(x, y): (&f64, &f64)| (place(*x, x0, x1, LEFT, RIGHT), place(up(*y), y0, y1, BOTTOM, TOP));
        let points: Vec<(f64, f64)> = c.x.iter().zip(&c.y).map(at).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(s, "<path {} d=\"{}\"/>", style(n), path(&points));
        legend(&mut s, n, &c.label);
    }
    s + "</svg>\n"
}

/// Lines of both axes with their numbers, and what they are.
fn axes(s: &mut String, frame: &Frame, [x0, x1, y0, y1]: Ends) {
    for t in ticks(x0, x1) {
        let (x, y) = (place(t, x0, x1, LEFT, RIGHT), BOTTOM + 16.0);
        let _ = write!(s, "<path class=\"g\" d=\"M{x:.1} {TOP}V{BOTTOM}\"/>");
        let _ = writeln!(s, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{}</text>", number(t));
    }
    for t in if frame.log { decades(y0, y1) } else { ticks(y0, y1) } {
        let (x, y) = (LEFT - 6.0, place(t, y0, y1, BOTTOM, TOP));
        let text = number(if frame.log { elementary::powf(10f64, t) } else { t });
        let _ = write!(s, "<path class=\"g\" d=\"M{LEFT} {y:.1}H{RIGHT}\"/>");
        let _ = writeln!(s, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>", y + 4.0);
    }
    let (x, y) = (0.5 * (LEFT + RIGHT), BOTTOM + 34.0);
    let _ = writeln!(s, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{}</text>", safe(&frame.x));
    let place = format!("translate(13 {:.1}) rotate(-90)", 0.5 * (TOP + BOTTOM));
    let _ = writeln!(s, "<text transform=\"{place}\" text-anchor=\"middle\">{}</text>", safe(&frame.y));
}

/// A line and its label, three in a row below the figure.
fn legend(s: &mut String, n: usize, label: &str) {
    let (x, y) = (LEFT + 190.0 * (n % 3) as f64, HEIGHT + 10.0 + 18.0 * (n / 3) as f64);
    let _ = write!(s, "<path {} d=\"M{x:.0} {:.0}h24\"/>", style(n), y - 4.0);
    let _ = writeln!(s, "<text x=\"{:.0}\" y=\"{y:.0}\">{}</text>", x + 30.0, safe(label));
}

/// Bars of one number each, the first of `y`.
#[must_use]
pub fn bars(all: &[Curve], frame: &Frame) -> String {
    let value = |c: &Curve| c.y.first().copied().unwrap_or_default();
    let (lo, hi) = span(all.iter().map(value).chain([0.0]));
    let (left, right) = (190.0, 560.0);
    let mut s = head(44.0 + 24.0 * all.len() as f64);
    for (n, c) in all.iter().enumerate() {
        let y = 12.0 + 24.0 * n as f64;
        let (a, b) = (place(0.0, lo, hi, left, right), place(value(c), lo, hi, left, right));
        let _ = write!(
            s,
            "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"end\">{}</text>",
            left - 8.0,
            y + 12.0,
            safe(&c.label)
        );
        let _ = write!(
            s,
            "<path fill=\"{}\" d=\"M{a:.1} {y:.0}H{b:.1}v16H{a:.1}z\"/>",
            COLOURS[n % COLOURS.len()]
        );
        let _ =
            writeln!(s, "<text x=\"{:.1}\" y=\"{:.0}\">{}</text>", a.max(b) + 6.0, y + 12.0, three(value(c)));
    }
    let _ = writeln!(
        s,
        "<text x=\"{left}\" y=\"{:.0}\">{}</text>",
        30.0 + 24.0 * all.len() as f64,
        safe(&frame.y)
    );
    s + "</svg>\n"
}

fn head(height: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" width=\"{WIDTH}\" height=\"{height:.0}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <style>.g{{stroke:#8884;stroke-width:1;fill:none}}text{{fill:#777}}</style>\n"
    )
}

fn style(n: usize) -> String {
    let dash = DASHES[n % DASHES.len()];
    let dash = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dash}\"") };
    format!("fill=\"none\" stroke-width=\"1.8\" stroke=\"{}\"{dash}", COLOURS[n % COLOURS.len()])
}

/// A polyline without points that lie within 0.3 px of a straight line through their neighbours.
fn path(points: &[(f64, f64)]) -> String {
    let mut out = String::new();
    let mut last = (f64::NAN, f64::NAN);
    for (n, p) in points.iter().enumerate() {
        let keep = match points.get(n + 1) {
            Some(next) if n > 0 => {
                let (dx, dy) = (next.0 - last.0, next.1 - last.1);
                let off =
                    ((p.0 - last.0) * dy - (p.1 - last.1) * dx).abs() / elementary::hypot(dx, dy).max(1e-9);
                off > 0.3 || elementary::hypot(p.0 - last.0, p.1 - last.1) > 12.0
            }
            _ => true,
        };
        if keep && p.0.is_finite() && p.1.is_finite() {
            let _ = write!(out, "{}{:.1} {:.1}", if out.is_empty() { "M" } else { "L" }, p.0, p.1);
            last = *p;
        }
    }
    out
}

fn place(v: f64, a: f64, b: f64, from: f64, to: f64) -> f64 {
    from + (v - a) / (b - a) * (to - from)
}

fn span(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (lo, hi) =
        values.filter(|v| v.is_finite()).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
    if hi > lo { (lo, hi) } else { (lo - 0.5, lo + 0.5) }
}

/// Four to nine round numbers between two ends.
fn ticks(a: f64, b: f64) -> Vec<f64> {
    let rough = (b - a) / 5.0;
    let power = elementary::powf(10f64, elementary::log10(rough).floor());
    let step = [1.0, 2.0, 5.0, 10.0].iter().map(|m| m * power).find(|s| *s >= rough).unwrap_or(rough);
    let first = (a / step).ceil() as i64;
    let last = (b / step).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

/// Logarithms of 1, 2 and 5 in every decade; of 1 alone where there are more than three.
fn decades(a: f64, b: f64) -> Vec<f64> {
    let steps: &[f64] = if b - a > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let (first, last) = (a.floor() as i32, b.ceil() as i32);
    let all = (first..=last).flat_map(|d| steps.iter().map(move |s| f64::from(d) + elementary::log10(*s)));
    all.filter(|t| (a..=b).contains(t)).collect()
}

fn number(v: f64) -> String {
    let text =
        if v != 0.0 && (v.abs() >= 1e5 || v.abs() < 1e-3) { format!("{v:.1e}") } else { format!("{v:.4}") };
    if text.contains('e') || !text.contains('.') {
        text
    } else {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

/// Three figures.
fn three(v: f64) -> String {
    if v == 0.0 {
        return "0".into();
    }
    let digits = (2.0 - elementary::log10(v.abs()).floor()).clamp(0.0, 6.0) as usize;
    if v.abs() >= 1e6 || v.abs() < 1e-3 { format!("{v:.2e}") } else { format!("{v:.digits$}") }
}

fn safe(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
