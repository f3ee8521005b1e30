//! Where rings wear the liner.

use std::f64::consts::PI;

use crate::common::*;

#[test]
fn what_wears_the_liner_is_the_work_of_rubbing_over_its_coefficient() {
    // A seated ring on a liner of 100 mm and a stroke of 100 mm, its friction of contact 0.1, in thin oil.
    let r = run_case("ring-on-liner", &["models.oil.viscosity=10 mPa s"]);
    let load = value(&r, "ring1.wear_load");
    let swept = 0.25 * PI * 0.1_f64.powi(2) * 0.1;
    let rubbing = value(&r, "ring1.fmep_boundary") * 1e5 * swept;
    // Friction fades below `solver.limits.friction_speed`, 1 mm/s against a mean speed of 0.89 m/s.
    assert!((rubbing / (0.1 * load) - 1.0).abs() < 1e-3, "{rubbing} J of friction, {load} J");
    let table = &r.tables["liner_wear"];
    let (depths, wear) = (&table.axis.values, &table.get("ring1.wear_load").expect("the ring").values);
    let along = wear.iter().sum::<f64>() * (depths[1] - depths[0]) * PI * 0.1;
    // Rows half a degree apart: trapezoids of |sin| miss h²/12, and what contact does between them.
    assert!((along / load - 1.0).abs() < 1e-3, "{along} J along the liner, {load} J");
    // Films are thinnest at the dead centres: most is worn there.
    let most = wear.iter().copied().fold(0.0, f64::max);
    let place = wear.iter().position(|w| *w == most).expect("the largest");
    assert!(place < wear.len() / 8 || place > wear.len() * 7 / 8, "{place}");
}
