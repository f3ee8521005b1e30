//! Length against bore at one outer diameter: what each limit leaves, lines of equal mass (less relief), the pin.

use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_core::result::{Anchor, FigureKind, RunResult, Shape, Style};
use gudgeon_pin::design::Design;

use super::shapes::{axes, figure, path, round_step, text};

/// Points of a map along its abscissa.
const COLUMNS: usize = 160;
/// Width and height of the map.
const PAGE: (f64, f64) = (110.0, 70.0);

/// The map's part of the design space, and its way to the page.
struct Map<'a, 'b> {
    design: &'a Design<'b>,
    size: PinSize,
    /// Lengths at the edges \[m\].
    from: f64,
    to: f64,
    lengths: Vec<f64>,
}

impl<'a, 'b> Map<'a, 'b> {
    fn new(design: &'a Design<'b>, size: PinSize) -> Self {
        let from = (0.85 * size.length).max(design.length.low);
        let to = (1.2 * size.length).min(design.length.high.max(size.length * (1.0 + 1e-6)));
        let lengths = (0..=COLUMNS).map(|k| from + (to - from) * k as f64 / COLUMNS as f64).collect();
        Self { design, size, from, to, lengths }
    }

    /// Abscissa of a length.
    fn x(&self, length: f64) -> f64 {
        PAGE.0 * (length - self.from) / (self.to - self.from)
    }

    /// Ordinate of a bore.
    fn y(&self, bore: f64) -> f64 {
        PAGE.1 * bore / self.size.outer
    }

    fn mass(&self, length: f64, inner: f64) -> f64 {
        self.design.masses(&PinSize { length, outer: self.size.outer, inner }).differential()
    }

    /// The region that all limits leave.
    fn feasible(&self, fixed: &mut Vec<Shape>) {
        let outer = self.size.outer;
        let mut region: Vec<[f64; 2]> = self
            .lengths
            .iter()
            .filter_map(|l| Some([self.x(*l), self.y(self.design.max_feasible_inner(*l, outer)?.min(outer))]))
            .collect();
        if region.len() > 1 {
            let floor = self.y(self.design.min_inner(outer));
            let (first, last) = (region[0][0], region[region.len() - 1][0]);
            region.push([last, floor]);
            region.push([first, floor]);
            fixed.push(path(region, true, Style::Metal));
        }
    }

    /// Lines of equal mass.
    fn contours(&self, fixed: &mut Vec<Shape>) {
        let (d, outer) = (self.design, self.size.outer);
        let here = self.mass(self.size.length, self.size.inner);
        let step = round_step(2.0 * (self.mass(self.to, 0.0) - here).abs().max(1e-9), 14.0);
        for k in -3..=12 {
            let level = (here / step).floor() * step + f64::from(k) * step;
            let points: Vec<[f64; 2]> = self
                .lengths
                .iter()
                .filter_map(|&l| {
                    let relieved = d.masses(&PinSize { length: l, outer, inner: 0.0 }).relieved;
                    let square = outer * outer - (level + relieved) / (0.25 * d.pi * d.density * l);
                    (square > 0.0 && square < outer * outer).then(|| [self.x(l), self.y(square.sqrt())])
                })
                .collect();
            if points.len() > COLUMNS / 6 {
                let [px, py] = points[points.len() / 12];
                fixed.push(path(points, false, Style::Dashed));
                fixed.push(text([px, py + 1.4], format!("{:.0} g", 1e3 * level), Anchor::Middle));
            }
        }
    }

    /// One line for each limit, with its name where it leaves the map.
    fn limits(&self, fixed: &mut Vec<Shape>) {
        let d = self.design;
        let wall = d.max_inner(self.size.outer);
        let mut names: Vec<(f64, &str)> = Vec::new();
        for q in PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite()) {
            if q == PinQuantity::BossPressure {
                self.min_length(q, fixed);
                continue;
            }
            let points: Vec<[f64; 2]> = self
                .lengths
                .iter()
                .filter_map(|l| {
                    let bore = d.max_inner_of_limit(q, *l, self.size.outer)?;
                    (bore < wall * (1.0 - 1e-6)).then(|| [self.x(*l), self.y(bore)])
                })
                .collect();
            if points.len() >= 2 {
                names.push((points[points.len() - 1][1], q.words()));
                fixed.push(path(points, false, Style::Second));
            }
        }
        names.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut last = f64::NEG_INFINITY;
        for (at, name) in names {
            let at = at.max(last + 3.6);
            last = at;
            fixed.push(text([PAGE.0 + 1.5, at], name, Anchor::Start));
        }
    }

    /// The line of a limit that forbids lengths, whatever the bore.
    fn min_length(&self, q: PinQuantity, fixed: &mut Vec<Shape>) {
        let keeps = |length: f64| self.design.max_inner_of_limit(q, length, self.size.outer).is_some();
        let Some(k) = self.lengths.iter().position(|l| keeps(*l)).filter(|k| *k > 0) else { return };
        let (mut bad, mut good) = (self.lengths[k - 1], self.lengths[k]);
        for _ in 0..50 {
            let middle = 0.5 * (bad + good);
            if keeps(middle) { good = middle } else { bad = middle }
        }
        let x = self.x(good);
        fixed.push(path(vec![[x, 0.0], [x, PAGE.1]], false, Style::Accent));
        fixed.push(text([x + 1.0, PAGE.1 - 3.0], q.words(), Anchor::Start));
    }

    /// The pin itself.
    fn pin(&self, fixed: &mut Vec<Shape>) {
        let (x, y) = (self.x(self.size.length), self.y(self.size.inner));
        fixed.push(Shape::Circle { centre: [x, y], radius: 1.1, style: Style::Accent });
        let mass = self.mass(self.size.length, self.size.inner);
        fixed.push(text([x + 2.0, y - 3.2], format!("{:.2} g", 1e3 * mass), Anchor::Start));
    }
}

/// Draws the map around a pin.
pub fn map(d: &Design<'_>, size: &PinSize, out: &mut RunResult) {
    let map = Map::new(d, *size);
    let mut fixed = Vec::new();
    map.feasible(&mut fixed);
    map.contours(&mut fixed);
    map.limits(&mut fixed);
    fixed.push(text([PAGE.0 + 26.0, 0.0], "", Anchor::Start));
    let (x, y) = ((1e3 * map.from, 1e3 * map.to), (0.0, 1e3 * size.outer));
    axes(&mut fixed, PAGE, x, y, ("length, mm", "bore, mm"));
    map.pin(&mut fixed);
    let hint = format!(
        "at an outer diameter of {:.3} mm: filled, what all limits leave; lines, the greatest bore that each admits; dashed, equal mass of the pin, less relief",
        1e3 * size.outer
    );
    figure(out, "Design map", hint, FigureKind::Drawing { apart: false, fixed, frames: Vec::new() });
}
