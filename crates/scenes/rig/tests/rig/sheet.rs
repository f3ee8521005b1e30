//! Films on a grid: half of a symmetric film, nodes of a map.

use gudgeon_film::film_2d::Multigrid;
use gudgeon_film::{SawtoothWaviness, SmoothSurfaces, WavinessTransport};

use gudgeon_core::kinds::{Film2dGrid, RoughnessSpec};
use gudgeon_scene_rig::sheet::{Conditions, MAPPED, Sheet, drawn};

#[test]
fn half_a_film_is_the_whole() {
    let waves = SawtoothWaviness {
        amplitude: gudgeon_core::quantity::quantity(4e-7),
        transport: WavinessTransport::Homogenised,
        closest: gudgeon_core::quantity::quantity(1.02),
    };
    let spec = Multigrid { tolerance: 1e-12, ..Multigrid::default() };
    let gap = |x: f64, y: f64| 1e-6 * (1.5 + 0.5 * (600.0 * x).cos() + 1e4 * (y - 0.004).powi(2));
    let rate = |x: f64, _: f64| 1e-3 * (300.0 * x).sin();
    let side = 2e5;
    let c = Conditions {
        u: 2.0,
        mu: 0.01,
        p_cav: 3e4,
        edge_pressure: [1e5, 1.5e5, side, side],
        edge_fill: [1.0; 4],
        between: true,
    };
    let period = 4.0 * std::f64::consts::PI / 600.0;
    for grid in [Film2dGrid::uniform(20, 13, 0.01, 0.008), Film2dGrid::journal(20, 13, period, 0.008)] {
        for rough in [&SmoothSurfaces {} as &dyn RoughnessSpec, &waves] {
            let [whole, half] = [false, true].map(|symmetric| {
                let mut sheet = Sheet::new(grid.clone(), symmetric, &spec, rough).expect("builds");
                let film = sheet.solve(&c, &gap, Some(&rate)).expect("solves");
                (sheet.nodes(), film)
            });
            assert_eq!((whole.0, half.0), (20 * 13, 20 * 7));
            let (a, b) = (&whole.1, &half.1);
            // Residuals of 1e-12 and condition numbers of up to a hundred.
            let top = a.out.p_max;
            assert!(a.p.iter().zip(&b.p).all(|(a, b)| (a - b).abs() < 1e-9 * top));
            assert!(a.fill.iter().zip(&b.fill).all(|(a, b)| (a - b).abs() < 1e-9));
            assert!(a.h.iter().zip(&b.h).all(|(a, b)| (a - b).abs() < 1e-9 * a));
            let flows = (0..4).map(|e| (a.out.outflow[e], b.out.outflow[e]));
            let pairs = [
                (a.out.load, b.out.load),
                (a.out.moment_x, b.out.moment_x),
                (a.out.shear_lower, b.out.shear_lower),
                (a.out.shear_upper, b.out.shear_upper),
                (a.out.cavity, b.out.cavity),
                (a.out.storage, b.out.storage),
            ];
            for (a, b) in pairs.into_iter().chain(flows) {
                assert!((a - b).abs() <= 1e-8 * a.abs(), "{a} {b}");
            }
        }
    }
}

#[test]
fn maps_have_both_ends() {
    for n in [2, 3, 128, 129, 130, 500, 2001] {
        let nodes = drawn(n);
        assert!(nodes.len() <= MAPPED + 2 && nodes[0] == 0 && nodes[nodes.len() - 1] == n - 1, "{n}");
        assert!(nodes.windows(2).all(|w| w[0] < w[1]), "{n}");
    }
}
