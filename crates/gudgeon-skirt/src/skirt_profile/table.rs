use gudgeon_core::file::Files;
use gudgeon_core::kinds::{SkirtProfile, SkirtProfileCtx, SkirtProfileSpec};
use gudgeon_core::quantity::{Length, NonNegative, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use gudgeon_numerics::table::Pchip;
use serde::{Deserialize, Serialize};

use crate::skirt_compliance::points::Points;

/// A measured shape.
///
/// Either `heights` and `drops`, the same all round but for an ovality `o sin² φ`, or a `file` of rows `height angle drop` in metres, degrees and
/// metres, whose points form a rectangular grid over the side (lines that begin with `#` are comments, separators are blanks, commas, semicolons or
/// tabs), or the table `skirt_shape.csv` that a case of the scene `pin` writes, whose `warm_drop` is taken over its `depth`. Between heights runs
/// a monotone cubic, between the points of a grid a plane of straight lines.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Heights below the upper edge, ascending.
    #[serde(default)]
    pub heights: Vec<Length>,
    /// Drops at the heights.
    #[serde(default)]
    pub drops: Vec<Length>,
    /// Drop at 90 degrees from the middle of the side.
    #[serde(default = "none")]
    pub ovality: Length<NonNegative>,
    /// Text file, relative to the folder of the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

fn none() -> Length<NonNegative> {
    quantity(0.0)
}

#[register_model(
    name = "table",
    summary = "a measured shape, by height or over the whole side",
    equations = "f = P(x) + o sin^2(phi), P a monotone cubic;  or bilinear between the points of a file",
    validity = "Hot shape. The ends of the table count beyond it.",
    references = ["fritsch1980"],
    example = "heights = [\"0 mm\", \"10 mm\", \"25 mm\", \"40 mm\"]\ndrops = [\"25 um\", \"4 um\", \"0 um\", \"12 um\"]\n",
)]
impl SkirtProfileSpec for Table {
    fn build(&self, ctx: &SkirtProfileCtx<'_>) -> Result<Box<dyn SkirtProfile>, BuildError> {
        if let Some(file) = &self.file {
            if !self.heights.is_empty() || !self.drops.is_empty() {
                return Err(BuildError::at("file", "the shape is given twice, in a file and inline"));
            }
            if let Some((x, y)) = designed(ctx.files, file)? {
                return self.curve(x, y, "file");
            }
            let points = Points::read(ctx.files, file, |_| 1)?;
            return Ok(Box::new(Map { oval: self.ovality.si(), points }));
        }
        if self.heights.len() != self.drops.len() || self.heights.len() < 2 {
            let what = format!("{} heights and {} drops are no table", self.heights.len(), self.drops.len());
            return Err(BuildError::at("heights", what).help("give two or more of both, or a `file`"));
        }
        let x = self.heights.iter().map(|h| h.si()).collect();
        let y = self.drops.iter().map(|d| d.si()).collect();
        self.curve(x, y, "heights")
    }
}

impl Table {
    fn curve(
        &self,
        x: Vec<f64>,
        y: Vec<f64>,
        key: &'static str,
    ) -> Result<Box<dyn SkirtProfile>, BuildError> {
        let (Some(first), Some(last)) = (x.first(), x.last()) else {
            return Err(BuildError::at(key, "a shape needs two heights or more"));
        };
        let ends = (*first, *last);
        let curve = Pchip::new(x, y).map_err(|e| BuildError::at(key, e.to_string()))?;
        Ok(Box::new(Curve { curve, ends, oval: self.ovality.si() }))
    }
}

/// Depths and drops.
type Shape = (Vec<f64>, Vec<f64>);

/// Depths and warm drops of a table that the scene `pin` wrote; nothing when the file is another one.
fn designed(files: &Files, file: &str) -> Result<Option<Shape>, BuildError> {
    let Ok(text) = files.text(file) else { return Ok(None) };
    let mut lines = text.lines().enumerate();
    let names: Vec<&str> = lines.next().map_or(Vec::new(), |(_, l)| l.split(',').collect());
    let place = |name: &str| names.iter().position(|n| *n == name);
    let (Some(x), Some(y)) = (place("depth[m]"), place("warm_drop[m]")) else { return Ok(None) };
    let mut columns = (Vec::new(), Vec::new());
    for (k, line) in lines.filter(|(_, l)| !l.trim().is_empty()) {
        let cells: Vec<&str> = line.split(',').collect();
        let number =
            |i: usize| cells.get(i).and_then(|c| c.trim().parse::<f64>().ok()).filter(|v| v.is_finite());
        let (Some(x), Some(y)) = (number(x), number(y)) else {
            let what = format!("{file}, line {}: a depth and a warm drop are needed", k + 1);
            return Err(BuildError::at("file", what));
        };
        columns.0.push(x);
        columns.1.push(y);
    }
    Ok(Some(columns))
}

#[derive(Debug)]
struct Curve {
    curve: Pchip,
    ends: (f64, f64),
    oval: f64,
}

impl SkirtProfile for Curve {
    fn depth(&self, x: f64, angle: f64) -> f64 {
        self.curve.value(x.clamp(self.ends.0, self.ends.1)) + self.oval * elementary::sin(angle).powi(2)
    }
    fn is_symmetric(&self) -> bool {
        true
    }
}

#[derive(Debug)]
struct Map {
    points: Points,
    oval: f64,
}

impl SkirtProfile for Map {
    fn depth(&self, x: f64, angle: f64) -> f64 {
        self.points.value(0, x, angle) + self.oval * elementary::sin(angle).powi(2)
    }
    fn is_symmetric(&self) -> bool {
        self.points.is_symmetric(0)
    }
}
