use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{Length, NonNegative, PosPressure, Ratio, quantity};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::quadrature::GaussLegendre;
use gudgeon_numerics::table::Pchip;
use serde::{Deserialize, Serialize};

/// Plastic contact of a measured surface with a smooth, hard one: where the surface would stand above the plane it flows under its hardness.
///
/// ```text
/// p(h) = H M(h)        A_c/A = M(h)        h_film = ∫_{-∞}^h (1 - M(z)) dz
/// ```
///
/// `M(z)` is the curve of Abbott and Firestone, the share of the surface that is higher than `z`, as a profile meter prints it; between its rows a monotone cubic.
/// The heights count from any datum, up from the body: the mean plane, from which the separation `h` counts, is found from the curve.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("abbott_firestone.json")))]
pub struct AbbottFirestone {
    /// Heights, ascending.
    pub height: Vec<Length>,
    /// Share of the surface above each: from 1 at the lowest to 0 at the highest, never rising.
    pub material_ratio: Vec<Ratio<NonNegative>>,
    /// Hardness H of the surface: about 2 GPa for grey cast iron.
    pub hardness: PosPressure,
    /// Coefficient of friction of the load that the surface carries.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

#[register_model(
    name = "abbott_firestone",
    summary = "measured surface that flows under its hardness where it touches",
    equations = "p = H M(h);  A_c/A = M(h);  h_film = int_-inf^h (1 - M(z)) dz;  M: share of the surface above z",
    validity = "First touch of the peaks of a soft surface by a hard, smooth one: M below about a tenth. Deeper, the pressure stays below the hardness.",
    references = ["abbott1933", "fritsch1980"],
    example = "height = [\"-4 um\", \"-1 um\", \"-0.3 um\", \"0.2 um\", \"0.6 um\", \"1.2 um\"]\nmaterial_ratio = [1, 0.97, 0.80, 0.25, 0.02, 0]\nhardness = \"2 GPa\"\n",
)]
impl ContactSpec for AbbottFirestone {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        self.check()?;
        let heights: Vec<f64> = self.height.iter().map(|h| h.si()).collect();
        let ratios: Vec<f64> = self.material_ratio.iter().map(|m| m.si()).collect();
        let measured = Pchip::new(heights.clone(), ratios.clone())
            .map_err(|e| BuildError::at("height", format!("the curve cannot be used: {e}")))?;
        // Up to here the curve is a cubic between rows, for which two nodes of Gauss are exact.
        let rule = GaussLegendre::new(2);
        let voids = heights.windows(2).map(|w| rule.integrate(w[0], w[1], |z| 1.0 - measured.value(z)));
        let highest = heights[heights.len() - 1];
        let mean = highest - voids.sum::<f64>();
        let heights: Vec<f64> = heights.iter().map(|h| h - mean).collect();
        let curve = Pchip::new(heights.clone(), ratios)
            .map_err(|e| BuildError::at("height", format!("the curve cannot be used: {e}")))?;
        let mut gaps = vec![0.0];
        for w in heights.windows(2) {
            gaps.push(gaps[gaps.len() - 1] + rule.integrate(w[0], w[1], |z| 1.0 - curve.value(z)));
        }
        Ok(Box::new(Surface {
            curve,
            heights,
            gaps,
            rule,
            hardness: self.hardness.si(),
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

impl AbbottFirestone {
    fn check(&self) -> Result<(), BuildError> {
        let (z, m) = (&self.height, &self.material_ratio);
        if z.len() != m.len() {
            let what = format!("{} shares beside {} of `height`", m.len(), z.len());
            return Err(BuildError::at("material_ratio", what));
        }
        if z.len() < 2 {
            return Err(BuildError::at("height", format!("{} rows, at least 2 are needed", z.len())));
        }
        if let Some(i) = z.windows(2).position(|w| w[1].si() <= w[0].si()) {
            let what = format!("{} m does not follow {} m: heights must ascend", z[i + 1].si(), z[i].si());
            return Err(BuildError::at(format!("height.{}", i + 1), what));
        }
        if let Some(i) = m.windows(2).position(|w| w[1].si() > w[0].si()) {
            let what = format!("the share above a height rises to {} with the height", m[i + 1].si());
            return Err(BuildError::at(format!("material_ratio.{}", i + 1), what));
        }
        for (i, wanted, where_) in [(0, 1.0, "lowest"), (m.len() - 1, 0.0, "highest")] {
            if m[i].si() != wanted {
                let what = format!("the share above the {where_} height is {}, not {wanted}", m[i].si());
                let help = "measure from the deepest valley to the highest peak, or add that row";
                return Err(BuildError::at(format!("material_ratio.{i}"), what).help(help));
            }
        }
        Ok(())
    }
}

#[derive(Debug)]
struct Surface {
    /// `M` over the height from the mean plane.
    curve: Pchip,
    heights: Vec<f64>,
    /// Mean gap at each height.
    gaps: Vec<f64>,
    rule: GaussLegendre,
    hardness: f64,
    friction_coefficient: f64,
}

impl Contact for Surface {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        for (p, h) in pressure.iter_mut().zip(separation) {
            *p = self.hardness * self.curve.value(*h);
        }
    }
    /// The highest peak.
    fn range(&self) -> f64 {
        self.heights[self.heights.len() - 1]
    }
    fn mean_gap(&self, separation: f64) -> f64 {
        let k = self.heights.partition_point(|h| *h <= separation);
        match k {
            0 => 0.0,
            k if k == self.heights.len() => separation,
            k => {
                let part =
                    self.rule.integrate(self.heights[k - 1], separation, |z| 1.0 - self.curve.value(z));
                self.gaps[k - 1] + part
            }
        }
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
    fn real_area(&self, separation: &[f64], ratio: &mut [f64]) -> bool {
        for (r, h) in ratio.iter_mut().zip(separation) {
            *r = self.curve.value(*h);
        }
        true
    }
}
