//! The `gudgeon` program with the models of this crate added.

use std::process::ExitCode;

// A crate that no code names is not linked, and its models would be missing.
use custom_model as _;

fn main() -> ExitCode {
    gudgeon::main()
}
