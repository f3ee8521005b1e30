//! Crank angles at which a cycle is looked at for its series and its maps.

/// Crank angles in equal steps of about `step` \[rad\] over a cycle.
#[must_use]
pub fn angles(period: f64, step: f64) -> Vec<f64> {
    let count = (period / step).round().max(1.0) as usize;
    (0..=count).map(|k| period * k as f64 / count as f64).collect()
}

/// Crank angles closer than this are one \[rad\].
pub const SAME: f64 = 1e-9;

/// A crank angle that is looked at, for a row of the series, for a map, or for both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Crank angle \[rad\].
    pub theta: f64,
    /// Whether a row of the series stands here.
    pub row: bool,
    /// Whether a map stands here.
    pub map: bool,
}

/// Rows and maps in the order of their crank angles, which both ascend.
#[must_use]
pub fn places(rows: &[f64], maps: &[f64]) -> Vec<Place> {
    let mut all = Vec::with_capacity(rows.len() + maps.len());
    let mut maps = maps.iter().copied().peekable();
    for &theta in rows {
        while let Some(theta) = maps.next_if(|m| *m < theta - SAME) {
            all.push(Place { theta, row: false, map: true });
        }
        let map = maps.next_if(|m| *m <= theta + SAME).is_some();
        all.push(Place { theta, row: true, map });
    }
    all.extend(maps.map(|theta| Place { theta, row: false, map: true }));
    all
}
