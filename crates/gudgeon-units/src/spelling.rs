//! How people write numbers and units: look-alike characters, decimal commas, names written out.

use super::{ALL_DIMENSIONS, Unit};

/// A character as units write it: keyboards and word processors have several for the same sign.
const fn plain(c: char) -> char {
    match c {
        // Micro sign, Greek letter mu.
        '\u{b5}' | '\u{3bc}' => 'u',
        // Masculine ordinal, ring above.
        '\u{ba}' | '\u{2da}' => '°',
        // Spaces that do not break or are narrow.
        '\u{a0}' | '\u{2009}' | '\u{202f}' => ' ',
        c => c,
    }
}

impl Unit {
    /// Whether a text means this unit, whichever of the look-alike characters it is written with.
    #[must_use]
    pub fn is(&self, text: &str) -> bool {
        self.name.chars().map(plain).eq(text.chars().map(plain))
    }
}

/// `0,5 mm` as `0.5 mm`, a minus sign of typography as a hyphen; nothing where neither stands.
#[must_use]
pub fn with_decimal_point(text: &str) -> Option<String> {
    let t = text.trim();
    let (sign, digits) = match t.chars().next()? {
        '\u{2212}' | '\u{2013}' => ("-", &t[3..]),
        '-' => ("-", &t[1..]),
        _ => ("", t),
    };
    let count = |s: &str| s.chars().take_while(char::is_ascii_digit).count();
    let whole = count(digits);
    let rest = digits[whole..].strip_prefix(',').filter(|r| count(r) > 0 && !r.contains(','));
    match rest {
        Some(rest) if whole > 0 => Some(format!("{sign}{}.{rest}", &digits[..whole])),
        _ if whole > 0 && !t.starts_with(['-', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']) => {
            Some(format!("{sign}{digits}"))
        }
        _ => None,
    }
}

/// Names that units are known by besides their own.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("millimetre", "mm"),
    ("millimeter", "mm"),
    ("micrometre", "um"),
    ("micrometer", "um"),
    ("micron", "um"),
    ("mu", "um"),
    ("metre", "m"),
    ("meter", "m"),
    ("inch", "in"),
    ("\"", "in"),
    ("c", "degC"),
    ("oc", "degC"),
    ("celsius", "degC"),
    ("centigrade", "degC"),
    ("kelvin", "K"),
    ("degree", "deg"),
    ("°", "deg"),
    ("°ca", "deg"),
    ("degca", "deg"),
    ("radian", "rad"),
    ("/min", "rpm"),
    ("min-1", "rpm"),
    ("u/min", "rpm"),
    ("r/min", "rpm"),
    ("rev/min", "rpm"),
    ("hpa", "mbar"),
    ("n/mm2", "MPa"),
    ("n/m2", "Pa"),
    ("pascal", "Pa"),
    ("kp/cm2", "kgf/cm2"),
    ("at", "kgf/cm2"),
    ("kp", "kgf"),
    ("newton", "N"),
    ("gram", "g"),
    ("kilogram", "kg"),
    ("second", "s"),
    ("sec", "s"),
    ("litre", "l"),
    ("liter", "l"),
    ("ccm", "cm3"),
    ("cc", "cm3"),
    ("joule", "J"),
    ("watt", "W"),
    ("hertz", "Hz"),
    ("percent", "%"),
];

/// A unit without what writers differ in: case, spaces, signs of multiplication and powers.
fn folded(unit: &str) -> String {
    let digit = |c| match c {
        '²' => '2',
        '³' => '3',
        '⁻' => '-',
        '¹' => '1',
        c => c,
    };
    unit.chars()
        .map(plain)
        .filter(|c| !c.is_whitespace() && !"*·⋅^.".contains(*c))
        .map(digit)
        .flat_map(char::to_lowercase)
        .collect()
}

/// The unit of a dimension that a text probably means, and whether it only writes it in another way (rather than being few letters
/// off).
#[must_use]
pub fn nearest_unit(dimension: &str, text: &str) -> Option<(&'static str, bool)> {
    let (_, units, _) = ALL_DIMENSIONS.iter().find(|(name, ..)| *name == dimension)?;
    let wanted = folded(text);
    // `MPa` and `mPa s` differ by case alone: the same letters in the same case come first.
    let same = |u: &&Unit| !u.name.is_empty() && folded(u.name) == wanted;
    if let Some(u) = units.iter().find(same) {
        return Some((u.name, true));
    }
    let singular = wanted.strip_suffix('s').unwrap_or(&wanted);
    let meant = OTHER_NAMES.iter().find(|(n, _)| *n == wanted || *n == singular).map(|(_, u)| *u);
    if let Some(u) = units.iter().find(|u| Some(u.name) == meant) {
        return Some((u.name, true));
    }
    if wanted.len() < 2 {
        return None;
    }
    let near = units.iter().filter(|u| u.name.len() >= 2).find(|u| one_edit(&folded(u.name), &wanted));
    near.map(|u| (u.name, false))
}

/// Whether one letter more, less, different or exchanged with its neighbour makes one text the other.
fn one_edit(a: &str, b: &str) -> bool {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let head = a.iter().zip(&b).take_while(|(x, y)| x == y).count();
    let (ra, rb) = (&a[head..], &b[head..]);
    match (ra, rb) {
        ([x, y, s @ ..], [v, w, t @ ..]) if x == w && y == v && s == t => true,
        ([_, s @ ..], [_, t @ ..]) if s == t => true,
        ([_, s @ ..], t) if s == t => true,
        (s, [_, t @ ..]) => s == t,
        _ => false,
    }
}
