//! The cases that the playground offers, as Rust source, and the revision of the checkout for the record of its runs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

const CASES: &str = "../../cases";

fn main() {
    let git = |args: &[&str]| {
        let out = Command::new("git").args(args).output().ok().filter(|o| o.status.success())?;
        Some(String::from_utf8_lossy(&out.stdout).trim().to_owned())
    };
    println!(
        "cargo::rustc-env=GUDGEON_REVISION={}",
        git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_default()
    );
    if let Some(log) = git(&["rev-parse", "--path-format=absolute", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={CASES}");
    println!("cargo::rerun-if-changed={CASES}/rigs");
    let mut source = String::from("&[\n");
    for folder in ["", "rigs/"] {
        for name in names(&Path::new(CASES).join(folder)) {
            let path = std::env::current_dir().expect("a folder").join(CASES).join(folder).join(&name);
            // Writing to a String cannot fail.
            let _ =
                writeln!(source, "    (\"{folder}{name}\", include_str!({:?})),", path.display().to_string());
        }
    }
    source.push_str("]\n");
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    std::fs::write(out.join("cases.rs"), source).expect("the build folder can be written");
}

/// Case files of a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the cases of the repository");
    let mut all: Vec<String> = entries
        .filter_map(|e| e.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    all.sort();
    all
}
