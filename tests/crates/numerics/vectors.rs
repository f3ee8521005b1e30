//! Loops that are compiled twice.

use gudgeon_numerics::vectors::{Vectorised, all_finite, dots, finite_least, least, widest};

/// Products, quotients and roots of neighbouring numbers, and a running sum.
#[derive(Clone)]
struct Work(Vec<f64>);

impl Vectorised for Work {
    type Output = Vec<f64>;
    #[inline(always)]
    fn run(mut self) -> Vec<f64> {
        let mut sum = 0.0;
        for x in &mut self.0 {
            *x = (*x * 1.7 + 0.3) / (1.0 + *x * *x).sqrt() - *x;
        }
        for x in &self.0 {
            sum += x * 0.1 + 1e-3;
        }
        self.0.push(sum);
        self.0
    }
}

/// Whatever the processor at hand, the bits are those of vectors of two: no order of operations changes and no two roundings become one.
#[test]
fn wider_vectors_give_the_same_bits() {
    let work = Work((0..1003).map(|k| (f64::from(k) * 0.37).sin() * 1e3).collect());
    let (wide, plain) = (widest(work.clone()), work.run());
    assert!(wide.iter().zip(&plain).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!(wide.len(), 1004);
}

/// Numbers of either sign, so many that some stand behind whole groups of lanes.
fn numbers() -> Vec<f64> {
    (0..1003).map(|k| (f64::from(k) * 0.37).sin() * 1e3).collect()
}

#[test]
fn the_least_of_finite_numbers_is_found_and_others_are_told() {
    let all = numbers();
    let lowest = all.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!((least(&all), finite_least(&all), all_finite(&all)), (lowest, Some(lowest), true));
    assert_eq!((least(&[]), finite_least(&[]), all_finite(&[])), (f64::INFINITY, Some(f64::INFINITY), true));
    // In a group, and behind the last one.
    for place in [0, 500, 1002] {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut values = all.clone();
            values[place] = wrong;
            assert_eq!((finite_least(&values), all_finite(&values)), (None, false), "{wrong} at {place}");
        }
    }
}

#[test]
fn inner_products_are_those_of_plain_sums() {
    let a = numbers();
    let (b, c): (Vec<f64>, Vec<f64>) = a.iter().map(|x| (x + 3.0, x * x)).unzip();
    let plain = |b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let size = |b: &[f64]| a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum::<f64>();
    for (got, field) in dots(&a, [&b, &c]).into_iter().zip([&b, &c]) {
        // A thousand roundings of either sum.
        assert!((got - plain(field)).abs() < 1e-13 * size(field), "{got}");
    }
    assert_eq!(dots(&a[..3], [&a[..3]]), [a[..3].iter().map(|x| x * x).sum::<f64>()]);
}
