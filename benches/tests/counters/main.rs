//! Counters: that a run counts the same every time and on any number of threads, what a comparison tells, and that every kind and every
//! scene takes part in benches.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod compare;
mod suites;
