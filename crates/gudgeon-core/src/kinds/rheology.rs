//! What the oil and the surfaces of a film under a ring are beside a constant viscosity between smooth walls.

use std::sync::Arc;

use super::{
    Compressibility, CompressibilitySpec, Piezoviscosity, PiezoviscositySpec, Roughness, RoughnessSpec,
    ShearThinning, ShearThinningSpec,
};
use crate::BuildError;

/// Specifications that a case gives for a film; each may be absent.
#[derive(Debug, Clone, Copy, Default)]
pub struct RheologySpecs<'a> {
    /// Rough surfaces.
    pub roughness: Option<&'a dyn RoughnessSpec>,
    /// Fall of viscosity with the shear rate.
    pub shear_thinning: Option<&'a dyn ShearThinningSpec>,
    /// Rise of viscosity with pressure.
    pub piezoviscosity: Option<&'a dyn PiezoviscositySpec>,
    /// Rise of density with pressure.
    pub compressibility: Option<&'a dyn CompressibilitySpec>,
}

impl RheologySpecs<'_> {
    /// Builds the models; those that are off are left out.
    ///
    /// # Errors
    /// What a model refuses, at the name of its kind.
    pub fn build(&self) -> Result<Rheology, BuildError> {
        let roughness = self.roughness.map(|s| s.build().map_err(|e| e.within("roughness"))).transpose()?;
        let thinning = self.shear_thinning.map(|s| s.build().map_err(|e| e.within("shear_thinning")));
        let piezo = self.piezoviscosity.map(|s| s.build().map_err(|e| e.within("piezoviscosity")));
        let density = self.compressibility.map(|s| s.build().map_err(|e| e.within("compressibility")));
        Ok(Rheology {
            roughness: roughness.filter(|m| !m.is_smooth()).map(Arc::from),
            shear_thinning: thinning.transpose()?.filter(|m| !m.is_off()).map(Arc::from),
            piezoviscosity: piezo.transpose()?.filter(|m| !m.is_off()).map(Arc::from),
            compressibility: density.transpose()?.filter(|m| !m.is_off()).map(Arc::from),
        })
    }
}

/// The running models, which the films of a ring share. What is absent has no effect.
#[derive(Debug, Clone, Default)]
pub struct Rheology {
    /// Rough surfaces, the ring being the body.
    pub roughness: Option<Arc<dyn Roughness>>,
    /// Fall of viscosity with the shear rate.
    pub shear_thinning: Option<Arc<dyn ShearThinning>>,
    /// Rise of viscosity with pressure.
    pub piezoviscosity: Option<Arc<dyn Piezoviscosity>>,
    /// Rise of density with pressure.
    pub compressibility: Option<Arc<dyn Compressibility>>,
}

/// Which parts of a [`Rheology`] a film can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RheologyScope {
    /// Rough surfaces.
    pub roughness: bool,
    /// Shear thinning.
    pub shear_thinning: bool,
    /// Viscosity that rises with pressure.
    pub piezoviscosity: bool,
    /// Density that rises with pressure.
    pub compressibility: bool,
}

impl RheologyScope {
    /// All of it.
    pub const ALL: Self =
        Self { roughness: true, shear_thinning: true, piezoviscosity: true, compressibility: true };
}

impl Rheology {
    /// Whether nothing of it has an effect.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.beyond(RheologyScope::default()).is_none()
    }

    /// The first kind of model in it that is not in `scope`.
    #[must_use]
    pub fn beyond(&self, scope: RheologyScope) -> Option<&'static str> {
        [
            ("roughness", self.roughness.is_some() && !scope.roughness),
            ("shear_thinning", self.shear_thinning.is_some() && !scope.shear_thinning),
            ("piezoviscosity", self.piezoviscosity.is_some() && !scope.piezoviscosity),
            ("compressibility", self.compressibility.is_some() && !scope.compressibility),
        ]
        .into_iter()
        .find_map(|(kind, beyond)| beyond.then_some(kind))
    }
}
