//! Temperatures of the film under each ring.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{FilmHeat, FilmTemperature, FilmTemperatureCtx, FilmTemperatureSpec};
use gudgeon_film as _; // links the models, which are only asked for by name

/// Gas temperatures above three rings and of the crankcase.
const LANDS: [f64; 4] = [573.15, 573.15, 523.15, 373.15];

fn build(text: &str) -> Result<Box<dyn FilmTemperature>, BuildError> {
    let spec: Box<dyn FilmTemperatureSpec> = toml::from_str(text).expect("a valid specification");
    spec.build(&FilmTemperatureCtx::new(&LANDS, 0.14))
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b, "{a} is not {b}"); // rounding
}

/// Zottin 1992, section 2.4: `es = Yp - (l - r)`, `f = (2r - es)/(2r)`, so that `2r - es` is the travel of ring 1.
#[test]
fn liner_linear() {
    let t = build("model = \"liner_linear\"\ntdc = \"180 degC\"\nbdc = \"110 degC\"\n").expect("valid");
    assert!(!t.is_constant());
    for (travel, celsius) in [(0.0, 180.0), (0.035, 162.5), (0.14, 110.0), (0.16, 100.0)] {
        close(t.temperature(0, travel, &[]), celsius + 273.15);
        assert_eq!(t.temperature(2, travel, &[]), t.temperature(0, travel, &[]));
    }
    assert!(
        build("model = \"liner_linear\"\ntdc = \"150 degC\"\nbdc = \"150 degC\"\n")
            .is_ok_and(|t| t.is_constant())
    );
    let spec: Box<dyn FilmTemperatureSpec> =
        toml::from_str("model = \"liner_linear\"\ntdc = 450\nbdc = 380\n").expect("valid");
    for stroke in [0.0, -1.0, f64::NAN] {
        assert!(spec.build(&FilmTemperatureCtx::new(&LANDS, stroke)).is_err());
    }
}

/// Tomanik 1993: a wall of 100 °C and lands of 200, 160 and 120 °C give films of 150, 130 and 110 °C.
#[test]
fn land_wall_mean() {
    let t = build("model = \"land_wall_mean\"\nlands = [\"200 degC\", \"160 degC\", \"120 degC\"]\n")
        .expect("valid");
    assert!(t.is_constant());
    for (ring, celsius) in [150.0, 130.0, 110.0].into_iter().enumerate() {
        close(t.temperature(ring, 0.1, &[]), celsius + 273.15);
    }
    // Without a list, the gas temperatures of the lands above the rings.
    let t = build("model = \"land_wall_mean\"\nwall = \"120 degC\"\n").expect("valid");
    for (ring, land) in LANDS[..3].iter().enumerate() {
        close(t.temperature(ring, 0.0, &[]), 0.5 * (land + 393.15));
    }
    let e = build("model = \"land_wall_mean\"\nlands = [400, 380]\n").expect_err("two for three rings");
    assert_eq!((e.field.as_str(), e.message.as_str()), ("lands", "2 temperatures for 3 rings"));
}

#[test]
fn given() {
    let t = build("model = \"given\"\ntemperatures = [\"150 degC\", \"130 degC\", 400]\n").expect("valid");
    assert!(t.is_constant());
    close(t.temperature(1, 0.1, &[]), 403.15);
    assert_eq!(t.temperature(2, 0.0, &[]), 400.0);
    for list in ["[]", "[400]", "[400, 400, 400, 400]"] {
        let e = build(&format!("model = \"given\"\ntemperatures = {list}\n")).expect_err("wrong length");
        assert_eq!(e.field, "temperatures");
    }
    let none = toml::from_str::<Box<dyn FilmTemperatureSpec>>("model = \"given\"\ntemperatures = []\n")
        .expect("valid");
    assert!(none.build(&FilmTemperatureCtx::new(&[], 0.1)).is_err());
}

const OMEGA: f64 = 200.0;
const AROUND: f64 = 0.377;

fn balance() -> Box<dyn FilmTemperature> {
    let text = "model = \"energy_balance\"\nrings = [480, 440]\ntdc = 450\nbdc = 380\nconductivity = 0.13\nheat_capacity = 1.9\n";
    let spec: Box<dyn FilmTemperatureSpec> = toml::from_str(text).expect("a valid specification");
    let ctx = FilmTemperatureCtx::new(&LANDS[..3], 0.14).faces(&[3e-3, 2e-3], AROUND, OMEGA);
    spec.build(&ctx).expect("valid")
}

/// Rate of the temperature of ring 1 \[K/s\] at a temperature \[K\].
fn heating(t: &mut dyn FilmTemperature, kelvin: f64, heat: &FilmHeat) -> f64 {
    let mut dy = [0.0; 2];
    t.rates(0, &[kelvin / 100.0, 4.0], heat, &mut dy).expect("finite");
    assert_eq!(dy[1], 0.0, "the other ring");
    100.0 * OMEGA * dy[0]
}

/// At rest a film has the mean of its walls and `P h/(12 k A)`, and comes back to that with `ρ c h²/(12 k)`.
#[test]
fn energy_balance_at_rest() {
    let mut t = balance();
    assert!(!t.is_constant());
    let (h, power, travel) = (2e-6, 400.0, 0.07);
    let heat = FilmHeat::new(h, power, 0.0, travel);
    let rest = 0.5 * (480.0 + 415.0) + power * h / (12.0 * 0.13 * AROUND * 3e-3);
    let time = 1.9e6 * h * h / (12.0 * 0.13);
    // Heat fluxes of 1e7 W/m2 that cancel to rounding, over the heat capacity of the film: 1e-9 of 1e7 K/s.
    assert!(heating(&mut *t, rest, &heat).abs() < 1e-8 * 10.0 / time);
    close(-heating(&mut *t, rest + 10.0, &heat) * time, 10.0);
    close(t.temperature(0, travel, &[3.9, 4.0]), 390.0);
    // A scheme without states sees the mean of the walls.
    close(t.temperature(1, travel, &[]), 0.5 * (440.0 + 415.0));
}

/// Sliding carries oil of the liner's temperature through the film: `ρ c u h/2` per circumference. Where that is all, the film takes that temperature.
#[test]
fn energy_balance_of_a_thick_film() {
    let mut t = balance();
    let (h, u) = (1e-3, 10.0);
    let heat = FilmHeat::new(h, 0.0, u, 0.0);
    let carried = 0.5 * 1.9e6 * u * h / 3e-3;
    let wall = 6.0 * 0.13 / h;
    let rest = (wall * 480.0 + (wall + carried) * 450.0) / (2.0 * wall + carried);
    // As above, with a film that has a thousand times the heat capacity.
    assert!(heating(&mut *t, rest, &heat).abs() < 1e-6 && (rest - 450.0).abs() < 0.01);
    // However thin, a film has a rate.
    assert!(heating(&mut *t, 400.0, &FilmHeat::new(0.0, 1e4, 20.0, 0.0)).is_finite());
}

#[test]
fn energy_balance_needs_its_rings() {
    let text = "model = \"energy_balance\"\nrings = [480]\ntdc = 450\nbdc = 380\n";
    let spec: Box<dyn FilmTemperatureSpec> = toml::from_str(text).expect("a valid specification");
    let of = |faces: &[f64], around: f64| {
        spec.build(&FilmTemperatureCtx::new(&LANDS, 0.14).faces(faces, around, OMEGA)).err().map(|e| e.field)
    };
    assert_eq!(of(&[3e-3, 2e-3], AROUND), Some("rings".into()));
    assert_eq!(of(&[], AROUND), Some("rings".into()));
    assert_eq!(of(&[3e-3], 0.0), Some(String::new()));
    assert_eq!(of(&[3e-3], AROUND), None);
}
