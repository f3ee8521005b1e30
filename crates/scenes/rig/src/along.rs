//! A film along a line as rows of a table, with its steps and fronts where they are.

use gudgeon_core::kinds::{Film1dOut, FilmField, RigOut};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_film::film_1d::LineProfile;

/// One end of a stretch between steps and fronts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// Place \[m\].
    pub x: f64,
    /// Gap \[m\].
    pub h: f64,
    /// Absolute pressure \[Pa\].
    pub p: f64,
    /// Filled fraction of the gap.
    pub fill: f64,
    /// Panel it belongs to.
    pub panel: usize,
    /// Under full film.
    pub film: bool,
}

/// Rows of the steady film `field` on `line`: for each panel its ends, and both sides of every front in it. The filled fraction in
/// a void is that of the flux there, `2 q/(u φ h)`, with `sliding` the factor `φ` of a panel. Before the film of a `starved` inlet the
/// oil lies on the moving surface and goes with it: half as much.
pub(crate) fn rows(
    line: &LineProfile,
    field: &FilmField<'_>,
    u: f64,
    p_cav: f64,
    starved: bool,
    sliding: impl Fn(usize) -> f64,
) -> Vec<Row> {
    let fronts = field.fronts;
    let mut out = Vec::with_capacity(2 * line.panels() + 2 * fronts.len());
    let mut film = match fronts.first() {
        Some(f) => f.film_before,
        None => field.fill.iter().all(|t| *t >= 1.0),
    };
    let mut next = 0;
    for i in 0..line.panels() {
        let (a, b) = (line.x[i], line.x[i + 1]);
        let (ha, hb) = (line.h_a[i], line.h_b[i]);
        let emptied = field.fill[i].min(field.fill[i + 1]) < 1.0;
        let row = |x: f64, h: f64, p: f64, film: bool, passed: usize| {
            let layer = starved && passed == if u > 0.0 { 0 } else { fronts.len() };
            let carried = if layer { 1.0 } else { 2.0 } * field.flux[i] / (u * sliding(i) * h);
            let fill = if film || !emptied || !carried.is_finite() { 1.0 } else { carried.clamp(0.0, 1.0) };
            Row { x, h, p, fill, panel: i, film }
        };
        while fronts.get(next).is_some_and(|f| f.x <= a) {
            film = !fronts[next].film_before;
            next += 1;
        }
        out.push(row(a, ha, field.p[i], film, next));
        let inside = fronts[next..].iter().take_while(|f| f.x < b).count();
        for f in &fronts[next..next + inside] {
            let h = ha + (hb - ha) * ((f.x - a) / (b - a));
            let p = match (inside, f.film_before) {
                (1, true) => field.p[i + 1],
                (1, false) => field.p[i],
                _ => p_cav,
            };
            out.push(row(f.x, h, p, f.film_before, next));
            next += 1;
            out.push(row(f.x, h, p, !f.film_before, next));
            film = !f.film_before;
        }
        out.push(row(b, hb, field.p[i + 1], film, next));
    }
    out
}

/// Refuses results that are not numbers: inputs of absurd size, which the film itself could still bear.
pub(crate) fn finite(out: &RigOut, model: &'static str) -> Result<(), EvalError> {
    let bad = out.results.iter().find(|(_, v)| !v.value.is_finite());
    let column = out.series.columns.iter().find(|c| c.values.iter().any(|v| !v.is_finite()));
    match bad.map(|(name, _)| name.as_str()).or(column.map(|c| c.name.as_str())) {
        Some(name) => Err(EvalError::fatal(model, format!("{name} is out of range"))),
        None => Ok(()),
    }
}

/// Refuses a cavitation pressure above that of every edge: nothing but a cavity would be left where the film begins.
pub(crate) fn cavitation_below(p_cav: f64, edges: &[f64]) -> Option<BuildError> {
    let max = edges.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (p_cav > max).then(|| {
        let what = format!(
            "must not be above the pressures at all edges, of which {} bar is the highest",
            1e-5 * max
        );
        BuildError::at("p_cav", what)
    })
}

/// What a film says of its oil, where it has any.
pub(crate) fn oil_balance(o: &Film1dOut) -> Option<f64> {
    (o.flux_in != 0.0 || o.flux_out != 0.0 || o.flux_error != 0.0).then_some(o.flux_error)
}
