//! Five plug-ins outside of Gudgeon, one file each: listed, described, read from case files, validated with places, run, compared and recorded
//! like built-in ones.
//!
//! | file | what it adds | how |
//! |---|---|---|
//! | `bernoulli_network.rs` | a gas law | [`gudgeon_gas::PassageLaw`] on the skeleton of a gas model |
//! | `lift_and_twist.rs` | a ring motion with four states | [`gudgeon_core::states::Stateful`] |
//! | `heat_balance.rs` | a film temperature with a state a ring | the same |
//! | `euler_march.rs` | a solver of the ring pack | [`gudgeon_scene_ring_pack::solver::RingPackSolverSpec`] |
//! | `inertia_force.rs` | a scene | [`gudgeon_scene::SceneCase`] |

pub mod bernoulli_network;
pub mod euler_march;
pub mod heat_balance;
pub mod inertia_force;
pub mod lift_and_twist;

gudgeon_core::link!(
    bernoulli_network::BernoulliNetwork,
    euler_march::EulerMarch,
    heat_balance::HeatBalance,
    inertia_force::InertiaForceCase,
    lift_and_twist::LiftAndTwist,
);
