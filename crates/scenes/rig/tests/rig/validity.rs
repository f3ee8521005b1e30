//! Notes on films outside their theory.

use gudgeon_core::kinds::RigOut;
use gudgeon_scene_rig::validity::note_limits;

fn noted(h: f64, p_max: f64, open: f64) -> Vec<String> {
    let mut out = RigOut::default();
    out.axis("x", "m", vec![0.0, 1.0]);
    out.column("h", "m", vec![1e-6, h]);
    out.result("p_max", p_max / 1e5, "bar", "highest pressure");
    out.balance.oil_mass = Some(open);
    note_limits(&mut out);
    out.notes.into_iter().map(|n| n.topic).collect()
}

#[test]
fn a_film_says_where_its_equation_ends() {
    assert!(noted(2e-9, 3e9, 1e-9).is_empty());
    assert_eq!(noted(2e-10, 3e9, 0.0), ["film_of_molecules"]);
    assert_eq!(noted(2e-9, 5e9, 0.0), ["surfaces_would_yield"]);
    assert_eq!(noted(2e-9, 3e9, -0.5), ["oil_not_conserved"]);
}
