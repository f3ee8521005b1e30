//! What a run produces, independent of how it is written: the interface between the simulation and the report.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod difference;
mod gradients;
mod overview;
mod shares;
mod swap;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use difference::{Confidence, Difference, change};
pub use gradients::{Gradient, GradientInput, Gradients, derivative_unit};
pub use overview::{Assessment, Grade, Headline, VERDICT};
pub use shares::{CASE, Share, ShareRow, ShareTable};
pub use swap::short_value;

/// A result value.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// The number, in `unit`.
    pub value: f64,
    /// The unit, as a person writes it.
    pub unit: String,
    /// One line saying what it is.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub what: String,
}

/// How much a [`Note`] matters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoteLevel {
    /// Good to know.
    #[default]
    Info,
    /// A floor, a cap, a limit of validity or a fallback acted. The results are what was asked for, with that in mind.
    Caution,
    /// A limit that the case declares is not kept: the results are what was asked for, and what they describe is not.
    Exceeded,
    /// The results are not what was asked for (a cycle that is not periodic): they are written and marked, and the run fails.
    Failure,
}

/// Something that a person who relies on the results must know, with how much and how long.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// Stable key, with the subject in it where there are several: `contact_floor.ring2`. Runs of a sweep are gathered by it.
    pub topic: String,
    /// How much it matters.
    pub level: NoteLevel,
    /// One sentence with the figures.
    pub text: String,
    /// Whether it is about numerics alone: a drag, a floor or a tolerance that stands for no physics. Such notes come behind the others.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub numerical: bool,
    /// The figures: share of the cycle, residual load.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub amounts: IndexMap<String, Value>,
}

impl Note {
    fn new(level: NoteLevel, topic: impl Into<String>, text: impl Into<String>) -> Self {
        Self { topic: topic.into(), level, text: text.into(), ..Self::default() }
    }

    /// Good to know.
    #[must_use]
    pub fn info(topic: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(NoteLevel::Info, topic, text)
    }

    /// A floor, a cap, a limit of validity or a fallback acted.
    #[must_use]
    pub fn caution(topic: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(NoteLevel::Caution, topic, text)
    }

    /// A limit of the case is not kept.
    #[must_use]
    pub fn exceeded(topic: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(NoteLevel::Exceeded, topic, text)
    }

    /// The results are not what was asked for.
    #[must_use]
    pub fn failure(topic: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(NoteLevel::Failure, topic, text)
    }

    /// The same, about numerics alone.
    #[must_use]
    pub fn of_numerics(mut self) -> Self {
        self.numerical = true;
        self
    }

    /// Adds a figure.
    #[must_use]
    pub fn amount(mut self, name: impl Into<String>, value: f64, unit: &str) -> Self {
        let what = String::new();
        self.amounts.insert(name.into(), Value { value, unit: unit.into(), what });
        self
    }
}

/// [`Failure::code`] of an input that is wrong.
pub const REFUSED: &str = "refused";
/// [`Failure::code`] of values that can be read, of a machine that cannot be: an end gap that closes. Where many values are run, such a point is left out
/// and told with its reason; the others are what was asked for.
pub const IMPOSSIBLE: &str = "impossible";

/// Why a case has no result.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// A word to tell failures apart by: [`REFUSED`] (the input is wrong), [`IMPOSSIBLE`] (there is no such machine), `model`, `integration`, `not_a_number`, `scene`, `stopped`.
    pub code: String,
    /// What is wrong, in one line.
    pub message: String,
    /// Path of the input that is wrong, `rings.0.cold_gap`; empty where none is to blame.
    pub path: String,
}

/// A model that ran.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelUse {
    /// Its kind.
    pub kind: String,
    /// Its name.
    pub model: String,
    /// Keys into `REFERENCES.bib`.
    pub references: Vec<String>,
}

/// Something that was not built or not evaluated, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Skipped {
    /// What.
    pub what: String,
    /// Why.
    pub why: String,
}

/// Relative closure per cycle; absent where the scene has no such balance.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Gas mass: (in - out - stored) / throughput, or what the lands hold where that is more.
    pub gas_mass: Option<f64>,
    /// Oil mass of films.
    pub oil_mass: Option<f64>,
    /// Oil on ring flanks: (in - out - stored) / what is fed, or what they hold where that is more.
    #[serde(default)]
    pub flank_oil: Option<f64>,
    /// Oil in the gaps of the skirt: (in - out - stored) / (in + stored before).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skirt_oil: Option<f64>,
    /// Work of all forces on the rings less the change of their kinetic energy, by the sum of the magnitudes.
    pub energy: Option<f64>,
    /// Impulse of all forces on the rings less the change of their momentum, by the sum of the magnitudes.
    pub momentum: Option<f64>,
    /// Energy of the gas: (brought - heat - work - stored) / most that was held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gas_energy: Option<f64>,
}

/// Work done by the solver.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SolverReport {
    /// Solver name.
    pub method: String,
    /// Counters, by name: `steps`, `rejected`, `rhs`, `jacobians`, `film_evaluations`, `cycles`, `events`, `states`.
    pub counters: IndexMap<String, u64>,
    /// Several periodic solutions, a period-2 cycle, a fallback that was used.
    pub notes: Vec<Note>,
}

/// Name of the axis of a [`Series`] over the crank angle.
pub const CRANK_ANGLE: &str = "theta";

/// One column of a series.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// `ring1.h_min`, `land2.p`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One value per row.
    pub values: Vec<f64>,
}

/// Columns over a common axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// What the rows are at: `theta` \[deg\] over a cycle, `x` \[m\] along a film, `t` \[s\].
    pub axis: Column,
    /// Columns, as long as the axis.
    pub columns: Vec<Column>,
}

/// No rows, over the crank angle.
impl Default for Series {
    fn default() -> Self {
        Self::over_cycle(Vec::new(), Vec::new())
    }
}

impl Series {
    /// A series over the crank angle \[deg\].
    #[must_use]
    pub fn over_cycle(theta_deg: Vec<f64>, columns: Vec<Column>) -> Self {
        Self { axis: Column { name: CRANK_ANGLE.into(), unit: "deg".into(), values: theta_deg }, columns }
    }

    /// Whether the rows are crank angles.
    #[must_use]
    pub fn is_over_cycle(&self) -> bool {
        self.axis.name == CRANK_ANGLE
    }

    /// One column by name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name == name)
    }
}

/// Something that happened at a crank angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Crank angle \[deg\].
    pub theta_deg: f64,
    /// `ring1`, `land2`.
    pub subject: String,
    /// `seats on the lower flank`, `leaves the upper flank`, `highest pressure`.
    pub what: String,
}

/// One periodic solution among several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Branch {
    /// How it was reached: `all lands at 1 bar`.
    pub start: String,
    /// 1 for a periodic cycle, 2 when it repeats every second one, 0 when it did not settle.
    pub period: u32,
    /// Its results.
    pub results: IndexMap<String, Value>,
}

/// One ring of a [`PackSection`], all lengths in metres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SectionRing {
    /// Axial thickness.
    pub height: f64,
    /// Radial width.
    pub width: f64,
    /// Distance of the groove's lower edge below the crown of the section.
    pub groove_bottom: f64,
    /// Axial groove height.
    pub groove_height: f64,
    /// Radial groove depth.
    pub groove_depth: f64,
    /// Mean axial clearance.
    pub clearance: f64,
    /// Drop of the running face at equal spacings, bottom edge first.
    pub face_drop: Vec<f64>,
    /// Axial length of the running face.
    pub face_length: f64,
    /// Number of running lands or rails.
    pub lands: usize,
}

/// Geometry of a ring pack for drawing its section.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PackSection {
    /// Bore radius.
    pub bore_radius: f64,
    /// Height of the top land.
    pub top_land: f64,
    /// Axial length of the drawn piston.
    pub length: f64,
    /// Stroke.
    pub stroke: f64,
    /// Rings, crown first.
    pub rings: Vec<SectionRing>,
}

/// A drawing of columns of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// What it shows.
    pub title: String,
    /// One line of explanation.
    #[serde(default)]
    pub hint: String,
    /// The table it reads: `series`, or a key of [`RunResult::tables`]; empty when it holds all it shows.
    #[serde(default)]
    pub table: String,
    /// How it is drawn.
    pub kind: FigureKind,
}

/// Kinds of [`Figure`]. Columns are named; the axis of the table by its own name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FigureKind {
    /// Curves over one column.
    Lines(Lines),
    /// Colours over a rectangular grid, one row per point; rows of equal `y` follow each other.
    Map {
        /// Column along the abscissa.
        x: String,
        /// Column along the ordinate.
        y: String,
        /// Column shown as colour.
        value: String,
        /// Places that are marked: points with a reservation, points without a result.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        marks: Vec<Mark>,
    },
    /// Line spectra one above the other.
    Waterfall(Waterfall),
    /// Something drawn to scale, still or moving. Reads no table.
    Drawing {
        /// Whether all frames are seen at once, side by side.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        apart: bool,
        /// What all frames show.
        fixed: Vec<Shape>,
        /// What changes; several frames are shown one after the other.
        frames: Vec<Frame>,
    },
    /// Labelled bars. Reads no table.
    Bars {
        /// Unit of the values, empty for a ratio.
        unit: String,
        /// The bars, from above.
        bars: Vec<Bar>,
    },
    /// Numbers in rows and columns. Reads no table.
    Table {
        /// What stands above the labels of the rows.
        rows_are: String,
        /// Name and unit of each column.
        columns: Vec<(String, String)>,
        /// Label of each row and its numbers; none where there is nothing to tell.
        rows: Vec<(String, Vec<Option<f64>>)>,
        /// Columns of text behind the numbers: name, and a text for each row.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        texts: Vec<(String, Vec<String>)>,
        /// Numbers beyond it are marked.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        limit: Option<f64>,
    },
    /// Labelled ranges: the swings of a tornado plot around a middle, or values with their intervals. Reads no table.
    Ranges {
        /// Unit of the values, empty for a ratio.
        unit: String,
        /// The value that swings go out from; none where every range has a value of its own.
        middle: Option<f64>,
        /// The ranges, from above.
        ranges: Vec<Range>,
    },
}

impl FigureKind {
    /// Columns of its table that it reads.
    #[must_use]
    pub fn columns(&self) -> Vec<&str> {
        match self {
            Self::Lines(l) => {
                let curves = l.lines.iter().chain(&l.rays).chain(&l.over).map(|c| &c.1);
                std::iter::once(&l.x).chain(&l.own_x).chain(curves).map(String::as_str).collect()
            }
            Self::Map { x, y, value, .. } => vec![x, y, value],
            Self::Waterfall(w) => {
                let spectra = w.spectra.iter().map(|s| &s.1);
                w.x.iter().chain([&w.y]).chain(spectra).map(String::as_str).collect()
            }
            Self::Drawing { .. } | Self::Bars { .. } | Self::Table { .. } | Self::Ranges { .. } => Vec::new(),
        }
    }
}

/// Curves of columns over another one.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Lines {
    /// Column along the abscissa.
    pub x: String,
    /// Label and column of each curve. Curves share a unit.
    pub lines: Vec<(String, String)>,
    /// Label and column of the envelope of the curves, drawn over them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<(String, String)>,
    /// Column along the abscissa of each curve, where every curve has its own: `ring1.hersey_number`, whose last word says what it is; `x` is the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own_x: Vec<String>,
    /// Logarithmic abscissa.
    pub log_x: bool,
    /// Logarithmic ordinate.
    pub log_y: bool,
    /// What stands along the ordinate; empty where the labels of the curves say it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub y_name: String,
    /// Label and column of thin lines that carry their label at their end and stand in no legend: rays of orders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rays: Vec<(String, String)>,
    /// Places and values that are marked.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<Mark>,
    /// Upper end of the ordinate; none: as far as the curves reach.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top: Option<f64>,
    /// Points that follow each other without being joined.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub scatter: bool,
}

/// Line spectra of several values of one quantity (a speed), one above the other, the nearer hiding the farther. The table has one row per line; those
/// of one spectrum follow each other, ascending along every abscissa.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Waterfall {
    /// Columns along the abscissa, one shown at a time: `order`, `frequency`.
    pub x: Vec<String>,
    /// Column by which the spectra stand one above the other.
    pub y: String,
    /// Label and column of what the spectra are of, one shown at a time. Each has a unit and a scale of its own.
    pub spectra: Vec<(String, String)>,
}

/// Something that is marked in [`Lines`], in the SI units of its columns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mark {
    /// A point, its area by `weight`, 0 to 1.
    Point {
        /// Its abscissa.
        x: f64,
        /// Its ordinate.
        y: f64,
        /// How much it matters.
        weight: f64,
        /// Whether it breaks a limit.
        beyond: bool,
        /// What it is.
        label: String,
    },
    /// A range of the abscissa: where a machine runs, or a margin that must stay free.
    Band {
        /// Its lower end.
        from: f64,
        /// Its upper end.
        to: f64,
        /// Whether it should stay free.
        kept_free: bool,
        /// What it is.
        label: String,
    },
    /// An upright line.
    At {
        /// Its abscissa.
        x: f64,
        /// What it is.
        label: String,
    },
    /// A level that curves should stay below, or within on both sides of zero.
    Limit {
        /// Its ordinate.
        y: f64,
        /// What it is.
        label: String,
    },
}

/// One range of a figure.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// What it is.
    pub label: String,
    /// Where it begins: of a swing, the value at the low end of the input.
    pub low: Option<f64>,
    /// Where it ends: of a swing, the value at the high end of the input.
    pub high: Option<f64>,
    /// The value that the range surrounds.
    pub value: Option<f64>,
}

/// One of the pictures of a moving drawing.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// What tells it from the others: `372 deg`.
    pub label: String,
    /// The crank angle \[deg\] that it shows, where it shows one: moving pictures of a page then show the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<f64>,
    /// What it shows.
    pub shapes: Vec<Shape>,
}

/// Part of a drawing. Coordinates share one length unit, `y` upwards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Straight pieces between points.
    Path {
        /// The points.
        points: Vec<[f64; 2]>,
        /// Whether the last joins the first.
        closed: bool,
        /// How it looks.
        style: Style,
    },
    /// A circle.
    Circle {
        /// Its centre.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
        /// How it looks.
        style: Style,
    },
    /// Words.
    Text {
        /// Their place.
        at: [f64; 2],
        /// The words.
        text: String,
        /// What part of them stands there.
        anchor: Anchor,
    },
    /// A dimension line with its arrows.
    Dimension {
        /// One end of what is measured.
        from: [f64; 2],
        /// The other.
        to: [f64; 2],
        /// How far the line stands off, to the left of the way from one to the other.
        offset: f64,
        /// What is written on it.
        text: String,
    },
}

/// How a [`Shape`] looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Style {
    /// A strong line.
    Outline,
    /// A thin line.
    Thin,
    /// A thin dashed line: hidden, or a reference.
    Dashed,
    /// A dash-dotted line: an axis.
    Axis,
    /// A line that draws the eye.
    Accent,
    /// A second line that does.
    Second,
    /// A solid body.
    Metal,
    /// A solid body that is cut.
    Cut,
    /// A hollow in a body.
    Hollow,
    /// Oil.
    Oil,
}

/// Which part of a text stands at its place.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    #[default]
    Middle,
    /// Its end.
    End,
}

/// One bar of a figure.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Bar {
    /// What it is.
    pub label: String,
    /// How long it is.
    pub value: f64,
    /// A mark that it should not pass.
    pub limit: Option<f64>,
}

/// A result beside the value that a source gives for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// What was changed against the case as it stands: `rig.speed=1 m/s`; empty for the case itself.
    pub set: Vec<String>,
    /// The setting from which the result changes, for sources that tell a change.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against: Option<Vec<String>>,
    /// Name of the result; `change of …` and `relative change of …` where the change is told.
    pub result: String,
    /// Computed value.
    pub value: f64,
    /// Value of the source.
    pub reference: f64,
    /// Unit of both.
    pub unit: String,
    /// Admitted deviation, relative to the reference (absolute when that is zero).
    pub tolerance: f64,
    /// Where the reference comes from.
    pub source: String,
    /// What the comparison shows.
    pub verdict: Verdict,
}

/// What a comparison with a source shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The source's value comes out, within the tolerance.
    #[default]
    Reproduced,
    /// The source is wrong, and what shows it stands with the comparison: an exact solution, its own numbers, two of its statements
    /// that contradict each other, or an independent calculation. The deviation is larger than the tolerance.
    Refuted,
    /// The value does not come out, because an input of the source is lost or for a reason that is not known: the deviation is larger
    /// than the tolerance.
    NotReproduced,
}

impl Verdict {
    /// All of them, in the order in which they are counted.
    pub const ALL: [Self; 3] = [Self::Reproduced, Self::Refuted, Self::NotReproduced];

    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Refuted => "refuted",
            Self::NotReproduced => "not reproduced",
        }
    }
}

impl Check {
    /// Deviation relative to the reference, or from zero when the reference is zero.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        let d = self.value - self.reference;
        if self.reference == 0.0 { d } else { d / self.reference.abs() }
    }

    /// The setting in words. Paths stand without the name of a bench's table, with which every one of a bench begins.
    #[must_use]
    pub fn setting(&self) -> String {
        let words = |set: &[String]| {
            let short: Vec<&str> = set.iter().map(|s| s.strip_prefix("rig.").unwrap_or(s)).collect();
            if short.is_empty() { "as it stands".to_owned() } else { short.join(", ") }
        };
        match &self.against {
            None => words(&self.set),
            Some(from) => format!("{}, against {}", words(&self.set), words(from)),
        }
    }

    /// Whether the comparison comes out as its verdict says.
    #[must_use]
    pub fn holds(&self) -> bool {
        let d = self.deviation();
        d.is_finite() && (d.abs() <= self.tolerance) == (self.verdict == Verdict::Reproduced)
    }
}

/// A case beside the values of its sources.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Validated {
    /// Name of the case.
    pub case: String,
    /// The file of comparisons.
    pub file: String,
    /// Title of the case.
    pub title: String,
    /// Where the case comes from.
    pub source: String,
    /// Settings that were run.
    pub runs: usize,
    /// The comparisons.
    pub checks: Vec<Check>,
}

impl Validated {
    /// Number of comparisons with a verdict that came out so.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.checks.iter().filter(|c| c.verdict == verdict && c.holds()).count()
    }

    /// Comparisons that did not come out as their verdict says.
    pub fn broken(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|c| !c.holds())
    }

    /// The largest deviation among the values that are reproduced, and the part of its tolerance that is used; none where there are
    /// none.
    #[must_use]
    pub fn worst(&self) -> Option<&Check> {
        let used = |c: &Check| if c.tolerance > 0.0 { c.deviation().abs() / c.tolerance } else { 0.0 };
        let reproduced = self.checks.iter().filter(|c| c.verdict == Verdict::Reproduced);
        reproduced.max_by(|a, b| used(a).total_cmp(&used(b)))
    }
}

/// A file that a case names, as it was read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct KeptFile {
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// Its text.
    pub text: String,
}

/// What a run was made of: enough to repeat it elsewhere, byte for byte.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Name of the case file, without its folder.
    pub file: String,
    /// Changes to it, as `--set` took them.
    pub overrides: Vec<String>,
    /// SHA-256 of the resolved case: equal where two runs computed the same.
    pub resolved_sha256: String,
    /// SHA-256 of the text of the case file.
    pub sha256: String,
    /// Revision of the program; empty where it was not built from a checkout.
    #[serde(default)]
    pub revision: String,
    /// Text of the case file.
    pub text: String,
    /// Further files that the case names, by their names in it.
    #[serde(default)]
    pub files: IndexMap<String, KeptFile>,
    /// Parameter sets that the case names: what each gave, with its source.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sets: Vec<SetUse>,
    /// Numbers, words and models of the case as a person reads them, in its order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<InputUse>,
    /// Every value of the case in SI units, changes and defaults filled in.
    pub resolved: serde_json::Value,
}

/// A value of a case, for the page of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct InputUse {
    /// Dotted path, as `--set` takes it.
    pub path: String,
    /// Number with its unit, word or name of a model.
    pub value: String,
    /// What it is: one sentence.
    pub about: String,
    /// Whether the case, a change or a parameter set gives it; otherwise it is a default.
    pub given: bool,
}

/// A parameter set that a table of a case took over.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetUse {
    /// Path of the table, `models.oil`.
    pub path: String,
    /// Name of the set.
    pub name: String,
    /// The values that were taken, by key: the value as a case says it, and where it comes from.
    pub values: IndexMap<String, SetValueUse>,
}

/// A value that a parameter set gave.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetValueUse {
    /// As a case says it.
    pub value: String,
    /// Source, or why it is assumed.
    pub origin: String,
}

/// One group of numerical settings that was refined.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Refined {
    /// What was refined: `tolerance`, `film grid`.
    pub what: String,
    /// The changes of each level.
    pub levels: Vec<Vec<String>>,
}

/// How far the results are from those of the equations.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Verification {
    /// What was refined.
    pub refined: Vec<Refined>,
    /// Numerical uncertainty of each result, in its unit.
    pub uncertainty: IndexMap<String, f64>,
}

/// Everything a run of one case produced.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Name of the case: the file name without its extension.
    pub case: String,
    /// Title from the case file.
    pub title: String,
    /// Where the case comes from.
    pub source: String,
    /// Assumptions that the case file declares.
    pub assumptions: Vec<String>,
    /// The scene.
    pub scene: String,
    /// Version of Gudgeon.
    pub gudgeon: String,
    /// What the run was made of.
    pub provenance: Provenance,
    /// How far the results are from those of the equations, where that was asked for.
    pub verification: Option<Verification>,
    /// Models that ran.
    pub models: Vec<ModelUse>,
    /// What was left out.
    pub skipped: Vec<Skipped>,
    /// Results by name.
    pub results: IndexMap<String, Value>,
    /// The balance sheet.
    pub balance: Balance,
    /// Work done.
    pub solver: SolverReport,
    /// Wall-clock seconds by phase: `build`, `solve`, `total`.
    pub seconds: IndexMap<String, f64>,
    /// Curves over the cycle, or over what the scene runs along.
    pub series: Series,
    /// Further tables, each a file of its own, by file name without `.csv`.
    pub tables: IndexMap<String, Series>,
    /// Drawings of the series and the tables, besides those of curves over the cycle.
    pub figures: Vec<Figure>,
    /// The results that lead, as the scene names them; those that a run does not have are left out ([`RunResult::leading`]).
    pub headlines: Vec<Headline>,
    /// Title of the figure that leads; empty: the section, or the first figure.
    pub lead: String,
    /// What happened when.
    pub events: Vec<Event>,
    /// Other periodic solutions.
    pub branches: Vec<Branch>,
    /// Section to draw, when the scene has one.
    pub section: Option<PackSection>,
}

/// One combination of a [`Comparison`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Variant {
    /// `gas_flow=narrow_channel, contact=off`; after the name of its case where there are several.
    pub label: String,
    /// Number of its case in [`Comparison::cases`].
    pub case: usize,
    /// `(path, value)` of every swap, in the order given.
    pub swaps: Vec<(String, String)>,
    /// The run, or why there is none (refused combination, failed run).
    pub outcome: Result<RunResult, Failure>,
}

impl Variant {
    /// Why there is no run, in words: `left out: …`, `refused: …` or `failed: …`.
    #[must_use]
    pub fn why(&self) -> Option<String> {
        let failure = self.outcome.as_ref().err()?;
        let what = match failure.code.as_str() {
            IMPOSSIBLE => "left out",
            REFUSED => "refused",
            _ => "failed",
        };
        Some(format!("{what}: {failure}"))
    }

    /// A result with its numerical uncertainty, where that is known.
    fn result(&self, name: &str) -> Option<(&Value, Option<f64>)> {
        let run = self.outcome.as_ref().ok()?;
        let uncertainty = run.verification.as_ref().and_then(|w| w.uncertainty.get(name));
        Some((run.results.get(name)?, uncertainty.copied()))
    }

    /// Whether there is no such machine.
    #[must_use]
    pub fn is_left_out(&self) -> bool {
        self.outcome.as_ref().is_err_and(|f| f.code == IMPOSSIBLE)
    }
}

/// A case of a [`Comparison`].
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ComparedCase {
    /// Its name, with the changes of its own where it has any: `turbo-diesel-120, engine.speed=1500 rpm`.
    pub name: String,
    /// Its title.
    pub title: String,
}

/// One case, or several, run with every combination of some swaps.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Comparison {
    /// Name of the case; of several, all their names.
    pub case: String,
    /// Title of the case; of several, how many they are.
    pub title: String,
    /// The cases.
    pub cases: Vec<ComparedCase>,
    /// `(path, values)` of every swap.
    pub swaps: Vec<(String, Vec<String>)>,
    /// The combinations, case by case and the last swap the fastest; the first one of a case that ran is the base that its others are compared with
    /// ([`Comparison::base`]).
    pub variants: Vec<Variant>,
    /// Which choice matters, where there are at least two: all cases together first, then each alone.
    pub shares: Vec<ShareTable>,
}

impl Comparison {
    /// Number of the combination that those of a case are compared with: its first one that has a run, counted from 0.
    #[must_use]
    pub fn base(&self, case: usize) -> Option<usize> {
        self.variants.iter().position(|v| v.case == case && v.outcome.is_ok())
    }

    /// Whether numerical uncertainties were looked for.
    #[must_use]
    pub fn is_verified(&self) -> bool {
        self.variants.iter().flat_map(|v| &v.outcome).any(|r| r.verification.is_some())
    }

    /// How a result of a combination differs from that of its base; none for the base itself, and where one of the two has no such result in the same unit.
    #[must_use]
    pub fn difference(&self, variant: usize, result: &str) -> Option<Difference> {
        let other = self.variants.get(variant)?;
        let base = self.base(other.case).filter(|b| *b != variant)?;
        let ((a, ua), (b, ub)) = (self.variants[base].result(result)?, other.result(result)?);
        if a.unit != b.unit {
            return None;
        }
        Difference::between((a.value, ua), (b.value, ub), &a.unit)
    }
}

/// Error that a default setting should not exceed.
pub const DEFAULT_ERROR: f64 = 1e-3;
/// By how much an achieved error may exceed the one that was asked for.
pub const OVER_ASKED: f64 = 10.0;

/// One point of a work-precision sweep.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct BenchPoint {
    /// Method: points of one method form one curve.
    pub method: String,
    /// The setting that was swept: `tolerance 1e-4`, `16 sub-steps`.
    pub setting: String,
    /// Whether the case as it stands has this setting.
    pub is_default: bool,
    /// Median wall time of one cycle \[s\]; of the whole where nothing is cyclic.
    pub seconds_per_cycle: f64,
    /// Wall time of the whole \[s\].
    pub seconds_total: f64,
    /// Cycle-equivalents to the periodic state; 1 where nothing is cyclic.
    pub cycles: f64,
    /// Work counters.
    pub work: IndexMap<String, u64>,
    /// Relative error of each chosen result against the reference.
    pub errors: IndexMap<String, f64>,
    /// Relative error that the setting asks for, where it is a tolerance.
    pub asked: Option<f64>,
    /// The largest relative error of the chosen results that the tolerance leaves, all else equal.
    pub achieved: Option<f64>,
    /// Why the point is missing, when it is.
    pub failure: Option<String>,
}

impl BenchPoint {
    /// The result with the largest error.
    #[must_use]
    pub fn worst(&self) -> Option<(&str, f64)> {
        let all = self.errors.iter().map(|(name, e)| (name.as_str(), *e));
        all.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|_| self.failure.is_none())
    }

    /// Achieved error over the one that was asked for.
    #[must_use]
    pub fn over_asked(&self) -> Option<f64> {
        self.achieved.zip(self.asked).map(|(got, asked)| got / asked)
    }
}

/// Run time against error of one case.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct BenchTable {
    /// Name of the case.
    pub case: String,
    /// Title of the case.
    pub title: String,
    /// How the reference was made and how far it is trusted.
    pub reference: String,
    /// Whether the reference comes from another method than those that are raced.
    pub independent: bool,
    /// Relative error to which the reference is trusted: smaller ones of a point say no more.
    pub trusted_to: f64,
    /// Reference values by result name.
    pub reference_values: IndexMap<String, Value>,
    /// The sweep.
    pub points: Vec<BenchPoint>,
    /// Statements drawn from the points: `implicit is 12 times faster than as_published at an error of 1e-3`.
    pub findings: Vec<String>,
}

impl BenchTable {
    /// The case as it stands.
    #[must_use]
    pub fn default_point(&self) -> Option<&BenchPoint> {
        self.points.iter().find(|p| p.is_default)
    }

    /// Achieved error of the case as it stands over the one it asks for.
    #[must_use]
    pub fn default_over_asked(&self) -> Option<f64> {
        self.points.iter().filter(|p| p.is_default).find_map(BenchPoint::over_asked)
    }

    /// Whether the case as it stands has errors of at most [`DEFAULT_ERROR`].
    #[must_use]
    pub fn default_is_enough(&self) -> bool {
        let worst = self.default_point().and_then(BenchPoint::worst);
        worst.is_some_and(|(_, e)| e <= DEFAULT_ERROR)
    }
}
