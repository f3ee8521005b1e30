//! Where a cycle is looked at.

use gudgeon_scene_piston_secondary::places::{SAME, angles, places};

#[test]
fn maps_stand_at_their_own_angles_whatever_the_rows_are() {
    let degrees = |step: f64| angles(4.0 * std::f64::consts::PI, step.to_radians());
    for (rows, maps, looks) in
        [(1.0, 5.0, 721), (30.0, 5.0, 145), (7.2, 5.0, 101 + 145 - 5), (0.05, 90.0, 14_401)]
    {
        let (rows, maps) = (degrees(rows), degrees(maps));
        let all = places(&rows, &maps);
        assert_eq!(all.len(), looks);
        assert_eq!(all.iter().filter(|p| p.row).count(), rows.len());
        assert_eq!(all.iter().filter(|p| p.map).count(), maps.len());
        assert!(all.windows(2).all(|w| w[0].theta < w[1].theta - SAME));
    }
    assert!(places(&degrees(1.0), &[]).iter().all(|p| p.row && !p.map));
}
