//! Influence matrices and shapes from files.

use std::fmt::Write as _;
use std::path::PathBuf;

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{SkirtComplianceCtx, SkirtComplianceSpec, SkirtProfileCtx, SkirtProfileSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_skirt::{InfluenceMatrix, Panel, Table};

/// A folder of this test alone, with one file.
fn folder(name: &str, text: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gudgeon-skirt-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("data.csv"), text).expect("a file");
    folder
}

const PANEL: Panel = Panel { radius: 0.04, length: 0.05, half_angle: 0.6 };

/// Seven heights and five angles over the side, `(height, radians)`.
fn points() -> Vec<(f64, f64)> {
    (0..5).flat_map(|j| (0..7).map(move |i| (0.05 * f64::from(i) / 6.0, 0.3 * f64::from(j) - 0.6))).collect()
}

/// Compliance between two points \[m/N\]: a skirt that bends from its upper edge and flattens across, and a little of its own at every point.
fn compliance(a: (f64, f64), b: (f64, f64)) -> f64 {
    let shape = |p: (f64, f64)| (p.0 / 0.05).powi(2) * (2.0 * p.1).cos();
    let other = |p: (f64, f64)| (1.0 - p.0 / 0.05) * p.1.cos();
    let own = if a == b { 1e-11 } else { 0.0 };
    4e-9 * shape(a) * shape(b) + 1e-9 * other(a) * other(b) + own
}

fn file(skew: f64) -> String {
    let all = points();
    let mut text = String::from("# height angle c\n");
    for (k, a) in all.iter().enumerate() {
        let _ = write!(text, "{} {}", a.0, a.1.to_degrees());
        for (m, b) in all.iter().enumerate() {
            let _ = write!(text, ",{:e}", compliance(*a, *b) + if m > k { skew } else { 0.0 });
        }
        text.push('\n');
    }
    text
}

#[test]
fn shapes_of_a_matrix_give_its_deflections() {
    let folder = folder("matrix", &file(0.0));
    let grid = PANEL.grid(6, 4, 0.0);
    let files = Files::of(&folder);
    let ctx = SkirtComplianceCtx::new(&grid, PANEL.length, PANEL.radius, PANEL.half_angle, &files);
    let spec = InfluenceMatrix { file: "data.csv".into(), shapes: 35, rest: quantity(0.0) };
    let modes = spec.build(&ctx).expect("shapes");
    // The nodes of this grid are the points. A force on point 10, and its mirror image 24: both, because half of a symmetric side is solved.
    let n = grid.len();
    let force = |k: usize| if k == 10 || k == 24 { 50.0 } else { 0.0 };
    let all = points();
    for at in [0, 6, 13, 27, 34] {
        let by_matrix: f64 = (0..n).map(|k| compliance(all[at], all[k]) * force(k)).sum();
        let by_shapes: f64 = (0..modes.states().len())
            .map(|m| {
                let shape = &modes.shapes()[m * n..(m + 1) * n];
                let load: f64 = (0..n).map(|k| shape[k] * force(k)).sum();
                shape[at] * modes.rest(m, load)
            })
            .sum();
        // Rounding of the file's digits and of the eigenvectors.
        assert!(
            (by_matrix - by_shapes).abs() < 1e-9 * 1e-7 + 1e-6 * by_matrix.abs(),
            "{at}: {by_matrix:e} {by_shapes:e}"
        );
    }
    // Of its shapes, two matter.
    let few = InfluenceMatrix { file: "data.csv".into(), shapes: 12, rest: quantity(0.02) };
    assert_eq!(few.build(&ctx).expect("shapes").states().len(), 2);
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn what_is_no_matrix_is_refused() {
    let grid = PANEL.grid(6, 4, 0.0);
    let refused = |name: &str, text: &str| {
        let folder = folder(name, text);
        let files = Files::of(&folder);
        let ctx = SkirtComplianceCtx::new(&grid, PANEL.length, PANEL.radius, PANEL.half_angle, &files);
        let spec = InfluenceMatrix { file: "data.csv".into(), shapes: 12, rest: quantity(1e-3) };
        let e = spec.build(&ctx).expect_err("refused").to_string();
        let _ = std::fs::remove_dir_all(&folder);
        e
    };
    assert!(refused("skew", &file(1e-9)).contains("not symmetric"));
    assert!(refused("short", "0 0 1\n0 1 1\n").contains("expected"));
    assert!(refused("word", "0 zero 1\n").contains("not a number"));
    assert!(refused("ragged", "0 0 1 1 1\n0 1 1 1 1\n1 0 1 1 1\n").contains("rectangular"));
}

#[test]
fn profile_from_a_file() {
    let mut text = String::new();
    for (x, a) in points() {
        let _ = writeln!(text, "{x}; {}; {}", a.to_degrees(), 1e-4 * (x - 0.02).abs() + 1e-5 * a);
    }
    let folder = folder("profile", &text);
    let spec = Table {
        heights: Vec::new(),
        drops: Vec::new(),
        ovality: quantity(0.0),
        file: Some("data.csv".into()),
    };
    let p = spec
        .build(&SkirtProfileCtx { length: 0.05, radius: 0.04, files: &Files::of(&folder) })
        .expect("builds");
    assert!(!p.is_symmetric());
    // At a point, and halfway between two angles: straight lines.
    assert!((p.depth(0.05, 0.3) - (3e-6 + 3e-6)).abs() < 1e-15);
    assert!((p.depth(0.05, 0.15) - (3e-6 + 1.5e-6)).abs() < 1e-15);
    let _ = std::fs::remove_dir_all(&folder);
}

/// The table that a case of the scene `pin` writes for the skirt it designed.
#[test]
fn profile_designed_with_the_pin() {
    let spec = Table {
        heights: Vec::new(),
        drops: Vec::new(),
        ovality: quantity(1e-5),
        file: Some("data.csv".into()),
    };
    let build = |name: &str, text: &str| {
        let folder = folder(name, text);
        let built = spec.build(&SkirtProfileCtx { length: 0.05, radius: 0.04, files: &Files::of(&folder) });
        let _ = std::fs::remove_dir_all(&folder);
        built
    };
    let text = "depth[m],cold_drop[m],warm_drop[m]\n0,8e-5,5e-5\n0.02,1e-5,0\n0.04,2e-5,1e-5\n";
    let p = build("designed", text).expect("builds");
    assert!(p.is_symmetric());
    // At a row the warm drop, all round but for the ovality; the ends count beyond the table.
    assert!((p.depth(0.0, 0.0) - 5e-5).abs() < 1e-18 && p.depth(0.02, 0.0).abs() < 1e-18);
    assert!((p.depth(0.05, std::f64::consts::FRAC_PI_2) - 2e-5).abs() < 1e-18);
    let refused = |name: &str, text: &str| build(name, text).expect_err("refused").to_string();
    assert!(refused("designed-word", "depth[m],warm_drop[m]\n0,x\n").contains("line 2"));
    assert!(refused("designed-empty", "depth[m],warm_drop[m]\n").contains("two heights"));
}
