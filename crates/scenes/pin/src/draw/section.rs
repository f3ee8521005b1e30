//! Section along the pin with bosses and small end, and across it, deformations enlarged.

use std::f64::consts::PI;

use gudgeon_core::elementary;
use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_core::result::{FigureKind, Frame, RunResult, Shape, Style};

use super::shapes::{block, dimension, figure, path, round_scale};
use crate::case::{Pin, PinCase};
use crate::setup::Setup;

/// Dimensions of the drawing in millimetres.
struct Section {
    length: f64,
    outer: f64,
    inner: f64,
    gap: f64,
    rod_width: f64,
    bore: f64,
    /// Distance of the pressure centres of the bosses.
    centres: f64,
    /// Wall of the bosses as drawn.
    boss: f64,
    /// Wall of the small end as drawn.
    eye: f64,
    /// Abscissa of the axis of the section across.
    across: f64,
}

impl Section {
    fn new(pin: &Pin, s: &Setup, size: &PinSize) -> Self {
        let (outer, bore) = (1e3 * size.outer, 1e3 * s.bore);
        let (offset, slope) = pin.boss_bore.centres(s.boss_gap);
        Self {
            length: 1e3 * size.length,
            outer,
            inner: 1e3 * size.inner,
            gap: 1e3 * s.boss_gap,
            rod_width: 1e3 * pin.rod_width.si(),
            bore,
            centres: 1e3 * (offset + slope * size.length),
            boss: 0.42 * outer,
            eye: 0.28 * outer,
            across: 0.5 * bore + 1.45 * outer,
        }
    }

    /// Bosses, small end and pin, cut along the axis; the forces on them.
    fn along(&self, fixed: &mut Vec<Shape>) {
        let (l, o, i) = (self.length, self.outer, self.inner);
        for side in [-1.0, 1.0] {
            for up in [-1.0, 1.0] {
                let wall = |inner: f64, outer: f64| [up * 0.5 * inner, up * (0.5 * inner + outer)];
                let boss = [side * 0.5 * self.gap, side * 0.5 * l];
                fixed.push(block(boss, wall(o, self.boss), Style::Metal));
                if side > 0.0 {
                    let eye = [-0.5 * self.rod_width, 0.5 * self.rod_width];
                    fixed.push(block(eye, wall(o, self.eye), Style::Metal));
                    fixed.push(block([-0.5 * l, 0.5 * l], [up * 0.5 * i, up * 0.5 * o], Style::Cut));
                }
            }
            // Where the forces act: down on the bosses' pressure centres.
            let x = side * 0.5 * self.centres;
            let y = 0.5 * o + self.boss;
            fixed.push(path(vec![[x, y + 0.3 * o], [x, y]], false, Style::Second));
            fixed.push(path(
                vec![[x - 0.05 * o, y + 0.1 * o], [x, y], [x + 0.05 * o, y + 0.1 * o]],
                false,
                Style::Second,
            ));
            let liner = side * 0.5 * self.bore;
            fixed.push(path(vec![[liner, -0.9 * o], [liner, 0.9 * o]], false, Style::Dashed));
        }
        let y = -0.5 * o - self.eye;
        fixed.push(path(vec![[0.0, y - 0.2 * o], [0.0, y]], false, Style::Second));
        let head = vec![[-0.05 * o, y - 0.1 * o], [0.0, y], [0.05 * o, y - 0.1 * o]];
        fixed.push(path(head, false, Style::Second));
        let axis = vec![[-0.5 * self.bore - 2.0, 0.0], [0.5 * self.bore + 2.0, 0.0]];
        fixed.push(path(axis, false, Style::Axis));
    }

    fn dimensions_along(&self, fixed: &mut Vec<Shape>) {
        let o = self.outer;
        let across = |half: f64, y: f64| ([-0.5 * half, y], [0.5 * half, y]);
        let low = -0.5 * o - self.boss;
        let (left, right) = across(self.length, low);
        fixed.push(dimension(right, left, 0.6 * o, "L", self.length));
        let (left, right) = across(self.bore, -0.9 * o);
        fixed.push(dimension(right, left, 0.95 * o, "D", self.bore));
        let (left, right) = across(self.gap, low);
        fixed.push(dimension(left, right, -0.28 * o, "D3", self.gap));
        let (left, right) = across(self.rod_width, 0.5 * o + self.eye);
        fixed.push(dimension(left, right, 0.18 * o, "B", self.rod_width));
        let (left, right) = across(self.centres, 0.5 * o + self.boss + 0.3 * o);
        fixed.push(dimension(left, right, 0.2 * o, "a", self.centres));
    }

    fn across(&self, fixed: &mut Vec<Shape>) {
        let (cx, o, i) = (self.across, self.outer, self.inner);
        fixed.push(Shape::Circle { centre: [cx, 0.0], radius: 0.5 * o, style: Style::Cut });
        if i > 0.0 {
            fixed.push(Shape::Circle { centre: [cx, 0.0], radius: 0.5 * i, style: Style::Hollow });
        }
        fixed.push(path(vec![[cx - 0.75 * o, 0.0], [cx + 0.75 * o, 0.0]], false, Style::Axis));
        fixed.push(path(vec![[cx, -0.75 * o], [cx, 0.75 * o]], false, Style::Axis));
        fixed.push(dimension([cx + 0.5 * o, 0.0], [cx - 0.5 * o, 0.0], 1.0 * o, "outer", o));
        fixed.push(dimension([cx - 0.5 * i, 0.0], [cx + 0.5 * i, 0.0], 1.0 * o, "inner", i));
    }
}

/// Deformations under the design load in millimetres, and their common scale.
struct Deformed<'a> {
    section: &'a Section,
    line: Vec<[f64; 2]>,
    deflection: f64,
    ovalisation: f64,
    scale: f64,
}

impl<'a> Deformed<'a> {
    fn new(section: &'a Section, deflection: f64, ovalisation: f64) -> Self {
        // One scale for both, a round number that shows the larger as a tenth of the pin.
        let scale = round_scale(0.1 * section.outer / deflection.max(ovalisation).max(1e-12));
        let line = bending_line(section.centres, section.rod_width);
        Self { section, line, deflection, ovalisation, scale }
    }

    /// Axis and outline under a part of the design load.
    fn frame(&self, part: f64, label: String) -> Frame {
        let left = self.line.iter().rev().map(|[x, y]| [-x, *y]);
        let right = self.line.iter().skip(1).copied();
        let bent = left.chain(right).map(|[x, y]| [x, self.scale * self.deflection * part * y]).collect();
        let ring = (0..120)
            .map(|k| {
                let t = PI * f64::from(k) / 60.0;
                // Shorter across the force, as much longer beside it.
                let r = 0.5 * self.section.outer
                    + 0.5 * self.scale * self.ovalisation * part * elementary::cos(2.0 * t);
                [self.section.across + r * elementary::cos(t), r * elementary::sin(t)]
            })
            .collect();
        let shapes = vec![path(bent, false, Style::Accent), path(ring, true, Style::Accent)];
        Frame { label, at: None, shapes }
    }

    /// The design load alone, or from it on once round the cycle.
    fn frames(&self, s: &Setup) -> Vec<Frame> {
        let cycle = &s.load.cycle;
        if cycle.is_empty() {
            return vec![self.frame(1.0, String::new())];
        }
        let n = cycle.len();
        let step = (n / 72).max(1);
        let design = &s.load.design;
        let first = cycle.iter().position(|i| i.theta >= design.theta).unwrap_or(0);
        (0..n / step)
            .map(|k| &cycle[(first + k * step) % n])
            .map(|i| {
                let force = i.forces.total();
                let label = format!("{:.0} deg, {:.1} kN", i.theta.to_degrees(), 1e-3 * force);
                self.frame(force / design.forces.total().abs(), label)
            })
            .collect()
    }
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

/// Draws the sections.
pub fn section(case: &PinCase, s: &Setup, size: &PinSize, out: &mut RunResult) {
    let Some(pin) = &case.pin else { return };
    let Ok(q) = s.strength.quantities(size, &s.load.design.forces) else { return };
    let section = Section::new(pin, s, size);
    let mut fixed = Vec::new();
    section.along(&mut fixed);
    section.dimensions_along(&mut fixed);
    section.across(&mut fixed);
    let mm = |k: PinQuantity| 1e3 * q[k as usize];
    let deformed = Deformed::new(&section, mm(PinQuantity::Deflection), mm(PinQuantity::Ovalisation));
    let frames = deformed.frames(s);
    let hint = format!(
        "in millimetres; bending of the axis ({:.1} um) and ovalisation ({:.1} um) enlarged {:.0} times",
        1e3 * deformed.deflection,
        1e3 * deformed.ovalisation,
        deformed.scale
    );
    figure(out, "Pin, bosses and small end", hint, FigureKind::Drawing { apart: false, fixed, frames });
}
