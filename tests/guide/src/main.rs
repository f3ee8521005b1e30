//! `gudgeon-guide`: writes the generated pages of the guide, checks it, runs its commands, and prepares the tree that mdBook builds.

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use gudgeon_guide::commands::{self, Programs};
use gudgeon_guide::reference::Facts;
use gudgeon_guide::{Outcome, benches, check, html, source, stage, write};

const USAGE: &str = "\
Usage: gudgeon-guide write [--pages]   writes docs/guide/src/reference and its figures; --pages: without figures
       gudgeon-guide check             tells what is stale and which links lead nowhere
       gudgeon-guide run [PAGE...]     runs the commands of the guide
       gudgeon-guide stage DIR         copies the sources and what they link to, for mdBook
       gudgeon-guide links DIR         tells which links of a built book lead nowhere
       gudgeon-guide gudgeon ...       the program itself";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let told = match words.split_first() {
        Some((&"gudgeon", _)) => return gudgeon::main_with(std::env::args_os().skip(1)),
        Some((&"write", rest)) => written(rest.is_empty()),
        Some((&"check", [])) => checked(),
        Some((&"run", pages)) => run(pages),
        Some((&"stage", [to])) => stage::stage(Path::new(to)).map(|n| format!("{n} files of the repository")),
        Some((&"links", [book])) => book_links(Path::new(book)),
        _ => Err(USAGE.into()),
    };
    match told {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(text) => {
            eprintln!("{text}");
            ExitCode::FAILURE
        }
    }
}

fn written(with_figures: bool) -> Outcome<String> {
    let facts = Facts::collect()?;
    let pages = facts.pages()?;
    let _ = std::fs::remove_dir_all(source().join("reference/models"));
    let _ = std::fs::remove_dir_all(source().join("reference/kinds"));
    for (path, text) in &pages {
        write(&source().join(path), text)?;
    }
    if with_figures {
        for (file, svg) in benches::draw(facts.benches())? {
            write(&benches::place(&file), &svg)?;
        }
    }
    Ok(format!("{} pages, {} figures", pages.len(), facts.benches().len()))
}

fn checked() -> Outcome<String> {
    let facts = Facts::collect()?;
    let mut wrong = check::stale(&facts.pages()?)?;
    wrong.extend(check::stale_figures(&facts)?);
    wrong.extend(check::broken()?);
    if wrong.is_empty() {
        Ok("the guide is fresh, and every link leads somewhere".into())
    } else {
        Err(wrong.join("\n"))
    }
}

fn run(pages: &[&str]) -> Outcome<String> {
    let own = std::env::current_exe().map_err(|e| e.to_string())?;
    let programs = Programs { extended: own.with_file_name("examples/extended"), gudgeon: own };
    let pages: Vec<PathBuf> =
        if pages.is_empty() { commands::pages()? } else { pages.iter().map(|p| source().join(p)).collect() };
    let ran = commands::run(&pages, &programs, &std::env::temp_dir().join("gudgeon-guide"))?;
    if !ran.wrong.is_empty() {
        return Err(ran.wrong.join("\n\n"));
    }
    let seconds: Vec<String> = ran.seconds.iter().map(|(s, page)| format!("{s:.1} s {page}")).collect();
    Ok(format!("{} commands, {} outputs as stated\n{}", ran.commands, ran.outputs, seconds.join("\n")))
}

fn book_links(book: &Path) -> Outcome<String> {
    let (count, wrong) = html::broken(book)?;
    if wrong.is_empty() { Ok(format!("{count} links, none broken")) } else { Err(wrong.join("\n")) }
}
