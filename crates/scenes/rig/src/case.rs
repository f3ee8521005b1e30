//! What a case of the scene `rig` may say.

use gudgeon_core::kinds::RigSpec;

use gudgeon_scene::case_file;

case_file! {
    /// One sub-model under prescribed conditions.
    pub struct RigCase {
        /// The bench: `model` names it, its other keys are the sub-model and the conditions.
        pub rig: Box<dyn RigSpec>,
    }
}
