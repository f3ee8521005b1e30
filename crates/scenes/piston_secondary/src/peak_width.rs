//! Width of the highest peak of a pressure field.

/// Intervals on which the highest peak of a field over `nx` nodes along stands at half its height: along, across.
#[must_use]
pub fn half_height(p: &[f64], nx: usize) -> [f64; 2] {
    let top = (0..p.len()).fold(0, |m, k| if p[k] > p[m] { k } else { m });
    let (i, j, half) = (top % nx, top / nx, 0.5 * p[top]);
    let along: Vec<f64> = p[j * nx..(j + 1) * nx].to_vec();
    let across: Vec<f64> = p.iter().skip(i).step_by(nx).copied().collect();
    let width = |line: &[f64], at: usize| {
        let reach = |ways: &mut dyn Iterator<Item = usize>| {
            let mut from = line[at];
            let mut steps = 0.0;
            for k in ways {
                if line[k] < half {
                    return steps + (from - half) / (from - line[k]);
                }
                (from, steps) = (line[k], steps + 1.0);
            }
            steps
        };
        reach(&mut (0..at).rev()) + reach(&mut (at + 1..line.len()))
    };
    [width(&along, i), width(&across, j)]
}
