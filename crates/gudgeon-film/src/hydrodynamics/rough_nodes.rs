//! The gap between rough surfaces at the nodes of a face.

use std::sync::Arc;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness};

/// What the flow and the shear at a node need to know of the gap; without a roughness that of smooth surfaces.
#[derive(Debug)]
pub(super) struct RoughNodes {
    law: Option<Arc<dyn Roughness>>,
    /// Flow factors.
    pub flow: RoughFlow,
    /// Shear factors.
    pub shear: RoughShear,
    /// Change of the film content at a node with the mean gap at the narrowest place.
    pub change: Vec<f64>,
    separations: Vec<f64>,
    one: RoughFlow,
}

/// Newton's steps from far away into the tail of a Gaussian surface: about half the square of the separation in roughness heights.
const STEPS: usize = 200;
/// Part of a mean gap to which its separation is found: that of the rounding of a content.
const FOUND: f64 = 1e-14;

impl RoughNodes {
    pub(super) fn new(law: Option<Arc<dyn Roughness>>, nodes: usize) -> Self {
        let mut flow = RoughFlow::new(nodes);
        flow.phi_x.fill(1.0);
        let mut shear = RoughShear::new(nodes);
        shear.phi_f.fill(1.0);
        shear.phi_fp.fill(1.0);
        let (change, separations) = (vec![1.0; nodes], vec![0.0; nodes]);
        Self { law, flow, shear, change, separations, one: RoughFlow::new(1) }
    }

    /// Sets the gap for a mean gap `h` \[m\], above zero, where the face has no drop.
    pub(super) fn place(&mut self, h: f64, drops: &[f64]) -> Result<(), EvalError> {
        let Some(law) = self.law.clone() else {
            for (i, drop) in drops.iter().enumerate() {
                let gap = h + drop;
                (self.flow.film[i], self.flow.transport[i], self.shear.film[i]) = (gap, gap, gap);
            }
            return Ok(());
        };
        let nearest = self.separation(&*law, h)?;
        let slope = self.one.content_derivative[0].max(f64::MIN_POSITIVE);
        for (s, drop) in self.separations.iter_mut().zip(drops) {
            *s = nearest + drop;
        }
        law.flow(&self.separations, &mut self.flow)?;
        law.shear(&self.separations, &mut self.shear)?;
        for (change, own) in self.change.iter_mut().zip(&self.flow.content_derivative) {
            *change = own / slope;
        }
        Ok(())
    }

    /// Separation of the mean planes at which the film content is `h`. The content is above the separation, convex and rising: Newton's method comes down to it
    /// from there.
    fn separation(&mut self, law: &dyn Roughness, h: f64) -> Result<f64, EvalError> {
        let mut s = h;
        for _ in 0..STEPS {
            law.flow(&[s], &mut self.one)?;
            let (excess, slope) = (self.one.content[0] - h, self.one.content_derivative[0]);
            if excess <= FOUND * h || slope <= 0.0 {
                break;
            }
            s -= excess / slope;
        }
        Ok(s)
    }
}
