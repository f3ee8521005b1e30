//! The load of solid contact along the liner.

use std::f64::consts::PI;

use gudgeon_core::result::{PackSection, SectionRing};
use gudgeon_scene_ring_pack::liner_wear::along;

#[test]
fn a_constant_load_wears_every_place_once_a_pass() {
    // Stroke 0.1 m, bore radius 0.05 m, two rings 10 mm apart with faces of 3 mm, in rows of one degree of a four-stroke cycle. A load w per
    // circumference leaves w a pass, four passes a cycle: p b |v| dt = w dz, whatever the speed.
    let ring = |bottom| SectionRing {
        height: 3e-3,
        width: 4e-3,
        groove_bottom: bottom,
        groove_height: 3e-3,
        groove_depth: 5e-3,
        clearance: 0.0,
        face_drop: vec![0.0, 0.0],
        face_length: 3e-3,
        lands: 1,
    };
    let section = PackSection {
        bore_radius: 0.05,
        stroke: 0.1,
        rings: vec![ring(8e-3), ring(18e-3)],
        ..PackSection::default()
    };
    let omega = 200.0;
    let theta: Vec<f64> = (0..=720).map(f64::from).collect();
    let y: Vec<f64> = theta.iter().map(|t| 0.05 * t.to_radians().cos()).collect();
    let v: Vec<f64> = theta.iter().map(|t| -0.05 * omega * t.to_radians().sin()).collect();
    let around = 2.0 * PI * 0.05;
    let (load, none) = (vec![50.0 * around; 721], vec![0.0; 721]);
    let (depths, wear) = along(&section, omega, &theta, &y, &v, &[Some(&load), Some(&none)]);
    let step = depths[1] - depths[0];
    // The middle of the face of ring 1 goes from 6.5 mm to 106.5 mm.
    for (z, w) in depths.iter().zip(&wear[0]) {
        if (0.012..0.101).contains(z) {
            // Trapezoids of |sin| over rows of a degree miss h²/12 = 2.5e-5 of its way, everywhere.
            assert!((w / 200.0 - 1.0).abs() < 3e-5, "{w} J/m2 at {z} m");
        }
        // Half a face farther, and half a bin.
        let beyond = *z < 0.0065 - 1.5e-3 - 0.5 * step || *z > 0.1065 + 1.5e-3 + 0.5 * step;
        assert!(!beyond || *w == 0.0, "{w} J/m2 at {z} m");
    }
    // Nothing is lost: load times the way of four strokes, but for the same part.
    let total = wear[0].iter().sum::<f64>() * step * around;
    assert!((total / (50.0 * around * 0.4) - 1.0).abs() < 3e-5, "{total} J");
    assert!(wear[1].iter().all(|w| *w == 0.0));
}
