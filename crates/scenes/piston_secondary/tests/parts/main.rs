//! Parts of the scene by themselves, and a lateral motion from outside.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod own_motion;
mod peak_width;
mod places;
mod spectrum;
mod stages;
mod trajectory;
