//! What a ring-pack run must compute: from wanted results to the parts that are built and integrated.

use gudgeon_core::BuildError;
use gudgeon_core::result::Skipped;

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

/// Every result of a pack of `rings` rings; `oil`: whether oil is followed on the liner.
#[must_use]
pub fn catalogue(rings: usize, oil: bool) -> Vec<ResultInfo> {
    let mut all = Vec::new();
    let mut add = |name: String, unit, needs, what: String| all.push(ResultInfo { name, unit, what, needs });
    add(
        "blow_by".into(),
        "l/min",
        Needs::Gas,
        "gas to the crankcase, whole engine, at meter conditions".into(),
    );
    add(
        "blow_by_per_cylinder".into(),
        "l/min",
        Needs::Gas,
        "gas to the crankcase, one cylinder, at meter conditions".into(),
    );
    add("blow_by_mass_per_cycle".into(), "kg", Needs::Gas, "gas to the crankcase, one cylinder".into());
    add(
        "blow_back_mass_per_cycle".into(),
        "kg",
        Needs::Gas,
        "gas returning past ring 1 to the cylinder, one cylinder".into(),
    );
    add("cylinder.p_max".into(), "bar", Needs::Gas, "highest cylinder pressure".into());
    for k in 2..=rings {
        add(format!("land{k}.p_max"), "bar", Needs::Gas, format!("highest pressure of land {k}"));
        add(
            format!("land{k}.p_max_angle"),
            "deg",
            Needs::Gas,
            format!("crank angle of the highest pressure of land {k}"),
        );
    }
    for i in 1..=rings {
        add(
            format!("ring{i}.seat_changes"),
            "1",
            Needs::Axial,
            format!(
                "arrivals of ring {i} on a groove flank (within `outputs.seat` of its clearance) per cycle"
            ),
        );
        add(
            format!("ring{i}.lifted_share"),
            "1",
            Needs::Axial,
            format!(
                "share of the cycle that ring {i} is off its lower flank, farther than `outputs.seat` of its clearance"
            ),
        );
        add(format!("ring{i}.h_min"), "um", Needs::Film, format!("thinnest film under ring {i}"));
        add(format!("ring{i}.h_max"), "um", Needs::Film, format!("thickest film under ring {i}"));
        add(format!("ring{i}.h_mean"), "um", Needs::Film, format!("mean film under ring {i}"));
        add(
            format!("ring{i}.friction_power"),
            "W",
            Needs::Film,
            format!("mean friction power of ring {i}, one cylinder"),
        );
        add(
            format!("ring{i}.oil_face_combustion"),
            "mm3",
            Needs::Film,
            format!("film on the expansion stroke less that on the compression stroke, ring {i}, per cycle"),
        );
        add(
            format!("ring{i}.oil_face_gas_exchange"),
            "mm3",
            Needs::Film,
            format!("film on the intake stroke less that on the exhaust stroke, ring {i}, per cycle"),
        );
        add(
            format!("ring{i}.oil_gap"),
            "mm3",
            Needs::Film,
            format!("oil that a gap full of oil would let up past ring {i}, per cycle"),
        );
        add(
            format!("ring{i}.oil_groove"),
            "mm3",
            Needs::Axial,
            format!("oil pumped up past the flanks of ring {i} in an oil-filled groove, per cycle"),
        );
        if oil {
            add(
                format!("ring{i}.wetted_share"),
                "1",
                Needs::Film,
                format!("mean share of the face under full film, ring {i}"),
            );
        }
    }
    if oil {
        add(
            "oil_taken".into(),
            "mm3",
            Needs::Film,
            "oil taken up from the liner by all faces, per cycle".into(),
        );
        add("oil_drained".into(), "mm3", Needs::Film, "oil scraped into the crankcase, per cycle".into());
        add(
            "oil_thrown".into(),
            "mm3",
            Needs::Film,
            "oil thrown off above ring 1 into the combustion chamber, per cycle".into(),
        );
    }
    add("friction_power".into(), "W", Needs::Film, "mean friction power of the pack, one cylinder".into());
    add("fmep".into(), "bar", Needs::Film, "friction mean effective pressure of the pack".into());
    add(
        "periodicity_error".into(),
        "1",
        Needs::Gas,
        "estimated true relative error of the periodic state".into(),
    );
    all
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
}

/// The names that `outputs.results` asks for.
///
/// # Errors
/// A name that is not in the catalogue.
pub fn wanted(asked: &[String], rings: usize, oil: bool) -> Result<Vec<ResultInfo>, Vec<BuildError>> {
    let all = catalogue(rings, oil);
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
        runs(&mut p, "flank_damping", format!("{} ring(s) move freely", facts.dynamic));
    } else {
        skip(&mut p, "flank_damping", "no ring moves freely in its groove".into());
    }
    p
}
