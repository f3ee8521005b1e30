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

/// Indicator diagram and lever of the compressor.
#[derive(Clone, Copy, PartialEq)]
pub enum Gas {
    None,
    /// Angle windows, obliquity of the listing.
    M1,
    /// Angle windows, exact obliquity.
    M2,
    /// Ideal valves, exact obliquity.
    M3,
}

pub mod compressor {
    //! The four-throw compressor of Gomes (2021).
    use super::{Gas, link, node};
    use gudgeon_core::kinds::*;
    use gudgeon_core::quantity::quantity;
    use gudgeon_kinematics::{AngleWindows, Clearance, ExactSliderCrank, IdealValves};

    pub const THROW: ThrowCtx = ThrowCtx {
        crank_radius: 0.09,
        rod_length: 0.562,
        offset: 0.0,
        crank_inertia: 7.0,
        rod_mass: 68.0,
        rod_centre: 0.29,
        rod_inertia: None,
        reciprocating_mass: 235.0,
    };

    pub fn end(gas: Gas) -> Vec<GasEnd> {
        if gas == Gas::None {
            return Vec::new();
        }
        let ctx = KinematicsCtx { crank_radius: 0.09, rod_length: 0.562, offset: 0.0, omega: 100.0 };
        let kinematics = ExactSliderCrank {}.build(&ctx).expect("builds");
        let area = std::f64::consts::PI * 0.305 * 0.305 / 4.0;
        let c = CylinderPressureCtx {
            kinematics: &*kinematics,
            piston_area: area,
            files: &gudgeon_core::file::Files::default(),
        };
        let clearance = Clearance {
            compression_ratio: Some(quantity(17.5)),
            stroke: Some(quantity(0.145)),
            ..Clearance::default()
        };
        let (suction, discharge, exponent) = (quantity(101_325.0), quantity(601_325.0), quantity(1.4));
        let pressure = if gas == Gas::M3 {
            IdealValves { suction, discharge, exponent, clearance, held_open: false }.build(&c)
        } else {
            AngleWindows {
                suction,
                discharge,
                exponent,
                clearance,
                suction_opens: quantity(0.771),
                discharge_opens: quantity(5.362),
            }
            .build(&c)
        };
        vec![GasEnd {
            pressure: pressure.expect("builds"),
            kinematics,
            area,
            back_pressure: 101_325.0,
            factor: 1.0,
            crank_radius: 0.09,
            obliquity: if gas == Gas::M1 { Obliquity::Reversed } else { Obliquity::Exact },
        }]
    }

    /// Mean inertia of a throw and the damping that the source sizes with it.
    pub fn inertia_and_damping() -> (f64, f64) {
        let i0 = gudgeon_torsion::throw_inertia::Mean {}.build(&THROW).expect("builds").mean();
        (i0, 2.0 * 0.03 * (8e6 * i0).sqrt())
    }

    /// The line with a motor of straight characteristic.
    pub fn line(
        gas: Gas,
        inertia: &dyn ThrowInertiaSpec,
        motor: Option<(f64, f64)>,
        phases: [f64; 4],
    ) -> Line {
        let (_, c0) = inertia_and_damping();
        let mut l = Line {
            nodes: [130.0, 10.0, 310.0, 0.0, 0.0, 0.0, 0.0].map(|j| node(j, 0.0)).to_vec(),
            links: super::COMPRESSOR_K.iter().enumerate().map(|(i, k)| link(i, i + 1, *k, c0, 0.0)).collect(),
            ..Line::default()
        };
        for (k, phase) in phases.into_iter().enumerate() {
            let inertia = inertia.build(&THROW).expect("builds");
            l.throws.push(LineThrow::new(3 + k, phase, inertia, end(gas)));
        }
        if let Some((c0, c1)) = motor {
            let drive = gudgeon_torsion::drive::Linear {
                intercept: Some(quantity(c0)),
                slope: Some(quantity(c1)),
                rated: None,
            };
            l.drives.push(LineDrive {
                node: 0,
                phase: 0.0,
                factor: 1.0,
                drive: drive.build().expect("builds"),
            });
        }
        l
    }

    /// A context about a speed, with the start of the source.
    pub fn context<'a>(
        line: &'a Line,
        speed: f64,
        orders: f64,
        speeds: &'a [f64],
        times: &'a [f64],
    ) -> TorsionCtx<'a> {
        TorsionCtx {
            line,
            speed,
            orders,
            period: 2.0 * std::f64::consts::PI,
            balance: &[1.0],
            angles: &[0.0; 7],
            speeds,
            times,
        }
    }

    pub const START: [f64; 7] = [1000.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

    pub fn run(spec: &dyn TorsionSpec, ctx: &TorsionCtx<'_>) -> TorsionOut {
        let mut out = TorsionOut::default();
        spec.build(ctx).expect("builds").run(&mut out).expect("runs");
        out
    }
}
