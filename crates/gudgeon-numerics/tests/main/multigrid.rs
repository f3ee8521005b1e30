//! Five-point matrices and their multigrid solver.

use gudgeon_numerics::multigrid::{FivePoint, LineMultigrid, Role};

/// A Poisson problem with pressure on all sides and the ratio `a` of diffusion along to across.
fn poisson(nx: usize, ny: usize, a: f64, periodic: bool) -> FivePoint {
    let mut m = FivePoint::new(nx, ny, periodic);
    for j in 0..ny {
        for i in 0..nx {
            let k = j * nx + i;
            let end = !periodic && (i == 0 || i + 1 == nx);
            if end || j == 0 || j + 1 == ny {
                m.role[k] = Role::Fixed;
            }
            m.gx[k] = if periodic || i + 1 < nx { a } else { 0.0 };
            m.gy[k] = if j + 1 < ny { 1.0 } else { 0.0 };
        }
    }
    m
}

#[test]
fn residuals_shrink_at_every_size_and_ratio() {
    for periodic in [false, true] {
        for (nx, ny) in [(3, 3), (5, 64), (33, 33), (64, 64), (129, 129), (200, 31), (16, 4096)] {
            for a in [1e-6, 1e-2, 0.25, 1.0, 4.0, 100.0, 1e6] {
                let m = poisson(nx, ny, a, periodic);
                let mut mg = LineMultigrid::new(nx, ny, periodic);
                mg.setup(&m).unwrap();
                let b: Vec<f64> = (0..nx * ny).map(|k| ((k * 7919) % 1009) as f64 / 1009.0 - 0.3).collect();
                let mut v = vec![0.0; nx * ny];
                let done = mg.solve(&b, &mut v, 1e-6, 40);
                // What it says of the residual is true, but for rounding: entries times solution times 2e-16.
                let floor = 1e-15 * (1.0 + a) * v.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                assert!(m.residual(&b, &v) <= done.residual + floor);
                assert!(done.residual <= 1e-6 + floor, "{periodic} {nx} {ny} {a}: {done:?}");
                // Zebra lines with one sweep before and after the coarse grid: about 0.1.
                assert!(done.residual > 1e-6 || done.rate < 0.12, "{periodic} {nx} {ny} {a}: {done:?}");
            }
        }
    }
}

#[test]
fn jumps_and_fixed_nodes_do_not_harm() {
    let (nx, ny) = (90, 70);
    let mut m = FivePoint::new(nx, ny, false);
    // Conductivity jumps by 1e4 in blocks; a quarter of the inner nodes is fixed in islands.
    let conductivity = |i: usize, j: usize| if (i / 7 + j / 5).is_multiple_of(2) { 1.0 } else { 1e4 };
    for j in 0..ny {
        for i in 0..nx {
            let k = j * nx + i;
            let edge = i == 0 || j == 0 || i + 1 == nx || j + 1 == ny;
            if edge || (i % 12 < 6 && j % 9 < 5) {
                m.role[k] = Role::Fixed;
            }
            m.gx[k] = if i + 1 < nx { 0.5 * (conductivity(i, j) + conductivity(i + 1, j)) } else { 0.0 };
            m.gy[k] = if j + 1 < ny { 0.5 * (conductivity(i, j) + conductivity(i, j + 1)) } else { 0.0 };
        }
    }
    let mut mg = LineMultigrid::new(nx, ny, false);
    mg.setup(&m).unwrap();
    let mut v = vec![0.0; nx * ny];
    let done = mg.solve(&vec![1.0; nx * ny], &mut v, 1e-8, 40);
    // Lumping to five points costs a part of the rate where the coefficients jump along the lines as well.
    assert!(done.residual <= 1e-8 && done.rate < 0.4, "{done:?}");
}

#[test]
fn what_is_carried_arrives() {
    // A ring of three carried nodes between diffused ones, on every line: what the first takes up the last gives back.
    let (nx, ny) = (12, 9);
    let mut m = FivePoint::new(nx, ny, false);
    for k in 0..nx * ny {
        let (i, j) = (k % nx, k / nx);
        m.gx[k] = if i + 1 < nx { 1.0 } else { 0.0 };
        m.gy[k] = if j + 1 < ny { 0.7 } else { 0.0 };
        m.qx[k] = 3.0;
        if i == 0 || j == 0 || i + 1 == nx || j + 1 == ny {
            m.role[k] = Role::Fixed;
        } else if (5..8).contains(&i) && j != 4 {
            m.role[k] = Role::Carried;
        }
    }
    let mut mg = LineMultigrid::new(nx, ny, false);
    mg.setup(&m).unwrap();
    let (b, mut v) = (vec![1.0; nx * ny], vec![0.0; nx * ny]);
    let done = mg.solve(&b, &mut v, 1e-11, 60);
    assert!(done.residual <= 1e-11 && done.rate < 0.3, "{done:?}");
    // Ten products of numbers up to a hundred.
    assert!((m.residual(&b, &v) - done.residual).abs() < 1e-13);
    // All that the sources give leaves over the fixed nodes: nothing is lost on the way.
    let sources = m.role.iter().filter(|r| **r != Role::Fixed).count() as f64;
    let mut left = 0.0;
    for (k, _) in m.role.iter().enumerate().filter(|(_, r)| **r == Role::Fixed) {
        let (i, j) = (k % nx, k / nx);
        let row = m.row(i, j);
        left += if i > 0 { row.w * v[k - 1] } else { 0.0 } + if i + 1 < nx { row.e * v[k + 1] } else { 0.0 };
        left +=
            if j > 0 { row.s * v[k - nx] } else { 0.0 } + if j + 1 < ny { row.n * v[k + nx] } else { 0.0 };
    }
    // A hundred residuals of 1e-11.
    assert!((left - sources).abs() < 1e-9, "{left} {sources}");
}

#[test]
fn a_singular_line_is_an_error() {
    let mut m = FivePoint::new(4, 4, false);
    // Neither tied to anything nor zero.
    m.gx.fill(f64::NAN);
    assert!(LineMultigrid::new(4, 4, false).setup(&m).is_err());
}
