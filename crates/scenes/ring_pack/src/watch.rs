//! What floors, caps and drags did over the reported cycle, and the ways of rings that left the liner.

use std::f64::consts::PI;

use gudgeon_core::result::{Event, Note};

use super::acted::{Acted, Retreats};
use super::error::RingPackError;
use super::instant::SeatLog;
use super::pack::Pack;
use gudgeon_scene::RunError;

/// One ring.
#[derive(Debug, Clone, Default)]
struct RingWatch {
    /// Residual load on the least film, or on the floor of a contact model \[N\].
    floor: Acted,
    /// Film thickness where that was most \[m\].
    floor_film: f64,
    /// Overlap of the mean planes \[m\].
    overlap: Acted,
    /// How much thinner than flow factors go the film is \[m\].
    factors: Acted,
    /// Load that the drag took \[N\].
    drag: Acted,
    /// Load that the drag of surfaces in contact took \[N\].
    contact_drag: Acted,
    /// Part of the velocity that the cap took.
    slowed: Acted,
    /// Load given to a film that has none \[N\].
    lifted: Acted,
    /// Load that the end of a search interval took \[N\].
    thickest: Acted,
    /// Load of a ring that has neither film nor contact \[N\].
    uncarried: Acted,
    retreats: Retreats,
}

/// The watch over one cycle.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    rings: Vec<RingWatch>,
}

/// Parts of a load or of a velocity below which nothing is said to have acted: what smooth limits leave far from themselves.
const COUNTS: f64 = 1e-3;

impl Watch {
    /// Begins a cycle with nothing seen.
    #[must_use]
    pub fn new(pack: &mut Pack) -> Self {
        pack.seat_log.iter_mut().for_each(SeatLog::clear);
        Self { rings: vec![RingWatch::default(); if pack.plan.film { pack.n_rings() } else { 0 }] }
    }

    /// Looks at the instant of `pack`, which stands for `weight` \[rad\].
    pub fn look(&mut self, pack: &Pack, weight: f64) {
        let (theta, away) = (pack.at.theta, pack.limits.off_the_liner);
        for (i, w) in self.rings.iter_mut().enumerate() {
            let (r, place) = (&pack.at.rings[i], &pack.at.places[i]);
            let circumference = 2.0 * PI * place.r_outer * pack.geo.rings[i].rails as f64;
            let l = r.limited;
            let (floor, drag, contact_drag) = (l.floor, l.drag, l.contact_drag);
            let (slowed, lifted, thickest) = (l.slowed, l.lifted, l.thickest);
            let tells =
                |load: f64, of: f64| if load > COUNTS * of.abs() { load * circumference } else { 0.0 };
            let before = w.floor.most;
            w.floor.see(tells(floor, r.load), theta, weight);
            if w.floor.most > before {
                w.floor_film = place.h;
            }
            let line = &pack.rings[i].contact;
            if line.open {
                w.overlap.see(line.overlap(place.h), theta, weight);
            }
            if let Some(end) = pack.rings[i].factors_end {
                w.factors.see(end - place.h, theta, weight);
            }
            w.drag.see(tells(drag, r.load), theta, weight);
            w.contact_drag.see(tells(contact_drag, r.load), theta, weight);
            w.slowed.see(if slowed > COUNTS { slowed } else { 0.0 }, theta, weight);
            w.lifted.see(tells(lifted, pack.tension(i)), theta, weight);
            w.thickest.see(tells(thickest, r.load), theta, weight);
            if !pack.rings[i].carries() {
                w.uncarried.see(r.load.max(0.0) * circumference, theta, weight);
            }
            w.retreats.see(theta, place.h, away);
        }
    }

    /// The first ring that rests on next to nothing, as an error.
    ///
    /// # Errors
    /// When there is one.
    pub fn carried(&self, pack: &Pack) -> Result<(), RunError> {
        for (i, w) in self.rings.iter().enumerate() {
            if w.floor.acted() && pack.rings[i].contact.floor.is_none() {
                return Err(RunError::scene(RingPackError::NothingCarries {
                    ring: i + 1,
                    theta_deg: w.floor.at.to_degrees(),
                    load: w.floor.most,
                    film_nm: w.floor_film * 1e9,
                }));
            }
        }
        Ok(())
    }

    /// What acted, with how much and for how long.
    #[must_use]
    pub fn notes(&self, pack: &Pack) -> Vec<Note> {
        let period = pack.period();
        let mut notes = Vec::new();
        for (i, w) in self.rings.iter().enumerate() {
            let ring = i + 1;
            let mut tell = |topic: &str,
                            a: &Acted,
                            name: &str,
                            unit: &str,
                            scale: f64,
                            what: &dyn Fn(&str) -> String| {
                if a.acted() {
                    let share = (a.span / period).min(1.0);
                    let when = format!(
                        "over {:.2} % of the cycle (most at {:.1} deg)",
                        100.0 * share,
                        a.at.to_degrees()
                    );
                    let note = Note::caution(format!("{topic}.ring{ring}"), what(&when));
                    let note = if NUMERICAL.contains(&topic) { note.of_numerics() } else { note };
                    notes.push(note.amount(name, a.most * scale, unit).amount("share_of_cycle", share, "1"));
                }
            };
            tell("contact_floor", &w.floor, "residual_load", "N", 1.0, &|when| {
                format!(
                    "the floor of the contact model at {:.3} um carries up to {:.4} N of ring {ring} {when}",
                    w.floor_film * 1e6,
                    w.floor.most
                )
            });
            tell("flow_factors", &w.factors, "below_their_end", "um", 1e6, &|when| {
                format!(
                    "the film of ring {ring} is up to {:.3} um thinner than the flow factors of its roughness go {when}: they are held at those of the thinnest film",
                    w.factors.most * 1e6
                )
            });
            tell("overlap", &w.overlap, "overlap", "um", 1e6, &|when| {
                format!(
                    "the mean planes of ring {ring} and liner overlap by up to {:.3} um {when}: elastic contact of roughness no longer describes surfaces there",
                    w.overlap.most * 1e6
                )
            });
            tell("radial_drag", &w.drag, "drag", "N", 1.0, &|when| {
                format!(
                    "`solver.limits.radial_drag` stands for the inertia of ring {ring}, up to {:.4} N, {when}",
                    w.drag.most
                )
            });
            tell("contact_drag", &w.contact_drag, "drag", "N", 1.0, &|when| {
                format!(
                    "`solver.limits.contact_drag` takes up to {:.4} N of the load of ring {ring}, as its contact gives way, {when}; drags of 1e3 to 1e5 Pa s change the friction of a pack by some 1e-4 of itself",
                    w.contact_drag.most
                )
            });
            tell("radial_speed", &w.slowed, "part_of_velocity", "1", 1.0, &|when| {
                format!(
                    "`solver.limits.radial_speed` takes up to {:.2} % of the radial velocity of ring {ring} {when}",
                    100.0 * w.slowed.most
                )
            });
            tell("min_load", &w.lifted, "load", "N", 1.0, &|when| {
                format!(
                    "`solver.limits.min_load` adds up to {:.3e} N to the load of the film of ring {ring} {when}: gas or contact presses the ring off",
                    w.lifted.most
                )
            });
            tell("thickest_film", &w.thickest, "residual_load", "N", 1.0, &|when| {
                format!(
                    "`solver.limits.thickest_film` holds ring {ring} against up to {:.4} N {when}",
                    w.thickest.most
                )
            });
            notes.extend(w.nothing_carries(ring, pack.plan.film_wanted));
            notes.extend(w.retreats.note(ring, period, pack.limits.off_the_liner));
        }
        notes.extend(pack.seat_log.iter().enumerate().filter_map(|(i, l)| chatter(i + 1, l)));
        notes
    }

    /// Leaving and coming back as events.
    #[must_use]
    pub fn events(&self) -> Vec<Event> {
        let mut events = Vec::new();
        for (i, w) in self.rings.iter().enumerate() {
            for r in &w.retreats.all {
                let mut add = |theta: f64, what: String| {
                    events.push(Event {
                        theta_deg: theta.to_degrees(),
                        subject: format!("ring{}", i + 1),
                        what,
                    });
                };
                add(r.from, format!("leaves the liner, by up to {:.4} mm", 1e3 * r.most));
                if let Some(to) = r.to {
                    add(to, format!("is back on the liner after {:.1} deg", (to - r.from).to_degrees()));
                }
            }
        }
        events
    }
}

/// Topics of drags that stand for no physics of the ring: what they take of a load that the film hardly has. (`min_load` is none of them: gas presses the
/// ring off.)
const NUMERICAL: [&str; 3] = ["radial_drag", "contact_drag", "radial_speed"];

/// Seats that are taken back as soon as they are taken.
fn chatter(ring: usize, log: &SeatLog) -> Option<Note> {
    (log.reversals > 0).then(|| {
        let text = format!(
            "the very next decision takes back {} of {} changes of seat of ring {ring}: its seat moves the pressures that the decision is made from, and the ring \
             would float between its flanks, which a model with decided seats cannot say",
            log.reversals, log.changes
        );
        Note::caution(format!("seat_chatter.ring{ring}"), text)
            .amount("reversals", f64::from(log.reversals), "1")
            .amount("seat_changes", f64::from(log.changes), "1")
    })
}

impl RingWatch {
    /// A ring without film and contact keeps the film it starts with: results of films are then none, and what depends on them is told.
    fn nothing_carries(&self, ring: usize, wanted: bool) -> Option<Note> {
        let a = self.uncarried;
        a.acted().then(|| {
            let text = format!(
                "nothing carries ring {ring} against the liner, up to {:.4} N (at {:.1} deg): `hydrodynamics` and `contact` are both off, so the ring keeps the \
                 film it starts with, and neither its film nor its friction is computed. Give it one of the two, or ask only for results of gas and of axial \
                 motion (`outputs.results`)",
                a.most,
                a.at.to_degrees()
            );
            let note = if wanted { Note::failure } else { Note::caution };
            note(format!("nothing_carries.ring{ring}"), text).amount("load", a.most, "N")
        })
    }
}
