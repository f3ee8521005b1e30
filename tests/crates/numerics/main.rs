//! Tests of the numerical methods, one module a topic. Allocations are counted in a program of their own.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod bdf;
mod complex;
mod fourier;
mod gmres;
mod jet;
mod linalg;
mod maximum;
mod multigrid;
mod ode;
mod ode_reference;
mod orbit;
mod panel;
mod qp;
mod quadrature;
mod radau;
mod refusals;
mod rodas;
mod roots;
mod scaling;
mod sdirk;
mod table;
mod tangent;
mod vectors;
