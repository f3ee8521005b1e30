//! What a ring-pack run must compute: from wanted results to the parts that are built and integrated.

use gudgeon_core::BuildError;
use gudgeon_core::result::Skipped;

use super::rails;
use crate::case::RingPackCase;

/// What a result needs beyond the gas network, which every result needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Gas pressures and flows.
    Gas,
    /// Axial positions of the rings.
    Axial,
    /// Films of all rings.
    Film,
}

/// One result of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultInfo {
    /// Name in `summary.json`.
    pub name: String,
    /// Unit of the value.
    pub unit: &'static str,
    /// One line.
    pub what: String,
    /// What it needs.
    pub needs: Needs,
}

/// What is told beside what every pack has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Told {
    /// Oil that is followed on the liner and under the faces.
    pub liner: bool,
    /// Oil that evaporates from there.
    pub vapour: bool,
    /// Oil that is followed on the flanks of the grooves.
    pub flanks: bool,
    /// Oil by the formulas of published decks.
    pub formulas: bool,
}

impl Told {
    /// Everything.
    pub const ALL: Self = Self { liner: true, vapour: true, flanks: true, formulas: true };
}

/// What rings and the lands above them are called in words.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names {
    /// The rings, and the flank that each seals.
    pub rings: Vec<(String, &'static str)>,
    /// The land above each.
    pub lands: Vec<String>,
}

impl Names {
    /// Of a case whose rings are single bodies.
    #[must_use]
    pub fn of(case: &RingPackCase) -> Self {
        let all = 0..case.rings.len();
        let lands = all.clone().map(|i| rails::land_name(case, i)).collect();
        Self { rings: all.map(|i| (rails::name(case, i), rails::flank(case, i))).collect(), lands }
    }
}

/// Every result of a pack.
#[must_use]
pub fn catalogue(names: &Names, told: Told) -> Vec<ResultInfo> {
    let mut all = gas_results();
    for (k, land) in names.lands.iter().enumerate().skip(1) {
        all.extend(land_results(k + 1, land));
    }
    for (i, (ring, flank)) in names.rings.iter().enumerate().map(|(i, ring)| (i + 1, ring)) {
        all.extend(passage_results(i, ring));
        all.extend(seat_results(i, ring, flank));
        all.extend(film_results(i, ring));
        if told.formulas {
            all.extend(oil_face_results(i, ring));
        }
        if told.flanks {
            all.extend(flank_results(i, ring));
        }
        if told.liner {
            all.extend(liner_results(i, ring));
        }
    }
    if told.liner {
        all.extend(oil_results());
    }
    if told.vapour {
        all.extend(vapour_results());
    }
    let power = "mean friction power of the pack, one cylinder";
    all.push(info("friction_power", "W", Needs::Film, power));
    all.push(info("fmep", "bar", Needs::Film, "friction mean effective pressure of the pack"));
    let solid = "the part of fmep that solid contact takes; films take the rest";
    all.push(info("fmep_boundary", "bar", Needs::Film, solid));
    let error = "estimated true relative error of the periodic state";
    all.push(info("periodicity_error", "1", Needs::Gas, error));
    all
}

fn info(name: impl Into<String>, unit: &'static str, needs: Needs, what: impl Into<String>) -> ResultInfo {
    ResultInfo { name: name.into(), unit, what: what.into(), needs }
}

fn gas_results() -> Vec<ResultInfo> {
    let add = |name, unit, what| info(name, unit, Needs::Gas, what);
    vec![
        add("blow_by", "l/min", "gas to the crankcase, whole engine, at meter conditions"),
        add("blow_by_per_cylinder", "l/min", "gas to the crankcase, one cylinder, at meter conditions"),
        add(
            "blow_by_share",
            "1",
            "gas to the crankcase over what the swept volume holds at the lower dead centre, at cylinder pressure and meter temperature",
        ),
        add("blow_by_mass_per_cycle", "kg", "gas to the crankcase, one cylinder"),
        add("blow_back_mass_per_cycle", "kg", "gas returning past ring 1 to the cylinder, one cylinder"),
        add(
            "blow_back",
            "l/min",
            "gas returning past ring 1 to the cylinder, whole engine, at meter conditions",
        ),
        add("cylinder.p_max", "bar", "highest cylinder pressure"),
        add(
            "cylinder.p_max_angle",
            "deg",
            "crank angle of the highest cylinder pressure; the firing dead centre of four strokes is at 360",
        ),
    ]
}

/// Of land `k`.
fn land_results(k: usize, land: &str) -> Vec<ResultInfo> {
    let add =
        |name, unit, what| info(format!("land{k}.{name}"), unit, Needs::Gas, format!("{what} of {land}"));
    vec![
        add("p_max", "bar", "highest pressure"),
        add("p_max_angle", "deg", "crank angle of the highest pressure"),
    ]
}

/// Of the gas past ring `i`.
fn passage_results(i: usize, ring: &str) -> Vec<ResultInfo> {
    let add = |name: &str, what: String| {
        info(
            format!("ring{i}.{name}"),
            "l/min",
            Needs::Gas,
            format!("{what}, less what comes back, whole engine, at meter conditions"),
        )
    };
    vec![
        add("blow_by", format!("gas past {ring} from the land above")),
        add(
            "blow_by_gap",
            format!(
                "the part of that directly through its end gap, {ring}, with its face where the gas model has both as one opening"
            ),
        ),
        add("blow_by_groove", format!("the part of that through its groove, {ring}")),
    ]
}

/// Of ring `i` between the flanks.
fn seat_results(i: usize, ring: &str, flank: &str) -> Vec<ResultInfo> {
    let told = |name, unit, what| info(format!("ring{i}.{name}"), unit, Needs::Axial, what);
    let add = |name, what| told(name, "1", what);
    let lift = format!(
        "{ring} comes off its {flank} flank, by `outputs.seat` of its clearance, first after the firing dead centre"
    );
    vec![
        add("lift_pressure_ratio", format!("pressure below over that above when {lift}; 0: never")),
        told("lift_angle", "deg", format!("crank angle at which {lift}; 0: never")),
        add(
            "seat_changes",
            format!(
                "arrivals of {ring} on a groove flank (within `outputs.seat` of its clearance) per cycle"
            ),
        ),
        add(
            "lifted_share",
            format!(
                "share of the cycle that {ring} is off its {flank} flank, farther than `outputs.seat` of its clearance"
            ),
        ),
        add(
            "reverse_pressure_ratio",
            format!(
                "highest ratio of the pressure below {ring} to that above: beyond 1 gas lifts a ring off its lower flank"
            ),
        ),
    ]
}

/// Of the film of ring `i`.
fn film_results(i: usize, ring: &str) -> Vec<ResultInfo> {
    let add = |name, unit, what| info(format!("ring{i}.{name}"), unit, Needs::Film, what);
    vec![
        add("h_min", "um", format!("thinnest film under {ring}")),
        add("h_max", "um", format!("thickest film under {ring}")),
        add("h_mean", "um", format!("mean film under {ring}")),
        add("h_min_angle", "deg", format!("crank angle of the thinnest film under {ring}")),
        add("h_mid", "um", format!("film under {ring} in the middle of a stroke, mean of the strokes")),
        add(
            "friction_coefficient_mid",
            "1",
            format!(
                "friction force over radial load of {ring} in the middle of a stroke, mean of the strokes"
            ),
        ),
        add("friction_max", "N", format!("largest friction force of {ring}, whole circumference")),
        add("friction_max_angle", "deg", format!("crank angle of the largest friction force of {ring}")),
        add("friction_power", "W", format!("mean friction power of {ring}, one cylinder")),
        add("fmep", "bar", format!("friction mean effective pressure of {ring}")),
        add(
            "fmep_boundary",
            "bar",
            format!("the part of that which solid contact takes, {ring}; the film takes the rest"),
        ),
        add(
            "wear_load",
            "J",
            format!("load of solid contact times the distance that {ring} slides under it, per cycle"),
        ),
    ]
}

/// Oil past ring `i` when all its ways are full of oil.
fn oil_face_results(i: usize, ring: &str) -> Vec<ResultInfo> {
    let add = |name, needs, what| info(format!("ring{i}.{name}"), "mm3", needs, what);
    vec![
        add(
            "oil_face_combustion",
            Needs::Film,
            format!("film on the expansion stroke less that on the compression stroke, {ring}, per cycle"),
        ),
        add(
            "oil_face_gas_exchange",
            Needs::Film,
            format!("film on the intake stroke less that on the exhaust stroke, {ring}, per cycle"),
        ),
        add(
            "oil_gap",
            Needs::Film,
            format!("oil that a gap full of oil would let up past {ring}, per cycle"),
        ),
        add(
            "oil_groove",
            Needs::Axial,
            format!("oil pumped up past the flanks of {ring} in an oil-filled groove, per cycle"),
        ),
    ]
}

/// Of the oil on the flanks of ring `i`.
fn flank_results(i: usize, ring: &str) -> Vec<ResultInfo> {
    let what =
        format!("oil that gas blows off the flanks of {ring} and that groove and lands replace, per cycle");
    vec![info(format!("ring{i}.flank_oil_lost"), "mm3", Needs::Gas, what)]
}

/// Of the oil on the liner at ring `i` and on the land above it.
fn liner_results(i: usize, ring: &str) -> Vec<ResultInfo> {
    let add = |name, unit, what| info(format!("ring{i}.{name}"), unit, Needs::Film, what);
    let ways = "with the liner, by inertia and with gas, per cycle";
    vec![
        add("wetted_share", "1", format!("mean share of the face under full film, {ring}")),
        add("gap_oil_up", "mm3", format!("oil that passes the end gap of {ring} upwards: {ways}")),
        add("gap_oil_down", "mm3", format!("oil that passes the end gap of {ring} downwards: {ways}")),
        add(
            "oil_scraped",
            "mm3",
            format!("oil that {ring} scrapes off the liner for want of room, per cycle"),
        ),
        info(format!("land{i}.oil"), "mm3", Needs::Film, format!("oil on land {i} at the end of the cycle")),
    ]
}

/// Of the oil on the liner.
///
/// `oil_up` counts two ways into the chamber: oil on the land above ring 1, which the deceleration of the piston before top dead centre throws off as a film with a free surface, and vapour of
/// the film that lies bare above ring 1. The first comes from what ring 1 scrapes on its way up beyond the wave that stands before its edge, and from what inertia and gas
/// bring through its gap from the land below. The wave itself is not thrown at the reversal: capillarity holds it, for `ρ a w²/σ` of 50 µm at 4000 m/s² is 0.3; and a
/// starved ring has none. Oil in the grooves, what gas blows off the flanks, and mist do not count.
fn oil_results() -> Vec<ResultInfo> {
    let add = |name, unit, what| info(name, unit, Needs::Film, what);
    let up = "oil that leaves the pack upwards, whole engine, thrown off the land above ring 1 and, where that is modelled, evaporated from the liner: a lower limit of \
              consumption, without mist and what passes the flanks";
    vec![
        add("oil_taken", "mm3", "oil taken up from the liner by all faces, per cycle"),
        add("oil_drained", "mm3", "oil scraped into the crankcase, per cycle"),
        add(
            "oil_thrown",
            "mm3",
            "oil that inertia throws off the land above ring 1 into the combustion chamber, per cycle",
        ),
        add("oil_up", "g/h", up),
        add("oil_up_specific", "g/kWh", "`oil_up` over the indicated power; 0 where the gas does no work"),
    ]
}

/// Of the oil that evaporates from the liner.
fn vapour_results() -> Vec<ResultInfo> {
    let add = |name, unit, what| info(name, unit, Needs::Film, what);
    vec![
        add("oil_evaporated", "mm3", "oil that evaporates from the liner above ring 1, per cycle"),
        add(
            "liner_dried",
            "mm",
            "height of the way of ring 1 that evaporation leaves without oil at some time of the cycle",
        ),
        add("oil_up_thrown", "g/h", "the part of `oil_up` that inertia throws off the land above ring 1"),
        add("oil_up_evaporated", "g/h", "the part of `oil_up` that evaporates from the liner"),
    ]
}

/// What runs and what does not.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    /// Names of the wanted results, in catalogue order.
    pub wanted: Vec<String>,
    /// Whether films are solved.
    pub film: bool,
    /// Whether a wanted result is one of a film, and not only what it depends on.
    pub film_wanted: bool,
    /// Whether axial forces are evaluated.
    pub axial: bool,
    /// What runs, and why.
    pub runs: Vec<Skipped>,
    /// What does not, and why.
    pub skipped: Vec<Skipped>,
}

/// What the planner must know about the models of the case.
#[derive(Debug, Clone, Copy)]
pub struct Facts<'a> {
    /// Name of the gas-flow model, and whether it depends on film thickness.
    pub gas: (&'a str, bool),
    /// Name of the ring-motion model, and whether it depends on film force, for rings that move.
    pub motion: (&'a str, bool),
    /// Rings that move: dynamically or by decision.
    pub moving: usize,
    /// Rings with position and velocity as states.
    pub dynamic: usize,
    /// Rings with a volume of oil on their flanks.
    pub wet: usize,
}

/// The names that `outputs.results` asks for.
///
/// # Errors
/// A name that is not in the catalogue.
pub fn wanted(asked: &[String], names: &Names, told: Told) -> Result<Vec<ResultInfo>, Vec<BuildError>> {
    let all = catalogue(names, told);
    let mut errors = Vec::new();
    for (k, name) in asked.iter().enumerate() {
        if name != "all" && !all.iter().any(|r| &r.name == name) {
            let near = all
                .iter()
                .map(|r| (strsim::jaro_winkler(&r.name, name), r.name.as_str()))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            let mut e =
                BuildError::at(format!("outputs.results.{k}"), format!("there is no result `{name}`"));
            if let Some((_, near)) = near {
                let names: Vec<_> = all.iter().map(|r| r.name.as_str()).collect();
                e = e.help(format!("did you mean `{near}`? The results are: {}", names.join(", ")));
            }
            errors.push(e);
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let every = asked.is_empty() || asked.iter().any(|a| a == "all");
    Ok(all.into_iter().filter(|r| every || asked.contains(&r.name)).collect())
}

/// Closes the wanted results over what they need.
#[must_use]
pub fn plan(wanted: &[ResultInfo], facts: Facts<'_>) -> Plan {
    let mut p = Plan { wanted: wanted.iter().map(|r| r.name.clone()).collect(), ..Plan::default() };
    let runs = |p: &mut Plan, what: &str, why: String| p.runs.push(Skipped { what: what.into(), why });
    let skip = |p: &mut Plan, what: &str, why: String| p.skipped.push(Skipped { what: what.into(), why });
    runs(&mut p, "gas_flow", "every result of a ring pack depends on the pressures".into());

    let film_results: Vec<_> =
        wanted.iter().filter(|r| r.needs == Needs::Film).map(|r| r.name.as_str()).collect();
    let (motion, motion_film) = facts.motion;
    let (gas, gas_film) = facts.gas;
    p.axial = facts.moving > 0;
    p.film_wanted = !film_results.is_empty();
    p.film = !film_results.is_empty() || (p.axial && motion_film) || gas_film;
    if p.film {
        let mut why = Vec::new();
        if let Some(first) = film_results.first() {
            let more = film_results.len() - 1;
            why.push(if more == 0 {
                format!("`{first}` is wanted")
            } else {
                format!("`{first}` and {more} more are wanted")
            });
        }
        if p.axial && motion_film {
            why.push(format!("the force of the film is part of `{motion}`"));
        }
        if gas_film {
            why.push(format!("the passages of `{gas}` depend on the film thickness"));
        }
        runs(&mut p, "hydrodynamics, contact, oil, film_temperature", why.join("; "));
    } else {
        let why = format!("no wanted result needs a film, and neither `{gas}` nor `{motion}` depends on it");
        skip(&mut p, "hydrodynamics, contact, oil, film_temperature, flank_friction", why);
    }
    if p.axial {
        runs(
            &mut p,
            "ring_motion",
            format!("{} ring(s) can move, and `{gas}` depends on where they are", facts.moving),
        );
    } else {
        skip(&mut p, "ring_motion", "no ring moves in its groove: no axial states, no axial forces".into());
    }
    if facts.dynamic > 0 {
        runs(&mut p, "flank", format!("{} ring(s) move freely", facts.dynamic));
    } else if facts.wet > 0 {
        runs(&mut p, "flank", format!("oil closes the gaps at the flanks of {} ring(s) to gas", facts.wet));
    } else {
        skip(&mut p, "flank", "no ring moves freely in its groove".into());
    }
    p
}
