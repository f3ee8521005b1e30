//! What the host of the module calls: texts go through its memory.
//!
//! `initialise()` once; then, for each question, `allocate(n)`, `n` bytes of UTF-8 written there, `ask(n)`, which gives the length of the answer
//! that stands at `answer()`. A panic ends the module; its message then stands at `answer()`, `panicked()` bytes long.
// Exported names, the memory that the host writes, and the call of the constructors, which is unsafe to make twice.
#![expect(unsafe_code, reason = "the border between the module and its host")]

use std::cell::RefCell;

use crate::{Playground, answer as reply};

thread_local! {
    static PLAYGROUND: RefCell<Playground> = RefCell::default();
    static QUESTION: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

unsafe extern "C" {
    /// Written by the linker: runs all that other targets run before `main`, registrations among it.
    fn __wasm_call_ctors();
}

/// Runs the registrations. The host calls it once, before all else.
#[unsafe(no_mangle)]
pub extern "C" fn initialise() -> usize {
    // SAFETY: the host calls it once, and nothing has run before.
    unsafe { __wasm_call_ctors() }
    std::panic::set_hook(Box::new(|info| PANIC.with(|p| *p.borrow_mut() = info.to_string())));
    gudgeon_models::link()
}

/// Room for a question of `length` bytes.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(length: usize) -> *mut u8 {
    QUESTION.with(|q| {
        *q.borrow_mut() = vec![0; length];
        q.borrow_mut().as_mut_ptr()
    })
}

/// Answers the question that was written, and gives the length of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn ask() -> usize {
    let question = QUESTION.with(|q| String::from_utf8_lossy(&q.take()).into_owned());
    let text = PLAYGROUND.with(|p| reply(&mut p.borrow_mut(), &question));
    ANSWER.with(|a| {
        *a.borrow_mut() = text;
        a.borrow().len()
    })
}

/// Where the answer stands.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    ANSWER.with(|a| a.borrow().as_ptr())
}

/// Length of the message of a panic, which then stands at [`answer`]; 0 where there was none.
#[unsafe(no_mangle)]
pub extern "C" fn panicked() -> usize {
    let text = PANIC.with(RefCell::take);
    let length = text.len();
    ANSWER.with(|a| *a.borrow_mut() = text);
    length
}
