//! Viscosity of the oil over its temperature.

mod constant;
mod table;
mod vogel;
mod vogel_grade;
mod walther;

pub use constant::Constant;
pub use table::Table;
pub use vogel::Vogel;
pub use vogel_grade::{Grade, VogelGrade, VogelTable};
pub use walther::Walther;
