mod common;
use common::*;
#[test]
fn probe() {
    for (n, s) in [("alcohol-1600-3000","1 bar"),("alcohol-1600-4000","6 bar"),("alcohol-1600-4000","1 bar"),("alcohol-1600-5000","6 bar"),("alcohol-1600-5000","1 bar"),("alcohol-1600-5600","1 bar")] {
        let s = format!("solver.starts=[\"{s}\"]");
        let t = std::time::Instant::now();
        let r = run_case(n, &[&s, "solver.cycles=12", "solver.gas_steps=200"]);
        println!("{n} {s} {:?} {:?} {:?}", t.elapsed(), r.solver.notes, r.balance);
        for (k, v) in &r.results { print!(" {k} {:.5};", v.value); }
        println!();
        for (c, a, b) in [("land2.p", 300., 450.), ("land2.p", 450., 720.), ("land3.p", 300., 720.), ("ring1.cumulative_mass", 0., 720.), ("ring2.cumulative_mass", 0., 720.), ("ring3.cumulative_mass", 0., 720.)] {
            println!("   {c} {:?} end {:?}", peak(&r, c, a, b), column(&r, c).last());
        }
        for i in 1..=2 {
            let e = column(&r, &format!("ring{i}.position"));
            let mut line = String::new();
            let mut last = -1.0;
            for (k, v) in e.iter().enumerate() { if *v != last { line += &format!(" {k}:{v}"); last = *v; } }
            println!("   ring{i} {line}");
        }
        for i in 1..=3 {
            let h = format!("ring{i}.h_min");
            print!("   {h}");
            for s in 0..4 { let p = peak(&r, &h, 180.0*f64::from(s), 180.0*f64::from(s+1)); print!(" {:.2}@{}", p.0*1e6, p.1); }
            let c: Vec<f64> = r.series.theta_deg.iter().zip(column(&r,&h)).filter(|(_, v)| **v <= 0.2000001e-6).map(|(t,_)| *t).collect();
            println!(" contact {:?}", c);
        }
    }
}
