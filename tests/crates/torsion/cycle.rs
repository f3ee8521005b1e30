//! Maxima and minima over the cycle of sums of harmonics.

use std::f64::consts::PI;

use gudgeon_torsion::cycle::Cycle;

/// Maximum and minimum for phasors as pairs.
fn extremes(cycle: &mut Cycle, mean: f64, phasors: &[[f64; 2]]) -> [f64; 2] {
    let [re, im] = [0, 1].map(|part| phasors.iter().map(|z| z[part]).collect::<Vec<f64>>());
    cycle.extremes(mean, [&re, &im])
}

#[test]
fn extremes_are_those_of_a_dense_grid() {
    // Five orders without a pattern: a grid of 2e5 points is right to (5 π/1e5)²/2 ≈ 1e-8 of the amplitude, and never above.
    let orders = [0.5, 1.0, 2.5, 3.0, 5.0];
    let a = [[1.0, 0.3], [-0.4, 2.0], [0.7, -0.9], [1.5, 0.2], [-0.3, 0.8]];
    let found = extremes(&mut Cycle::new(&orders, 4.0 * PI), 0.25, &a);
    let value = |t: f64| {
        0.25 + orders.iter().zip(a).map(|(o, [re, im])| re * (o * t).cos() - im * (o * t).sin()).sum::<f64>()
    };
    let grid = (0..200_000).map(|i| value(4.0 * PI * f64::from(i) / 2e5));
    let [high, low] = grid.fold([f64::NEG_INFINITY, f64::INFINITY], |[a, b], v| [a.max(v), b.min(v)]);
    assert!(found[0] >= high && found[0] - high < 1e-7, "{} {high}", found[0]);
    assert!(found[1] <= low && low - found[1] < 1e-7, "{} {low}", found[1]);
}

#[test]
fn one_wave_is_its_amplitude_wherever_its_crest_stands() {
    for i in 0..50 {
        let (sin, cos) = (0.13 * f64::from(i)).sin_cos();
        let [high, low] = extremes(&mut Cycle::new(&[3.0], 2.0 * PI), -1.0, &[[2.0 * cos, 2.0 * sin]]);
        // Rounding of a sine.
        assert!((high - 1.0).abs() < 1e-14 && (low + 3.0).abs() < 1e-14, "{high} {low}");
    }
}

#[test]
fn sums_of_any_orders_have_the_extremes_of_a_dense_grid() {
    let mut r = crate::elimination::Numbers(9);
    for case in 0..40 {
        // Multiples of one order, with gaps; in every third case an order that is none, of a period that it does not fit.
        let mut orders: Vec<f64> = (1..=12).filter(|_| r.next() < 0.6).map(|k| 0.5 * f64::from(k)).collect();
        orders.push(if case % 3 == 0 { 7.3 } else { 45.0 });
        let period = if case % 3 == 0 { 20.0 * PI } else { 4.0 * PI };
        let a: Vec<[f64; 2]> = orders.iter().map(|_| [r.between(-1.0, 1.0), r.between(-1.0, 1.0)]).collect();
        let mean = r.between(-3.0, 3.0);
        let mut cycle = Cycle::new(&orders, period);
        assert_eq!(cycle.orders(), orders);
        let [high, low] = extremes(&mut cycle, mean, &a);
        let n = 100_000;
        let value = |t: f64| {
            mean + orders
                .iter()
                .zip(&a)
                .map(|(o, [re, im])| re * (o * t).cos() - im * (o * t).sin())
                .sum::<f64>()
        };
        let grid: Vec<f64> = (0..n).map(|i| value(period * f64::from(i) / f64::from(n))).collect();
        let (top, bottom) =
            (grid.iter().copied().fold(f64::MIN, f64::max), grid.iter().copied().fold(f64::MAX, f64::min));
        // Half the square of half a step of the grid, times the sum of amplitudes by squared orders.
        let curve: f64 = orders.iter().zip(&a).map(|(o, a)| o * o * a[0].hypot(a[1])).sum();
        let error = 0.5 * (0.5 * period / f64::from(n)).powi(2) * curve;
        assert!(high >= top - 1e-12 && high <= top + error + 1e-12, "{case}: {high} {top}");
        assert!(low <= bottom + 1e-12 && low >= bottom - error - 1e-12, "{case}: {low} {bottom}");
        // The same again, and a wave of nothing.
        assert_eq!(extremes(&mut cycle, mean, &a), [high, low]);
        assert_eq!(extremes(&mut cycle, mean, &vec![[0.0; 2]; a.len()]), [mean, mean]);
    }
}

#[test]
fn orders_too_many_for_a_table_are_evaluated_as_they_come() {
    // 600 orders of which one is high: more than a million values of cosine and sine.
    let orders: Vec<f64> = (1..600).map(f64::from).chain([400.5]).collect();
    let mut cycle = Cycle::new(&orders, 4.0 * PI);
    let one = |k: usize| {
        if k == 599 {
            [0.6, -0.8]
        } else if k == 0 {
            [1e-3, 0.0]
        } else {
            [0.0; 2]
        }
    };
    let [high, low] = extremes(&mut cycle, 2.0, &(0..600).map(one).collect::<Vec<_>>());
    // Crests of the high order stand within 0.016 of that of the low one, whose cosine has lost 1e-4 of 1e-3 there.
    assert!((high - 3.001).abs() < 2e-7 && (low - 0.999).abs() < 2e-7, "{high} {low}");
}

#[test]
fn coarse_grids_miss_no_top() {
    // Orders that decay, as those of gas torques: looked at on coarser grids than those of waves of one size. Tops of nearly the same
    // height stand close together in some of these sums.
    let mut r = crate::elimination::Numbers(4);
    let orders: Vec<f64> = (1..=24).map(f64::from).collect();
    let mut cycle = Cycle::new(&orders, 2.0 * PI);
    for case in 0..150 {
        let decay = [0.5, 1.0, 1.5, 2.5][case % 4];
        let size = |o: f64| o.powf(-decay) * if case % 3 == 0 && o == 5.0 { 20.0 } else { 1.0 };
        let a: Vec<[f64; 2]> = orders
            .iter()
            .map(|o| [size(*o) * r.between(-1.0, 1.0), size(*o) * r.between(-1.0, 1.0)])
            .collect();
        let [high, low] = extremes(&mut cycle, 0.0, &a);
        let n = 4000;
        let value = |i: i32| {
            let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(n)).sin_cos();
            let (mut sum, mut x, mut y) = (0.0, 1.0, 0.0);
            for [re, im] in &a {
                (x, y) = (x * cos - y * sin, x * sin + y * cos);
                sum += re * x - im * y;
            }
            sum
        };
        let [top, bottom] = (0..n).map(value).fold([f64::MIN, f64::MAX], |[t, b], v| [t.max(v), b.min(v)]);
        // Half the square of half a step of the grid, times the sum of amplitudes by squared orders; rounding of the sums.
        let curve: f64 = orders.iter().zip(&a).map(|(o, a)| o * o * a[0].hypot(a[1])).sum();
        let error = 0.5 * (PI / f64::from(n)).powi(2) * curve;
        assert!(high >= top - 1e-12 && high <= top + error, "{case}: {high} {top}");
        assert!(low <= bottom + 1e-12 && low >= bottom - error, "{case}: {low} {bottom}");
    }
}

#[test]
fn extremes_are_right_to_rounding() {
    // Spectra as those of gas torques behind a resonance. The highest point of a dense grid is followed to its top by bisecting the sign of the derivative, with
    // sines and cosines of every order.
    let mut r = crate::elimination::Numbers(11);
    let orders: Vec<f64> = (1..=24).map(f64::from).collect();
    let mut cycle = Cycle::new(&orders, 2.0 * PI);
    for case in 0..60 {
        let resonant = f64::from(1 + case % 12);
        let size = |o: f64| o.powi(-2) / (1.0 - (o / resonant).powi(2)).hypot(0.05);
        let a: Vec<[f64; 2]> = orders
            .iter()
            .map(|o| [size(*o) * r.between(-1.0, 1.0), size(*o) * r.between(-1.0, 1.0)])
            .collect();
        let sum = |t: f64, sign: f64| {
            let terms = orders.iter().zip(&a).map(|(o, [re, im])| {
                let (sin, cos) = (o * t).sin_cos();
                [sign * (re * cos - im * sin), -sign * o * (re * sin + im * cos)]
            });
            terms.fold([0.0; 2], |[v, s], [x, y]| [v + x, s + y])
        };
        let top = |sign: f64| {
            let n = 3000;
            let step = 2.0 * PI / f64::from(n);
            let highest = (0..n).map(|i| sum(f64::from(i) * step, sign)[0]).fold(f64::MIN, f64::max);
            // All points that a top higher than the highest point can stand beside.
            let curve: f64 = orders.iter().zip(&a).map(|(o, a)| o * o * a[0].hypot(a[1])).sum();
            let near = |i: &i32| sum(f64::from(*i) * step, sign)[0] >= highest - 0.5 * curve * step * step;
            let tops = (0..n).filter(near).map(|i| {
                let (mut low, mut high) = (f64::from(i - 1) * step, f64::from(i + 1) * step);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if sum(middle, sign)[1] > 0.0 { low = middle } else { high = middle }
                }
                sum(low, sign)[0]
            });
            tops.fold(highest, f64::max)
        };
        let [high, low] = extremes(&mut cycle, 0.0, &a);
        let (most, least) = (top(1.0), -top(-1.0));
        // Sums of 24 terms, each rounded; what tops may miss is less.
        let rounding = 1e-13 * (most - least);
        assert!((high - most).abs() <= rounding, "{case}: {high} {most}");
        assert!((low - least).abs() <= rounding, "{case}: {low} {least}");
    }
}
