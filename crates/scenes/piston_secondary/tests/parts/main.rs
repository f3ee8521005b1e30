//! Parts of the scene by themselves, and a lateral motion from outside.

mod own_motion;
mod peak_width;
mod places;
mod stages;
mod trajectory;
