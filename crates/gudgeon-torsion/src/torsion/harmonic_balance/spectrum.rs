//! Between orders and the course over the cycle.

use gudgeon_numerics::fourier::Fourier;
use gudgeon_numerics::linalg::Complex;

/// Angles, rates and accelerations over the cycle of angles by row and order; `omega` is the angular frequency of the first order.
pub(super) fn waves(
    fourier: &mut Fourier,
    angle: &[Complex],
    omega: f64,
    [x, v, a]: &mut [Vec<f64>; 3],
    ([first, second], spare): (&mut [Vec<Complex>; 2], &mut [f64]),
) {
    let (m, orders) = (fourier.points(), first.len());
    for ((own, x), v) in angle.chunks_exact(orders).zip(x.chunks_exact_mut(m)).zip(v.chunks_exact_mut(m)) {
        for (k, (z, x)) in first.iter_mut().zip(own).enumerate() {
            let rate = k as f64 * omega;
            *z = Complex::new(-rate * x.im, rate * x.re);
        }
        fourier.waves(own, first, x, v);
    }
    // Accelerations of two rows at once.
    for (own, a) in angle.chunks(2 * orders).zip(a.chunks_mut(2 * m)) {
        for k in 0..orders {
            let factor = Complex::new(-(k as f64 * omega).powi(2), 0.0);
            first[k] = factor * own[k];
            second[k] = own.get(orders + k).map_or(Complex::default(), |z| factor * *z);
        }
        let (low, high) = a.split_at_mut(m);
        fourier.waves(first, second, low, if high.is_empty() { &mut *spare } else { high });
    }
}

/// Orders of forces by row, two rows at once.
pub(super) fn spectra(fourier: &mut Fourier, force: &[f64], out: &mut [Complex], spare: &mut [Complex]) {
    let (m, orders) = (fourier.points(), spare.len());
    for (f, out) in force.chunks(2 * m).zip(out.chunks_mut(2 * orders)) {
        let (low, high) = out.split_at_mut(orders);
        let (own, other) = f.split_at(m);
        if other.is_empty() {
            fourier.orders(own, own, low, &mut *spare);
        } else {
            fourier.orders(own, other, low, high);
        }
    }
}
