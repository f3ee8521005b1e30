//! The balance of blow-by: what of the gas passes where in a cycle, ring by ring.
//!
//! The recorded cycle carries the flow through every passage of the gas as a quadrature ([`Pack::follow_passages`]); the cycles before it, which search
//! the periodic state, do not. What went back is the sum of the falls of these quadratures, as for the gas that returns to the chamber.

use gudgeon_core::kinds::{GasPassage, GasSpace, GasWay};
use gudgeon_core::result::{Column, Figure, FigureKind, Series};

use super::pack::Pack;
use super::results::Cycle;

/// Gas that passed somewhere in a cycle \[kg\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Passed {
    /// Downwards, less what came back.
    pub net: f64,
    /// Upwards.
    pub up: f64,
}

impl Passed {
    /// Downwards \[kg\].
    fn down(self) -> f64 {
        self.net + self.up
    }
}

/// Where gas passed in a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct GasBalance<'a> {
    passages: &'a [GasPassage],
    /// Through each of them.
    through: Vec<Passed>,
    /// Past each ring from the land above, and to the crankcase.
    past: Vec<Passed>,
}

impl<'a> GasBalance<'a> {
    /// Of a cycle of `pack`.
    #[must_use]
    pub fn of(pack: &'a Pack, cycle: &Cycle) -> Self {
        let all: Vec<Passed> =
            cycle.totals.passed().zip(&cycle.measures.up).map(|(net, up)| Passed { net, up: *up }).collect();
        let (past, through) = all.split_at(pack.n_rings() + 1);
        Self { passages: pack.gas.passages(), through: through.to_vec(), past: past.to_vec() }
    }

    fn each(&self) -> impl Iterator<Item = (&GasPassage, Passed)> {
        self.passages.iter().zip(self.through.iter().copied())
    }

    /// Most gas \[kg\], of either sign, that a space between chamber and crankcase gains over the cycle.
    #[must_use]
    pub fn gained(&self) -> f64 {
        let rings = self.past.len() - 1;
        let spaces = (1..rings).map(GasSpace::Land).chain((0..rings).map(GasSpace::Behind));
        spaces.map(|space| net_into(self.each(), space).abs()).fold(0.0, f64::max)
    }
}

/// What comes into a space less what leaves it \[kg\].
fn net_into<'a>(each: impl Iterator<Item = (&'a GasPassage, Passed)>, space: GasSpace) -> f64 {
    let side = |there: GasSpace| f64::from(u8::from(there == space));
    each.map(|(p, gas)| (side(p.to) - side(p.from)) * gas.net).sum()
}

/// Net gas \[kg\] through the first passage of ring `i` that `is_one`, of the `passages` of a gas model and what passed them; 0 where there is none.
#[must_use]
pub fn net_past(passages: &[GasPassage], net: &[f64], i: usize, is_one: impl Fn(GasWay) -> bool) -> f64 {
    passages.iter().zip(net).find(|(p, _)| p.ring == i && is_one(p.way)).map_or(0.0, |(_, net)| *net)
}

/// Ways by which gas passes the end gap of a ring.
#[must_use]
pub const fn is_gap(way: GasWay) -> bool {
    matches!(way, GasWay::Gap | GasWay::GapAndFace)
}

/// Ways by which gas passes the groove of a ring.
#[must_use]
pub const fn is_groove(way: GasWay) -> bool {
    matches!(way, GasWay::UpperFlank | GasWay::LowerFlank | GasWay::Groove)
}

/// Name of a way in the table, and in words.
const fn named(way: GasWay) -> (&'static str, &'static str) {
    match way {
        GasWay::Gap => ("gap", "end gap"),
        GasWay::GapAndFace => ("gap_and_face", "end gap and face"),
        GasWay::Face => ("face", "face"),
        GasWay::UpperFlank => ("upper_flank", "upper flank"),
        GasWay::LowerFlank => ("lower_flank", "lower flank"),
        GasWay::Groove => ("groove", "groove"),
        GasWay::Drain => ("drain", "drain"),
    }
}

/// A row per ring: gas downwards and upwards by each way that any ring has \[kg\].
#[must_use]
pub fn table(balance: &GasBalance<'_>) -> Series {
    let rings = balance.past.len() - 1;
    let mut ways: Vec<GasWay> = balance.passages.iter().map(|p| p.way).collect();
    ways.sort_unstable();
    ways.dedup();
    let column = |name: String, of: &dyn Fn(usize) -> f64| Column {
        name,
        unit: "kg".into(),
        values: (0..rings).map(of).collect(),
    };
    let mut columns = Vec::new();
    for way in ways {
        let sum = |i: usize, of: fn(Passed) -> f64| {
            // Adding zero turns -0 into 0.
            balance.each().filter(|(p, _)| (p.ring, p.way) == (i, way)).map(|(_, gas)| of(gas)).sum::<f64>()
                + 0.0
        };
        let name = named(way).0;
        columns.push(column(format!("{name}.down"), &|i| sum(i, Passed::down)));
        columns.push(column(format!("{name}.up"), &|i| sum(i, |gas| gas.up)));
    }
    let values = (1..=rings).map(|k| k as f64).collect();
    Series { axis: Column { name: "ring".into(), unit: "1".into(), values }, columns }
}

/// The balance in rows, of the rings with these names: every passage that gas passes, each ring, the crankcase. None where the model has no passages, or
/// the solver has not followed them.
#[must_use]
pub fn figure(balance: &GasBalance<'_>, names: &[String]) -> Option<Figure> {
    let to_crankcase = *balance.past.last()?;
    if balance.through.is_empty() {
        return None;
    }
    let row = |label: String, gas: Passed| {
        let share = (to_crankcase.net > 0.0).then(|| (1e3 * gas.net / to_crankcase.net).round() / 10.0 + 0.0);
        let [net, down, up] = [gas.net, gas.down(), gas.up].map(|mass| Some(shown(mass)));
        (label, vec![net, share, down, up])
    };
    let mut rows = Vec::new();
    for (i, name) in names.iter().enumerate() {
        let mut own: Vec<_> = balance.each().filter(|(p, _)| p.ring == i).collect();
        own.sort_by_key(|(p, _)| p.way);
        let passed = own.into_iter().filter(|(_, gas)| shown(gas.up) != 0.0 || shown(gas.down()) != 0.0);
        rows.extend(passed.map(|(p, gas)| row(format!("{name}, {}", named(p.way).1), gas)));
        rows.push(row(format!("{name}, all"), balance.past[i]));
    }
    rows.push(row("to the crankcase".into(), to_crankcase));
    let columns = [("net", "mg"), ("share", "%"), ("down", "mg"), ("back up", "mg")];
    Some(Figure {
        title: "Blow-by balance".into(),
        hint: format!(
            "gas of one cylinder per cycle, share of the blow-by; what passes a closed groove passes its upper flank, then the lower one. Error of the balance: no land and no space behind a \
             ring gains more than {:.1e} mg over the cycle",
            1e6 * balance.gained()
        ),
        table: "blow_by".into(),
        kind: FigureKind::Table {
            rows_are: "passage".into(),
            columns: columns.map(|(name, unit)| (name.to_owned(), unit.to_owned())).to_vec(),
            rows,
            texts: Vec::new(),
            limit: None,
        },
    })
}

/// A mass \[kg\] in whole micrograms, as mg.
fn shown(mass: f64) -> f64 {
    (1e9 * mass).round() / 1e3 + 0.0
}
