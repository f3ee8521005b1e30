//! The part of a case that is the same for every scene.

use crate::sweep_input::Sweep;

/// What every case may say besides its physics.
#[derive(Debug, Clone, Copy, Default)]
pub struct Heading<'a> {
    /// Name of its scene.
    pub scene: &'a str,
    /// One line for reports.
    pub title: &'a str,
    /// Where the case comes from.
    pub source: &'a str,
    /// Inputs that no source gives and that were assumed.
    pub assumptions: &'a [String],
    /// Inputs that are varied.
    pub sweeps: &'a [Sweep],
}

/// The part of a case that is the same for every scene. `case_file!` implements it.
pub trait Headed {
    /// Title, source, sweeps.
    fn heading(&self) -> Heading<'_>;
}

/// The type of a case file: the keys of its scene between those that every case may say.
#[macro_export]
macro_rules! case_file {
    ($(#[$about:meta])* pub struct $name:ident { $($own:tt)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, ::serde::Serialize, ::serde::Deserialize, ::schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// What is simulated.
            pub scene: $crate::SceneName,
            /// One line for reports.
            #[serde(default)]
            pub title: String,
            /// Where the case comes from.
            #[serde(default)]
            pub source: String,
            /// Inputs that no source gives and that were assumed, one sentence each. Reports show them.
            #[serde(default)]
            pub assumptions: Vec<String>,
            $($own)*
            /// Inputs that are varied, one or two: every combination is run.
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            pub sweeps: Vec<$crate::Sweep>,
        }

        impl $crate::Headed for $name {
            fn heading(&self) -> $crate::Heading<'_> {
                $crate::Heading {
                    scene: self.scene.as_str(),
                    title: &self.title,
                    source: &self.source,
                    assumptions: &self.assumptions,
                    sweeps: &self.sweeps,
                }
            }
        }
    };
}
