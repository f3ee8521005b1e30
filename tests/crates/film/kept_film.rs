//! Films that keep their filling from step to step, against closed forms.

use gudgeon_core::kinds::{
    Edge, Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dSpec, FilmMode, History, Unfilled,
};
use gudgeon_film::film_2d::{Cavitation, Direct, Multigrid, Sor};

/// A channel along the motion, without flow across.
fn channel(n: usize) -> Film2dGrid {
    let mut grid = Film2dGrid::uniform(n + 1, 3, 1.0, 0.5);
    grid.edges = [Edge::Pressure, Edge::Pressure, Edge::Wall, Edge::Wall];
    grid
}

fn direct(grid: &Film2dGrid) -> Box<dyn Film2d> {
    Direct::default().build(&Film2dCtx { grid }).expect("a film")
}

/// Areas of the control volumes.
fn areas(grid: &Film2dGrid) -> Vec<f64> {
    let halves = |x: &[f64]| -> Vec<f64> {
        let last = x.len() - 1;
        (0..=last).map(|i| 0.5 * (x[(i + 1).min(last)] - x[i.saturating_sub(1)])).collect()
    };
    let (wx, wy) = (halves(&grid.x), halves(&grid.y));
    wy.iter().flat_map(|wy| wx.iter().map(move |wx| wx * wy)).collect()
}

#[test]
fn a_film_that_arrives_fills_the_gap_by_twice_its_share() {
    // Steady flow: u delta = u h theta/2. Either way of the motion, and never more than the gap holds.
    let grid = channel(10);
    let area = areas(&grid);
    for (u, arriving, gap) in [(2.0, [0.1, 0.7], 0.5), (-2.0, [0.7, 0.1], 0.5), (2.0, [0.4, 0.0], 0.5)] {
        let mut film = direct(&grid);
        let h = vec![gap; grid.len()];
        let mut content = vec![0.0; grid.len()];
        // Implicit steps of many transits forget the start by a factor each.
        for _ in 0..60 {
            let history = Some(History { dt: 5.0, content: &content });
            let inp = Film2dIn { history, arriving: Some(arriving), ..Film2dIn::new(&h, u, 1.0) };
            let out = film.solve(&inp).expect("a film");
            let held = |c: &[f64]| c.iter().zip(&area).map(|(c, a)| c * a).sum::<f64>();
            let before = held(&content);
            content.iter_mut().zip(film.fill()).for_each(|(c, f)| *c = gap * f);
            // What came in and did not leave is there: to rounding of volumes of the order of one.
            let left = 5.0 * out.outflow.iter().sum::<f64>();
            assert!((held(&content) - before + left).abs() < 1e-13, "{u}: {left}");
        }
        let delta: f64 = if u > 0.0 { arriving[0] } else { arriving[1] };
        let wanted = (2.0 * delta / gap).min(1.0);
        // A hundredth of what is missing at the start is left after each of 60 steps: rounding.
        assert!(film.fill().iter().all(|f| (f - wanted).abs() < 1e-12), "{u} {wanted}: {:?}", film.fill());
    }
}

#[test]
fn nodes_that_are_not_filled_bound_the_film() {
    // Squeezed between nodes a and b at p_cav: p = 6 mu V (x - a)(b - x)/h^3, at the nodes exactly, for second differences of a parabola are.
    let grid = channel(20);
    let (h, mu, v) = (vec![0.3; grid.len()], 0.2, 0.7);
    let (a, b) = (4, 15);
    let nx = grid.x.len();
    let full = |k: usize| (a + 1..b).contains(&(k % nx));
    let engaged: Vec<f64> = (0..grid.len()).map(|k| f64::from(u8::from(full(k)))).collect();
    let fill: Vec<f64> = engaged.iter().map(|e| 0.5 + 0.5 * e).collect();
    let dhdt = vec![-v; grid.len()];
    let mode = FilmMode { u: 0.0, dhdt: &dhdt, edge_pressure: [0.0; 4] };
    let inp = Film2dIn {
        unfilled: Some(Unfilled { engaged: &engaged, fill: &fill }),
        ..Film2dIn::new(&h, 0.0, mu)
    };
    let mut film = direct(&grid);
    let mut p = vec![0.0; grid.len()];
    film.solve_many(&inp, &[mode], &mut p).expect("a film");
    let scale = 6.0 * mu * v / 0.3_f64.powi(3);
    for (k, p) in p.iter().enumerate() {
        let x = grid.x[k % nx];
        let wanted = if full(k) { scale * (x - grid.x[a]) * (grid.x[b] - x) } else { 0.0 };
        // Rounding of an elimination over twenty nodes.
        assert!((p - wanted).abs() < 1e-11 * scale, "{k}: {p} {wanted}");
    }
    // What these pressures leave over at the nodes that carry them is nothing.
    let mut r = vec![0.0; grid.len()];
    assert!(film.imbalance(&inp, &mode, &p, &mut r).expect("flows"));
    let largest = v * 0.05 * 0.25;
    assert!((0..grid.len()).filter(|k| full(*k)).all(|k| r[k].abs() < 1e-11 * largest), "{r:?}");
}

#[test]
fn the_liner_brings_what_is_in_the_gap_to_the_film() {
    // One node carries pressure between two that do not. What reaches it is q times the filling before it, what leaves is q: p = q (theta - 1)/(2 g).
    let grid = channel(4);
    let (h, mu, u) = (0.2, 0.1, 3.0);
    let gap = vec![h; grid.len()];
    let nx = grid.x.len();
    let engaged: Vec<f64> = (0..grid.len()).map(|k| f64::from(u8::from(k % nx == 2))).collect();
    for theta in [0.0, 0.25, 1.0] {
        let fill = vec![theta; grid.len()];
        let fill: Vec<f64> = fill.iter().zip(&engaged).map(|(f, e)| f + (1.0 - f) * e).collect();
        let unfilled = Some(Unfilled { engaged: &engaged, fill: &fill });
        let inp = Film2dIn { unfilled, ..Film2dIn::new(&gap, u, mu) };
        let mode = FilmMode { u, dhdt: &[], edge_pressure: [0.0; 4] };
        let mut p = vec![0.0; grid.len()];
        direct(&grid).solve_many(&inp, &[mode], &mut p).expect("a film");
        // Flow per width and conductance over a spacing of a quarter.
        let (q, g) = (0.5 * u * h, h * h * h / (12.0 * mu) / 0.25);
        let wanted = q * (theta - 1.0) / (2.0 * g);
        assert!((p[2] - wanted).abs() < 1e-13 * q / g, "{theta}: {} {wanted}", p[2]);
    }
}

#[test]
fn a_node_takes_its_part_of_the_pressure() {
    // Alone between nodes without pressure a node that is engaged by s has s times the pressure of a full one.
    let grid = Film2dGrid::uniform(3, 3, 1.0, 0.8);
    let h = vec![0.3; 9];
    let dhdt = vec![-1.0; 9];
    let mode = FilmMode { u: 0.0, dhdt: &dhdt, edge_pressure: [0.0; 4] };
    let centre = |s: f64| {
        let (engaged, fill) = (vec![s; 9], vec![1.0; 9]);
        let unfilled = Some(Unfilled { engaged: &engaged, fill: &fill });
        let mut p = vec![0.0; 9];
        let inp = Film2dIn { unfilled, ..Film2dIn::new(&h, 0.0, 1.0) };
        direct(&grid).solve_many(&inp, &[mode], &mut p).expect("a film");
        p[4]
    };
    let mut full = vec![0.0; 9];
    direct(&grid).solve_many(&Film2dIn::new(&h, 0.0, 1.0), &[mode], &mut full).expect("a film");
    assert!(full[4] > 0.0);
    for s in [0.0, 1e-6, 0.3, 1.0] {
        assert!((centre(s) - s * full[4]).abs() < 1e-14 * full[4], "{s}: {} {}", centre(s), full[4]);
    }
}

#[test]
fn films_say_whether_they_keep_their_filling() {
    let grid = channel(6);
    let ctx = Film2dCtx { grid: &grid };
    let keeps = |spec: &dyn Film2dSpec| spec.build(&ctx).expect("a film").keeps_fill();
    assert!(keeps(&Direct::default()));
    assert!(!keeps(&Direct { cavitation: Cavitation::HalfSommerfeld, ..Direct::default() }));
    assert!(!keeps(&Multigrid::default()));
    assert!(!keeps(&Sor::default()));
}

#[test]
fn bad_fillings_are_refused() {
    let grid = channel(6);
    let h = vec![0.3; grid.len()];
    let (one, short) = (vec![1.0; grid.len()], vec![1.0; 2]);
    let (mut much, mut none) = (one.clone(), one.clone());
    (much[3], none[3]) = (1.5, f64::NAN);
    let mode = FilmMode { u: 1.0, dhdt: &[], edge_pressure: [0.0; 4] };
    let mut p = vec![0.0; grid.len()];
    for bad in [&short, &much, &none] {
        for (engaged, fill) in [(bad, &one), (&one, bad)] {
            let inp = Film2dIn { unfilled: Some(Unfilled { engaged, fill }), ..Film2dIn::new(&h, 1.0, 1.0) };
            assert!(!direct(&grid).solve_many(&inp, &[mode], &mut p).expect_err("refused").is_recoverable());
        }
    }
    for arriving in [[-1.0, 0.0], [0.0, f64::NAN]] {
        let history = Some(History { dt: 1.0, content: &h });
        let inp = Film2dIn { history, arriving: Some(arriving), ..Film2dIn::new(&h, 1.0, 1.0) };
        assert!(!direct(&grid).solve(&inp).expect_err("refused").is_recoverable());
    }
}
