//! Small pictures beside headline results: curves without axes, drawn as the page is written, so that they print and need no script.

use std::fmt::Write;

use gudgeon_core::result::Column;

use crate::number::{significant, unit};
use crate::page::esc;

/// Width and height in the units of its drawing.
const SIZE: (f64, f64) = (200.0, 44.0);
/// Stretches of the abscissa; each is drawn by its minimum and maximum, so that no peak is lost.
const STRETCHES: usize = 100;

/// Curves over one axis with a common ordinate, which holds zero unless all values are far from it; none where there is nothing to draw.
pub(crate) fn spark(columns: &[&Column]) -> Option<String> {
    let ranges: Vec<(f64, f64)> = columns.iter().map(|c| range(&c.values)).collect();
    let (low, high) = ranges
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), range| (low.min(range.0), high.max(range.1)));
    if low >= high {
        return None;
    }
    let (low, high) = (low.min(0.0), high.max(0.0));
    let (w, h) = SIZE;
    let y = |v: f64| 2.0 + (h - 4.0) * (high - v) / (high - low);
    let mut out = format!(
        "<svg class=\"spark\" viewBox=\"0 0 {w} {h}\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{}\">",
        esc(&told(columns, &ranges))
    );
    let _ = write!(out, "<line x1=\"0\" x2=\"{w}\" y1=\"{0:.1}\" y2=\"{0:.1}\" class=\"zero\"/>", y(0.0));
    for (k, c) in columns.iter().enumerate() {
        out.push_str("<polyline points=\"");
        for (n, (at, v)) in sampled(&c.values).iter().enumerate() {
            out.push_str(if n > 0 { " " } else { "" });
            tenths(&mut out, w * at);
            out.push(',');
            tenths(&mut out, y(*v));
        }
        let _ = write!(out, "\" style=\"stroke:var(--c{})\"/>", k % 8);
    }
    out.push_str("</svg>");
    Some(out)
}

/// A number from zero to its sizes with one decimal, for which the exact formatting of any number takes ten times as long.
fn tenths(out: &mut String, value: f64) {
    let exact = (10.0 * value).clamp(0.0, 9999.0);
    let whole = exact as u32;
    let tenths = whole + u32::from(exact - f64::from(whole) >= 0.5);
    let digit = |n: u32| char::from(b'0' + (n % 10) as u8);
    for (unit, place) in [(1000, 100), (100, 10)] {
        if tenths >= unit {
            out.push(digit(tenths / 10 / place));
        }
    }
    out.push(digit(tenths / 10));
    out.push('.');
    out.push(digit(tenths));
}

/// The least and the greatest of the values that are finite.
fn range(values: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in values.iter().filter(|v| v.is_finite()) {
        low = if *v < low { *v } else { low };
        high = if *v > high { *v } else { high };
    }
    (low, high)
}

/// What the picture shows, for those who do not see it.
fn told(columns: &[&Column], ranges: &[(f64, f64)]) -> String {
    let one = |(c, (low, high)): (&&Column, &(f64, f64))| {
        format!(
            "{} from {} to {} {}",
            c.name,
            significant(Some(*low), 3),
            significant(Some(*high), 3),
            unit(&c.unit)
        )
    };
    columns.iter().zip(ranges).map(one).collect::<Vec<_>>().join("; ")
}

/// Place, 0 to 1, and value of what is drawn of some rows: all of a few, minimum and maximum of each stretch of many.
fn sampled(values: &[f64]) -> Vec<(f64, f64)> {
    let last = values.len().saturating_sub(1).max(1) as f64;
    let place = |i: usize| i as f64 / last;
    let known = |(i, v): (usize, &f64)| v.is_finite().then_some((place(i), *v));
    if values.len() <= 2 * STRETCHES {
        return values.iter().enumerate().filter_map(known).collect();
    }
    let each = values.len().div_ceil(STRETCHES);
    let mut out = Vec::with_capacity(2 * STRETCHES);
    for (k, part) in values.chunks(each).enumerate() {
        let Some((low, high)) = extremes(part) else { continue };
        let (first, second) = (low.min(high), low.max(high));
        out.push((place(k * each + first), part[first]));
        if second != first {
            out.push((place(k * each + second), part[second]));
        }
    }
    out
}

/// Where the first minimum and the last maximum of some values stand, of those that are finite.
fn extremes(values: &[f64]) -> Option<(usize, usize)> {
    let mut finite = values.iter().enumerate().filter(|(_, v)| v.is_finite()).map(|(i, v)| (i, order(*v)));
    let first = finite.next()?;
    let (mut low, mut high) = (first, first);
    for this in finite {
        low = if this.1 < low.1 { this } else { low };
        high = if this.1 >= high.1 { this } else { high };
    }
    Some((low.0, high.0))
}

/// A whole number that orders as the total order of numbers does.
fn order(value: f64) -> i64 {
    let bits = value.to_bits() as i64;
    bits ^ ((bits >> 63) as u64 >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_survive_and_nothing_is_drawn_of_a_constant() {
        let mut values: Vec<f64> = (0..1441).map(|i| f64::from(i) * 1e-3).collect();
        values[777] = 50.0;
        assert!(sampled(&values).iter().any(|p| p.1 == 50.0));
        let column = |values| Column { name: "a".into(), unit: "N".into(), values };
        assert!(spark(&[&column(vec![1.0; 9])]).is_none());
        assert!(spark(&[&column(vec![f64::NAN; 9])]).is_none());
        assert!(spark(&[]).is_none());
        let drawn = spark(&[&column(values)]).unwrap();
        assert!(drawn.contains("a from 0 to 50.0 N") && !drawn.contains("NaN"));
    }

    #[test]
    fn of_equal_extremes_the_first_minimum_and_the_last_maximum_count() {
        assert_eq!(extremes(&[2.0, 1.0, 1.0, 2.0, f64::NAN]), Some((1, 3)));
        assert_eq!(extremes(&[0.0, -0.0, f64::INFINITY, 0.0]), Some((1, 3)));
        assert_eq!(extremes(&[-2.0, -1.0, -3.0]), Some((2, 1)));
        assert_eq!(extremes(&[f64::NAN]), None);
    }

    #[test]
    fn tenths_are_rounded() {
        let text = |value| {
            let mut out = String::new();
            tenths(&mut out, value);
            out
        };
        let all = [-0.2, 0.0, 0.049, 0.25, 12.34, 199.96, 2e9, f64::NAN];
        assert_eq!(all.map(text), ["0.0", "0.0", "0.0", "0.3", "12.3", "200.0", "999.9", "0.0"]);
    }
}
