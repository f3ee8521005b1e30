//! Sine, exponential and the like as the WebAssembly module has them, for a program of this machine: a library that is loaded before the one of the
//! system (`LD_PRELOAD`). With it a run here gives the results of the module, bit for bit; without it long integrations differ by what their
//! tolerance leaves open.
#![expect(unsafe_code, reason = "exported names; a function that writes through pointers")]

macro_rules! functions {
    ($($name:ident($($x:ident),*);)*) => {$(
        /// As `libm` has it.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name($($x: f64),*) -> f64 {
            libm::$name($($x),*)
        }
    )*}
}
functions! {
    sin(x); cos(x); tan(x); asin(x); acos(x); atan(x); atan2(y, x);
    sinh(x); cosh(x); tanh(x); asinh(x); acosh(x); atanh(x);
    exp(x); exp2(x); expm1(x); log(x); log2(x); log10(x); log1p(x);
    pow(x, y); cbrt(x); hypot(x, y);
}

/// Both at once, as compilers ask for them.
///
/// # Safety
/// The pointers are valid for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sincos(x: f64, sine: *mut f64, cosine: *mut f64) {
    // SAFETY: the caller's pointers are valid.
    unsafe { (*sine, *cosine) = (libm::sin(x), libm::cos(x)) }
}
