//! Sums of vectors, and the norm of errors.

/// `x += factor Σ_j a_j u_j`, of vectors `u_j` that stand one after the other: four at a time, since `x` is short and each turn of a loop over it
/// costs as much as a product.
pub(crate) fn add_all(x: &mut [f64], factor: f64, a: &[f64], u: &[f64]) {
    let n = x.len();
    if n == 0 {
        return;
    }
    let (fours, rest) = a.as_chunks::<4>();
    let (of_fours, of_rest) = u.split_at(4 * fours.len() * n);
    for (a, u) in fours.iter().zip(of_fours.chunks_exact(4 * n)) {
        let [a0, a1, a2, a3] = a.map(|a| factor * a);
        let ((u0, u1), (u2, u3)) = (halves(&u[..2 * n]), halves(&u[2 * n..]));
        for ((((x, u0), u1), u2), u3) in x.iter_mut().zip(u0).zip(u1).zip(u2).zip(u3) {
            *x += (a0 * u0 + a1 * u1) + (a2 * u2 + a3 * u3);
        }
    }
    for (a, u) in rest.iter().zip(of_rest.chunks_exact(n)) {
        let a = factor * a;
        x.iter_mut().zip(u).for_each(|(x, u)| *x += a * u);
    }
}

fn halves(u: &[f64]) -> (&[f64], &[f64]) {
    u.split_at(u.len() / 2)
}

/// The larger of `a` and `|b|`; a NaN wins.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    let b = b.abs();
    if b > a || b.is_nan() { b } else { a }
}
