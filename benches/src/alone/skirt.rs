//! The piston skirt: shape, yielding, and friction across the bore.

use std::fmt::Write as _;
use std::hint::black_box;

use gudgeon_core::ModelInfo;
use gudgeon_core::elementary;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    GrooveFrictionCtx, GrooveFrictionSpec, PinFrictionSpec, ProfileCurveSpec, SkirtComplianceCtx,
    SkirtComplianceSpec, SkirtOilSpec, SkirtProfileCtx, SkirtProfileSpec,
};
use gudgeon_skirt::Panel;

use super::{Alone, alone, seen};

/// One side of a skirt.
const PANEL: Panel = Panel { radius: 0.04, length: 0.05, half_angle: 0.6 };

/// Depths at 24 x 16 places of the side.
pub fn skirt_profile(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn SkirtProfileSpec, _, _>(
        m,
        |s| {
            let files = Files::default();
            s.build(&SkirtProfileCtx { length: PANEL.length, radius: PANEL.radius, files: &files })
        },
        |shape| {
            let of = |k: u32, n: u32| f64::from(k) / f64::from(n - 1);
            let depth = |i: u32, j: u32| {
                shape.depth(black_box(PANEL.length * of(i, 24)), PANEL.half_angle * (2.0 * of(j, 16) - 1.0))
            };
            seen((0..16).map(|j| (0..24).map(|i| depth(i, j)).sum::<f64>()).sum::<f64>())
        },
    )
}

/// Seven heights and five angles over the side: place \[m, rad\].
fn places() -> Vec<(f64, f64)> {
    let height = |i: u32| PANEL.length * f64::from(i) / 6.0;
    let angle = |j: u32| PANEL.half_angle * (0.5 * f64::from(j) - 1.0);
    (0..5).flat_map(|j| (0..7).map(move |i| (height(i), angle(j)))).collect()
}

/// Deflections \[m/N\] of a skirt that bends from its upper edge, as the file of an influence matrix.
fn influence_matrix() -> String {
    let shape = |p: &(f64, f64)| (p.0 / PANEL.length).powi(2) * elementary::cos(2.0 * p.1);
    let all = places();
    let mut text = String::from("# height angle c\n");
    for (k, a) in all.iter().enumerate() {
        // Writing to a text cannot fail.
        let _ = write!(text, "{} {}", a.0, a.1.to_degrees());
        for (i, b) in all.iter().enumerate() {
            let own = if i == k { 1e-11 } else { 0.0 };
            let _ = write!(text, ",{:e}", 4e-9 * shape(a) * shape(b) + own);
        }
        text.push('\n');
    }
    text
}

/// Elastic resistances of all shapes; the shapes are found where the model is built.
pub fn skirt_compliance(m: &ModelInfo) -> Result<Alone, String> {
    // The name that the example of the model with a file gives.
    let files = Files::recorded([("skirt-compliance.csv".to_owned(), influence_matrix())]);
    let grid = PANEL.grid(24, 16, 0.0);
    let nodes = grid.len();
    alone::<dyn SkirtComplianceSpec, _, _>(
        m,
        move |s| {
            let Panel { length, radius, half_angle } = PANEL;
            s.build(&SkirtComplianceCtx::new(&grid, length, radius, half_angle, &files))
        },
        move |skirt| {
            let shapes = skirt.shapes().len() / nodes;
            seen((0..shapes).map(|k| skirt.resistance(k, black_box(1e-6), 0.0)).sum::<f64>())
        },
    )
}

/// What arrives at the edges of a skirt that keeps its oil; one that keeps none is asked for nothing.
pub fn skirt_oil(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn SkirtOilSpec, _, _>(
        m,
        |s| s.build(),
        |supply| seen(supply.as_ref().map_or(0.0, |s| s.arriving(black_box(1.0))[0] + s.room_above())),
    )
}

pub fn groove_friction(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn GrooveFrictionSpec, _, _>(
        m,
        |s| s.build(&GrooveFrictionCtx { bore: 2.0 * PANEL.radius }),
        |law| seen(law.force(black_box(60e5), 0.01)),
    )
}

pub fn pin_friction(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn PinFrictionSpec, _, _>(m, |s| s.build(), |law| seen(law.moment(black_box(50e3), 30.0)))
}

/// A curve through five ordinates, asked at 32 places.
pub fn profile_curve(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn ProfileCurveSpec, _, _>(
        m,
        |s| s.build(&[0.0, 0.01, 0.02, 0.035, 0.05], &[30e-6, 10e-6, 2e-6, 0.0, 12e-6]),
        |curve| {
            let x = |k: u32| PANEL.length * f64::from(k) / 31.0;
            seen((0..32).map(|k| curve.value(black_box(x(k)))).sum::<f64>())
        },
    )
}
