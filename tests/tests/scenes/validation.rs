//! Every file of comparisons in `validation/` holds, and the pages that show them are what the cases give now.

use std::path::{Path, PathBuf};

use gudgeon_core::result::Validated;
use gudgeon_report::{page_name, validation_index, validation_page};
use gudgeon_study::validate::{ValidateError, file_of, files, validate};

use crate::common::*;

/// A folder or a file of the repository.
fn here(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

/// Runs every comparison. Their pages in the repository must be what this gives:
/// `gudgeon validate --pages VALIDATION.md` writes them anew.
#[test]
fn every_case_agrees_with_its_sources() {
    let all = files(&here("validation")).expect("the folder of the comparisons");
    let validated: Vec<Validated> = validate(&all, 0, &mut gudgeon_scene::unwatched)
        .expect("nobody stops it")
        .into_iter()
        .map(|v| match v {
            Ok(v) => v,
            Err(ValidateError::Input(report)) => panic!("{report}"),
            Err(ValidateError::Run(file, e)) => panic!("{}: {e}", file.display()),
        })
        .collect();
    let broken: Vec<String> = validated
        .iter()
        .flat_map(|v| {
            v.broken().map(move |c| {
                let (says, admitted) = (c.verdict.words(), c.tolerance);
                format!(
                    "{}: {}: {}: {:e} where the source gives {:e}, deviation {:.1e}, admitted {admitted:.0e}, called {says}",
                    v.case,
                    c.setting(),
                    c.result,
                    c.value,
                    c.reference,
                    c.deviation()
                )
            })
        })
        .collect();
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
    assert!(validated.len() > 40 && validated.iter().all(|v| !v.checks.is_empty()));
    let mut stale = Vec::new();
    let mut compare = |file: PathBuf, text: &str| {
        let stands = std::fs::read_to_string(&file).unwrap_or_default();
        if stands != text {
            let differs = stands.lines().zip(text.lines()).find(|(a, b)| a != b);
            stale.push(format!("{}: {differs:?}", file.display()));
        }
    };
    for v in &validated {
        compare(here("docs/validation").join(format!("{}.md", page_name(v))), &validation_page(v));
    }
    compare(here("VALIDATION.md"), &validation_index(&validated, "docs/validation"));
    assert!(
        stale.is_empty(),
        "write the pages anew with `gudgeon validate --pages VALIDATION.md`:\n{}",
        stale.join("\n")
    );
}

#[test]
fn a_case_finds_its_comparisons() {
    let found = |case: &str| {
        let f = file_of(&case_file(case)).expect("the folder can be read")?;
        Some(f.strip_prefix(here("validation").canonicalize().expect("a folder")).expect("below").to_owned())
    };
    assert_eq!(found("ea111-1400"), Some("ea111-1400.toml".into()));
    assert_eq!(found("rigs/kinematics"), Some("rigs/kinematics.toml".into()));
    assert_eq!(found("turbo-diesel-120-power-cylinder"), None);
}
