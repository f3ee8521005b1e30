//! What the check of a release finds, on invented packages.

use std::collections::BTreeSet;

use gudgeon_release::{Cycle, Package, complaints, missing_includes, order, packages};

const METADATA: &str = r#"{ "packages": [
    { "name": "top", "version": "0.2.0", "manifest_path": "/w/top/Cargo.toml", "publish": null, "readme": "README.md",
      "description": "d", "license": "MIT", "documentation": "https://docs.rs/top", "rust_version": "1.89",
      "keywords": ["engine"], "categories": ["science"], "dependencies": [
        { "name": "base", "req": "^0.2.0", "kind": null, "path": "/w/base" },
        { "name": "serde", "req": "^1", "kind": null } ] },
    { "name": "base", "version": "0.2.0", "manifest_path": "/w/base/Cargo.toml", "publish": null, "readme": "README.md",
      "description": "d", "license": "MIT", "documentation": "https://docs.rs/base", "rust_version": "1.89",
      "keywords": ["engine"], "categories": ["science"], "dependencies": [
        { "name": "top", "req": "*", "kind": "dev", "path": "/w/top" } ] },
    { "name": "inside", "version": "0.2.0", "manifest_path": "/w/inside/Cargo.toml", "publish": [], "dependencies": [] } ] }"#;

fn all() -> Vec<Package> {
    packages(METADATA).expect("metadata")
}
fn names(all: &[Package]) -> Result<Vec<&str>, Cycle> {
    order(all).map(|o| o.iter().map(|p| p.name.as_str()).collect())
}

/// A package comes after what it depends on; a dev-dependency without a version is dropped by Cargo and does not count.
#[test]
fn packages_come_after_their_dependencies() {
    let mut all = all();
    assert_eq!(names(&all), Ok(vec!["base", "top"]));
    all[1].dependencies[0].requirement = "^0.2.0".into();
    assert_eq!(names(&all), Err(Cycle(vec!["base".into(), "top".into()])));
}

#[test]
fn what_an_index_refuses_is_told() {
    assert!(complaints(&all()).is_empty(), "{:?}", complaints(&all()));
    type Spoil = fn(&mut Vec<Package>);
    let spoilt: [(&str, Spoil); 8] = [
        ("base: no `license`", |all| all[1].texts[1].1 = None),
        ("top: no `description`", |all| all[0].texts[0].1 = Some(String::new())),
        ("base: no README.md of its own", |all| all[1].readme = Some("../README.md".into())),
        ("top: no `categories`", |all| all[0].categories.clear()),
        ("top: keywords", |all| all[0].keywords = vec!["a word of more than twenty letters".into()]),
        ("base: version 0.1.0 where others have 0.2.0", |all| all[1].version = "0.1.0".into()),
        ("top: asks for base ^0.1.0", |all| all[0].dependencies[0].requirement = "^0.1.0".into()),
        ("top: depends on base, which is not published", |all| all[1].published = false),
    ];
    for (told, spoil) in spoilt {
        let mut all = all();
        spoil(&mut all);
        assert!(complaints(&all).iter().any(|c| c.starts_with(told)), "{told}: {:?}", complaints(&all));
    }
}

#[test]
fn files_that_a_source_takes_in_belong_to_the_package() {
    let files: BTreeSet<String> = ["src/a/b.rs", "src/sets.json"].map(str::to_owned).into();
    let text = "const A: &str = include_str!(\"../sets.json\");\nconst B: &[u8] = include_bytes!(\"../../data.bin\");\n// include_str!(\"no\")\n";
    let told = missing_includes("src/a/b.rs", text, &files);
    assert_eq!(told, ["src/a/b.rs takes in ../../data.bin, which is not in the package"]);
}
