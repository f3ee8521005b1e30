//! Oil that evaporates, against measured hydrocarbons and the closed forms of still films.

use gudgeon_core::kinds::{Evaporation, EvaporationCtx, EvaporationSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::evaporation::{Fraction, HeatMassAnalogy};
use gudgeon_film::parts::{diffusivity, lewis_number, molar_mass, vapour_pressure};

/// A cylinder of 1.6 l at a mean piston speed of 10 m/s.
const CYLINDER: EvaporationCtx = EvaporationCtx { swept: 1.6e-3, mean_speed: 10.0 };

/// Shares and boiling temperatures \[K\].
fn oil(fractions: &[(f64, f64)]) -> HeatMassAnalogy {
    let fraction =
        |(share, boiling): &(f64, f64)| Fraction { share: quantity(*share), boiling: quantity(*boiling) };
    HeatMassAnalogy { fractions: fractions.iter().map(fraction).collect(), ..HeatMassAnalogy::default() }
}

fn built(spec: &HeatMassAnalogy) -> Box<dyn Evaporation> {
    spec.build(&CYLINDER).unwrap().unwrap()
}

/// Fluxes \[kg/(m² s)\] of the fractions, each alone, from a liner of `temperature` \[K\] under `pressure` \[Pa\].
fn fluxes(oil: &dyn Evaporation, temperature: f64, pressure: f64) -> Vec<f64> {
    let mut volatility = vec![0.0; oil.shares().len()];
    oil.volatility(temperature, &mut volatility);
    volatility.iter().map(|v| v * oil.transfer(pressure)).collect()
}

/// Boiling temperatures of n-hexadecane and n-eicosane under 1 atm \[K\].
const HEXADECANE: f64 = 559.98;
const EICOSANE: f64 = 616.93;

#[test]
fn vapour_pressures_are_those_of_alkanes() {
    for boiling in [500.0, 600.0, 700.0, 800.0] {
        let p = vapour_pressure(boiling, boiling);
        // The middle one of the three laws gives 763 mmHg.
        assert!((p / 101_325.0 - 1.0).abs() < 5e-3, "{boiling} K: {p} Pa");
    }
    // Antoine's law of n-hexadecane, 463 to 560 K (Camin, Forziati and Rossini 1954, in the tables of NIST): log p/bar = 4.17312 - 1845.672/(T - 117.054).
    for t in [463.2, 480.0, 500.0, 530.0, 559.0_f64] {
        let measured = 1e5 * 10_f64.powf(4.173_12 - 1845.672 / (t - 117.054));
        let p = vapour_pressure(HEXADECANE, t);
        // What Maxwell and Bonnell say of the precision of their correlation in this range.
        assert!((p / measured - 1.0).abs() < 0.02, "{t} K: {p} Pa, measured {measured} Pa");
    }
}

/// It rises, but for the 1 % by which the laws miss each other where they meet, and is nothing when cold.
#[test]
fn vapour_pressure_rises_with_temperature() {
    let mut last = vapour_pressure(700.0, 100.0);
    assert!(last < 1e-30, "{last}");
    for k in 1..=400 {
        let p = vapour_pressure(700.0, 100.0 + 2.0 * f64::from(k));
        // 2 K add 3 % or more wherever laws meet.
        assert!(p >= last && p.is_finite(), "{p} after {last}");
        last = p;
    }
}

#[test]
fn molar_masses_and_diffusivities_are_those_of_alkanes() {
    for (boiling, mass) in [(HEXADECANE, 226.45), (EICOSANE, 282.55)] {
        // The correlation is good to half a per cent.
        assert!((1e3 * molar_mass(boiling) / mass - 1.0).abs() < 5e-3);
    }
    // 1e-7 T^1.75 sqrt(1/282.55 + 1/28.97)/(V^(1/3) + 20.1^(1/3))², V = 20 x 16.5 + 42 x 1.98 but for the fourth digit of the number of carbon atoms.
    let volume = 20.0 * 16.5 + 42.0 * 1.98_f64;
    let sum = volume.cbrt() + 20.1_f64.cbrt();
    let want = 1e-7 * 300_f64.powf(1.75) * (1.0 / 282.55 + 1.0 / 28.97_f64).sqrt() / (sum * sum);
    let found = diffusivity(0.28255);
    assert!((found / want - 1.0).abs() < 1e-3, "{found:e} {want:e}");
    assert!((lewis_number(0.28255) * found - 22.5e-6).abs() < 1e-18);
}

/// `h/c_p Le^(-2/3) M/M_gas p_v/p` in another language: h = 130 (0.8e-3)^-0.06 5^0.8 900^-0.4 11.4^0.8 = 333.2428 W/(m² K), c_p = 1150 J/(kg K), Le = 5.5133,
/// M = 282.592 g/mol over 28.97, p_v = 583.5958 Pa over 5 bar.
#[test]
fn the_flux_is_that_of_the_analogy() {
    let j = fluxes(&*built(&oil(&[(1.0, EICOSANE)])), 450.0, 5e5)[0];
    let want = 1.057_168_580_617_401_9e-3;
    // Rounding of some ten powers.
    assert!((j / want - 1.0).abs() < 1e-13, "{j:e} {want:e}");
}

/// Thins `masses` in `steps` equal steps of a whole `exposure`.
fn thinned(oil: &dyn Evaporation, temperature: f64, exposure: f64, steps: u32, masses: &[f64]) -> Vec<f64> {
    let mut volatility = vec![0.0; masses.len()];
    oil.volatility(temperature, &mut volatility);
    let mut left = masses.to_vec();
    for _ in 0..steps {
        oil.thin(&volatility, exposure / f64::from(steps), &mut left);
    }
    left
}

/// A still film of one fraction loses the same mass in equal times, whatever there is.
#[test]
fn a_film_of_one_fraction_thins_evenly() {
    let oil = built(&oil(&[(1.0, 700.0)]));
    let film = 1e-3;
    let mut volatility = [0.0];
    oil.volatility(450.0, &mut volatility);
    // A tenth of the film.
    let exposure = 0.1 * film / volatility[0];
    let lost = |steps| film - thinned(&*oil, 450.0, exposure, steps, &[film])[0];
    for steps in [10, 100, 1000] {
        let off = (lost(steps) / (0.1 * film) - 1.0).abs();
        // Each step loses `1 - exp(-e)` of a film and not `e`, with e = 0.1 to 0.111 of a step: half of that too little.
        assert!(off < 0.06 / f64::from(steps), "{steps} steps: {off:e}");
    }
}

/// A light fraction in an oil that stays is lost exponentially, in one step or many.
#[test]
fn a_light_fraction_decays() {
    let (light, heavy) = (600.0, 990.0);
    let oil = built(&oil(&[(1e-4, light), (0.9999, heavy)]));
    let masses = [1e-7, 0.9999e-3];
    let (t, exposure) = (420.0, 2e-7);
    let mut volatility = [0.0; 2];
    oil.volatility(t, &mut volatility);
    let moles = masses[0] / molar_mass(light) + masses[1] / molar_mass(heavy);
    let rate = volatility[0] * exposure / (molar_mass(light) * moles);
    assert!((0.3..3.0).contains(&rate), "{rate}: neither nothing nor all");
    for steps in [1, 7, 400] {
        let left = thinned(&*oil, t, exposure, steps, &masses);
        // The moles of what goes, 5e-4 of all.
        assert!((left[0] / (masses[0] * (-rate).exp()) - 1.0).abs() < 1e-3, "{steps}");
        assert!((left[1] / masses[1] - 1.0).abs() < 1e-9, "the rest stays");
    }
}

#[test]
fn a_film_gives_no_more_than_it_has() {
    let spec = HeatMassAnalogy::default();
    let oil = built(&spec);
    let masses: Vec<f64> = oil.shares().iter().map(|s| 1e-3 * s).collect();
    for exposure in [1.0, 1e6, f64::MAX] {
        let left = thinned(&*oil, 1500.0, exposure, 3, &masses);
        assert!(left.iter().all(|m| (0.0..1e-9).contains(m)), "{left:?}");
    }
    assert_eq!(thinned(&*oil, 450.0, 1.0, 1, &[0.0; 3]), [0.0; 3], "no film");
    // Cold liners keep their oil: at 0 degC less than 1e-6 of what goes at 180 degC.
    let [cold, hot] = [273.15, 453.15].map(|t| fluxes(&*oil, t, 2e5).iter().sum::<f64>());
    assert!(cold < 1e-5 * hot, "{cold:e} {hot:e}");
}

/// While little goes, twice the vapour pressure takes twice as much.
#[test]
fn twice_the_vapour_pressure_takes_twice_as_much() {
    let oil = built(&oil(&[(1.0, 700.0)]));
    let film = 1e-3;
    let lost = |v: f64| {
        let mut left = [film];
        oil.thin(&[v], 1e-6, &mut left);
        film - left[0]
    };
    // 1e-5 of the film in a step: half of that too little, and a rounding of the film, 1e-11 of what goes.
    let (once, twice) = (lost(1e-2), lost(2e-2));
    assert!((once / 1e-8 - 1.0).abs() < 1e-5 && (twice / once - 2.0).abs() < 2e-5, "{once:e} {twice:e}");
}

#[test]
fn fractions_that_cannot_be_are_refused_with_their_place() {
    let refused = |fractions: &[(f64, f64)]| oil(fractions).build(&CYLINDER).unwrap_err();
    let e = refused(&[(0.5, 700.0), (0.4, 750.0)]);
    assert_eq!(e.field, "fractions");
    assert!(e.to_string().contains("0.9"), "{e}");
    assert_eq!(refused(&[]).field, "fractions");
    for boiling in [200.0, 1200.0] {
        assert_eq!(refused(&[(0.5, 700.0), (0.5, boiling)]).field, "fractions.1.boiling");
    }
    // Shares of a rounded table are parts of their sum.
    let thirds = built(&oil(&[(0.3333, 650.0), (0.3333, 700.0), (0.3333, 750.0)]));
    assert!((thirds.shares().iter().sum::<f64>() - 1.0).abs() < 1e-15);
}
