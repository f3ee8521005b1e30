use gudgeon_study::sampling::{Design, LatinHypercube, Morris, OneAtATime, Points, Saltelli, Sobol};

fn all(design: &dyn Points) -> Vec<Vec<f64>> {
    (0..design.len()).map(|k| design.point(k)).collect()
}

fn column(points: &[Vec<f64>], d: usize) -> impl Iterator<Item = f64> {
    points.iter().map(move |p| p[d])
}

/// Whether each of `n` equal parts holds exactly one of `n` coordinates.
fn one_in_each_part(u: impl Iterator<Item = f64>, n: usize) -> bool {
    let mut hit = vec![0; n];
    u.for_each(|u| hit[(u * n as f64) as usize] += 1);
    hit.iter().all(|h| *h == 1)
}

#[test]
fn every_part_of_every_dimension_holds_one_point_of_a_latin_hypercube() {
    for n in [1, 2, 7, 1000] {
        let points = all(&LatinHypercube::new(n, 5, 3).unwrap());
        assert!((0..5).all(|d| one_in_each_part(column(&points, d), n)), "{n}");
    }
    // The last part of the largest design stays below 1.
    let large = LatinHypercube::new(1 << 20, 1, 0).unwrap();
    assert!(all(&large).iter().all(|p| 0.0 < p[0] && p[0] < 1.0));
}

#[test]
fn the_sobol_sequence_is_that_of_joe_and_kuo() {
    // Numerators over 2^32 of dimensions 1, 2, 3, 8, 100 and 256, from SciPy 1.16, which takes the same direction numbers.
    let known: [(usize, [u64; 6]); 6] = [
        (1, [1 << 31; 6]),
        (2, [3221225472, 1073741824, 1073741824, 3221225472, 3221225472, 3221225472]),
        (3, [1073741824, 3221225472, 3221225472, 1073741824, 1073741824, 1073741824]),
        (5, [3758096384, 3758096384, 536870912, 1610612736, 1610612736, 3758096384]),
        (777, [2973761536, 4022337536, 700448768, 3275751424, 2193620992, 2730491904]),
        (1024, [6291456, 1616904192, 1923088384, 2522873856, 1537212416, 2904555520]),
    ];
    let sequence = Sobol::plain(2000, 256).unwrap();
    for (k, numerators) in known {
        let u = sequence.point(k);
        let own = [0, 1, 2, 7, 99, 255].map(|d| (u[d] * 2_f64.powi(32)) as u64);
        assert_eq!(own, numerators, "point {k}");
    }
}

#[test]
fn scrambling_keeps_every_dimension_even() {
    let points = all(&Sobol::scrambled(256, 256, 7).unwrap());
    assert!((0..256).all(|d| one_in_each_part(column(&points, d), 256)));
    // Any aligned block of the sequence is as even as the first.
    let later = all(&Sobol::scrambled(512, 4, 7).unwrap()).split_off(256);
    assert!((0..4).all(|d| one_in_each_part(column(&later, d), 256)));
}

#[test]
fn the_first_two_dimensions_are_a_net_of_strength_zero() {
    const M: u32 = 8;
    let points = all(&Sobol::scrambled(1 << M, 2, 11).unwrap());
    for i in 0..=M {
        let (x, y) = (f64::from(1 << i), f64::from(1 << (M - i)));
        let mut hit = vec![0; 1 << M];
        for p in &points {
            hit[(p[0] * x) as usize * (1 << (M - i)) + (p[1] * y) as usize] += 1;
        }
        assert!(hit.iter().all(|h| *h == 1), "elementary intervals of 2^-{i} by 2^-{}", M - i);
    }
}

/// Largest difference between the part of the points in a box at the origin and its area, over all boxes.
fn star_discrepancy(points: &[Vec<f64>]) -> f64 {
    let n = points.len() as f64;
    let ends = |d| column(points, d).chain([1.0]).collect::<Vec<_>>();
    let mut worst = 0.0_f64;
    for x in ends(0) {
        for y in ends(1) {
            let open = points.iter().filter(|p| p[0] < x && p[1] < y).count() as f64;
            let closed = points.iter().filter(|p| p[0] <= x && p[1] <= y).count() as f64;
            worst = worst.max(x * y - open / n).max(closed / n - x * y);
        }
    }
    worst
}

#[test]
fn the_star_discrepancy_keeps_the_bound_of_niederreiter() {
    for m in [3, 5, 7] {
        let n = 1 << m;
        let d = star_discrepancy(&all(&Sobol::scrambled(n, 2, 5).unwrap()));
        // Niederreiter, Monatshefte Math. 104 (1987) 273-337: n D* <= floor(m/2 + 3/2) for a (0,m,2)-net in base 2.
        assert!(d * n as f64 <= f64::from((m + 3) / 2), "{m}: {d}");
    }
}

#[test]
fn scrambling_has_no_bias() {
    // The mean over seeds of one point is 1/2; its deviation is 1/√(12 n). Five of them.
    let n = 4000;
    let u = |seed| Sobol::scrambled(4, 3, seed).unwrap().point(3)[2];
    let mean: f64 = (0..n).map(u).sum::<f64>() / n as f64;
    assert!((mean - 0.5).abs() < 5.0 / (12.0 * n as f64).sqrt(), "{mean}");
}

#[test]
fn one_input_moves_at_a_time() {
    let design = OneAtATime::new(3, 0.1, 0.8).unwrap();
    assert_eq!(design.len(), 7);
    assert_eq!(design.point(0), [0.5, 0.5, 0.5]);
    assert_eq!(design.point(3), [0.5, 0.1, 0.5]);
    assert_eq!(design.point(6), [0.5, 0.5, 0.8]);
}

#[test]
fn trajectories_step_once_in_every_input_within_the_levels() {
    let design = Morris::new(12, 5, 6, 1).unwrap();
    let level = |u: f64| (u * 6.0 - 0.5).round();
    for t in 0..12 {
        let way: Vec<Vec<f64>> = (0..6).map(|s| design.point(t * 6 + s)).collect();
        let moved: Vec<usize> = way
            .windows(2)
            .map(|w| {
                let other: Vec<usize> = (0..5).filter(|d| w[0][*d] != w[1][*d]).collect();
                assert_eq!(other.len(), 1);
                assert_eq!((w[1][other[0]] - w[0][other[0]]).abs(), Morris::STEP);
                other[0]
            })
            .collect();
        assert_eq!(moved, design.order(t));
        // Within the rounding of a sixth.
        assert!(
            way.iter().flatten().all(|u| (u * 6.0 - 0.5 - level(*u)).abs() < 1e-12 && (0.0..1.0).contains(u))
        );
    }
    // Twelve trajectories begin twice at each of six levels.
    for d in 0..5 {
        let mut begins = [0; 6];
        (0..12).for_each(|t| begins[level(design.point(t * 6)[d]) as usize] += 1);
        assert_eq!(begins, [2; 6]);
    }
}

#[test]
fn mixtures_take_one_coordinate_from_the_other_sample() {
    let design = Saltelli::new(8, 3, 2).unwrap();
    assert_eq!(design.len(), 40);
    for row in 0..8 {
        let point = |j| design.point(row * 5 + j);
        let (a, b) = (point(0), point(1));
        for i in 0..3 {
            let mut mixed = a.clone();
            mixed[i] = b[i];
            assert_eq!(point(2 + i), mixed);
            assert_ne!(a[i], b[i]);
        }
    }
}

#[test]
fn points_stay_the_same_for_ever() {
    // Studies that were begun go on with these points: a change here breaks them.
    let first = |design: Design| design.points(2).unwrap().point(3);
    let seed = 42;
    let points = [
        first(Design::LatinHypercube { points: 10, seed }),
        first(Design::Sobol { points: 10, seed }),
        first(Design::Morris { trajectories: 10, levels: 4, seed }),
        first(Design::Saltelli { base: 10, seed }),
    ];
    assert_eq!(points, STORED);
}

const STORED: [[f64; 2]; 4] = [
    [0.723_431_581_922_341_1, 0.639_021_773_624_699_6],
    [0.320_717_840_762_170_14, 0.701_067_843_450_500_1],
    [0.625, 0.375],
    [0.008_045_689_272_697_998, 0.133_212_383_560_878_4],
];

#[test]
fn designs_without_sense_are_refused() {
    let wrong = [
        (Design::LatinHypercube { points: 0, seed: 0 }, 1),
        (Design::LatinHypercube { points: 10, seed: 0 }, 0),
        (Design::Sobol { points: usize::MAX, seed: 0 }, 1),
        (Design::Sobol { points: 10, seed: 0 }, 257),
        (Design::Saltelli { base: 10, seed: 0 }, 129),
        (Design::Saltelli { base: 1 << 20, seed: 0 }, 1),
        (Design::Morris { trajectories: 10, levels: 3, seed: 0 }, 1),
        (Design::OneAtATime { low: 0.5, high: 0.9 }, 1),
        (Design::OneAtATime { low: 0.1, high: f64::NAN }, 1),
    ];
    for (design, dimensions) in wrong {
        assert!(design.points(dimensions).is_err(), "{design:?}");
    }
}

#[test]
fn files_say_a_method_and_its_numbers() {
    let read = |text: &str| serde_json::from_str::<Design>(text);
    let design = read(r#"{"method":"morris","trajectories":10}"#).unwrap();
    assert_eq!(design, Design::Morris { trajectories: 10, levels: 4, seed: 0 });
    assert!(read(r#"{"method":"sobol","points":8,"low":0.1}"#).is_err());
}
