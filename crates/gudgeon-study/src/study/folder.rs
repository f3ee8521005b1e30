//! The folder of a study: made once, filled by anybody.

use std::collections::hash_map::RandomState;
use std::fs;
use std::hash::{BuildHasher, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use gudgeon_case::{Diagnostic, Document, Loaded, Origin, Report, load_document, read};
use gudgeon_scene::many::run_many;
use gudgeon_scene::{Checked, Progress, Stopped};
use serde::Serialize;

use super::FolderError;
use super::columnar::{about_parquet, to_parquet};
use super::file::StudyFile;
use super::part::{self, Row};
use super::points::Plan;
use super::record::Record;
use super::table::Table;

/// What a study runs.
const RECORD: &str = "study.json";
/// Where its rows are.
const PARTS: &str = "parts";
/// In the metadata of a part: the hash of its study, and how many of its rows have no result or not the one that was asked for.
const STUDY: &str = "study";
const FAILED: &str = "failed";
/// How many of its rows are machines that cannot be.
const LEFT_OUT: &str = "left_out";

/// A study that can be run: its folder, or its record alone where parts go elsewhere.
pub struct Study {
    dir: PathBuf,
    /// What is run.
    pub record: Record,
    /// Its points.
    pub plan: Plan,
}

/// The files of a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// Rows, as a Parquet file.
    pub rows: Vec<u8>,
    /// Series, as a Parquet file, where they were asked for.
    pub curves: Option<Vec<u8>>,
}

/// How far a study is.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Status {
    /// Points of the study.
    pub points: usize,
    /// Those that are done.
    pub done: usize,
    /// Of these, those without a result, or without the one that was asked for.
    pub failed: usize,
    /// Of these that are done, those left out because there is no such machine: an end gap that closes.
    pub left_out: usize,
    /// Part files of the study.
    pub parts: usize,
    /// Numbers of those that are missing.
    pub missing: Vec<usize>,
}

/// Some of the parts: the `k`-th of `n` jobs, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Job {
    /// Which job this is, 1 to `of`.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

impl Job {
    /// Everything.
    pub const ALL: Self = Self { number: 1, of: 1 };

    const fn has(self, part: usize) -> bool {
        part % self.of + 1 == self.number
    }
}

impl Study {
    /// Makes the folder of a study, or finds it made already.
    ///
    /// # Errors
    /// A study file that is wrong; a folder that holds another study.
    pub fn create(dir: &Path, file: &Path) -> Result<Self, FolderError> {
        let source = read(file)?;
        let document = Document::of(&source.text);
        if let (Some(place), None) = (document.place("scene"), document.place("cases")) {
            let d = Diagnostic::new("this is a case, not the file of a study").at(Origin::File, Some(place));
            let d = d.help("a study file names it in `cases` and says in `inputs` what is varied");
            return Err(Report::new(vec![d], Arc::new(source), Arc::from([])).into());
        }
        let loaded: Loaded<StudyFile> = load_document(source, document, &[])?;
        Self::keep(dir, super::prepare::prepare(&loaded)?)
    }

    /// Makes the folder of a record, or finds it made already.
    ///
    /// # Errors
    /// A folder that holds another study, or that cannot be written.
    pub fn keep(dir: &Path, record: Record) -> Result<Self, FolderError> {
        let path = dir.join(RECORD);
        if path.exists() {
            let there = Self::open(dir)?;
            if there.record.sha256 == record.sha256 {
                return Ok(there);
            }
            let what =
                format!("`{}` holds another study; name another folder, or remove this one", dir.display());
            return Err(FolderError::Folder(what));
        }
        let parts = dir.join(PARTS);
        fs::create_dir_all(&parts).map_err(FolderError::io("create", &parts))?;
        let text = serde_json::to_string_pretty(&record).unwrap_or_default() + "\n";
        put(&path, text.as_bytes())?;
        Self::of(dir, record)
    }

    /// Opens the folder of a study.
    ///
    /// # Errors
    /// A folder without a study, or one that was changed by hand.
    pub fn open(dir: &Path) -> Result<Self, FolderError> {
        let path = dir.join(RECORD);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                let what =
                    format!("`{}` holds no study: `gudgeon study new {0} FILE` makes one", dir.display());
                return Err(FolderError::Folder(what));
            }
            Err(_) if dir.is_file() => {
                let what = format!(
                    "`{}` is a file, not the folder of a study: `gudgeon study new DIR {0}` makes one of a study file",
                    dir.display()
                );
                return Err(FolderError::Folder(what));
            }
            Err(e) => return Err(FolderError::io("read", path)(e)),
        };
        Self::read(dir, &text)
    }

    /// A study from the text of its `study.json`, for workers that do not see the folder. Nothing is read from or written to `dir` by this.
    ///
    /// # Errors
    /// A text that is no record, or one whose hash is another.
    pub fn read(dir: &Path, text: &str) -> Result<Self, FolderError> {
        let damaged = |why: String| FolderError::Damaged { path: dir.join(RECORD), why };
        let record: Record = serde_json::from_str(text).map_err(|e| damaged(e.to_string()))?;
        if record.hash() != record.sha256 {
            return Err(damaged("it was changed: its hash is another".into()));
        }
        let own = env!("CARGO_PKG_VERSION");
        if record.gudgeon != own {
            let what = format!(
                "`{}` is a study of version {} of Gudgeon, and this is version {own}, whose digits may differ: make a new study",
                dir.display(),
                record.gudgeon
            );
            return Err(FolderError::Folder(what));
        }
        Self::of(dir, record)
    }

    fn of(dir: &Path, record: Record) -> Result<Self, FolderError> {
        let plan = Plan::new(&record.study, record.list.clone()).map_err(|e| {
            FolderError::Folder(e.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
        })?;
        Ok(Self { dir: dir.to_owned(), record, plan })
    }

    /// The folder.
    #[must_use]
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Number of part files.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.record.points.div_ceil(self.record.part)
    }

    /// Points of a part.
    fn points_of(&self, part: usize) -> std::ops::Range<usize> {
        part * self.record.part..((part + 1) * self.record.part).min(self.record.points)
    }

    /// File of a part.
    #[must_use]
    pub fn part_path(&self, part: usize) -> PathBuf {
        self.dir.join(PARTS).join(format!("part-{part:06}.parquet"))
    }

    /// File of the series of a part.
    #[must_use]
    pub fn curves_path(&self, part: usize) -> PathBuf {
        self.dir.join(PARTS).join(format!("curves-{part:06}.parquet"))
    }

    /// How many rows of a part failed and are left out, when the part is there and belongs to this study.
    fn failed_of(&self, part: usize) -> Option<(usize, usize)> {
        let about = about_parquet(&self.part_path(part)).ok()?;
        let curves = self.record.study.curves.is_empty() || self.curves_path(part).is_file();
        let own = about.get(STUDY) == Some(&self.record.sha256) && curves;
        let count = |key| about.get(key)?.parse().ok();
        count(FAILED).zip(count(LEFT_OUT)).filter(|_| own)
    }

    /// How far the study is.
    #[must_use]
    pub fn status(&self) -> Status {
        let mut status = Status { points: self.record.points, parts: self.parts(), ..Status::default() };
        for part in 0..self.parts() {
            match self.failed_of(part) {
                Some((failed, left_out)) => {
                    status.done += self.points_of(part).len();
                    status.failed += failed;
                    status.left_out += left_out;
                }
                None => status.missing.push(part),
            }
        }
        status
    }

    /// Runs the points of a part; nothing is written.
    ///
    /// # Errors
    /// A case that this program refuses, a stop.
    pub fn compute(
        &self,
        part: usize,
        threads: usize,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<Part, FolderError> {
        let cases = self.record.checked()?;
        let points: Vec<usize> = self.points_of(part).collect();
        let work = |k: usize, tell: &mut dyn FnMut(Progress) -> Result<(), Stopped>| {
            part::run_row(&self.record, &self.plan, &cases, points[k], tell)
        };
        let rows = run_many(points.len(), threads, work, progress).all()?;
        self.files(part, &rows.into_iter().collect::<Result<Vec<_>, _>>()?)
    }

    /// The files of a part from its rows.
    fn files(&self, part: usize, rows: &[Row]) -> Result<Part, FolderError> {
        let damaged = |e: parquet::errors::ParquetError| FolderError::Damaged {
            path: self.part_path(part),
            why: e.to_string(),
        };
        let marked = |mut table: Table| {
            table.about.insert(STUDY.into(), self.record.sha256.clone());
            table.about.insert(FAILED.into(), part::failed(rows).to_string());
            table.about.insert(LEFT_OUT.into(), part::left_out(rows).to_string());
            to_parquet(&table).map_err(damaged)
        };
        Ok(Part {
            rows: marked(part::table(&self.record, &self.plan, rows))?,
            curves: part::curves(&self.record, rows).map(marked).transpose()?,
        })
    }

    /// Puts a part into the folder.
    ///
    /// # Errors
    /// A file system that refuses.
    pub fn put(&self, part: usize, files: &Part) -> Result<(), FolderError> {
        // The rows come last: they say that the part is there.
        if let Some(curves) = &files.curves {
            put(&self.curves_path(part), curves)?;
        }
        put(&self.part_path(part), &files.rows)
    }

    /// Runs the parts of a job that are not there yet, on `threads` threads (0: one a core). A part is written when its last point is done;
    /// a stop loses the parts under way and keeps the rest.
    ///
    /// # Errors
    /// A case that this program refuses, a file system that refuses, a stop.
    pub fn run(
        &self,
        job: Job,
        threads: usize,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<Status, FolderError> {
        let cases = self.record.checked()?;
        let missing: Vec<usize> = self.status().missing.into_iter().filter(|p| job.has(*p)).collect();
        let filling = Filling::new(self, &cases, &missing);
        let mut heed = |p: Progress| if filling.is_broken() { Err(Stopped) } else { progress(p) };
        let out = run_many(filling.points.len(), threads, |k, tell| filling.point(k, tell), &mut heed);
        match filling.broken.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(e) => Err(e),
            None if out.stopped => Err(FolderError::Stopped),
            None => Ok(self.status()),
        }
    }
}

/// Parts that fill up.
struct Filling<'a> {
    study: &'a Study,
    cases: &'a [Checked],
    /// The place of its part in `parts`, and its number.
    points: Vec<(usize, usize)>,
    parts: Vec<(usize, Mutex<Vec<Row>>)>,
    /// Why no more can be written.
    broken: Mutex<Option<FolderError>>,
}

impl<'a> Filling<'a> {
    fn new(study: &'a Study, cases: &'a [Checked], missing: &[usize]) -> Self {
        let points = missing.iter().enumerate().flat_map(|(i, p)| study.points_of(*p).map(move |k| (i, k)));
        Self {
            study,
            cases,
            points: points.collect(),
            parts: missing.iter().map(|p| (*p, Mutex::default())).collect(),
            broken: Mutex::default(),
        }
    }

    fn is_broken(&self) -> bool {
        self.broken.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    /// Runs the `i`-th point; writes its part when it was the last one of it.
    fn point(&self, i: usize, tell: &mut dyn FnMut(Progress) -> Result<(), Stopped>) {
        let (place, k) = self.points[i];
        let Ok(row) = part::run_row(&self.study.record, &self.study.plan, self.cases, k, tell) else {
            return;
        };
        let (part, rows) = &self.parts[place];
        let whole = {
            let mut rows = rows.lock().unwrap_or_else(PoisonError::into_inner);
            rows.push(row);
            (rows.len() == self.study.points_of(*part).len()).then(|| std::mem::take(&mut *rows))
        };
        if let Some(mut rows) = whole {
            rows.sort_by_key(Row::point);
            let written = self.study.files(*part, &rows).and_then(|files| self.study.put(*part, &files));
            if let Err(e) = written {
                self.broken.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(e);
            }
        }
    }
}

/// Writes a file aside and renames it: it is there whole or not at all, whoever else writes it.
pub fn put(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    // Seeded anew by every process: two that write the same part do not meet.
    let aside = path.with_file_name(format!(".{name}.{:016x}", RandomState::new().build_hasher().finish()));
    let written = fs::File::create(&aside).and_then(|mut f| {
        std::io::Write::write_all(&mut f, bytes)?;
        f.sync_all()?;
        fs::rename(&aside, path)
    });
    written.map_err(|e| {
        let _ = fs::remove_file(&aside);
        FolderError::io("write", path)(e)
    })
}
