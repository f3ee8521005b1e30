//! Friction of a twin-land ring.

mod both_lands;
mod lower_twice;
pub use both_lands::BothLands;
pub use lower_twice::LowerTwice;
