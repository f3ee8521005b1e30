//! What every running model of some kinds must keep, whoever wrote it, at a machine of ordinary size: `gudgeon_testkit` says what.

use std::f64::consts::PI;
use std::path::Path;

use gudgeon_core::file::Files;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{
    BossBore, CompressibilitySpec, ContactSpec, CylinderPressureCtx, CylinderPressureSpec, FaceCtx, FaceIn,
    HydrodynamicsSpec, Kinematics, KinematicsCtx, KinematicsSpec, OilSpec, PiezoviscositySpec, PinForces,
    PinSize, PinStrengthCtx, PinStrengthSpec, Rheology, RheologySpecs, RoughnessSpec, ShearThinningSpec,
};
use gudgeon_core::registry::Kind;
use gudgeon_core::{Registry, spec};
use gudgeon_testkit::{Tolerance, assert_none, example_of};

/// Complaints about all models of the kind `S`, each built from its own example, and how many there are.
fn complaints<S: ?Sized + Kind + 'static>(check: impl Fn(Box<S>) -> Vec<String>) -> (Vec<String>, usize) {
    let registry = Registry::collect();
    let mut all = Vec::new();
    let models = registry.models(S::NAME);
    for m in models {
        let spec = example_of::<S>(m).unwrap_or_else(|e| panic!("{}: {e}", m.name));
        all.extend(check(spec).into_iter().map(|c| format!("{}: {c}", m.name)));
    }
    (all, models.len())
}

fn mechanism(offset: f64) -> KinematicsCtx {
    KinematicsCtx { crank_radius: 0.07, rod_length: 0.24, offset, omega: 2100.0 * PI / 30.0 }
}

#[test]
fn contacts() {
    let (wrong, models) =
        complaints::<dyn ContactSpec>(|s| gudgeon_testkit::contact(&*s.build().expect("an example builds")));
    assert_none(wrong);
    assert!(models >= 6);
}

#[test]
fn oils() {
    let (wrong, models) =
        complaints::<dyn OilSpec>(|s| gudgeon_testkit::oil(&*s.build().expect("an example builds")));
    assert_none(wrong);
    assert!(models >= 3);
}

#[test]
fn kinematics() {
    for offset in [0.0, 0.001, -0.012] {
        let (wrong, models) = complaints::<dyn KinematicsSpec>(|s| match s.build(&mechanism(offset)) {
            Ok(k) => gudgeon_testkit::kinematics(&*k),
            // A series may be one without offset.
            Err(e) if offset != 0.0 => {
                assert!(e.to_string().contains("offset"), "{e}");
                Vec::new()
            }
            Err(e) => vec![e.to_string()],
        });
        assert_none(wrong);
        assert!(models >= 2);
    }
}

#[test]
fn cylinder_pressures() {
    let exact = spec::plain_model::<dyn KinematicsSpec>("exact_slider_crank").expect("a model");
    let motion: Box<dyn Kinematics> = exact.build(&mechanism(0.0)).expect("a mechanism that turns");
    let files = Files::of(Path::new(env!("CARGO_MANIFEST_DIR")));
    let ctx =
        CylinderPressureCtx { kinematics: &*motion, piston_area: 0.25 * PI * 0.12 * 0.12, files: &files };
    let (wrong, models) = complaints::<dyn CylinderPressureSpec>(|s| match s.build(&ctx) {
        Ok(p) => gudgeon_testkit::cylinder_pressure(&*p),
        Err(e) => vec![e.to_string()],
    });
    assert_none(wrong);
    assert!(models >= 8);
}

#[test]
fn ring_films() {
    let (length, drop) = (2.5e-3, 8e-6);
    let faces = [
        FaceProfile::Parabola { length, curvature: 4.0 * drop / (length * length), apex: 0.5 * length },
        FaceProfile::Taper { length, land: 0.3e-3, drop },
        FaceProfile::Table { length, drops: vec![drop, 0.0, 0.0, 0.5 * drop] },
    ];
    let instants = [
        FaceIn { h: 2e-6, u: 8.0, p_bottom: 1.2e5, p_top: 4e5, p_cav: 1e5, mu: 0.008 },
        FaceIn { h: 0.7e-6, u: -3.0, p_bottom: 2e5, p_top: 60e5, p_cav: 1e5, mu: 0.02 },
        FaceIn { h: 4e-6, u: 0.0, p_bottom: 1e5, p_top: 1e5, p_cav: 1e5, mu: 0.01 },
    ];
    for face in &faces {
        for inp in &instants {
            let (wrong, models) = complaints::<dyn HydrodynamicsSpec>(|s| match s.build(&FaceCtx { face }) {
                Ok(mut film) => gudgeon_testkit::hydrodynamics(&mut *film, inp, 0.02),
                Err(e) => vec![e.to_string()],
            });
            assert_none(wrong.into_iter().map(|w| format!("{face:?}, {inp:?}: {w}")).collect());
            assert!(models >= 3);
        }
    }
}

/// Every film with every oil and surface that it can have.
#[test]
fn ring_films_of_real_oil_between_rough_surfaces() {
    let (length, drop) = (2.5e-3, 8e-6);
    let face =
        FaceProfile::Parabola { length, curvature: 4.0 * drop / (length * length), apex: 0.5 * length };
    // Squeezed so slowly that no oil would need more pressure than it can have.
    let instants = [
        (FaceIn { h: 2e-6, u: 8.0, p_bottom: 1.2e5, p_top: 4e5, p_cav: 1e5, mu: 0.008 }, 1e-3),
        (FaceIn { h: 0.7e-6, u: -3.0, p_bottom: 2e5, p_top: 60e5, p_cav: 1e5, mu: 0.02 }, 1e-5),
        (FaceIn { h: 4e-6, u: 0.0, p_bottom: 1e5, p_top: 1e5, p_cav: 1e5, mu: 0.01 }, 1e-3),
    ];
    let (mut wrong, mut films) = (Vec::new(), 0);
    for rheology in rheologies() {
        for m in Registry::collect().models("hydrodynamics") {
            let spec = example_of::<dyn HydrodynamicsSpec>(m).unwrap_or_else(|e| panic!("{}: {e}", m.name));
            let mut film = match spec.build_with(&FaceCtx { face: &face }, &rheology) {
                Ok(film) if rheology.beyond(spec.scope()).is_none() => film,
                Err(_) if rheology.beyond(spec.scope()).is_some() => continue,
                other => panic!("{}: {rheology:?}: {:?}", m.name, other.err()),
            };
            films += 1;
            for (inp, hdot) in &instants {
                let found = gudgeon_testkit::hydrodynamics(&mut *film, inp, *hdot);
                wrong.extend(found.into_iter().map(|w| format!("{}, {rheology:?}, {inp:?}: {w}", m.name)));
            }
        }
    }
    assert_none(wrong);
    assert!(films >= 8, "{films}");
}

/// Every model of the four kinds alone, as its example says.
fn rheologies() -> Vec<Rheology> {
    let registry = Registry::collect();
    let mut all = Vec::new();
    let none = RheologySpecs::default;
    for m in registry.models("roughness") {
        let s = example_of::<dyn RoughnessSpec>(m).unwrap_or_else(|e| panic!("{}: {e}", m.name));
        all.push(RheologySpecs { roughness: Some(&*s), ..none() }.build());
    }
    for m in registry.models("shear_thinning") {
        let s = example_of::<dyn ShearThinningSpec>(m).unwrap_or_else(|e| panic!("{}: {e}", m.name));
        all.push(RheologySpecs { shear_thinning: Some(&*s), ..none() }.build());
    }
    for m in registry.models("piezoviscosity") {
        let s = example_of::<dyn PiezoviscositySpec>(m).unwrap_or_else(|e| panic!("{}: {e}", m.name));
        all.push(RheologySpecs { piezoviscosity: Some(&*s), ..none() }.build());
    }
    for m in registry.models("compressibility") {
        let s = example_of::<dyn CompressibilitySpec>(m).unwrap_or_else(|e| panic!("{}: {e}", m.name));
        all.push(RheologySpecs { compressibility: Some(&*s), ..none() }.build());
    }
    all.into_iter().map(|r| r.expect("examples build")).collect()
}

#[test]
fn pin_strengths() {
    for boss_bore in [BossBore::Profiled, BossBore::Cylindrical] {
        let ctx = PinStrengthCtx {
            boss_gap: 0.040,
            rod_width: 0.038,
            boss_bore,
            modulus: 210e9,
            poisson: 0.3,
            pi: PI,
        };
        // The eccentricity of a curved ring is a difference of radii, twenty times smaller than they are: it loses that many roundings.
        let tolerance = Tolerance { rounding: 20.0 * 16.0 * f64::EPSILON, ..Tolerance::default() };
        let (wrong, models) = complaints::<dyn PinStrengthSpec>(|s| match s.build(&ctx) {
            Ok(strength) => gudgeon_testkit::pin_strength(
                &*strength,
                &PinSize { length: 0.090, outer: 0.042, inner: 0.024 },
                &PinForces { gas: 150e3, inertia: -12e3 },
                tolerance,
            ),
            Err(e) => vec![e.to_string()],
        });
        assert_none(wrong);
        assert!(models >= 4);
    }
}
