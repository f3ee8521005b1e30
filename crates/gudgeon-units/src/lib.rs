//! Physical quantities as they stand in case files: `"120 mm"`, `"2000 rpm"`, `"100 degC"`, or a bare SI number.
//!
//! Inside the program every value is an SI `f64`; a [`Quantity`] exists only where a file is read or echoed. Its two
//! type parameters say which dimension it has and which values it admits, so that a wrong unit, a negative clearance
//! or a NaN is refused while the file is being read, where the error can still point at the text.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod spelling;

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub use spelling::{nearest_unit, with_decimal_point};

/// One unit of a dimension: `si = value * factor + offset`.
#[derive(Debug, Clone, Copy)]
pub struct Unit {
    /// The text a user writes.
    pub name: &'static str,
    /// Multiplier to SI.
    pub factor: f64,
    /// Added after the multiplication (temperatures only).
    pub offset: f64,
}

/// A physical dimension with the units a user may write. The first unit is the SI unit.
pub trait Dimension: 'static {
    /// What to call it in a message: "a length".
    const NAME: &'static str;
    /// Accepted units, the SI unit first.
    const UNITS: &'static [Unit];
    /// Largest magnitude that is read, in SI: some thousand times what any machine, or anything that stands for infinite in one, has. What
    /// is larger is a slip of the pen, and its powers overflow.
    const MOST: f64;
}

/// Which values of a dimension are admitted.
pub trait Bound: 'static {
    /// Completes the sentence "must be …".
    const TEXT: &'static str;
    /// Whether an SI value is admitted. Only finite values are ever asked about.
    fn admits(si: f64) -> bool;
}

macro_rules! bounds {
    ($($(#[$doc:meta])* $name:ident: $text:literal, $test:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub enum $name {}
        impl Bound for $name {
            const TEXT: &'static str = $text;
            fn admits(si: f64) -> bool { let f: fn(f64) -> bool = $test; f(si) }
        }
    )*
        /// The bounds of this module: the text of each and its test.
        const ALL_BOUNDS: &[(&str, fn(f64) -> bool)] = &[$(($text, <$name as Bound>::admits)),*];
    };
}
bounds! {
    /// Any finite value.
    Any: "finite", |_| true;
    /// Strictly greater than zero.
    Positive: "greater than zero", |v| v > 0.0;
    /// Zero or greater.
    NonNegative: "zero or greater", |v| v >= 0.0;
    /// From 0 to 1.
    Fraction: "between 0 and 1", |v| (0.0..=1.0).contains(&v);
}

macro_rules! dimensions {
    ($($(#[$doc:meta])* $name:ident, $alias:ident, $pos:ident, $text:literal, $most:expr, [$(($unit:literal, $factor:expr, $offset:expr)),* $(,)?];)*) => {
        /// Marker types of the dimensions.
        pub mod dim {
            use super::{Dimension, PI, Unit};
            $(
                $(#[$doc])*
                #[derive(Debug, Clone, Copy)]
                pub enum $name {}
                impl Dimension for $name {
                    const NAME: &'static str = $text;
                    const MOST: f64 = $most;
                    const UNITS: &'static [Unit] = &[$(Unit { name: $unit, factor: $factor, offset: $offset }),*];
                }
            )*
        }
        $(
            $(#[$doc])*
            pub type $alias<B = Any> = Quantity<dim::$name, B>;
            $(#[$doc])*
            ///
            /// Strictly positive.
            pub type $pos = Quantity<dim::$name, Positive>;
        )*
        /// Every dimension with its units, for documentation: (name, units, largest value).
        pub const ALL_DIMENSIONS: &[(&str, &[Unit], f64)] = &[$((dim::$name::NAME, dim::$name::UNITS, dim::$name::MOST)),*];
    };
}
const PI: f64 = std::f64::consts::PI;
dimensions! {
    /// Length \[m\].
    Length, Length, PosLength, "a length", 1e6, [("m", 1.0, 0.0), ("cm", 1e-2, 0.0), ("mm", 1e-3, 0.0), ("um", 1e-6, 0.0), ("µm", 1e-6, 0.0), ("nm", 1e-9, 0.0), ("in", 0.0254, 0.0)];
    /// Area \[m²\].
    Area, Area, PosArea, "an area", 1e12, [("m2", 1.0, 0.0), ("cm2", 1e-4, 0.0), ("mm2", 1e-6, 0.0)];
    /// Volume \[m³\].
    Volume, Volume, PosVolume, "a volume", 1e12, [("m3", 1.0, 0.0), ("l", 1e-3, 0.0), ("cm3", 1e-6, 0.0), ("mm3", 1e-9, 0.0)];
    /// Mass \[kg\].
    Mass, Mass, PosMass, "a mass", 1e12, [("kg", 1.0, 0.0), ("g", 1e-3, 0.0), ("mg", 1e-6, 0.0)];
    /// Moment of inertia \[kg m²\].
    Inertia, Inertia, PosInertia, "a moment of inertia", 1e15, [("kg m2", 1.0, 0.0), ("kg cm2", 1e-4, 0.0), ("kg mm2", 1e-6, 0.0), ("g mm2", 1e-9, 0.0)];
    /// Density \[kg/m³\].
    Density, Density, PosDensity, "a density", 1e9, [("kg/m3", 1.0, 0.0), ("g/cm3", 1e3, 0.0), ("g/mm3", 1e6, 0.0)];
    /// Force \[N\].
    Force, Force, PosForce, "a force", 1e15, [("N", 1.0, 0.0), ("kN", 1e3, 0.0), ("kgf", 9.80665, 0.0)];
    /// Pressure \[Pa\], absolute unless the key says otherwise.
    Pressure, Pressure, PosPressure, "a pressure", 1e18, [("Pa", 1.0, 0.0), ("kPa", 1e3, 0.0), ("MPa", 1e6, 0.0), ("GPa", 1e9, 0.0), ("bar", 1e5, 0.0), ("mbar", 1e2, 0.0), ("atm", 101_325.0, 0.0), ("psi", 6_894.757_293_168, 0.0), ("kgf/mm2", 9_806_650.0, 0.0), ("kgf/cm2", 98_066.5, 0.0)];
    /// Temperature \[K\].
    Temperature, Temperature, PosTemperature, "a temperature", 1e6, [("K", 1.0, 0.0), ("degC", 1.0, 273.15), ("°C", 1.0, 273.15)];
    /// Angular speed \[rad/s\].
    AngularSpeed, AngularSpeed, PosAngularSpeed, "a rotational speed", 1e6, [("rad/s", 1.0, 0.0), ("rpm", PI / 30.0, 0.0), ("1/min", PI / 30.0, 0.0), ("rev/s", 2.0 * PI, 0.0)];
    /// Angle \[rad\].
    Angle, Angle, PosAngle, "an angle", 1e6, [("rad", 1.0, 0.0), ("deg", PI / 180.0, 0.0)];
    /// Time \[s\].
    Time, Time, PosTime, "a time", 1e12, [("s", 1.0, 0.0), ("ms", 1e-3, 0.0), ("us", 1e-6, 0.0)];
    /// Velocity \[m/s\].
    Velocity, Velocity, PosVelocity, "a velocity", 1e7, [("m/s", 1.0, 0.0), ("cm/s", 1e-2, 0.0), ("mm/s", 1e-3, 0.0)];
    /// Dynamic viscosity \[Pa s\].
    Viscosity, Viscosity, PosViscosity, "a dynamic viscosity", 1e9, [("Pa s", 1.0, 0.0), ("mPa s", 1e-3, 0.0), ("cP", 1e-3, 0.0)];
    /// Energy \[J\].
    Energy, Energy, PosEnergy, "an energy", 1e15, [("J", 1.0, 0.0), ("kJ", 1e3, 0.0)];
    /// Specific gas constant \[J/(kg K)\].
    GasConstant, GasConstant, PosGasConstant, "a specific gas constant", 1e9, [("J/(kg K)", 1.0, 0.0), ("kJ/(kg K)", 1e3, 0.0)];
    /// Coefficient of thermal expansion \[1/K\].
    Expansion, Expansion, PosExpansion, "a thermal expansion coefficient", 1e3, [("1/K", 1.0, 0.0)];
    /// Stiffness \[N/m\].
    Stiffness, Stiffness, PosStiffness, "a stiffness", 1e21, [("N/m", 1.0, 0.0), ("N/mm", 1e3, 0.0), ("N/um", 1e6, 0.0)];
    /// Force per area and velocity \[N s/m³\].
    AreaDamping, AreaDamping, PosAreaDamping, "a damping per area", 1e24, [("N s/m3", 1.0, 0.0), ("N/(m2 m/s)", 1.0, 0.0)];
    /// Pressure per approach \[N/m³\].
    AreaStiffness, AreaStiffness, PosAreaStiffness, "a stiffness per area", 1e27, [("N/m3", 1.0, 0.0), ("Pa/m", 1.0, 0.0), ("MPa/um", 1e12, 0.0)];
    /// Surface density \[1/m²\].
    SurfaceDensity, SurfaceDensity, PosSurfaceDensity, "a surface density", 1e24, [("1/m2", 1.0, 0.0), ("1/mm2", 1e6, 0.0)];
    /// Relative change per pressure \[1/Pa\].
    PressureCoefficient, PressureCoefficient, PosPressureCoefficient, "a pressure coefficient", 1e3, [("1/Pa", 1.0, 0.0), ("1/MPa", 1e-6, 0.0), ("1/GPa", 1e-9, 0.0)];
    /// Shear rate \[1/s\].
    ShearRate, ShearRate, PosShearRate, "a shear rate", 1e18, [("1/s", 1.0, 0.0)];
    /// Torque \[N m\].
    Torque, Torque, PosTorque, "a torque", 1e15, [("N m", 1.0, 0.0), ("kN m", 1e3, 0.0), ("MN m", 1e6, 0.0)];
    /// Torsional stiffness \[N m/rad\].
    TorsionalStiffness, TorsionalStiffness, PosTorsionalStiffness, "a torsional stiffness", 1e21, [("N m/rad", 1.0, 0.0), ("kN m/rad", 1e3, 0.0), ("MN m/rad", 1e6, 0.0)];
    /// Torsional damping \[N m s/rad\].
    TorsionalDamping, TorsionalDamping, PosTorsionalDamping, "a torsional damping", 1e18, [("N m s/rad", 1.0, 0.0), ("kN m s/rad", 1e3, 0.0)];
    /// Frequency \[Hz\].
    Frequency, Frequency, PosFrequency, "a frequency", 1e9, [("Hz", 1.0, 0.0), ("cpm", 1.0 / 60.0, 0.0)];
    /// Power \[W\].
    Power, Power, PosPower, "a power", 1e15, [("W", 1.0, 0.0), ("kW", 1e3, 0.0), ("MW", 1e6, 0.0)];
    /// Dimensionless number.
    Ratio, Ratio, PosRatio, "a number", 1e30, [("", 1.0, 0.0), ("%", 1e-2, 0.0)];
}

/// An SI value of dimension `D` that satisfies `B`.
///
/// Reads from a bare number (SI) or from text with a unit; writes text with the SI unit, which reads back to the same bits.
pub struct Quantity<D, B = Any> {
    si: f64,
    marker: PhantomData<fn() -> (D, B)>,
}

/// Why a value is not a [`Quantity`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantityError {
    /// No number at the front of the text.
    #[error("`{text}` does not start with a number; write {dimension} like `{example}`")]
    NotANumber {
        /// What was written.
        text: String,
        /// The dimension wanted.
        dimension: &'static str,
        /// A well-formed example.
        example: String,
    },
    /// The unit belongs to another dimension or does not exist.
    #[error("unit `{unit}` is not {dimension}, expected one of {known}")]
    Unit {
        /// What was written.
        unit: String,
        /// The dimension wanted.
        dimension: &'static str,
        /// The units that would do.
        known: String,
    },
    /// A decimal comma, or a minus sign of typography.
    #[error("`{text}` is not a number with a unit; write `{instead}`")]
    Spelling {
        /// What was written.
        text: String,
        /// The same as it would be read.
        instead: String,
    },
    /// Larger than anything of its dimension in a machine.
    #[error("`{text}` is beyond any machine: {dimension} is at most {most:e}{unit}")]
    TooLarge {
        /// What was written.
        text: String,
        /// The dimension wanted.
        dimension: &'static str,
        /// Largest magnitude in SI.
        most: f64,
        /// The SI unit, with a space before it; nothing of a number.
        unit: String,
    },
    /// Not finite, or outside the admitted range.
    #[error("`{text}` must be {bound}")]
    Range {
        /// What was written.
        text: String,
        /// What it must be.
        bound: &'static str,
    },
}

/// The SI value that `text` states in one of `units`; where it would do with a decimal point, that is what is told.
fn read(text: &str, dimension: &'static str, units: &'static [Unit]) -> Result<f64, QuantityError> {
    read_as_written(text, dimension, units).map_err(|e| match with_decimal_point(text) {
        Some(instead) if read_as_written(&instead, dimension, units).is_ok() => {
            QuantityError::Spelling { text: text.to_owned(), instead }
        }
        _ => e,
    })
}

fn read_as_written(
    text: &str,
    dimension: &'static str,
    units: &'static [Unit],
) -> Result<f64, QuantityError> {
    let t = text.trim();
    // The longest prefix that is a number; "1e3" must not be read as "1" with the unit "e3". No number of a case has more
    // characters than this; without a limit a megabyte of digits would take hours to refuse.
    const NUMBER: usize = 64;
    let number = (0..=t.len().min(NUMBER))
        .rev()
        .filter(|&i| t.is_char_boundary(i))
        .find_map(|i| t[..i].trim_end().parse::<f64>().ok().map(|v| (v, t[i..].trim())));
    let Some((value, unit)) = number else {
        let u = units.get(2).or(units.first()).map_or("", |u| u.name);
        return Err(QuantityError::NotANumber {
            text: text.to_owned(),
            dimension,
            example: format!("1.5 {u}").trim_end().to_owned(),
        });
    };
    let found = if unit.is_empty() { units.first() } else { units.iter().find(|u| u.is(unit)) };
    let Some(u) = found else {
        return Err(QuantityError::Unit {
            unit: unit.to_owned(),
            dimension,
            known: units
                .iter()
                .filter(|u| !u.name.is_empty())
                .map(|u| format!("`{}`", u.name))
                .collect::<Vec<_>>()
                .join(", "),
        });
    };
    Ok(value * u.factor + u.offset)
}

/// What is wrong with a value of the dimension and bound that a JSON schema names by its keys `x-dimension` and
/// `x-bound`: `number` when it stands there as a bare number, otherwise `text`. Nothing is wrong with a dimension that is
/// not one of [`ALL_DIMENSIONS`], which only its own type can judge.
///
/// # Errors
/// As [`Quantity::parse`] and [`Quantity::new`].
pub fn check(dimension: &str, bound: &str, text: &str, number: Option<f64>) -> Result<(), QuantityError> {
    let Some(&(name, units, most)) = ALL_DIMENSIONS.iter().find(|(name, ..)| *name == dimension) else {
        return Ok(());
    };
    let (bound, admits) =
        ALL_BOUNDS.iter().find(|(t, _)| *t == bound).copied().unwrap_or((Any::TEXT, <Any as Bound>::admits));
    let wanted = Wanted { name, units, most, bound, admits };
    let si = number.map_or_else(|| read(text, name, units), Ok)?;
    wanted.admit(si, || text.to_owned()).map(|_| ())
}

impl<D: Dimension, B: Bound> Quantity<D, B> {
    /// From an SI value.
    ///
    /// # Errors
    /// [`QuantityError::Range`] when the value is not finite or not admitted by `B`.
    pub fn new(si: f64) -> Result<Self, QuantityError> {
        Wanted::of::<D, B>().number(si).map(|si| Self { si, marker: PhantomData })
    }

    /// From text with a unit, `"120 mm"`. A number without a unit is SI.
    ///
    /// # Errors
    /// Says which part of the text is wrong and what would be right.
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        Wanted::of::<D, B>().text(text).map(|si| Self { si, marker: PhantomData })
    }

    /// The value in SI units.
    #[must_use]
    pub const fn si(self) -> f64 {
        self.si
    }
}

/// Shorthand for a value that stands in the source code and is known to be admitted.
///
/// # Panics
/// When it is not, which a test of the default catches.
pub fn quantity<D: Dimension, B: Bound>(si: f64) -> Quantity<D, B> {
    match Quantity::new(si) {
        Ok(q) => q,
        Err(e) => panic!("built-in value: {e}"),
    }
}

impl<D, B> Clone for Quantity<D, B> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<D, B> Copy for Quantity<D, B> {}
impl<D, B> PartialEq for Quantity<D, B> {
    fn eq(&self, other: &Self) -> bool {
        self.si == other.si
    }
}
impl<D: Dimension, B> fmt::Debug for Quantity<D, B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
impl<D: Dimension, B> fmt::Display for Quantity<D, B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = D::UNITS[0].name;
        let (v, space) = (self.si, if unit.is_empty() { "" } else { " " });
        if v != 0.0 && (v.abs() < 1e-4 || v.abs() >= 1e7) {
            write!(f, "{v:e}{space}{unit}")
        } else {
            write!(f, "{v}{space}{unit}")
        }
    }
}

impl<D: Dimension, B: Bound> Serialize for Quantity<D, B> {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        if D::UNITS[0].name.is_empty() { s.serialize_f64(self.si) } else { s.collect_str(self) }
    }
}

/// A dimension and a bound as values: what reads any quantity is compiled once for a format, not once for every pair of types.
struct Wanted {
    name: &'static str,
    units: &'static [Unit],
    most: f64,
    bound: &'static str,
    admits: fn(f64) -> bool,
}

impl Wanted {
    const fn of<D: Dimension, B: Bound>() -> Self {
        Self { name: D::NAME, units: D::UNITS, most: D::MOST, bound: B::TEXT, admits: B::admits }
    }

    /// An SI value that may stand here; `text` is what was written.
    fn admit(&self, si: f64, text: impl Fn() -> String) -> Result<f64, QuantityError> {
        if !si.is_finite() {
            return Err(QuantityError::Range { text: text(), bound: "finite" });
        }
        if !(self.admits)(si) {
            return Err(QuantityError::Range { text: text(), bound: self.bound });
        }
        if si.abs() > self.most {
            let unit = self.units[0].name;
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            return Err(QuantityError::TooLarge {
                text: text(),
                dimension: self.name,
                most: self.most,
                unit,
            });
        }
        Ok(si)
    }

    /// See [`Quantity::new`].
    fn number(&self, si: f64) -> Result<f64, QuantityError> {
        self.admit(si, || format!("{si} {}", self.units[0].name).trim_end().to_owned())
    }

    /// See [`Quantity::parse`].
    fn text(&self, text: &str) -> Result<f64, QuantityError> {
        self.admit(read(text, self.name, self.units)?, || text.to_owned())
    }

    fn schema(&self) -> schemars::Schema {
        let units = self.units.iter().map(|u| u.name).filter(|n| !n.is_empty());
        // Values as they are: `json_schema!` would write each of them out and read it again. All at once, for which room is made once.
        let mut schema = schemars::Schema::default();
        schema.ensure_object().extend([
            ("description".into(), [self.name, ", ", self.bound].concat().into()),
            ("type".into(), ["number", "string"].into_iter().collect()),
            ("x-units".into(), units.collect()),
            ("x-dimension".into(), self.name.into()),
            ("x-bound".into(), self.bound.into()),
        ]);
        schema
    }
}

impl Visitor<'_> for Wanted {
    type Value = f64;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let u = self.units[0].name;
        if u.is_empty() {
            write!(f, "{}", self.name)
        } else {
            write!(f, "{} (a number in {u}, or text with a unit)", self.name)
        }
    }
    fn visit_f64<E: de::Error>(self, v: f64) -> Result<f64, E> {
        self.number(v).map_err(E::custom)
    }
    fn visit_i64<E: de::Error>(self, v: i64) -> Result<f64, E> {
        self.number(v as f64).map_err(E::custom)
    }
    fn visit_u64<E: de::Error>(self, v: u64) -> Result<f64, E> {
        self.number(v as f64).map_err(E::custom)
    }
    fn visit_str<E: de::Error>(self, v: &str) -> Result<f64, E> {
        self.text(v).map_err(E::custom)
    }
}

impl<'de, D: Dimension, B: Bound> Deserialize<'de> for Quantity<D, B> {
    fn deserialize<T: Deserializer<'de>>(d: T) -> Result<Self, T::Error> {
        let si = d.deserialize_any(Wanted::of::<D, B>())?;
        Ok(Self { si, marker: PhantomData })
    }
}

impl<D: Dimension, B: Bound> schemars::JsonSchema for Quantity<D, B> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("{} ({})", D::NAME, B::TEXT).into()
    }
    fn schema_id() -> Cow<'static, str> {
        // Asked for at every field: no text is made for it.
        std::any::type_name::<Self>().into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Wanted::of::<D, B>().schema()
    }
}
