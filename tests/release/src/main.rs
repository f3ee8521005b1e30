//! `gudgeon-release check` looks, `check --final` also asks for what a maintainer does in the course of a release, `order` lists the packages.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::path::PathBuf;
use std::process::ExitCode;

use gudgeon_release::{cargo, check, order, packages};

const USAGE: &str = "gudgeon-release check [--final] | order";

fn main() -> ExitCode {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["check"] => look(&root, false),
        ["check", "--final"] => look(&root, true),
        ["order"] => list(&root),
        _ => Err(USAGE.to_owned()),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::from(2)
        }
    }
}

fn look(root: &std::path::Path, last: bool) -> Result<bool, String> {
    let found = check(root)?;
    found.wrong.iter().for_each(|w| eprintln!("wrong: {w}"));
    found.left.iter().for_each(|l| eprintln!("left to do: {l}"));
    let ready = found.wrong.is_empty() && (found.left.is_empty() || !last);
    println!("{} wrong, {} left to do before a release", found.wrong.len(), found.left.len());
    Ok(ready)
}

fn list(root: &std::path::Path) -> Result<bool, String> {
    let all = packages(&cargo(root, &["metadata", "--no-deps", "--format-version", "1"])?)?;
    for p in order(&all).map_err(|c| c.to_string())? {
        println!("{}", p.name);
    }
    Ok(true)
}
