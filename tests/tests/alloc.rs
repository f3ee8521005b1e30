//! The right-hand side of a whole ring pack, its Jacobian and the stages of implicit steps allocate nothing.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod common;
#[path = "common/counting.rs"]
mod counting;

use common::*;
use counting::allocations;
use gudgeon_core::file::Files;
use gudgeon_core::states::Stage;
use gudgeon_scene_ring_pack::assemble::assemble;
use gudgeon_scene_ring_pack::case::RingPackCase;
use gudgeon_scene_ring_pack::jacobian::Base;
use gudgeon_scene_ring_pack::staged::Staging;

#[test]
fn a_right_hand_side_allocates_nothing() {
    let models = ["orifice_network", "gap_orifice", "narrow_channel", "namazian_heywood", "labyrinth"];
    let warm = "{ model = \"narrow_channel\", mouth = \"automatic\", gas_temperature = \"energy_balance\" }";
    for gas in models.map(|name| format!("{{ model = \"{name}\" }}")).into_iter().chain([warm.to_owned()]) {
        let case = checked("turbo-diesel-120/flooded", &[&format!("models.gas_flow={gas}")]);
        let mut pack =
            assemble(case.of::<RingPackCase>().expect("a ring pack"), &Files::default()).expect("assembles");
        let n = pack.layout.n;
        let mut y = vec![0.0; n];
        pack.initial(2e5, &mut y);
        let mut f = vec![0.0; n + pack.layout.quads()];
        let mut jac = vec![0.0; f.len() * n];
        let mut base = Base::default();
        let mut answered = 0;
        let mut before = 0;
        // Two cycles of states around the start: films, seats and pressures change with the angle. The first cycle may fill work
        // arrays.
        for k in 0..1440 {
            if k == 720 {
                before = allocations();
                answered = 0;
            }
            let theta = f64::from(k % 720).to_radians();
            let mut z = y.clone();
            before += u64::from(k >= 720);
            for (i, z) in z.iter_mut().enumerate() {
                *z += 0.05 * (theta * (1.0 + 0.3 * i as f64)).sin();
            }
            if pack.rates(theta, &z, &mut f).is_ok()
                && pack.jacobian(&z, |_| 1e-7, &mut jac, &mut base).is_ok()
            {
                answered += 1;
            }
        }
        let allocations = allocations() - before;
        assert!(answered > 600, "{gas}: {answered} of 720 states can be evaluated");
        // A state that a model refuses costs the text of its refusal.
        assert!(allocations <= 10 * (720 - answered), "{gas}: {allocations} allocations, {answered} answers");
    }
}

#[test]
fn a_stage_of_an_implicit_step_allocates_nothing() {
    for name in ["turbo-diesel-120/flooded", "turbo-diesel-120"] {
        let case = checked(name, &[]);
        let mut pack =
            assemble(case.of::<RingPackCase>().expect("a ring pack"), &Files::default()).expect("assembles");
        let n = pack.layout.n;
        let mut base = vec![0.0; n];
        pack.initial(2e5, &mut base);
        let mut staging = Staging::new(&pack);
        let (mut y, mut g) = (base.clone(), vec![0.0; pack.layout.quads()]);
        let accuracy = vec![1e-6; n];
        let (mut answered, mut before) = (0, 0);
        // Implicit steps of a degree, the first of which may fill work arrays.
        for k in 0..240 {
            if k == 60 {
                before = allocations();
                answered = 0;
            }
            let stage = Stage { number: 1, base: &base, step: 1f64.to_radians(), accuracy: &accuracy };
            if pack.stage(f64::from(k + 1).to_radians(), &stage, &mut y, &mut g, &mut staging).is_ok() {
                answered += 1;
                base.copy_from_slice(&y);
            } else {
                y.copy_from_slice(&base);
            }
        }
        let allocations = allocations() - before;
        assert!(answered > 120, "{name}: {answered} of 180 stages are solved");
        // A stage that is not solved costs the text of its refusal, at every trial.
        assert!(
            allocations <= 40 * (180 - answered),
            "{name}: {allocations} allocations, {answered} answers"
        );
    }
}
