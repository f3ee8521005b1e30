use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, PosPressure, PosRatio, Ratio, quantity};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::asperity_integral::{asperity_integral, f_1, f_2, f_3_2};
use crate::summits::{SummitHeights, Summits};

/// Mixed lubrication by load sharing: film and solids carry together at one film thickness, and that is the volume of oil over the area, the mean gap of the
/// rough surfaces. The mean planes stand where that volume fits, and there the summits are pressed as by
/// [`GreenwoodWilliamson`](crate::GreenwoodWilliamson).
///
/// ```text
/// h = ∫_-∞^d (d - z) φ(z/σ)/σ dz = σ (D Φ(D) + φ(D))        D = d/σ, solved for d; Φ, φ of the normal distribution
/// p(h) = (4/3) (η β σ) √(σ/β) (σ_s/σ)^(3/2) E' F_(3/2)((d - h_s)/σ_s)        dp/dh = p'(d)/Φ(D)
/// A_c/A = π (η β σ) (σ_s/σ) F_1((d - h_s)/σ_s)
/// ```
///
/// `h` is the film thickness at each place, so a face that curves away takes its oil with it; the other models take the shape of a face for that of the
/// mean planes. Where `h` is large both are the same. At `h = 0` the integral has no finite `d`: below `D = -3` (`h = 3.8e-4 σ`, less than an atom)
/// the pressure goes on along its tangent, and the film thins out exponentially.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("surfaces.json")))]
pub struct LoadSharing {
    /// Composite roughness σ of the two surfaces: `√(σ1² + σ2²)` of their rms roughness.
    pub roughness: PosLength,
    /// Composite modulus E' with `1/E' = Σ (1-ν²)/E`: about 75 GPa for steel on grey cast iron, 115 GPa for steel on steel.
    pub composite_modulus: PosPressure,
    /// The product η β σ of the sum of both surfaces, usually 0.03 to 0.07.
    pub eta_beta_sigma: PosRatio,
    /// The ratio σ/β, usually 1e-4 to 1e-2.
    pub sigma_over_beta: PosRatio,
    /// Where the summits stand over the mean plane.
    #[serde(default)]
    pub summit_heights: SummitHeights,
    /// Coefficient of friction of the load that the asperities carry.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

#[register_model(
    name = "load_sharing",
    summary = "elastic spherical summits where the mean gap of the surfaces is the film thickness",
    equations = "h/sigma = D Phi(D) + phi(D) solved for D = d/sigma;  p = (4/3) (eta beta sigma) sqrt(sigma/beta) (sigma_s/sigma)^(3/2) E' F_3/2((d - h_s)/sigma_s);  dp/dh = p'(d)/Phi(D);  below D = -3 along the tangent",
    validity = "Elastic, isotropic Gaussian roughness, summits that do not touch each other: real area below a tenth. The volume between the surfaces is that of undeformed heights.",
    references = ["johnson1972", "gelinck2000", "greenwood1966", "mccool1986"],
    example = "roughness = \"0.4 um\"\ncomposite_modulus = \"115 GPa\"\neta_beta_sigma = 0.05\nsigma_over_beta = 1e-3\n",
)]
impl ContactSpec for LoadSharing {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        let (product, ratio) = (self.eta_beta_sigma.si(), self.sigma_over_beta.si());
        let summits = Summits::new(self.roughness.si(), product, ratio, self.summit_heights)?;
        let slender = summits.deviation / summits.sigma;
        let scale =
            4.0 / 3.0 * product * ratio.sqrt() * slender * slender.sqrt() * self.composite_modulus.si();
        let planes = Planes::new();
        let joint = summits.sigma * f_1(-DEEPEST);
        let deepest = summits.distance(DEEPEST * summits.sigma);
        // dp/dh = -(3/2) scale F_(1/2) dd/dh, dD/dh = 1/(σ Φ).
        let slope = -1.5 * scale * asperity_integral(0.5, deepest) / (summits.deviation * share(DEEPEST));
        if !(scale > 0.0 && slope.is_finite() && joint.is_normal()) {
            return Err(BuildError::new(format!("the contact pressure has no finite scale: {scale:e} Pa")));
        }
        Ok(Box::new(Sharing {
            range: summits.mean_gap(summits.range(f_3_2)),
            summits,
            planes,
            scale,
            joint,
            slope,
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

/// Distance of the mean planes over σ from which on, downwards, pressure is continued.
const DEEPEST: f64 = -3.0;
/// Distance over σ from which on, upwards, the mean gap is that distance but for 1e-13 of it.
const APART: f64 = 7.0;
/// Rows of the table for each unit of `ln(h/σ)`: a cubic between them is good to 1e-6, and a step of Newton's method squares that.
const PER_UNIT: f64 = 8.0;

/// `Φ(D)`, the share of one surface below the mean plane of the other, by `F_0(λ) = F_2(λ) + λ F_1(λ)` at `λ = -D`.
fn share(d: f64) -> f64 {
    f_2(-d) - d * f_1(-d)
}

/// The distance `D` of the mean planes over the mean gap, both over σ.
#[derive(Debug)]
struct Planes {
    /// `ln` of the gap at the first row.
    from: f64,
    /// `D` and its rise over the length of a row.
    rows: Vec<[f64; 2]>,
}

impl Planes {
    fn new() -> Self {
        let from = elementary::ln(f_1(-DEEPEST));
        let rows = ((elementary::ln(APART) - from) * PER_UNIT).ceil() as usize;
        let mut d = DEEPEST;
        let row = |k: usize| {
            let gap = elementary::exp(from + k as f64 / PER_UNIT);
            // ln F_1(-D) is concave in D: Newton's method from below comes in monotonically, quadratically in the end.
            for _ in 0..40 {
                let next = improved(d, gap);
                if (next - d).abs() <= 1e-15 * d.abs() {
                    break;
                }
                d = next;
            }
            [d, gap / (share(d) * PER_UNIT)]
        };
        Self { from, rows: (0..=rows).map(row).collect() }
    }

    /// `D` at a gap not below that of [`DEEPEST`].
    fn distance(&self, gap: f64) -> f64 {
        let x = (elementary::ln(gap) - self.from) * PER_UNIT;
        let k = x.max(0.0) as usize;
        let Some(&[[y0, s0], [y1, s1]]) = self.rows.get(k..).and_then(<[_]>::first_chunk::<2>) else {
            return gap;
        };
        let t = x - k as f64;
        let rise = y1 - y0;
        let start = y0 + t * (s0 + t * (3.0 * rise - 2.0 * s0 - s1 + t * (s0 + s1 - 2.0 * rise)));
        improved(start, gap)
    }
}

/// One step of Newton's method on `ln F_1(-D) = ln gap`.
fn improved(d: f64, gap: f64) -> f64 {
    let value = f_1(-d);
    d + elementary::ln(gap / value) * value / share(d)
}

#[derive(Debug)]
struct Sharing {
    summits: Summits,
    planes: Planes,
    scale: f64,
    /// Film thickness below which the pressure is continued \[m\].
    joint: f64,
    /// Its derivative there \[Pa/m\].
    slope: f64,
    range: f64,
    friction_coefficient: f64,
}

impl Sharing {
    /// Distance of the smooth surface from the mean of the summits over their deviation, at a film thickness \[m\].
    fn summit_distance(&self, h: f64) -> f64 {
        self.summits.distance(self.mean_planes(h))
    }
}

impl Contact for Sharing {
    fn pressure(&self, film: &[f64], pressure: &mut [f64]) {
        for (p, h) in pressure.iter_mut().zip(film) {
            let deep = (h - self.joint).min(0.0);
            *p = self.scale * f_3_2(self.summit_distance(*h)) + self.slope * deep;
        }
    }
    fn range(&self) -> f64 {
        self.range
    }
    /// The film thickness itself; where the pressure is continued, thinner and thinner and never nothing.
    fn mean_gap(&self, film: f64) -> f64 {
        if film < self.joint { self.joint * elementary::exp(film / self.joint - 1.0) } else { film }
    }
    fn mean_planes(&self, film: f64) -> f64 {
        self.summits.sigma * self.planes.distance(film.max(self.joint) / self.summits.sigma)
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
    /// Never above 1: summits that have grown together are no spheres any more. Where the pressure is continued it stays.
    fn real_area(&self, film: &[f64], ratio: &mut [f64]) -> bool {
        let s = &self.summits;
        let scale = std::f64::consts::PI * s.product * s.deviation / s.sigma;
        for (r, h) in ratio.iter_mut().zip(film) {
            *r = (scale * f_1(self.summit_distance(*h))).min(1.0);
        }
        true
    }
}
