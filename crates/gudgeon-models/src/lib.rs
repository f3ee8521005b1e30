//! Links every built-in model crate.
//!
//! A crate that no code names is never given to the linker, and its models would be missing without a word. Programs,
//! tests and benches name this crate (`use gudgeon_models as _;`), and this crate names the rest.
// Not for its unit tests, which see the dependencies of the integration tests too.
#![cfg_attr(not(test), deny(unused_crate_dependencies))]

use gudgeon_contact as _;
use gudgeon_core as _;
use gudgeon_film as _;
use gudgeon_gas as _;
use gudgeon_kinematics as _;
use gudgeon_pin as _;
use gudgeon_ring as _;
use gudgeon_scene_pin as _;
use gudgeon_scene_piston_secondary as _;
use gudgeon_scene_power_cylinder as _;
use gudgeon_scene_rig as _;
use gudgeon_scene_ring_pack as _;
use gudgeon_scene_shaft_line as _;
use gudgeon_skirt as _;
use gudgeon_torsion as _;
