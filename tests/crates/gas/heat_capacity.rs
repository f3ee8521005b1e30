//! Ratios of specific heats, against tables.

use gudgeon_gas::Gamma;

/// `c_p/R` from the ratio of specific heats.
fn heat_capacity(gas: Gamma, t: f64) -> f64 {
    let gamma = gas.at(t, 1.4);
    gamma / (gamma - 1.0)
}

#[test]
fn air_is_as_in_the_tables() {
    // c_p of dry air [kJ/(kg K)] with R = 0.28706, from tables of ideal-gas properties: 1.005 at 300 K, 1.051 at 600 K, 1.142 at
    // 1000 K, 1.211 at 1500 K, printed to three decimals and differing by up to 0.2 % among each other.
    for (t, cp) in [(300.0, 1.005), (600.0, 1.051), (1000.0, 1.142), (1500.0, 1.211)] {
        let here = 0.28706 * heat_capacity(Gamma::Air, t);
        assert!((here / cp - 1.0).abs() < 2.5e-3, "{t}: {here}");
    }
    for (t, gamma) in [(300.0, 1.401), (600.0, 1.376), (1000.0, 1.336)] {
        // Half a unit of the last digit stated.
        assert!((Gamma::Air.at(t, 1.3) - gamma).abs() < 5.1e-4, "{t}: {}", Gamma::Air.at(t, 1.3));
    }
}

#[test]
fn mixtures_of_tabulated_gases() {
    // Molar c_p [J/(mol K)] of N2, O2, CO2, H2O at 300, 1000 and 2000 K, from the JANAF thermochemical tables; argon has 5/2 R.
    let tables = [
        (300.0, [29.125, 29.385, 37.221, 33.596]),
        (1000.0, [32.697, 34.870, 54.308, 41.268]),
        (2000.0, [35.971, 37.741, 60.350, 51.180]),
    ];
    for (t, [n2, o2, co2, h2o]) in tables {
        let ar = 2.5 * 8.31446;
        let air = 0.7812 * n2 + 0.2095 * o2 + 0.0093 * ar;
        // CH_1.85 + 1.4625 (O2 + 3.7289 N2 + 0.0444 Ar) -> CO2 + 0.925 H2O + 1.4625 (3.7289 N2 + 0.0444 Ar)
        let oxygen = 1.4625;
        let (nitrogen, argon) = (oxygen * 0.7812 / 0.2095, oxygen * 0.0093 / 0.2095);
        let burnt = (co2 + 0.925 * h2o + nitrogen * n2 + argon * ar) / (1.925 + nitrogen + argon);
        for (gas, cp) in [(Gamma::Air, air), (Gamma::BurntGas, burnt)] {
            let here = 8.31446 * heat_capacity(gas, t);
            // The published polynomials differ from these tables by up to 0.17 %, that of nitrogen; and that of water vapour, from newer
            // data, lies 1.1 % higher at 2000 K, where a sixth of the heat capacity of burnt gas is that of water.
            let water = if gas == Gamma::BurntGas && t == 2000.0 { 0.011 / 6.0 } else { 0.0 };
            assert!((here / cp - 1.0).abs() < 2e-3 + water, "{gas:?} {t}: {here} {cp}");
        }
    }
}

#[test]
fn burnt_gas_has_more_degrees_of_freedom() {
    for t in [300.0, 450.0, 900.0, 1200.0, 2500.0] {
        let (air, burnt) = (Gamma::Air.at(t, 1.4), Gamma::BurntGas.at(t, 1.4));
        assert!(burnt < air && burnt > 1.2, "{t}: {air} {burnt}");
    }
    for (t, gamma) in [(300.0, 1.372), (600.0, 1.335), (1000.0, 1.294)] {
        assert!((Gamma::BurntGas.at(t, 1.4) - gamma).abs() < 5.1e-4, "{t}: {}", Gamma::BurntGas.at(t, 1.4));
    }
}

#[test]
fn halves_meet() {
    // The two polynomials of each gas share the value at 1000 K to about seven digits; a slip in one coefficient of nitrogen, oxygen,
    // carbon dioxide or water, each at least a tenth of one of the mixtures, would show.
    for gas in [Gamma::Air, Gamma::BurntGas] {
        let (below, above) = (heat_capacity(gas, 1000.0), heat_capacity(gas, 1000.0f64.next_up()));
        assert!((below / above - 1.0).abs() < 2e-6, "{gas:?}: {below} {above}");
    }
}

#[test]
fn outside_the_range_and_constant() {
    assert_eq!(Gamma::Air.at(10.0, 1.4), Gamma::Air.at(300.0, 1.4));
    assert_eq!(Gamma::Air.at(1e9, 1.4), Gamma::Air.at(3500.0, 1.4));
    assert_eq!(Gamma::Constant.at(1234.0, 1.37), 1.37);
}
