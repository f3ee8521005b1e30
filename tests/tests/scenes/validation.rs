//! Every bench, and every case with checks, against the values of its sources: one table, which stands in VALIDATION.md.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use gudgeon_core::result::Check;
use gudgeon_sim::{check, run};

/// Every bench, and every engine case that compares itself with its source.
fn cases() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases");
    let mut files: Vec<_> = ["", "rigs"]
        .iter()
        .flat_map(|f| std::fs::read_dir(folder.join(f)).expect("the folder of the cases"))
        .map(|e| e.expect("an entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .filter(|p| {
            let bench = p.parent().is_some_and(|f| f.ends_with("rigs"));
            bench || std::fs::read_to_string(p).expect("a case").contains("[[checks]]")
        })
        .collect();
    files.sort();
    files
}

/// Its name below the folder of the cases.
fn name(path: &Path) -> String {
    let bench = path.parent().is_some_and(|f| f.ends_with("rigs"));
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    if bench { format!("rigs/{stem}") } else { stem.into_owned() }
}

/// A deviation as the table shows it. Rounding differs between machines, so what is of its size is only called small.
fn deviation(c: &Check) -> String {
    let d = c.deviation();
    if d.abs() < 1e-12 { "< 1e-12".into() } else { format!("{d:+.0e}") }
}

/// Digits that a check can vouch for: those beyond its tolerance and beyond eight would differ between machines.
fn value(v: f64) -> String {
    if v == 0.0 { "0".into() } else { format!("{v:.7e}") }
}

/// Runs every case and writes its checks as a table. The file in the repository must be what this makes of the cases:
/// `GUDGEON_WRITE_VALIDATION=1 cargo test -p gudgeon-tests --test scenes validation` writes it anew.
#[test]
fn every_case_agrees_with_its_sources() {
    let mut text = String::from(
        "# Validation\n\nEvery bench of `cases/rigs` and every other case with checks beside the values of its sources. The test `validation` makes this \
         file and fails when a deviation is larger than admitted, or when a model or a source that must fail (it does not conserve \
         mass, say) does not. Deviations are relative, or absolute where the source gives zero. The published engine cases have \
         tables of their own, made by the tests `zottin` and `tomanik`.\n",
    );
    let mut wrong = Vec::new();
    let mut rows = 0;
    for path in cases() {
        let c = check(&path, &[]).unwrap_or_else(|r| panic!("{}: {r}", path.display()));
        let r = run(&c, &mut |_| {}).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let _ = write!(text, "\n## {}\n\n`cases/{}.toml`. {}\n\n", r.title, name(&path), r.source);
        if r.checks.is_empty() {
            text.push_str("No values to compare with.\n");
            continue;
        }
        text.push_str("| setting | result | computed | source | unit | deviation | admitted | where from |\n|---|---|---|---|---|---|---|---|\n");
        for c in &r.checks {
            rows += 1;
            let set = c.setting();
            let admitted = format!("{}{:.0e}", if c.must_fail { "must exceed " } else { "" }, c.tolerance);
            let _ = writeln!(
                text,
                "| {set} | {} | {} | {} | {} | {} | {admitted} | {} |",
                c.result,
                value(c.value),
                value(c.reference),
                c.unit,
                deviation(c),
                c.source
            );
            if !c.holds() {
                wrong.push(format!(
                    "{}: {set}: {}: {:e} instead of {:e}, deviation {:.1e}, admitted {admitted}",
                    r.case,
                    c.result,
                    c.value,
                    c.reference,
                    c.deviation()
                ));
            }
        }
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../VALIDATION.md");
    if std::env::var_os("GUDGEON_WRITE_VALIDATION").is_some() {
        std::fs::write(&file, &text).expect("VALIDATION.md can be written");
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(rows > 0, "no case has a check");
    let stands = std::fs::read_to_string(&file).unwrap_or_default();
    let differs = stands.lines().zip(text.lines()).find(|(a, b)| a != b);
    assert!(
        stands == text,
        "VALIDATION.md is not what the cases give now; the first line that differs: {differs:?}. Write it anew with GUDGEON_WRITE_VALIDATION=1"
    );
}
