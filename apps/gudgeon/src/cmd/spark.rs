//! A row of values as a line of characters, and in words.

use crate::ui::number;

/// Characters of a line; longer rows are thinned out.
const MAX_LENGTH: usize = 24;

/// Part of the range by which a value may go back without being called so: what a solver leaves of noise.
const NOISE: f64 = 1e-3;

/// Part of the largest magnitude below which a range is none.
const CONSTANT: f64 = 1e-9;

/// Part of the largest magnitude below which a range has no course worth a word: it is told as 0.0 %.
const SLIGHT: f64 = 5e-4;

/// Places of at most `most` of `n` values, evenly spaced, the first and the last among them.
pub fn chosen(n: usize, most: usize) -> Vec<usize> {
    match (n, most) {
        (0, _) | (_, 0) => Vec::new(),
        (_, 1) => vec![0],
        (n, most) if n <= most => (0..n).collect(),
        (n, most) => (0..most).map(|k| (k * (n - 1) + (most - 1) / 2) / (most - 1)).collect(),
    }
}

/// Least and greatest of the finite values.
pub fn range(values: &[f64]) -> Option<(f64, f64)> {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    finite.fold(None, |r, v| Some(r.map_or((v, v), |(lo, hi): (f64, f64)| (lo.min(v), hi.max(v)))))
}

/// Blocks of eight heights between `lo` and `hi`; `x` where there is no value.
pub fn line(values: &[f64], (lo, hi): (f64, f64)) -> String {
    const BLOCKS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let top = (BLOCKS.len() - 1) as f64;
    let one = |v: f64| {
        if !v.is_finite() {
            return 'x';
        }
        let part = if hi > lo { (0.5 * v - 0.5 * lo) / (0.5 * hi - 0.5 * lo) } else { 0.5 };
        BLOCKS[(part.clamp(0.0, 1.0) * top).round() as usize]
    };
    chosen(values.len(), MAX_LENGTH).into_iter().map(|k| one(values[k])).collect()
}

/// Whether a range is one of rounding.
fn is_constant(range: (f64, f64)) -> bool {
    is_within(range, CONSTANT)
}

/// Whether a range is less than a part of the largest magnitude.
fn is_within((lo, hi): (f64, f64), part: f64) -> bool {
    // Halves first: the difference of two finite numbers may be none.
    0.5 * hi - 0.5 * lo <= 0.5 * part * lo.abs().max(hi.abs())
}

/// How a row goes: `rises`, `falls`, `constant`, `nearly constant`, `least at …`, `greatest at …`, `to and fro`. `at` names the places.
pub fn course(values: &[f64], at: &[String]) -> String {
    let there: Vec<(usize, f64)> =
        values.iter().copied().enumerate().filter(|(_, v)| v.is_finite()).collect();
    let (Some((lo, hi)), true) = (range(values), there.len() > 1) else { return String::new() };
    if is_constant((lo, hi)) {
        return "constant".into();
    }
    if is_within((lo, hi), SLIGHT) {
        return "nearly constant".into();
    }
    let noise = NOISE * (0.5 * hi - 0.5 * lo);
    let step = |w: &[(usize, f64)]| 0.5 * w[1].1 - 0.5 * w[0].1;
    let rises = |part: &[(usize, f64)]| part.windows(2).all(|w| step(w) >= -noise);
    let falls = |part: &[(usize, f64)]| part.windows(2).all(|w| step(w) <= noise);
    let place = |v: f64| there.iter().position(|t| t.1 == v).unwrap_or_default();
    let (least, greatest) = (place(lo), place(hi));
    let name = |k: usize| at.get(there[k].0).map_or("", String::as_str);
    if rises(&there) {
        "rises".into()
    } else if falls(&there) {
        "falls".into()
    } else if falls(&there[..=least]) && rises(&there[least..]) {
        format!("least at {}", name(least))
    } else if rises(&there[..=greatest]) && falls(&there[greatest..]) {
        format!("greatest at {}", name(greatest))
    } else {
        "to and fro".into()
    }
}

/// The change from the first to the last value, in per cent; nothing where that says nothing.
pub fn change(values: &[f64]) -> String {
    if range(values).is_none_or(is_constant) {
        return String::new();
    }
    let mut finite = values.iter().copied().filter(|v| v.is_finite());
    match (finite.next(), finite.next_back()) {
        (Some(a), Some(b)) if a != 0.0 && a.signum() == b.signum() && (b / a).is_finite() => {
            let percent = 100.0 * (b / a - 1.0);
            if percent.abs() < 1000.0 { format!("{percent:+.1} %") } else { format!("x {}", number(b / a)) }
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NO: f64 = f64::NAN;

    #[test]
    fn lines_show_the_range() {
        assert_eq!(line(&[0.0, 1.0, NO, 0.5], (0.0, 1.0)), "▁█x▅");
        assert_eq!(line(&[2.0, 2.0], (2.0, 2.0)), "▅▅");
        assert_eq!(line(&[f64::MIN, f64::MAX], (f64::MIN, f64::MAX)), "▁█");
        assert_eq!(line(&[1.0; 1000], (0.0, 1.0)).chars().count(), MAX_LENGTH);
        assert_eq!(line(&[], (0.0, 1.0)), "");
    }

    #[test]
    fn first_and_last_are_always_chosen() {
        assert_eq!(chosen(3, 6), [0, 1, 2]);
        for n in 7..100 {
            let k = chosen(n, 6);
            assert_eq!((k.len(), k[0], k[5]), (6, 0, n - 1));
            assert!(k.windows(2).all(|w| w[0] < w[1]), "{k:?}");
        }
        assert!(chosen(0, 6).is_empty() && chosen(5, 0).is_empty());
    }

    #[test]
    fn courses_are_told_in_words() {
        let at: Vec<String> = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
        let of = |v: &[f64]| course(v, &at);
        assert_eq!(of(&[1.0, 2.0, 2.0, 5.0]), "rises");
        assert_eq!(of(&[5.0, 2.0, NO, 1.0]), "falls");
        assert_eq!(of(&[3.0, 1.0, 2.0, 5.0]), "least at b");
        assert_eq!(of(&[1.0, NO, 4.0, 3.0]), "greatest at c");
        assert_eq!(of(&[1.0, 2.0, 1.0, 2.0]), "to and fro");
        // Noise of a solver, a ten-thousandth of the range, is no turn; rounding is no change at all.
        assert_eq!(of(&[0.0, 1.0, 0.9999, 2.0]), "rises");
        assert_eq!(of(&[1.0, 1.0 + 1e-12, 1.0]), "constant");
        // What is told as 0.0 % has no course.
        assert_eq!(of(&[1.0, 1.0004, 1.0, 1.0003]), "nearly constant");
        assert_eq!(of(&[0.0, 0.0]), "constant");
        assert_eq!(of(&[NO, 1.0]), "");
    }

    #[test]
    fn changes_are_told_where_they_say_something() {
        assert_eq!(change(&[2.0, 9.0, 1.0]), "-50.0 %");
        assert_eq!(change(&[NO, 2.0, 3.0, NO]), "+50.0 %");
        assert_eq!(change(&[1.0, 100.0]), "x 100");
        for nothing in [&[0.0, 1.0][..], &[-1.0, 1.0], &[1.0], &[3.0, 3.0], &[NO, NO], &[]] {
            assert_eq!(change(nothing), "");
        }
    }
}
