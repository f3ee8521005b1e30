//! The `gudgeon` program with the plug-ins of this crate added.

use std::process::ExitCode;

fn main() -> ExitCode {
    // A crate that no code names is not linked, and its models would be missing.
    extensions::link();
    gudgeon::main()
}
