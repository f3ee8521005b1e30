//! Differences, repetition, finite answers.

use gudgeon_core::kinds::Oil;
use gudgeon_testkit::{Tolerance, all_finite, assert_none, oil, partials, same_answer};

/// `(x² y, sin x)`.
fn f(x: &[f64], out: &mut [f64]) {
    out[0] = x[0] * x[0] * x[1];
    out[1] = x[0].sin();
}

#[test]
fn partials_are_compared_with_differences() {
    let x = [1.3_f64, -0.4];
    let right = [2.0 * x[0] * x[1], x[0] * x[0], x[0].cos(), 0.0];
    let step = [1e-4, 1e-4];
    assert_none(partials(f, &x, &step, &right, Tolerance::default()));
    for k in 0..right.len() {
        for wrong in [right[k] + 1e-6, f64::NAN, f64::INFINITY, -1.0 - right[k]] {
            let mut given = right;
            given[k] = wrong;
            let complaints = partials(f, &x, &step, &given, Tolerance::default());
            assert_eq!(complaints.len(), 1, "{wrong}: {complaints:?}");
            let place = format!("value {} by input {}:", k / 2, k % 2);
            assert!(complaints[0].starts_with(&place), "{complaints:?}");
        }
    }
    // What the caller admits is admitted, and not twice of it.
    let off = |by: f64| [right[0] * (1.0 + by), right[1], right[2], right[3]];
    let tolerance = Tolerance { relative: 1e-3, ..Tolerance::default() };
    assert_none(partials(f, &x, &step, &off(0.9e-3), tolerance));
    assert_eq!(partials(f, &x, &step, &off(2e-3), tolerance).len(), 1);
    assert_eq!(partials(f, &x, &step[..1], &right, tolerance).len(), 1, "a step is missing");
    assert_eq!(partials(f, &x, &step, &right[..3], tolerance).len(), 1, "a partial is missing");
}

/// A function that is not a number near the place is a complaint, whatever the partial.
#[test]
fn differences_that_are_no_numbers_are_noticed() {
    let root = |x: &[f64], out: &mut [f64]| out[0] = x[0].sqrt();
    assert_eq!(partials(root, &[0.0], &[1e-3], &[1.0], Tolerance::default()).len(), 1);
}

#[test]
fn an_answer_that_depends_on_what_was_asked_before_is_noticed() {
    assert_none(same_answer(f, &[1.0, 2.0], &[3.0, 4.0], 2));
    let mut last = 0.0;
    let forgetful = |x: &[f64], out: &mut [f64]| (out[0], last) = (x[0] + 1e-3 * last, x[0]);
    assert_eq!(same_answer(forgetful, &[1.0], &[2.0], 1).len(), 1);
}

#[test]
fn every_corner_and_middle_is_asked() {
    let mut asked = Vec::new();
    let f = |x: &[f64]| {
        asked.push((x[0], x[1]));
        (x[1] < 3.0).then(|| vec![1.0, 1.0 / x[0]])
    };
    let complaints = all_finite(f, &[[-1.0, 1.0], [2.0, 4.0]]);
    // 1/0 in the middle of the first range; the model refuses 3 and 4 of the second.
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    assert!(complaints[0].contains("value 1 is inf at [0.0, 2.0]"), "{complaints:?}");
    let all: Vec<_> = [2.0, 3.0, 4.0].iter().flat_map(|y| [-1.0, 0.0, 1.0].map(|x| (x, *y))).collect();
    assert_eq!(asked, all);
}

#[derive(Debug)]
struct Line(f64);
impl Oil for Line {
    fn viscosity(&self, temperature: f64) -> f64 {
        1.0 - self.0 * temperature
    }
}

#[test]
fn an_oil_that_becomes_negative_is_noticed() {
    assert_none(oil(&Line(1e-4)));
    // Negative above 1/0.0015 = 667 K: at 1000 and 2000 K.
    assert_eq!(oil(&Line(1.5e-3)).len(), 2);
    assert!(!oil(&Line(f64::NAN)).is_empty());
}
