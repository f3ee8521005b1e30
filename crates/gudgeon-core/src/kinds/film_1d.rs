use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// What a [`Film1dSpec`] is built for: the places where the film is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Film1dCtx<'a> {
    /// Nodes \[m\], rising, at least two. Panel `i` lies between nodes `i` and `i + 1`; steps of the profile stand on nodes.
    pub x: &'a [f64],
}

impl Film1dCtx<'_> {
    /// Whether the nodes make a line.
    ///
    /// # Errors
    /// Fewer than two nodes, or nodes that are not finite and rising.
    pub fn check(&self) -> Result<(), BuildError> {
        if self.x.len() < 2 {
            return Err(BuildError::at("x", format!("a line needs two or more nodes, not {}", self.x.len())));
        }
        if self.x.iter().any(|x| !x.is_finite()) {
            return Err(BuildError::at("x", "the nodes of a line must be finite"));
        }
        match self.x.windows(2).position(|w| w[1] <= w[0]) {
            Some(i) => Err(BuildError::at(
                "x",
                format!(
                    "nodes must rise, but node {} is at {} m and node {} at {} m",
                    i,
                    self.x[i],
                    i + 1,
                    self.x[i + 1]
                ),
            )),
            None => Ok(()),
        }
    }
}

/// What a film along a line can be asked for besides steady motion between two baths of oil.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Film1dScope {
    /// [`FilmEnd::Starved`] where the moving surface enters the gap.
    pub starved: bool,
    /// [`FilmTime::Squeeze`].
    pub squeeze: bool,
    /// [`FilmTime::Step`].
    pub steps: bool,
}

/// Configuration of a one-dimensional film.
#[register_kind(name = "film_1d", summary = "oil film along a line, of any profile, steady or in time")]
pub trait Film1dSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model of one line.
    ///
    /// # Errors
    /// Nodes that make no line, or constants outside their range.
    fn build(&self, ctx: &Film1dCtx<'_>) -> Result<Box<dyn Film1d>, BuildError>;

    /// What the model can be asked for; the rest it refuses whenever it is asked, so a bench refuses it before.
    fn scope(&self) -> Film1dScope {
        Film1dScope { starved: true, squeeze: true, steps: true }
    }

    /// Models of this kind that solve, where they have the settings of this one, the same equations by another method: the first one gives
    /// `bench` its reference.
    fn same_equations(&self) -> &'static [&'static str] {
        &[]
    }
}

/// What there is at one end of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FilmEnd {
    /// A bath of oil at this absolute pressure \[Pa\].
    Flooded {
        /// Absolute pressure \[Pa\].
        p: f64,
    },
    /// Gas at this absolute pressure, and a layer of oil that arrives on the moving surface, when that moves into the gap
    /// here: the flux `|u| h_oil`, of which the film takes no more than a bath would give it. Where the gap is not yet
    /// filled, the gas has its pressure. When the surface leaves here, the end counts as flooded.
    Starved {
        /// Absolute pressure of the gas \[Pa\].
        p: f64,
        /// Thickness of the arriving layer \[m\], zero or more.
        h_oil: f64,
    },
}

impl FilmEnd {
    /// Absolute pressure \[Pa\].
    #[must_use]
    pub const fn pressure(self) -> f64 {
        match self {
            Self::Flooded { p } | Self::Starved { p, .. } => p,
        }
    }
}

/// How a film depends on time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FilmTime<'a> {
    /// Nothing changes.
    Steady,
    /// The gap changes at these rates `∂h/∂t` \[m/s\], one for each panel, and the film has adjusted to that: a cavity keeps the
    /// volume of its void, unless it runs dry.
    Squeeze(&'a [f64]),
    /// One implicit Euler step: the gap is that at the end of the step.
    Step {
        /// Length of the step \[s\], positive.
        dt: f64,
        /// Oil \[m²\] in the control volume of each node at the start of the step: [`FilmField::content`] of the last one.
        content: &'a [f64],
    },
}

/// How the roughness of the surfaces changes the flow through a panel and the shear in it; for smooth surfaces all 1 but for the
/// difference, which is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PanelFactors {
    /// φ_p: on the flow that pressure drives. Positive.
    pub pressure_flow: f64,
    /// On the flow that sliding drives: effective transporting film over the gap, `(h_T + σ φ_s)/h`. Zero or more.
    pub sliding_flow: f64,
    /// On the shear `μ u/h`.
    pub sliding_shear: f64,
    /// On the shear `h/2 ∂p/∂x`.
    pub pressure_shear: f64,
    /// Part of the shear `μ u/h` that the moving surface has more, and the stationary one less.
    pub shear_difference: f64,
}

impl PanelFactors {
    /// Smooth surfaces.
    pub const SMOOTH: Self = Self {
        pressure_flow: 1.0,
        sliding_flow: 1.0,
        sliding_shear: 1.0,
        pressure_shear: 1.0,
        shear_difference: 0.0,
    };
}

/// One film at an instant, in the frame of the stationary surface, which has the profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film1dIn<'a> {
    /// Film thickness \[m\] at the beginning of each panel, positive. Linear from there to its end.
    pub h_a: &'a [f64],
    /// Film thickness \[m\] at the end of each panel, positive. A difference to `h_a` of the next panel is a step.
    pub h_b: &'a [f64],
    /// Dynamic viscosity \[Pa s\] in each panel, positive.
    pub mu: &'a [f64],
    /// Roughness in each panel; `None` for smooth surfaces.
    pub factors: Option<&'a [PanelFactors]>,
    /// Velocity of the moving, plane surface along `+x` \[m/s\].
    pub u: f64,
    /// What there is at the first node and at the last.
    pub ends: [FilmEnd; 2],
    /// Absolute pressure \[Pa\] below which the film cavitates. End pressures below it count as this one.
    pub p_cav: f64,
    /// Steady or not.
    pub time: FilmTime<'a>,
}

/// What a film does, per metre of width.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Film1dOut {
    /// `∫ (p - p_cav) dx` \[N/m\].
    pub load: f64,
    /// `∫ (p - p_cav) x dx` \[N\]: centre of pressure times load.
    pub moment: f64,
    /// Viscous force on the moving surface along `-x`, `∫ (μu/h + h p'/2) dx` \[N/m\].
    pub moving_shear: f64,
    /// Viscous force on the stationary surface along `+x`, `∫ (μu/h - h p'/2) dx` \[N/m\].
    pub fixed_shear: f64,
    /// Pressure force on the slopes and steps of the stationary surface along `+x`, `-∫ (p - p_cav) dh` \[N/m\].
    pub slope_force: f64,
    /// Flux of oil \[m²/s\] along `+x` into the line at its first node.
    pub flux_in: f64,
    /// Flux of oil \[m²/s\] along `+x` out of the line at its last node.
    pub flux_out: f64,
    /// Highest absolute pressure \[Pa\] and
    pub p_max: f64,
    /// where it is \[m\].
    pub x_p_max: f64,
    /// The inlet is not filled: less oil arrives than a bath would give.
    pub starved: bool,
    /// Largest imbalance of flux at a node, from the pressures and fills of the nodes, over the largest of what sliding drives
    /// through the panels beside it, what their pressures would drive against none, and what the node stores.
    pub flux_error: f64,
    /// Passes over the line that the solution took.
    pub iterations: usize,
}

impl Film1dOut {
    /// Centre of pressure \[m\], when there is a load.
    #[must_use]
    pub fn centre(&self) -> Option<f64> {
        (self.load > 0.0).then(|| self.moment / self.load)
    }
}

/// An end of a film inside the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmFront {
    /// Where \[m\].
    pub x: f64,
    /// The full film lies at smaller `x`, and a cavity (or the starved inlet) behind.
    pub film_before: bool,
}

/// The film found last, at nodes and panels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmField<'a> {
    /// Absolute pressure \[Pa\] at the nodes.
    pub p: &'a [f64],
    /// Fraction of the gap that is filled with oil, at the nodes.
    pub fill: &'a [f64],
    /// Oil \[m²\] in the control volume of each node: half of each panel beside it.
    pub content: &'a [f64],
    /// Flux \[m²/s\] along `+x` through each panel.
    pub flux: &'a [f64],
    /// Ends of films, by rising `x`.
    pub fronts: &'a [FilmFront],
}

/// A running one-dimensional film.
pub trait Film1d: Send {
    /// Solves for the film. What is found depends on nothing but the inputs; a model may start its search from the last film.
    ///
    /// # Errors
    /// No gap, or no solution for these inputs (Recoverable); inputs that are not numbers or do not fit the line (Fatal).
    fn solve(&mut self, inp: &Film1dIn<'_>) -> Result<Film1dOut, EvalError>;

    /// The film that the last successful [`Film1d::solve`] found; before it, an empty line.
    fn field(&self) -> FilmField<'_>;

    /// Oil \[m²\] in the control volume of each node when the gap is full: a start for [`FilmTime::Step`].
    fn full_content(&self, h_a: &[f64], h_b: &[f64], content: &mut [f64]);
}
