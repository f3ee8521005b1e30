//! Grids over a side.

use gudgeon_core::kinds::Edge;
use gudgeon_skirt::{CROWDING, Panel};

#[test]
fn grid_covers_the_side_and_is_its_own_mirror_image() {
    let panel = Panel { radius: 0.04, length: 0.03, half_angle: 0.6 };
    for (nx, ny, g) in
        [(9, 9, 0.0), (16, 24, 0.3), (7, 8, 0.5), (1000, 6, *CROWDING.end()), (1000, 6, *CROWDING.start())]
    {
        let grid = panel.grid(nx, ny, g);
        assert_eq!((grid.x.len(), grid.y.len()), (nx + 1, ny + 1));
        // Rounding of the ends.
        assert!(grid.x[0].abs() < 1e-17 && (grid.x[nx] - 0.03).abs() < 1e-17);
        assert!((grid.y[ny] - 0.024).abs() < 1e-17);
        assert!((0..=ny).all(|j| grid.y[j] == -grid.y[ny - j]));
        assert!(grid.x.windows(2).chain(grid.y.windows(2)).all(|w| w[1] > w[0]));
        match Panel::half(&grid) {
            Some(half) => assert!(ny % 2 == 0 && half.y[ny / 2] == 0.0 && half.edges[3] == Edge::Wall),
            None => assert!(ny % 2 == 1),
        }
    }
    // Nodes that crowd towards the edges: the first of n intervals is `(1.5 - 1/n) 2/n²` of the height with g = -1/2, all rounded to 1e-16.
    let crowded = panel.grid(16, 8, -0.5);
    assert!((crowded.x[1] / 0.03 - (1.5 - 1.0 / 16.0) * 2.0 / 256.0).abs() < 1e-15);
    // The area of the side by the weights of its grid.
    let (wx, wy) = panel.grid(9, 9, 0.0).weights();
    let area: f64 = wx.iter().sum::<f64>() * wy.iter().sum::<f64>();
    assert!((area / panel.area() - 1.0).abs() < 1e-14);
}

#[test]
fn gap_of_a_skirt_that_stands_towards_the_liner() {
    let panel = Panel { radius: 0.04, length: 0.03, half_angle: 0.6 };
    for (x, angle) in [(0.0, 0.0), (0.03, 0.3), (0.012, -0.6)] {
        // `c - (top (1 - x/L) + bottom x/L) cos`: products and sums of some micrometres.
        let exact = 1e-5 - (3e-6 * (1.0 - x / 0.03) - 2e-6 * x / 0.03) * f64::cos(angle);
        assert!((panel.gap(1e-5, 3e-6, -2e-6, x, angle) - exact).abs() < 1e-20, "{x} {angle}");
    }
}
