//! Ctrl-C: the first one asks what is under way to end and to keep what is done, the second one ends the program.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

use gudgeon_scene::Stopped;
use signal_hook::{consts::SIGINT, flag};

static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Exit code of a program that Ctrl-C ended, as shells have it.
const KILLED: i32 = 130;

/// Listens for Ctrl-C, without a thread for it. Where that cannot be had, the first one ends the program, as it does without.
pub fn listen() {
    // In this order, so that the first one only asks.
    let _ = flag::register_conditional_shutdown(SIGINT, KILLED, Arc::clone(&ASKED))
        .and_then(|_| flag::register(SIGINT, Arc::clone(&ASKED)));
}

/// Whether work may go on.
///
/// # Errors
/// Ctrl-C was pressed.
pub fn check() -> Result<(), Stopped> {
    if ASKED.load(Ordering::Relaxed) { Err(Stopped) } else { Ok(()) }
}
