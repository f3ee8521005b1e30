//! Fallible stiff integrators, periodic-orbit solver, roots, tables and small linear algebra. No physics lives here.
//!
//! * [`ode`]: one interface ([`ode::OdeSystem`], [`ode::Options`], [`ode::Observer`], [`ode::Integrator`]) over two stiff
//!   one-step methods, [`ode::Rodas`] (the default) and [`radau::Radau5`] (reference runs at tight tolerance), with
//!   quadratures, breakpoints, directed events and dense output.
//! * [`orbit`]: periodic orbits of a cycle map, with an estimate of the true error.
//! * [`linalg`], [`roots`], [`table`], [`quadrature`]: what the sub-models need beside it.
//!
//! Nothing here panics on user input, and no hot call allocates: work arrays are made in the constructors.

pub mod linalg;
pub mod ode;
pub mod orbit;
pub mod quadrature;
pub mod radau;
pub mod roots;
pub mod table;
