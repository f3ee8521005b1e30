use gudgeon_study::distribution::Distribution;

fn normal(mean: f64, deviation: f64, from: Option<f64>, to: Option<f64>) -> Distribution {
    Distribution::Normal { mean, deviation, from, to }
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs().max(1e-300)
}

#[test]
fn normal_quantiles_are_those_of_forty_digits() {
    // Root of the distribution function, in arithmetic of 40 digits.
    let known = [
        (1e-300, -37.047_096_299_361_2),
        (1e-20, -9.262_340_089_798_407),
        (1e-5, -4.264_890_793_922_825),
        (0.07, -1.475_791_028_179_170_7),
        (0.075, -1.439_531_470_938_456),
        (0.3, -0.524_400_512_708_040_8),
        (0.9, 1.281_551_565_544_600_6),
    ];
    for (u, z) in known {
        // Wichura promises 1e-16; rounding of sums of eight terms adds some of it.
        assert!(close(normal(0.0, 1.0, None, None).quantile(u), z, 1e-15), "{u}");
    }
    assert_eq!(normal(3.0, 2.0, None, None).quantile(0.5), 3.0);
}

#[test]
fn truncated_normal_quantiles_are_those_of_forty_digits() {
    let known = [
        (normal(1.0, 2.0, Some(3.0), None), 0.3, 3.441_834_484_153_254),
        (normal(1.0, 2.0, Some(-3.0), Some(-1.0)), 0.3, -2.051_731_217_922_055_9),
        (normal(0.0, 1.0, Some(6.0), Some(8.0)), 0.9, 6.363_413_413_274_561),
    ];
    for (d, u, v) in known {
        // Two probabilities and a quantile, each to some 1e-16, and a quantile has its relative error divided by z² in the tail.
        assert!(close(d.quantile(u), v, 2e-15), "{d:?}: {}", d.quantile(u));
    }
}

#[test]
fn other_quantiles_are_closed_forms() {
    let uniform = Distribution::Uniform { from: 2.0, to: 4.0 };
    let log = Distribution::LogUniform { from: 1.0, to: 100.0 };
    let triangular = Distribution::Triangular { from: 0.0, mode: 1.0, to: 4.0 };
    assert_eq!(uniform.quantile(0.25), 2.5);
    // Rounding of a logarithm and an exponential.
    assert!(close(log.quantile(0.5), 10.0, 1e-15));
    // F(1) = 1/4; above, 1 - F = (4 - x)²/12.
    assert!(close(triangular.quantile(0.25), 1.0, 1e-15));
    assert!(close(triangular.quantile(1.0 - 1.0 / 12.0), 3.0, 1e-15));
    assert!(close(triangular.quantile(1.0 / 16.0), 0.5, 1e-15));
}

#[test]
fn nothing_lies_beyond_the_ends() {
    let all = [
        Distribution::Uniform { from: -1.1, to: 3.3 },
        Distribution::LogUniform { from: 0.1, to: 3.3 },
        Distribution::Triangular { from: 0.1, mode: 0.1, to: 3.3 },
        normal(0.0, 1.0, Some(0.1), Some(3.3)),
    ];
    for d in all {
        d.check().unwrap();
        for u in [1e-16, 1e-9, 0.5, 1.0 - 1e-16] {
            assert!((-1.1..=3.3).contains(&d.quantile(u)), "{d:?} {u}");
        }
    }
    assert!(normal(0.0, 1.0, None, None).quantile(f64::MIN_POSITIVE).is_finite());
}

#[test]
fn weights_choose() {
    let d = Distribution::Discrete { values: vec!["a", "b", "c"], weights: vec![1.0, 3.0, 0.0] };
    let at = |u| d.choice(u);
    assert_eq!([at(0.0), at(0.24), at(0.26), at(1.0)], [Some(0), Some(0), Some(1), Some(1)]);
    let equal = Distribution::Discrete { values: vec![1.0, 2.0, 3.0], weights: Vec::new() };
    assert_eq!([0.0, 0.34, 0.99, 1.0].map(|u| equal.quantile(u)), [1.0, 2.0, 3.0, 3.0]);
}

#[test]
fn parameters_that_make_no_distribution_are_refused() {
    let wrong = [
        Distribution::Uniform { from: 1.0, to: 1.0 },
        Distribution::Uniform { from: f64::NAN, to: 1.0 },
        Distribution::Uniform { from: -f64::MAX, to: f64::MAX },
        Distribution::LogUniform { from: 0.0, to: 1.0 },
        Distribution::Triangular { from: 0.0, mode: 2.0, to: 1.0 },
        normal(0.0, 0.0, None, None),
        normal(0.0, 1.0, Some(1.0), Some(1.0)),
        normal(0.0, 1.0, Some(40.0), None),
        Distribution::Discrete { values: Vec::new(), weights: Vec::new() },
        Distribution::Discrete { values: vec![1.0], weights: vec![0.0] },
        Distribution::Discrete { values: vec![1.0], weights: vec![1.0, 1.0] },
    ];
    for d in wrong {
        assert!(d.check().is_err(), "{d:?}");
    }
}

#[test]
fn texts_become_numbers() {
    let text = Distribution::Normal { mean: "5", deviation: "0.5", from: None, to: Some("6") };
    let numbers = text.try_map(|_, v| v.parse::<f64>()).unwrap();
    assert_eq!(numbers, normal(5.0, 0.5, None, Some(6.0)));
    let wrong = Distribution::Uniform { from: "1", to: "x" };
    assert_eq!(wrong.try_map(|key, v| v.parse::<f64>().map_err(|_| key)), Err("to"));
}

#[test]
fn files_say_a_shape_and_its_keys() {
    let read = |text: &str| serde_json::from_str::<Distribution<String>>(text);
    let text = r#"{"shape":"normal","mean":"0.5 mm","deviation":"0.02 mm"}"#;
    let d = read(text).unwrap();
    assert_eq!(serde_json::to_string(&d).unwrap(), text);
    assert!(read(r#"{"shape":"uniform","from":"1","to":"2","mode":"1"}"#).is_err());
    assert!(read(r#"{"shape":"uniform","from":"1"}"#).is_err());
}
