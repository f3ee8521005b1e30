//! The exact optimum: the published engine, the closed-form problem, random engines, its proofs.

mod common;

use common::*;
use gudgeon_core::kinds::{PinForces, PinQuantity, PinSize, PinStrengthCtx};
use gudgeon_pin::certificate::certify;
use gudgeon_pin::design::Range;
use gudgeon_pin::optimum::{NoOptimum, PROOF, is_sharp, lightest};

#[test]
fn the_published_engine_has_a_pin_0_69_g_lighter() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let d = published_design(&*strength, PUBLISHED_PI);
    let o = lightest(&d, None).expect("solved");
    println!("{o:?}");
    // Brute force of the specification printed to the last digit given.
    assert!((1e3 * o.size.outer - 21.2497).abs() < 5e-5, "{}", o.size.outer);
    assert!((1e3 * o.size.length - 62.8684).abs() < 5e-5, "{}", o.size.length);
    assert!((1e3 * o.size.inner - 13.5896).abs() < 5e-5, "{}", o.size.inner);
    assert!((1e3 * o.masses.differential() - 42.678).abs() < 5e-4, "{}", o.masses.differential());
    let mut active = o.active();
    active.sort();
    assert_eq!(active, [PinQuantity::BossPressure, PinQuantity::Ovalisation, PinQuantity::BendingStress]);
    assert!(is_sharp(&o) && o.proof.curvature.is_none(), "{:?}", o.proof);
    let published = d.masses(&mm(61.9, 21.85, 13.94));
    assert!((1e3 * (published.differential() - o.masses.differential()) - 0.69).abs() < 5e-3);
    let c = certify(&d, &o.size, 1e-6, 200_000);
    println!("{c:?}");
    assert!(c.closed && c.lighter.is_none() && c.bound >= o.masses.differential() - 1.001e-6 * o.masses.pin);
}
