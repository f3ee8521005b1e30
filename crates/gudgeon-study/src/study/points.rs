//! Which points a study has: number to case and changes.

use gudgeon_core::BuildError;

use super::file::StudyFile;
use super::input::Quantiles;
use super::linear::ONE_DEVIATION;
use super::list::PointList;
use crate::sampling::{Design, MAX_POINTS, Points};

/// An input that a study varies, with the unit that all its values share.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Varied {
    /// Its path.
    pub path: String,
    /// The unit behind its numbers; none where its values are no numbers of one unit.
    pub unit: Option<String>,
}

/// All points of a study, each computed from its number.
pub struct Plan {
    cases: usize,
    list: PointList,
    inputs: Inputs,
    /// What is varied, in the order of [`Plan::values`].
    pub varied: Vec<Varied>,
}

/// How the inputs of a study file are combined.
enum Inputs {
    Grid { paths: Vec<String>, values: Vec<Vec<String>> },
    Design { paths: Vec<String>, quantiles: Vec<Quantiles>, points: Box<dyn Points> },
}

impl Inputs {
    fn new(file: &StudyFile) -> Result<Self, Vec<BuildError>> {
        let paths = file.inputs.iter().map(|i| i.axis.path.clone()).collect();
        match &file.design {
            None => Ok(Self::Grid { paths, values: each(file, super::input::Input::grid)? }),
            Some(design) => {
                let quantiles = each(file, super::input::Input::quantiles)?;
                let points = design.points(quantiles.len()).map_err(|e| vec![e.within("design")])?;
                let word = quantiles.iter().position(|q| matches!(q, Quantiles::Choice(_)));
                if let (Design::Linear {}, Some(k)) = (design, word) {
                    let what = "a linear study needs numbers: nothing is differentiated by a choice";
                    return Err(vec![BuildError::at(format!("inputs.{k}"), what)]);
                }
                Ok(Self::Design { paths, quantiles, points })
            }
        }
    }

    fn len(&self) -> Option<usize> {
        match self {
            Self::Grid { values, .. } => values.iter().try_fold(1usize, |n, v| n.checked_mul(v.len())),
            Self::Design { points, .. } => Some(points.len()),
        }
    }

    fn paths(&self) -> &[String] {
        match self {
            Self::Grid { paths, .. } | Self::Design { paths, .. } => paths,
        }
    }

    /// Values of point `k`, the last input running fastest.
    fn values(&self, mut k: usize) -> Vec<String> {
        match self {
            Self::Grid { values, .. } => {
                let mut out: Vec<String> = Vec::with_capacity(values.len());
                for all in values.iter().rev() {
                    out.push(all[k % all.len()].clone());
                    k /= all.len();
                }
                out.reverse();
                out
            }
            Self::Design { quantiles, points, .. } => {
                points.point(k).iter().zip(quantiles).map(|(u, q)| q.text(*u)).collect()
            }
        }
    }
}

/// `f` of every input, or all that is wrong, with places.
fn each<T>(
    file: &StudyFile,
    f: impl Fn(&super::input::Input) -> Result<T, BuildError>,
) -> Result<Vec<T>, Vec<BuildError>> {
    let (mut out, mut wrong) = (Vec::new(), Vec::new());
    for (k, input) in file.inputs.iter().enumerate() {
        match f(input) {
            Ok(v) => out.push(v),
            Err(e) => wrong.push(e.within(&format!("inputs.{k}"))),
        }
    }
    if wrong.is_empty() { Ok(out) } else { Err(wrong) }
}

impl Plan {
    /// The points of a study of `cases` cases.
    ///
    /// # Errors
    /// Everything that is wrong with inputs and design, with places in the study file.
    pub fn new(file: &StudyFile, list: Option<PointList>) -> Result<Self, Vec<BuildError>> {
        let inputs = Inputs::new(file)?;
        let list = list.unwrap_or_default();
        let mut plan = Self { cases: file.cases.len(), list, inputs, varied: Vec::new() };
        let paths: Vec<&String> = plan.list.paths.iter().chain(plan.inputs.paths()).collect();
        if let Some(twice) = (1..paths.len()).find(|k| paths[..*k].contains(&paths[*k])) {
            let what = format!("`{}` is varied twice", paths[twice]);
            return Err(vec![BuildError::at("inputs", what)]);
        }
        if let Some(e) = plan.too_many() {
            return Err(vec![e]);
        }
        plan.varied = plan.look_at_units();
        Ok(plan)
    }

    fn too_many(&self) -> Option<BuildError> {
        let all = self.inputs.len().and_then(|n| n.checked_mul(self.rows())?.checked_mul(self.cases));
        let many = all.is_none_or(|n| n > MAX_POINTS);
        many.then(|| BuildError::at("inputs", format!("a study has at most {MAX_POINTS} points")))
    }

    fn rows(&self) -> usize {
        self.list.rows.len().max(1)
    }

    /// The texts of every input of a design one deviation below and above its middle.
    #[must_use]
    pub fn spread(&self) -> Vec<(String, [String; 2])> {
        match &self.inputs {
            Inputs::Grid { .. } => Vec::new(),
            Inputs::Design { paths, quantiles, .. } => {
                let ends = |q: &Quantiles| ONE_DEVIATION.map(|u| q.text(u));
                paths.iter().cloned().zip(quantiles.iter().map(ends)).collect()
            }
        }
    }

    /// How many points there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.cases * self.rows() * self.inputs.len().unwrap_or(0)
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The case of point `k`, and the values of the varied inputs as a case would write them.
    #[must_use]
    pub fn values(&self, k: usize) -> (usize, Vec<String>) {
        let inner = self.inputs.len().unwrap_or(1).max(1);
        let (outer, own) = (k / inner, k % inner);
        let mut values = self.list.rows.get(outer % self.rows()).cloned().unwrap_or_default();
        values.extend(self.inputs.values(own));
        (outer / self.rows(), values)
    }

    /// The case of point `k`, and its changes as `--set` takes them. Models come before the values that a model may have.
    #[must_use]
    pub fn changes(&self, k: usize) -> (usize, Vec<String>) {
        let (case, values) = self.values(k);
        let set = |(v, text): (&Varied, String)| format!("{}={text}", v.path);
        let mut all: Vec<String> = self.varied.iter().zip(values).map(set).collect();
        all.sort_by_key(|s| !s.split('=').next().is_some_and(|path| path.ends_with(".model")));
        (case, all)
    }

    /// The units of all inputs: of every value in lists and grids; a design has one by construction.
    fn look_at_units(&self) -> Vec<Varied> {
        let listed = self.list.paths.iter().enumerate().map(|(k, path)| {
            let unit = common_unit(self.list.rows.iter().map(|r| r[k].as_str()));
            Varied { path: path.clone(), unit }
        });
        let own = self.inputs.paths().iter().enumerate().map(|(k, path)| {
            let unit = match &self.inputs {
                Inputs::Grid { values, .. } => common_unit(values[k].iter().map(String::as_str)),
                Inputs::Design { quantiles, .. } => match &quantiles[k] {
                    Quantiles::Number(_, unit) => Some(unit.clone()),
                    Quantiles::Choice(d) => match d {
                        crate::distribution::Distribution::Discrete { values, .. } => {
                            common_unit(values.iter().map(String::as_str))
                        }
                        _ => None,
                    },
                },
            };
            Varied { path: path.clone(), unit }
        });
        listed.chain(own).collect()
    }
}

/// The unit behind all of some numbers.
fn common_unit<'a>(mut texts: impl Iterator<Item = &'a str>) -> Option<String> {
    let unit = |t: &'a str| gudgeon_scene::number(t).map(|(_, unit)| unit);
    let first = unit(texts.next()?)?;
    texts.all(|t| unit(t) == Some(first)).then(|| first.to_owned())
}
