//! A short campaign, and every case that went wrong once.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::path::{Path, PathBuf};
use std::time::Duration;

use gudgeon_fuzz::campaign::{self, Plan};
use gudgeon_fuzz::case::command;
use gudgeon_fuzz::child::Executor;
use gudgeon_fuzz::class::{Class, classify};
use gudgeon_fuzz::corpus::{Corpus, shipped};
use gudgeon_fuzz::draw::Draw;
use gudgeon_fuzz::execute::Job;
use gudgeon_fuzz::regression::{Regression, read};
use gudgeon_fuzz::tell;

/// Seed and share of wild cases of the short campaign.
const SEED: u64 = 1;
const WILD: f64 = 0.3;

fn program() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_gudgeon-fuzz"))
}

/// Cases of each scene: many where one takes milliseconds, few where it takes seconds. The first three skirts are refused; the second power cylinder is the
/// same case as the first, and takes five seconds.
const SHORT: [(&str, usize); 6] = [
    ("pin", 10),
    ("piston_secondary", 5),
    ("power_cylinder", 1),
    ("rig", 14),
    ("ring_pack", 6),
    ("shaft_line", 10),
];

#[test]
fn a_short_campaign_ends_without_a_forbidden_class() {
    let corpus = Corpus::read(&shipped()).unwrap_or_else(|e| panic!("{e}"));
    let draw = Draw::new(&corpus, SEED, WILD);
    let mut indices: Vec<u64> =
        SHORT.iter().flat_map(|(scene, n)| draw.of_scene(scene, 0).take(*n).collect::<Vec<_>>()).collect();
    indices.sort_unstable();
    let plan = Plan { seed: SEED, indices, wild: WILD, seconds: f64::INFINITY, jobs: 2, program: program() };
    let records = campaign::run(&plan, &corpus, &|_, _| {}).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(records.len(), 46);
    assert!(!records.iter().any(|r| r.class.forbidden()), "{}", tell::text(&records));
    // A campaign that refuses everything shows nothing.
    let run = records.iter().filter(|r| r.class.honest()).count();
    assert!(run >= 15, "only {run} of 46 cases have results\n{}", tell::text(&records));
}

#[test]
fn regressions_come_out_as_they_should() {
    let all =
        read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions")).unwrap_or_else(|e| panic!("{e}"));
    assert!(!all.is_empty());
    // Every other one to each of two programs.
    let wrong: Vec<String> = std::thread::scope(|s| {
        let halves = [0, 1].map(|k| {
            let half: Vec<_> = all.iter().skip(k).step_by(2).collect();
            s.spawn(move || failures(&half))
        });
        halves.into_iter().flat_map(|h| h.join().expect("a half of the cases")).collect()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Those of `cases` that do not come out as they should.
#[expect(clippy::print_stderr, reason = "what is known and still open is told, and no failure")]
fn failures(cases: &[&Regression]) -> Vec<String> {
    let mut executor = Executor::new(program(), shipped());
    let mut wrong = Vec::new();
    for r in cases {
        let job = Job {
            base: r.case.clone(),
            set: r.set.clone(),
            refine: r.refine,
            coarse: Vec::new(),
            twice: r.twice,
        };
        // One that hung is given a hundred times what a case of its scene takes, as in a campaign; none here needs more.
        let outcome =
            executor.run(&job, Duration::from_secs(120)).unwrap_or_else(|e| panic!("{}: {e}", r.name));
        let (class, detail) = classify(&outcome);
        assert!(!r.why.is_empty() && !r.expect.iter().any(|c| Class::forbidden(*c)), "{}", r.name);
        match (r.expect.contains(&class), r.known) {
            (true, None) => {}
            (true, Some(known)) => eprintln!("{}: mended, delete `known = {:?}`", r.name, known.name()),
            (false, Some(known)) if known == class => {
                eprintln!("{}: still {}: {detail}", r.name, known.name())
            }
            (false, _) => {
                wrong.push(format!("{}: {}: {detail}\n  {}", r.name, class.name(), command(&r.case, &r.set)))
            }
        }
    }
    wrong
}
