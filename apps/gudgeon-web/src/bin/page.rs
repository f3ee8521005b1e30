//! `gudgeon-web-page MODULE PACKED OUT`: puts the page together. MODULE is the WebAssembly file, PACKED the same compressed by gzip and written in
//! base64, OUT a folder.
//!
//! `index.html` reads `gudgeon.wasm` beside it from any web server; `gudgeon.html` holds it and opens from a folder too. The drawings are the
//! scripts of the report, as `gudgeon-report` has them.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs, io};

use gudgeon_report::{OVER_CYCLE, RUN_SCRIPTS, STYLE};

const INDEX: &str = include_str!("../../page/index.html");
const PAGE_STYLE: &str = include_str!("../../page/playground.css");
const WORKER: &str = include_str!("../../page/worker.js");
const SCRIPTS: [&str; 6] = [
    include_str!("../../page/engine.js"),
    include_str!("../../page/controls.js"),
    include_str!("../../page/editor.js"),
    include_str!("../../page/draw.js"),
    include_str!("../../page/results.js"),
    include_str!("../../page/app.js"),
];

fn main() -> ExitCode {
    let all: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [module, packed, out] = &all[..] else {
        return failed("usage: gudgeon-web-page MODULE PACKED OUT");
    };
    match write(module, packed, out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => failed(&e.to_string()),
    }
}

#[expect(clippy::print_stderr, reason = "a program of the build")]
fn failed(what: &str) -> ExitCode {
    eprintln!("{what}");
    ExitCode::FAILURE
}

fn write(module: &Path, packed: &Path, out: &Path) -> io::Result<()> {
    fs::create_dir_all(out)?;
    fs::copy(module, out.join("gudgeon.wasm"))?;
    fs::write(out.join("index.html"), page("'self'", ""))?;
    let element =
        format!("<script type=\"text/plain\" id=\"module\">{}</script>\n", fs::read_to_string(packed)?);
    fs::write(out.join("gudgeon.html"), page("'none'", &element))
}

/// The page, which may reach what `connect` says, with the module as an element where it holds it.
fn page(connect: &str, module: &str) -> String {
    // Placeholders are filled from the last to the first, so that nothing that was filled in is looked at again.
    let (head, rest) = split(INDEX, "{CONNECT}");
    let (style, rest) = split(rest, "{STYLE}");
    let (body, rest) = split(rest, "{WORKER}");
    let (after, rest) = split(rest, "{MODULE}");
    let (before, end) = split(rest, "{SCRIPTS}");
    let scripts = format!("\"use strict\";\n{}\n{}", drawings(), SCRIPTS.concat());
    [head, connect, style, STYLE, PAGE_STYLE, body, WORKER, after, module, before, &scripts, end].concat()
}

fn split<'a>(text: &'a str, at: &str) -> (&'a str, &'a str) {
    text.split_once(at).unwrap_or((text, ""))
}

/// The scripts of the report in a function of their own, which takes what they read from outside. Between the first, which has the crank angle that all
/// drawings share, and the others the angle is told to whoever draws again.
fn drawings() -> String {
    let (first, rest) = RUN_SCRIPTS.split_first().unwrap_or((&"", &[]));
    format!(
        "function reportScripts(document, location, addEventListener, scope) {{\nconst OVER_CYCLE = {};\n{first}\n{{ const Plain = Cycle; Cycle = class \
         extends Plain {{ constructor(...all) {{ super(...all); scope.cycle = this; }} }}; }}\n{}\n}}\n",
        OVER_CYCLE.trim_end(),
        rest.concat()
    )
}
