//! Films under a ring face with flow factors, shear thinning, thickening under pressure and density, against closed forms and independent solutions.

use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{
    CompressibilitySpec, FaceCtx, FaceIn, Hydrodynamics, HydrodynamicsSpec, PiezoviscositySpec,
    RheologySpecs, RoughFlow, RoughnessSpec, ShearThinningSpec,
};
use gudgeon_core::quantity::quantity;
use gudgeon_film::{
    Barus, Carreau, Cavitation, CavityShear, ClosedFormFace, DowsonHigginson, GriddedFace, PatirCheng,
    Pattern,
};

const AMBIENT: f64 = 101_325.0;

fn rough(liner: f64, body: f64) -> PatirCheng {
    PatirCheng {
        liner_roughness: quantity(liner),
        body_roughness: quantity(body),
        pattern: Pattern::One,
        liner_pattern: None,
        body_pattern: None,
    }
}

fn carreau() -> Carreau {
    Carreau { critical_shear_rate: quantity(1e6), exponent: quantity(0.6), high_shear_ratio: quantity(0.5) }
}

fn barus(alpha: f64) -> Barus {
    Barus { pressure_viscosity: quantity(alpha) }
}

fn dense() -> DowsonHigginson {
    DowsonHigginson { a: quantity(0.6e-9), b: quantity(1.7e-9) }
}

fn barrel(length: f64, depth: f64) -> FaceProfile {
    let half = 0.5 * length;
    FaceProfile::Parabola { length, curvature: depth / (half * half), apex: half }
}

fn film(
    face: &FaceProfile,
    points: usize,
    refine: usize,
    specs: RheologySpecs<'_>,
) -> Box<dyn Hydrodynamics> {
    let rheology = specs.build().expect("models");
    GriddedFace { refine, points }.build_with(&FaceCtx { face }, &rheology).expect("a film")
}

/// The kinds one by one, and together.
fn each<'a>(
    r: &'a dyn RoughnessSpec,
    s: &'a dyn ShearThinningSpec,
    p: &'a dyn PiezoviscositySpec,
    c: &'a dyn CompressibilitySpec,
) -> [RheologySpecs<'a>; 5] {
    let none = RheologySpecs::default();
    [
        RheologySpecs { shear_thinning: Some(s), ..none },
        RheologySpecs { piezoviscosity: Some(p), ..none },
        RheologySpecs { compressibility: Some(c), ..none },
        RheologySpecs { roughness: Some(r), ..none },
        RheologySpecs {
            roughness: Some(r),
            shear_thinning: Some(s),
            piezoviscosity: Some(p),
            compressibility: Some(c),
        },
    ]
}

/// Independent numbers: the flux through the edge found by shooting (SciPy, DOP853 at a tolerance of 1e-12) for
/// `p' = 12 μ f_s(u/h) exp(α p)/(φ h³) [u h_c/2 + (ḣ Y - m)/ρ(p)]`, `Y' = ρ c/c(0)`, the factors of Patir and Cheng written anew, forces by Simpson's rule.
/// Load, force on the ring, on the liner, on the slopes \[N/m\], highest pressure \[Pa\].
const INDEPENDENT: [(&str, [f64; 5]); 5] = [
    ("shear_thinning", [2835.522184, -5.998455621, -8.423085982, -10.74463036, 6565327.996]),
    ("piezoviscosity", [3077.038114, -6.910722759, -9.98297984, -11.39225708, 7458515.166]),
    ("compressibility", [2953.118863, -6.478218086, -9.145798838, -10.98758075, 6976924.487]),
    ("roughness", [3108.274986, -7.744897238, -9.709652004, -11.01779945, 7539031.752]),
    ("all", [3121.072616, -7.661873413, -9.765453491, -11.14028665, 7600851.131]),
];

#[test]
fn independent_solutions_to_second_order() {
    let face = barrel(1e-3, 4e-6);
    let inp = FaceIn { h: 1.2e-6, u: -2.0, p_bottom: 4e5, p_top: 2e6, p_cav: AMBIENT, mu: 0.008 };
    let (r, s, p, c) = (rough(0.4e-6, 0.2e-6), carreau(), barus(2e-8), dense());
    for (specs, (name, exact)) in each(&r, &s, &p, &c).into_iter().zip(INDEPENDENT) {
        let errors = [50, 200].map(|points| {
            let o = film(&face, points, 1, specs).evaluate(&inp, -5e-3).expect("a film");
            [o.load, o.ring_shear, o.liner_shear, o.slope_force, o.p_max]
                .iter()
                .zip(exact)
                .map(|(v, e)| (v / e - 1.0).abs())
                .fold(0.0, f64::max)
        });
        // Second order on 49 and 199 panels: some 1e-3, and a sixteenth of it.
        assert!(errors[0] < 5e-3 && errors[1] < 0.08 * errors[0], "{name}: {errors:?}");
    }
}

/// Where every effect vanishes the film is that of the smooth grid, to rounding.
#[test]
fn without_effect_it_is_the_plain_film() {
    let faces = [barrel(3e-3, 6e-6), FaceProfile::Taper { length: 2.6e-3, land: 0.4e-3, drop: 35e-6 }];
    let none = RheologySpecs::default();
    let (faint, thick) = (barus(1e-20), rough(1e-12, 1e-12));
    for face in faces {
        for (h, u, hdot, p_top) in
            [(2e-6, 12.0, 1e-4, 8e6), (6e-7, -0.3, -2e-3, 3e5), (8e-6, -15.0, 0.0, 1e5)]
        {
            let inp = FaceIn { h, u, p_bottom: 2e5, p_top, p_cav: AMBIENT, mu: 0.006 };
            let plain = GriddedFace { refine: 2, points: 21 }.build(&FaceCtx { face: &face });
            let plain = plain.expect("a film").evaluate(&inp, hdot).expect("a film");
            for (specs, apart) in [
                // The reduced pressure goes through a logarithm and an exponential.
                (RheologySpecs { piezoviscosity: Some(&faint), ..none }, 1e-10),
                // The drag of rough surfaces is (sigma/h)^2 greater, 6e-12 at the thinnest place.
                (RheologySpecs { roughness: Some(&thick), ..none }, 1e-10),
            ] {
                let o = film(&face, 21, 2, specs).evaluate(&inp, hdot).expect("a film");
                let pairs = [
                    (o.load, plain.load),
                    (o.squeeze_damping, plain.squeeze_damping),
                    (o.ring_shear, plain.ring_shear),
                    (o.liner_shear, plain.liner_shear),
                    (o.slope_force, plain.slope_force),
                    (o.p_max, plain.p_max),
                    (o.full_film.1, plain.full_film.1),
                ];
                for (k, (a, b)) in pairs.into_iter().enumerate() {
                    assert!((a - b).abs() <= apart * b.abs() + 1e-12, "{k} at {h}, {u}: {a} is not {b}");
                }
            }
        }
    }
}

/// Between flat rough plates that approach, `load = -ḣ μ L³/(φ_x h_p³)`: over that of smooth plates it is `h³/(φ_x h_p³)`, with `h` the mean gap.
/// Sliding drags both with `μ u L φ_f/h_p`, shared unequally.
#[test]
fn flat_rough_plates() {
    let face = FaceProfile::Table { length: 1e-3, drops: vec![0.0; 11] };
    let spec = rough(0.3e-6, 0.1e-6);
    let law = spec.build().expect("builds");
    let mut flow = RoughFlow::new(1);
    for separation in [-2e-7, 1e-7, 3e-7, 1e-6, 4e-6] {
        law.flow(&[separation], &mut flow).expect("a film");
        let (h, held, phi) = (flow.content[0], flow.film[0], flow.phi_x[0]);
        let inp = FaceIn { h, u: 0.0, p_bottom: AMBIENT, p_top: AMBIENT, p_cav: AMBIENT, mu: 0.01 };
        let smooth = GriddedFace { refine: 1, points: 11 }.build(&FaceCtx { face: &face });
        let smooth = smooth.expect("a film").evaluate(&inp, -1e-4).expect("a film");
        let specs = RheologySpecs { roughness: Some(&spec), ..RheologySpecs::default() };
        let mut rough = film(&face, 11, 1, specs);
        let o = rough.evaluate(&inp, -1e-4).expect("a film");
        let ratio = h.powi(3) / (phi * held.powi(3));
        // The separation is found to 1e-14 of the content; deep in the overlap, where the content is a twentieth of the roughness, that is 1e-13 of the rest.
        assert!(
            (o.load / smooth.load / ratio - 1.0).abs() < 1e-11,
            "{separation}: {} {ratio}",
            o.load / smooth.load
        );
        let slid = rough.evaluate(&FaceIn { u: 7.0, ..inp }, 0.0).expect("a film");
        let mut shear = gudgeon_core::kinds::RoughShear::new(1);
        law.shear(&[separation], &mut shear).expect("a film");
        let mean = 0.01 * 7.0 * 1e-3 * shear.phi_f[0] / shear.film[0];
        let apart = 0.01 * 7.0 * 1e-3 * shear.phi_fs[0] / shear.film[0];
        assert!((0.5 * (slid.ring_shear + slid.liner_shear) / mean - 1.0).abs() < 1e-11);
        assert!((0.5 * (slid.liner_shear - slid.ring_shear) - apart).abs() < 1e-11 * mean);
    }
}

/// Pressures of an oil by Barus are `-ln(1 - α Π)/α` of those of the oil that does not thicken, at every node.
#[test]
fn barus_is_the_closed_form_at_every_node() {
    let (alpha, face) = (2.2e-8, barrel(2e-3, 5e-6));
    let inp = FaceIn { h: 1e-6, u: 9.0, p_bottom: AMBIENT, p_top: AMBIENT, p_cav: AMBIENT, mu: 0.012 };
    let mut plain = GriddedFace { refine: 1, points: 41 }.build(&FaceCtx { face: &face }).expect("a film");
    let law = barus(alpha);
    let specs = RheologySpecs { piezoviscosity: Some(&law), ..RheologySpecs::default() };
    let mut thick = film(&face, 41, 1, specs);
    let (mut a, mut b) = ([(0.0, 0.0, 0.0); 41], [(0.0, 0.0, 0.0); 41]);
    plain.profile(&inp, -2e-4, &mut a).expect("a film");
    thick.profile(&inp, -2e-4, &mut b).expect("a film");
    let mut rose = 0.0_f64;
    for (a, b) in a.iter().zip(&b) {
        let exact = -(-alpha * (a.2 - AMBIENT)).ln_1p() / alpha;
        rose = rose.max(exact / (a.2 - AMBIENT).max(1.0));
        // Rounding of sums over 40 panels of pressures that cancel in part.
        assert!((b.2 - AMBIENT - exact).abs() < 1e-6 * exact.max(1e3), "{}: {} {exact}", a.0, b.2 - AMBIENT);
    }
    assert!(rose > 1.02, "the oil hardly thickens: {rose}");
    // Pressed together faster it would have no pressure any more, did the thickening not end; the squeeze velocity of any load is found.
    assert!(thick.evaluate(&inp, -1.0).is_ok_and(|o| o.load.is_finite() && o.load > 1e9));
    for load in [1e3, 1e4, 3e4, 1e7] {
        let hdot = thick.squeeze_rate(&inp, load).expect("a velocity");
        let o = thick.evaluate(&inp, hdot).expect("a film");
        assert!((o.load / load - 1.0).abs() < 1e-9, "{} for {load}", o.load);
    }
}

#[test]
fn what_it_cannot_do_is_told() {
    let face = barrel(3e-3, 6e-6);
    let s = carreau();
    let mut model =
        film(&face, 11, 1, RheologySpecs { shear_thinning: Some(&s), ..RheologySpecs::default() });
    let inp = FaceIn { h: 2e-6, u: 5.0, p_bottom: 2e5, p_top: 2e5, p_cav: AMBIENT, mu: 0.006 };
    assert!(model.evaluate(&FaceIn { h: 0.0, ..inp }, 0.0).is_err_and(|e| e.is_recoverable()));
    assert!(model.evaluate(&FaceIn { mu: 0.0, ..inp }, 0.0).is_err_and(|e| !e.is_recoverable()));
    assert!(model.evaluate(&FaceIn { u: f64::NAN, ..inp }, 0.0).is_err_and(|e| !e.is_recoverable()));
    assert!(model.evaluate(&inp, f64::NAN).is_err_and(|e| !e.is_recoverable()));
    // Edge pressures alone carry more than that.
    assert!(model.squeeze_rate(&inp, 1e-3).is_err_and(|e| e.is_recoverable()));
}

/// The closed form with averages of flow factors and shear thinning against the grid with the values of every node, both clipped at the cavitation
/// pressure: what each makes of the load and the drag of the plain film, on faces that carry.
#[test]
fn averages_of_the_closed_form() {
    let faces = [barrel(3e-3, 6e-6), FaceProfile::Taper { length: 2.6e-3, land: 0.2e-3, drop: 35e-6 }];
    let closed = ClosedFormFace { cavitation: Cavitation::HalfSommerfeld, cavity_shear: CavityShear::Full };
    let fine = GriddedFace { refine: 2, points: 199 };
    let (equal, thinning) = (rough(0.2e-6, 0.2e-6), carreau());
    let none = RheologySpecs::default();
    for specs in [
        RheologySpecs { roughness: Some(&equal), ..none },
        RheologySpecs { shear_thinning: Some(&thinning), ..none },
    ] {
        let rheology = specs.build().expect("models");
        for face in &faces {
            let ctx = FaceCtx { face };
            let films = [&closed as &dyn HydrodynamicsSpec, &fine]
                .map(|s| (s.build_with(&ctx, &rheology).expect("a film"), s.build(&ctx).expect("a film")));
            let [mut averaged, mut every] = films;
            // From 3.5 roughness heights on.
            for h in [1e-6, 2e-6, 4e-6] {
                for (u, hdot) in [(-3.0, -2e-4 * h / 1e-6), (0.5, -1e-3 * h / 1e-6)] {
                    let inp = FaceIn { h, u, p_bottom: 2e5, p_top: 3e5, p_cav: AMBIENT, mu: 0.008 };
                    let change = |(with, without): &mut (Box<dyn Hydrodynamics>, Box<dyn Hydrodynamics>)| {
                        let with = with.evaluate(&inp, hdot).expect("a film");
                        let without = without.evaluate(&inp, hdot).expect("a film");
                        (with.load / without.load, with.liner_shear / without.liner_shear)
                    };
                    let (a, b) = (change(&mut averaged), change(&mut every));
                    let apart = (a.0 / b.0 - 1.0, a.1 / b.1 - 1.0);
                    // Squeeze and sliding are clipped together, and each alone is matched: what the documentation of the model says.
                    assert!(apart.0.abs() < 0.03 && apart.1.abs() < 0.01, "{face:?}, {inp:?}: {a:?} {b:?}");
                }
            }
        }
    }
}

/// In mixed lubrication, where the face drives the flow by what the surfaces leave of its rise, and where they carry it unequally: load and drags of a face
/// that slides against a rough liner, over those of the plain film, are those of the grid.
#[test]
fn averages_of_the_closed_form_near_contact() {
    let edge = FaceProfile::Table { length: 2.6e-3, drops: vec![0.0, 35e-6] };
    let closed = ClosedFormFace { cavitation: Cavitation::HalfSommerfeld, cavity_shear: CavityShear::Full };
    let fine = GriddedFace { refine: 2, points: 200 };
    for (liner, body) in [(0.2e-6, 0.2e-6), (0.3e-6, 0.1e-6), (0.1e-6, 0.3e-6)] {
        let surfaces = rough(liner, body);
        let specs = RheologySpecs { roughness: Some(&surfaces), ..RheologySpecs::default() };
        let rheology = specs.build().expect("models");
        // A third, two thirds, 1.3, 2.3 roughness heights; the first with the part that its 16 places a side miss of a film as long as two of them.
        for (h, part) in [(1e-7, 0.12), (2e-7, 0.02), (4e-7, 0.01), (6.6e-7, 0.01)] {
            for face in [&barrel(3e-3, 6e-6), &edge] {
                let ctx = FaceCtx { face };
                let inp = FaceIn { h, u: -3.0, p_bottom: 2e5, p_top: 3e5, p_cav: AMBIENT, mu: 0.008 };
                let [averaged, every] = [&closed as &dyn HydrodynamicsSpec, &fine].map(|s| {
                    let with = s.build_with(&ctx, &rheology).expect("a film").evaluate(&inp, 0.0);
                    let without = s.build(&ctx).expect("a film").evaluate(&inp, 0.0);
                    let (with, without) = (with.expect("a film"), without.expect("a film"));
                    [with.load / without.load, with.liner_shear / without.liner_shear]
                });
                for (a, b) in averaged.into_iter().zip(every) {
                    assert!((a / b - 1.0).abs() < part, "{face:?}, {liner}, {h}: {averaged:?} {every:?}");
                }
            }
        }
    }
}

/// What a face lets through is the flow of the grid's equation: between flat surfaces `u h_c/2`.
#[test]
fn averages_let_through_what_the_liner_carries() {
    let face = FaceProfile::Table { length: 1e-3, drops: vec![0.0; 11] };
    let surfaces = rough(0.3e-6, 0.1e-6);
    let specs = RheologySpecs { roughness: Some(&surfaces), ..RheologySpecs::default() };
    let rheology = specs.build().expect("models");
    let mut film = ClosedFormFace::default().build_with(&FaceCtx { face: &face }, &rheology).expect("a film");
    let mut flow = RoughFlow::new(1);
    for separation in [-1e-7, 3e-7, 2e-6] {
        surfaces.build().expect("builds").flow(&[separation], &mut flow).expect("a film");
        let p = AMBIENT + 1e5;
        let inp = FaceIn { h: flow.content[0], u: -4.0, p_bottom: p, p_top: p, p_cav: AMBIENT, mu: 0.01 };
        let flux = film.evaluate(&inp, 0.0).expect("a film").flux;
        // The separation is found to 1e-14 of the content, a fifth of the roughness deep in the overlap.
        assert!((flux / (0.5 * inp.u * flow.transport[0]) - 1.0).abs() < 1e-11, "{separation}: {flux}");
        assert_eq!(film.forces(&inp, 0.0).expect("a film").flux, flux);
    }
}

/// Between flat surfaces the averages are the values of every place, and the closed form is the grid but for its nodes.
#[test]
fn averages_over_a_flat_face_are_exact() {
    let face = FaceProfile::Table { length: 1e-3, drops: vec![0.0; 11] };
    let (equal, thinning) = (rough(0.2e-6, 0.2e-6), carreau());
    let specs = RheologySpecs {
        roughness: Some(&equal),
        shear_thinning: Some(&thinning),
        ..RheologySpecs::default()
    };
    let rheology = specs.build().expect("models");
    let ctx = FaceCtx { face: &face };
    let mut closed = ClosedFormFace::default().build_with(&ctx, &rheology).expect("a film");
    let mut grid = GriddedFace { refine: 19, points: 20 }.build_with(&ctx, &rheology).expect("a film");
    for (h, u) in [(0.8e-6, 3.0), (2e-6, -9.0)] {
        let inp = FaceIn { h, u, p_bottom: AMBIENT, p_top: AMBIENT, p_cav: AMBIENT, mu: 0.01 };
        let (a, b) =
            (closed.evaluate(&inp, -1e-4).expect("a film"), grid.evaluate(&inp, -1e-4).expect("a film"));
        for (x, y) in [(a.load, b.load), (a.ring_shear, b.ring_shear), (a.liner_shear, b.liner_shear)] {
            // The trapezoidal rule on 380 panels: 1/380^2 = 7e-6.
            assert!((x / y - 1.0).abs() < 1e-5, "{h}: {x} {y}");
        }
    }
}
