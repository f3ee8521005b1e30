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
        super::check_flow("roughness off", h, out)?;
        out.film.copy_from_slice(h);
        out.transport.copy_from_slice(h);
        for (i, &h) in h.iter().enumerate() {
            out.content[i] = h.max(0.0);
            out.content_slope[i] = if h > 0.0 { 1.0 } else { 0.0 };
        }
        out.phi_x.fill(1.0);
        out.phi_y.fill(1.0);
        Ok(())
    }
    fn shear(&self, h: &[f64], out: &mut RoughShear) -> Result<(), EvalError> {
        super::check_shear("roughness off", h, out)?;
        out.film.copy_from_slice(h);
        out.phi_f.fill(1.0);
        out.phi_fs.fill(0.0);
        out.phi_fp.fill(1.0);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_film_is_what_it_was() {
        let model = Off {}.build().expect("builds");
        let h = [2e-6, 0.0, -1e-7];
        let (mut flow, mut shear) = (RoughFlow::new(3), RoughShear::new(3));
        model.flow(&h, &mut flow).expect("finite");
        model.shear(&h, &mut shear).expect("finite");
        assert_eq!((&flow.film[..], &flow.transport[..]), (&h[..], &h[..]));
        assert_eq!(
            (&flow.content[..], &flow.content_slope[..]),
            (&[2e-6, 0.0, 0.0][..], &[1.0, 0.0, 0.0][..])
        );
        assert_eq!((flow.phi_x, flow.phi_y), (vec![1.0; 3], vec![1.0; 3]));
        assert_eq!((shear.phi_f, shear.phi_fs, shear.phi_fp), (vec![1.0; 3], vec![0.0; 3], vec![1.0; 3]));
    }

    #[test]
    fn bad_input_is_an_error() {
        let model = Off {}.build().expect("builds");
        assert!(model.flow(&[f64::NAN], &mut RoughFlow::new(1)).is_err_and(|e| e.is_recoverable()));
        assert!(model.shear(&[f64::INFINITY], &mut RoughShear::new(1)).is_err_and(|e| e.is_recoverable()));
        assert!(model.flow(&[1e-6], &mut RoughFlow::new(2)).is_err_and(|e| !e.is_recoverable()));
        assert!(model.shear(&[1e-6], &mut RoughShear::new(0)).is_err_and(|e| !e.is_recoverable()));
    }
}
