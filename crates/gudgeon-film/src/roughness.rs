//! Rough surfaces in a film: what the models share.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{RoughFlow, RoughShear};

pub mod off;

/// Whether separations are finite and every buffer has their number.
fn check(model: &'static str, h: &[f64], lengths: &[usize]) -> Result<(), EvalError> {
    if lengths.iter().any(|&n| n != h.len()) {
        return Err(EvalError::fatal(model, format!("{} separations for buffers of {lengths:?}", h.len())));
    }
    match h.iter().find(|h| !h.is_finite()) {
        Some(h) => Err(EvalError::recoverable(model, format!("the separation {h} m is not finite"))),
        None => Ok(()),
    }
}

fn check_flow(model: &'static str, h: &[f64], out: &RoughFlow) -> Result<(), EvalError> {
    let RoughFlow { film, phi_x, phi_y, transport, content, content_slope } = out;
    check(model, h, &[film, phi_x, phi_y, transport, content, content_slope].map(Vec::len))
}

fn check_shear(model: &'static str, h: &[f64], out: &RoughShear) -> Result<(), EvalError> {
    let RoughShear { film, phi_f, phi_fs, phi_fp } = out;
    check(model, h, &[film, phi_f, phi_fs, phi_fp].map(Vec::len))
}
