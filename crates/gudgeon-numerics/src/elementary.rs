//! Sine, exponential, power and the other elementary functions of a real number: the same bits on every machine.
//!
//! IEEE 754 fixes the four operations and the square root, not these functions. The methods of `f64` call the mathematics library of the platform, whose
//! results differ in the last bit from one platform (and one processor) to the next. A run integrates over a hundred thousand steps, looks for events
//! and for a periodic state, and decides by comparisons on the way: such a bit moves results by what the tolerances leave open (seen on a diesel ring pack:
//! 2e-4 of its friction, and 16 cycles to its periodic state in place of 27). With these functions a case gives the same bytes on Linux, macOS, Windows and in a
//! browser. They are the port of musl's library in the crate `libm`, errors below 1 ulp (`pow`, `exp`, `log`: about 0.52 ulp); infinities and NaN as
//! IEEE 754 asks. A ring pack spends 4 % of its instructions in them, and no more than with the library of the system.
//!
//! Clippy refuses the methods of `f64` in this workspace (`clippy.toml`), so that none slips in. A model of your own may call them: it works, on every platform
//! with the last bit of that platform.

macro_rules! functions {
    ($($(#[$doc:meta])* $name:ident = $from:ident($($x:ident),*);)*) => {$(
        $(#[$doc])*
        #[inline]
        #[must_use]
        pub fn $name($($x: f64),*) -> f64 {
            libm::$from($($x),*)
        }
    )*}
}

functions! {
    /// sin x, x in rad.
    sin = sin(x);
    /// cos x, x in rad.
    cos = cos(x);
    /// tan x, x in rad.
    tan = tan(x);
    /// arcsin x in rad, -π/2 to π/2; NaN for |x| > 1.
    asin = asin(x);
    /// arccos x in rad, 0 to π; NaN for |x| > 1.
    acos = acos(x);
    /// arctan x in rad, -π/2 to π/2.
    atan = atan(x);
    /// Angle of the point (x, y) in rad, -π to π.
    atan2 = atan2(y, x);
    /// sinh x.
    sinh = sinh(x);
    /// cosh x.
    cosh = cosh(x);
    /// tanh x.
    tanh = tanh(x);
    /// arsinh x.
    asinh = asinh(x);
    /// arcosh x; NaN for x < 1.
    acosh = acosh(x);
    /// artanh x; NaN for |x| > 1.
    atanh = atanh(x);
    /// e^x.
    exp = exp(x);
    /// 2^x.
    exp2 = exp2(x);
    /// e^x - 1, exact for small x as well.
    exp_m1 = expm1(x);
    /// Natural logarithm; NaN for x < 0.
    ln = log(x);
    /// ln(1 + x), exact for small x as well; NaN for x < -1.
    ln_1p = log1p(x);
    /// Logarithm to base 10; NaN for x < 0.
    log10 = log10(x);
    /// Logarithm to base 2; NaN for x < 0.
    log2 = log2(x);
    /// x^y; NaN for x < 0 and y no whole number.
    powf = pow(x, y);
    /// Cube root.
    cbrt = cbrt(x);
    /// √(x² + y²), without overflow on the way.
    hypot = hypot(x, y);
}

/// sin x and cos x, x in rad.
#[inline]
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}
