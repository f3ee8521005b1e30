//! Ctrl-C: the first one asks what is under way to end and to keep what is done, the second one ends the program.

use std::sync::atomic::{AtomicBool, Ordering};

use gudgeon_scene::Stopped;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Exit code of a program that Ctrl-C ended, as shells have it.
const KILLED: i32 = 130;

/// Listens for Ctrl-C. Where that cannot be had, the first one ends the program, as it does without.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            #[expect(clippy::exit, reason = "the user asked twice")]
            std::process::exit(KILLED);
        }
    });
}

/// Whether work may go on.
///
/// # Errors
/// Ctrl-C was pressed.
pub fn check() -> Result<(), Stopped> {
    if ASKED.load(Ordering::Relaxed) { Err(Stopped) } else { Ok(()) }
}
