//! What `bench` races on a pin: the exact optimum with its proof at several gaps, and the published search at several steps.

use gudgeon_core::kinds::PinSize;
use gudgeon_pin::optimum::lightest;
use gudgeon_scene::{Asked, MethodSetting, Reference, WorkPrecision};

use crate::case::{Method, Optimise, PinCase};
use crate::setup::Setup;

/// Gaps of the proof.
const GAPS: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
/// Steps of the published search, as parts of those of the case.
const STEPS: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.1];
/// Gap of the proof that gives the reference, and of the one that tells how far it can be trusted.
const TIGHT: [f64; 2] = [1e-7, 1e-6];
/// Where the published search starts, over length and bore of the optimum: it only ever lengthens a pin and narrows its bore.
const START: (f64, f64) = (0.9, 1.1);

/// Methods and reference for diagrams of run time against error.
pub fn work_precision(case: &PinCase, setup: Option<&Setup>) -> Result<WorkPrecision, String> {
    let (Some(s), Some(o)) = (setup, &case.optimise) else {
        return Err(
            "without a table `optimise` everything is a closed form: there is no numerical setting to race"
                .into(),
        );
    };
    if o.method != Method::Exact {
        return Err("`bench` races the searches for the lightest pin from `optimise.method = \"exact\"`, and adds the published one".into());
    }
    let mass = if s.relief.is_some() { "mass_differential" } else { "pin_mass" };
    let mut settings: Vec<MethodSetting> = GAPS.iter().map(|gap| proved(*gap, o)).collect();
    settings.extend(published(s, o));
    Ok(WorkPrecision {
        settings,
        reference: Some(Reference {
            set: vec![certificate(TIGHT[0])],
            check: vec![certificate(TIGHT[1])],
            is: format!(
                "branch and bound, below which no pin of the ranges weighs, gap {:.0e}; differs from a gap of {:.0e}",
                TIGHT[0], TIGHT[1]
            ),
            independent: true,
            told_as: vec![(mass, "mass_bound")],
        }),
        all: vec!["optimise.sweep_points=0".into(), "optimise.pareto=[]".into()],
        results: vec![mass.into()],
        ..WorkPrecision::default()
    })
}

fn certificate(gap: f64) -> String {
    format!("optimise.certificate={gap:e}")
}

/// The optimum with its proof.
fn proved(gap: f64, o: &Optimise) -> MethodSetting {
    MethodSetting {
        method: "exact optimum and proof".into(),
        setting: format!("gap {gap:.0e}"),
        is_default: (gap / o.certificate.si() - 1.0).abs() < 1e-9,
        set: vec!["optimise.method=exact".into(), certificate(gap)],
        asked: Some(Asked { tolerance: gap, told_by: Some("certificate_gap"), ..Asked::default() }),
    }
}

/// The published search at the outer diameter of the optimum, which it cannot find; none where that is a solid pin.
fn published(s: &Setup, o: &Optimise) -> Vec<MethodSetting> {
    let d = s.design();
    let best = match lightest(&d, s.given).or_else(|_| lightest(&d, None)) {
        Ok(best) if best.size.inner > 0.0 => best.size,
        _ => return Vec::new(),
    };
    let start = PinSize {
        length: (START.0 * best.length).max(d.length.low),
        outer: best.outer,
        inner: (START.1 * best.inner).min(0.5 * (best.inner + best.outer)),
    };
    STEPS.iter().map(|part| stepped(*part, &start, o)).collect()
}

fn stepped(part: f64, start: &PinSize, o: &Optimise) -> MethodSetting {
    let [length, coarse, fine] = [o.steps.length, o.steps.coarse, o.steps.fine].map(|s| part * s.si());
    MethodSetting {
        method: "published search, outer diameter given".into(),
        setting: format!("steps of {:.4} and {:.4} mm", 1e3 * length, 1e3 * fine),
        is_default: false,
        set: vec![
            "optimise.method=as_published".into(),
            format!("optimise.steps.length={length:e}"),
            format!("optimise.steps.coarse={coarse:e}"),
            format!("optimise.steps.fine={fine:e}"),
            format!("pin.length={:e}", start.length),
            format!("pin.outer={:e}", start.outer),
            format!("pin.inner={:e}", start.inner),
        ],
        asked: None,
    }
}
