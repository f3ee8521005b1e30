//! Every check passes what is right and complains about what is wrong.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod contract;
mod gas;
mod numbers;
mod running;
mod states;
