//! Names of all results that a run may tell, known from the case alone. What a search may not find (a lighter pin of the stock, an optimum beside
//! the published search) is among them.

use gudgeon_core::kinds::PinQuantity;
use gudgeon_pin::piston::GUIDES;

use super::case::{Crown, Method, Optimise, PinCase, Skirt};
use super::setup::Setup;

/// Names of the results of a case, of its pin first.
pub fn names(case: &PinCase, setup: Option<&Setup>) -> Vec<String> {
    let mut all = Vec::new();
    if let Some(s) = setup {
        of_pin(&mut all, case, s);
    }
    if let Some(s) = &case.skirt {
        of_skirt(&mut all, s);
    }
    if let Some(c) = &case.crown {
        of_crown(&mut all, c);
    }
    if let Some(d) = &case.dimensions {
        for (g, v) in GUIDES.iter().zip(d.values()) {
            all.push(format!("guide_{}", g.name));
            all.extend(v.map(|_| format!("adopted_{}", g.name)));
        }
    }
    all
}

fn add(all: &mut Vec<String>, names: &[&str]) {
    all.extend(names.iter().map(|n| (*n).to_owned()));
}

fn of_pin(all: &mut Vec<String>, case: &PinCase, s: &Setup) {
    let design = s.design();
    let limited: Vec<&str> = PinQuantity::ALL
        .into_iter()
        .filter(|q| design.limits[*q as usize].is_finite())
        .map(PinQuantity::name)
        .collect();
    add(all, &["length", "outer", "inner", "pin_mass"]);
    if s.relief.is_some() {
        add(all, &["relieved_mass", "mass_differential"]);
    }
    add(all, &["second_moment", "section_modulus", "pressure_centres"]);
    add(all, &PinQuantity::ALL.map(PinQuantity::name));
    all.extend(limited.iter().map(|q| format!("utilisation_{q}")));
    if !limited.is_empty() {
        add(all, &["utilisation"]);
    }
    add(all, &["peak_pressure", "gas_force", "inertia_force", "pin_force"]);
    if s.load.crank_ratio.is_some() {
        add(all, &["crank_ratio"]);
    }
    if !s.load.cycle.is_empty() {
        add(all, &["design_angle"]);
    }
    add(all, &["piston_mass_estimate"]);
    if let Some(o) = &case.optimise {
        of_search(all, o, &limited);
        if o.method == Method::Exact && s.given.is_some() {
            add(all, &["excess_of_given"]);
        }
    }
    if !s.fatigue.is_off() {
        add(all, &["fatigue_mean", "fatigue_amplitude", "fatigue_safety"]);
    }
}

fn of_search(all: &mut Vec<String>, o: &Optimise, limited: &[&str]) {
    match o.method {
        Method::Exact => {
            all.extend(limited.iter().map(|q| format!("multiplier_{q}")));
            add(all, &["sensitivity_force", "sensitivity_modulus", "stationarity", "infeasibility"]);
            add(all, &["complementarity", "curvature", "certificate_gap", "mass_bound"]);
        }
        Method::AsPublished => {
            for phase in ["coarse", "fine"] {
                all.extend(limited.iter().map(|q| format!("{phase}_{q}")));
            }
            add(all, &["start_bore_admitted", "start_length_admitted", "excess_here", "excess"]);
        }
    }
    add(all, &["min_outer"]);
    if o.stock.is_some() {
        add(all, &["stock_length", "stock_outer", "stock_inner", "stock_mass_differential", "stock_excess"]);
    }
}

fn of_skirt(all: &mut Vec<String>, s: &Skirt) {
    if s.surface_ratio.is_some() {
        add(all, &["ovality"]);
    }
    let mut stations = |names: &[&str]| {
        all.extend(names.iter().flat_map(|name| (1..=5).map(move |i| format!("{name}_{i}"))));
    };
    stations(&["growth", "assembly_clearance", "deviation"]);
    if s.reference_offset.is_some() {
        stations(&["reference"]);
    }
    stations(&["proposed_ordinate", "warm_clearance", "warm_proposed", "warm_profiled"]);
    let rows = (s.height.si() / s.step.si() + 1e-9).floor() as usize;
    all.extend((0..=rows).map(|k| format!("curve_{k}")));
    add(all, &["warm_gap"]);
    if s.surface_ratio.is_some() {
        add(all, &["oval_drop"]);
    }
}

fn of_crown(all: &mut Vec<String>, c: &Crown) {
    add(all, &["recess_depth", "recess_rim", "recess_volume", "recess_volume_of_rim"]);
    add(all, &["swept_volume", "clearance_volume"]);
    if c.nominal_volume.is_some() {
        add(all, &["actual_compression_ratio", "flat_compression_ratio"]);
    }
}
