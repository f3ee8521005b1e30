//! What a case of the scene `power_cylinder` may say.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gudgeon_scene::case_file;

case_file! {
    /// Rings and skirt of one cylinder, each as a case of its own, driven by the same crank and the same gas.
    ///
    /// The ring pack's case says engine speed, bore, crank, rod, piston motion and cylinder pressure; the skirt's case takes them from there,
    /// whatever its file says.
    pub struct PowerCylinderCase {
        /// The rings.
        pub ring_pack: Part,
        /// The skirt.
        pub piston_secondary: Part,
    }
}

/// A part of the cylinder.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Case file, in the folder of this case.
    pub case: String,
    /// Changes to it, as `--set` takes them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
}
