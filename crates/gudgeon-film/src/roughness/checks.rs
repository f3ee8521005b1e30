//! What the models check of separations and of the buffers for their answers; the least separation.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{RoughFlow, RoughShear};

use crate::slices::check;

pub(super) fn check_flow(model: &'static str, h: &[f64], out: &RoughFlow) -> Result<f64, EvalError> {
    let RoughFlow { film, phi_x, phi_y, transport, content, content_derivative } = out;
    check(
        model,
        "separation [m]",
        h,
        &[film, phi_x, phi_y, transport, content, content_derivative].map(Vec::len),
    )
}

pub(super) fn check_shear(model: &'static str, h: &[f64], out: &RoughShear) -> Result<f64, EvalError> {
    let RoughShear { film, phi_f, phi_fs, phi_fp } = out;
    check(model, "separation [m]", h, &[film, phi_f, phi_fs, phi_fp].map(Vec::len))
}
