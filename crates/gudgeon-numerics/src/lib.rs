//! Fallible stiff integrators, periodic-orbit solver, roots, tables and small linear algebra. No physics lives here.

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
pub mod table;

pub use error::EvalError;
