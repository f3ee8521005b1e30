//! A folder of results that changes whole or not at all.
//!
//! New files are written into a folder of their own inside it. Then a journal says which of them take their places and which old ones
//! go; from there on the change is done, whatever happens: who opens the folder next finishes it. A lock keeps two runs from writing
//! one folder at a time. Files that Gudgeon did not write stay as they are.

use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::ReportError;

/// Files that are being written, and the journal once they are complete.
const PARTIAL: &str = ".gudgeon-partial";
/// Held by the run that writes the folder.
const LOCK: &str = ".gudgeon-lock";
/// What was written here last, and by what.
const MADE: &str = ".gudgeon.json";
/// In [`PARTIAL`]: what is left to do.
const JOURNAL: &str = ".journal";
/// Results that programs wrote before they left [`MADE`] behind.
const OLD: [&str; 8] = [
    "summary.json",
    "series.csv",
    "sweep.csv",
    "comparison.json",
    "comparison.csv",
    "bench.json",
    "bench.csv",
    "report.html",
];

/// What a folder of results holds.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Made {
    /// The case file as it was named; empty when the results did not come from a file.
    case: String,
    /// The files.
    files: BTreeSet<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Journal {
    put: BTreeSet<String>,
    remove: BTreeSet<String>,
}

/// A folder that this process writes.
#[derive(Debug)]
pub struct Folder {
    dir: PathBuf,
    lock: Option<File>,
    /// Folders that did not exist, the outermost first.
    created: Vec<PathBuf>,
    case: String,
    files: BTreeSet<String>,
}

impl Folder {
    /// Makes the folder where it does not exist, takes its lock, finishes what an interrupted run left and tries whether files can be
    /// written.
    ///
    /// # Errors
    /// A file system that refuses, or another run that writes the folder.
    pub fn open(dir: &Path) -> Result<Self, ReportError> {
        let missing = |d: &&Path| !d.as_os_str().is_empty() && !d.exists();
        let mut created: Vec<PathBuf> = dir.ancestors().take_while(missing).map(Path::to_owned).collect();
        created.reverse();
        fs::create_dir_all(dir).map_err(ReportError::io("create", dir))?;
        let mut folder =
            Self { dir: dir.to_owned(), lock: None, created, case: String::new(), files: BTreeSet::new() };
        folder.take_lock()?;
        folder.finish()?;
        let partial = folder.dir.join(PARTIAL);
        fs::create_dir(&partial).map_err(ReportError::io("create", &partial))?;
        Ok(folder)
    }

    fn take_lock(&mut self) -> Result<(), ReportError> {
        let path = self.dir.join(LOCK);
        let file = File::create(&path).map_err(ReportError::io("write", &path))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(ReportError::Busy { dir: self.dir.clone() }),
            // A file system without locks: two runs are not kept apart there.
            Err(TryLockError::Error(e)) if e.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(ReportError::io("lock", &path)(e)),
        }
        self.lock = Some(file);
        Ok(())
    }

    /// Finishes the change of an interrupted run whose files were complete, and throws away the files of one whose were not.
    fn finish(&self) -> Result<(), ReportError> {
        let partial = self.dir.join(PARTIAL);
        if let Ok(text) = fs::read(partial.join(JOURNAL))
            && let Ok(journal) = serde_json::from_slice::<Journal>(&text)
        {
            self.apply(&journal)?;
        }
        match fs::remove_dir_all(&partial) {
            Err(e) if e.kind() != ErrorKind::NotFound => Err(ReportError::io("remove", &partial)(e)),
            _ => Ok(()),
        }
    }

    /// Does what a journal says; what is done already is no error.
    fn apply(&self, journal: &Journal) -> Result<(), ReportError> {
        let gone = |r: std::io::Result<()>, what, path: &Path| match r {
            Err(e) if e.kind() != ErrorKind::NotFound => Err(ReportError::io(what, path)(e)),
            _ => Ok(()),
        };
        for name in &journal.remove {
            let path = self.dir.join(name);
            gone(fs::remove_file(&path), "remove", &path)?;
        }
        for name in &journal.put {
            let path = self.dir.join(name);
            gone(fs::rename(self.dir.join(PARTIAL).join(name), &path), "write", &path)?;
        }
        Ok(())
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.dir
    }

    /// The case whose results lie here, as its file was named; none where nothing lies or nobody said.
    #[must_use]
    pub fn case(&self) -> Option<String> {
        made(&self.dir).map(|m| m.case).filter(|c| !c.is_empty())
    }

    /// Names the case whose results will lie here.
    #[must_use]
    pub fn of_case(mut self, case: impl Into<String>) -> Self {
        self.case = case.into();
        self
    }

    /// Writes one file, apart from those that lie in the folder.
    pub(crate) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), ReportError> {
        let path = self.dir.join(PARTIAL).join(name);
        if self.dir.join(name).is_dir() {
            return Err(ReportError::io("write", self.dir.join(name))(ErrorKind::IsADirectory.into()));
        }
        self.files.insert(name.to_owned());
        fs::write(&path, bytes).map_err(ReportError::io("write", &path))
    }

    /// Puts the new files in place of everything that Gudgeon wrote here before.
    pub(crate) fn commit(self) -> Result<(), ReportError> {
        let before = made(&self.dir).map_or_else(|| OLD.map(str::to_owned).into(), |m| m.files);
        let remove = before.difference(&self.files).cloned().collect();
        let made = Made { case: self.case.clone(), files: self.files.clone() };
        self.settle(made, remove)
    }

    /// Puts the new files in place and leaves the others.
    pub(crate) fn commit_beside(self) -> Result<(), ReportError> {
        let mut made = made(&self.dir).unwrap_or_default();
        made.files.extend(self.files.iter().cloned());
        self.settle(made, BTreeSet::new())
    }

    fn settle(mut self, made: Made, remove: BTreeSet<String>) -> Result<(), ReportError> {
        let text = |v: serde_json::Result<String>| v.unwrap_or_default() + "\n";
        self.add(MADE, text(serde_json::to_string_pretty(&made)).as_bytes())?;
        let journal = Journal { put: std::mem::take(&mut self.files), remove };
        let partial = self.dir.join(PARTIAL);
        let (written, place) = (partial.join(".writing"), partial.join(JOURNAL));
        let bytes = text(serde_json::to_string(&journal));
        fs::write(&written, bytes).map_err(ReportError::io("write", &written))?;
        // From here on the change is done.
        fs::rename(&written, &place).map_err(ReportError::io("write", &place))?;
        self.created.clear();
        self.apply(&journal)?;
        // Nothing is left to do; a journal that will not go is followed once more, which does no harm.
        let _ = fs::remove_file(&place);
        Ok(())
    }
}

fn made(dir: &Path) -> Option<Made> {
    serde_json::from_slice(&fs::read(dir.join(MADE)).ok()?).ok()
}

/// Finishes what an interrupted run left in a folder that is about to be read.
pub(crate) fn settle(dir: &Path) -> Result<(), ReportError> {
    if dir.join(PARTIAL).exists() { Folder::open(dir).map(drop) } else { Ok(()) }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Nothing can be done about files that will not go, and the first error is the one to report.
        if self.lock.is_some() {
            if self.finish().is_ok() {
                let _ = fs::remove_file(self.dir.join(LOCK));
            }
            self.lock = None;
        }
        // Folders that were made for results that never came; those that hold something stay.
        for d in self.created.iter().rev() {
            let _ = fs::remove_dir(d);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(name: &str) -> PathBuf {
        let dir = std::env::temp_dir().join(format!("gudgeon-folder-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&dir);
        dir
    }

    fn names(dir: &Path) -> Vec<String> {
        let mut all: Vec<String> = fs::read_dir(dir)
            .expect("the folder")
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        all.sort();
        all
    }

    fn write(dir: &Path, case: &str, files: &[(&str, &str)]) {
        let mut f = Folder::open(dir).expect("opens").of_case(case);
        for (name, text) in files {
            f.add(name, text.as_bytes()).expect("written");
        }
        f.commit().expect("settles");
    }

    #[test]
    fn old_results_go_and_the_files_of_others_stay() {
        let dir = place("old");
        write(&dir, "a.toml", &[("summary.json", "1"), ("sweep.csv", "1")]);
        fs::write(dir.join("mine.txt"), "x").expect("written");
        write(&dir, "b.toml", &[("summary.json", "2")]);
        assert_eq!(names(&dir), [MADE, "mine.txt", "summary.json"]);
        assert_eq!(Folder::open(&dir).expect("opens").case().as_deref(), Some("b.toml"));
        let _ = fs::remove_dir_all(&dir);
    }

    #[test]
    fn a_folder_that_got_no_results_is_not_left_behind() {
        let dir = place("none");
        drop(Folder::open(&dir.join("a/b")).expect("opens"));
        assert!(!dir.exists());
    }

    #[test]
    fn one_run_at_a_time() {
        let dir = place("busy");
        let first = Folder::open(&dir).expect("opens");
        assert!(matches!(Folder::open(&dir), Err(ReportError::Busy { .. })));
        drop(first);
        assert!(!dir.exists());
    }

    /// An interruption is imitated at every point: before the journal nothing has changed, behind it everything has.
    #[test]
    fn an_interrupted_change_is_done_whole_or_not_at_all() {
        let dir = place("cut");
        write(&dir, "a.toml", &[("a", "old"), ("b", "old"), ("c", "old")]);
        let leave = |journal: bool, moved: bool| {
            let mut f = Folder::open(&dir).expect("opens");
            f.add("a", b"new").expect("written");
            f.add("b", b"new").expect("written");
            if journal {
                let j = r#"{"put":["a","b"],"remove":["c"]}"#;
                fs::write(dir.join(PARTIAL).join(JOURNAL), j).expect("written");
            }
            if moved {
                fs::rename(dir.join(PARTIAL).join("a"), dir.join("a")).expect("moved");
            }
            // Killed: the lock goes with the process, nothing else does.
            f.lock = None;
            f.created.clear();
            drop(f);
        };
        let read = |name: &str| fs::read_to_string(dir.join(name)).unwrap_or_default();
        leave(false, false);
        settle(&dir).expect("settles");
        assert_eq!([read("a"), read("b"), read("c")], ["old", "old", "old"]);
        leave(true, true);
        assert_eq!([read("a"), read("b")], ["new", "old"]);
        settle(&dir).expect("settles");
        assert_eq!([read("a"), read("b"), read("c")], ["new", "new", ""]);
        assert!(!dir.join(PARTIAL).exists() && !dir.join(LOCK).exists());
        let _ = fs::remove_dir_all(&dir);
    }
}
