//! Shaft lines: their parts, their natural frequencies, their vibration.

use std::f64::consts::PI;
use std::hint::black_box;

use gudgeon_core::ModelInfo;
use gudgeon_core::kinds::{
    CouplingSpec, DriveSpec, Line, LineDrive, LineLink, LineNode, NaturalFrequenciesSpec, ThrowCtx,
    ThrowInertiaSpec, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec,
};
use gudgeon_core::quantity::quantity;

use super::{Alone, alone, part, seen};

/// Speed of the line \[rad/s\].
const SPEED: f64 = 150.0;
/// Inertias \[kg m²\] of a six-cylinder engine with damper, gear and flywheel.
const INERTIAS: [f64; 9] = [0.12, 0.03, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 1.6];
/// Stiffnesses \[N m/rad\] between them.
const STIFFNESSES: [f64; 8] = [0.08e6, 0.9e6, 1.35e6, 1.35e6, 1.35e6, 1.35e6, 1.35e6, 1.8e6];
/// Damping of every shaft \[N m s/rad\].
const DAMPING: f64 = 5.0;

/// The engine, driven by the harmonics of the drive's example at its first throw.
fn engine() -> Result<Line, String> {
    let node =
        |inertia: f64| LineNode { name: String::new(), inertia, damping: 0.5, ground: 0.0, ratio: 1.0 };
    let link = |(k, stiffness): (usize, f64)| {
        let spec = gudgeon_torsion::coupling::Linear {
            stiffness: quantity(stiffness),
            damping: quantity(DAMPING),
            loss_factor: quantity(0.0),
        };
        let coupling = spec.build().map_err(|e| e.to_string())?;
        Ok::<_, String>(LineLink { name: String::new(), nodes: [k, k + 1], coupling })
    };
    let drive = part::<dyn DriveSpec>("harmonics")?.build().map_err(|e| e.to_string())?;
    Ok(Line {
        nodes: INERTIAS.map(node).to_vec(),
        links: STIFFNESSES.into_iter().enumerate().map(link).collect::<Result<_, _>>()?,
        drives: vec![LineDrive { node: 2, phase: 0.0, factor: 1.0, drive }],
        ..Line::default()
    })
}

/// Torque under a twist of 10 mrad that changes, and the linear law at 100 Hz.
pub fn coupling(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn CouplingSpec, _, _>(
        m,
        |s| s.build(),
        |c| seen((c.torque(black_box(0.01), 1.0), c.linear(black_box(200.0 * PI), 500.0))),
    )
}

pub fn drive(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn DriveSpec, _, _>(m, |s| s.build(), |d| seen(d.torque(black_box(1.0), SPEED)))
}

/// A throw of a compressor over one turn in 72 angles.
pub fn throw_inertia(m: &ModelInfo) -> Result<Alone, String> {
    let throw = ThrowCtx {
        crank_radius: 0.09,
        rod_length: 0.562,
        offset: 0.0,
        crank_inertia: 7.0,
        rod_mass: 68.0,
        rod_centre: 0.29,
        rod_inertia: None,
        reciprocating_mass: 235.0,
    };
    alone::<dyn ThrowInertiaSpec, _, _>(
        m,
        move |s| s.build(&throw),
        |t| {
            let angle = |k: u32| (5.0 * f64::from(k)).to_radians();
            seen((0..72).map(|k| t.inertia(black_box(angle(k))).0).sum::<f64>())
        },
    )
}

/// All modes of the engine.
pub fn natural_frequencies(m: &ModelInfo) -> Result<Alone, String> {
    let line = engine()?;
    alone::<dyn NaturalFrequenciesSpec, _, _>(m, move |s| s.build(&line), |modes| seen(modes.modes()?))
}

/// The vibration of the engine: over a cycle where the model answers for one, else over its first 20 ms.
pub fn torsion(m: &ModelInfo) -> Result<Alone, String> {
    let line = engine()?;
    alone::<dyn TorsionSpec, _, _>(
        m,
        move |s| {
            let n = line.nodes.len();
            let (angles, speeds, mut balance) = (vec![0.0; n], vec![SPEED; n], vec![0.0; n]);
            // The flywheel takes the mean torque.
            balance[n - 1] = 1.0;
            let times: &[f64] = if s.answers() == TorsionAnswer::Time { &[0.005, 0.01, 0.02] } else { &[] };
            s.build(&TorsionCtx {
                line: &line,
                speed: SPEED,
                orders: 12.0,
                period: 4.0 * PI,
                balance: &balance,
                angles: &angles,
                speeds: &speeds,
                times,
            })
        },
        |line| {
            let mut out = TorsionOut::default();
            line.run(&mut out)?;
            seen(out)
        },
    )
}
