//! The same bytes twice; no NaN.

/// Complaints when `f` answers a question otherwise the second time, after it has answered another: it then remembers what it should not, or depends on
/// something that is not asked.
pub fn same_answer(
    mut f: impl FnMut(&[f64], &mut [f64]),
    question: &[f64],
    other: &[f64],
    values: usize,
) -> Vec<String> {
    let (mut first, mut between, mut second) = (vec![0.0; values], vec![0.0; values], vec![0.0; values]);
    f(question, &mut first);
    f(other, &mut between);
    f(question, &mut second);
    let differ = first.iter().zip(&second).enumerate().filter(|(_, (a, b))| a.to_bits() != b.to_bits());
    differ
        .map(|(i, (a, b))| format!("value {i} is {a:e} at first and {b:e} after another question"))
        .collect()
}

/// Complaints about every corner, middle of an edge, face and body of the box `ranges` (three values an input) at which `f` gives anything but finite
/// numbers. An `f` that refuses (an error of the model) gives `None`, and that is no complaint.
///
/// With n inputs these are 3ⁿ questions; above 8 inputs, take some of them fixed.
pub fn all_finite(mut f: impl FnMut(&[f64]) -> Option<Vec<f64>>, ranges: &[[f64; 2]]) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut x: Vec<f64> = ranges.iter().map(|r| r[0]).collect();
    let mut digit = vec![0u8; ranges.len()];
    loop {
        if let Some(values) = f(&x)
            && let Some(i) = values.iter().position(|v| !v.is_finite())
        {
            wrong.push(format!("value {i} is {} at {x:?}", values[i]));
        }
        // Counts through all combinations.
        let Some(k) = digit.iter().position(|d| *d < 2) else { return wrong };
        for j in 0..k {
            (digit[j], x[j]) = (0, ranges[j][0]);
        }
        digit[k] += 1;
        let [low, high] = ranges[k];
        x[k] = if digit[k] == 1 { 0.5 * low + 0.5 * high } else { high };
    }
}
