//! What the benches compute themselves: balances, limits and agreement with each other.

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{RigCtx, RigOut, RigSpec};
use gudgeon_ring as _;
use gudgeon_scene_rig as _;

fn run(case: &str) -> RigOut {
    let spec: Box<dyn RigSpec> = toml::from_str(case).unwrap_or_else(|e| panic!("{e}\n{case}"));
    let mut rig =
        spec.build(&RigCtx { files: &Files::default() }).unwrap_or_else(|e| panic!("{e:?}\n{case}"));
    let mut out = RigOut::default();
    rig.run(&mut out).unwrap_or_else(|e| panic!("{e}\n{case}"));
    out
}

fn value(out: &RigOut, name: &str) -> f64 {
    out.results[name].value
}

/// Two vessels of different size and temperature, joined by an opening alone.
fn two_vessels(until: &str) -> RigOut {
    run(&format!(
        "model = \"gas_volumes\"\nrun = {{ {until} }}\n\
         volumes = [{{ name = \"a\", volume = \"100 mm3\", temperature = \"300 K\", pressure = \"40 bar\" }}, \
         {{ name = \"b\", volume = \"900 mm3\", temperature = \"500 K\", pressure = \"1 bar\" }}]\n\
         openings = [{{ from = \"a\", to = \"b\", area = \"0.1 mm2\" }}]"
    ))
}

#[test]
fn joined_vessels_end_at_the_pressure_of_their_gas() {
    // p = Σ m R / Σ V/T, with m R = p V/T.
    let (a, b) = (100.0 / 300.0, 900.0 / 500.0);
    let p = (40.0 * a + b) / (a + b);
    let steady = two_vessels("until = \"steady\"");
    // The steps keep the sum of the masses to rounding, some hundred of them.
    assert!((value(&steady, "a.p") / p - 1.0).abs() < 1e-12, "{}", value(&steady, "a.p"));
    assert!((value(&steady, "b.p") / p - 1.0).abs() < 1e-12, "{}", value(&steady, "b.p") / p - 1.0);
    let late = two_vessels("until = \"time\", duration = \"1 s\"");
    // The default tolerance; the sum of masses is kept, what is left is the difference of the pressures.
    assert!((value(&late, "a.p") / p - 1.0).abs() < 1e-6, "{}", value(&late, "a.p"));
    assert!(late.balance.gas_mass.is_some_and(|b| b.abs() < 1e-13), "{:?}", late.balance.gas_mass);
}

#[test]
fn an_opening_in_a_network_is_the_opening_alone() {
    // A ratio of specific heats that goes with the temperature of the side that the gas comes from.
    let law = "orifice = { discharge = 0.8, gamma = \"burnt_gas\" }";
    let net = run(&format!(
        "model = \"gas_volumes\"\nrun = {{ until = \"steady\" }}\n{law}\n\
         volumes = [{{ name = \"land\", volume = \"500 mm3\", temperature = \"450 K\", pressure = \"1 bar\" }}]\n\
         boundaries = [{{ name = \"chamber\", temperature = \"1200 K\", pressure = \"20 bar\" }}, \
         {{ name = \"crankcase\", temperature = \"350 K\", pressure = \"1 bar\" }}]\n\
         openings = [{{ from = \"chamber\", to = \"land\", area = \"0.3 mm2\" }}, {{ from = \"land\", to = \"crankcase\", area = \"0.2 mm2\" }}]"
    ));
    let land = value(&net, "land.p");
    for (high, low, t, area) in [(20.0, land, 1200.0, 0.3), (land, 1.0, 450.0, 0.2)] {
        let alone = run(&format!(
            "model = \"gas_passage\"\npressure = \"{high} bar\"\nratio = {}\ntemperature = \"{t} K\"\n{law}\n\
             passage = {{ law = \"orifice\", area = \"{area} mm2\" }}",
            low / high
        ));
        // The steady state is Newton's, to rounding, and the ratio is rounded once more.
        let deviation = value(&alone, "flow") / value(&net, "crankcase.flow") - 1.0;
        assert!(deviation.abs() < 1e-11, "{deviation:e}");
    }
    assert_eq!(value(&net, "chamber.flow").signum(), -1.0);
}

/// A ring that starts 30 µm above the lower flank of a groove of 100 µm.
fn ring(rest: &str) -> RigOut {
    run(&format!(
        "model = \"flank\"\nclearance = \"100 um\"\narea = \"1000 mm2\"\nwidth = \"3 mm\"\nviscosity = \"10 mPa s\"\n\
         height = \"30 um\"\ntolerance = 1e-9\n{rest}"
    ))
}

#[test]
fn a_ring_lands_on_either_flank() {
    let dry = "mass = \"12 g\"\nduration = \"10 ms\"\nflank = { model = \"dry\", gas_viscosity = 0.0 }\n";
    for (load, way) in [(60.0, 30e-6), (-60.0, 70e-6)] {
        let out = ring(&format!("{dry}load = \"{load} N\""));
        let t = 1e3 * (2.0 * 0.012 * way / 60.0f64).sqrt();
        // A parabola is exact for the method; the root of the landing is found to rounding of the time.
        assert!((value(&out, "time") / t - 1.0).abs() < 1e-9, "{} {t}", value(&out, "time"));
        let end = if load > 0.0 { 0.0 } else { 100.0 };
        assert!((value(&out, "end_height") - end).abs() < 1e-6);
    }
}

#[test]
fn a_light_ring_falls_like_one_without_mass() {
    let oil =
        "load = \"60 N\"\nduration = \"5 ms\"\nflank = { model = \"squeeze_film\", separation = 0.1 }\n";
    let without = ring(oil);
    // Relaxation m h³/(μ A w²) over the time of the fall: of the order of the mass.
    for (mass, off) in [("1 g", 1e-3), ("0.01 g", 1e-5)] {
        let with = ring(&format!("{oil}mass = \"{mass}\""));
        let deviation = value(&with, "end_height") / value(&without, "end_height") - 1.0;
        assert!(deviation.abs() < off, "{mass}: {deviation:e}");
    }
    // A groove that resists nowhere holds no ring without mass.
    let spec: Box<dyn RigSpec> = toml::from_str(
        "model = \"flank\"\nclearance = \"100 um\"\narea = \"1000 mm2\"\nwidth = \"3 mm\"\nviscosity = \"10 mPa s\"\n\
         height = \"30 um\"\nload = \"60 N\"\nduration = \"1 ms\"\nflank = { model = \"dry\", gas_viscosity = 0.0 }",
    )
    .expect("reads");
    let mut rig = spec.build(&RigCtx { files: &Files::default() }).unwrap_or_else(|e| panic!("{e:?}"));
    assert!(rig.run(&mut RigOut::default()).is_err());
}
