//! Width of the highest peak of a pressure field.

use gudgeon_scene_piston_secondary::peak_width::half_height;

#[test]
fn width_of_a_tent() {
    // A tent over 9 x 7 nodes, at half its height four intervals wide along and two across.
    let (nx, ny) = (9, 7);
    let p: Vec<f64> = (0..nx * ny)
        .map(|k| {
            let (i, j) = ((k % nx) as f64, (k / nx) as f64);
            (1.0 - (i - 4.0).abs() / 4.0).max(0.0) * (1.0 - (j - 3.0).abs() / 2.0).max(0.0)
        })
        .collect();
    let [along, across] = half_height(&p, nx);
    // Straight lines between nodes: rounding.
    assert!((along - 4.0).abs() < 1e-12 && (across - 2.0).abs() < 1e-12, "{along} {across}");
}
