//! Baselines, changes and their history.

use gudgeon_benches::baseline::{Baseline, changes};
use gudgeon_benches::history;
use gudgeon_benches::measure::{Span, Work};

fn work(all: &[(&str, &str, u64, u64)]) -> Work {
    let mut work = Work::new();
    for (case, counter, low, high) in all {
        work.entry((*case).into()).or_default().insert((*counter).into(), Span(*low, *high));
    }
    work
}

/// A file of this test alone.
fn file(name: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}-{name}", std::process::id()))
}

#[test]
fn within_the_span_nothing_changed_and_beyond_it_the_nearer_end_counts() {
    let was = work(&[("a", "steps", 900, 1000)]);
    let share = |n: u64| changes(&was, &work(&[("a", "steps", n, n)])).first().map(|c| c.share());
    assert_eq!([share(900), share(950), share(1000)], [None; 3]);
    // Quotients of small integers, rounded once.
    assert!((share(1100).expect("a change") - 0.1).abs() < 1e-15);
    assert!((share(810).expect("a change") + 0.1).abs() < 1e-15);
}

#[test]
fn what_is_new_or_gone_is_beyond_any_share() {
    let (was, is) = (work(&[("a", "steps", 1, 1)]), work(&[("a", "rhs", 2, 2)]));
    let told = changes(&was, &is);
    assert_eq!(told.iter().map(|c| c.share()).collect::<Vec<_>>(), [f64::INFINITY; 2]);
    assert_eq!(told[0].to_string(), "a: rhs is 2, and was not counted before");
    assert_eq!(told[1].to_string(), "a: steps was 1, and is no longer counted");
    // A count that was nothing has no part of it to grow by.
    let zero = changes(&work(&[("a", "steps", 0, 0)]), &work(&[("a", "steps", 3, 3)]));
    assert_eq!(zero.first().map(ToString::to_string).as_deref(), Some("a: steps was 0, is 3 (+300.0 %)"));
}

#[test]
fn a_baseline_reads_back_and_has_a_line_for_every_counter() {
    let counters = work(&[("b, x", "steps", 3, 4), ("a", "rhs", 2, 2), ("a", "cycles", 1, 1)]);
    let instructions = work(&[("a", "million_instructions", 116, 116)]);
    let baseline = Baseline { compiler: "rustc 1".into(), counters, instructions };
    let path = file("counters.toml");
    baseline.write(&path).expect("a file");
    assert_eq!(Baseline::read(&path), Ok(baseline));
    let text = std::fs::read_to_string(&path).expect("a file");
    let body = text.split_once("\n\n").expect("a head").1;
    let expected = "compiler = \"rustc 1\"\n\n[counters.a]\ncycles = [1, 1]\nrhs = [2, 2]\n\n[counters.\"b, x\"]\nsteps = [3, 4]\n\n\
                    [instructions.a]\nmillion_instructions = [116, 116]\n";
    assert_eq!(body, expected);
    std::fs::remove_file(&path).expect("the file");
}

#[test]
fn the_history_tells_reasons_with_both_values() {
    let path = file("history.md");
    let was = work(&[("a", "steps", 10, 10), ("b", "rhs", 1, 1)]);
    let is = work(&[("a", "steps", 11, 12), ("c", "cycles", 1, 1), ("c", "steps", 5, 5)]);
    history::add(&path, " More steps, for a reason.\n", &changes(&was, &is)).expect("a file");
    history::add(&path, "Nothing.", &[]).expect("a file");
    let text = std::fs::read_to_string(&path).expect("a file");
    let entries = text.split_once("\n## ").expect("an entry").1;
    let expected = "More steps, for a reason.\n\n- Gone: b (rhs)\n- New: c (cycles, steps)\n\n\
                    | case | counter | was | is | change |\n|---|---|---|---|---|\n\
                    | a | steps | 10 | 11 to 12 | +20.0 % |\n\n## Nothing.\n";
    assert_eq!(entries, expected);
    std::fs::remove_file(&path).expect("the file");
}
