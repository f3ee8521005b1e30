//! Many runs at once: points of a case on the cores of this machine.
//!
//! Every point is a list of changes to one case. Points are independent, and what is kept of each stands at its own place: the answer is the same
//! for any number of threads, and in any order in which they happen to end.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use gudgeon_core::result::{Failure, RunResult};
use gudgeon_core::{Stopped, Stopwatch};

use crate::error::{Progress, RunError};
use crate::run::once;
use crate::scene::Scene;
use crate::second::{alone, limited};

/// What was kept of many runs.
#[derive(Debug)]
pub struct Many<T> {
    /// By point; none where the point was not reached before a stop.
    pub rows: Vec<Option<T>>,
    /// Whether the caller stopped it.
    pub stopped: bool,
}

impl<T> Many<T> {
    /// All rows.
    ///
    /// # Errors
    /// Not all points were reached.
    pub fn all(self) -> Result<Vec<T>, Stopped> {
        self.rows.into_iter().collect::<Option<_>>().filter(|_| !self.stopped).ok_or(Stopped)
    }
}

/// A callback that hears how far a computation is, and says whether it may go on.
type Tell<'a> = &'a mut dyn FnMut(Progress) -> Result<(), Stopped>;

/// How often the caller hears of the progress of other threads.
const TOLD_EVERY: Duration = Duration::from_millis(50);

/// Number of threads that `0` stands for: one a core.
#[must_use]
pub fn all_threads() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// Has `work` done for `0..count`, on `threads` threads (0: one a core). The calling thread hears of the progress, with the remaining time in words; when it
/// says [`Stopped`], points under way are broken off and those that are done are kept.
///
/// With one thread the points are done on the calling thread, and no run uses a second one; a single point may, where more are allowed.
pub fn run_many<T: Send>(
    count: usize,
    threads: usize,
    work: impl Fn(usize, Tell<'_>) -> T + Sync,
    progress: Tell<'_>,
) -> Many<T> {
    if threads == 1 || alone() {
        return limited(1, || one_by_one(count, work, progress));
    }
    let threads = if threads == 0 { all_threads() } else { threads }.min(count);
    let pool = (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build());
    match pool {
        // Where threads cannot be had, the calling one does it all.
        None | Some(Err(_)) => one_by_one(count, work, progress),
        Some(Ok(pool)) => side_by_side(&pool, threads, count, work, progress),
    }
}

fn one_by_one<T>(count: usize, work: impl Fn(usize, Tell<'_>) -> T, progress: Tell<'_>) -> Many<T> {
    let clock = Clock::new(count);
    let mut rows: Vec<Option<T>> = (0..count).map(|_| None).collect();
    for k in 0..count {
        let mut stopped = progress(clock.look(k, 0.0)).is_err();
        let row = (!stopped)
            .then(|| work(k, &mut |p| progress(clock.look(k, p.fraction)).inspect_err(|_| stopped = true)));
        if stopped {
            return Many { rows, stopped };
        }
        rows[k] = row;
    }
    Many { rows, stopped: false }
}

fn side_by_side<T: Send>(
    pool: &rayon::ThreadPool,
    threads: usize,
    count: usize,
    work: impl Fn(usize, Tell<'_>) -> T + Sync,
    progress: Tell<'_>,
) -> Many<T> {
    let clock = Clock::new(count);
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (send, receive) = mpsc::channel::<(usize, T)>();
    let mut rows: Vec<Option<T>> = (0..count).map(|_| None).collect();
    pool.in_place_scope(|scope| {
        for _ in 0..threads {
            let (send, work, next, stop) = (send.clone(), &work, &next, &stop);
            scope.spawn(move |_| {
                let mut heed = |_| if stop.load(Ordering::Relaxed) { Err(Stopped) } else { Ok(()) };
                while let Some(k) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|k| *k < count) {
                    if stop.load(Ordering::Relaxed) {
                        return;
                    }
                    let row = limited(1, || work(k, &mut heed));
                    // A point that was broken off has nothing to tell; one that ended just before the stop is told all the same.
                    if stop.load(Ordering::Relaxed) || send.send((k, row)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(send);
        let (mut done, mut told) = (0, Instant::now());
        loop {
            match receive.recv_timeout(TOLD_EVERY) {
                Ok((k, row)) => {
                    rows[k] = Some(row);
                    done += 1;
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => break,
            }
            if told.elapsed() >= TOLD_EVERY || done == count {
                told = Instant::now();
                if progress(clock.look(done, 0.0)).is_err() {
                    stop.store(true, Ordering::Relaxed);
                }
            }
        }
    });
    Many { rows, stopped: stop.into_inner() }
}

/// Tells how far many runs are.
struct Clock {
    begin: Stopwatch,
    count: usize,
}

impl Clock {
    fn new(count: usize) -> Self {
        Self { begin: Stopwatch::start(), count }
    }

    /// `done` points and the share `under_way` of another.
    fn look(&self, done: usize, under_way: f64) -> Progress {
        let fraction = (done as f64 + under_way) / self.count.max(1) as f64;
        let mut phase = format!("{done} of {} runs", self.count);
        let passed = self.begin.seconds();
        if fraction > 0.0 && passed > 0.0 {
            let left = passed * (1.0 / fraction - 1.0);
            phase.push_str(&format!(", {} left", in_words(left)));
        }
        Progress { phase, fraction }
    }
}

/// A time that is still to pass, as coarse as it is known.
fn in_words(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// Runs a case with the changes of each of `points`, sweeps apart; `keep` says what stays of a run, told the number of its point.
///
/// A point whose changes are refused, or whose run fails, is a [`Failure`].
pub fn run_points<T: Send>(
    scene: &dyn Scene,
    points: &[Vec<String>],
    threads: usize,
    keep: impl Fn(usize, Result<RunResult, Failure>) -> T + Sync,
    progress: Tell<'_>,
) -> Many<T> {
    let work = |k: usize, tell: Tell<'_>| keep(k, run_point(scene, &points[k], tell));
    run_many(points.len(), threads, work, progress)
}

/// Runs a case with some changes, sweeps apart.
///
/// # Errors
/// Why it has no result.
pub fn run_point(scene: &dyn Scene, set: &[String], progress: Tell<'_>) -> Result<RunResult, Failure> {
    let changed = scene.changed(set).map_err(|report| report.failure())?;
    let errors = changed.legal();
    if !errors.is_empty() {
        return Err(changed.refuse(&errors).failure());
    }
    once(changed.as_ref(), progress).map_err(|e: RunError| e.failure())
}
