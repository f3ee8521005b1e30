//! Limits and their reasons.

use gudgeon_scene_ring_pack::limits::Limits;

#[test]
fn every_limit_says_its_value_and_its_reason() {
    let told = Limits::default().explained();
    assert!(told.len() >= 16);
    for (key, value, reason) in told {
        assert!(
            key.starts_with("solver.limits.") && !value.is_empty() && reason.len() > 20,
            "{key}: {reason}"
        );
    }
}

#[test]
fn steps_follow_the_tolerance_unless_they_are_given() {
    let mut l = Limits::default();
    let most = [(1e-3, 200.0), (1e-4, 100.0), (1e-8, 200.0), (1e-4, 10.0)].map(|(t, w)| l.steps_at(t, w));
    assert_eq!(most, [30_000, 30_000, 300_000, 300_000]);
    l.max_steps = 17;
    assert_eq!(l.steps_at(1e-8, 1.0), 17);
}
