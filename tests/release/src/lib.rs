//! Whether the packages of the workspace can be published, and in which order: what `cargo package` does not look at.
//!
//! `cargo publish` refuses one package after the other, and what has been published stays. So everything that can be known is known before: what the
//! index demands, what a package must hold, versions that go together, an order in which each package finds what it depends on.

mod contents;
mod metadata;
mod order;
mod texts;

pub use contents::missing_includes;
pub use metadata::{Dependency, Package, complaints, packages};
pub use order::{Cycle, order};
pub use texts::{Kept, texts};

use std::path::Path;
use std::process::Command;

/// What a check found: what is wrong, and what is left to do before a release.
#[derive(Debug, Default)]
pub struct Found {
    /// Defects: no package may be published with one.
    pub wrong: Vec<String>,
    /// What a maintainer does in the course of a release.
    pub left: Vec<String>,
}

/// Everything at once, for the workspace at `root`.
///
/// # Errors
/// Cargo does not run, or answers with something else than metadata.
pub fn check(root: &Path) -> Result<Found, String> {
    let all = packages(&cargo(root, &["metadata", "--no-deps", "--format-version", "1"])?)?;
    let mut found = Found { wrong: complaints(&all), left: Vec::new() };
    if let Err(cycle) = order(&all) {
        found.wrong.push(cycle.to_string());
    }
    for p in all.iter().filter(|p| p.published) {
        let list = cargo(root, &["package", "--list", "--allow-dirty", "--package", &p.name])?;
        found.wrong.extend(contents::complaints(p, list.lines()));
    }
    let homeless = all.iter().filter(|p| p.published && p.repository.is_none()).count();
    if homeless > 0 {
        found.left.push(format!(
            "{homeless} packages have no `repository`, which the links of their READMEs start from"
        ));
    }
    let kept = texts(root, all.first().map_or("", |p| p.version.as_str()));
    found.wrong.extend(kept.wrong);
    found.left.extend(kept.left);
    Ok(found)
}

/// What Cargo prints, without a look at the network.
///
/// # Errors
/// What it says when it fails.
pub fn cargo(root: &Path, args: &[&str]) -> Result<String, String> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let out = Command::new(program).args(args).arg("--offline").current_dir(root).output();
    let out = out.map_err(|e| format!("cargo does not start: {e}"))?;
    if !out.status.success() {
        return Err(format!("cargo {}: {}", args.join(" "), String::from_utf8_lossy(&out.stderr)));
    }
    String::from_utf8(out.stdout).map_err(|e| format!("cargo {}: {e}", args.join(" ")))
}
