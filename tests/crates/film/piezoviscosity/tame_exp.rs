//! The exponential that does not overflow.

use gudgeon_film::parts::tame_exp::{MAX_EXPONENT, MIN_EXPONENT, tame_exp};

#[test]
fn the_exponential_is_continued_with_its_slope() {
    for joint in [MAX_EXPONENT, MIN_EXPONENT] {
        let (l, r) = (tame_exp(joint.next_down()), tame_exp(joint.next_up()));
        // One ulp of the argument 30 is 4e-15.
        assert!((l.0 / r.0 - 1.0).abs() < 1e-14 && (l.1 / r.1 - 1.0).abs() < 1e-14);
    }
    for x in [-1e300, -5.0, 0.0, 40.0, 1e300] {
        let (f, s) = tame_exp(x);
        assert!(f > 0.0 && f.is_finite() && s >= 0.0 && s.is_finite(), "{x}");
    }
}
