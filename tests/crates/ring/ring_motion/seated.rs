//! A ring that never leaves its seat.

use gudgeon_core::kinds::{FlankCtx, FlankSpec};
use gudgeon_core::kinds::{RingMotionCtx, RingMotionSpec};
use gudgeon_ring::{Dry, Flank, Seated};

#[test]
fn rests_where_it_is_told() {
    let oil = FlankCtx::new(2, 3, 0.6, 5e-3, 0.01);
    for (flank, e) in [(Flank::Lower, 0.0), (Flank::Upper, 1.0)] {
        let damping = Dry::default().build(&oil).expect("builds").law();
        let m = Seated { flank }.build(RingMotionCtx::new(2, 0.0, 0.0, 1.0, damping)).expect("always builds");
        let pose = m.pose(&[], 1e-4);
        assert_eq!((pose.s, pose.lift_fraction), (e * 1e-4, e));
        assert!(!m.moves() && !m.uses_film_force() && m.states().is_empty());
    }
}
