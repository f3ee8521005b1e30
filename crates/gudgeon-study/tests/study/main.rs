//! Statistics of studies against closed forms.

mod anova;
mod distribution;
mod sampling;
mod sensitivity;
mod shares;
