//! Drawings: mode shapes on the line, the Campbell diagram.

use std::f64::consts::PI;

use gudgeon_core::kinds::{Line, LineLink, Mode};
use gudgeon_core::result::{Anchor, Figure, FigureKind, Frame, Lines, Mark, Shape, Style};
use gudgeon_numerics::elementary;
use gudgeon_torsion::critical::CriticalSpeed;
use gudgeon_torsion::tree::Tree;

use crate::rpm;

/// Where each inertia is drawn: along the line, branches below each other.
fn layout(line: &Line) -> Vec<[f64; 2]> {
    let n = line.nodes.len();
    let mut near = vec![Vec::new(); n];
    for l in &line.links {
        near[l.nodes[0]].push(l.nodes[1]);
        near[l.nodes[1]].push(l.nodes[0]);
    }
    // The longest way through the tree is the main line: twice the farthest node.
    let far = |from: usize| {
        let mut seen = vec![usize::MAX; n];
        let mut queue = vec![from];
        seen[from] = from;
        let mut last = from;
        let mut k = 0;
        while k < queue.len() {
            last = queue[k];
            for &j in &near[last] {
                if seen[j] == usize::MAX {
                    seen[j] = last;
                    queue.push(j);
                }
            }
            k += 1;
        }
        (last, seen)
    };
    let (end, _) = far(0);
    let (begin, _) = far(end);
    let (first, other) = (begin.min(end), begin.max(end));
    let (_, from) = far(first);
    let mut path = vec![other];
    while path[path.len() - 1] != first {
        path.push(from[path[path.len() - 1]]);
    }
    path.reverse();
    let mut at = vec![[f64::NAN; 2]; n];
    for (k, &i) in path.iter().enumerate() {
        at[i] = [k as f64, 0.0];
    }
    let mut row = 0.0;
    for &i in &path {
        let mut stack: Vec<(usize, f64)> =
            near[i].iter().filter(|j| at[**j][0].is_nan()).map(|j| (*j, at[i][0] + 0.5)).collect();
        while let Some((j, x)) = stack.pop() {
            if !at[j][0].is_nan() {
                continue;
            }
            // Every leaf of a branch has a row of its own.
            if stack.is_empty() || near[j].len() == 1 || row == 0.0 {
                row -= 3.0;
            }
            at[j] = [x, row];
            for &m in near[j].iter().filter(|m| at[**m][0].is_nan()) {
                stack.push((m, x + 1.0));
            }
        }
    }
    at
}

/// Places at rest of a shape: link and fraction of its length from the first of its inertias. The ring of a viscous damper hangs on no
/// stiffness, takes no part in an undamped mode, and does not count.
pub fn nodes(line: &Line, shape: &[f64]) -> Vec<(usize, f64)> {
    if shape.len() != line.nodes.len() {
        return Vec::new();
    }
    line.links
        .iter()
        .enumerate()
        .filter(|(_, link)| link.coupling.linear(0.0, 0.0).stiffness != 0.0)
        .filter_map(|(l, link)| {
            let [a, b] = link.nodes;
            // Gears turn the shape; seen from the reference shaft they do not.
            let (x, y) = (shape[a] / line.nodes[a].ratio, shape[b] / line.nodes[b].ratio);
            (x * y < 0.0).then(|| (l, x / (x - y)))
        })
        .collect()
}

/// Mode shapes drawn on the line, one frame each.
pub fn modes(line: &Line, modes: &[&Mode]) -> Figure {
    let at = layout(line);
    let mut fixed = shafts(line, &at);
    discs(line, &at, &mut fixed);
    let frames = modes.iter().enumerate().map(|(k, m)| frame(line, &at, k, m)).collect();
    let branched = Tree::new(line).is_ok_and(|t| !t.chain);
    Figure {
        title: "Mode shapes".into(),
        hint: format!(
            "angle of each inertia{}, of {}; circles on the shaft are places at rest",
            if branched { " as seen from the reference shaft, branches below the main line" } else { "" },
            line.nodes.iter().map(|n| n.name.as_str()).collect::<Vec<_>>().join(", ")
        ),
        table: String::new(),
        kind: FigureKind::Drawing { apart: true, fixed, frames },
    }
}

fn shafts(line: &Line, at: &[[f64; 2]]) -> Vec<Shape> {
    let shaft = |l: &LineLink| {
        let [a, b] = l.nodes.map(|i| at[i]);
        let points = if a[1] == b[1] { vec![a, b] } else { vec![a, [a[0], b[1]], b] };
        Shape::Path { points, closed: false, style: Style::Axis }
    };
    line.links.iter().map(shaft).collect()
}

/// Discs as tall as the cube root of their inertia, at least visible, with their names where these have room.
fn discs(line: &Line, at: &[[f64; 2]], fixed: &mut Vec<Shape>) {
    let n = line.nodes.len();
    let inertia: Vec<f64> = (0..n).map(|i| line.mean_inertia(i) * line.nodes[i].ratio.powi(2)).collect();
    let heaviest = inertia.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let ends = at.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[0]), b.max(p[0])));
    for i in 0..n {
        let h = (0.12 + 0.45 * elementary::cbrt(inertia[i] / heaviest)).min(0.6);
        let w = 0.10;
        let [x, y] = at[i];
        let points = vec![[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]];
        fixed.push(Shape::Path { points, closed: true, style: Style::Metal });
        if n <= 16 {
            fixed.push(name(line.nodes[i].name.clone(), [x, y], ends));
        }
    }
}

/// The name of a disc of a line between two ends.
fn name(text: String, [x, y]: [f64; 2], (left, right): (f64, f64)) -> Shape {
    // Every other name a little lower, long ones at the ends lower still, so that they do not meet.
    let end = x <= left || x >= right;
    let drop = match x.round() as i64 % 2 {
        _ if end && text.len() > 9 => 1.89,
        0 => 1.35,
        _ => 1.62,
    };
    // Names at the ends stay within the drawing.
    let (shift, anchor) = if x <= left {
        (-0.4, Anchor::Start)
    } else if x >= right {
        (0.4, Anchor::End)
    } else {
        (0.0, Anchor::Middle)
    };
    Shape::Text { at: [x + shift, y - drop], text, anchor }
}

/// Mode `k` on the line.
fn frame(line: &Line, at: &[[f64; 2]], k: usize, m: &Mode) -> Frame {
    let n = line.nodes.len();
    let scaled: Vec<f64> = (0..n).map(|i| m.shape[i] / line.nodes[i].ratio).collect();
    let top = scaled.iter().map(|s| s.abs()).fold(f64::MIN_POSITIVE, f64::max);
    let y = |i: usize| at[i][1] + 1.1 * scaled[i] / top;
    let mut shapes = Vec::new();
    for l in &line.links {
        let [a, b] = l.nodes;
        let points = vec![[at[a][0], y(a)], [at[b][0], y(b)]];
        shapes.push(Shape::Path { points, closed: false, style: Style::Accent });
    }
    for i in 0..n {
        shapes.push(Shape::Circle { centre: [at[i][0], y(i)], radius: 0.05, style: Style::Accent });
    }
    for (l, f) in nodes(line, &m.shape) {
        let [a, b] = line.links[l].nodes;
        let centre = [at[a][0] + f * (at[b][0] - at[a][0]), at[a][1] + f * (at[b][1] - at[a][1])];
        shapes.push(Shape::Circle { centre, radius: 0.09, style: Style::Second });
    }
    let damping = m
        .damped
        .map_or_else(String::new, |(d, w)| format!(", damping {:.2} %", 100.0 * d / elementary::hypot(d, w)));
    Frame { label: format!("mode {}: {:.2} Hz{damping}", k + 1, m.omega / (2.0 * PI)), at: None, shapes }
}

/// Title of the diagram that leads.
pub const CAMPBELL: &str = "Campbell diagram";

/// What the diagram marks on its axis of speeds \[rpm\].
pub struct Marked {
    /// The mean speed.
    pub running: f64,
    /// The operating range.
    pub operating: [f64; 2],
    /// The largest separation from an order that a limit asks for, as part of the speed; 0 where none does.
    pub margin: f64,
}

/// Campbell diagram of table `interference`: natural frequencies \[Hz\] over speeds \[rpm\], orders as rays, critical speeds where they
/// meet.
pub fn campbell(
    speeds: &[f64],
    levels: &[Vec<f64>],
    orders: &[f64],
    critical: &[CriticalSpeed],
    marked: &Marked,
) -> Figure {
    let to = speeds.iter().copied().fold(0.0, f64::max);
    // Modes that an order can reach, and one above.
    let reach = orders.last().copied().unwrap_or(1.0) * to / 60.0;
    let highest = |level: &Vec<f64>| level.iter().copied().fold(0.0, f64::max);
    let drawn = levels.iter().filter(|l| highest(l) <= reach).count().clamp(1, 12).min(levels.len());
    let top = 1.15 * highest(&levels[drawn - 1]);
    let lines = (1..=drawn).map(|k| (format!("mode {k}"), format!("mode{k}"))).collect();
    let rays = orders.iter().map(|o| (format!("{o}"), format!("order{o}"))).collect();
    let [low, high] = marked.operating;
    let mut marks = vec![Mark::At { x: marked.running, label: "mean speed".into() }];
    if high > low {
        marks.push(Mark::Band { from: low, to: high, kept_free: false, label: "operating range".into() });
    }
    if marked.margin > 0.0 {
        let label = format!("with a margin of {:.0} %", 100.0 * marked.margin);
        let (from, to) = (low * (1.0 - marked.margin), high * (1.0 + marked.margin));
        marks.push(Mark::Band { from, to, kept_free: true, label });
    }
    marks.extend(critical.iter().filter(|c| c.omega / (2.0 * PI) <= top).map(|c| {
        let x = rpm(c.speed);
        Mark::Point {
            x,
            y: c.omega / (2.0 * PI),
            weight: 0.0,
            beyond: x >= low && x <= high,
            label: format!("order {} excites mode {} at {x:.0} rpm", c.order, c.mode),
        }
    }));
    Figure {
        title: CAMPBELL.into(),
        hint: "natural frequencies over the speed, orders as rays with their numbers; critical speeds where they meet, red within the operating range".into(),
        table: "interference".into(),
        kind: FigureKind::Lines(Lines {
            x: "speed".into(),
            lines,
            rays,
            marks,
            y_name: "frequency".into(),
            top: Some(top),
            ..Lines::default()
        }),
    }
}
