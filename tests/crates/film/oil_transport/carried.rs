//! Oil on the liner and under the faces.

use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{
    EvaporationCtx, EvaporationSpec, FilmTemperatureCtx, FilmTemperatureSpec, OilDrive, OilFacePlace,
    OilLand, OilStep, OilTransport, OilTransportCtx, Volatile,
};
use gudgeon_core::quantity::quantity;
use gudgeon_core::states::Stateful;
use gudgeon_film::LinerLinear;
use gudgeon_film::evaporation::HeatMassAnalogy;
use gudgeon_film::parts::{Carried, GaussianGap, Law};
use gudgeon_film::parts::{MIN_REACH, SIDES, WAVE_SLOPE};

/// Share of the circumference that an end gap leaves open.
const GAP: f64 = 1e-3;

fn pack() -> Carried {
    with(None)
}

/// The same on a liner of `temperature` \[K\], from which it evaporates.
fn drying(temperature: f64) -> Carried {
    let liner = LinerLinear { tdc: quantity(temperature), bdc: quantity(temperature) };
    let temperature = liner.build(&FilmTemperatureCtx::new(&[400.0; 3], 0.1)).unwrap();
    let model = HeatMassAnalogy::default().build(&EvaporationCtx { swept: 1e-3, mean_speed: 10.0 });
    let model = model.unwrap().unwrap();
    with(Some(Volatile { model: &*model, temperature: &*temperature, top: 0.11 }))
}

fn with(volatile: Option<Volatile<'_>>) -> Carried {
    let barrel = FaceProfile::Parabola { length: 1.2e-3, curvature: 15.0, apex: 0.5e-3 };
    let table = FaceProfile::Table { length: 0.8e-3, drops: vec![3e-6, 0.0, 0.0, 2e-6] };
    let place = |ring, profile: &FaceProfile, offset, clearance| OilFacePlace {
        ring,
        land: 0,
        profile: profile.clone(),
        offset,
        clearance,
    };
    let law = Law {
        supply: 5e-6,
        split: 0.5,
        roughness: 0.0,
        mean_gap: GaussianGap::new(),
        wave: 50e-6,
        spacing: 0.2e-3,
        initial: 1e-6,
        density: 850.0,
    };
    let faces = [place(0, &barrel, 8e-3, [Some(0.2e-3); 2]), place(1, &table, 0.0, [None, Some(0.2e-3)])];
    let land = |height, drained| OilLand { height, gap: GAP, drained };
    let lands = [land(8e-3, false), land(6e-3, true)];
    Carried::new(
        law,
        &OilTransportCtx { faces: &faces, lands: &lands, pin: (0.0, 0.1), omega: 1.0, volatile },
    )
}

fn begin(p: &mut Carried, y: &[f64]) {
    let mut field = vec![0.0; p.carried()];
    p.field(&mut field);
    p.begin_cycle(y, &field, 0.1);
}

/// A step of 0.1 ms under films of 2 um, with a piston that is thrown up in the upper half of its way and down in the lower one.
fn book(p: &mut Carried, y0: &[f64], y1: &[f64], pin: f64) {
    let drive = OilDrive {
        dt: 1e-4,
        acceleration: 4e4 * (0.05 - pin),
        viscosity: &[5e-3, 8e-3],
        pressures: &[20e5, 3e5, 1e5],
    };
    p.book(&OilStep { y0, y1, pin, films: &[2e-6; 2], drive });
}

#[test]
fn a_reach_holds_its_volume() {
    let mut p = pack();
    for k in 0..2 {
        for side in 0..SIDES {
            let h = 1.3e-6;
            let full = p.faces[k].capacity(h, side);
            for part in [0.1, 0.5, 0.99] {
                p.faces[k].volume[side] = part * full;
                let r = p.faces[k].reach_of(h, side);
                // Joined to the least reach without a corner, and not beyond the edge.
                let least = (MIN_REACH * p.faces[k].length).min(p.faces[k].span(side));
                if r.length >= p.faces[k].span(side) {
                    continue;
                }
                let t = (r.length * r.length - least * least).sqrt();
                let held = p.faces[k].held(h, t, side);
                // Newton's method ends where the length no longer changes by a rounding; the difference of squares loses a digit or two.
                assert!((held - part * full).abs() <= 1e-13 * full, "{k} {side} {part}");
                let gap = h + p.faces[k].drop_at(r.length, side);
                assert_eq!(r.gap, gap);
            }
            p.faces[k].volume[side] = full + 2e-9;
            let r = p.faces[k].reach_of(h, side);
            assert_eq!(r.length, p.faces[k].span(side));
            let edge = h + p.faces[k].drop_at(r.length, side);
            let wave = 0.5 * (r.gap * r.gap - edge * edge) / WAVE_SLOPE;
            assert!((wave - 2e-9).abs() < 1e-20, "{wave:e}");
        }
    }
}

#[test]
fn a_volume_under_a_table_is_that_of_its_trapezoids() {
    let p = pack();
    // From the middle of the flat bottom, 0.4 mm, to the bottom edge: 0.1333 mm flat, then a triangle of 3 um by 0.2667 mm.
    let v = p.faces[1].held(1e-6, 0.4e-3, 0);
    let exact = 1e-6 * 0.4e-3 + 0.5 * 3e-6 * (0.8e-3 / 3.0);
    assert!((v - exact).abs() <= 1e-14 * exact);
}

/// Eight strokes up and down by odd steps of at most 3 mm, with faces that lose what they are told to lose: the part of the oil taken up that is not accounted for.
fn unaccounted(p: &mut Carried) -> f64 {
    unaccounted_by(p, 3e-3)
}

/// The same by steps of at most `way` [m].
fn unaccounted_by(p: &mut Carried, way: f64) -> f64 {
    let mut y = vec![0.0; p.states().len()];
    p.first(&[2e-6; 2], &mut y);
    begin(p, &y);
    let before = p.total(&y);
    let supplied = p.ledger().supplied;
    let mut pin: f64 = 0.1;
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f64 / (1u64 << 24) as f64
    };
    for stroke in 0..8 {
        let down = stroke % 2 == 0;
        loop {
            let next = (pin + (random() + 0.01) * if down { -way } else { way }).clamp(0.0, 0.1);
            let y0 = y.clone();
            for k in 0..2 {
                // Moves oil through the face and loses some.
                y[2 * k] += 0.01 * (random() - 0.5);
                y[2 * k + 1] -= 0.02 * random();
            }
            book(p, &y0, &y, next);
            pin = next;
            if pin <= 0.0 || pin >= 0.1 {
                break;
            }
        }
    }
    p.settle();
    let l = p.ledger();
    assert!(l.taken > 1e-7, "the faces took up {:e}", l.taken);
    assert!(p.liner.film.iter().all(|h| *h >= 0.0));
    (l.gained() - supplied - (p.total(&y) - before)) / l.taken
}

#[test]
fn nothing_is_gained_or_lost() {
    let mut p = pack();
    let closure = unaccounted(&mut p);
    // A few hundred steps of additions, each exact to rounding.
    assert!(closure.abs() <= 1e-12, "{closure:e}");
    assert_eq!(p.ledger().evaporated, 0.0);
}

/// A step of 40 mm, over which a face goes on over what the one before it has left in it, 6.4 mm behind.
#[test]
fn nothing_is_gained_or_lost_over_long_steps() {
    let closure = unaccounted_by(&mut pack(), 40e-3);
    // Some fifty steps of additions, each exact to rounding.
    assert!(closure.abs() <= 1e-12, "{closure:e}");
}

/// What a face takes up of the film that the one before it leaves in the same step, as its stages see it and as it is booked.
#[test]
fn a_face_takes_up_what_is_left_before_it_in_the_same_step() {
    let mut p = pack();
    let mut y = vec![5.0; p.states().len()];
    p.liner.film.fill(0.0);
    begin(&mut p, &y);
    // Down by 20 mm: the lower face leaves a film of 1 um on its way, of which the upper one has come over all but what lies between them.
    let (way, gap) = (20e-3, p.faces[0].edge[0] - p.faces[1].edge[1]);
    let y0 = y.clone();
    y[2] -= 1e-6 * way / p.unit(1);
    let at_rest = p.faces[0].taken[0] + y[0] * p.unit(0);
    p.place(&y, 0.1 - way);
    let seen = p.faces[0].volume[0] - at_rest;
    book(&mut p, &y0, &y, 0.1 - way);
    let booked = p.faces[0].taken[0];
    let want = (1.0 - GAP) * 1e-6 * (way - gap);
    assert!((seen - want).abs() <= 1e-12 * want, "{seen:e} of {want:e}");
    // Where the way of the lower face began, its film shares a cell with the bare liner.
    assert!((booked - want).abs() <= 1e-6 * p.liner.cell, "{booked:e} of {want:e}");
}

/// The same while it evaporates, from liners that lose a little and that dry up. What is missing is vapour, and no more than was laid bare.
#[test]
fn vapour_is_accounted_for() {
    let [(little, dry_none), (much, dry_some), (most, dry_all), (all, _)] = [400.0, 600.0, 900.0, 1200.0]
        .map(|t| {
            let mut p = drying(t);
            let closure = unaccounted(&mut p);
            // As above; films thin in hundreds of cells a step, each to rounding.
            assert!(closure.abs() <= 1e-12, "{t} K: {closure:e}");
            (p.ledger().evaporated, OilTransport::dried(&p))
        });
    assert!(0.0 < little && little < 0.1 * much && much < most, "{little:e} {much:e} {most:e}");
    // When the first step takes all of it, a hotter liner takes no more, but for what ring 1 has just laid in the cell of its edge.
    assert!((all / most - 1.0).abs() < 0.02, "{most:e} {all:e}");
    // At 400 K where the faces of this test left nothing, at 900 K all of the way of ring 1, 100 mm, but for cells cut by its ends.
    assert!(dry_none < 0.5 * dry_some && dry_some <= dry_all, "{dry_none} {dry_some} {dry_all} m");
    assert!((0.099..=0.1001).contains(&dry_all), "{dry_all} m");
}

/// What no ring reaches is dry from the start where it would only dry up, which takes many cycles.
#[test]
fn above_the_rings_a_liner_that_dries_is_dry() {
    let films = |mut p: Carried| {
        let mut y = vec![0.0; p.states().len()];
        p.first(&[2e-6; 2], &mut y);
        let top = p.faces[0].edges(0.1)[1];
        let (z, film) = OilTransport::liner(&p);
        let above: f64 = z.iter().zip(&film).filter(|(z, _)| **z > top + 0.2e-3).map(|(_, h)| h).sum();
        (above, film[0])
    };
    assert_eq!(films(drying(430.0)), (0.0, 1e-6));
    assert!(films(pack()).0 > 0.0);
}

/// What is added up from the lowest cell that changed is the sum over all, and the crankcase wets every cell below the pack.
#[test]
fn the_liner_below_a_height_holds_the_sum_of_its_cells() {
    for mut p in [pack(), drying(400.0)] {
        let mut y = vec![5.0; p.states().len()];
        begin(&mut p, &y);
        for _ in 0..3 {
            strokes(&mut p, &mut y);
            let mut sum = 0.0;
            let lowest = p.faces[1].edge[0];
            for k in 0..p.liner.film.len() {
                let (low, high) = p.liner.ends(k);
                let middle = sum + 0.5 * p.liner.cell * p.liner.film[k];
                let got = p.liner.below(0.5 * (low + high));
                // The place of the middle of a cell is rounded in a liner of a few hundred.
                assert!((got - middle).abs() <= 1e-12 * middle, "{k}: {got:e} {middle:e}");
                sum += p.liner.cell * p.liner.film[k];
                assert!(low > lowest || p.liner.film[k] == 5e-6, "{k}");
            }
            let edges = p.faces[0].edge.map(|z| p.liner.below(z));
            assert_eq!(p.faces[0].below, edges);
        }
    }
}

/// A film that an edge lays down in several steps is what another takes up in others.
#[test]
fn what_is_laid_down_is_taken_up() {
    let mut p = pack();
    let mut y = vec![5.0; p.states().len()];
    p.liner.film.fill(0.0);
    begin(&mut p, &y);
    // Down to 60 mm in uneven steps, the upper face losing 2 units of volume for every mm.
    let unit = p.unit(0);
    let mut pin: f64 = 0.1;
    let mut lost = 0.0;
    for d in [0.3e-3, 1.1e-3, 0.05e-3, 2.0e-3, 3.3e-3, 0.7e-3].into_iter().cycle() {
        let next = (pin - d).max(0.06);
        let y0 = y.clone();
        y[1] -= 2.0 * (pin - next) / 1e-3;
        lost += 2.0 * (pin - next) / 1e-3 * unit;
        book(&mut p, &y0, &y, next);
        pin = next;
        if pin <= 0.06 {
            break;
        }
    }
    let taken = p.faces[0].taken[1];
    let (y0, y1) = (y.clone(), y.clone());
    book(&mut p, &y0, &y1, 0.1);
    let back = p.faces[0].taken[1] - taken;
    // Some forty cells added up. What lies before the end gap passes it, onto the land below.
    let (face, gap) = ((1.0 - GAP) * lost, GAP * lost);
    assert!((back - face).abs() <= 1e-12 * lost, "{back:e} of {lost:e}");
    let passed = OilTransport::passed(&p, 0).down;
    assert!((passed - gap).abs() <= 1e-12 * lost, "{passed:e} of {gap:e}");
}

#[test]
fn the_film_on_the_liner_stands_at_the_middle_of_its_cells() {
    let p = pack();
    let (z, film) = OilTransport::liner(&p);
    assert_eq!((z.len(), &film), (p.liner.film.len(), &p.liner.film));
    for (k, z) in z.iter().enumerate() {
        let (low, high) = p.liner.ends(k);
        // A few roundings of a liner of 0.1 m.
        assert!((z - 0.5 * (low + high)).abs() < 1e-16, "{k}");
    }
}

#[test]
fn volumes_of_the_last_instant_are_remembered() {
    let mut p = pack();
    let mut y = vec![5.0; p.states().len()];
    begin(&mut p, &y);
    p.place(&y, 0.1);
    let want: Vec<f64> = p.faces.iter().flat_map(|f| f.volume).collect();
    assert!(want.iter().all(|v| *v > 0.0));
    let mut saved = Vec::new();
    p.save(&mut saved);
    y.fill(1.0);
    p.place(&y, 0.1);
    saved.push(7.0);
    assert_eq!(p.restore(&saved), want.len());
    assert_eq!(p.faces.iter().flat_map(|f| f.volume).collect::<Vec<_>>(), want);
}

/// A ring that goes down and back up by uneven steps, whose face loses a little in each.
fn strokes(p: &mut Carried, y: &mut [f64]) {
    let mut pin = 0.1;
    for k in 0..120 {
        let next = if k < 60 { pin - 0.9e-3 } else { pin + 0.7e-3 };
        let y0 = y.to_vec();
        y[0] -= 0.01;
        y[3] -= 0.02;
        book(p, &y0, y, next);
        pin = next;
    }
    p.place(y, pin);
}

/// At the end of a cycle what was taken up goes into the states and the film into the field: the same oil, held otherwise.
#[test]
fn the_next_cycle_begins_with_the_oil_of_the_last() {
    let mut p = pack();
    let mut y = vec![5.0; p.states().len()];
    begin(&mut p, &y);
    strokes(&mut p, &mut y);
    let (volumes, total): (Vec<f64>, f64) = (p.faces.iter().flat_map(|f| f.volume).collect(), p.total(&y));
    let film = p.liner.film.clone();
    let owed: Vec<f64> = p.faces.iter().map(|f| f.owed).collect();
    assert!(p.faces.iter().any(|f| f.taken.iter().any(|t| *t > 0.0)), "nothing was taken up");
    let mut field = vec![0.0; p.carried()];
    p.end_cycle(&mut y, &mut field);
    assert!(p.faces.iter().all(|f| f.taken == [0.0; SIDES] && f.owed == 0.0));
    // The field is in its unit, a micrometre.
    assert!(field.iter().zip(&film).all(|(y, h)| (y * 1e-6 - h).abs() <= 4.0 * f64::EPSILON * h));
    // Some ten additions of volumes of this size.
    assert!((p.total(&y) - total).abs() <= 1e-14 * total, "{:e} {total:e}", p.total(&y));
    p.place(&y, p.faces[0].edge[0] - p.faces[0].offset);
    for (k, (now, before)) in p.faces.iter().flat_map(|f| f.volume).zip(volumes).enumerate() {
        // What a face owes is booked below it.
        let want = before + if k % SIDES == 0 { owed[k / SIDES] } else { 0.0 };
        assert!((now - want).abs() <= 1e-14 * total, "{k}: {now:e} {want:e}");
    }
}
