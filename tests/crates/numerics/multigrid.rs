//! Five-point matrices and their multigrid solver.

use gudgeon_numerics::linalg::{lu_factor, lu_solve};
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

/// Entries of the matrix, row by row, from its definition: what the sum of all that leaves a node is made of.
fn dense(m: &FivePoint) -> Vec<f64> {
    let n = m.nx * m.ny;
    let mut a = vec![0.0; n * n];
    let mut exchange = |from: usize, to: usize, g: f64| {
        // g (v_from - v_to) leaves one and enters the other; what does not diffuse counts as zero.
        let diffused = |k: usize| m.role[k] == Role::Diffused;
        for (row, other) in [(from, to), (to, from)] {
            a[row * n + row] += if diffused(row) { g } else { 0.0 };
            a[row * n + other] -= if diffused(other) { g } else { 0.0 };
        }
    };
    for j in 0..m.ny {
        for i in 0..m.nx {
            let k = j * m.nx + i;
            if i + 1 < m.nx || m.periodic {
                exchange(k, j * m.nx + (i + 1) % m.nx, m.gx[k]);
            }
            if j + 1 < m.ny {
                exchange(k, k + m.nx, m.gy[k]);
            }
        }
    }
    for j in 0..m.ny {
        for i in 0..m.nx {
            let (k, next) = (j * m.nx + i, j * m.nx + (i + 1) % m.nx);
            if i + 1 < m.nx || m.periodic {
                // -q v leaves the node upstream and enters the one downstream.
                let q = m.qx[k];
                let (up, down) = if q > 0.0 { (k, next) } else { (next, k) };
                if m.role[up] == Role::Carried {
                    a[up * n + up] -= q.abs();
                    a[down * n + up] += q.abs();
                }
            }
            if m.role[k] == Role::Carried {
                a[k * n + k] -= m.hold[k];
            }
        }
    }
    a
}

/// A grid with every kind of node and coefficients that differ from node to node.
fn mixed(nx: usize, ny: usize, periodic: bool) -> FivePoint {
    let mut m = FivePoint::new(nx, ny, periodic);
    for k in 0..nx * ny {
        m.gx[k] = 1.0 + ((3 * k) % 7) as f64;
        // Some nodes have no neighbour above that they exchange with, some none below either.
        m.gy[k] = if nx > 2 && k % 6 == 1 { 0.0 } else { 0.5 + ((5 * k) % 11) as f64 };
        m.qx[k] = if (k / nx).is_multiple_of(2) { 1.5 + (k % 3) as f64 } else { -2.0 - (k % 2) as f64 };
        m.hold[k] = 0.25 + (k % 4) as f64;
        m.role[k] = match k {
            _ if k % 13 == 4 || k + 1 == nx * ny => Role::Fixed,
            _ if k % 5 == 2 => Role::Carried,
            _ => Role::Diffused,
        };
    }
    m
}

#[test]
fn rows_are_the_balances_of_their_nodes() {
    for (nx, ny, periodic) in [(6, 5, false), (6, 5, true), (4, 1, true), (1, 6, false), (3, 2, false)] {
        let m = mixed(nx, ny, periodic);
        let (a, n) = (dense(&m), nx * ny);
        let v: Vec<f64> =
            (0..n).map(|k| if m.role[k] == Role::Fixed { 0.0 } else { ((7 * k) % 5) as f64 - 1.5 }).collect();
        let b: Vec<f64> = (0..n).map(|k| (k % 3) as f64).collect();
        let mut largest = 0.0_f64;
        for k in 0..n {
            let (i, j) = (k % nx, k / nx);
            let row = m.row(i, j);
            let mut sum = row.c * v[k];
            let (west, east) = (m.before(i, k), m.after(i, k));
            sum -=
                if west != k { row.w * v[west] } else { 0.0 } + if east != k { row.e * v[east] } else { 0.0 };
            sum -= if j > 0 { row.s * v[k - nx] } else { 0.0 }
                + if j + 1 < ny { row.n * v[k + nx] } else { 0.0 };
            if m.role[k] == Role::Fixed {
                continue;
            }
            let exact: f64 = (0..n).map(|c| a[k * n + c] * v[c]).sum();
            // Sums of multiples of an eighth: nothing is rounded.
            assert_eq!(sum, exact, "{nx} {ny} {periodic} {k}");
            largest = largest.max((b[k] - exact).abs());
        }
        assert_eq!(m.residual(&b, &v), largest);
    }
}

#[test]
fn solutions_are_those_of_a_dense_solver() {
    for (nx, ny) in [(6, 5), (5, 8), (4, 1), (3, 2), (7, 3), (1, 6), (2, 5)] {
        for periodic in [false, true] {
            for carried in [false, true] {
                let mut m = mixed(nx, ny, periodic);
                for role in &mut m.role {
                    if *role == Role::Carried && !carried {
                        *role = Role::Diffused;
                    }
                }
                // What a carried unknown loses on the spot makes its row a sink like the others.
                let (mut a, n) = (dense(&m), nx * ny);
                let mut x: Vec<f64> = (0..n).map(|k| 1.0 + (k % 4) as f64).collect();
                let b = x.clone();
                for k in (0..n).filter(|k| m.role[*k] == Role::Fixed) {
                    (0..n).for_each(|c| a[k * n + c] = f64::from(u8::from(c == k)));
                    x[k] = 0.0;
                }
                let mut pivots = vec![0; n];
                lu_factor(&mut a, n, &mut pivots).unwrap();
                lu_solve(&a, n, &pivots, &mut x);
                let mut mg = LineMultigrid::new(nx, ny, periodic);
                mg.setup(&m).unwrap();
                let mut v = vec![0.0; n];
                let done = mg.solve(&b, &mut v, 1e-12, 60);
                assert!(done.residual <= 1e-12, "{nx} {ny} {periodic} {carried} {done:?}");
                for (v, x) in v.iter().zip(&x) {
                    // The residual by the norm of the inverse, below ten thousand.
                    assert!((v - x).abs() < 1e-8, "{nx} {ny} {periodic} {carried}: {v} {x}");
                }
            }
        }
    }
}

#[test]
fn cycles_are_counted_and_limited() {
    let m = poisson(40, 40, 1.0, false);
    let mut mg = LineMultigrid::new(40, 40, false);
    mg.setup(&m).unwrap();
    let b = vec![1.0; 1600];
    for limit in [1, 2, 3] {
        let mut v = vec![0.0; 1600];
        let done = mg.solve(&b, &mut v, 0.0, limit);
        assert_eq!(done.cycles, limit);
        assert!(done.rate > 0.0 && done.rate < 0.12, "{done:?}");
    }
    // A factor of ten a cycle and better, from residuals of 1.
    let mut v = vec![0.0; 1600];
    let done = mg.solve(&b, &mut v, 1e-9, 40);
    assert!((4..=12).contains(&done.cycles) && done.residual <= 1e-9, "{done:?}");
    // A solution needs none.
    let done = mg.solve(&b, &mut v, 1e-8, 10);
    assert!(done.cycles == 0 && done.rate == 0.0 && done.residual < 1e-8, "{done:?}");
}

#[test]
#[should_panic(expected = "another grid")]
fn a_matrix_of_another_grid_is_a_mistake() {
    let _ = LineMultigrid::new(4, 5, false).setup(&FivePoint::new(5, 4, false));
}

#[test]
fn cycles_of_both_phases_add_up() {
    // No residual is small enough: cycles alone come to a halt, and directions of the minimisation take the rest.
    let m = poisson(40, 40, 1.0, false);
    let mut mg = LineMultigrid::new(40, 40, false);
    mg.setup(&m).unwrap();
    let mut v = vec![0.0; 1600];
    assert_eq!(mg.solve(&vec![1.0; 1600], &mut v, 0.0, 40).cycles, 40);
    let m = mixed(12, 9, false);
    let mut mg = LineMultigrid::new(12, 9, false);
    mg.setup(&m).unwrap();
    for limit in [1, 2, 3, 12] {
        let mut v = vec![0.0; 108];
        let done = mg.solve(&vec![1.0; 108], &mut v, 0.0, limit);
        assert_eq!(done.cycles, limit);
        // What the minimisation says of the residual is true, to rounding.
        assert!((m.residual(&vec![1.0; 108], &v) - done.residual).abs() < 1e-11, "{done:?}");
    }
}
