//! Oils, surfaces and films.

use std::hint::black_box;

use gudgeon_core::elementary;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{
    BoundaryFrictionSpec, CompressibilitySpec, ContactSpec, EvaporationCtx, EvaporationSpec, FaceCtx, FaceIn,
    Film1dCtx, Film1dIn, Film1dSpec, Film2dCtx, Film2dGrid, Film2dIn, Film2dSpec, FilmEnd, FilmHeat,
    FilmTemperatureCtx, FilmTemperatureSpec, FilmTime, HydrodynamicsSpec, OilFaceIn, OilFacePlace, OilLand,
    OilSpec, OilTransportCtx, OilTransportSpec, PiezoviscositySpec, RoughFlow, RoughShear, RoughnessSpec,
    Rubbing, ShearThinningSpec,
};
use gudgeon_core::{EvalError, ModelInfo};
use gudgeon_film::film_1d::LineProfile;

use super::{Alone, alone, seen};

/// Places at which a law that answers for a slice is asked.
const POINTS: usize = 64;
/// Dynamic viscosity of the films \[Pa s\].
const VISCOSITY: f64 = 0.01;

/// `POINTS` values from `from` to `to`, both included.
fn points(from: f64, to: f64) -> [f64; POINTS] {
    std::array::from_fn(|k| from + (to - from) * k as f64 / (POINTS - 1) as f64)
}

/// At 100 °C.
pub fn oil(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn OilSpec, _, _>(m, |s| s.build(), |oil| seen(oil.viscosity(black_box(373.15))))
}

/// Up to 1 GPa.
pub fn piezoviscosity(m: &ModelInfo) -> Result<Alone, String> {
    let (p, mut factor, mut slope) = (points(0.0, 1e9), [0.0; POINTS], [0.0; POINTS]);
    alone::<dyn PiezoviscositySpec, _, _>(
        m,
        |s| s.build(),
        move |law| seen(law.factor(VISCOSITY, black_box(&p), &mut factor, &mut slope)?),
    )
}

/// Up to 10⁸ 1/s.
pub fn shear_thinning(m: &ModelInfo) -> Result<Alone, String> {
    let (rate, mut factor, mut slope) = (points(0.0, 1e8), [0.0; POINTS], [0.0; POINTS]);
    alone::<dyn ShearThinningSpec, _, _>(
        m,
        |s| s.build(),
        move |law| seen(law.factor(black_box(&rate), &mut factor, &mut slope)?),
    )
}

/// Up to 1 GPa.
pub fn compressibility(m: &ModelInfo) -> Result<Alone, String> {
    let (p, mut factor, mut slope) = (points(0.0, 1e9), [0.0; POINTS], [0.0; POINTS]);
    alone::<dyn CompressibilitySpec, _, _>(
        m,
        |s| s.build(),
        move |law| seen(law.factor(black_box(&p), &mut factor, &mut slope)?),
    )
}

/// Flow and shear factors from 0.1 to 10 µm.
pub fn roughness(m: &ModelInfo) -> Result<Alone, String> {
    let (mut flow, mut shear) = (RoughFlow::new(POINTS), RoughShear::new(POINTS));
    alone::<dyn RoughnessSpec, _, _>(
        m,
        |s| s.build(),
        move |surface| {
            // A surface that touches below some height is asked above it.
            let least = surface.held_below().unwrap_or(1e-7).max(1e-7);
            let h = points(least, least + 1e-5);
            surface.flow(black_box(&h), &mut flow)?;
            surface.shear(black_box(&h), &mut shear)?;
            seen((&flow, &shear))
        },
    )
}

/// Pressures from touching mean planes to 4 µm.
pub fn contact(m: &ModelInfo) -> Result<Alone, String> {
    let (separation, mut pressure) = (points(0.0, 4e-6), [0.0; POINTS]);
    alone::<dyn ContactSpec, _, _>(
        m,
        |s| s.build(),
        move |contact| {
            contact.pressure(black_box(&separation), &mut pressure);
            seen(&pressure)
        },
    )
}

/// From -20 to 20 m/s, a hundredth of the area touching under 2 MPa.
pub fn boundary_friction(m: &ModelInfo) -> Result<Alone, String> {
    let (speed, mut coefficient, mut slope) = (points(-20.0, 20.0), [0.0; POINTS], [0.0; POINTS]);
    alone::<dyn BoundaryFrictionSpec, _, _>(
        m,
        |s| s.build(),
        move |law| {
            let at = Rubbing { speed: &speed, pressure: &[2e6; POINTS], real_area: &[0.01; POINTS] };
            seen(law.coefficient(black_box(&at), &mut coefficient, &mut slope)?)
        },
    )
}

/// Temperatures under three rings, and what heats them.
pub fn film_temperature(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn FilmTemperatureSpec, _, _>(
        m,
        |s| {
            let ctx = FilmTemperatureCtx::new(&[523.15, 473.15, 423.15, 383.15], 0.14);
            s.build(&ctx.faces(&[3e-3, 2.6e-3, 0.4e-3], 0.377, 209.4))
        },
        |model| {
            let mut y = vec![0.0; model.states().len()];
            model.initial(&mut y);
            let mut rates = vec![0.0; y.len()];
            for ring in 0..3 {
                black_box(model.temperature(ring, black_box(0.05), &y));
                model.rates(ring, &y, &FilmHeat::new(2e-6, 500.0, 10.0, 0.05), &mut rates)?;
            }
            seen(rates)
        },
    )
}

/// Films of a barrel face about mid-stroke, a step of a few per cent apart as those of an integrator.
fn films() -> [FaceIn; 16] {
    std::array::from_fn(|k| {
        let (sin, cos) = elementary::sin_cos(std::f64::consts::TAU * k as f64 / 16.0);
        let (h, u) = (3e-6 * (1.0 + 0.1 * sin), -10.0 - 2.0 * cos);
        FaceIn { h, u, p_bottom: 2e5, p_top: 1e6, p_cav: 1e5, mu: VISCOSITY }
    })
}

/// The forces of sixteen films at a squeeze velocity, and the squeeze velocity at which each load is carried.
pub fn hydrodynamics(m: &ModelInfo) -> Result<Alone, String> {
    let films = films();
    alone::<dyn HydrodynamicsSpec, _, _>(
        m,
        |s| {
            let face = FaceProfile::Parabola { length: 3e-3, curvature: 2.7, apex: 1.2e-3 };
            s.build(&FaceCtx { face: &face })
        },
        move |film| {
            for inp in &films {
                let load = film.evaluate(black_box(inp), -1e-4)?.load;
                if film.resists() {
                    black_box(film.carry(black_box(inp), load)?);
                }
            }
            Ok(())
        },
    )
}

/// A barrel face of 1.2 mm on 64 panels, from a film that was found before.
pub fn film_1d(m: &ModelInfo) -> Result<Alone, String> {
    let line = LineProfile::parabola(1.2e-3, 17.0, 0.6e-3, 2e-6, POINTS, false).map_err(|e| e.to_string())?;
    let x = line.x.clone();
    let mu = [VISCOSITY; POINTS];
    alone::<dyn Film1dSpec, _, _>(
        m,
        move |s| s.build(&Film1dCtx { x: &x }),
        move |film| {
            seen(film.solve(&Film1dIn {
                h_a: black_box(&line.h_a),
                h_b: &line.h_b,
                mu: &mu,
                factors: None,
                u: 10.0,
                ends: [FilmEnd::Flooded { p: 1e5 }; 2],
                p_cav: 0.0,
                time: FilmTime::Steady,
            })?)
        },
    )
}

/// A plane slider of 80 mm x 80 mm that closes from 30 to 15 µm, on 24 x 24 intervals, from nothing.
pub fn film_2d(m: &ModelInfo) -> Result<Alone, String> {
    let grid = Film2dGrid::uniform(25, 25, 0.08, 0.08);
    let h: Vec<f64> = (0..grid.len()).map(|k| 30e-6 - 15e-6 * (k % 25) as f64 / 24.0).collect();
    alone::<dyn Film2dSpec, _, _>(
        m,
        move |s| s.build(&Film2dCtx { grid: &grid }),
        move |film| {
            film.reset();
            let inp = Film2dIn { edge_pressure: [1e5; 4], ..Film2dIn::new(black_box(&h), 5.0, VISCOSITY) };
            seen(film.solve(&inp)?)
        },
    )
}

/// A film of 1 µm on a liner of 180 °C for 0.1 ms under 3 bar, at fourteen metres a second.
pub fn evaporation(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn EvaporationSpec, _, _>(
        m,
        |s| s.build(&EvaporationCtx { swept: 1.6e-3, mean_speed: 14.0 }),
        |built| {
            let Some(oil) = built else { return Ok::<(), EvalError>(()) };
            let mut masses: Vec<f64> = oil.shares().iter().map(|s| 0.85e-3 * s).collect();
            let mut volatility = vec![0.0; masses.len()];
            oil.volatility(black_box(453.15), &mut volatility);
            oil.thin(&volatility, oil.transfer(3e5) * 1e-4, &mut masses);
            seen(masses)
        },
    )
}

/// Extents and rates of the oil under one face that leaves the top dead centre.
pub fn oil_transport(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn OilTransportSpec, _, _>(
        m,
        |s| {
            let profile = FaceProfile::Parabola { length: 1.2e-3, curvature: 15.0, apex: 0.5e-3 };
            let place =
                OilFacePlace { ring: 0, land: 0, profile, offset: 8e-3, clearance: [Some(0.2e-3); 2] };
            let land = OilLand { height: 8e-3, gap: 1e-3, drained: false };
            s.build(&OilTransportCtx {
                faces: &[place],
                lands: &[land],
                pin: (0.0, 0.1),
                omega: 209.4,
                volatile: None,
            })
        },
        |built| {
            let Some(oil) = built else { return Ok::<(), EvalError>(()) };
            let mut y = vec![0.0; oil.states().len()];
            oil.first(&[2e-6], &mut y);
            oil.place(black_box(&y), 0.095);
            black_box(oil.extent(0, 2e-6));
            let mut rates = vec![0.0; y.len()];
            oil.rates(0, &OilFaceIn { h: 2e-6, hdot: 1e-4, u: -5.0, flux: 1e-5 }, &mut rates);
            seen(rates)
        },
    )
}
