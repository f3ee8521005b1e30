//! Where the oil of the skirt comes from.

mod fill_history;
mod off;

pub use fill_history::FillHistory;
pub use off::Off;
