//! Drawings of the report: section of pin and bosses, utilisation bars, design map, skirt. Coordinates in millimetres.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PIN_QUANTITIES, PinQuantity, PinSize};
use gudgeon_core::result::{Anchor, Bar, Figure, FigureKind, Frame, RunResult, Shape, Style};
use gudgeon_pin::design::Design;
use gudgeon_pin::piston::oval_radius;

use super::case::PinCase;
use super::setup::Setup;

fn path(points: Vec<[f64; 2]>, closed: bool, style: Style) -> Shape {
    Shape::Path { points, closed, style }
}

fn block(x: [f64; 2], y: [f64; 2], style: Style) -> Shape {
    path(vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]], true, style)
}

fn text(at: [f64; 2], text: impl Into<String>, anchor: Anchor) -> Shape {
    Shape::Text { at, text: text.into(), anchor }
}

fn dimension(from: [f64; 2], to: [f64; 2], offset: f64, name: &str, mm: f64) -> Shape {
    // Three decimals: micrometres; trailing zeros say nothing.
    let number = format!("{mm:.3}");
    let number = number.trim_end_matches('0').trim_end_matches('.');
    Shape::Dimension { from, to, offset, text: format!("{name} {number}") }
}

fn figure(out: &mut RunResult, title: &str, hint: String, kind: FigureKind) {
    out.figures.push(Figure { title: title.into(), hint, table: String::new(), kind });
}

/// Bending line of the beam under its spread load, from its middle to a pressure centre: ordinates from 1 in the middle to 0.
fn bending_line(centres: f64, width: f64) -> Vec<[f64; 2]> {
    const N: usize = 60;
    let half = 0.5 * centres;
    let moment = |x: f64| (half - x) - (0.5 * width - x).max(0.0).powi(2) / width;
    let (mut slope, mut sag) = (0.0, 0.0);
    let h = half / N as f64;
    let mut points = vec![[0.0, 0.0]];
    for k in 0..N {
        let m = moment((k as f64 + 0.5) * h);
        sag += slope * h + 0.5 * m * h * h;
        slope += m * h;
        points.push([(k + 1) as f64 * h, sag]);
    }
    points.into_iter().map(|[x, y]| [x, 1.0 - y / sag]).collect()
}

/// Section along the pin with bosses and small end, and across it, deformations enlarged.
pub fn section(case: &PinCase, s: &Setup, size: &PinSize, out: &mut RunResult) {
    let Some(pin) = &case.pin else { return };
    let (l, o, i) = (1e3 * size.length, 1e3 * size.outer, 1e3 * size.inner);
    let (gap, rod, bore) = (1e3 * s.boss_gap, 1e3 * pin.rod_width.si(), 1e3 * s.bore);
    let (offset, slope) = pin.boss_bore.centres(s.boss_gap);
    let centres = 1e3 * (offset + slope * size.length);
    let (boss, eye) = (0.42 * o, 0.28 * o);
    let mut fixed = Vec::new();
    for side in [-1.0, 1.0] {
        for up in [-1.0, 1.0] {
            let wall = |inner: f64, outer: f64| [up * 0.5 * inner, up * (0.5 * inner + outer)];
            fixed.push(block([side * 0.5 * gap, side * 0.5 * l], wall(o, boss), Style::Metal));
            if side > 0.0 {
                fixed.push(block([-0.5 * rod, 0.5 * rod], wall(o, eye), Style::Metal));
                fixed.push(block([-0.5 * l, 0.5 * l], [up * 0.5 * i, up * 0.5 * o], Style::Cut));
            }
        }
        // Where the forces act: down on the bosses' pressure centres.
        let x = side * 0.5 * centres;
        let y = 0.5 * o + boss;
        fixed.push(path(vec![[x, y + 0.3 * o], [x, y]], false, Style::Second));
        fixed.push(path(
            vec![[x - 0.05 * o, y + 0.1 * o], [x, y], [x + 0.05 * o, y + 0.1 * o]],
            false,
            Style::Second,
        ));
        fixed.push(path(
            vec![[side * 0.5 * bore, -0.9 * o], [side * 0.5 * bore, 0.9 * o]],
            false,
            Style::Dashed,
        ));
    }
    let y = -0.5 * o - eye;
    fixed.push(path(vec![[0.0, y - 0.2 * o], [0.0, y]], false, Style::Second));
    fixed.push(path(vec![[-0.05 * o, y - 0.1 * o], [0.0, y], [0.05 * o, y - 0.1 * o]], false, Style::Second));
    fixed.push(path(vec![[-0.5 * bore - 2.0, 0.0], [0.5 * bore + 2.0, 0.0]], false, Style::Axis));
    let low = -0.5 * o - boss;
    fixed.push(dimension([0.5 * l, low], [-0.5 * l, low], 0.6 * o, "L", l));
    fixed.push(dimension([0.5 * bore, -0.9 * o], [-0.5 * bore, -0.9 * o], 0.95 * o, "D", bore));
    fixed.push(dimension([-0.5 * gap, low], [0.5 * gap, low], -0.28 * o, "D3", gap));
    fixed.push(dimension([-0.5 * rod, 0.5 * o + eye], [0.5 * rod, 0.5 * o + eye], 0.18 * o, "B", rod));
    fixed.push(dimension(
        [-0.5 * centres, 0.5 * o + boss + 0.3 * o],
        [0.5 * centres, 0.5 * o + boss + 0.3 * o],
        0.2 * o,
        "a",
        centres,
    ));
    // Across.
    let cx = 0.5 * bore + 1.45 * o;
    fixed.push(Shape::Circle { centre: [cx, 0.0], radius: 0.5 * o, style: Style::Cut });
    if i > 0.0 {
        fixed.push(Shape::Circle { centre: [cx, 0.0], radius: 0.5 * i, style: Style::Hollow });
    }
    fixed.push(path(vec![[cx - 0.75 * o, 0.0], [cx + 0.75 * o, 0.0]], false, Style::Axis));
    fixed.push(path(vec![[cx, -0.75 * o], [cx, 0.75 * o]], false, Style::Axis));
    fixed.push(dimension([cx + 0.5 * o, 0.0], [cx - 0.5 * o, 0.0], 1.0 * o, "outer", o));
    fixed.push(dimension([cx - 0.5 * i, 0.0], [cx + 0.5 * i, 0.0], 1.0 * o, "inner", i));
    let Ok(q) = s.strength.quantities(size, &s.load.design.forces) else { return };
    let (sag, oval) = (1e3 * q[PinQuantity::Deflection as usize], 1e3 * q[PinQuantity::Ovalisation as usize]);
    // One scale for both, a round number that shows the greater as a tenth of the pin.
    let wanted = 0.1 * o / sag.max(oval).max(1e-12);
    let decade = 10f64.powf(wanted.log10().floor());
    let scale = decade * [1.0, 2.0, 5.0].into_iter().rev().find(|f| f * decade <= wanted).unwrap_or(1.0);
    let line = bending_line(centres, rod);
    let design = s.load.design.forces.total();
    let frame = |part: f64, label: String| {
        let bent = |up: f64| {
            let left = line.iter().rev().map(|[x, y]| [-x, *y]);
            let right = line.iter().skip(1).copied();
            left.chain(right).map(|[x, y]| [x, up + scale * sag * part * y]).collect::<Vec<_>>()
        };
        let ring: Vec<[f64; 2]> = (0..120)
            .map(|k| {
                let t = PI * f64::from(k) / 60.0;
                // Shorter across the force, as much longer beside it.
                let r = 0.5 * o + 0.5 * scale * oval * part * (2.0 * t).cos();
                [cx + r * t.cos(), r * t.sin()]
            })
            .collect();
        let shapes = vec![path(bent(0.0), false, Style::Accent), path(ring, true, Style::Accent)];
        Frame { label, shapes }
    };
    let frames = if s.load.cycle.is_empty() {
        vec![frame(1.0, String::new())]
    } else {
        // From the design load on, once round the cycle.
        let n = s.load.cycle.len();
        let step = (n / 72).max(1);
        let first = s.load.cycle.iter().position(|i| i.theta >= s.load.design.theta).unwrap_or(0);
        (0..n / step)
            .map(|k| &s.load.cycle[(first + k * step) % n])
            .map(|i| {
                frame(
                    i.forces.total() / design.abs(),
                    format!("{:.0} deg, {:.1} kN", i.theta.to_degrees(), 1e-3 * i.forces.total()),
                )
            })
            .collect()
    };
    let hint = format!(
        "in millimetres; bending of the axis ({:.1} um) and ovalisation ({:.1} um) enlarged {scale:.0} times",
        1e3 * sag,
        1e3 * oval
    );
    figure(out, "Pin, bosses and small end", hint, FigureKind::Drawing { fixed, frames });
}

/// Bars of all limits.
pub fn utilisation(d: &Design<'_>, size: &PinSize, out: &mut RunResult) -> Result<(), EvalError> {
    let u: [f64; PIN_QUANTITIES] = d.utilisation(size)?;
    let bars: Vec<Bar> = PinQuantity::ALL
        .into_iter()
        .filter(|q| d.limits[*q as usize].is_finite())
        .map(|q| Bar { label: q.words().into(), value: u[q as usize], limit: Some(1.0) })
        .collect();
    if !bars.is_empty() {
        let hint = "each quantity over its limit".to_owned();
        figure(out, "Utilisation of the limits", hint, FigureKind::Bars { unit: String::new(), bars });
    }
    Ok(())
}

/// Round steps that divide `span` into about `n` parts.
fn round_step(span: f64, n: f64) -> f64 {
    let raw = span / n;
    let decade = 10f64.powf(raw.log10().floor());
    decade * [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * decade >= raw).unwrap_or(10.0)
}

/// Points of a map along its abscissa.
const COLUMNS: usize = 160;

/// Length against bore at one outer diameter: what each limit leaves, lines of equal mass (less relief), the pin.
pub fn map(d: &Design<'_>, size: &PinSize, out: &mut RunResult) {
    let (w, h) = (110.0, 70.0);
    let from = (0.85 * size.length).max(d.length.low);
    let to = (1.2 * size.length).min(d.length.high.max(size.length * (1.0 + 1e-6)));
    let top = size.outer;
    let x = |l: f64| w * (l - from) / (to - from);
    let y = |i: f64| h * i / top;
    let lengths: Vec<f64> = (0..=COLUMNS).map(|k| from + (to - from) * k as f64 / COLUMNS as f64).collect();
    let mut fixed = Vec::new();
    // The region that all limits leave.
    let floor = d.least_inner(size.outer);
    let region: Vec<[f64; 2]> =
        lengths.iter().filter_map(|l| Some([x(*l), y(d.greatest_bore(*l, size.outer)?.min(top))])).collect();
    if region.len() > 1 {
        let mut points = region.clone();
        points.push([region[region.len() - 1][0], y(floor)]);
        points.push([region[0][0], y(floor)]);
        fixed.push(path(points, true, Style::Metal));
    }
    // Lines of equal mass.
    let mass = |l: f64, i: f64| d.masses(&PinSize { length: l, outer: size.outer, inner: i }).differential();
    let here = mass(size.length, size.inner);
    let step = round_step(2.0 * (mass(to, 0.0) - here).abs().max(1e-9), 14.0);
    for k in -3..=12 {
        let level = (here / step).floor() * step + f64::from(k) * step;
        let points: Vec<[f64; 2]> = lengths
            .iter()
            .filter_map(|&l| {
                let square = size.outer * size.outer
                    - (level + d.masses(&PinSize { length: l, outer: size.outer, inner: 0.0 }).relieved)
                        / (0.25 * d.pi * d.density * l);
                (square > 0.0 && square < top * top).then(|| [x(l), y(square.sqrt())])
            })
            .collect();
        if points.len() > COLUMNS / 6 {
            let [px, py] = points[points.len() / 12];
            fixed.push(path(points, false, Style::Dashed));
            fixed.push(text([px, py + 1.4], format!("{:.0} g", 1e3 * level), Anchor::Middle));
        }
    }
    // One line for each limit, with its name where it leaves the map.
    let mut names: Vec<(f64, String)> = Vec::new();
    for q in PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite()) {
        let bores: Vec<(f64, Option<f64>)> =
            lengths.iter().map(|l| (*l, d.bore_of_limit(q, *l, size.outer))).collect();
        if q == PinQuantity::BossPressure {
            // It forbids lengths, whatever the bore.
            let Some(k) = bores.iter().position(|(_, b)| b.is_some()).filter(|k| *k > 0) else { continue };
            let (mut bad, mut good) = (bores[k - 1].0, bores[k].0);
            for _ in 0..50 {
                let mid = 0.5 * (bad + good);
                if d.bore_of_limit(q, mid, size.outer).is_some() { good = mid } else { bad = mid }
            }
            fixed.push(path(vec![[x(good), 0.0], [x(good), h]], false, Style::Accent));
            fixed.push(text([x(good) + 1.0, h - 3.0], q.words(), Anchor::Start));
            continue;
        }
        let wall = d.greatest_inner(size.outer);
        let points: Vec<[f64; 2]> = bores
            .iter()
            .filter_map(|(l, b)| b.filter(|b| *b < wall * (1.0 - 1e-6)).map(|b| [x(*l), y(b)]))
            .collect();
        if points.len() < 2 {
            continue;
        }
        names.push((points[points.len() - 1][1], q.words().to_owned()));
        fixed.push(path(points, false, Style::Second));
    }
    names.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = f64::NEG_INFINITY;
    for (at, name) in names {
        let at = at.max(last + 3.6);
        last = at;
        fixed.push(text([w + 1.5, at], name, Anchor::Start));
    }
    fixed.push(text([w + 26.0, 0.0], "", Anchor::Start));
    axes(&mut fixed, (w, h), (1e3 * from, 1e3 * to), (0.0, 1e3 * top), ("length, mm", "bore, mm"));
    fixed.push(Shape::Circle { centre: [x(size.length), y(size.inner)], radius: 1.1, style: Style::Accent });
    fixed.push(text(
        [x(size.length) + 2.0, y(size.inner) - 3.2],
        format!("{:.2} g", 1e3 * here),
        Anchor::Start,
    ));
    let hint = format!(
        "at an outer diameter of {:.3} mm: filled, what all limits leave; lines, the greatest bore that each admits; dashed, equal mass of the pin, less relief",
        1e3 * size.outer
    );
    figure(out, "Design map", hint, FigureKind::Drawing { fixed, frames: Vec::new() });
}

/// A frame with ticks around a box.
fn axes(fixed: &mut Vec<Shape>, (w, h): (f64, f64), x: (f64, f64), y: (f64, f64), names: (&str, &str)) {
    fixed.push(path(vec![[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]], true, Style::Outline));
    let ticks = |(from, to): (f64, f64)| {
        let step = round_step(to - from, 6.0);
        let first = (from / step - 1e-9).ceil();
        (0..20).map(move |k| (first + f64::from(k)) * step).take_while(move |v| *v <= to + 1e-9 * step)
    };
    for v in ticks(x) {
        let at = w * (v - x.0) / (x.1 - x.0);
        fixed.push(path(vec![[at, 0.0], [at, -1.2]], false, Style::Thin));
        fixed.push(text(
            [at, -3.4],
            format!("{v:.4}").trim_end_matches('0').trim_end_matches('.'),
            Anchor::Middle,
        ));
    }
    for v in ticks(y) {
        let at = h * (v - y.0) / (y.1 - y.0);
        fixed.push(path(vec![[0.0, at], [-1.2, at]], false, Style::Thin));
        fixed.push(text(
            [-2.0, at],
            format!("{v:.4}").trim_end_matches('0').trim_end_matches('.'),
            Anchor::End,
        ));
    }
    fixed.push(text([0.5 * w, -7.4], names.0, Anchor::Middle));
    fixed.push(text([-2.0, h + 2.6], names.1, Anchor::Middle));
}

/// Barrel and oval of the skirt, enlarged.
pub fn skirt(bore: f64, height: f64, ovality: Option<f64>, out: &mut RunResult) {
    let Some(t) = out.tables.get("skirt") else { return };
    let Some(finished) = t.get("finished") else { return };
    let most = finished.values.iter().copied().fold(0.0f64, |a, b| a.max(b.abs()));
    if most == 0.0 && ovality.is_none() {
        return;
    }
    let (h, half) = (1e3 * height, 0.5e3 * bore);
    // The greatest ordinate shows as a seventh of the radius.
    let wanted = if most > 0.0 { half / 7.0 / (0.5e3 * most) } else { 1.0 };
    let decade = 10f64.powf(wanted.log10().floor());
    let scale = decade * [1.0, 2.0, 5.0].into_iter().rev().find(|f| f * decade <= wanted).unwrap_or(1.0);
    let side = |sign: f64| -> Vec<[f64; 2]> {
        let rows = t.axis.values.iter().zip(&finished.values);
        rows.map(|(x, y)| [sign * (half + scale * 0.5e3 * y), 1e3 * x]).collect()
    };
    let mut body = side(-1.0);
    let mut right = side(1.0);
    right.reverse();
    body.extend(right);
    let top = 1e3 * t.axis.values.last().copied().unwrap_or(height);
    let mut fixed = vec![path(body, true, Style::Metal)];
    for sign in [-1.0, 1.0] {
        fixed.push(path(vec![[sign * half, 0.0], [sign * half, top]], false, Style::Dashed));
    }
    fixed.push(path(vec![[0.0, -3.0], [0.0, h + 3.0]], false, Style::Axis));
    fixed.push(dimension([half, 0.0], [-half, 0.0], 7.0, "D", 2.0 * half));
    fixed.push(dimension([-half, 0.0], [-half, h], 5.0, "skirt", h));
    let mut hint = format!("in millimetres; the profile enlarged {scale:.0} times, open end below");
    if let Some(ov) = ovality {
        let wanted = half / 3.5 / (0.5e3 * ov);
        let decade = 10f64.powf(wanted.log10().floor());
        let scale = decade * [1.0, 2.0, 5.0].into_iter().rev().find(|f| f * decade <= wanted).unwrap_or(1.0);
        let (cx, cy) = (2.35 * half, 0.5 * h);
        let points = (0..180)
            .map(|k| {
                let a = PI * f64::from(k) / 90.0;
                let r = 1e3 * (0.5 * bore - scale * (0.5 * bore - oval_radius(bore, ov, a)));
                [cx + r * a.cos(), cy + r * a.sin()]
            })
            .collect();
        fixed.push(path(points, true, Style::Metal));
        fixed.push(Shape::Circle { centre: [cx, cy], radius: half, style: Style::Dashed });
        fixed.push(path(vec![[cx - half - 4.0, cy], [cx + half + 4.0, cy]], false, Style::Axis));
        fixed.push(path(vec![[cx, cy - half - 4.0], [cx, cy + half + 4.0]], false, Style::Axis));
        fixed.push(text([cx + half + 5.0, cy], "thrust", Anchor::Start));
        fixed.push(text([cx, cy + half + 6.0], "pin", Anchor::Middle));
        // Room for the word beside the axis.
        fixed.push(text([cx + half + 24.0, cy], "", Anchor::Start));
        hint += &format!("; the ovality of {:.1} um enlarged {scale:.0} times", 1e6 * ov);
    }
    figure(out, "Skirt", hint, FigureKind::Drawing { fixed, frames: Vec::new() });
}
