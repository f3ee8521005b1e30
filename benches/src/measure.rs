//! Runs cases and takes down what their solvers counted.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use crate::cases::Case;

/// Counters of one case, by name.
pub type Counts = BTreeMap<String, u64>;

/// Least and greatest count of a case and its neighbours ([`Case::neighbours`]): the difference is chance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Span(pub u64, pub u64);

/// Spans by case and counter.
pub type Work = BTreeMap<String, BTreeMap<String, Span>>;

/// What the solver of a case counted, sweeps apart.
///
/// # Errors
/// A case that is wrong, does not run or counts nothing.
pub fn counts(case: &Case) -> Result<Counts, String> {
    let counters: Counts = case.run()?.solver.counters.into_iter().collect();
    if counters.is_empty() { Err(format!("{}: its solver counts nothing", case.name)) } else { Ok(counters) }
}

/// What the solver of each case counted, in the order of the cases, on `threads` threads; the same for any number of them.
pub fn each(cases: &[Case], threads: usize) -> Vec<Result<Counts, String>> {
    let next = AtomicUsize::new(0);
    let done: Vec<_> = cases.iter().map(|_| Mutex::new(None)).collect();
    let take = || {
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(k) else { return };
            *done[k].lock().unwrap_or_else(PoisonError::into_inner) = Some(counts(case));
        }
    };
    std::thread::scope(|s| {
        for _ in 0..threads.clamp(1, cases.len().max(1)) {
            s.spawn(take);
        }
    });
    let taken = |slot: Mutex<Option<_>>| slot.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.into_iter().filter_map(taken).collect()
}

/// What the solvers of `cases` counted, by case name; cases of one name share their spans.
///
/// # Errors
/// What is wrong with every case that has no counters.
pub fn work(cases: &[Case], threads: usize) -> Result<Work, Vec<String>> {
    let mut work = Work::new();
    let mut wrong = Vec::new();
    for (case, outcome) in cases.iter().zip(each(cases, threads)) {
        let counts = outcome.unwrap_or_else(|e| {
            wrong.push(e);
            Counts::new()
        });
        let spans = work.entry(case.name.clone()).or_default();
        for (counter, n) in counts {
            spans.entry(counter).and_modify(|s| *s = Span(s.0.min(n), s.1.max(n))).or_insert(Span(n, n));
        }
    }
    if wrong.is_empty() { Ok(work) } else { Err(wrong) }
}
