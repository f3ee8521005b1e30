//! Every check passes what is right and complains about what is wrong.

mod contract;
mod gas;
mod numbers;
mod running;
mod states;
