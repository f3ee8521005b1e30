use gudgeon_core::kinds::*;
use gudgeon_film::Cavitation;
use gudgeon_film::film_1d::*;

fn solve(
    spec: &dyn Film1dSpec,
    l: &LineProfile,
    mu: f64,
    u: f64,
    p: (f64, f64),
    p_cav: f64,
) -> (Film1dOut, Vec<FilmFront>, Vec<f64>) {
    let mut f = spec.build(&Film1dCtx { x: &l.x }).unwrap();
    let mus = vec![mu; l.panels()];
    let o = f
        .solve(&Film1dIn {
            h_a: &l.h_a,
            h_b: &l.h_b,
            mu: &mus,
            factors: None,
            u,
            ends: [FilmEnd::Flooded { p: p.0 }, FilmEnd::Flooded { p: p.1 }],
            p_cav,
            time: FilmTime::Steady,
        })
        .unwrap();
    let fl = f.field();
    (o, fl.fronts.to_vec(), fl.p.to_vec())
}

#[test]
fn scratch() {
    let c = Complementarity::default();
    let fb = Complementarity { solver: LineSolver::FischerBurmeister, ..Complementarity::default() };
    for n in [1, 2, 10] {
        let l = LineProfile::linear(1.0, 2.0, 1.0, n).unwrap();
        let (o, ..) = solve(&c, &l, 1.0, 1.0, (0.0, 0.0), 0.0);
        println!(
            "{n} W {:e} p {:e} F {:e} pad {:e} xcp {:e}  slope id {:e}",
            o.load - 0.1588830833596718565033927,
            o.p_max - 0.25,
            o.moving_shear - 0.7725887222397812376689285,
            o.fixed_shear - 0.6137056388801093811655358,
            o.centre().unwrap() - 0.5686879121963155355251178,
            o.fixed_shear + o.slope_force - o.moving_shear
        );
    }
    for n in [50, 100, 200, 400, 800, 1600] {
        let l = LineProfile::parabola(1.2e-3, 6e-6 / 0.36e-6, 0.6e-3, 2e-6, n, false).unwrap();
        for s in [&c, &fb] {
            let (o, f, _) = solve(s, &l, 0.01, 10.0, (1e5, 1e5), 0.0);
            println!(
                "ring {n} {:e} F {:e} pmax {:e} q {:e} {:?} err {:e} its {}",
                o.load / 1928.500543377637755942081 - 1.0,
                o.moving_shear / (31.83651283314982372982677 + 7.192262943906510181987812) - 1.0,
                o.p_max / 5153863.278147620133311238 - 1.0,
                o.flux_in / 0.00001189463034543730148282106 - 1.0,
                f.iter().map(|f| f.x - 0.6e-3).collect::<Vec<_>>(),
                o.flux_error,
                o.iterations
            );
        }
    }
    for (u, w, q, xf, fr) in [
        (0.02, 2333.451964244468593322038, 1.073208240076096281398981e-8, 0.0, 1.874671479487971898376998),
        (
            0.05,
            3683.4736333629854863946,
            2.659986602870813397129187e-8,
            0.002554933333871499088896818,
            4.529166997523321203430668,
        ),
        (
            1.0,
            35165.7009797406808120885,
            5.229635023923444976076555e-7,
            0.003611262655813475733708496,
            84.4257934944705684652534,
        ),
    ] {
        for n in [10, 100, 800] {
            let l = LineProfile::pocket(0.01, 1.05e-6, 1e-6, (0.002, 0.005), 1e-6, n).unwrap();
            for s in [&c, &fb] {
                let (o, f, _) = solve(s, &l, 0.01, u, (1e5, 1e5), 0.0);
                println!(
                    "pocket {u} {n} W {:e} q {:e} xf {:e} F {:e} err {:e} its {} {f:?}",
                    o.load / w - 1.0,
                    o.flux_in / q - 1.0,
                    f.last().map_or(0.0, |f| f.x) - xf,
                    o.moving_shear / fr - 1.0,
                    o.flux_error,
                    o.iterations
                );
            }
        }
    }
    let h = Complementarity { cavitation: Cavitation::HalfSommerfeld, ..c.clone() };
    let r = Complementarity { cavitation: Cavitation::SwiftStieber, ..c.clone() };
    for n in [50, 100, 200, 400, 800, 1600] {
        let l = LineProfile::parabola(1.2e-3, 6e-6 / 0.36e-6, 0.6e-3, 2e-6, n, false).unwrap();
        let (o, ..) = solve(&h, &l, 0.01, 10.0, (1e5, 1e5), 0.0);
        print!(
            "half {n} {:e} F {:e} err {:e} fluxes {:e} {:e};  ",
            o.load / 1447.390993439895749413652 - 1.0,
            o.moving_shear / 42.09015468779601701405562 - 1.0,
            o.flux_error,
            o.flux_in,
            o.flux_out
        );
        let (o, ..) = solve(&r, &l, 0.01, 10.0, (1e5, 1e5), 0.0);
        println!(
            "ss {n} {:e} F {:e} err {:e}",
            o.load / 1927.756191321964532466805 - 1.0,
            o.moving_shear / (31.25613705842348964780379 + 7.249148391312546588404298) - 1.0,
            o.flux_error
        );
    }

    let ft = FrontTracking::default();
    let ea = ElrodAdams::default();
    for (u, w, q, xf, fr) in [(0.02, 2333.451964244468593322038, 1.073208240076096281398981e-8, 0.0, 1.874671479487971898376998), (0.05, 3683.4736333629854863946, 2.659986602870813397129187e-8, 0.002554933333871499088896818, 4.529166997523321203430668), (1.0, 35165.7009797406808120885, 5.229635023923444976076555e-7, 0.003611262655813475733708496, 84.4257934944705684652534)] {
            for (n, s) in [(10, &ft as &dyn Film1dSpec), (1, &ft), (800, &ea)] {
                let l = LineProfile::pocket(0.01, 1.05e-6, 1e-6, (0.002, 0.005), 1e-6, n).unwrap();
                let (o, f, _) = solve(s, &l, 0.01, u, (1e5, 1e5), 0.0);
                println!("FT pocket {u} {n} W {:e} q {:e} xf {:e} F {:e} err {:e} its {} {f:?}", o.load / w - 1.0, o.flux_in / q - 1.0, f.last().map_or(0.0, |f| f.x) - xf, o.moving_shear / fr - 1.0, o.flux_error, o.iterations);
            }
    }
    for n in [50, 64, 100, 200, 400, 800, 1600] {
        let l = LineProfile::parabola(1.2e-3, 6e-6 / 0.36e-6, 0.6e-3, 2e-6, n, false).unwrap();
        for s in [&ft as &dyn Film1dSpec, &ea] {
            let (o, f, _) = solve(s, &l, 0.01, 10.0, (1e5, 1e5), 0.0);
            println!("FT ring {n} {:e} F {:e} pmax {:e} q {:e} {:?} err {:e} its {}", o.load / 1928.500543377637755942081 - 1.0, o.moving_shear / (31.83651283314982372982677 + 7.192262943906510181987812) - 1.0, o.p_max / 5153863.278147620133311238 - 1.0, o.flux_in / 0.00001189463034543730148282106 - 1.0, f.iter().map(|f| f.x - 0.6e-3).collect::<Vec<_>>(), o.flux_error, o.iterations);
        }
    }
    let l = LineProfile::textured(0.01, 2e-6, 1e-6, 7, 0.5, 3e-6, 700).unwrap();
    for s in [&ft as &dyn Film1dSpec, &c, &fb, &ea] {
        let (o, f, _) = solve(s, &l, 0.01, 10.0, (1e5, 1e5), 0.0);
        println!("FT textured {:e} F {:e} q {:e} err {:e} its {} {:?}", o.load , o.moving_shear , o.flux_in, o.flux_error, o.iterations, f.iter().map(|f| f.x).collect::<Vec<_>>());
    }
}
