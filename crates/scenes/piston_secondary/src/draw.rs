//! Pictures of the motion: the piston in its bore, gap, wear and pressures of both sides of its skirt, the spectrum of its slap.

use gudgeon_core::result::{
    Anchor, Column, Figure, FigureKind, Frame, Lines, Mark, RunResult, Series, Shape, Style,
};
use gudgeon_numerics::elementary;
use gudgeon_skirt::Side;

use super::assembly::Assembly;
use super::plan::tidy;
use super::record::{Map, Record, Wear};
use super::spectrum::{SLAP, Spectrum};

/// Title of the picture that leads.
pub const PISTON: &str = "The piston in its bore";
/// Crank angle between the pictures of the piston \[deg\].
const FRAME: f64 = 5.0;
/// Part of the radius that the clearance takes up in the picture.
const SHOWN: f64 = 0.35;
/// Depths at which the outline of the skirt is drawn, less one.
const OUTLINE: usize = 16;
/// Half the width of the crown over the radius.
const LAND: f64 = 0.97;
/// Part of the radius that the highest pressure takes up beside the liner.
const PRESSURE: f64 = 0.9;

/// Adds the figures of a run.
pub fn figures(a: &Assembly, record: &Record, result: &mut RunResult) {
    result.figures.push(piston(a, record));
    gaps(a, record, result);
    wear(a, record, result);
    let names = ["thrust", "anti_thrust"];
    let words = ["thrust side", "anti-thrust side"];
    for k in 0..2 {
        let (maps, peak, side) = (&record.maps[k], &record.peak[k], &a.piston.sides[k]);
        if maps.is_empty() || peak.p.is_empty() {
            continue;
        }
        let table = format!("{}_cycle", names[k]);
        result.tables.insert(table.clone(), middle_over_cycle(side, maps));
        result.figures.push(Figure {
            title: format!("Pressure on the {} over the cycle", words[k]),
            hint: "along the middle of the side, height above the lower edge".into(),
            table,
            kind: FigureKind::Map {
                x: "crank_angle".into(),
                y: "height".into(),
                value: "p".into(),
                marks: Vec::new(),
            },
        });
        let table = format!("{}_pressure", names[k]);
        result.tables.insert(table.clone(), over_side(side, peak));
        result.figures.push(Figure {
            title: format!("Pressure on the {} at {:.1}°", words[k], peak.theta_deg),
            hint: "when it is highest; angle from the middle of the side, height above the lower edge".into(),
            table,
            kind: FigureKind::Map {
                x: "angle".into(),
                y: "height".into(),
                value: "p".into(),
                marks: Vec::new(),
            },
        });
    }
}

fn column(name: &str, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values }
}

/// Curves over the height above the lower edge.
fn over_height(table: &str, title: &str, hint: String, lines: Vec<(String, String)>, y_name: &str) -> Figure {
    let kind = Lines { x: "height".into(), lines, y_name: y_name.into(), ..Lines::default() };
    Figure { title: title.into(), hint, table: table.into(), kind: FigureKind::Lines(kind) }
}

/// Table `skirt_gap` and its figure: the gap along the middle of both sides, of the centred skirt and when either carries most.
fn gaps(a: &Assembly, record: &Record, result: &mut RunResult) {
    let (length, x) = (a.piston.body.length, &a.piston.sides[0].grid().x);
    let over = |f: &dyn Fn(f64) -> f64| x.iter().rev().map(|x| f(*x)).collect::<Vec<f64>>();
    let centred = |depth: f64| a.clearance + a.profile.depth(depth, 0.0);
    let mut table = Series {
        axis: column("height", "m", over(&|x| length - x)),
        columns: vec![column("centred", "m", over(&centred))],
    };
    let mut lines = vec![("hot, centred".to_owned(), "centred".to_owned())];
    let mut told = Vec::new();
    for (k, (name, side)) in
        [("thrust", "thrust side"), ("anti_thrust", "anti-thrust side")].iter().enumerate()
    {
        let (at, own) = (&record.loaded[k], &a.piston.sides[k]);
        if at.gap.is_empty() {
            continue;
        }
        told.push(format!("{side} at {}° under {:.0} N", at.theta_deg, at.force));
        let [top, bottom] = at.edges.map(|e| own.sign * e);
        let rigid = |depth: f64| centred(depth) + top + (bottom - top) * depth / length;
        let mut gap = middle(own, &at.gap);
        gap.reverse();
        lines.push(((*side).to_owned(), format!("{name}.gap")));
        table.columns.push(column(&format!("{name}.gap"), "m", gap));
        if a.elastic {
            lines.push((format!("{side}, without yielding"), format!("{name}.rigid_gap")));
            table.columns.push(column(&format!("{name}.rigid_gap"), "m", over(&rigid)));
        }
    }
    let hint = format!(
        "between the mean planes of skirt and liner along the middle of each side, the bore at 0: of the centred piston and where each side carries most ({}); negative where crests overlap",
        told.join(", ")
    );
    result.tables.insert("skirt_gap".into(), table);
    result.figures.push(over_height(
        "skirt_gap",
        "Hot profile and clearance of the skirt",
        hint,
        lines,
        "gap",
    ));
}

/// Table `skirt_wear` and its figure: load of solid contact times way, by height; none where nothing touches.
fn wear(a: &Assembly, record: &Record, result: &mut RunResult) {
    let Wear { depths, sides, .. } = &record.wear;
    if sides.iter().flatten().all(|w| *w <= 0.0) {
        return;
    }
    let height = depths[0].iter().rev().map(|x| a.piston.body.length - x).collect();
    let of = |k: usize, name: &str| column(name, "J/m2", sides[k].iter().rev().copied().collect());
    result.tables.insert(
        "skirt_wear".into(),
        Series {
            axis: column("height", "m", height),
            columns: vec![of(0, "thrust.wear_load"), of(1, "anti_thrust.wear_load")],
        },
    );
    let lines = [("thrust side", "thrust.wear_load"), ("anti-thrust side", "anti_thrust.wear_load")]
        .map(|(label, name)| (label.to_owned(), name.to_owned()));
    result.figures.push(over_height(
        "skirt_wear",
        "Wear load of the skirt",
        "pressure of solid contact times speed over a cycle, mean over the arc of the side; times a coefficient of wear (m³/(N m), Archard) it is the depth worn per cycle".into(),
        lines.to_vec(),
        "per cycle",
    ));
}

/// Table `slap_spectrum` and its figure.
pub fn slap(spectrum: &Spectrum, result: &mut RunResult) {
    let [thrust, anti_thrust] = spectrum.slap();
    result.tables.insert("slap_spectrum".into(), spectrum.table());
    result.figures.push(Figure {
        title: "Slap spectrum".into(),
        hint: format!(
            "amplitude (half of peak to peak) of every harmonic of the cycle in the force of film and contact on each side; order 1 is {:.2} Hz; slap from {:.0} Hz on: {thrust:.2} N rms on the thrust side, {anti_thrust:.2} N on the other",
            spectrum.cycle * spectrum.turns,
            SLAP
        ),
        table: "slap_spectrum".into(),
        kind: FigureKind::Lines(Lines {
            x: "frequency".into(),
            lines: vec![
                ("thrust side".into(), "thrust.force".into()),
                ("anti-thrust side".into(), "anti_thrust.force".into()),
            ],
            log_y: true,
            y_name: "force".into(),
            marks: vec![Mark::At { x: SLAP, label: "slap from here".into() }],
            ..Lines::default()
        }),
    });
}

/// The line of nodes in the middle of a side, from the upper edge down, or the mean of the two beside it.
fn middle(side: &Side, p: &[f64]) -> Vec<f64> {
    let (nx, ny) = (side.grid().x.len(), side.grid().y.len());
    let (low, high) = ((ny - 1) / 2 * nx, ny / 2 * nx);
    (0..nx).map(|i| 0.5 * (p[low + i] + p[high + i])).collect()
}

fn middle_over_cycle(side: &Side, maps: &[Map]) -> Series {
    let (mut theta, mut height, mut p) = (Vec::new(), Vec::new(), Vec::new());
    for i in (0..side.grid().x.len()).rev() {
        for map in maps {
            theta.push(map.theta_deg);
            height.push(side.panel.length - side.grid().x[i]);
            p.push(middle(side, &map.p)[i]);
        }
    }
    Series {
        axis: column("crank_angle", "deg", theta),
        columns: vec![column("height", "m", height), column("p", "Pa", p)],
    }
}

fn over_side(side: &Side, map: &Map) -> Series {
    let grid = side.grid();
    let nx = grid.x.len();
    let (mut angle, mut height, mut p) = (Vec::new(), Vec::new(), Vec::new());
    for i in (0..nx).rev() {
        for (j, y) in grid.y.iter().enumerate() {
            angle.push((y / side.panel.radius).to_degrees());
            height.push(side.panel.length - grid.x[i]);
            p.push(map.p[j * nx + i]);
        }
    }
    Series {
        axis: column("angle", "deg", angle),
        columns: vec![column("height", "m", height), column("p", "Pa", p)],
    }
}

fn line(points: Vec<[f64; 2]>, closed: bool, style: Style) -> Shape {
    Shape::Path { points, closed, style }
}

fn text(at: [f64; 2], text: String, anchor: Anchor) -> Shape {
    Shape::Text { at, text, anchor }
}

/// Sizes of the picture \[m\]. Heights count from the crank axis.
struct Picture<'a> {
    a: &'a Assembly,
    record: &'a Record,
    radius: f64,
    /// Factor of everything that happens across the bore.
    magnified: f64,
    /// Distance of the liner from the axis.
    wall: f64,
    /// Thickness of the liner.
    thick: f64,
    /// Upper and lower end of the liner.
    head: f64,
    end: f64,
    /// Height of the crown above the upper edge of the skirt, negative as a depth.
    up: f64,
    /// Highest film pressure \[Pa\].
    highest: f64,
}

/// The piston in its bore, to scale but for what happens across it.
fn piston(a: &Assembly, record: &Record) -> Figure {
    let p = Picture::new(a, record);
    let rows = record.rows();
    let every = ((FRAME.to_radians() / (rows[1] - rows[0])).round() as usize).max(1);
    let frames = (0..rows.len()).step_by(every).map(|k| p.frame(k)).collect();
    Figure {
        title: PISTON.into(),
        hint: format!(
            "piston to scale, its skirt, profile and clearance magnified {:.0} times; film pressure along the middle of both sides, {:.1} bar at most",
            p.magnified,
            1e-5 * p.highest
        ),
        table: String::new(),
        kind: FigureKind::Drawing { apart: false, fixed: p.fixed(), frames },
    }
}

impl<'a> Picture<'a> {
    fn new(a: &'a Assembly, record: &'a Record) -> Self {
        let body = &a.piston.body;
        let radius = a.piston.sides[0].panel.radius;
        let magnified = SHOWN * radius / a.clearance;
        let wall = radius + SHOWN * radius;
        let (top, stroke) = (a.kinematics.y_tdc(), a.kinematics.stroke());
        let crown = body.pin.max(0.0) + 0.5 * radius;
        Self {
            a,
            record,
            radius,
            magnified,
            wall,
            thick: 0.12 * radius,
            head: top + crown + 0.1 * radius,
            end: top - stroke - (body.length - body.pin) - 0.1 * radius,
            up: body.pin - crown,
            highest: record.maps.iter().flatten().flat_map(|m| &m.p).fold(1.0_f64, |m, p| m.max(*p)),
        }
    }

    /// Displacement at a depth below the upper edge of the skirt in row `k`, magnified.
    fn moved(&self, k: usize, depth: f64) -> f64 {
        let (et, eb) = (self.record.column("skirt.e_top"), self.record.column("skirt.e_bottom"));
        self.magnified * (et[k] + (eb[k] - et[k]) * depth / self.a.piston.body.length)
    }

    /// The liner, the way of the crank pin, and what is written on them.
    fn fixed(&self) -> Vec<Shape> {
        let Self { radius, wall, thick, head, end, .. } = *self;
        let mut fixed =
            vec![line(vec![[0.0, head + 0.2 * radius], [0.0, end - 0.3 * radius]], false, Style::Axis)];
        for side in [-1.0, 1.0] {
            let x = side * wall;
            fixed.push(line(
                vec![[x, head], [x + side * thick, head], [x + side * thick, end], [x, end]],
                true,
                Style::Cut,
            ));
        }
        fixed.push(text([-wall - thick, head + 0.2 * radius], "thrust side".into(), Anchor::Middle));
        fixed.push(text([wall + thick, head + 0.2 * radius], "anti-thrust side".into(), Anchor::Middle));
        fixed.push(Shape::Dimension {
            from: [-wall, end],
            to: [-radius, end],
            offset: -0.45 * radius,
            text: String::new(),
        });
        // Beside the arrows, which leave no room for it.
        let clearance = format!("{} µm", tidy(1e6 * self.a.clearance));
        fixed.push(text([-wall - 0.1 * radius, end - 0.45 * radius], clearance, Anchor::End));
        fixed
    }

    /// The crank axis.
    fn centre(&self) -> [f64; 2] {
        [-self.a.piston.crank.crank_offset, 0.0]
    }

    /// The piston, the rod and the pressures of row `k`.
    fn frame(&self, k: usize) -> Frame {
        let (body, crank, radius) = (&self.a.piston.body, &self.a.piston.crank, self.radius);
        let theta = self.record.rows()[k];
        let y = self.a.kinematics.motion(theta).y;
        let height = |depth: f64| y + body.pin - depth;
        // The body stands still and to scale: what moves is its skirt in the clearance, magnified.
        let fixed = |across: f64, depth: f64| [across, height(depth)];
        let at = |across: f64, depth: f64| [across + self.moved(k, depth), height(depth)];
        let depth = |i: usize| body.length * i as f64 / OUTLINE as f64;
        // How far the skirt stands back.
        let relief = |depth: f64| self.magnified * self.a.profile.depth(depth, 0.0);
        let (land, up) = (LAND * radius, self.up);
        let mut outline = vec![fixed(-land, 0.0), fixed(-land, up), fixed(land, up), fixed(land, 0.0)];
        outline.extend((0..=OUTLINE).map(|i| at(radius - relief(depth(i)), depth(i))));
        outline.extend((0..=OUTLINE).rev().map(|i| at(relief(depth(i)) - radius, depth(i))));
        let mut shapes = vec![line(outline, true, Style::Metal)];
        let pin = fixed(-crank.pin_offset, body.pin);
        let (sin, cos) = elementary::sin_cos(theta);
        let centre = self.centre();
        let crank_pin = [centre[0] + crank.radius * sin, crank.radius * cos];
        // The rod as far as the liner reaches.
        let part = ((pin[1] - self.end) / (pin[1] - crank_pin[1])).min(1.0);
        let cut = [pin[0] + part * (crank_pin[0] - pin[0]), pin[1] + part * (crank_pin[1] - pin[1])];
        shapes.push(line(vec![pin, cut], false, Style::Outline));
        shapes.push(Shape::Circle { centre: pin, radius: 0.22 * radius, style: Style::Hollow });
        let deg = tidy(theta.to_degrees());
        self.pressures(deg, height, &mut shapes);
        let (et, eb) = (self.record.column("skirt.e_top"), self.record.column("skirt.e_bottom"));
        let force = self.record.column("skirt.side_force");
        // Adding zero turns -0 into 0.
        let told = format!(
            "upper edge {:.2} µm, lower edge {:.2} µm, side force {:.0} N",
            1e6 * et[k] + 0.0,
            1e6 * eb[k] + 0.0,
            force[k].round() + 0.0
        );
        shapes.push(text([0.0, self.head + 0.55 * radius], told, Anchor::Middle));
        Frame { label: format!("{deg}°"), at: Some(deg), shapes }
    }

    /// Film pressure along the middle of both sides, standing on the liner.
    fn pressures(&self, deg: f64, height: impl Fn(f64) -> f64, shapes: &mut Vec<Shape>) {
        for (side, direction) in [(0, -1.0), (1, 1.0)] {
            let Some(map) = self.record.maps[side].iter().find(|m| (m.theta_deg - deg).abs() < 1e-6) else {
                continue;
            };
            let own = &self.a.piston.sides[side];
            let p = middle(own, &map.p);
            if p.iter().all(|p| *p <= 0.0) {
                continue;
            }
            let from = direction * (self.wall + self.thick);
            let reach = |p: f64| from + direction * PRESSURE * self.radius * p.max(0.0) / self.highest;
            let mut points = vec![[from, height(0.0)]];
            points.extend(own.grid().x.iter().zip(&p).map(|(x, p)| [reach(*p), height(*x)]));
            points.push([from, height(self.a.piston.body.length)]);
            shapes.push(line(points, true, Style::Oil));
        }
    }
}
