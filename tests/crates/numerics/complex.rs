//! Complex numbers: the laws of a field, and quotients at the ends of the range.

use gudgeon_numerics::linalg::Complex;

const I: Complex = Complex::new(0.0, 1.0);

#[test]
fn arithmetic_is_that_of_pairs_of_real_numbers() {
    let (a, b) = (Complex::new(3.0, -4.0), Complex::new(-2.0, 7.0));
    // Small integers: nothing is rounded.
    assert_eq!(a + b, Complex::new(1.0, 3.0));
    assert_eq!(a - b, Complex::new(5.0, -11.0));
    assert_eq!(-a, Complex::new(-3.0, 4.0));
    assert_eq!(a * b, Complex::new(22.0, 29.0));
    assert_eq!(I * I, Complex::new(-1.0, 0.0));
    assert_eq!((a.abs(), a.norm1()), (5.0, 7.0));
    assert_eq!(Complex::new(1.0, 0.0) / I, -I);
    assert_eq!(a / Complex::new(2.0, 0.0), Complex::new(1.5, -2.0));
}

#[test]
fn quotients_undo_products_at_any_size() {
    // Divisors with the larger part real, imaginary, or neither, of any sign.
    for b in [(3.0, 0.25), (-0.5, 4.0), (1.0, 1.0), (-2.0, -7.0), (0.0, -3.0)] {
        for size in [1.0, 1e300, 1e-300] {
            let (a, b) = (Complex::new(1.25, -0.75), Complex::new(b.0 * size, b.1 * size));
            let back = a * b / b;
            // Three roundings in the product, five in the quotient.
            assert!((back - a).abs() < 8.0 * f64::EPSILON * a.abs(), "{b:?} {back:?}");
        }
    }
}
