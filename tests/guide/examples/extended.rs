//! `gudgeon` with the models of `examples/extensions`: what a reader has who built that example.

use std::process::ExitCode;

fn main() -> ExitCode {
    extensions::link();
    gudgeon::main()
}
