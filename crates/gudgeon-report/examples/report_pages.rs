//! Writes one page of every sort from invented data: `cargo run -p gudgeon-report --example report_pages -- DIR`.

#![allow(clippy::disallowed_methods, reason = "curves to look at")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::path::PathBuf;

fn main() -> Result<(), gudgeon_report::ReportError> {
    let dir = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("report_pages"), PathBuf::from);
    gudgeon_report::write_run(&common::run(3), &dir.join("run"))?;
    gudgeon_report::write_run(&common::run(1), &dir.join("one_ring"))?;
    gudgeon_report::write_run(&common::run(5), &dir.join("five_rings"))?;
    gudgeon_report::write_comparison(&common::comparison(), &dir.join("comparison"))?;
    gudgeon_report::write_bench(&common::bench(), &dir.join("bench"))?;
    Ok(())
}
