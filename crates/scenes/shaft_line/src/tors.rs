//! Reader of openTorsion's TORS format: lines of disks, shafts and gears as JSON.
//!
//! The reader follows the chain of components as openTorsion 0.3 does: the elements of a component follow each other, a connection
//! goes on from one of its elements with the component it names. What the format says and this program does not take over is
//! reported, never dropped in silence.

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{CouplingSpec, Line, LineLink, LineNode};
use gudgeon_core::quantity::{NonNegative, Quantity, TorsionalDamping, TorsionalStiffness};
use gudgeon_torsion::coupling::{Linear, Off};
use gudgeon_torsion::shaft::{Piece, stiffness};
use serde_json::Value;

/// What was read.
#[derive(Debug, Default)]
pub struct Import {
    /// The line.
    pub line: Line,
    /// Stress by torque of each link.
    pub stress: Vec<Option<f64>>,
    /// What was understood in another way than openTorsion does, or not at all.
    pub report: Vec<String>,
}

/// Maximum number of elements of a file: a loop of connections is found here at the latest.
const MAX_ELEMENTS: usize = 100_000;

/// Reads a file.
///
/// # Errors
/// A file that cannot be read or is not TORS, with the place.
pub fn read(files: &Files, file: &str) -> Result<Import, String> {
    let text = files.text(file).map_err(|e| format!("cannot read {}: {e}", files.path(file).display()))?;
    parse(&text)
}

/// Reads a text.
///
/// # Errors
/// Text that is not TORS, with the place.
pub fn parse(text: &str) -> Result<Import, String> {
    let file: Value = serde_json::from_str(text).map_err(|e| format!("is not JSON: {e}"))?;
    let list = |key: &str| {
        file.get(key)
            .and_then(Value::as_array)
            .ok_or_else(|| format!("has no list `{key}`, as TORS files have"))
    };
    let (components, structure) = (list("components")?, list("structure")?);
    let mut reader = Reader {
        components,
        connections: Vec::new(),
        out: Import::default(),
        gears: Vec::new(),
        elements: 0,
    };
    for key in file.as_object().into_iter().flat_map(|o| o.keys()) {
        if key != "components" && key != "structure" {
            reader.out.report.push(format!("`{key}` was not read"));
        }
    }
    for (i, c) in structure.iter().enumerate() {
        let end = |k: usize| c.get(k).and_then(Value::as_str).and_then(|s| s.split_once('.'));
        match (end(0), end(1)) {
            (Some(a), Some(b)) => reader.connections.push([a, b]),
            _ => return Err(format!("structure.{i}: a connection is a pair of `component.element`")),
        }
    }
    let starts: Vec<&str> = components
        .iter()
        .filter_map(|c| c.get("name").and_then(Value::as_str))
        .filter(|n| !reader.connections.iter().any(|[_, b]| b.0 == *n))
        .collect();
    let connected = |n: &&&str| reader.connections.iter().any(|[a, _]| a.0 == **n);
    let start = match (components.len(), starts.iter().filter(connected).count()) {
        (1, _) => starts.first().copied().ok_or("the component has no name")?,
        (_, 1) => starts.iter().find(connected).copied().unwrap_or_default(),
        (_, 0) => return Err("structure: no component begins the line".into()),
        _ => return Err("structure: more than one group of components".into()),
    };
    for lost in starts.iter().filter(|s| **s != start) {
        reader.out.report.push(format!("component `{lost}` is not connected and was left out"));
    }
    reader.component(start, None, 0)?;
    if reader.out.line.nodes.is_empty() {
        return Err("components: there is no element in the line".into());
    }
    Ok(reader.out)
}

struct Reader<'a> {
    components: &'a [Value],
    /// From and to, component and element each.
    connections: Vec<[(&'a str, &'a str); 2]>,
    out: Import,
    /// Name of every gear with its node and its size (teeth or diameter).
    gears: Vec<(String, usize, f64)>,
    elements: usize,
}

impl<'a> Reader<'a> {
    fn number(e: &Value, key: &str, place: &str) -> Result<f64, String> {
        e.get(key)
            .and_then(Value::as_f64)
            .filter(|v| v.is_finite())
            .ok_or_else(|| format!("{place}: `{key}` is not a number"))
    }

    fn optional(e: &Value, key: &str, default: f64, place: &str) -> Result<f64, String> {
        if e.get(key).is_some() { Self::number(e, key, place) } else { Ok(default) }
    }

    fn new_node(&mut self, name: String, ratio: f64) -> usize {
        let mut unique = name.clone();
        let mut k = 2;
        while self.out.line.nodes.iter().any(|n| n.name == unique) {
            unique = format!("{name} {k}");
            k += 1;
        }
        let node = LineNode { name: unique, inertia: 0.0, damping: 0.0, ground: 0.0, ratio };
        self.out.line.nodes.push(node);
        self.out.line.nodes.len() - 1
    }

    fn link(
        &mut self,
        name: String,
        nodes: [usize; 2],
        spec: &dyn CouplingSpec,
        stress: Option<f64>,
    ) -> Result<(), String> {
        let coupling = spec.build().map_err(|e| format!("{name}: {e}"))?;
        self.out.line.links.push(LineLink { name, nodes, coupling });
        self.out.stress.push(stress);
        Ok(())
    }

    /// Adds a component that begins at node `at` (none: the beginning of the line).
    fn component(&mut self, name: &'a str, at: Option<usize>, depth: usize) -> Result<(), String> {
        if depth > 1000 {
            return Err("structure: the connections go round in circles".into());
        }
        let all = self.components;
        let component = all
            .iter()
            .find(|c| c.get("name").and_then(Value::as_str) == Some(name))
            .ok_or_else(|| format!("structure: there is no component `{name}`"))?;
        let elements = component
            .get("elements")
            .and_then(Value::as_array)
            .ok_or_else(|| format!("{name}: has no list `elements`"))?;
        let mut node = at;
        for (k, e) in elements.iter().enumerate() {
            self.elements += 1;
            if self.elements > MAX_ELEMENTS {
                return Err("structure: the connections go round in circles".into());
            }
            let own = e
                .get("name")
                .and_then(Value::as_str)
                .map_or_else(|| format!("element {}", k + 1), str::to_owned);
            let place = format!("{name}.{own}");
            let kind = e.get("type").and_then(Value::as_str).unwrap_or_default();
            self.report_unread(e, kind, &place);
            match kind {
                "Disk" => node = Some(self.disk(e, node, &place)?),
                "ShaftDiscrete" | "ShaftContinuous" => node = Some(self.shaft(e, kind, node, &place)?),
                "GearElement" => node = Some(self.gear(e, name, node, &place)?),
                _ => {}
            }
            let next: Vec<&'a str> = self
                .connections
                .iter()
                .filter(|[a, _]| a.0 == name && a.1 == own)
                .map(|[_, b]| b.0)
                .collect();
            for next in next {
                self.component(next, node, depth + 1)?;
            }
        }
        Ok(())
    }

    /// Tells what of an element is not taken over.
    fn report_unread(&mut self, e: &Value, kind: &str, place: &str) {
        let known: &[&str] = match kind {
            "Disk" => &["inertia", "damping"],
            "ShaftDiscrete" => &["stiffness", "damping"],
            "ShaftContinuous" => {
                &["length", "innerDiameter", "outerDiameter", "density", "shearModulus", "damping"]
            }
            "GearElement" => &["inertia", "teeth", "diameter", "parent", "damping"],
            _ => &[],
        };
        let unread: Vec<&str> = e
            .as_object()
            .into_iter()
            .flat_map(|o| o.keys())
            .map(String::as_str)
            .filter(|key| !["name", "type"].contains(key) && !known.contains(key))
            .collect();
        if known.is_empty() {
            let what = format!("{place}: elements of type `{kind}` are not known; it was left out");
            self.out.report.push(what);
        } else if !unread.is_empty() {
            self.out.report.push(format!("{place}: {} not read", unread.join(", ")));
        }
    }

    /// A disk on the node before it; the node.
    fn disk(&mut self, e: &Value, node: Option<usize>, place: &str) -> Result<usize, String> {
        let n = match node {
            Some(n) => n,
            None => self.new_node(place.to_owned(), 1.0),
        };
        let inertia = Self::number(e, "inertia", place)?;
        let damping = Self::optional(e, "damping", 0.0, place)?;
        if inertia < 0.0 {
            return Err(format!("{place}: an inertia of {inertia} cannot be"));
        }
        let target = &mut self.out.line.nodes[n];
        // The end of a shaft is called after what sits on it.
        if target.name.ends_with(" end") || target.name.ends_with(" begin") {
            place.clone_into(&mut target.name);
        }
        target.inertia += inertia;
        target.damping += damping;
        Ok(n)
    }

    /// A shaft from the node before it; the node at its end.
    fn shaft(&mut self, e: &Value, kind: &str, node: Option<usize>, place: &str) -> Result<usize, String> {
        let ratio = node.map_or(1.0, |n| self.out.line.nodes[n].ratio);
        let a = match node {
            Some(n) => n,
            None => self.new_node(format!("{place} begin"), ratio),
        };
        let b = self.new_node(format!("{place} end"), ratio);
        let (k, c, stress) = if kind == "ShaftDiscrete" {
            let c = Self::optional(e, "damping", 0.0, place)?;
            (Self::number(e, "stiffness", place)?, c, None)
        } else {
            self.continuous_shaft(e, [a, b], place)?
        };
        let error = |e| format!("{place}: {e}");
        let stiffness: TorsionalStiffness<NonNegative> = Quantity::new(k).map_err(error)?;
        let damping: TorsionalDamping<NonNegative> = Quantity::new(c).map_err(error)?;
        let law = Linear { stiffness, damping, loss_factor: gudgeon_core::quantity::quantity(0.0) };
        self.link(place.to_owned(), [a, b], &law, stress)?;
        Ok(b)
    }

    /// Stiffness, damping and stress by torque of a cylinder, whose inertia goes to its ends.
    fn continuous_shaft(
        &mut self,
        e: &Value,
        ends: [usize; 2],
        place: &str,
    ) -> Result<(f64, f64, Option<f64>), String> {
        // Lengths are in millimetres there.
        let mm = |key: &str| Self::number(e, key, place).map(|v| v * 1e-3);
        let piece =
            Piece { length: mm("length")?, diameter: mm("outerDiameter")?, bore: mm("innerDiameter")? };
        if !(piece.length > 0.0 && piece.diameter > piece.bore && piece.bore >= 0.0) {
            return Err(format!("{place}: length and diameters do not make a shaft"));
        }
        let half = 0.5 * piece.inertia(Self::optional(e, "density", 8000.0, place)?);
        for end in ends {
            self.out.line.nodes[end].inertia += half;
        }
        self.out.report.push(format!(
            "{place}: half of the shaft's inertia stands at each end; openTorsion spreads it over a linear element"
        ));
        let k = stiffness(&[piece], Self::optional(e, "shearModulus", 80e9, place)?);
        Ok((k, Self::optional(e, "damping", 0.0, place)?, Some(piece.stress(1.0))))
    }

    /// A gear on the node before it, or in mesh with its parent; the node.
    fn gear(
        &mut self,
        e: &Value,
        component: &str,
        node: Option<usize>,
        place: &str,
    ) -> Result<usize, String> {
        let size = Self::number(e, if e.get("teeth").is_some() { "teeth" } else { "diameter" }, place)?;
        if size <= 0.0 {
            return Err(format!("{place}: a gear of size {size} cannot be"));
        }
        let parent = e.get("parent").and_then(Value::as_str).and_then(|p| {
            let full = format!("{component}.{p}");
            self.gears.iter().find(|g| g.0 == full).map(|g| (g.1, g.2))
        });
        let n = match (parent, node) {
            (Some((mate, mate_size)), _) => {
                let r = -self.out.line.nodes[mate].ratio * mate_size / size;
                let n = self.new_node(place.to_owned(), r);
                self.link(format!("{place} mesh"), [mate, n], &Off {}, None)?;
                n
            }
            (None, Some(n)) => n,
            (None, None) => self.new_node(place.to_owned(), 1.0),
        };
        if e.get("parent").is_some() && parent.is_none() {
            self.out
                .report
                .push(format!("{place}: its parent gear does not come before it and was not meshed"));
        }
        let inertia = Self::number(e, "inertia", place)?;
        self.out.line.nodes[n].inertia += inertia.max(0.0);
        self.gears.push((place.to_owned(), n, size));
        Ok(n)
    }
}
