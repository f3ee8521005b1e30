//! Piston skirt: geometry, films and contact of both sides, compliance, and the balance of forces across the bore.

mod body;
mod geometry;
mod groove_friction;
mod pin_friction;
mod piston;
mod secondary_motion;
mod side;
mod skirt_compliance;
mod skirt_profile;

pub use body::{Body, Crank, Instant, Rod};
pub use geometry::Panel;
pub use groove_friction::{Coulomb as GrooveCoulomb, Off as NoGrooveFriction};
pub use pin_friction::{Coulomb as PinCoulomb, Off as NoPinFriction};
pub use piston::{Piston, Summary};
pub use secondary_motion::{FullInertia, Held, QuasiStatic};
pub use side::{ContactGrid, Side, SideLoads, SideSetup, Slopes};
pub use skirt_compliance::{InfluenceMatrix, Modal, Rigid, Shape};
pub use skirt_profile::{Barrel, Cylindrical, Table};
