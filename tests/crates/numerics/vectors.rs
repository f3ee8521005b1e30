//! Loops that are compiled twice.

use gudgeon_numerics::vectors::{Vectorised, widest};

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
