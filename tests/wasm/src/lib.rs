//! The list of everything that is registered, for the host of a WebAssembly module: `initialise()` once, then `registered()` bytes of
//! UTF-8 stand at `text()`.
#![cfg(target_family = "wasm")]
// Exported names, and the call of the constructors, which is unsafe to make twice.
#![expect(unsafe_code, reason = "exported names; the call of the constructors")]

use std::sync::OnceLock;

static TEXT: OnceLock<String> = OnceLock::new();

unsafe extern "C" {
    /// Written by the linker: runs all that other targets run before `main`, registrations among it.
    fn __wasm_call_ctors();
}

/// Runs the registrations. The host calls it once, before all else.
#[unsafe(no_mangle)]
pub extern "C" fn initialise() {
    // SAFETY: the host calls it once, and nothing has run before.
    unsafe { __wasm_call_ctors() }
}

/// Length of the list \[bytes\].
#[unsafe(no_mangle)]
pub extern "C" fn registered() -> usize {
    list().len()
}

/// Where the list stands in the memory of the module.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    list().as_ptr()
}

/// How many models and scenes the crates say they register.
#[unsafe(no_mangle)]
pub extern "C" fn linked() -> usize {
    gudgeon_models::link()
}

fn list() -> &'static str {
    TEXT.get_or_init(gudgeon_models::registered)
}
