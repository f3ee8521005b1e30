//! A ring that never leaves its seat.

use gudgeon_core::kinds::{FlankDampingCtx, FlankDampingSpec};
use gudgeon_core::kinds::{RingMotionCtx, RingMotionSpec};
use gudgeon_ring::{DampingOff, Flank, Seated};

#[test]
fn rests_where_it_is_told() {
    let oil = FlankDampingCtx { ring: 2, rings: 3, oil_fill: 0.6, width: 5e-3, mu: 0.01 };
    for (flank, e) in [(Flank::Lower, 0.0), (Flank::Upper, 1.0)] {
        let damping = DampingOff {}.build(&oil).expect("builds");
        let m = Seated { flank }.build(RingMotionCtx::new(2, 0.0, 0.0, 1.0, damping)).expect("always builds");
        let pose = m.pose(&[], 1e-4);
        assert_eq!((pose.s, pose.lift_fraction), (e * 1e-4, e));
        assert!(!m.moves() && !m.uses_film_force() && m.states().is_empty());
    }
}
