//! The loader against cases that nobody would write: shipped ones with parts exchanged, cut, doubled or replaced, and plain noise. Nothing
//! may panic; what is refused has mistakes that can be rendered, bounded in number; all of it in bounded time.
//!
//! Deterministic: the same mutations every time.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use gudgeon_case::{MAX_MISTAKES, Source};
use gudgeon_core::file::Files;

/// A small generator (xorshift) of its own: a mutation must be the same on every machine.
struct Dice(u64);
impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }
    fn below(&mut self, n: usize) -> usize {
        (self.roll() % n.max(1) as u64) as usize
    }
    fn of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.below(all.len())]
    }
}

/// Pieces that mean something to the parser, the units, the schema.
const PIECES: &[&str] = &[
    "=",
    "\"",
    "[",
    "]]",
    "{ ",
    "}",
    "\n",
    "#",
    "'''",
    "\\",
    "\u{0}",
    "µ",
    "\u{3bc}m",
    "−",
    ",5",
    "1e999",
    "-0",
    "nan",
    "inf",
    "99999999999999999999",
    "0x",
    "1979-05-27",
    "true",
    "\"\"",
    "[]",
    "{}",
    "model = \"off\"\n",
    "[a.b.c]\n",
    "[[rings]]\n",
    "a.b = 1\n",
    "model = \"no such\"\n",
    " mm",
    " bar",
    "°C",
    ".",
    "_",
    "\r\n",
    "scene = \"rig\"\n",
    "\u{feff}",
];

fn mutated(text: &str, dice: &mut Dice) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..=dice.below(4) {
        let at = dice.below(lines.len());
        match dice.below(7) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[at].clone()),
            2 => {
                let other = dice.below(lines.len());
                lines.swap(at, other);
            }
            3 => lines.truncate(at + 1),
            // A value for another one.
            4 => {
                let other = lines[dice.below(lines.len())].clone();
                if let (Some((key, _)), Some((_, value))) =
                    (lines[at].clone().split_once('='), other.split_once('='))
                {
                    lines[at] = format!("{key}={value}");
                }
            }
            _ => {
                let line = &lines[at];
                let places: Vec<usize> = line.char_indices().map(|(i, _)| i).chain([line.len()]).collect();
                let (a, b) = (places[dice.below(places.len())], places[dice.below(places.len())]);
                let (a, b) = (a.min(b), a.max(b).min(a.min(b) + 8).max(a.min(b)));
                let b = (b..=line.len()).find(|i| line.is_char_boundary(*i)).unwrap_or(line.len());
                lines[at] = format!("{}{}{}", &line[..a], dice.of(PIECES), &line[b..]);
            }
        }
        if lines.is_empty() {
            lines.push(String::new());
        }
    }
    lines.join("\n")
}

fn noise(dice: &mut Dice) -> String {
    let pieces = dice.below(60);
    let byte = |dice: &mut Dice| char::from(dice.below(128) as u8).to_string();
    (0..pieces).map(|k| if k % 3 == 0 { byte(dice) } else { dice.of(PIECES).to_owned() }).collect()
}

fn cases() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases");
    let mut all = Vec::new();
    for folder in [root.clone(), root.join("rigs")] {
        let entries = std::fs::read_dir(&folder).expect("the cases are in the repository");
        for path in entries.map(|e| e.expect("readable").path()) {
            if path.extension().is_some_and(|e| e == "toml") {
                let text = std::fs::read_to_string(&path).expect("a case is text");
                all.push((path, text));
            }
        }
    }
    all.sort();
    all
}

/// Whether a text was read; what was wrong must be tellable.
fn read(name: &str, text: String, overrides: &[String], slowest: &mut (Duration, String)) -> bool {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases");
    let begin = Instant::now();
    let outcome =
        gudgeon_scene::load(Source { name: name.to_owned(), text, files: Files::of(&folder) }, overrides);
    if let Err(report) = &outcome {
        assert!(!report.diagnostics.is_empty() && report.diagnostics.len() <= MAX_MISTAKES, "{name}");
        let told = report.render(false);
        assert!(!told.is_empty() && report.diagnostics.iter().all(|d| !d.message.is_empty()), "{name}");
        for word in ["u32", "f64", "usize", "invalid type", "untagged", "struct "] {
            assert!(!report.diagnostics.iter().any(|d| d.message.contains(word)), "{name}: {told}");
        }
    }
    let took = begin.elapsed();
    if took > slowest.0 {
        *slowest = (took, name.to_owned());
    }
    outcome.is_ok()
}

#[test]
fn no_text_brings_the_loader_down() {
    let mut dice = Dice(0x9e37_79b9_7f4a_7c15);
    let mut slowest = (Duration::ZERO, String::new());
    let (mut right, mut all) = (0, 0);
    for (path, text) in cases() {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        for k in 0..9 {
            let case = format!("{name}, mutation {k}");
            right += usize::from(read(&case, mutated(&text, &mut dice), &[], &mut slowest));
            all += 1;
        }
        for k in 0..2 {
            let piece = |dice: &mut Dice| dice.of(PIECES).to_owned();
            let line = text.lines().nth(dice.below(text.lines().count())).unwrap_or_default().to_owned();
            let set = [line, format!("models.x={}", piece(&mut dice)), piece(&mut dice)];
            read(&format!("{name}, overrides {k}"), text.clone(), &set[dice.below(3)..], &mut slowest);
        }
    }
    for k in 0..200 {
        read(&format!("noise {k}"), noise(&mut dice), &[], &mut slowest);
    }
    // Some mutations change nothing that matters and most do: both sides of the loader were met.
    assert!(all > 500 && right > all / 20 && right < all * 19 / 20, "{right} of {all} read");
    // A case is read in milliseconds; the bound is for a busy machine without optimisation.
    assert!(slowest.0 < Duration::from_secs(5), "{}: {:?}", slowest.1, slowest.0);
}
