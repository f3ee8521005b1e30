//! Rows of a line, as they are solved inside.

use gudgeon_core::kinds::{Film1dCtx, Film1dIn, FilmEnd, FilmTime};
use gudgeon_film::film_1d::LineSolver;
use gudgeon_film::parts::{Line, Node, Rows};

/// Numbers between 0 and 1 that look like chance.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// What the rows miss, over the largest term of each, and whether states and solution contradict each other.
fn misfit(rows: &Rows, line: &Line) -> f64 {
    let mut worst: f64 = 0.0;
    for i in rows.first..line.n {
        let hold = rows.s[i] + line.c[i];
        let terms = [
            hold * rows.theta[i],
            line.g[i] * (rows.p[i] - rows.p[i + 1]),
            line.g[i - 1] * (rows.p[i] - rows.p[i - 1]),
            -line.c[i - 1] * rows.theta[i - 1],
            -rows.b[i],
        ];
        let size = terms.iter().fold(line.g[i] * rows.p[i], |s, t| s.max(t.abs()));
        let sum: f64 = terms.iter().sum();
        assert!((0.0..=1.0).contains(&rows.theta[i]) && rows.p[i] >= 0.0);
        assert!(rows.p[i] == 0.0 || rows.theta[i] == 1.0, "pressure in a void");
        // Where there is no oil more may arrive at than is there: nothing.
        let off = if rows.state[i] == Node::Dry { (-sum).max(0.0) } else { sum.abs() };
        if off > 0.0 {
            worst = worst.max(off / size);
        }
    }
    worst
}

#[test]
fn newton_and_node_by_node_find_the_same_film_in_any_line() {
    let mut r = Chance(7);
    let (mut films, mut voids, mut dry) = (0, 0, 0);
    for case in 0..3000 {
        let n = 2 + (r.next() * 40.0) as usize;
        let x: Vec<f64> = (0..=n).map(|i| i as f64 + 0.5 * r.next()).collect();
        let h_a: Vec<f64> = (0..n).map(|_| 0.2 + r.next()).collect();
        let h_b: Vec<f64> = (0..n).map(|_| 0.2 + r.next()).collect();
        let mu = vec![1.0; n];
        let content: Vec<f64> = (0..=n).map(|_| 1.2 * r.next()).collect();
        let v: Vec<f64> = (0..n).map(|_| 2.0 * (r.next() - 0.5)).collect();
        let time = match case % 3 {
            0 => FilmTime::Steady,
            1 => FilmTime::Squeeze(&v),
            _ => FilmTime::Step { dt: 10.0_f64.powf(4.0 * (r.next() - 0.5)), content: &content },
        };
        let inp = Film1dIn {
            h_a: &h_a,
            h_b: &h_b,
            mu: &mu,
            factors: None,
            u: if case % 7 == 0 { 0.0 } else { 3.0 * (r.next() - 0.5) },
            ends: [FilmEnd::Flooded { p: (r.next() - 0.3).max(0.0) }, FilmEnd::Flooded { p: r.next() }],
            p_cav: 0.0,
            time,
        };
        let mut line = Line::new("test", &Film1dCtx { x: &x });
        line.enter(&inp, true).expect("a line");
        let mut rows = Rows::new(n + 1);
        rows.solve(&mut line, LineSolver::Direct).expect("a film");
        let newton = rows.p.clone();
        // Rounding, through rows whose terms differ by the cube of the gap.
        let off = misfit(&rows, &line);
        assert!(off < 1e-11, "case {case}: {off:e}");
        for s in &rows.state[1..n] {
            match s {
                Node::Film => films += 1,
                Node::Void => voids += 1,
                Node::Dry => dry += 1,
            }
        }
        rows.node_by_node(&line).expect("states");
        rows.step(&line).expect("a film");
        let off = misfit(&rows, &line);
        assert!(off < 1e-11, "case {case}, node by node: {off:e}");
        let top = newton.iter().copied().fold(0.0, f64::max);
        for (a, b) in rows.p.iter().zip(&newton) {
            assert!((a - b).abs() <= 1e-10 * top, "case {case}: {a} and {b}");
        }
    }
    assert!(films > 1000 && voids > 1000 && dry > 300, "{films} films, {voids} voids, {dry} dry");
}

/// The smooth functions of Fischer and Burmeister find a film in the number of steps that Newton's method needs to go from 1 to 1e-11, however many cavities there
/// are and however many panels their ends have to go; the choice of states moves an end by a panel or two in a pass, and may take a pass for each.
#[test]
fn smooth_functions_need_few_steps_where_the_choice_of_states_needs_many() {
    let mut most_of_choice = 0;
    for n in [50, 200, 800] {
        for waves in [1.0, 5.0, 25.0] {
            let x: Vec<f64> = (0..=n).map(|i| f64::from(i) / f64::from(n)).collect();
            let gap: Vec<f64> =
                x.iter().map(|x| 1.5 + (2.0 * std::f64::consts::PI * waves * x).cos()).collect();
            let (h_a, h_b) = (&gap[..gap.len() - 1], &gap[1..]);
            let mu = vec![1.0; h_a.len()];
            for p in [0.0, 0.1] {
                let ends = [FilmEnd::Flooded { p }; 2];
                let (factors, time) = (None, FilmTime::Steady);
                let inp = Film1dIn { h_a, h_b, mu: &mu, factors, u: 1.0, ends, p_cav: 0.0, time };
                let passes = |solver| {
                    let mut line = Line::new("test", &Film1dCtx { x: &x });
                    line.enter(&inp, true).expect("a line");
                    Rows::new(x.len()).solve(&mut line, solver).expect("a film")
                };
                most_of_choice = most_of_choice.max(passes(LineSolver::Direct));
                // Quadratic convergence, 0.5 to 1e-11, takes six steps; a few more bring the states near, and one pass confirms them.
                let smooth = passes(LineSolver::FischerBurmeister);
                assert!(smooth <= 12, "{smooth} passes with {n} panels, {waves} waves, {p}");
            }
        }
    }
    // There are films among these that tell the two apart.
    assert!(most_of_choice > 24, "{most_of_choice}");
}
