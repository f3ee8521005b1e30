//! Numbers for people, and for programs.

use gudgeon_core::elementary;
use std::fmt::Write as _;

/// `value` with `digits` significant digits; powers of ten outside 10⁻³ … 10⁶. An absent or non-finite value is a dash.
pub(crate) fn significant(value: Option<f64>, digits: usize) -> String {
    let Some(value) = value.filter(|v| v.is_finite()) else { return "–".into() };
    if value == 0.0 {
        return "0".into();
    }
    let digits = digits.max(1);
    // The exponent after rounding: 9.9999 with three digits is 10.0, not 9.99 or 10.00.
    let scientific = format!("{:.*e}", digits - 1, value.abs());
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let mut out = String::from(if value < 0.0 { "−" } else { "" });
    if !(-3..6).contains(&exponent) {
        out.extend([mantissa, "×10", &superscript(exponent)]);
    } else if exponent < 0 {
        out.push_str("0.");
        out.extend((exponent + 1..0).map(|_| '0'));
        out.extend(mantissa.chars().filter(|c| *c != '.'));
    } else if exponent as usize + 1 < digits {
        let shown = mantissa.chars().filter(|c| *c != '.');
        shown.enumerate().for_each(|(k, c)| {
            out.push_str(if k == exponent as usize + 1 { "." } else { "" });
            out.push(c);
        });
    } else {
        // No digit before the point is left out.
        let _ = write!(out, "{:.0}", value.abs());
    }
    out
}

/// A value with the digits that hold: as many as its uncertainty leaves, and that uncertainty with one digit. Without one, `digits`.
pub(crate) fn certain(value: Option<f64>, uncertainty: Option<f64>, digits: usize) -> String {
    /// More digits than anybody reads.
    const MOST: i32 = 9;
    let (Some(v), Some(u)) = (value.filter(|v| v.is_finite()), uncertainty.filter(|u| *u > 0.0)) else {
        return match value {
            // Counts and orders are whole, and no measure is so by chance.
            Some(v) if v.fract() == 0.0 && v.abs() < 1e6 => format!("{v}").replace('-', "−"),
            _ => significant(value, digits),
        };
    };
    // Twice the uncertainty fits into one unit of the last digit but one.
    let held = elementary::log10(v.abs() / u).floor() as i32 + 1;
    if v == 0.0 || held <= 0 {
        return format!(
            "{} ± {}",
            significant(Some(if held <= 0 { 0.0 } else { v }), 1),
            significant(Some(u), 1)
        );
    }
    let text = significant(Some(v), held.clamp(1, MOST) as usize);
    if held > MOST { text } else { format!("{text} ± {}", significant(Some(u), 1)) }
}

/// A difference with its sign, and behind it ` ± ` its uncertainty where that is known: apart, so that a unit can stand between. As many digits as the uncertainty
/// leaves, at most four.
pub(crate) fn signed(value: f64, uncertainty: Option<f64>) -> (String, String) {
    const DIGITS: usize = 3;
    let plus = |text: String| if value > 0.0 && text != "0" { format!("+{text}") } else { text };
    let Some(u) = uncertainty.filter(|u| *u > 0.0) else {
        return (plus(certain(Some(value), None, DIGITS)), String::new());
    };
    // One digit more where both are of one size.
    let close = i32::from((0.5..2.0).contains(&(value.abs() / u)));
    let place = |x: f64| elementary::log10(x).floor() as i32;
    // Down to the place of the first digit of the uncertainty.
    let held = if value == 0.0 { 0 } else { place(value.abs()) - place(u) + 1 + close };
    let text =
        if held > 0 { significant(Some(value), held.min(DIGITS as i32 + 1) as usize) } else { "0".into() };
    (plus(text), format!(" ± {}", significant(Some(u), 1 + close as usize)))
}

/// A relative difference in percent with its sign, finer the smaller it is.
pub(crate) fn percent(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let size = value.abs();
    let text = if size < 5e-4 {
        "0".into()
    } else if size < 0.1 {
        format!("{value:+.3}")
    } else if size < 10.0 {
        format!("{value:+.2}")
    } else if size < 1e4 {
        format!("{value:+.1}")
    } else {
        format!("{value:+.1e}")
    };
    format!("{} %", text.replace('-', "−"))
}

/// Units as they are typeset.
pub(crate) fn unit(text: &str) -> String {
    match text {
        "-" | "" | "1" => String::new(),
        "um" => "µm".into(),
        "deg" => "°".into(),
        "degC" => "°C".into(),
        _ => text
            .replace("um", "µm")
            .replace("m2", "m²")
            .replace("m3", "m³")
            .replace("m4", "m⁴")
            .replace("s2", "s²"),
    }
}

/// A counter with thin spaces between groups of three digits.
pub(crate) fn count(n: u64) -> String {
    let plain = n.to_string();
    if plain.len() < 5 {
        return plain;
    }
    let mut text = String::new();
    for (i, c) in plain.chars().enumerate() {
        if i > 0 && (plain.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(c);
    }
    text
}

/// First letter large.
pub(crate) fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().collect::<String>() + chars.as_str())
}

fn superscript(n: i32) -> String {
    n.to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' | '4'..='9' => char::from_u32(0x2070 + c as u32 - '0' as u32).unwrap_or(c),
            _ => c,
        })
        .collect()
}

/// Room for the text of one number after the other.
#[derive(Default)]
pub(crate) struct RoundTrip {
    fast: zmij::Buffer,
    other: String,
}

impl RoundTrip {
    /// Shortest decimal text that reads back as the same number, in powers of ten outside 10⁻⁴ … 10¹⁵; empty for one that is not finite.
    pub(crate) fn text(&mut self, value: f64) -> &str {
        let size = value.abs();
        if (1e-4..1e15).contains(&size) || size < 1e-5 {
            let text = self.fast.format_finite(value);
            return text.strip_suffix(".0").unwrap_or(text);
        }
        self.moved(value)
    }

    /// Where that library puts the point or the exponent elsewhere. Apart, for the others to be written in line.
    #[inline(never)]
    fn moved(&mut self, value: f64) -> &str {
        self.other.clear();
        if value.abs() < 1e-4 {
            // `0.0000123` of that library is `1.23e-5`.
            let text = self.fast.format_finite(value);
            let size = text.strip_prefix('-').unwrap_or(text);
            let (first, rest) = size.strip_prefix("0.0000").unwrap_or(size).split_at(1);
            self.other.push_str(if value < 0.0 { "-" } else { "" });
            self.other.push_str(first);
            self.other.push_str(if rest.is_empty() { "" } else { "." });
            self.other.push_str(rest);
            self.other.push_str("e-5");
        } else if value.is_finite() {
            // Writing to a string does not fail.
            let _ = write!(self.other, "{value:e}");
        }
        &self.other
    }
}

/// The text of one number: [`RoundTrip::text`].
pub(crate) fn round_trip(value: f64) -> String {
    RoundTrip::default().text(value).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_stand_as_they_are() {
        assert_eq!(certain(Some(9.0), None, 4), "9");
        assert_eq!(certain(Some(-12.0), None, 4), "−12");
        assert_eq!(certain(Some(0.5), None, 4), "0.5000");
        assert_eq!(certain(Some(9.0), Some(0.0), 4), "9");
        assert_eq!(certain(None, None, 4), "–");
    }

    #[test]
    fn significant_digits_survive_rounding_up_and_extremes() {
        assert_eq!(significant(Some(49.9), 4), "49.90");
        assert_eq!(significant(Some(9.9996), 4), "10.00");
        assert_eq!(significant(Some(-0.012_345), 4), "−0.01235");
        assert_eq!(significant(Some(2.14e-9), 2), "2.1×10⁻⁹");
        assert_eq!(significant(Some(123_456.7), 4), "123457");
        assert_eq!(significant(Some(0.0), 4), "0");
        assert_eq!(significant(Some(f64::NAN), 4), "–");
        assert_eq!(significant(None, 4), "–");
    }

    #[test]
    fn digits_that_do_not_hold_are_not_printed() {
        assert_eq!(certain(Some(83.412_34), Some(0.021), 4), "83.41 ± 0.02");
        assert_eq!(certain(Some(83.412_34), Some(21.0), 4), "83 ± 21");
        assert_eq!(certain(Some(1294.0), Some(600.0), 4), "1294 ± 600");
        assert_eq!(certain(Some(0.01), Some(0.3), 4), "0 ± 0.3");
        assert_eq!(certain(Some(1.0 / 3.0), Some(1e-14), 4), "0.333333333");
        assert_eq!(certain(Some(49.9), None, 4), "49.90");
    }

    #[test]
    fn differences_have_a_sign_and_the_digits_that_hold() {
        let text = |v, u| signed(v, u).into();
        let all: [[String; 2]; 7] = [
            text(3.2168, Some(0.12)),
            text(-3.2168, Some(1e-9)),
            text(0.01, Some(0.3)),
            text(0.0612, Some(0.0588)),
            text(3.2168, None),
            text(3.0, Some(0.0)),
            text(-0.0, Some(0.1)),
        ];
        let expected = [
            ["+3.2", " ± 0.1"],
            ["−3.217", " ± 1×10⁻⁹"],
            ["0", " ± 0.3"],
            ["+0.061", " ± 0.059"],
            ["+3.22", ""],
            ["+3", ""],
            ["0", " ± 0.1"],
        ];
        assert_eq!(all, expected);
    }

    #[test]
    fn percentages_have_a_sign() {
        assert_eq!(percent(3.456), "+3.46 %");
        assert_eq!(percent(-12.34), "−12.3 %");
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(percent(f64::INFINITY), "–");
    }

    #[test]
    fn round_trip_is_exact_at_every_size() {
        let mut writer = RoundTrip::default();
        let mut sizes: Vec<f64> = (-330..=308).map(|e| format!("1.2345e{e}").parse().unwrap()).collect();
        sizes.extend((-330..=308).map(|e| format!("1e{e}").parse::<f64>().unwrap()));
        sizes.extend((0..2000).map(|k| 1e-5 + 4.4987e-8 * f64::from(k)));
        sizes.extend([0.1, 1.0 / 3.0, 1.0 / 3e5, 5e-324, f64::MAX, 101_325.0, 720.0, 0.3 - 0.1]);
        for size in sizes {
            let near = [size, size.next_up(), size.next_down()].into_iter().filter(|v| v.is_finite());
            for v in near.flat_map(|v| [v, -v]) {
                let plain = v == 0.0 || (1e-4..1e15).contains(&v.abs());
                let expected = if plain { format!("{v}") } else { format!("{v:e}") };
                assert_eq!(writer.text(v), expected);
                assert_eq!(expected.parse::<f64>().unwrap().to_bits(), v.to_bits());
            }
        }
        assert_eq!(round_trip(f64::NAN), "");
        assert_eq!(round_trip(f64::NEG_INFINITY), "");
    }

    #[test]
    fn counters_are_grouped() {
        assert_eq!(count(9999), "9999");
        assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
    }
}
