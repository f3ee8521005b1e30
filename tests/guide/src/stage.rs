//! The tree that mdBook builds: the sources of the guide, and the documents and files of the repository that they link to.
//!
//! In the repository a page links to `../../../ARCHITECTURE.md`, which a forge shows. A book holds nothing outside its sources, so all that is linked
//! is copied to `repository/`, in its own folders, and the links of the guide lead there. Citations become links to the list of works.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::markdown::links;
use crate::{Outcome, files, read, relative, root, source, tidy, write};

/// Where the repository stands in the book.
const COPY: &str = "repository";

/// Copies the sources and what they link to; the number of files that came from the rest of the repository.
///
/// # Errors
/// A file that cannot be read or written.
pub fn stage(to: &Path) -> Outcome<usize> {
    let _ = std::fs::remove_dir_all(to);
    let mut wanted = BTreeSet::new();
    for file in files(&source(), "")? {
        let target = to.join(relative(&source(), &file));
        if file.extension().is_some_and(|e| e == "md") {
            write(&target, &page(&file, &read(&file)?, &mut wanted))?;
        } else {
            copy(&file, &target)?;
        }
    }
    let copied = follow(wanted, to)?;
    let contents = to.join("SUMMARY.md");
    write(&contents, &(read(&contents)? + &chapters(&copied)))?;
    Ok(copied.len())
}

fn copy(from: &Path, to: &Path) -> Outcome<()> {
    if let Some(folder) = to.parent() {
        std::fs::create_dir_all(folder).map_err(|e| e.to_string())?;
    }
    std::fs::copy(from, to).map(|_| ()).map_err(|e| format!("{}: {e}", from.display()))
}

/// Copies the files of the repository, and all that documents among them link to.
fn follow(mut wanted: BTreeSet<PathBuf>, to: &Path) -> Outcome<BTreeSet<PathBuf>> {
    let mut done = BTreeSet::new();
    while let Some(file) = wanted.pop_first() {
        if !done.insert(file.clone()) {
            continue;
        }
        let target = to.join(COPY).join(relative(&root(), &file));
        if file.extension().is_some_and(|e| e == "md") {
            write(&target, &document(&file, &read(&file)?, &mut wanted))?;
        } else {
            copy(&file, &target)?;
        }
    }
    Ok(done)
}

/// A page of the guide: links out of it lead to the copy.
fn page(file: &Path, text: &str, wanted: &mut BTreeSet<PathBuf>) -> String {
    let here = file.parent().unwrap_or(file).to_owned();
    let text = relinked(text, &mut |target| {
        let (path, anchor) = split(target);
        let to = tidy(&here.join(path));
        if path.is_empty() || to.starts_with(source()) || !to.is_file() {
            return Some(target.to_owned());
        }
        let copied = source().join(COPY).join(relative(&root(), &to));
        wanted.insert(to);
        Some(relative(&here, &copied) + anchor)
    });
    cited(&text, &relative(&here, &source().join("reference/works.md")))
}

/// A document of the repository: its links stay, those to folders become text, and what it links to is copied too.
fn document(file: &Path, text: &str, wanted: &mut BTreeSet<PathBuf>) -> String {
    let here = file.parent().unwrap_or(file).to_owned();
    relinked(text, &mut |target| {
        let (path, anchor) = split(target);
        let to = tidy(&here.join(path));
        if target.contains("://") || path.is_empty() {
            return Some(target.to_owned());
        }
        if to.starts_with(source()) {
            let copy = source().join(COPY).join(relative(&root(), &here));
            return Some(relative(&copy, &to) + anchor);
        }
        to.is_file().then(|| {
            wanted.insert(to);
            target.to_owned()
        })
    })
}

fn split(target: &str) -> (&str, &str) {
    target.find('#').map_or((target, ""), |at| target.split_at(at))
}

/// A page whose links are what `change` says; none: the text of the link alone.
fn relinked(text: &str, change: &mut dyn FnMut(&str) -> Option<String>) -> String {
    let found = links(text);
    let mut out = Vec::new();
    for (n, line) in text.lines().enumerate() {
        let mut line = line.to_owned();
        for link in found.iter().rev().filter(|l| l.line == n + 1) {
            match change(&link.target) {
                Some(target) => line.replace_range(link.span.0..link.span.1, &target),
                None => {
                    line.replace_range(link.span.0 - 1..=link.span.1, "");
                    let open = line[..link.span.0 - 2].rfind('[').unwrap_or(0);
                    line.replace_range(link.span.0 - 2..link.span.0 - 1, "");
                    line.replace_range(open..=open, "");
                }
            }
        }
        out.push(line);
    }
    out.join("\n") + "\n"
}

/// `[@key]` as a link to the list of works.
fn cited(text: &str, works: &str) -> String {
    let mut out = String::new();
    for (n, part) in text.split("[@").enumerate() {
        match part.split_once(']') {
            Some((key, rest)) if n > 0 && !key.contains(char::is_whitespace) => {
                out += &format!("[{key}]({works}#{key}){rest}");
            }
            _ => {
                out += if n > 0 { "[@" } else { "" };
                out += part;
            }
        }
    }
    out
}

/// Chapters of the documents that were copied.
fn chapters(copied: &BTreeSet<PathBuf>) -> String {
    let mut s = "\n# Documents of the repository\n\n".to_owned();
    for file in copied.iter().filter(|f| f.extension().is_some_and(|e| e == "md")) {
        let path = relative(&root(), file);
        let text = read(file).unwrap_or_default();
        let title = text.lines().find_map(|l| l.strip_prefix("# ")).unwrap_or(&path).to_owned();
        s += &format!("- [{title}]({COPY}/{path})\n");
    }
    s
}
