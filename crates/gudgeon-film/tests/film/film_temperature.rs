//! Temperatures of the film under each ring.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{FilmTemperature, FilmTemperatureCtx, FilmTemperatureSpec};
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
