//! The program `gudgeon`; everything is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    gudgeon::main()
}
