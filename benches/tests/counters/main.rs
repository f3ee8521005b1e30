//! Counters: that a run counts the same every time and on any number of threads, what a comparison tells, and that every kind and every
//! scene takes part in benches.

mod compare;
mod suites;
