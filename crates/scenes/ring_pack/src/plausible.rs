//! Dimensions that no ring pack can have, and those some ten times outside of what is usual: mostly a unit that was forgotten or mistyped.
//!
//! What cannot be is refused before anything is built, because everything built on it would be refused for reasons that do not name it.

use std::f64::consts::PI;

use gudgeon_case::Loaded;
use gudgeon_core::BuildError;
use gudgeon_core::result::Note;

use crate::case::{Ring, RingDesign, RingPackCase};

/// A value that is measured by something beside it.
struct Look {
    /// Its key.
    path: String,
    /// It in a unit that a person reads at a glance.
    value: String,
    /// What it amounts to: `5.2 times the bore`.
    amounts: String,
    /// What is usual, as a person would write it.
    usual: String,
    /// It over its measure.
    ratio: f64,
    /// Ratios beyond which it is told: about ten times outside of what is usual.
    told: (f64, f64),
    /// Ratio from which it cannot be.
    most: f64,
    /// The unit that a bare number was probably meant in.
    unit: &'static str,
}

impl Look {
    fn says(&self, loaded: &Loaded<RingPackCase>) -> (String, String) {
        let what = format!("{} {}", self.value, self.amounts);
        let meant = loaded.bare_number(&self.path).map_or_else(String::new, |n| {
            format!("; a number without a unit is SI: did you mean `\"{n} {}\"`?", self.unit)
        });
        (what, format!("usual: {}{meant}", self.usual))
    }
}

/// Values that no ring pack can have.
pub fn impossible(loaded: &Loaded<RingPackCase>) -> Vec<BuildError> {
    let refused = |l: Look| {
        let (what, help) = l.says(loaded);
        BuildError::at(l.path, what).help(help)
    };
    looks(&loaded.value).into_iter().filter(|l| l.ratio > l.most).map(refused).collect()
}

/// Values that are possible and far from anything usual.
pub fn unusual(loaded: &Loaded<RingPackCase>) -> Vec<Note> {
    let told = |l: Look| {
        let (what, help) = l.says(loaded);
        let text = format!("`{}`: {what}; {help}", l.path);
        Note::caution(format!("unusual.{}", l.path), text)
    };
    // A bare number that is improbable in SI is told already where it was read.
    let said = |l: &Look| loaded.notes.iter().any(|n| n.starts_with(&format!("{} is ", l.path)));
    let outside = |l: &Look| (l.ratio < l.told.0 || l.ratio > l.told.1) && !said(l);
    looks(&loaded.value).into_iter().filter(outside).map(told).collect()
}

fn looks(case: &RingPackCase) -> Vec<Look> {
    let mut all = of_engine(case);
    for (i, ring) in case.rings.iter().enumerate() {
        all.extend(of_ring(ring, i, case.engine.bore.si()));
    }
    all
}

/// Millimetres in four digits.
fn mm(metres: f64) -> String {
    format!("{} mm", four(1e3 * metres))
}

/// Four significant digits, without zeros at the end.
fn four(v: f64) -> String {
    format!("{v:.3e}").parse::<f64>().unwrap_or(v).to_string()
}

fn of_engine(case: &RingPackCase) -> Vec<Look> {
    let e = &case.engine;
    let bore = e.bore.si();
    let mut all = vec![Look {
        path: "engine.bore".into(),
        value: mm(bore),
        amounts: "of bore: the smallest engines have some 10 mm, the largest 1 m".into(),
        usual: "30 to 1000 mm".into(),
        ratio: bore,
        told: (5e-3, 2.0),
        most: 3.0,
        unit: "mm",
    }];
    // Contradictions of stroke, rod and speed are the crank drive's to tell.
    let Ok(crank) = e.crank() else { return all };
    let stroke = 2.0 * crank.radius;
    let speed = stroke * crank.omega / PI;
    all.push(Look {
        path: if e.stroke.is_some() { "engine.stroke" } else { "engine.crank_radius" }.into(),
        value: mm(stroke),
        amounts: format!("of stroke are {} times the bore", four(stroke / bore)),
        usual: "0.6 to 4 times".into(),
        ratio: stroke / bore,
        told: (0.1, 20.0),
        most: f64::INFINITY,
        unit: "mm",
    });
    all.push(Look {
        path: "engine.rod_length".into(),
        value: mm(crank.rod_length),
        amounts: format!("from centre to centre are {} times the stroke", four(crank.rod_length / stroke)),
        usual: "1.4 to 3 times".into(),
        ratio: crank.rod_length / stroke,
        told: (0.0, 15.0),
        most: f64::INFINITY,
        unit: "mm",
    });
    all.push(Look {
        path: "engine.speed".into(),
        value: format!("{} rpm", four(crank.omega * 30.0 / PI)),
        amounts: format!("make a mean piston speed of {} m/s", four(speed)),
        usual: "up to 25 m/s".into(),
        ratio: speed,
        told: (0.0, 50.0),
        most: f64::INFINITY,
        unit: "rpm",
    });
    let crankcase = case.gas.crankcase_pressure.si() / 1e5;
    all.push(Look {
        path: "gas.crankcase_pressure".into(),
        value: format!("{} bar", four(crankcase)),
        amounts: "in the crankcase, absolute".into(),
        usual: "0.9 to 4 bar".into(),
        ratio: crankcase,
        told: (0.1, 40.0),
        most: f64::INFINITY,
        unit: "bar",
    });
    all.extend(case.liner.distortion.iter().enumerate().map(|(k, d)| Look {
        path: format!("liner.distortion.{k}.diametral"),
        value: mm(d.diametral.si()),
        amounts: format!("are {} % of the bore", four(100.0 * d.diametral.si() / bore)),
        usual: format!("up to 0.2 %, here {}", mm(2e-3 * bore)),
        ratio: d.diametral.si().abs() / bore,
        told: (0.0, 0.02),
        most: 0.1,
        unit: "mm",
    }));
    all
}

fn of_ring(r: &Ring, i: usize, bore: f64) -> Vec<Look> {
    let at = |key: &str| format!("rings.{i}.{key}");
    let (height, width) = (r.height.si(), r.width.si());
    let oil = r.design != RingDesign::Compression;
    // A three-piece ring says the height of one rail; rails and spacer fill their groove, or a case says the room of one rail as its groove.
    let whole = if r.design == RingDesign::ThreePiece {
        r.groove.height.map_or(0.0, |h| h.si()).max(4.0 * height)
    } else {
        height
    };
    let volume = PI * (bore - width).max(width) * width * whole;
    let (force, mass) = (r.tangential_force.si(), r.mass.si());
    let (pressure, density) = (2.0 * force / (bore * whole), mass / volume);
    let mut all = vec![
        Look {
            path: at("height"),
            value: mm(height),
            amounts: format!("of axial height are {} % of the bore", four(100.0 * height / bore)),
            usual: format!("1 to 5 %, here {} to {}", mm(0.01 * bore), mm(0.05 * bore)),
            ratio: height / bore,
            told: (1e-3, 0.3),
            most: 0.5,
            unit: "mm",
        },
        Look {
            path: at("mass"),
            value: format!("{} g", four(1e3 * mass)),
            amounts: format!(
                "in a section of {} by {} make {} g/cm3; osmium has 22.6",
                mm(whole),
                mm(width),
                four(1e-3 * density)
            ),
            usual: format!(
                "7 to 8 g/cm3 (iron, steel), here {} g; less where the section is slotted",
                four(7.5e6 * volume)
            ),
            ratio: density,
            told: (700.0, 20e3),
            most: 23e3,
            unit: "g",
        },
        Look {
            path: at("tangential_force"),
            value: format!("{} N", four(force)),
            amounts: format!("press the ring against the liner with {} MPa", four(1e-6 * pressure)),
            usual: if oil { "0.2 to 2 MPa of an oil ring" } else { "0.05 to 0.3 MPa of a compression ring" }
                .into(),
            ratio: pressure,
            told: if oil { (2e4, 2e7) } else { (5e3, 3e6) },
            most: f64::INFINITY,
            unit: "N",
        },
        Look {
            path: at("tangential_force"),
            value: format!("{} N", four(force)),
            amounts: format!(
                "load the section of the ring with {} MPa, more than steel carries",
                four(1e-6 * force / (whole * width))
            ),
            usual: format!("{} to {} N", four(5e4 * bore * whole / 2.0), four(2e6 * bore * whole / 2.0)),
            ratio: force / (whole * width),
            told: (0.0, f64::INFINITY),
            most: 1.5e9,
            unit: "N",
        },
    ];
    for (key, gap) in [("gap", r.gap), ("cold_gap", r.cold_gap)] {
        all.extend(gap.map(|gap| Look {
            path: at(key),
            value: mm(gap.si()),
            amounts: format!("of end gap are {} % of the bore ({})", four(100.0 * gap.si() / bore), mm(bore)),
            usual: format!("0.2 to 0.6 %, here {} to {}", mm(2e-3 * bore), mm(6e-3 * bore)),
            ratio: gap.si() / bore,
            told: (0.0, 0.05),
            most: 0.2,
            unit: "mm",
        }));
    }
    let length = r.face.length.map_or(height, |l| l.si());
    all.extend(r.face.drop.map(|drop| Look {
        path: at("face.drop"),
        value: mm(drop.si()),
        amounts: format!("of drop on a face {} long", mm(length)),
        usual: "3 to 20 um of a barrel, up to 60 um of a taper".into(),
        ratio: drop.si() / length,
        told: (0.0, 0.3),
        most: 1.0,
        unit: "um",
    }));
    let clearance = match (r.groove.height, r.groove.clearance) {
        (Some(b), None) if r.design == RingDesign::Compression => Some(("groove.height", b.si() - height)),
        (None, Some(c)) => Some(("groove.clearance", c.si())),
        _ => None,
    };
    all.extend(clearance.map(|(key, clearance)| Look {
        path: at(key),
        value: mm(if key == "groove.height" { clearance + height } else { clearance }),
        amounts: format!("leave the ring an axial clearance of {}", mm(clearance)),
        usual: "0.03 to 0.15 mm".into(),
        ratio: clearance / height,
        told: (f64::NEG_INFINITY, 0.5),
        most: f64::INFINITY,
        unit: "mm",
    }));
    all
}
