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
            for (k, v) in &r.results { if f == "all" || f.split(',').any(|x| x == k) { println!("  {k} {:?} {}", v.value, v.unit); } }
            println!("  {:?}\n  {:?}\n  {:?}", r.solver, r.balance, r.seconds);
        }
        Err(e) => println!("{case} {sets:?} {:?} ERR {e}", t.elapsed()),
    }
}
