//! What acted over a cycle, and when a ring was off the liner.

use gudgeon_scene_ring_pack::acted::{Acted, Retreats};

#[test]
fn a_retreat_begins_and_ends_where_the_film_passes_the_limit() {
    let mut w = Retreats::default();
    // ln h rises and falls by 1 per 0.1 rad about the limit of 1: from 0.2 to 0.6, most e^2.
    for (k, log) in [-2.0, -1.0, 0.0, 1.0, 2.0, 1.0, 0.0, -1.0].into_iter().enumerate() {
        w.see(0.1 * k as f64, f64::exp(log - 1e-12), 1.0);
    }
    let [r] = w.all[..] else { panic!("{:?}", w.all) };
    // Straight lines in ln h; the limit is passed 1e-13 later than at a sample.
    assert!((r.from - 0.2).abs() < 1e-9 && r.to.is_some_and(|t| (t - 0.6).abs() < 1e-9), "{r:?}");
    assert!((r.most - 2f64.exp()).abs() < 1e-9);
    let note = w.note(2, 4.0, 1.0).expect("left");
    assert_eq!(note.topic, "off_the_liner.ring2");
    assert!((note.amounts["share_of_cycle"].value - 0.1).abs() < 1e-9);
}

#[test]
fn nothing_is_said_of_what_did_not_act() {
    let mut a = Acted::default();
    a.see(0.0, 1.0, 0.5);
    a.see(-1.0, 1.0, 0.5);
    assert!(!a.acted());
    a.see(3.0, 1.0, 0.5);
    a.see(2.0, 2.0, 0.25);
    assert!(a.acted() && a.most == 3.0 && a.at == 1.0 && a.span == 0.75);
}
