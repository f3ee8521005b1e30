mod common;
use common::*;
#[test]
fn probe() {
    let case = std::env::var("CASE").unwrap();
    let sets = std::env::var("SETS").unwrap_or_default();
    let sets: Vec<&str> = sets.split(';').filter(|s| !s.is_empty()).collect();
    let t = std::time::Instant::now();
    match try_run(&case, &sets) {
        Ok(r) => {
            println!("{case} {sets:?} {:?}", t.elapsed());
            let f = std::env::var("F").unwrap_or("blow_by_per_cylinder,land2.p_max".into());
            for (k, v) in &r.results {
                if f == "all" || f.split(',').any(|x| x == k) {
                    println!("  {k} {:?} {}", v.value, v.unit);
                }
            }
            println!("  {:?}\n  {:?}\n  {:?}\n  {:?}", r.solver, r.balance, r.seconds, r.skipped);
            for b in &r.branches {
                println!(
                    "  branch {} {} {} {}",
                    b.start, b.period, b.results["land2.p_max"].value, b.results["blow_by"].value
                );
            }
            if let Ok(cols) = std::env::var("COLS") {
                let range: Vec<f64> = std::env::var("RANGE")
                    .unwrap_or("0,720".into())
                    .split(',')
                    .map(|x| x.parse().unwrap())
                    .collect();
                println!("theta {cols}");
                for (k, th) in r.series.theta_deg.iter().enumerate() {
                    if *th < range[0] || *th > range[1] {
                        continue;
                    }
                    print!("{th}");
                    for c in cols.split(',') {
                        print!(" {:.5e}", column(&r, c)[k]);
                    }
                    println!();
                }
            }
        }
        Err(e) => println!("{case} {sets:?} {:?} ERR {e}", t.elapsed()),
    }
}
