//! Values at the points of a rectangular grid over the side, read from a text file.

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;

/// Fields over heights × angles; between the points straight lines, beyond them the values of the edge.
#[derive(Debug)]
pub(crate) struct Points {
    pub heights: Vec<f64>,
    /// Radians from the middle of the side.
    pub angles: Vec<f64>,
    /// Field after field; height `i` at angle `j` stands at `j heights + i`.
    pub values: Vec<f64>,
}

impl Points {
    /// Rows of height \[m\], angle \[deg\] and `columns(rows)` values.
    pub fn read(files: &Files, file: &str, columns: impl Fn(usize) -> usize) -> Result<Self, BuildError> {
        let text = files.text(file).map_err(|e| {
            BuildError::at("file", format!("cannot read {}: {e}", files.path(file).display()))
                .help("the name is relative to the folder of the case file")
        })?;
        let fault =
            |line: usize, what: String| BuildError::at("file", format!("{file}, line {line}: {what}"));
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let mut row = Vec::new();
            for field in line.split([' ', ',', ';', '\t']).filter(|f| !f.is_empty()) {
                match field.parse::<f64>() {
                    Ok(v) if v.is_finite() => row.push(v),
                    _ => return Err(fault(number + 1, format!("`{field}` is not a number"))),
                }
            }
            rows.push(row);
        }
        let wanted = 2 + columns(rows.len());
        if let Some(k) = rows.iter().position(|r| r.len() != wanted) {
            let what = format!("row {} has {} values where {wanted} are expected", k + 1, rows[k].len());
            return Err(BuildError::at("file", format!("{file}: {what}")));
        }
        let distinct = |at: usize| {
            let mut v: Vec<f64> = rows.iter().map(|r| r[at]).collect();
            v.sort_by(f64::total_cmp);
            v.dedup();
            v
        };
        let (heights, degrees) = (distinct(0), distinct(1));
        let count = heights.len() * degrees.len();
        if heights.len() < 2 || degrees.len() < 2 || rows.len() != count {
            let what = format!(
                "{} points at {} heights and {} angles are no rectangular grid of two or more each way",
                rows.len(),
                heights.len(),
                degrees.len()
            );
            return Err(BuildError::at("file", format!("{file}: {what}")));
        }
        let place = |r: &[f64]| {
            let i = heights.partition_point(|h| *h < r[0]);
            degrees.partition_point(|a| *a < r[1]) * heights.len() + i
        };
        let mut seen = vec![false; count];
        let mut values = vec![0.0; count * (wanted - 2)];
        for r in &rows {
            let k = place(r);
            if std::mem::replace(&mut seen[k], true) {
                return Err(BuildError::at(
                    "file",
                    format!("{file}: the point {} {} stands there twice", r[0], r[1]),
                ));
            }
            for (m, v) in r[2..].iter().enumerate() {
                values[m * count + k] = *v;
            }
        }
        // Where the rows stand in the grid, for columns that belong to points too.
        if wanted - 2 == count {
            let order: Vec<usize> = rows.iter().map(|r| place(r)).collect();
            let by_row = values.clone();
            for (m, to) in order.iter().enumerate() {
                values[to * count..(to + 1) * count].copy_from_slice(&by_row[m * count..(m + 1) * count]);
            }
        }
        Ok(Self { heights, angles: degrees.iter().map(|a| a.to_radians()).collect(), values })
    }

    pub fn len(&self) -> usize {
        self.heights.len() * self.angles.len()
    }

    /// Value of a field at height `x` and an angle.
    pub fn value(&self, field: usize, x: f64, angle: f64) -> f64 {
        self.weights(x, angle).iter().map(|(k, w)| w * self.values[field * self.len() + k]).sum()
    }

    /// Points round a place, and their parts in its value.
    pub fn weights(&self, x: f64, angle: f64) -> [(usize, f64); 4] {
        let find = |line: &[f64], at: f64| {
            let i = line.partition_point(|v| *v < at).clamp(1, line.len() - 1);
            (i - 1, ((at - line[i - 1]) / (line[i] - line[i - 1])).clamp(0.0, 1.0))
        };
        let ((i, a), (j, b)) = (find(&self.heights, x), find(&self.angles, angle));
        let n = self.heights.len();
        let k = j * n + i;
        [(k, (1.0 - a) * (1.0 - b)), (k + 1, a * (1.0 - b)), (k + n, (1.0 - a) * b), (k + n + 1, a * b)]
    }

    /// The point on the other side of the middle, when there is one for every point.
    pub fn mirror(&self) -> Option<Vec<usize>> {
        let (n, m) = (self.heights.len(), self.angles.len());
        let mirrored = (0..m).all(|j| (self.angles[j] + self.angles[m - 1 - j]).abs() < 1e-9);
        mirrored.then(|| (0..n * m).map(|k| (m - 1 - k / n) * n + k % n).collect())
    }

    /// Whether a field is the same on both sides of the middle.
    pub fn is_symmetric(&self, field: usize) -> bool {
        let f = &self.values[field * self.len()..(field + 1) * self.len()];
        let scale = f.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        self.mirror().is_some_and(|to| f.iter().zip(&to).all(|(v, k)| (v - f[*k]).abs() <= 1e-9 * scale))
    }
}
