//! Gas on a ring, its motion in the groove, and the conventions of its forces.

use std::hint::black_box;

use gudgeon_core::ModelInfo;
use gudgeon_core::geometry::{PackGeometry, RingPlace, RingSection};
use gudgeon_core::kinds::{
    AxialForces, AxialGasSpec, CavitationDatumSpec, DragSpec, FaceForces, FilmForceSpec, FlankCtx,
    FlankFrictionSpec, FlankSpec, HoopSpec, RadialGasSpec, RingForces, RingMotionCtx, RingMotionSpec,
    TwinLandFrictionSpec,
};

use super::{Alone, alone, part, seen};

/// Axial clearance in the groove \[m\].
const CLEARANCE: f64 = 50e-6;
/// Film forces under a face \[N/m\].
const FILM: FaceForces = FaceForces {
    load: 2000.0,
    squeeze_damping: 1e6,
    ring_shear: 20.0,
    liner_shear: -22.0,
    slope_force: 1.0,
    flux: 1e-5,
};

/// A ring of a 100 mm bore between 40 and 5 bar.
fn section(pack: &(PackGeometry, Vec<RingPlace>)) -> RingSection<'_> {
    let (geometry, places) = pack;
    RingSection::new(&geometry.rings[0], &places[0], geometry.bore_radius).under(40e5, 5e5, 38e5, 1e5)
}

pub fn axial_gas(m: &ModelInfo) -> Result<Alone, String> {
    let pack = gudgeon_gas::plain_pack(1);
    alone::<dyn AxialGasSpec, _, _>(m, |s| s.build(), move |law| seen(law.force(black_box(&section(&pack)))))
}

pub fn radial_gas(m: &ModelInfo) -> Result<Alone, String> {
    let pack = gudgeon_gas::plain_pack(1);
    alone::<dyn RadialGasSpec, _, _>(
        m,
        |s| s.build(),
        move |law| {
            let ring = section(&pack);
            seen((law.circumference(black_box(&ring)), law.load(black_box(&ring))))
        },
    )
}

pub fn cavitation_datum(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn CavitationDatumSpec, _, _>(
        m,
        |s| s.build(),
        |law| seen(law.pressure(black_box(1e5), 40e5, 5e5)),
    )
}

pub fn drag(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn DragSpec, _, _>(
        m,
        |s| s.build(),
        |law| {
            let shear = law.shear(black_box(&FILM));
            seen(law.power(shear, 10.0))
        },
    )
}

pub fn film_force(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn FilmForceSpec, _, _>(m, |s| s.build(), |law| seen(law.per_length(black_box(&FILM), 10.0)))
}

pub fn hoop(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn HoopSpec, _, _>(m, |s| s.build(), |law| seen(law.radial_force(black_box(20.0))))
}

pub fn twin_land_friction(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn TwinLandFrictionSpec, _, _>(m, |s| s.build(), |law| seen(black_box(law).shares()))
}

/// A top ring whose flanks are half wetted by an oil of 10 mPa s.
fn damping(ring: usize) -> FlankCtx {
    FlankCtx::new(ring, 3, 0.5, 4e-3, 0.01).at_speed(209.4)
}

pub fn flank(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn FlankSpec, _, _>(
        m,
        |s| s.build(&damping(0)),
        |film| {
            let place = RingPlace { s: 0.2 * CLEARANCE, clearance: CLEARANCE, ..RingPlace::default() };
            let mut y = vec![0.0; film.states().len()];
            film.initial(&mut y);
            let oil = film.oil(black_box(&y), &place);
            seen(film.law().force(&oil, place.s, -0.05, CLEARANCE, 1e-3))
        },
    )
}

pub fn flank_friction(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn FlankFrictionSpec, _, _>(
        m,
        |s| s.build(),
        |law| seen((law.force(black_box(1e-3), 500.0), law.derivative(black_box(1e-3), 500.0))),
    )
}

/// Pose and rates of a ring that has left the lower flank of its groove.
pub fn ring_motion(m: &ModelInfo) -> Result<Alone, String> {
    let oil = part::<dyn FlankSpec>("squeeze_film")?;
    let pack = gudgeon_gas::plain_pack(1);
    alone::<dyn RingMotionSpec, _, _>(
        m,
        move |s| {
            let ctx = RingMotionCtx::new(0, 0.02, CLEARANCE, 209.4, oil.build(&damping(0))?.law());
            s.build(ctx.section(2e-3, 4e-3, 0.05, 1.2e-3))
        },
        move |motion| {
            let mut y = vec![0.0; motion.states().len()];
            motion.initial(&mut y);
            let pose = motion.pose(black_box(&y), CLEARANCE);
            let place = RingPlace { s: pose.s, v: pose.v, lift_fraction: pose.lift_fraction, ..pack.1[0] };
            let axial = AxialForces {
                gas: 50.0,
                inertia: -20.0,
                gravity: -0.2,
                film: 3.0,
                expander: 0.0,
                damping: 0.0,
            };
            let mut rates = vec![0.0; y.len()];
            seen(motion.rates(&y, &RingForces::new(place, axial), &mut rates)?)
        },
    )
}
