//! Shapes of the skirt.

mod barrel;
mod cylindrical;
mod table;

pub use barrel::Barrel;
pub use cylindrical::Cylindrical;
pub use table::Table;
