//! The table of the contact of a whole face against closed forms.

use std::sync::Arc;

use gudgeon_contact::{GreenwoodTripp, asperity_integral};
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_scene_ring_pack::contact_line::{ContactLine, MeanPlanes, SCALE};

const SIGMA: f64 = 0.3e-6;

fn rough(more: &str) -> Box<dyn Contact> {
    let text = format!(
        "roughness = {SIGMA:e}\ncomposite_modulus = 115e9\neta_beta_sigma = 0.05\nsigma_over_beta = 1e-3\n{more}"
    );
    let spec: GreenwoodTripp = toml::from_str(&text).expect("a model");
    spec.build().expect("builds")
}

fn line(contact: &dyn Contact, face: &FaceProfile, lands: usize) -> ContactLine {
    ContactLine::new(contact, &Arc::new(MeanPlanes::new(contact)), face, lands)
}

/// `p/F_(5/2)` \[Pa\].
fn scale() -> f64 {
    16.0 * 2f64.sqrt() * std::f64::consts::PI / 15.0 * 0.05 * 0.05 * 1e-3f64.sqrt() * 115e9
}

#[test]
fn sharp_taper_carries_on_through_zero_separation() {
    // ∫ F_(5/2)(λ + t) dt from 0 = F_(7/2)(λ)/3.5: the load of an edge whose face falls by `slope`.
    let (length, drop) = (2.6e-3, 35e-6);
    let slope = drop / length;
    let face = FaceProfile::Table { length, drops: vec![0.0, drop] };
    let line = line(&*rough(""), &face, 1);
    assert!(line.open && line.floor.is_none());
    for k in -60..=40 {
        let l = f64::from(k) / 10.0;
        let film = SIGMA * asperity_integral(1.0, -l);
        let exact = scale() * SIGMA / slope * asperity_integral(3.5, l) / 3.5;
        // Cubic interpolation of the fourth root as documented at POINTS, its fourth power, and the end of the range beyond 4.
        assert!((line.load(film) / exact - 1.0).abs() < 3e-6, "{l}: {} {exact}", line.load(film));
        assert!((line.separation(film) / SIGMA - l).abs() < 1e-6, "{l}");
        // Where the planes meet the table may be off by as much.
        assert!((line.overlap(film) / SIGMA - (-l).max(0.0)).abs() < 1e-6, "{l}");
        assert!(l <= 0.0 || line.overlap(film) == 0.0, "{l}");
    }
}

#[test]
fn real_area_of_a_sharp_taper() {
    // ∫ F_2(λ + t) dt from 0 = F_3(λ)/3, on A_c/A = π² (η β σ)² F_2; two lands touch on twice as much.
    let (length, drop) = (2.6e-3, 35e-6);
    let face = FaceProfile::Table { length, drops: vec![0.0, drop] };
    let contact = rough("");
    let line = line(&*contact, &face, 2);
    assert_eq!(line.area(0.5 * SIGMA), 0.0, "nobody asked for it");
    let line = line.with_area(&*contact, &face, 2);
    for k in -40..=40 {
        let l = f64::from(k) / 10.0;
        let film = SIGMA * asperity_integral(1.0, -l);
        let part = std::f64::consts::PI.powi(2) * 0.05 * 0.05;
        let exact = 2.0 * part * SIGMA * length / drop * asperity_integral(3.0, l) / 3.0;
        // As for the load.
        assert!((line.area(film) / exact - 1.0).abs() < 3e-6, "{l}: {} {exact}", line.area(film));
    }
    assert_eq!(line.area(line.range), 0.0);
}

#[test]
fn land_carries_its_width_and_the_flank_behind_it() {
    let (length, land, drop) = (2.6e-3, 0.2e-3, 35e-6);
    let line = line(&*rough(""), &FaceProfile::Taper { length, land, drop }, 1);
    for l in [-3.0, -1.0, 0.0, 0.7, 2.0, 3.5] {
        let flank = SIGMA * (length - land) / drop * asperity_integral(3.5, l) / 3.5;
        let exact = scale() * (land * asperity_integral(2.5, l) + flank);
        let got = line.load(SIGMA * asperity_integral(1.0, -l));
        // As for the sharp edge.
        assert!((got / exact - 1.0).abs() < 3e-6, "{l}: {got} {exact}");
    }
}

#[test]
fn load_rises_without_end_as_the_film_thins() {
    let barrel = FaceProfile::Parabola { length: 3e-3, curvature: 6e-6 / 2.25e-6, apex: 1.2e-3 };
    let edge = FaceProfile::Table { length: 2.6e-3, drops: vec![0.0, 35e-6] };
    for face in [barrel, edge] {
        for fit in ["", "integral = \"polynomial\"", "integral = \"hu1994\"", "integral = \"quintic\""] {
            let line = line(&*rough(fit), &face, 2);
            let mut last = (0.0, line.separation(line.range));
            // From beyond the range down to e^-45 of a metre, below the table.
            for k in 0..3000 {
                let h = (-13.0 - 32.0 * f64::from(k) / 3000.0).exp();
                let (load, s) = (line.load(h), line.separation(h));
                assert!(load >= last.0 && (load > last.0 || load == 0.0), "{fit} {h:e}");
                assert!(h >= line.range || s < last.1, "{fit} {h:e}");
                last = (load, s);
            }
            assert!(last.1 < -6.0 * SIGMA && last.0 > 1e5, "{fit}: {last:?}");
        }
    }
}

#[test]
fn tolerance_of_a_film_follows_its_separation() {
    let face = FaceProfile::Table { length: 2.6e-3, drops: vec![0.0, 35e-6] };
    let line = line(&*rough(""), &face, 1);
    assert_eq!(line.ease(2.0 * line.range), 1.0);
    for l in [-4.0, -2.0, 0.0, 0.3] {
        // ds/d ln h = h/Φ(l): by the closed forms of the mean gap and its slope, interpolation as above.
        let (gap, slope) = (asperity_integral(1.0, -l), asperity_integral(0.0, -l));
        let exact = (SCALE * line.range / (SIGMA * gap / slope)).max(1.0);
        assert!((line.ease(SIGMA * gap) / exact - 1.0).abs() < 1e-3, "{l}");
    }
}
