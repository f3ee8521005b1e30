//! Reading of the files that a user names: regular files of a bounded size only.
//!
//! A pipe would be waited for without end and a device has none, so both are refused before they are opened. The sizes are far above
//! what a case or a measured trace has: they keep a wrong argument (a disk image, a log) from filling the memory.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Most bytes of a case file: 4 MiB.
pub const MAX_CASE_BYTES: u64 = 4 << 20;

/// Most bytes of any other file that a case names (tables, traces, profiles, shaft lines): 64 MiB.
pub const MAX_TABLE_BYTES: u64 = 64 << 20;

/// Why a file was not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// A folder.
    #[error("it is a folder")]
    Folder,
    /// A pipe, a socket or a device.
    #[error("it is no regular file but a pipe, a socket or a device")]
    Special,
    /// More bytes than admitted.
    #[error("it is too large: more than {} MiB", .most >> 20)]
    TooLarge {
        /// Most bytes admitted.
        most: u64,
    },
    /// Not UTF-8.
    #[error("it is not UTF-8 text (line {line}, column {column})")]
    NotText {
        /// Line of the first wrong byte, from 1.
        line: usize,
        /// Column of it in characters, from 1.
        column: usize,
    },
    /// What the operating system said.
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

/// The content of a regular file of at most `most` bytes.
///
/// # Errors
/// Anything else.
pub fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, ReadError> {
    // Before it is opened: opening a pipe waits for somebody who writes.
    let kind = std::fs::metadata(path)?.file_type();
    if kind.is_dir() {
        return Err(ReadError::Folder);
    }
    if !kind.is_file() {
        return Err(ReadError::Special);
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(ReadError::TooLarge { most }) } else { Ok(bytes) }
}

/// The text of a regular file of at most `most` bytes.
///
/// # Errors
/// Anything else.
pub fn read_text(path: &Path, most: u64) -> Result<String, ReadError> {
    String::from_utf8(read_bytes(path, most)?).map_err(|e| {
        let valid = String::from_utf8_lossy(&e.as_bytes()[..e.utf8_error().valid_up_to()]);
        let line = valid.rsplit('\n').next().unwrap_or_default();
        ReadError::NotText { line: valid.matches('\n').count() + 1, column: line.chars().count() + 1 }
    })
}

/// The files that a case names, by the names it gives them: read from the folder of the case, or from what a run recorded of them.
///
/// Each file is read once and kept, so that a run that reads one twice sees one text, and its record can hold it. Clones share what was
/// read.
#[derive(Debug, Clone, Default)]
pub struct Files {
    store: Arc<Store>,
    /// What stands before a name: the folder of a case that another case names, from the folder of that one.
    below: String,
}

#[derive(Debug, Default)]
struct Store {
    folder: PathBuf,
    /// Whether only what is known may be read.
    recorded: bool,
    known: Mutex<BTreeMap<String, Arc<str>>>,
}

impl Files {
    /// The files of a folder.
    #[must_use]
    pub fn of(folder: &Path) -> Self {
        let store = Store { folder: folder.to_owned(), ..Store::default() };
        Self { store: Arc::new(store), below: String::new() }
    }

    /// Files that a run recorded, and no others.
    #[must_use]
    pub fn recorded(files: impl IntoIterator<Item = (String, String)>) -> Self {
        let known = files.into_iter().map(|(name, text)| (name, text.into())).collect();
        let store = Store { recorded: true, known: Mutex::new(known), ..Store::default() };
        Self { store: Arc::new(store), below: String::new() }
    }

    /// Names as a case gives them that is itself named `case` here.
    #[must_use]
    pub fn beside(&self, case: &str) -> Self {
        let folder = case.rfind('/').map_or("", |k| &case[..=k]);
        Self { store: Arc::clone(&self.store), below: format!("{}{folder}", self.below) }
    }

    /// Where a file lies, for messages.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        self.store.folder.join(format!("{}{name}", self.below))
    }

    /// The text of a file of at most [`MAX_TABLE_BYTES`] bytes. Bytes that are not UTF-8, as in comments of old programs, are replaced.
    ///
    /// # Errors
    /// A file that is no regular one, too large, or that the operating system or the record does not have.
    pub fn text(&self, name: &str) -> Result<Arc<str>, ReadError> {
        let key = format!("{}{name}", self.below);
        // What a panicking thread left is whole: entries are only ever added.
        let mut known = self.store.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(text) = known.get(&key) {
            return Ok(Arc::clone(text));
        }
        if self.store.recorded {
            let what = format!("the record of the run does not hold `{key}`");
            return Err(ReadError::Io(std::io::Error::new(std::io::ErrorKind::NotFound, what)));
        }
        let bytes = read_bytes(&self.path(name), MAX_TABLE_BYTES)?;
        let text: Arc<str> = String::from_utf8_lossy(&bytes).into();
        known.insert(key, Arc::clone(&text));
        Ok(text)
    }

    /// Everything that was read so far, by name.
    #[must_use]
    pub fn read_so_far(&self) -> BTreeMap<String, Arc<str>> {
        self.store.known.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Files of one place are the same files.
impl PartialEq for Files {
    fn eq(&self, other: &Self) -> bool {
        let place = |f: &Self| (f.store.folder.clone(), f.store.recorded, f.below.clone());
        place(self) == place(other)
    }
}

impl Eq for Files {}
