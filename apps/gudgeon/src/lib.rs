//! The Gudgeon command line, as a library so that a program with more models can be built from it: link the crates that
//! register them and call [`main`] (`examples/custom-model` does).
//!
//! Exit codes: 0 done, 1 the run failed, 2 the input is wrong.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod args;
mod cmd;
mod failure;
mod interrupt;
mod ui;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use gudgeon_core::Registry;

use args::{Args, Command};
use failure::Failure;
use ui::Ui;

/// Reads the command line of this process, does what it says, and tells how it went.
pub fn main() -> ExitCode {
    main_with(std::env::args_os())
}

/// As [`main`], with the words of a command line, the name of the program first.
pub fn main_with(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    gudgeon_models::link();
    interrupt::listen();
    let args = Args::parse_from(words);
    let ui = Ui::new(args.quiet());
    match dispatch(&args.command, &ui).and_then(|()| ui.end()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            ui.failure(&failure);
            failure.exit_code()
        }
    }
}

fn dispatch(command: &Command, ui: &Ui) -> Result<(), Failure> {
    let registry = Registry::collect();
    if let Err(all) = registry.verify() {
        return Err(Failure::Registry(all));
    }
    match command {
        Command::New(a) => cmd::new::new(a, ui),
        Command::Run(a) => cmd::run::run(a, ui),
        Command::Check(a) => cmd::check::check(a, ui),
        Command::Explain(a) => cmd::explain::explain(a, ui),
        Command::Models(a) => cmd::models::models(a, &registry, ui),
        Command::Describe(a) => cmd::describe::describe(a, &registry, ui),
        Command::Schema => cmd::schema::schema(ui),
        Command::Compare(a) => cmd::compare::compare(a, ui),
        Command::Bench(a) => cmd::bench::bench(a, ui),
        Command::Gradient(a) => cmd::gradient::gradient(a, ui),
        Command::Validate(a) => cmd::validate::validate(a, ui),
        Command::Study(a) => cmd::study::study(a, ui),
        Command::Report(a) => cmd::report::report(a, ui),
        Command::Completions(a) => {
            cmd::completions::completions(a.shell, ui);
            Ok(())
        }
        Command::Man(a) => cmd::man::man(a, ui),
    }
}
