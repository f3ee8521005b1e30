//! Parts of the ring pack by themselves.

mod acted;
mod contact_line;
mod limits;
