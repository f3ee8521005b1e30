//! What benches, counters and their tests share: the cases that stand for the scenes, and every registered model alone.
//!
//! | command | shows |
//! |---|---|
//! | `cargo bench -p gudgeon-benches --bench registry` | time to read, to build and to ask every registered model ([`alone`]) |
//! | `cargo bench -p gudgeon-benches --bench scenes` | time to run one case of every scene |
//! | `cargo bench -p gudgeon-benches --bench files` | time to read, change and refuse a case, and to write a report |
//! | `cargo bench -p gudgeon-benches --bench NAME` | the other benches: time beside error of single methods |
//! | `cargo run -p gudgeon-benches --bin counters` | work of the solvers against `counters.toml` ([`measure`], [`baseline`]) |
//! | `… --bin counters -- --instructions` | instructions of a few cases, by valgrind ([`instructions`]) |
//! | `… --bin counters -- --stress` | steps of a ring pack over speed, contact stiffness and mass of the rings ([`stress`]) |
//!
//! Error beside time, where there is a reference, is what `gudgeon bench` measures: suites made from the registry show time alone.

pub mod alone;
pub mod baseline;
pub mod cases;
pub mod history;
pub mod instructions;
pub mod measure;
pub mod stress;
