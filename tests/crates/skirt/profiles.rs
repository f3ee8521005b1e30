//! Shapes of the skirt.

use gudgeon_core::kinds::{SkirtProfileCtx, SkirtProfileSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_skirt::Barrel;

#[test]
fn drops_at_the_edges_and_none_in_the_middle() {
    let spec = Barrel {
        top: quantity(2e-5),
        bottom: quantity(1e-5),
        widest: quantity(0.4),
        ovality: quantity(1e-4),
    };
    let files = &gudgeon_core::file::Files::default();
    let p = spec.build(&SkirtProfileCtx { length: 0.05, radius: 0.04, files }).expect("builds");
    // A product and a sum or two.
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-19, "{a} {b}");
    near(p.depth(0.0, 0.0), 2e-5);
    near(p.depth(0.05, 0.0), 1e-5);
    near(p.depth(0.02, 0.0), 0.0);
    near(p.depth(0.01, 0.0), 0.5e-5);
    near(p.depth(0.02, std::f64::consts::FRAC_PI_6), 2.5e-5);
}
