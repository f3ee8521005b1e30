//! What one side of a running face holds.

use gudgeon_core::geometry::FaceProfile;
use gudgeon_film::parts::{SIDES, Side};

const LENGTH: f64 = 1.2e-3;

fn parabola(curvature: f64, apex: f64) -> FaceProfile {
    FaceProfile::Parabola { length: LENGTH, curvature, apex }
}

/// Faces whose narrowest place is within, at an edge, in the middle of a flat part, and one that rises again.
fn faces() -> Vec<FaceProfile> {
    vec![
        parabola(15.0, 0.3e-3),
        parabola(15.0, -0.4e-3),
        parabola(15.0, 1.5e-3),
        parabola(0.0, 0.5e-3),
        FaceProfile::Taper { length: LENGTH, land: 0.3e-3, drop: 5e-6 },
        FaceProfile::Table { length: LENGTH, drops: vec![4e-6, 1e-6, 0.0, 2e-6, 9e-6] },
        FaceProfile::Table { length: LENGTH, drops: vec![3e-6, 6e-6, 0.0, 0.0, 4e-6, 1e-6] },
        FaceProfile::Table { length: LENGTH, drops: vec![0.0, 5e-6] },
    ]
}

/// The volume under a face is the integral of film and drop, also where the narrowest place is an edge and no apex.
#[test]
fn a_volume_is_the_integral_of_the_gap() {
    let h = 1.5e-6;
    for profile in &faces() {
        for k in 0..SIDES {
            let side = Side::new(profile, k);
            let sign = if k == 0 { -1.0 } else { 1.0 };
            for part in [0.25, 0.5, 1.0] {
                let t = part * side.span;
                // Simpson's rule, exact for parabolas, over intervals of which the kinks of these faces are ends.
                let n = 420;
                let gap = |k: f64| h + profile.drop_at(profile.narrowest() + sign * t * k / f64::from(n));
                let panel =
                    |k: i32| gap(f64::from(k)) + 4.0 * gap(f64::from(k) + 0.5) + gap(f64::from(k + 1));
                let want = t / f64::from(6 * n) * (0..n).map(panel).sum::<f64>();
                let held = side.held(h, t);
                // Rounding of the sum of 420 panels.
                assert!((held - want).abs() <= 5e-14 * want, "{profile:?} {k} {part}: {held:e} {want:e}");
                let drop = profile.drop_at(profile.narrowest() + sign * t);
                // Rounding of a place of 1 mm on a slope of 0.02.
                assert!((side.drop_at(t) - drop).abs() <= 1e-20, "{profile:?} {k} {part}");
            }
            assert_eq!(side.capacity(h), side.held(h, side.span));
        }
    }
}

/// Random numbers between 0 and 1, the same in every run.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// A random face: of each kind, some with the narrowest place at an edge.
fn random_face(seed: &mut u64) -> FaceProfile {
    let mut within = |lo: f64, hi: f64| lo + (hi - lo) * random(seed);
    let kind = within(0.0, 4.0) as usize;
    match kind {
        0 => parabola(10.0_f64.powf(within(-3.0, 4.0)), within(0.0, LENGTH)),
        1 => parabola(10.0_f64.powf(within(-3.0, 4.0)), LENGTH * within(-5.0, 6.0)),
        2 => {
            let land = LENGTH * within(0.01, 0.99);
            FaceProfile::Taper { length: LENGTH, land, drop: 10.0_f64.powf(within(-8.0, -4.0)) }
        }
        _ => {
            let n = within(2.0, 12.0) as usize;
            let mut drops: Vec<f64> = (0..n).map(|_| within(0.0, 20e-6)).collect();
            let low = drops.iter().copied().fold(f64::INFINITY, f64::min);
            drops.iter_mut().for_each(|d| *d -= low);
            FaceProfile::Table { length: LENGTH, drops }
        }
    }
}

/// The distance that holds a volume, by bisection down to neighbouring numbers.
fn bisected(side: &Side, h: f64, volume: f64) -> f64 {
    let (mut lo, mut hi) = (0.0, side.span);
    for _ in 0..1100 {
        let mid = 0.5 * (lo + hi);
        if mid <= lo || mid >= hi {
            break;
        }
        if side.held(h, mid) < volume { lo = mid } else { hi = mid }
    }
    0.5 * (lo + hi)
}

#[test]
fn a_distance_is_that_of_bisection_for_all_faces_films_and_volumes() {
    let mut seed = 7;
    let mut asked = 0;
    for _ in 0..20_000 {
        let profile = random_face(&mut seed);
        let h = 10.0_f64.powf(-9.0 + 5.0 * random(&mut seed));
        for k in 0..SIDES {
            let side = Side::new(&profile, k);
            // From a millionth of a millionth of what there is room for up to all but a rounding of it.
            let part =
                if random(&mut seed) < 0.1 { 1.0 - 1e-15 } else { 10.0_f64.powf(-12.0 * random(&mut seed)) };
            let volume = part * side.capacity(h);
            if volume <= 0.0 || volume >= side.capacity(h) {
                continue;
            }
            asked += 1;
            let (got, want) = (side.distance(h, volume), bisected(&side, h, volume));
            // Ten roundings of each. Where a table has a higher drop before a narrow gap, a rounding of the volume is as many more of the distance.
            let amplified = volume / (got * (h + side.drop_at(got)));
            let allowed = 1e-13 * amplified.max(1.0) * want;
            assert!((got - want).abs() <= allowed, "{profile:?} {k} {h:e} {part:e}: {got:e} {want:e}");
        }
    }
    assert!(asked > 30_000, "{asked}");
}
