//! A second core for one run.
//!
//! A run that can do two things at once uses a core beside its own, where one is free: not where many runs share the machine, nor where its caller asked for one thread. Results are the
//! same to the bit. What is done beside a run takes a millisecond or two, so both threads wait awake: one that sleeps is woken late, and on a virtual machine often on the core of the one that
//! wakes it.

use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvError, Sender, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::many::all_threads;

/// Threads of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Threads {
    /// That of its caller alone.
    One,
    /// A second one, whatever else the machine does: for measurements and tests.
    Two,
    /// A second one that is given up at once, as where other processes want its core: for tests.
    GivenUp,
}

thread_local! {
    /// Threads of the runs that begin on this one, where that is asked for.
    static ASKED: Cell<Option<Threads>> = const { Cell::new(None) };
}

/// Has `work` done, with `threads` in every run that it begins on this thread.
pub fn with_threads<T>(threads: Threads, work: impl FnOnce() -> T) -> T {
    /// Puts back what was, also where the work panics.
    struct Before(Option<Threads>);
    impl Drop for Before {
        fn drop(&mut self) {
            ASKED.set(self.0);
        }
    }
    let _before = Before(ASKED.replace(Some(threads)));
    work()
}

/// The same where a caller that counts threads asks for one.
pub(crate) fn limited<T>(threads: usize, work: impl FnOnce() -> T) -> T {
    if threads == 1 { with_threads(Threads::One, work) } else { work() }
}

/// Whether runs that begin on this thread keep to it.
pub(crate) fn alone() -> bool {
    ASKED.get() == Some(Threads::One)
}

/// Threads of this process that run a case or work beside one.
static BUSY: AtomicUsize = AtomicUsize::new(0);

/// One of them, as long as it lives.
pub(crate) struct Busy(());

impl Busy {
    pub(crate) fn new() -> Self {
        BUSY.fetch_add(1, Ordering::Relaxed);
        Self(())
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        BUSY.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Whether a core has nothing to do for this process.
fn is_one_free() -> bool {
    static CORES: OnceLock<usize> = OnceLock::new();
    BUSY.load(Ordering::Relaxed) < *CORES.get_or_init(all_threads)
}

/// Looks for what is awaited before a thread sleeps: about a millisecond.
const LOOKS: usize = 1000;
/// Looks after which others that wait for this core may run, and idle instructions before each of the rest: these leave the core to its other hardware thread.
const YIELDS: usize = 8;
const IDLE: usize = 32;
/// Longest time between two of them when nobody else runs on this core, by far: a second thread that has to leave it takes some 50 us.
const ELSEWHERE: Duration = Duration::from_micros(500);
/// How often others may run in between until a second thread is given up: where all cores are busy two threads take a fifth more of them than one.
const CROWDED: u32 = 2;

thread_local! {
    /// How often others ran while this thread waited.
    static DISPLACED: Cell<u32> = const { Cell::new(0) };
}

/// What comes next, awaited awake at first, while nobody else wants this core.
///
/// # Errors
/// Nothing will come.
pub fn receive<T>(from: &Receiver<T>) -> Result<T, RecvError> {
    let mut looked = Instant::now();
    for look in 0..LOOKS {
        match from.try_recv() {
            Ok(next) => return Ok(next),
            Err(TryRecvError::Disconnected) => return Err(RecvError),
            Err(TryRecvError::Empty) if look.is_multiple_of(YIELDS) => std::thread::yield_now(),
            Err(TryRecvError::Empty) => (0..IDLE).for_each(|_| std::hint::spin_loop()),
        }
        let before = std::mem::replace(&mut looked, Instant::now());
        if looked - before > ELSEWHERE {
            DISPLACED.set(DISPLACED.get().wrapping_add(1));
            break;
        }
    }
    from.recv()
}

/// Work, and the core of the thread that asks for it.
type Work = (Box<dyn FnOnce() + Send>, Option<usize>);

/// A thread that works beside that of its owner.
pub struct SecondThread {
    work: Sender<Work>,
    thread: JoinHandle<()>,
    /// How often its owner was displaced before.
    displaced: u32,
}

impl SecondThread {
    /// One on a core that is free, if there is one.
    #[must_use]
    pub fn spare() -> Option<Self> {
        let asked = ASKED.get();
        if !asked.map_or_else(is_one_free, |asked| asked != Threads::One) {
            return None;
        }
        let (work, come) = channel::<Work>();
        let (busy, owner) = (Busy::new(), this_core());
        let run = move || {
            let _busy = busy;
            leave(owner);
            while let Ok((work, core)) = receive(&come) {
                leave(core);
                work();
            }
        };
        let thread = std::thread::Builder::new().spawn(run).ok()?;
        // It can leave this core before there is work for it.
        std::thread::yield_now();
        let given_up = if asked == Some(Threads::GivenUp) { CROWDED } else { 0 };
        Some(Self { work, thread, displaced: DISPLACED.get().wrapping_sub(given_up) })
    }

    /// Has `work` done beside what the caller does next. Where the thread has ended nothing comes of it, which the caller learns as it waits for that.
    pub fn begin(&self, work: impl FnOnce() + Send + 'static) {
        let _ended = self.work.send((Box::new(work), this_core()));
    }

    /// Whether other processes want the core of its owner, who then better goes on alone.
    #[must_use]
    pub fn is_crowded(&self) -> bool {
        DISPLACED.get().wrapping_sub(self.displaced) >= CROWDED
    }

    /// Goes on here with the panic that ended the thread.
    pub fn panicked(self) -> ! {
        match self.thread.join() {
            Err(panic) => std::panic::resume_unwind(panic),
            Ok(()) => panic!("a second thread ended before its work"),
        }
    }
}

/// The core that this thread runs on, where that can be asked.
#[cfg(target_os = "linux")]
fn this_core() -> Option<usize> {
    Some(rustix::thread::sched_getcpu())
}

#[cfg(not(target_os = "linux"))]
const fn this_core() -> Option<usize> {
    None
}

/// Goes to another core where this thread runs on the one of its owner, on which Linux starts it: it would be moved some milliseconds later.
#[cfg(target_os = "linux")]
fn leave(core: Option<usize>) {
    use rustix::thread::{sched_getaffinity, sched_setaffinity};
    let Some(core) = core.filter(|_| core == this_core()) else { return };
    let Ok(all) = sched_getaffinity(None) else { return };
    let mut others = all;
    others.unset(core);
    // Where it may not go it stays. Then it may be moved anywhere again.
    let _refused = sched_setaffinity(None, &others);
    let _refused = sched_setaffinity(None, &all);
}

#[cfg(not(target_os = "linux"))]
const fn leave(_: Option<usize>) {}
