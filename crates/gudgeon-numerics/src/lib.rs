//! Numerical methods for small stiff models: integrators with events, periodic orbits, linear systems, roots, optimisation, quadrature and
//! tables. The crate holds no physics, depends on no other crate of Gudgeon and can be used alone.
//!
//! Three rules hold everywhere. A function that is integrated or searched may fail ([`EvalError`]), and the method then tries a
//! smaller step or hands the error on. Work arrays are allocated when a solver is made, not while it runs. Results depend on the
//! arguments alone: not on threads, time or hash order.
//!
//! # Which module to take
//!
//! | problem | take | because |
//! |---|---|---|
//! | stiff `y' = f(t, y)`, relative tolerance 1e-2 to 1e-7, events, balances that must close | [`rodas::Rodas`] | one LU factorisation a step, no Newton iteration; order 5 or 3 |
//! | the same at 1e-7 and tighter, or as an independent reference | [`radau::Radau5`] | fully implicit, fewer right-hand sides at tight tolerances; locates no events |
//! | the same, smooth over many steps, with dear right-hand sides or Jacobians | [`bdf::Bdf`] | one or two right-hand sides a step, and a Jacobian in ten steps; slow after events and breakpoints |
//! | what all share: the system, options, statistics, dense output | [`ode`] | |
//! | derivatives of a solution by its initial state and by parameters | [`tangent::Tangent`] | variational equations on the steps of the solution; events are jumps |
//! | state that repeats after a cycle | [`orbit::periodic_orbit`] | Anderson acceleration, error estimate, stability check |
//! | dense, banded or tridiagonal systems | [`linalg`] | in place, no allocation, singular matrices are errors |
//! | `A x = b` where only the product `A x` is known | [`gmres::Gmres`] | minimal residuals over a Krylov space |
//! | diffusion and transport on a rectangular grid | [`multigrid::LineMultigrid`] | work proportional to the number of nodes |
//! | root of one function | [`roots::itp`], [`roots::newton_bracketed`] | the first needs values only, the second a derivative and a good start |
//! | maximum of a sampled function of one variable | [`maximum`] | |
//! | minimum of a quadratic function of three variables with linear constraints | [`qp::minimise`] | dual active-set method |
//! | value, gradient and Hessian of a formula of three variables | [`jet`] | exact derivatives, no differences |
//! | integral of a function | [`quadrature`] | Gauss–Legendre with fixed nodes, adaptive Gauss–Kronrod |
//! | integral, extremes, level crossings over the steps of an integrator | [`panel`] | polynomial through five samples of a step |
//! | interpolation in a table | [`table::Pchip`], [`table::PeriodicCubic`] | the first never overshoots, the second is smoother |
//! | Fourier series of a periodic signal | [`fourier::Fourier`] | two real signals in one transform |
//! | loops over neighbouring numbers | [`vectors::widest`] | vectors of four numbers where the processor has them |
//!
//! # A stiff equation with an event
//!
//! Robertson's reaction has rates from 0.04 to 3e7. `Rodas` stops where half of the first species is left; `Radau5` confirms the
//! time and the state.
//!
//! ```
//! use gudgeon_numerics::ode::{EventAction, Integrator, OdeSystem, Options};
//! use gudgeon_numerics::{EvalError, radau::Radau5, rodas::Rodas};
//!
//! /// `half`: the event is located when true; `at`: its time.
//! struct Robertson { half: bool, at: f64 }
//! impl OdeSystem for Robertson {
//!     fn dim(&self) -> usize { 3 }
//!     fn rhs(&mut self, _t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
//!         let (a, b, c) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
//!         (f[0], f[1], f[2]) = (b - a, a - b - c, c);
//!         Ok(())
//!     }
//!     fn n_events(&self) -> usize { usize::from(self.half) }
//!     fn events(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
//!         g[0] = y[0] - 0.5;
//!         Ok(())
//!     }
//!     fn on_event(&mut self, _k: usize, t: f64, _y: &mut [f64]) -> Result<EventAction, EvalError> {
//!         self.at = t;
//!         Ok(EventAction::Stop)
//!     }
//! }
//!
//! let options = Options::new(1e-6, &[1.0, 1e-5, 1.0]);
//! let (mut system, mut y) = (Robertson { half: true, at: 0.0 }, [1.0, 0.0, 0.0]);
//! let work = Rodas::new(3, 0, None).solve(&mut system, (0.0, 1e6), &mut y, &options)?;
//! assert!((y[0] - 0.5).abs() < 1e-12 && work.events == 1);
//!
//! let (half, mut z) = (system.at, [1.0, 0.0, 0.0]);
//! Radau5::new(3, 0, None).solve(&mut Robertson { half: false, at: 0.0 }, (0.0, half), &mut z, &options)?;
//! // Ten times the tolerance: errors of some ten steps add up.
//! assert!((z[0] - 0.5).abs() < 1e-5 && (z[2] - y[2]).abs() < 1e-5);
//! # Ok::<(), gudgeon_numerics::ode::IntegrateError>(())
//! ```
//!
//! # A periodic orbit
//!
//! The amount left of two doses after each interval: `y ↦ M y + d`. Plain repetition would need 130 cycles for this accuracy, the
//! slow mode keeps 90 % from cycle to cycle.
//!
//! ```
//! use gudgeon_numerics::EvalError;
//! use gudgeon_numerics::orbit::{CycleMap, OrbitOptions, periodic_orbit};
//!
//! struct Doses;
//! impl CycleMap for Doses {
//!     fn dim(&self) -> usize { 2 }
//!     fn map(&mut self, y0: &[f64], y1: &mut [f64], _accuracy: f64) -> Result<f64, EvalError> {
//!         (y1[0], y1[1]) = (0.9 * y0[0] + 1.0, 0.2 * y0[0] + 0.5 * y0[1]);
//!         Ok(1.0)
//!     }
//!     fn scale(&self, _y: &[f64], s: &mut [f64]) { s.fill(10.0) }
//! }
//!
//! let options = OrbitOptions { tolerance: 1e-6, accuracy: 1e-12, max_cycles: 50, refinements: 0, accelerate: true };
//! let mut y = [0.0, 0.0];
//! let report = periodic_orbit(&mut Doses, &mut y, &options)?;
//! assert!(report.converged && report.period == 1 && report.cycles < 10);
//! assert!((y[0] - 10.0).abs() < 1e-5 && (y[1] - 4.0).abs() < 1e-5);
//! # Ok::<(), EvalError>(())
//! ```
//!
//! # Linear systems
//!
//! A dense matrix is a row-major slice; its factors take its place. The central difference of `-u'' = 2` is exact for the parabola.
//!
//! ```
//! use gudgeon_numerics::linalg::{lu_factor, lu_solve, solve_tridiagonal};
//!
//! let (mut a, mut pivots, mut x) = ([2.0, 1.0, 1.0, 3.0], [0; 2], [3.0, 5.0]);
//! lu_factor(&mut a, 2, &mut pivots)?;
//! lu_solve(&a, 2, &pivots, &mut x);
//! assert!((x[0] - 0.8).abs() < 1e-15 && (x[1] - 1.4).abs() < 1e-15);
//!
//! let (n, h) = (9, 0.1);
//! let (off, diagonal, mut work) = ([-1.0; 9], [2.0; 9], [0.0; 9]);
//! let mut u = [2.0 * h * h; 9];
//! solve_tridiagonal(&off, &diagonal, &off, &mut u, &mut work)?;
//! for i in 0..n {
//!     let x = (i + 1) as f64 * h;
//!     assert!((u[i] - x * (1.0 - x)).abs() < 1e-14);
//! }
//! # Ok::<(), gudgeon_numerics::linalg::Singular>(())
//! ```
//!
//! # A root
//!
//! ```
//! use gudgeon_numerics::roots::{RootError, itp, newton_bracketed};
//! use std::convert::Infallible;
//!
//! // cos x = x, from values alone and with the derivative.
//! let r = itp(|x: f64| Ok::<_, Infallible>(x - x.cos()), 0.0, 1.0, 1e-12)?;
//! let n = newton_bracketed(|x: f64| Ok::<_, Infallible>((x - x.cos(), 1.0 + x.sin())), 0.0, 1.0, 0.7, 1e-12)?;
//! assert!((r.x - n.x).abs() < 2e-12 && (n.x - n.x.cos()).abs() < 1e-15);
//! assert!(r.evaluations < 12 && n.evaluations < 8);
//! // A function without a change of sign is refused, with its values.
//! let none = itp(|x: f64| Ok::<_, Infallible>(1.0 + x * x), -1.0, 1.0, 1e-12);
//! assert!(matches!(none, Err(RootError::NoBracket { f_lo: 2.0, f_hi: 2.0, .. })));
//! # Ok::<(), RootError>(())
//! ```
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod bdf;
pub mod elementary;
mod error;
pub mod fourier;
pub mod gmres;
pub mod jet;
pub mod linalg;
pub mod maximum;
pub mod multigrid;
pub mod ode;
pub mod orbit;
pub mod panel;
pub mod qp;
pub mod quadrature;
pub mod radau;
pub mod rodas;
pub mod roots;
pub mod sdirk;
mod square;
pub mod stages;
pub mod table;
pub mod tangent;
pub mod vectors;

pub use error::{EvalError, Stopped, unwatched};
