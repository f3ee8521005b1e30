//! `gudgeon man [--out DIR]`

use std::fs;

use clap::{Command, CommandFactory};
use clap_mangen::{Man, generate_to};

use crate::args::{Args, ManArgs};
use crate::failure::Failure;
use crate::ui::Ui;

pub fn man(a: &ManArgs, ui: &Ui) -> Result<(), Failure> {
    // `gudgeon help run` is `gudgeon run --help` and needs no page.
    let program = Args::command().disable_help_subcommand(true);
    match &a.out {
        None => ui.out(&page(program)?),
        Some(dir) => {
            let cannot = |e| {
                Failure::argument(
                    format!("manual pages cannot go to `{}`: {e}", dir.display()),
                    "give a folder that can be written with `--out DIR`",
                )
            };
            fs::create_dir_all(dir).map_err(cannot)?;
            generate_to(program, dir).map_err(cannot)?;
            let first = dir.join("gudgeon.1");
            ui.out(&format!(
                "{}\n\n`man -l {}` reads it; each command has a page beside it",
                first.display(),
                first.display()
            ));
        }
    }
    Ok(())
}

/// The page of the program.
fn page(mut program: Command) -> Result<String, Failure> {
    program.build();
    let mut text = Vec::new();
    Man::new(program).render(&mut text).map_err(|e| Failure::Run(e.to_string()))?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
