use gudgeon_core::result::{
    ComparedCase, Comparison, Failure, Note, RunResult, ShareRow, ShareTable, Value, Variant, Verification,
};
use gudgeon_study::shares;

/// Two swaps of two and of three values; `f` gives the results of a case and the numbers of its values.
fn comparison(
    cases: usize,
    f: impl Fn(usize, usize, usize) -> Vec<(&'static str, f64, &'static str)>,
) -> Comparison {
    let swaps: Vec<(String, Vec<String>)> = vec![
        ("models.gas_flow.model".into(), vec!["a".into(), "b".into()]),
        ("models.contact.model".into(), vec!["p".into(), "q".into(), "r".into()]),
    ];
    let mut variants = Vec::new();
    for case in 0..cases {
        for i in 0..2 {
            for j in 0..3 {
                let mut r = RunResult::default();
                for (name, value, unit) in f(case, i, j) {
                    r.results.insert(name.into(), Value { value, unit: unit.into(), what: String::new() });
                }
                let of = |k: usize, l: usize| (swaps[k].0.clone(), swaps[k].1[l].clone());
                variants.push(Variant {
                    label: String::new(),
                    case,
                    swaps: vec![of(0, i), of(1, j)],
                    outcome: Ok(r),
                });
            }
        }
    }
    let case = |k: usize| ComparedCase { name: format!("engine {k}"), title: String::new() };
    Comparison { cases: (0..cases).map(case).collect(), swaps, variants, ..Comparison::default() }
}

fn row<'a>(t: &'a ShareTable, name: &str) -> &'a ShareRow {
    t.rows.iter().find(|r| r.result == name).unwrap()
}

fn share(t: &ShareTable, name: &str, effect: &str) -> f64 {
    let e = (0..t.effects.len()).find(|e| t.effect(*e) == effect).unwrap();
    row(t, name).shares[e].unwrap().share
}

#[test]
fn a_large_engine_counts_as_much_as_a_small_one() {
    // Both change by 10 % of their mean either way, the second is a hundred times as large.
    let size = [1.0, 100.0];
    let c = comparison(2, |case, i, _| {
        vec![("blow_by", size[case] * (1.0 + 0.1 * (2.0 * i as f64 - 1.0)), "l/min")]
    });
    let tables = shares(&c, &[]);
    assert_eq!(tables.len(), 3);
    let all = &tables[0];
    assert_eq!(all.factors, ["case", "gas_flow", "contact"]);
    // Rounding of sums of twelve numbers.
    assert!((share(all, "blow_by", "gas_flow") - 1.0).abs() < 1e-12);
    assert!((row(all, "blow_by").spread - 10.0).abs() < 1e-12);
    // Means 1 and 100, deviations of 10 % within: (99/2)² of (99/2)² + (0.1² + 10²)/2.
    let between = 49.5_f64.powi(2) / (49.5_f64.powi(2) + 0.5 * (0.01 + 100.0));
    assert!((row(all, "blow_by").between_cases.unwrap() - between).abs() < 1e-12);
    assert_eq!(tables[2].case.as_deref(), Some("engine 1"));
    assert!((row(&tables[2], "blow_by").mean.unwrap() - 100.0).abs() < 1e-12);
    assert_eq!(
        all.findings,
        [
            "`gas_flow` explains 100 % of the variance of `blow_by` (spread 10 %).",
            "`contact` takes part in less than 1 % of the variance of any of these results.",
            "The cases answer alike: interactions with the case explain less than 1 % of any of these results.",
        ]
    );
}

#[test]
fn cases_that_answer_in_opposite_ways_interact() {
    let sign = [1.0, -1.0];
    let c = comparison(2, |case, i, _| vec![("fmep", 1.0 + 0.1 * sign[case] * i as f64, "bar")]);
    let t = &shares(&c, &[])[0];
    // Means 1.05 and 0.95 make relative changes of 0.1/1.05 and -0.1/0.95, whose mean is small beside their difference.
    assert!(share(t, "fmep", "case × gas_flow") > 0.99);
    assert!(t.findings.iter().any(|f| f.starts_with("The cases answer differently")), "{:?}", t.findings);
}

#[test]
fn levels_that_a_case_forbids_are_left_out_and_named() {
    let mut c = comparison(2, |_, i, j| vec![("fmep", 1.0 + i as f64 + 0.1 * j as f64, "bar")]);
    // The second case has no `r`, and one of its other runs is not periodic.
    for v in c.variants.iter_mut().filter(|v| v.case == 1 && v.swaps[1].1 == "r") {
        v.outcome = Err(Failure::default());
    }
    let tables = shares(&c, &[]);
    assert_eq!(
        (row(&tables[0], "fmep").left_out.as_slice(), row(&tables[0], "fmep").combinations),
        (&["contact=r".to_owned()][..], 8)
    );
    assert!(row(&tables[1], "fmep").left_out.is_empty());
    if let Ok(r) = &mut c.variants[6].outcome {
        r.solver.notes.push(Note::failure("not_periodic", "the cycle is not periodic"));
    }
    // A block of all three factors would need all of `p` and `q`: of those with two factors, the first case alone is the largest.
    let t = &shares(&c, &[])[0];
    assert_eq!(row(t, "fmep").combinations, 6);
    assert_eq!(row(t, "fmep").left_out, ["case=engine 1"]);
    assert_eq!(t.findings, ["Too many combinations have no result to tell all choices apart in `fmep`."]);
}

#[test]
fn angles_are_shifts_around_the_cycle() {
    let c = comparison(1, |_, i, _| vec![("angle", if i == 0 { 715.0 } else { 5.0 }, "deg")]);
    let t = &shares(&c, &[])[0];
    assert_eq!((row(t, "angle").spread, row(t, "angle").mean), (5.0, Some(720.0)));
    assert_eq!(row(t, "angle").spread_unit, "deg");
}

#[test]
fn the_same_result_in_another_unit_is_told_once() {
    let c = comparison(1, |_, i, j| {
        let v = 1.0 + i as f64 + 0.3 * j as f64;
        vec![("power", v, "W"), ("fmep", 0.17 * v, "bar"), ("ring1.power", 0.5 * v, "W")]
    });
    let t = &shares(&c, &[])[0];
    assert_eq!(row(t, "fmep").same_as.as_deref(), Some("power"));
    assert_eq!(t.headlines().map(|r| r.result.as_str()).collect::<Vec<_>>(), ["power"]);
    assert!(!row(t, "ring1.power").headline);
    let chosen = &shares(&c, &["ring1.power".to_owned()])[0];
    assert_eq!(chosen.headlines().map(|r| r.result.as_str()).collect::<Vec<_>>(), ["ring1.power"]);
}

#[test]
fn differences_below_the_numerics_are_marked() {
    let mut c = comparison(1, |_, i, j| vec![("fmep", 1.0 + 0.1 * i as f64 + 1e-4 * j as f64, "bar")]);
    let marked = |c: &Comparison| -> Vec<bool> {
        let t = &shares(c, &[])[0];
        row(t, "fmep").shares.iter().map(|s| s.unwrap().within_numerics).collect()
    };
    // 1e-4 is a tenth of what is assumed.
    assert_eq!(marked(&c), [false, true, true]);
    for v in &mut c.variants {
        let r = v.outcome.as_mut().unwrap();
        let uncertainty = [("fmep".to_owned(), 1e-6)].into_iter().collect();
        r.verification = Some(Verification { uncertainty, ..Verification::default() });
    }
    assert_eq!(marked(&c), [false, false, true]);
    assert!(shares(&c, &[])[0].verified);
    let still = comparison(1, |_, _, _| vec![("fmep", 1.0, "bar")]);
    assert_eq!(shares(&still, &[])[0].findings, ["No choice changes `fmep` beyond the numerics."]);
}

#[test]
fn a_single_choice_has_nothing_to_share() {
    let mut c = comparison(1, |_, i, _| vec![("fmep", i as f64, "bar")]);
    c.swaps.pop();
    c.variants.retain(|v| v.swaps[1].1 == "p");
    assert!(shares(&c, &[]).is_empty());
}
