//! Lines for the tests.
#![allow(dead_code, reason = "each test uses some of it")]

pub mod reference;

use gudgeon_core::kinds::{CouplingSpec, Line, LineLink, LineNode};
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::coupling::{Linear, Off};

pub fn node(inertia: f64, damping: f64) -> LineNode {
    LineNode { name: String::new(), inertia, damping, ground: 0.0, ratio: 1.0 }
}

/// A linear link; a rigid one for infinite stiffness.
pub fn link(a: usize, b: usize, k: f64, c: f64, eta: f64) -> LineLink {
    let coupling = if k == f64::INFINITY {
        Off {}.build()
    } else {
        Linear { stiffness: quantity(k), damping: quantity(c), loss_factor: quantity(eta) }.build()
    };
    LineLink { name: format!("{a}-{b}"), nodes: [a, b], coupling: coupling.expect("builds") }
}

pub fn chain(j: &[f64], k: &[f64], c: &[f64], c_abs: &[f64]) -> Line {
    Line {
        nodes: j.iter().enumerate().map(|(i, j)| node(*j, c_abs.get(i).copied().unwrap_or(0.0))).collect(),
        links: k
            .iter()
            .enumerate()
            .map(|(i, k)| link(i, i + 1, *k, c.get(i).copied().unwrap_or(0.0), 0.0))
            .collect(),
        ..Line::default()
    }
}

pub fn engine() -> Line {
    use reference::{ENGINE_C, ENGINE_C_ABS, ENGINE_J, ENGINE_K};
    chain(&ENGINE_J, &ENGINE_K, &ENGINE_C, &ENGINE_C_ABS)
}

/// Chain of the compressor of Gomes (2021) with its computed inertia and damping.
pub const COMPRESSOR_J: [f64; 7] = [130.0, 10.0, 310.0, 8.422684, 8.422684, 8.422684, 8.422684];
pub const COMPRESSOR_K: [f64; 6] = [8e6, 40e6, 8e6, 8e6, 8e6, 8e6];
