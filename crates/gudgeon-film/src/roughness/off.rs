use super::checks::{check_flow, check_shear};
use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness, RoughnessSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// Smooth surfaces: the Reynolds equation as it is.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "smooth surfaces",
    equations = "h_p = h_c = h_T = h,  phi_x = phi_y = phi_f = phi_fp = 1,  phi_fs = 0",
    validity = "Films several times thicker than the roughness.",
    references = [],
    example = "",
)]
impl RoughnessSpec for Off {
    fn build(&self) -> Result<Box<dyn Roughness>, BuildError> {
        Ok(Box::new(Smooth))
    }
}

#[derive(Debug)]
struct Smooth;

impl Roughness for Smooth {
    fn is_smooth(&self) -> bool {
        true
    }
    fn flow(&self, h: &[f64], out: &mut RoughFlow) -> Result<(), EvalError> {
        check_flow("roughness off", h, out)?;
        out.film.copy_from_slice(h);
        out.transport.copy_from_slice(h);
        for (i, &h) in h.iter().enumerate() {
            out.content[i] = h.max(0.0);
            out.content_derivative[i] = if h > 0.0 { 1.0 } else { 0.0 };
        }
        out.phi_x.fill(1.0);
        out.phi_y.fill(1.0);
        Ok(())
    }
    fn shear(&self, h: &[f64], out: &mut RoughShear) -> Result<(), EvalError> {
        check_shear("roughness off", h, out)?;
        out.film.copy_from_slice(h);
        out.phi_f.fill(1.0);
        out.phi_fs.fill(0.0);
        out.phi_fp.fill(1.0);
        Ok(())
    }
}
