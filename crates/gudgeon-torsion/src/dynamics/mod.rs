//! Equations of motion over time: what the models that integrate share.

mod groups;
mod links;
mod motion;
mod newton;
mod record;

pub(crate) use motion::Dynamics;
pub(crate) use record::record;
