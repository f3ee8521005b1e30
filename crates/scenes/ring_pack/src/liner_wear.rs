//! Where the rings wear the liner: the load of solid contact times the way that it slides, by place (Archard).

use std::f64::consts::PI;

use gudgeon_core::result::{Column, Figure, FigureKind, Lines, PackSection, RunResult, Series};

/// Places along the liner.
const PLACES: usize = 200;

/// Bins along the liner.
struct Liner {
    from: f64,
    step: f64,
    sums: Vec<f64>,
}

impl Liner {
    /// Spreads `amount` over the way of a face that reaches `half` to both sides of its middle, which goes from `a` to `b` evenly.
    fn spread(&mut self, a: f64, b: f64, half: f64, amount: f64) {
        let place = |x: f64| (x - self.from) / self.step;
        let (a, b, half) = (place(a.min(b)), place(a.max(b)), half / self.step);
        let last = self.sums.len() - 1;
        let first = ((a - half).max(0.0) as usize).min(last);
        let end = ((b + half).max(0.0) as usize).min(last);
        let mut below = part_below(first as f64 - a, b - a, half);
        for (k, sum) in self.sums.iter_mut().enumerate().take(end + 1).skip(first) {
            let upto = part_below((k + 1) as f64 - a, b - a, half);
            *sum += amount * (upto - below);
            below = upto;
        }
    }
}

/// Ways and faces, in bins, that count as points.
const POINT: f64 = 1e-6;

/// Part of what a face of `half` its length leaves on its way from 0 to `way` that lies below `x`: a box over the face at every place of a box over
/// the way.
fn part_below(x: f64, way: f64, half: f64) -> f64 {
    if way < POINT {
        return if half < POINT {
            f64::from(u8::from(x > 0.0))
        } else {
            ((x + half) / (2.0 * half)).clamp(0.0, 1.0)
        };
    }
    if half < POINT {
        return (x / way).clamp(0.0, 1.0);
    }
    let ramp = |x: f64| 0.5 * x.max(0.0).powi(2);
    let sum = ramp(x + half) - ramp(x - half) - ramp(x - way + half) + ramp(x - way - half);
    (sum / (2.0 * half * way)).clamp(0.0, 1.0)
}

/// Wear load of each ring along the liner \[J/m²\], with the depth below the crown at the upper dead centre. `theta` are crank angles \[deg\], `y` heights and
/// `v` speeds of the piston, `loads` those of solid contact over the whole circumference \[N\], none of a ring without a film.
///
/// Between two rows the power of contact, by the trapezoidal rule, is spread over the way of the running face, so nothing is lost: the sum over the
/// liner is that over the rows. Places are resolved to the length of the face and of a row.
#[must_use]
pub fn along(
    section: &PackSection,
    omega: f64,
    theta: &[f64],
    y: &[f64],
    v: &[f64],
    loads: &[Option<&[f64]>],
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let top = y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let face = |i: usize| {
        let r = &section.rings[i];
        (r.groove_bottom - 0.5 * r.height, 0.5 * r.face_length)
    };
    let faces: Vec<(f64, f64)> = (0..loads.len()).map(face).collect();
    let from = faces.iter().map(|(at, half)| at - half).fold(f64::INFINITY, f64::min);
    let to = faces.iter().map(|(at, half)| at + half).fold(0.0, f64::max) + section.stroke;
    let step = (to - from) / PLACES as f64;
    let depths = (0..PLACES).map(|k| from + (k as f64 + 0.5) * step).collect();
    let area = 2.0 * PI * section.bore_radius * step;
    let of = |(i, load): (usize, &Option<&[f64]>)| {
        let mut liner = Liner { from, step, sums: vec![0.0; PLACES] };
        let (at, half) = faces[i];
        for (k, w) in load.iter().flat_map(|l| l.windows(2)).enumerate() {
            let time = (theta[k + 1] - theta[k]).to_radians() / omega;
            let work = 0.5 * time * (w[0] * v[k].abs() + w[1] * v[k + 1].abs());
            liner.spread(top - y[k] + at, top - y[k + 1] + at, half, work);
        }
        liner.sums.iter().map(|s| s / area).collect()
    };
    (depths, loads.iter().enumerate().map(of).collect())
}

/// Adds the table `liner_wear` and its figure where a ring touches the liner; `rings` are their names.
pub fn figure(out: &mut RunResult, rings: &[String], section: &PackSection, omega: f64) {
    let series = &out.series;
    let values = |name: &str| series.get(name).map(|c| c.values.as_slice());
    let (Some(y), Some(v)) = (values("piston.y"), values("piston.v")) else { return };
    let loads: Vec<Option<&[f64]>> =
        (1..=rings.len()).map(|i| values(&format!("ring{i}.contact_load"))).collect();
    if loads.iter().flatten().copied().flatten().all(|w| *w <= 0.0) {
        return;
    }
    let (depths, wear) = along(section, omega, &series.axis.values, y, v, &loads);
    let column = |name: String, unit: &str, values| Column { name, unit: unit.into(), values };
    let mut table = Series { axis: column("depth".into(), "m", depths), columns: Vec::new() };
    let all = (0..PLACES).map(|k| wear.iter().map(|w| w[k]).sum()).collect();
    let mut lines = Vec::new();
    for (i, (name, own)) in rings.iter().zip(wear).enumerate() {
        if loads[i].is_some() {
            lines.push((name.clone(), format!("ring{}.wear_load", i + 1)));
            table.columns.push(column(format!("ring{}.wear_load", i + 1), "J/m2", own));
        }
    }
    if lines.len() > 1 {
        lines.push(("all rings".into(), "wear_load".into()));
        table.columns.push(column("wear_load".into(), "J/m2", all));
    }
    out.tables.insert("liner_wear".into(), table);
    out.figures.push(Figure {
        title: "Wear load of the liner".into(),
        hint: "pressure of solid contact times the way that it slides, in a cycle, over the depth below the crown at the upper dead centre; times a coefficient of wear (m³/(N m), Archard) it is the depth worn per cycle".into(),
        table: "liner_wear".into(),
        kind: FigureKind::Lines(Lines { x: "depth".into(), lines, y_name: "per cycle".into(), ..Lines::default() }),
    });
}
