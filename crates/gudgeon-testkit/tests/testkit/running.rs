//! Running models that are wrong in one way each.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{
    Contact, CylinderPressure, FaceIn, FaceOut, Hydrodynamics, Kinematics, PinExpansion, PinForces, PinSize,
    PinStrength, PistonMotion,
};
use gudgeon_testkit::{
    Tolerance, assert_none, contact, cylinder_pressure, hydrodynamics, kinematics, pin_strength,
};

fn told(complaints: &[String], what: &str) {
    assert!(complaints.iter().any(|c| c.contains(what)), "{what}: {complaints:?}");
}

/// `(1 - s/r)²` below the range; what is wrong with it by name.
#[derive(Debug)]
struct Square(&'static str);

impl Contact for Square {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        let sign = if self.0 == "negative" { -1.0 } else { 1.0 };
        let among = if self.0 == "among others" { 1e-9 * separation.len() as f64 } else { 0.0 };
        for (p, s) in pressure.iter_mut().zip(separation) {
            let x = (1.0 - s / 1e-6).max(0.0);
            *p = sign * 1e6 * (x * x + among);
            if self.0 == "rises" && *s > 0.5e-6 {
                *p = 2e6 * s / 1e-6;
            }
        }
    }
    fn range(&self) -> f64 {
        if self.0 == "beyond the range" { 0.5e-6 } else { 1e-6 }
    }
    fn mean_gap(&self, separation: f64) -> f64 {
        if self.0 == "mean gap" { 0.5 * separation } else { separation }
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        if self.0 == "coefficient of friction" { -0.1 } else { 0.1 }
    }
}

#[test]
fn contacts() {
    assert_none(contact(&Square("")));
    for wrong in
        ["negative", "among others", "rises", "beyond the range", "mean gap", "coefficient of friction"]
    {
        let what = if wrong == "negative" { "the pressure at" } else { wrong };
        told(&contact(&Square(wrong)), what);
    }
}

/// A sine.
#[derive(Debug, Clone)]
struct Sine(&'static str);

impl Kinematics for Sine {
    fn motion(&self, theta: f64) -> PistonMotion {
        let turn = if self.0 == "a turn after" { 1.1 * theta } else { theta };
        let slip = if self.0 == "velocity" { 1.01 } else { 1.0 };
        let sign = if self.0 == "acceleration" { 1.0 } else { -1.0 };
        PistonMotion {
            y: 0.2 + 0.05 * turn.cos(),
            v: -slip * 10.0 * 0.05 * turn.sin(),
            a: sign * 100.0 * 0.05 * turn.cos(),
            rod_angle: 0.0,
        }
    }
    fn y_tdc(&self) -> f64 {
        if self.0 == "above the top" { 0.24 } else { 0.25 }
    }
    fn stroke(&self) -> f64 {
        if self.0 == "the pin moves" { 0.11 } else { 0.1 }
    }
    fn omega(&self) -> f64 {
        10.0
    }
}

#[test]
fn mechanisms() {
    assert_none(kinematics(&Sine("")));
    for wrong in ["a turn after", "velocity", "acceleration", "above the top", "the pin moves"] {
        told(&kinematics(&Sine(wrong)), wrong);
    }
}

/// A cosine over two turns.
#[derive(Debug, Clone)]
struct Wave(&'static str, Vec<f64>);

impl CylinderPressure for Wave {
    fn pressure(&self, theta: f64) -> f64 {
        let shift = if self.0 == "is -" { -2e5 } else { 2e5 };
        let factor = if self.0 == "a cycle after" { 0.51 } else { 0.5 };
        shift + 1e5 * (factor * theta).cos()
    }
    fn kinks(&self) -> &[f64] {
        &self.1
    }
    fn period(&self) -> f64 {
        4.0 * std::f64::consts::PI
    }
    fn highest(&self) -> (f64, f64) {
        if self.0 == "above the highest" { (1.0, self.pressure(1.0)) } else { (0.0, self.pressure(0.0)) }
    }
}

#[test]
fn pressures() {
    assert_none(cylinder_pressure(&Wave("", vec![1.0, 2.0])));
    for wrong in ["is -", "a cycle after", "above the highest"] {
        told(&cylinder_pressure(&Wave(wrong, Vec::new())), wrong);
    }
    told(&cylinder_pressure(&Wave("", vec![2.0, 1.0])), "the kinks do not ascend");
}

/// A load `1e-9 h^-2 exp(-ḣ)`.
struct Falling(&'static str, u32);

impl Hydrodynamics for Falling {
    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError> {
        self.1 += 1;
        let sign = if self.0 == "the load rises" { 1.0 } else { -1.0 };
        let drift = if self.0 == "at first" { 1.0 + 1e-3 * f64::from(self.1) } else { 1.0 };
        let load = drift * 1e-9 / (inp.h * inp.h) * (sign * hdot).exp();
        let damping = if self.0 == "loads give" { 0.5 * load } else { load };
        Ok(FaceOut {
            load,
            squeeze_damping: damping,
            ring_shear: inp.u,
            liner_shear: inp.u,
            ..FaceOut::default()
        })
    }
    fn squeeze_rate(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError> {
        let miss = if self.0 == "where the film carries" { 1e-3 } else { 0.0 };
        Ok(miss - (load * inp.h * inp.h * 1e9).ln())
    }
    fn profile(&mut self, _: &FaceIn, _: f64, _: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        Ok(())
    }
}

#[test]
fn ring_films() {
    let inp = FaceIn { h: 1e-6, u: 5.0, p_bottom: 1e5, p_top: 1e5, p_cav: 1e5, mu: 0.01 };
    assert_none(hydrodynamics(&mut Falling("", 0), &inp, 0.1));
    for wrong in ["the load rises", "at first", "loads give", "where the film carries"] {
        told(&hydrodynamics(&mut Falling(wrong, 0), &inp, 0.1), wrong);
    }
}

/// Powers of the dimensions with the signs that a pin has.
#[derive(Debug)]
struct Powers(&'static str);

/// Exponents by length, outer and inner diameter; the resultant stands for itself.
const POWERS: [[i32; 3]; 7] =
    [[-1, -1, 0], [-1, -2, 1], [1, -2, 1], [0, -1, 0], [1, -3, 1], [-1, -2, 2], [0, -2, 1]];

impl PinStrength for Powers {
    fn quantities(&self, size: &PinSize, load: &PinForces) -> Result<[f64; 8], EvalError> {
        Ok(self.expansion(size, load)?.value)
    }
    fn expansion(&self, size: &PinSize, _: &PinForces) -> Result<PinExpansion, EvalError> {
        if size.inner >= size.outer && self.0 != "without a wall" {
            return Err(EvalError::recoverable("powers", "no wall"));
        }
        let x = [size.length, size.outer, size.inner];
        let mut e = PinExpansion::default();
        for (q, powers) in POWERS.iter().enumerate() {
            let mut n = *powers;
            if self.0 == "goes the wrong way" && q == 0 {
                n[1] = 1;
            }
            let n = n.map(f64::from);
            let v = x.iter().zip(n).map(|(x, n)| x.powf(n)).product::<f64>();
            let d: [f64; 3] = std::array::from_fn(|i| n[i] * v / x[i]);
            let dd =
                |i: usize, j: usize| if i == j { (n[i] - 1.0) * d[i] / x[i] } else { n[j] * d[i] / x[j] };
            e.value[q] = v;
            e.gradient[q] = d;
            e.hessian[q] = [dd(0, 0), dd(0, 1), dd(0, 2), dd(1, 1), dd(1, 2), dd(2, 2)];
        }
        let (b, o) = (4, 5);
        let r = e.value[b].hypot(e.value[o]);
        e.value[7] = if self.0 == "the resultant stress" { 1.1 * r } else { r };
        let g = |i: usize| (e.value[b] * e.gradient[b][i] + e.value[o] * e.gradient[o][i]) / r;
        let gradient = [g(0), g(1), g(2)];
        let pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
        for (k, (i, j)) in pairs.into_iter().enumerate() {
            let parts = [b, o].map(|q| e.gradient[q][i] * e.gradient[q][j] + e.value[q] * e.hessian[q][k]);
            e.hessian[7][k] = (parts[0] + parts[1] - gradient[i] * gradient[j]) / r;
        }
        e.gradient[7] = gradient;
        if self.0 == "the partial is" {
            e.gradient[2][1] *= 1.001;
        }
        Ok(e)
    }
}

#[test]
fn pins() {
    let (size, load) =
        (PinSize { length: 0.09, outer: 0.042, inner: 0.024 }, PinForces { gas: 1e5, inertia: 0.0 });
    // Powers of numbers far from one are rounded in their exponents.
    let tolerance = Tolerance { rounding: 64.0 * f64::EPSILON, ..Tolerance::default() };
    assert_none(pin_strength(&Powers(""), &size, &load, tolerance));
    for wrong in ["without a wall", "goes the wrong way", "the resultant stress", "the partial is"] {
        told(&pin_strength(&Powers(wrong), &size, &load, tolerance), wrong);
    }
}
