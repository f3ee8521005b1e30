//! Many cases, some at a time.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::case::Case;
use crate::child::Executor;
use crate::class::{Class, classify, defect};
use crate::corpus::Corpus;
use crate::draw::Draw;
use crate::execute::{End, Job, Outcome};
use crate::shrink::shrink;

/// What is wanted.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Seed.
    pub seed: u64,
    /// Indices of the cases.
    pub indices: Vec<u64>,
    /// Share of wild cases.
    pub wild: f64,
    /// No case is begun after this time.
    pub seconds: f64,
    /// Cases at a time.
    pub jobs: usize,
    /// The program that becomes the children.
    pub program: PathBuf,
}

/// A case and what became of it.
#[derive(Debug, Clone, Serialize)]
pub struct Record {
    /// The case.
    pub case: Case,
    /// Its class.
    pub class: Class,
    /// What makes it so.
    pub detail: String,
    /// The same without figures.
    pub defect: String,
    /// Time \[s\].
    pub seconds: f64,
    /// The command that runs it; of a bad case, with no more changes than make it so.
    pub command: String,
    /// The changes of that command.
    pub changes: usize,
}

/// A case takes too long beyond this many times the median of its scene.
const TIMES: f64 = 100.0;
/// No case takes too long below this \[s\]: other programs run on the machine too.
const PATIENCE: f64 = 30.0;
/// Until so many plausible cases of a scene have ended, nothing is known about its median.
const KNOWN: usize = 10;
/// Limit until then \[s\].
const AT_FIRST: f64 = 120.0;
/// Limits of a case after which its reduction stops with what it has: hangs are dear to repeat.
const LONGEST: u32 = 2;
/// Cases of one defect that are reduced.
const SHRUNK: usize = 2;

/// Times of the plausible cases of each scene that were not refused.
#[derive(Debug, Default)]
struct Clock(BTreeMap<String, Vec<f64>>);

impl Clock {
    fn limit(&self, scene: &str) -> Duration {
        let times = self.0.get(scene).map_or(&[][..], Vec::as_slice);
        let limit = if times.len() < KNOWN { AT_FIRST } else { (TIMES * median(times)).max(PATIENCE) };
        Duration::from_secs_f64(limit)
    }
}

/// The median; zero of nothing.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    let mut v = values.to_vec();
    v.sort_by(f64::total_cmp);
    v.get(v.len() / 2).copied().unwrap_or(0.0)
}

/// What all workers share.
struct Shared {
    next: AtomicUsize,
    begin: Instant,
    clock: Mutex<Clock>,
    records: Mutex<Vec<Record>>,
    reduced: Mutex<BTreeMap<(Class, String, String), usize>>,
}

fn lock<T>(m: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    m.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs the cases of a plan, in the order of their indices in the end. `tell` hears of every case that ends.
///
/// # Errors
/// No child can be started, a scene without cases.
pub fn run(
    plan: &Plan,
    corpus: &Corpus,
    tell: &(dyn Fn(usize, &Record) + Sync),
) -> Result<Vec<Record>, String> {
    let shared = Shared {
        next: AtomicUsize::new(0),
        begin: Instant::now(),
        clock: Mutex::default(),
        records: Mutex::default(),
        reduced: Mutex::default(),
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> =
            (0..plan.jobs.max(1)).map(|_| scope.spawn(|| work(plan, corpus, &shared, tell))).collect();
        let ended = workers.into_iter().map(|w| w.join().unwrap_or_else(|_| Err("a worker panicked".into())));
        ended.collect::<Result<(), String>>()
    })?;
    let mut records = shared.records.into_inner().unwrap_or_else(PoisonError::into_inner);
    records.sort_by_key(|r| r.case.index);
    Ok(records)
}

fn work(
    plan: &Plan,
    corpus: &Corpus,
    shared: &Shared,
    tell: &(dyn Fn(usize, &Record) + Sync),
) -> Result<(), String> {
    let draw = Draw::new(corpus, plan.seed, plan.wild);
    let mut executor = Executor::new(plan.program.clone(), corpus.folder.clone());
    loop {
        let k = shared.next.fetch_add(1, Ordering::Relaxed);
        let Some(index) = plan.indices.get(k) else { return Ok(()) };
        if shared.begin.elapsed().as_secs_f64() > plan.seconds {
            return Ok(());
        }
        let case = draw.case(*index)?;
        let limit = lock(&shared.clock).limit(&case.scene) * runs(&case);
        let outcome = executor.run(&job(&case), limit).map_err(|e| e.to_string())?;
        if !case.wild() && !matches!(outcome.end, End::Refused { .. } | End::Hang) {
            lock(&shared.clock).0.entry(case.scene.clone()).or_default().push(outcome.seconds);
        }
        let mut record = record(case, &outcome);
        if record.class.bad()
            && shared.begin.elapsed().as_secs_f64() < plan.seconds
            && first_of(shared, &record)
        {
            reduce(&mut record, &mut executor, limit).map_err(|e| e.to_string())?;
        }
        let mut records = lock(&shared.records);
        records.push(record);
        tell(records.len(), &records[records.len() - 1]);
    }
}

/// Runs of a case that its time limit counts: itself, again where that is asked for, and several finer ones, each of a grid at most four times as dear.
fn runs(case: &Case) -> u32 {
    1 + u32::from(case.twice) + 8 * u32::from(case.refine)
}

/// What a child is asked to do with a case.
#[must_use]
pub fn job(case: &Case) -> Job {
    let coarse = case.shortened.iter().map(|c| c.path.clone()).collect();
    Job { base: case.base.clone(), set: case.set(), refine: case.refine, coarse, twice: case.twice }
}

/// A case with its class.
#[must_use]
pub fn record(case: Case, outcome: &Outcome) -> Record {
    let (class, detail) = classify(outcome);
    Record {
        class,
        defect: defect(&detail),
        detail,
        seconds: outcome.seconds,
        command: case.command(),
        changes: case.changes.len(),
        case,
    }
}

/// Whether it is one of the first of its defect in its scene.
fn first_of(shared: &Shared, r: &Record) -> bool {
    let mut reduced = lock(&shared.reduced);
    let n = reduced.entry((r.class, r.case.scene.clone(), r.defect.clone())).or_insert(0);
    *n += 1;
    *n <= SHRUNK
}

/// Reduces the changes of a bad record to those that make it so.
///
/// # Errors
/// No child can be started.
pub fn reduce(r: &mut Record, executor: &mut Executor, limit: Duration) -> std::io::Result<()> {
    let (class, defect, begin) = (r.class, r.defect.clone(), Instant::now());
    let mut detail = None;
    let least = shrink(&r.case, |c| {
        if begin.elapsed() > LONGEST * limit {
            return Ok(false);
        }
        let again = record(c.clone(), &executor.run(&job(c), limit)?);
        let same = again.class == class && (again.defect == defect || class != Class::Panic);
        if same {
            detail = Some(again.detail);
        }
        std::io::Result::Ok(same)
    })?;
    r.command = least.command();
    r.changes = least.changes.len();
    r.detail = detail.unwrap_or_else(|| r.detail.clone());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_follows_the_median_of_the_scene() {
        let mut clock = Clock::default();
        assert_eq!(clock.limit("pin").as_secs_f64(), AT_FIRST);
        clock.0.insert("pin".into(), vec![0.5; KNOWN]);
        assert_eq!(clock.limit("pin").as_secs_f64(), 50.0);
        clock.0.insert("pin".into(), vec![1e-3; KNOWN]);
        assert_eq!(clock.limit("pin").as_secs_f64(), PATIENCE);
        assert_eq!(clock.limit("rig").as_secs_f64(), AT_FIRST);
    }
}
