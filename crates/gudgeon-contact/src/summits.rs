//! Summits of a random rough surface: how many there are, how high, and how far above the mean plane.

use gudgeon_core::BuildError;
use serde::{Deserialize, Serialize};

use crate::asperity_integral::f_1;

/// Where the summits of the surface stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SummitHeights {
    /// Those of an isotropic Gaussian field: higher than the surface on average, and less scattered.
    #[default]
    RandomField,
    /// Scattered about the mean plane like the surface itself, as Greenwood and Williamson took them.
    AsSurface,
}

/// Smallest `ηβσ` of an isotropic Gaussian field: its bandwidth parameter is then 3/2, and no field has a smaller one.
const LEAST_PRODUCT: f64 = 0.024_937;

/// Summits of a surface, all lengths in metres.
#[derive(Debug, Clone, Copy)]
pub struct Summits {
    /// Composite roughness σ.
    pub sigma: f64,
    /// Standard deviation of the summits' heights σ_s.
    pub deviation: f64,
    /// Height of their mean over the mean plane of the surface.
    pub height: f64,
    /// Product ηβσ of density and radius of the summits and the roughness.
    pub product: f64,
    /// Radius of the summits β.
    pub radius: f64,
}

impl Summits {
    /// Summits of a surface with the roughness `sigma` \[m\], from `ηβσ` and `σ/β`.
    ///
    /// For an isotropic Gaussian field (mccool1986, after Nayak) both follow from `ηβσ` alone:
    ///
    /// ```text
    /// σ_s² = σ² (1 - 3.717e-4/(ηβσ)²)        height = 0.045944 σ/(ηβσ)
    /// ```
    ///
    /// # Errors
    /// Products that no Gaussian field has, and numbers without a finite scale.
    pub fn new(sigma: f64, product: f64, ratio: f64, heights: SummitHeights) -> Result<Self, BuildError> {
        let (deviation, height) = match heights {
            SummitHeights::AsSurface => (sigma, 0.0),
            SummitHeights::RandomField if product < LEAST_PRODUCT => {
                let what = format!("no isotropic Gaussian surface has eta_beta_sigma = {product}");
                let help = format!(
                    "give {LEAST_PRODUCT} or more (0.03 to 0.07 is usual), or summit_heights = \"as_surface\""
                );
                return Err(BuildError::at("eta_beta_sigma", what).help(help));
            }
            SummitHeights::RandomField => {
                (sigma * (1.0 - 3.717e-4 / (product * product)).sqrt(), 0.045_944 * sigma / product)
            }
        };
        let all = Self { sigma, deviation, height, product, radius: sigma / ratio };
        if [deviation, all.radius, height + sigma, sigma.recip(), all.radius.recip()]
            .iter()
            .all(|v| v.is_finite())
        {
            Ok(all)
        } else {
            let what = format!(
                "roughness {sigma:e} m and sigma_over_beta {ratio:e} give no finite radius of summits"
            );
            Err(BuildError::new(what))
        }
    }

    /// Distance of the smooth surface from the mean of the summits over their deviation, at the separation `h` \[m\] of the mean planes.
    pub fn distance(&self, h: f64) -> f64 {
        (h - self.height) / self.deviation
    }

    /// The separation \[m\] at which that distance is `d`.
    pub fn separation(&self, d: f64) -> f64 {
        self.height + d * self.deviation
    }

    /// Mean gap \[m\] of surfaces with Gaussian heights at the separation `h` \[m\] of their mean planes.
    pub fn mean_gap(&self, h: f64) -> f64 {
        self.sigma * f_1(-h / self.sigma)
    }

    /// Separation \[m\] at which `value`, a pressure over [`Summits::distance`] that falls, is 1e-12 of what it is where the mean planes meet.
    pub fn range(&self, value: impl Fn(f64) -> f64) -> f64 {
        let level = 1e-12 * value(self.distance(0.0));
        let (mut low, mut high) = (self.distance(0.0), FADED);
        // Halved until the interval is a rounding of its ends.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if value(middle) > level { low = middle } else { high = middle }
        }
        self.separation(high)
    }
}

/// A distance at which no pressure of Gaussian summits is left.
pub const FADED: f64 = 10.0;
