use gudgeon_study::anova::{Anova, Blocks, NoAnova, anova, largest_full_block};

/// Results of a function of the levels, in the order of the combinations.
fn table(levels: &[usize], f: impl Fn(&[usize]) -> f64) -> Vec<f64> {
    let count: usize = levels.iter().product();
    (0..count)
        .map(|mut c| {
            let mut at = vec![0; levels.len()];
            for (l, n) in at.iter_mut().zip(levels).rev() {
                (*l, c) = (c % n, c / n);
            }
            f(&at)
        })
        .collect()
}

fn exact(levels: &[usize], y: &[f64]) -> Anova {
    anova(levels, y, &vec![0.0; y.len()]).unwrap()
}

fn share(a: &Anova, factors: &[usize]) -> f64 {
    a.effects.iter().find(|e| e.factors == factors).unwrap().share
}

#[test]
fn a_sum_has_main_effects_alone() {
    // Variances of 0, 1 and of 0, 2, 4: 1/4 and 8/3.
    let y = table(&[2, 3], |l| 100.0 + l[0] as f64 + 2.0 * l[1] as f64);
    let a = exact(&[2, 3], &y);
    // Sums of six small numbers.
    assert!((a.variance - (0.25 + 8.0 / 3.0)).abs() < 1e-14);
    assert!((share(&a, &[0]) - 0.25 / a.variance).abs() < 1e-14);
    assert!((share(&a, &[1]) - 8.0 / 3.0 / a.variance).abs() < 1e-14);
    assert!(share(&a, &[0, 1]) < 1e-30);
    assert_eq!(a.mean, 102.5);
}

#[test]
fn a_product_of_centred_factors_is_all_interaction() {
    let y = table(&[2, 2, 2], |l| l.iter().map(|l| 2.0 * *l as f64 - 1.0).product());
    let a = exact(&[2, 2, 2], &y);
    assert_eq!(share(&a, &[0, 1, 2]), 1.0);
    assert_eq!(a.effects.iter().map(|e| e.share).sum::<f64>(), 1.0);
    assert_eq!(a.total(1), 1.0);
}

#[test]
fn the_classical_table_of_two_factors() {
    // Sums of squares by hand: rows 1, 2, 6 and 3, 4, 2; means 3, 3 of the rows and 2, 3, 4 of the columns; SS of columns 2 (1 + 0 + 1) = 4,
    // total 16, so the interaction has 12.
    let a = exact(&[2, 3], &[1.0, 2.0, 6.0, 3.0, 4.0, 2.0]);
    assert_eq!((share(&a, &[0]), a.mean), (0.0, 3.0));
    // Thirds are rounded.
    assert!((share(&a, &[1]) - 0.25).abs() < 1e-15 && (share(&a, &[0, 1]) - 0.75).abs() < 1e-15);
}

#[test]
fn shares_of_anything_make_one_whatever_the_offset() {
    let levels = [3, 1, 4, 2];
    let y = table(&levels, |l| 1e6 + (l[0] * 7 + l[2] * l[2] * 3 + l[3] * l[0] * l[2]) as f64);
    let a = exact(&levels, &y);
    // Seven effects of three factors; that of one level has none.
    assert_eq!(a.effects.len(), 7);
    assert!(a.effects.iter().all(|e| !e.factors.contains(&1)));
    // Sums of 24 numbers of size 100.
    assert!((a.effects.iter().map(|e| e.share).sum::<f64>() - 1.0).abs() < 1e-14);
    let low = exact(&levels, &y.iter().map(|v| v - 1e6).collect::<Vec<_>>());
    assert_eq!(a.effects, low.effects);
}

#[test]
fn effects_below_the_numerics_are_marked() {
    let y = table(&[2, 2], |l| 10.0 * l[0] as f64 + 0.01 * l[1] as f64);
    // The contrast of two means of two: an effect of 0.005, and results wrong by u can make u of it.
    let marked = |u: f64| {
        anova(&[2, 2], &y, &[u; 4]).unwrap().effects.iter().map(|e| e.within_numerics).collect::<Vec<_>>()
    };
    assert_eq!(marked(0.0051), [false, true, true]);
    // The interaction is zero but for rounding.
    assert_eq!(marked(0.0049), [false, false, true]);
}

#[test]
fn a_result_that_does_not_vary_has_no_shares() {
    let a = exact(&[2, 2], &[0.1; 4]);
    assert_eq!(a.variance, 0.0);
    assert!(a.effects.iter().all(|e| e.share == 0.0 && e.within_numerics));
}

#[test]
fn numbers_that_do_not_fit_are_refused() {
    assert!(matches!(anova(&[2, 2], &[0.0; 3], &[0.0; 3]), Err(NoAnova::Length { .. })));
    assert_eq!(anova(&[2], &[0.0, f64::NAN], &[0.0; 2]), Err(NoAnova::Missing(1)));
    assert_eq!(anova(&[2; 11], &[0.0; 2048], &[0.0; 2048]), Err(NoAnova::Factors(11)));
}

#[test]
fn the_largest_full_block_drops_what_is_missing() {
    let whole = largest_full_block(&[2, 2], &[true; 4]);
    assert_eq!((whole.combinations.len(), whole.left_out), (4, 0));
    // The third level of the second factor is missing for one of three levels of the first: eight of nine there; 2 x 3 and 3 x 2 are equally
    // large, and the first levels stay.
    let mut there = [true; 9];
    there[5] = false;
    let kept = largest_full_block(&[3, 3], &there);
    assert_eq!(kept.combinations.len(), 6);
    assert_eq!(kept.left_out, 2);
    assert_eq!(kept.levels, [vec![0, 1, 2], vec![0, 1]]);
    // Keeping both factors is worth more than keeping more combinations.
    let mut there = [false; 20];
    there[..10].fill(true);
    there[10..12].fill(true);
    assert_eq!(largest_full_block(&[2, 10], &there).levels, [vec![0, 1], vec![0, 1]]);
    // A diagonal leaves no factor.
    let diagonal = largest_full_block(&[2, 2], &[true, false, false, true]);
    assert_eq!(diagonal.levels, [vec![0], vec![0]]);
    let none = largest_full_block(&[2, 2], &[false; 4]);
    assert!(none.combinations.is_empty());
}

#[test]
fn large_tables_drop_levels_one_by_one() {
    // One level of twenty misses all, one of the second factor a half of the rest.
    let levels = [20, 5];
    let there: Vec<bool> = table(&levels, |l| f64::from(l[0] != 7 && (l[1] != 3 || l[0] % 2 == 0)))
        .into_iter()
        .map(|v| v > 0.0)
        .collect();
    let kept = largest_full_block(&levels, &there);
    assert_eq!(kept.levels[1], [0, 1, 2, 4]);
    assert_eq!((kept.levels[0].len(), kept.combinations.len()), (19, 76));
    assert!(kept.combinations.iter().all(|c| there[*c]));
}

#[test]
fn what_a_block_leaves_out_is_named() {
    let mut blocks = Blocks::new(vec![2, 3]);
    let factors = [
        ("model".to_owned(), vec!["a".to_owned(), "b".to_owned()]),
        ("speed".to_owned(), ["1", "2", "3"].map(str::to_owned).to_vec()),
    ];
    let there = vec![true, true, false, true, true, true];
    let kept = blocks.largest(there.clone());
    assert_eq!(kept, largest_full_block(&[2, 3], &there));
    assert_eq!(kept.levels_left_out(&factors), ["speed=3"]);
    // Asked once more, and about another result.
    assert_eq!(blocks.largest(there), kept);
    assert!(blocks.largest(vec![true; 6]).levels_left_out(&factors).is_empty());
}
