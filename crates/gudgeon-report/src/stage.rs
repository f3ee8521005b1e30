//! Several files that appear together: all are written under temporary names first, then renamed.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::ReportError;

pub(crate) struct Stage {
    dir: PathBuf,
    /// `(temporary, final)`, in the order they are put in place.
    files: Vec<(PathBuf, PathBuf)>,
}

impl Stage {
    pub(crate) fn new(dir: &Path) -> Result<Self, ReportError> {
        fs::create_dir_all(dir).map_err(ReportError::io("create", dir))?;
        Ok(Self { dir: dir.to_path_buf(), files: Vec::new() })
    }

    /// Writes one file under its temporary name. The process id keeps two runs into one directory from sharing it.
    pub(crate) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), ReportError> {
        let temporary = self.dir.join(format!(".{name}.{}.partial", std::process::id()));
        // Listed before it is written, so that a write that fails half way is cleaned up too.
        self.files.push((temporary.clone(), self.dir.join(name)));
        File::create(&temporary)
            .and_then(|mut f| f.write_all(bytes))
            .map_err(ReportError::io("write", &temporary))
    }

    /// Puts every file in its place, in the order of [`Stage::add`].
    pub(crate) fn commit(mut self) -> Result<(), ReportError> {
        for (temporary, place) in &self.files {
            fs::rename(temporary, place).map_err(ReportError::io("write", place))?;
        }
        self.files.clear();
        Ok(())
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        for (temporary, _) in &self.files {
            // Nothing can be done about a temporary file that will not go, and the first error is the one to report.
            let _ = fs::remove_file(temporary);
        }
    }
}
