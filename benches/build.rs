//! What compiled the counters: a count of instructions is compared with one of the same compiler and settings only.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let var = |name: &str| std::env::var(name).unwrap_or_default();
    let rustc = Command::new(var("RUSTC")).arg("--version").output();
    let version = rustc.map(|o| String::from_utf8_lossy(&o.stdout).into_owned()).unwrap_or_default();
    // "rustc 1.95.0 (59807616e 2026-04-14)": the number says all.
    let version = version.split_whitespace().nth(1).unwrap_or("unknown").to_owned();
    println!("cargo::rustc-env=GUDGEON_COMPILER=rustc {version}, opt-level {}", var("OPT_LEVEL"));
    println!("cargo::rustc-env=GUDGEON_PLATFORM={}", var("TARGET"));
}
