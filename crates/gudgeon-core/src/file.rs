//! Reading of the files that a user names: regular files of a bounded size only.
//!
//! A pipe would be waited for without end and a device has none, so both are refused before they are opened. The sizes are far above
//! what a case or a measured trace has: they keep a wrong argument (a disk image, a log) from filling the memory.

use std::io::Read;
use std::path::Path;

/// Most bytes of a case file: 4 MiB.
pub const MOST_OF_A_CASE: u64 = 4 << 20;

/// Most bytes of any other file that a case names (tables, traces, profiles, shaft lines): 64 MiB.
pub const MOST_OF_A_TABLE: u64 = 64 << 20;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_a_bounded_size() {
        let folder = std::env::temp_dir().join(format!("gudgeon-read-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("the temporary folder can be written");
        let file = folder.join("x");
        let said = |most| read_text(&file, most).map_err(|e| e.to_string());
        assert!(said(9).is_err());
        std::fs::write(&file, "0123\n56789").expect("written");
        assert_eq!(said(10).as_deref(), Ok("0123\n56789"));
        assert!(said(9).is_err_and(|e| e.contains("too large")));
        std::fs::write(&file, b"ab\nc\xff").expect("written");
        assert_eq!(said(9), Err("it is not UTF-8 text (line 2, column 2)".into()));
        assert!(matches!(read_text(&folder, 9), Err(ReadError::Folder)));
        let _ = std::fs::remove_dir_all(&folder);
        #[cfg(unix)]
        assert!(matches!(read_bytes(Path::new("/dev/zero"), 9), Err(ReadError::Special)));
    }
}
