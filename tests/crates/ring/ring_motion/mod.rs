//! Motion in the groove.

mod groove_states;
mod hold;
mod newton_groove;
mod seated;
mod three_seat;
