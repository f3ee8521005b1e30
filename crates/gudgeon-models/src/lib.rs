//! Links every built-in model crate.
//!
//! A crate that no code names is never given to the linker, and its models would be missing without a word. Programs,
//! tests and benches call [`link`] or name this crate (`use gudgeon_models as _;`, enough but for WebAssembly), and this crate names the rest.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
// Not for its unit tests, which see the dependencies of the integration tests too.
#![cfg_attr(not(any(test, doctest)), deny(unused_crate_dependencies))]

use std::fmt::Write;

use gudgeon_core::Registry;

/// The `link` of a crate.
type Link = fn() -> usize;

/// The `link` of every built-in crate that registers something, with the name of the crate.
const CRATES: &[(&str, Link)] = &[
    ("gudgeon_contact", gudgeon_contact::link),
    ("gudgeon_film", gudgeon_film::link),
    ("gudgeon_gas", gudgeon_gas::link),
    ("gudgeon_kinematics", gudgeon_kinematics::link),
    ("gudgeon_pin", gudgeon_pin::link),
    ("gudgeon_ring", gudgeon_ring::link),
    ("gudgeon_scene_pin", gudgeon_scene_pin::link),
    ("gudgeon_scene_piston_secondary", gudgeon_scene_piston_secondary::link),
    ("gudgeon_scene_power_cylinder", gudgeon_scene_power_cylinder::link),
    ("gudgeon_scene_rig", gudgeon_scene_rig::link),
    ("gudgeon_scene_ring_pack", gudgeon_scene_ring_pack::link),
    ("gudgeon_scene_shaft_line", gudgeon_scene_shaft_line::link),
    ("gudgeon_skirt", gudgeon_skirt::link),
    ("gudgeon_torsion", gudgeon_torsion::link),
];

/// Makes the linker keep every built-in model and scene, on every target, and gives their number. Calling it once,
/// anywhere in a program, is enough. What WebAssembly needs besides stands at [`gudgeon_core::link!`].
pub fn link() -> usize {
    CRATES.iter().map(|(_, link)| link()).sum()
}

/// How many models and scenes each built-in crate says it registers: its name, as in paths, and what its own `link` gives.
pub fn linked() -> impl Iterator<Item = (&'static str, usize)> {
    CRATES.iter().map(|(name, link)| (*name, link()))
}

/// Everything registered in this program as text, one line each with the crate it comes from: kinds with their models, then scenes.
/// Equal on all targets for a program with the same crates.
#[must_use]
pub fn registered() -> String {
    let mut text = Registry::collect().to_string();
    text.push_str("scenes\n");
    for scene in gudgeon_scene::scenes() {
        let _ = writeln!(text, "    {} ({})", scene.name, scene.crate_name());
    }
    text
}
