use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::vogel::VogelOil;

/// The Vogel equation with the published constants of an oil grade: `μ = a exp(b / (T_C + c))`.
///
/// | table | grade | a \[Pa s\] | b \[K\] | c \[K\] |
/// |---|---|---|---|---|
/// | `zottin1992` | `sae_10w10` | 0.0850e-8 · 9.80665e4 | 820.723 | 93.625 |
/// | `zottin1992` | `sae_10w20` | 0.1034e-8 · 9.80665e4 | 773.810 | 93.153 |
/// | `zottin1992` | `sae_10w30` | 0.2020e-8 · 9.80665e4 | 737.690 | 89.9 |
/// | `zottin1992` | `sae_10w40` | 0.1165e-8 · 9.80665e4 | 1033.340 | 120.8 |
/// | `zottin1992` | `sae_10w50` | 0.0952e-8 · 9.80665e4 | 1304.170 | 155.22 |
/// | `zottin1992` | `sae_20w20` | 0.1350e-8 · 9.80665e4 | 737.810 | 77.7 |
/// | `zottin1992` | `sae_20w30` | 0.1441e-8 · 9.80665e4 | 811.962 | 93.458 |
/// | `zottin1992` | `sae_20w40` | 0.1671e-8 · 9.80665e4 | 793.329 | 83.931 |
/// | `zottin1992` | `sae_20w50` | 0.0948e-8 · 9.80665e4 | 1146.25 | 124.7 |
/// | `zottin1992` | `sae_30` | 0.1531e-8 · 9.80665e4 | 720.015 | 71.123 |
/// | `tomanik1993` | `sae_5w` | 5.54e-5 | 900 | 110.8 |
/// | `tomanik1993` | `sae_10w` | 4.08e-5 | 1066 | 116.5 |
/// | `tomanik1993` | `sae_15w` | 6.68e-5 | 902 | 100.2 |
/// | `tomanik1993` | `sae_20w` | 2.37e-5 | 1361 | 123.3 |
/// | `tomanik1993` | `sae_20` | 4.99e-5 | 1028 | 108.0 |
/// | `tomanik1993` | `sae_30` | 2.37e-5 | 1361 | 123.3 |
/// | `tomanik1993` | `sae_40` | 2.37e-5 | 1396 | 121.7 |
/// | `tomanik1993` | `sae_50` | 1.96e-5 | 1518 | 122.6 |
///
/// The constants of `zottin1992` are those of the program listing, where `a` stands in kp s/cm²; the rounded ones of its
/// annex give viscosities within 0.05 %, and within 0.11 % for `sae_20w40`. In `tomanik1993` the rows `sae_20w` and `sae_30` are identical, so one of them is
/// probably misprinted; both are kept as printed.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VogelGrade {
    /// Where the constants were published.
    pub table: VogelTable,
    /// Grade of the oil.
    pub grade: Grade,
}

/// A published table of Vogel constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum VogelTable {
    /// Zottin 1992, program listing: ten oils, multigrades among them.
    Zottin1992,
    /// Tomanik 1993: eight monogrades.
    Tomanik1993,
}

impl VogelTable {
    const fn name(self) -> &'static str {
        match self {
            Self::Zottin1992 => "zottin1992",
            Self::Tomanik1993 => "tomanik1993",
        }
    }

    /// Every row: grade, a \[Pa s\], b \[K\], c \[K\].
    fn rows(self) -> &'static [(Grade, f64, f64, f64)] {
        /// 1 kp s/cm² \[Pa s\].
        const KP_S_CM2: f64 = 9.80665e4;
        const ZOTTIN: &[(Grade, f64, f64, f64)] = &[
            (Grade::Sae10w10, 0.0850e-8 * KP_S_CM2, 820.723, 93.625),
            (Grade::Sae10w20, 0.1034e-8 * KP_S_CM2, 773.810, 93.153),
            (Grade::Sae10w30, 0.2020e-8 * KP_S_CM2, 737.690, 89.9),
            (Grade::Sae10w40, 0.1165e-8 * KP_S_CM2, 1033.340, 120.8),
            (Grade::Sae10w50, 0.0952e-8 * KP_S_CM2, 1304.170, 155.22),
            (Grade::Sae20w20, 0.1350e-8 * KP_S_CM2, 737.810, 77.7),
            (Grade::Sae20w30, 0.1441e-8 * KP_S_CM2, 811.962, 93.458),
            (Grade::Sae20w40, 0.1671e-8 * KP_S_CM2, 793.329, 83.931),
            (Grade::Sae20w50, 0.0948e-8 * KP_S_CM2, 1146.25, 124.7),
            (Grade::Sae30, 0.1531e-8 * KP_S_CM2, 720.015, 71.123),
        ];
        const TOMANIK: &[(Grade, f64, f64, f64)] = &[
            (Grade::Sae5w, 5.54e-5, 900.0, 110.8),
            (Grade::Sae10w, 4.08e-5, 1066.0, 116.5),
            (Grade::Sae15w, 6.68e-5, 902.0, 100.2),
            (Grade::Sae20w, 2.37e-5, 1361.0, 123.3),
            (Grade::Sae20, 4.99e-5, 1028.0, 108.0),
            (Grade::Sae30, 2.37e-5, 1361.0, 123.3),
            (Grade::Sae40, 2.37e-5, 1396.0, 121.7),
            (Grade::Sae50, 1.96e-5, 1518.0, 122.6),
        ];
        match self {
            Self::Zottin1992 => ZOTTIN,
            Self::Tomanik1993 => TOMANIK,
        }
    }

    /// The grades of this table.
    pub fn grades(self) -> impl Iterator<Item = Grade> {
        self.rows().iter().map(|r| r.0)
    }
}

macro_rules! grades {
    ($($(#[$doc:meta])* $variant:ident = $name:literal),* $(,)?) => {
        /// Grade of an oil, as the tables name it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
        #[non_exhaustive]
        pub enum Grade {
            $($(#[$doc])* #[serde(rename = $name)] $variant),*
        }

        impl Grade {
            /// The word that stands for it in a case file.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),* }
            }
        }
    };
}
grades! {
    /// SAE 5W.
    Sae5w = "sae_5w",
    /// SAE 10W.
    Sae10w = "sae_10w",
    /// SAE 15W.
    Sae15w = "sae_15w",
    /// SAE 20W.
    Sae20w = "sae_20w",
    /// SAE 20.
    Sae20 = "sae_20",
    /// SAE 30.
    Sae30 = "sae_30",
    /// SAE 40.
    Sae40 = "sae_40",
    /// SAE 50.
    Sae50 = "sae_50",
    /// 10W/10.
    Sae10w10 = "sae_10w10",
    /// 10W/20.
    Sae10w20 = "sae_10w20",
    /// 10W/30.
    Sae10w30 = "sae_10w30",
    /// 10W/40.
    Sae10w40 = "sae_10w40",
    /// 10W/50.
    Sae10w50 = "sae_10w50",
    /// 20W/20.
    Sae20w20 = "sae_20w20",
    /// 20W/30.
    Sae20w30 = "sae_20w30",
    /// 20W/40.
    Sae20w40 = "sae_20w40",
    /// 20W/50.
    Sae20w50 = "sae_20w50",
}

#[register_model(
    name = "vogel_grade",
    summary = "Vogel equation with the published constants of an oil grade",
    equations = "mu = a exp(b / (T_C + c)),  T_C = T - 273.15 K",
    validity = "About 40 to 150 degC, at low shear rate and ambient pressure: no shear thinning, no rise with pressure.",
    references = ["vogel1921", "cameron1966", "zottin1992", "tomanik1993"],
    example = "table = \"zottin1992\"\ngrade = \"sae_30\"\n",
)]
impl OilSpec for VogelGrade {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        let Some(&(_, a, b, c)) = self.table.rows().iter().find(|r| r.0 == self.grade) else {
            let known: Vec<_> = self.table.grades().map(|g| format!("`{}`", g.name())).collect();
            return Err(BuildError::at(
                "grade",
                format!("the table `{}` has no grade `{}`", self.table.name(), self.grade.name()),
            )
            .help(format!("its grades are {}", known.join(", "))));
        };
        Ok(Box::new(VogelOil::new(a, b, c)?))
    }
}
