//! Statistics of studies against closed forms.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod anova;
mod distribution;
mod sampling;
mod sensitivity;
mod shares;
