//! Parts of the ring pack by themselves.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod acted;
mod contact_line;
mod limits;
mod liner_wear;
