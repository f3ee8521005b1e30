//! One run on two threads.

use gudgeon_scene::many::run_many;
use gudgeon_scene::{Progress, SecondThread, Stopped, Threads, receive, run, unwatched, with_threads};

use crate::common::checked;

/// All that a run tells but its wall times, or why it failed.
fn told(threads: Threads, case: &str, set: &[&str]) -> String {
    let c = checked(case, set);
    match with_threads(threads, || run::run_alone(&c, &mut unwatched)) {
        Ok(mut result) => {
            result.seconds.clear();
            serde_json::to_string(&result).expect("a result is text and numbers")
        }
        Err(e) => e.to_string(),
    }
}

const FLOODED: &str = "turbo-diesel-120/flooded";
const HALVES: &[&str] = &["solver.integrator=waveform", "solver.tolerance=1e-2"];

/// Halves to the end and on the way to the whole pack, without oil and with it; a ring that leaves the liner, a search that ends too soon, and either half giving up.
#[test]
fn halves_at_once_tell_what_they_tell_in_turn() {
    let cases: [(&str, &[&str]); 8] = [
        (FLOODED, HALVES),
        (FLOODED, &["solver.tolerance=1e-2"]),
        ("turbo-diesel-120", HALVES),
        ("motored-rings-1600", HALVES),
        (FLOODED, &[HALVES[0], HALVES[1], "engine.speed=4000 rpm"]),
        (FLOODED, &[HALVES[0], HALVES[1], "solver.max_cycles=2"]),
        // Gas and grooves come to 54 degrees with 100 steps. With 300 they end the cycle, but films with oil on the liner do not.
        (FLOODED, &[HALVES[0], HALVES[1], "solver.limits.max_steps=100"]),
        ("turbo-diesel-120", &[HALVES[0], HALVES[1], "solver.limits.max_steps=300"]),
    ];
    for (case, set) in cases {
        let [one, two, given_up] =
            [Threads::One, Threads::Two, Threads::GivenUp].map(|threads| told(threads, case, set));
        assert!(one == two && one == given_up, "{case} {set:?}");
    }
}

#[test]
fn a_second_thread_is_there_where_it_is_asked_for() {
    let spare = |threads| with_threads(threads, || SecondThread::spare().is_some());
    assert!(spare(Threads::Two) && !spare(Threads::One));
    // What was asked for holds within, not after.
    let within = with_threads(Threads::Two, || (spare(Threads::One), SecondThread::spare().is_some()));
    assert_eq!(within, (false, true));
}

/// Whether a run that begins where it is asked would have a second thread.
fn none_is_spare(_: Progress) -> Result<(), Stopped> {
    assert!(SecondThread::spare().is_none());
    Ok(())
}

#[test]
fn one_thread_is_one() {
    let c = checked("rigs/slider-barrel", &[]);
    with_threads(Threads::Two, || {
        run::run_on(&c, 1, &mut none_is_spare).expect("it runs");
        run::run_verified_on(&c, 1, &mut none_is_spare).expect("it runs");
        let rows = |threads| run_many(4, threads, |_, _| SecondThread::spare().is_none(), &mut unwatched);
        assert_eq!([rows(1).rows, rows(2).rows], [vec![Some(true); 4], vec![Some(true); 4]]);
    });
}

#[test]
fn what_a_second_thread_cannot_do_is_known_here() {
    let thread = with_threads(Threads::Two, SecondThread::spare).expect("a thread");
    let (done, come) = std::sync::mpsc::channel::<()>();
    thread.begin(move || {
        let _done = done;
        panic!("meant to end like this");
    });
    assert!(receive(&come).is_err());
    let panic = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| thread.panicked()));
    assert_eq!(panic.expect_err("it panicked").downcast_ref(), Some(&"meant to end like this"));
}
