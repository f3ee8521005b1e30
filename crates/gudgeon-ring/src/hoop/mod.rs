//! Force of a ring by its own tension.

mod as_printed;
mod correct;
pub use as_printed::AsPrinted;
pub use correct::Correct;
