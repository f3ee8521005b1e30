//! The balance of energy of the gas in a whole ring pack, and the laws of its passages.

use crate::common::{column, run_case, value};

const BALANCE: &str = "models.gas_flow.gas_temperature=energy_balance";

#[test]
fn the_energy_of_the_gas_is_accounted_for() {
    for model in ["orifice_network", "narrow_channel", "namazian_heywood"] {
        let r = run_case("turbo-diesel-120/flooded", &[&format!("models.gas_flow.model={model}"), BALANCE]);
        // What the integration loses, at its tolerance of 1e-4; the greatest, 5e-5, is that of channels without a mouth.
        let open = r.balance.gas_energy.expect("a balance");
        assert!(open < 1e-4, "{model}: {open:e}");
        // The masses stay a linear invariant: roundings of the steps.
        assert!(r.balance.gas_mass.expect("a balance") < 1e-12, "{model}");
        let (land, behind) = (column(&r, "gas.land2.temperature"), column(&r, "gas.ring1.back.temperature"));
        // Gas behind the top ring is compressed with the cylinder and loses its heat to walls at 503 K.
        let most = |t: &[f64]| t.iter().copied().fold(0.0, f64::max);
        assert!(
            most(behind) > 550.0 && most(behind) < 900.0 && most(land) < most(behind),
            "{}",
            most(behind)
        );
    }
}

/// Walls that take heat a thousand times as fast hold the gas at their temperature.
#[test]
fn much_heat_to_the_walls_is_the_model_without_a_balance() {
    let walls = run_case("turbo-diesel-120/flooded", &[]);
    assert!(walls.balance.gas_energy.is_none());
    let r = run_case("turbo-diesel-120/flooded", &[BALANCE, "models.gas_flow.nusselt=1e4"]);
    // The temperature follows within the time that compression takes divided by 1e3; 3e-4 was seen, and each run is good to its tolerance of 1e-4.
    for name in ["blow_by", "land2.p_max", "fmep"] {
        assert!((value(&r, name) / value(&walls, name) - 1.0).abs() < 1e-3, "{name}");
    }
}

#[test]
fn every_law_of_the_passages_closes_its_masses() {
    let auto =
        "models.gas_flow={ model = \"narrow_channel\", mouth = \"automatic\", friction = \"blended\" }";
    let fall = "models.gas_flow={ model = \"orifice_network\", orifice = { discharge = 0.85, discharge_fall = 0.25 } }";
    let laws = ["models.gas_flow.model=labyrinth", "models.gas_flow.model=namazian_heywood", auto, fall];
    let orifices = "models.gas_flow.model=orifice_network";
    let whole = value(&run_case("alcohol-2000-5600/flooded", &[orifices]), "blow_by");
    for law in laws {
        let r = run_case("alcohol-2000-5600/flooded", &[law]);
        // Roundings of the steps.
        assert!(r.balance.gas_mass.expect("a balance") < 1e-12, "{law}");
        let blow_by = value(&r, "blow_by");
        // All laws let less through than isentropic orifices of 0.86.
        assert!(blow_by > 0.4 * whole && blow_by < whole, "{law}: {blow_by} of {whole}");
    }
}
