//! The models are registered.

#[test]
fn registered() {
    let registry = gudgeon_core::Registry::collect();
    for (kind, names) in [
        ("ring_motion", &["newton_groove", "seated", "three_seat"][..]),
        ("flank", &["dry", "squeeze_film", "tangent_degrees", "tangent_radians", "wetted_strip"]),
        ("flank_friction", &["off", "rational_saturation", "tanh_stribeck"]),
    ] {
        let found: Vec<_> = registry.models(kind).iter().map(|m| m.name).collect();
        assert_eq!(found, names);
    }
}
