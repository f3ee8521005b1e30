//! Many runs at once.

use std::sync::atomic::{AtomicUsize, Ordering};

use gudgeon_core::result::{Failure, RunResult};
use gudgeon_scene::many::{run_many, run_points};
use gudgeon_scene::{Progress, Stopped, unwatched};

use crate::common::checked;

/// Speeds of a slider, one of them not a number and one refused by the model.
fn points() -> Vec<Vec<String>> {
    let mut all: Vec<Vec<String>> = (1..=40).map(|k| vec![format!("rig.speed={k} m/s")]).collect();
    all[7] = vec!["rig.speed=fast".into()];
    all[20] = vec!["rig.panels=0".into()];
    all
}

fn kept(threads: usize) -> Vec<Result<RunResult, Failure>> {
    let c = checked("rigs/slider-barrel", &[]);
    let keep = |_, outcome: Result<RunResult, Failure>| {
        outcome.map(|mut r| {
            // Wall times are no results.
            r.seconds.clear();
            r
        })
    };
    run_points(c.case.as_ref(), &points(), threads, keep, &mut unwatched).all().expect("nobody stops it")
}

#[test]
fn rows_are_the_same_for_any_number_of_threads() {
    let alone = kept(1);
    assert_eq!(alone.iter().filter(|r| r.is_ok()).count(), 38);
    for threads in [2, 5, 0] {
        assert!(kept(threads) == alone, "{threads} threads");
    }
}

#[test]
fn a_point_that_fails_is_a_row_with_code_path_and_message() {
    let rows = kept(2);
    let (text, range) = (rows[7].as_ref().expect_err("no number"), rows[20].as_ref().expect_err("no panel"));
    assert_eq!((text.code.as_str(), text.path.as_str()), ("refused", "rig.speed"));
    assert_eq!((range.code.as_str(), range.path.as_str()), ("refused", "rig.panels"));
    assert!(text.message.contains("fast"), "{}", text.message);
}

#[test]
fn a_stop_keeps_what_is_done() {
    for threads in [1, 3] {
        let begun = AtomicUsize::new(0);
        // Every run waits for the stop, but for the first ten.
        let work = |k: usize, tell: &mut dyn FnMut(Progress) -> Result<(), Stopped>| {
            begun.fetch_add(1, Ordering::Relaxed);
            let far = || Progress { phase: String::new(), fraction: 0.5 };
            while k >= 10 && tell(far()).is_ok() {
                std::thread::yield_now();
            }
            k
        };
        let mut told = 0.0;
        let mut progress = |p: Progress| {
            told = p.fraction;
            if p.fraction >= 0.1 { Err(Stopped) } else { Ok(()) }
        };
        let out = run_many(100, threads, work, &mut progress);
        assert!(out.stopped && told < 0.5, "{threads} threads, told {told}");
        assert!((0..10).all(|k| out.rows[k] == Some(k)), "{threads} threads: {:?}", out.rows);
        assert!(out.rows[10..].iter().all(Option::is_none), "{threads} threads: {:?}", out.rows);
        assert!(begun.into_inner() <= 10 + threads, "{threads} threads went on");
        assert!(out.all().is_err());
    }
}

#[test]
fn a_run_that_is_stopped_says_so() {
    let c = checked("turbo-diesel-120/flooded", &[]);
    let mut looks = 0;
    let mut after_three = |_| {
        looks += 1;
        if looks == 3 { Err(Stopped) } else { Ok(()) }
    };
    let e = gudgeon_scene::run(&c, &mut after_three).expect_err("stopped");
    assert!(matches!(e, gudgeon_scene::RunError::Stopped), "{e}");
    assert_eq!(looks, 3);
}
