use std::fmt::Debug;

use dyn_clone::DynClone;
use indexmap::IndexMap;

use crate::file::Files;
use crate::result::{Balance, Column, Figure, FigureKind, Lines, Note, Series, Value};
use crate::{BuildError, EvalError, register_kind};

/// What a [`RigSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct RigCtx<'a> {
    /// The files that the case names.
    pub files: &'a Files,
}

/// Configuration of a test bench: one sub-model, and the conditions it is run under.
#[register_kind(name = "rig", summary = "test bench: one sub-model alone under prescribed conditions")]
pub trait RigSpec: Debug + DynClone + Send + Sync {
    /// Kind and name of the models on the bench.
    fn models(&self) -> Vec<(&'static str, &'static str)>;
    /// Where a sub-model stands that others could replace because they solve the same equations, below `rig`, and the names of those: what
    /// `bench` races, and takes its reference from.
    fn same_equations(&self) -> Option<(&'static str, &'static [&'static str])> {
        None
    }
    /// Results that `bench` looks at unless told otherwise, the first few where none are named: none that count or that follow from others.
    fn headline(&self) -> &'static [&'static str] {
        &[]
    }
    /// Checks the numbers and builds the bench.
    ///
    /// # Errors
    /// Everything that is wrong, each with the path of its value.
    fn build(&self, ctx: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>>;
}

/// A test bench.
pub trait Rig: Send {
    /// Names of all results that [`Rig::run`] may tell, in its order. Some are told only where there is something to tell, as the place where a film
    /// ruptures.
    fn results(&self) -> Vec<String>;
    /// Runs it.
    ///
    /// # Errors
    /// The sub-model refused.
    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError>;
}

/// Names as [`Rig::results`] tells them.
#[must_use]
pub fn named(names: &[&str]) -> Vec<String> {
    names.iter().map(|n| (*n).to_owned()).collect()
}

/// What a bench measured.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RigOut {
    /// Results by name.
    pub results: IndexMap<String, Value>,
    /// The main table: along the film, over time, over the crank angle.
    pub series: Series,
    /// Further tables by file name without extension.
    pub tables: IndexMap<String, Series>,
    /// Drawings.
    pub figures: Vec<Figure>,
    /// Balances of what is conserved.
    pub balance: Balance,
    /// Work counters.
    pub counters: IndexMap<String, u64>,
    /// What a person should read.
    pub notes: Vec<Note>,
}

impl RigOut {
    /// Adds a result.
    pub fn result(&mut self, name: impl Into<String>, value: f64, unit: &str, what: impl Into<String>) {
        self.results.insert(name.into(), Value { value, unit: unit.into(), what: what.into() });
    }

    /// Sets the axis of the main table.
    pub fn axis(&mut self, name: &str, unit: &str, values: Vec<f64>) {
        self.series.axis = column(name, unit, values);
    }

    /// Adds a column to the main table.
    pub fn column(&mut self, name: impl Into<String>, unit: &str, values: Vec<f64>) {
        self.series.columns.push(column(name, unit, values));
    }

    /// Adds curves of the main table over its axis: `(label, column)`.
    pub fn curves(&mut self, title: &str, hint: &str, lines: &[(&str, &str)]) {
        let x = self.series.axis.name.clone();
        self.figures.push(Figure {
            title: title.into(),
            hint: hint.into(),
            table: "series".into(),
            kind: FigureKind::Lines(Lines {
                x,
                lines: lines.iter().map(|(l, c)| ((*l).into(), (*c).into())).collect(),
                ..Lines::default()
            }),
        });
    }

    /// Adds maps over a rectangular grid: a table with one row per point, rows of equal `y` following each other, and a map of
    /// every value `(name, unit, title, values)`.
    pub fn maps(
        &mut self,
        table: &str,
        x: (&str, &str, Vec<f64>),
        y: (&str, &str, Vec<f64>),
        values: Vec<(&str, &str, &str, Vec<f64>)>,
    ) {
        let (nx, ny) = (x.2.len(), y.2.len());
        let along = (0..nx * ny).map(|k| x.2[k % nx]).collect();
        let across = (0..nx * ny).map(|k| y.2[k / nx]).collect();
        let mut t = Series { axis: column(x.0, x.1, along), columns: vec![column(y.0, y.1, across)] };
        for (name, unit, title, v) in values {
            t.columns.push(column(name, unit, v));
            self.figures.push(Figure {
                title: title.into(),
                hint: String::new(),
                table: table.into(),
                kind: FigureKind::Map { x: x.0.into(), y: y.0.into(), value: name.into(), marks: Vec::new() },
            });
        }
        self.tables.insert(table.into(), t);
    }
}

fn column(name: impl Into<String>, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values }
}
