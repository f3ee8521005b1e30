//! Every plug-in of this crate is a full member of the program: listed, described, read from a case, validated with places, run, compared and
//! recorded.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::path::{Path, PathBuf};

use extensions::bernoulli_network::BernoulliNetwork;
use gudgeon as _;
use gudgeon_core::Registry;
use gudgeon_core::kinds::{
    FilmHeat, FilmTemperatureCtx, FilmTemperatureSpec, GasFlowCtx, GasFlowSpec, GasIn,
};
use gudgeon_core::result::RunResult;
use gudgeon_core::states::Signals;
use gudgeon_scene::{check, explain, run};
use gudgeon_scene_ring_pack::assemble::assemble;
use gudgeon_scene_ring_pack::case::RingPackCase;
use gudgeon_scene_ring_pack::jacobian::Base;
use gudgeon_testkit::{Tolerance, assert_none, gas_flow, reads, stateful};

/// Kind, name, and the `--set` argument that has the diesel use it.
const MODELS: [(&str, &str, &str); 4] = [
    ("gas_flow", "bernoulli_network", "models.gas_flow.model=bernoulli_network"),
    (
        "ring_motion",
        "lift_and_twist",
        "models.ring_motion={ model = \"lift_and_twist\", static_twist = \"0.1 deg\" }",
    ),
    (
        "film_temperature",
        "heat_balance",
        "models.film_temperature={ model = \"heat_balance\", tdc = \"180 degC\", bdc = \"110 degC\" }",
    ),
    ("ring_pack_solver", "euler_march", "solver.method=euler_march"),
];

fn diesel() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/turbo-diesel-120.toml")
}

/// Faces that always find oil: a solver of one's own need not follow what lies on the liner.
const FLOODED: &str = "models.oil_transport.model=off";

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("inertia-force.toml")
}

fn run_with(case: &Path, set: &[&str]) -> RunResult {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    let c = check(case, &set).unwrap_or_else(|r| panic!("{set:?}: {r}"));
    run(&c, &mut gudgeon_scene::unwatched).unwrap_or_else(|e| panic!("{set:?}: {e}"))
}

fn refused(case: &Path, set: &str) -> String {
    match check(case, &[set.to_owned()]) {
        Ok(_) => panic!("{set} was accepted"),
        Err(report) => report.diagnostics.iter().map(|d| d.headline()).collect(),
    }
}

#[test]
fn they_are_listed_and_described() {
    let registry = Registry::collect();
    assert_eq!(registry.verify(), Ok(()));
    for (kind, name, _) in MODELS {
        let m = registry.model(kind, name).unwrap_or_else(|| panic!("{kind}/{name}"));
        assert!(!m.summary.is_empty() && !m.equations.is_empty() && m.file.ends_with(&format!("{name}.rs")));
    }
    assert!(
        gudgeon_scene::scenes()
            .iter()
            .any(|s| s.name == "inertia_force" && s.file.ends_with("inertia_force.rs"))
    );
}

#[test]
fn mistakes_are_found_at_their_place() {
    for (set, place) in [
        ("models.gas_flow={ model = \"bernoulli_network\", laminar = 0 }", "laminar"),
        (
            "models.ring_motion={ model = \"lift_and_twist\", modulus = \"1 mm\" }",
            "models.ring_motion.modulus",
        ),
        ("models.film_temperature={ model = \"heat_balance\", tdc = \"180 degC\" }", "missing key `bdc`"),
        ("solver={ method = \"euler_march\", steps_per_degree = 0 }", "at least one step"),
        ("solver={ method = \"euler_march\", tolerance = 1e-3 }", "unknown key `tolerance`"),
    ] {
        let text = refused(&diesel(), set);
        assert!(text.contains(place), "{set}: {text}");
    }
    assert!(refused(&scene(), "engine.rod_length=50 mm").contains("rod"));
}

#[test]
fn they_run_and_are_recorded_and_explained() {
    let plain = run_with(&diesel(), &[FLOODED]);
    let runs = MODELS.map(|(_, _, set)| run_with(&diesel(), &[FLOODED, set]));
    for ((kind, name, set), r) in MODELS.into_iter().zip(&runs) {
        let used = r.models.iter().any(|m| m.kind == kind && m.model == name) || r.solver.method == name;
        assert!(used, "{name}: {:?}", r.models);
        assert!(r.provenance.overrides.iter().any(|o| o == set), "{name}");
        assert_ne!(r.results["blow_by"].value, plain.results["blow_by"].value, "{name}");
        let told = explain(&check(&diesel(), &[FLOODED.to_owned(), set.to_owned()]).expect("valid"))
            .expect("explained");
        assert!(told.to_text().contains(name), "{name}");
    }
    let twist = runs[1].series.get("ring1.twist").expect("a column of the model's own");
    // The gas twists a ring that would stand at 0.1 degrees.
    assert!(twist.values.iter().any(|t| (t.to_degrees() - 0.1).abs() > 0.01));
}

#[test]
fn they_are_compared_with_built_in_ones() {
    for (path, values) in [
        ("models.gas_flow", ["orifice_network", "bernoulli_network"]),
        ("models.ring_motion", ["newton_groove", "lift_and_twist"]),
        ("solver.method", ["implicit", "euler_march"]),
    ] {
        let swaps = [(path.to_owned(), values.map(str::to_owned).into())];
        let c =
            gudgeon_study::compare(&diesel(), &[FLOODED.to_owned()], &swaps, &mut gudgeon_scene::unwatched)
                .unwrap_or_else(|r| panic!("{r}"));
        for v in &c.variants {
            assert!(v.outcome.is_ok(), "{}: {:?}", v.label, v.outcome.as_ref().err());
        }
    }
}

/// What every model of Gudgeon keeps, and what every gas flow does.
#[test]
fn they_keep_the_contract_of_a_model() {
    assert_eq!(gudgeon_testkit::check_crate("extensions"), MODELS.len());
    let (pack, rings) = gudgeon_gas::plain_pack(2);
    let mut gas = BernoulliNetwork::default().build(&GasFlowCtx { pack: &pack }).expect("a plain pack");
    let inp = GasIn { p_cylinder: 40e5, p_crankcase: 1e5, rings: &rings };
    // Flows of the root of a pressure difference: over 1e-5 of the pressure, quotients and derivative differ in the third derivative, 1e-10
    // of them; rounding of pressures that are differences of masses adds 1e-16/1e-5.
    let tolerance = Tolerance { relative: 1e-8, ..Tolerance::default() };
    assert_none(gas_flow(&mut *gas, &inp, &[40e5, 15e5, 1e5], tolerance));
}

/// The film temperature has states and reads them, the power of its films, and nothing else.
#[test]
fn states_are_declared_as_they_are_read() {
    let spec = r#"{ "model": "heat_balance", "tdc": "180 degC", "bdc": "110 degC" }"#;
    let spec: Box<dyn FilmTemperatureSpec> = serde_json::from_str(spec).expect("a specification");
    let ctx = FilmTemperatureCtx::new(&[450.0, 400.0], 0.14).faces(&[2e-3], 0.38, 200.0);
    let mut films = spec.build(&ctx).expect("one film");
    assert_none(stateful(&mut *films));
    let inputs = [
        (Signals::FILM_THICKNESS, 1e-6, 2e-6),
        (Signals::FILM_FORCE, 100.0, 200.0),
        (Signals::AXIAL_VELOCITY, 5.0, 6.0),
        (Signals::TEMPERATURE, 4.0, 4.1),
    ];
    let mut read = |declared| {
        let rates = |x: &[f64], dy: &mut [f64]| {
            films.rates(0, &x[3..], &FilmHeat::new(x[0], x[1], x[2], 0.05), dy).expect("rates");
        };
        reads(declared, &inputs, 1, rates)
    };
    assert_eq!(read(Signals::NONE).len(), 2, "the check sees what is read");
    assert_none(read(Signals::TEMPERATURE | Signals::FILM_FORCE));
    assert_eq!(films.reads(), Signals::TEMPERATURE | Signals::FILM_FORCE);
}

/// A compressible orifice chokes at 0.685 of `C_d A p/√(RT)`, an incompressible one goes on to `√2` of it: gaps and flanks of the same size let more
/// gas by.
#[test]
fn more_gas_goes_by_without_choking() {
    let same = "models.gas_flow={ model = \"bernoulli_network\", discharge = 0.86 }";
    let other = "models.gas_flow.orifice.discharge=0.86";
    let by = |set: &str| run_with(&diesel(), &[set]).results["blow_by"].value;
    let (mine, theirs) = (by(same), by(other));
    assert!(mine > theirs, "{mine} {theirs}");
}

/// What the models declare of their states is what their rates depend on: the Jacobian that follows these declarations agrees with differences
/// of all rates by every state.
#[test]
fn declared_dependencies_are_complete() {
    let mut set: Vec<String> = MODELS[..3].iter().map(|(_, _, set)| (*set).to_owned()).collect();
    // The Jacobian leaves out 0.3 % of how the flow out of land 3 goes with its mass, for any step of the quotient and any coefficient (a cause to be found);
    // with 0.86 that is 1.02 of the slack below.
    set.push("models.gas_flow.discharge=0.65".to_owned());
    let c = check(&diesel(), &set).unwrap_or_else(|r| panic!("{r}"));
    let case = c.of::<RingPackCase>().expect("a ring pack");
    let mut pack = assemble(case, &c.case.source().files).expect("valid");
    let n = pack.layout.n;
    let quads = pack.layout.quads();
    let mut y = vec![0.0; n];
    pack.initial(3e5, &mut y);
    let theta = 6.9;
    let increment = |y: &[f64], k: usize| (y[k] + 1e-7 * y[k].abs().max(1e-3)) - y[k];
    let (mut f, mut g) = (vec![0.0; n + quads], vec![0.0; n + quads]);
    let mut jac = vec![0.0; (n + quads) * n];
    pack.rates(theta, &y, &mut f).expect("rates");
    pack.jacobian(&y, |k| increment(&y, k), &mut jac, &mut Base::default()).expect("a Jacobian");
    let mut worst = 0.0_f64;
    for k in 0..n {
        let (d, keep) = (increment(&y, k), y[k]);
        y[k] += d;
        pack.rates(theta, &y, &mut g).expect("rates");
        y[k] = keep;
        let size = (0..n + quads).map(|r| jac[r * n + k].abs()).fold(0.0, f64::max);
        for r in 0..n + quads {
            let quotient = (g[r] - f[r]) / d;
            let error = (quotient - jac[r * n + k]).abs();
            // Differences of rates that are rounded to 1e-15 of their size over 1e-10 or more, and one-sided quotients of laws whose second
            // derivative is large: a thousandth of the largest entry of the column; a dependency that is not followed misses all of an entry.
            let slack = 1e-3 * size + 1e-4 * f[r].abs();
            worst = worst.max(error / slack);
            assert!(
                error <= slack,
                "row {r}, column {k} ({}): {quotient:e} {:e}",
                pack.layout.states[k].name,
                jac[r * n + k]
            );
        }
    }
    assert!(worst > 0.0, "the quotients are those of another instant");
}

#[test]
fn the_scene_gives_its_closed_form() {
    let r = run_with(&scene(), &[]);
    // At top dead centre the acceleration of a central slider crank is -r ω² (1 + r/l).
    let (radius, rod, omega) = (0.065, 0.22, 2000.0 * std::f64::consts::TAU / 60.0);
    let exact = 1.2 * radius * omega * omega * (1.0 + radius / rod);
    assert!((r.results["force_max"].value / exact - 1.0).abs() < 1e-12);
    assert_eq!(r.models[0].model, "exact_slider_crank");
    let swaps = [("kinematics".to_owned(), vec!["exact_slider_crank".into(), "two_harmonic_series".into()])];
    let c = gudgeon_study::compare(&scene(), &[], &swaps, &mut gudgeon_scene::unwatched)
        .unwrap_or_else(|r| panic!("{r}"));
    assert!(c.variants.iter().all(|v| v.outcome.is_ok()));
}
