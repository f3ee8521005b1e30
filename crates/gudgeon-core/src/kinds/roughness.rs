use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// Configuration of a model of rough surfaces in a film.
#[register_kind(name = "roughness", summary = "flow and shear factors of a film between rough surfaces")]
pub trait RoughnessSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn Roughness>, BuildError>;
}

/// What roughness does to the flow in a film, one value per point. See [`Roughness`] for the equations.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RoughFlow {
    /// Film `h_p` \[m\] that the pressure-flow factors multiply: the separation, held above zero where the model ends.
    pub film: Vec<f64>,
    /// Pressure-flow factor `φ_x` along the sliding direction.
    pub phi_x: Vec<f64>,
    /// Pressure-flow factor `φ_y` across the sliding direction.
    pub phi_y: Vec<f64>,
    /// Film `h_c` \[m\] that the moving liner carries along: `u h_c / 2` is the Couette flow.
    pub transport: Vec<f64>,
    /// Film content `h_T` \[m\]: oil between the surfaces per area, the average gap. Zero or greater.
    pub content: Vec<f64>,
    /// `∂h_T/∂h`, from 0 to 1.
    pub content_derivative: Vec<f64>,
}

impl RoughFlow {
    /// Buffers for `points` points.
    #[must_use]
    pub fn new(points: usize) -> Self {
        let v = || vec![0.0; points];
        Self { film: v(), phi_x: v(), phi_y: v(), transport: v(), content: v(), content_derivative: v() }
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.film.len()
    }

    /// Whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.film.is_empty()
    }
}

/// What roughness does to the shear stress in a film, one value per point. See [`Roughness`] for the equations.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RoughShear {
    /// Film `h_p` \[m\] of the equations, as in [`RoughFlow::film`].
    pub film: Vec<f64>,
    /// `φ_f`, of the sliding speed: the average of `h/h_local`.
    pub phi_f: Vec<f64>,
    /// `φ_fs`, of the sliding speed; adds to the liner's stress what it takes from the body's.
    pub phi_fs: Vec<f64>,
    /// `φ_fp`, of the pressure gradient.
    pub phi_fp: Vec<f64>,
}

impl RoughShear {
    /// Buffers for `points` points.
    #[must_use]
    pub fn new(points: usize) -> Self {
        let v = || vec![0.0; points];
        Self { film: v(), phi_f: v(), phi_fs: v(), phi_fp: v() }
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.film.len()
    }

    /// Whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.film.is_empty()
    }
}

/// A running model of rough surfaces.
///
/// The frame is that of the body (ring or skirt); the liner slides along `+x` at `u`. With the separation `h` of the mean
/// planes, and pressure `p` and flows `q` averaged over the roughness,
///
/// ```text
/// q_x = u h_c/2 - φ_x h_p³ ∂p/∂x / (12 μ)        q_y = - φ_y h_p³ ∂p/∂y / (12 μ)        ∂h_T/∂t + div q = 0
/// liner:  μ u/h_p (φ_f + φ_fs) + φ_fp h_p/2 ∂p/∂x     force per area along -x
/// body:   μ u/h_p (φ_f - φ_fs) - φ_fp h_p/2 ∂p/∂x     force per area along +x
/// ```
///
/// Smooth surfaces: `h_p = h_c = h_T = h`, `φ_x = φ_y = φ_f = φ_fp = 1`, `φ_fs = 0`. Everything is continuous with its
/// derivative in `h` unless the model says otherwise, and finite for every finite `h`, zero and negative ones included.
pub trait Roughness: Debug + Send + Sync {
    /// Whether the surfaces are smooth: a solver need not ask then.
    fn is_smooth(&self) -> bool {
        false
    }

    /// Separation \[m\] below which the film of the flow is held above the separation, because the factors end there; none when it never is.
    fn held_below(&self) -> Option<f64> {
        None
    }

    /// Flow factors for separations `h` \[m\]; all buffers of `out` have the length of `h`.
    ///
    /// # Errors
    /// A separation that is not finite (Recoverable), or buffers of another length (Fatal).
    fn flow(&self, h: &[f64], out: &mut RoughFlow) -> Result<(), EvalError>;

    /// Shear factors for separations `h` \[m\]; all buffers of `out` have the length of `h`.
    ///
    /// # Errors
    /// As [`Roughness::flow`].
    fn shear(&self, h: &[f64], out: &mut RoughShear) -> Result<(), EvalError>;
}
