//! The exact film under a ring face.
//!
//! A face ([`shape`]) is one [`parabola`] or a [`table`] of straight lines, for which all integrals of a film are known in closed form
//! ([`moments`]). A film in one sliding direction belongs to a [`side`]. Its places of rupture and reformation are found by quick
//! searches that start at the last film ([`quick`], for a crowned face [`crown`]), or by searches that always end ([`search`],
//! [`rupture`], [`reformation`], [`clip`]); what they find are stretches of full film ([`islands`]) with a [`load`] and [`forces`].

mod cavity_shear;
mod clip;
#[allow(
    missing_docs,
    reason = "public for the tests of this crate alone, which call its searches one by one"
)]
pub mod crown;
mod errors;
mod film;
mod flow;
mod forces;
mod islands;
mod load;
mod model;
pub mod moments;
pub mod parabola;
mod quick;
mod quick_at_rate;
mod quick_under_load;
mod reformation;
mod rupture;
mod ruptured;
mod search;
pub mod shape;
mod side;
mod stretch;
pub mod table;

pub use cavity_shear::CavityShear;
pub use model::ClosedFormFace;
