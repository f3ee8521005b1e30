//! Motion in the groove.

pub mod groove_flank;
pub mod hold;
pub mod newton_groove;
pub mod seated;
pub mod three_seat;
