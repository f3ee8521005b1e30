//! What a cycle of the skirt has to say of itself: inertia that was left out, surfaces inside one another, films held open, peaks that the grid
//! does not resolve.

use gudgeon_core::EvalError;
use gudgeon_core::result::Note;

use super::peak_width::half_height;
use super::row::{Look, Row, index};
use super::survey::{Survey, Which};

/// Part of the largest side force from which inertia that was left out is told.
const INERTIA_TOLD: f64 = 0.02;
/// Part of the cycle with both sides in solid contact at once from which a skirt counts as jammed. Skirts that run touch both sides at once in passing at most, when they tilt.
const JAMMED: f64 = 0.1;
/// Intervals of the film across half the height of a pressure peak that resolve it. Peaks of 2.7 and more intervals change by some 0.5 % on twice as fine a
/// grid. A sharp edge that is pressed against the liner squeezes its film out beside the edge: that peak is one interval wide on every grid (1.0, 1.2, 1.4 of 20,
/// 40, 64) and grows with it (620, 990, 1260 bar).
const RESOLVED: f64 = 2.0;

/// Part of the clearance that an edge may cross in a step of the oil. Films that it meets there are full all at once, and their pressure goes with the step: of a skirt
/// that crosses a quarter, the highest pressure changes by 0.1 % on an eighth of the step; of one that crosses 0.44, it falls by a quarter.
const CROSSED: f64 = 0.3;

const SIDES: [(&str, &str); 2] = [("thrust", "thrust side"), ("anti_thrust", "anti-thrust side")];

/// Notes of a cycle; `peaks` are the crank angles \[rad\] of the highest film pressure of each side.
///
/// # Errors
/// A film that cannot be solved.
pub fn notes(survey: &Survey, look: &mut Look<'_>, peaks: [Option<f64>; 2]) -> Result<Vec<Note>, EvalError> {
    let mut all = Vec::new();
    if look.a.motion.moves() && !look.a.motion.has_inertia() {
        all.extend(inertia(survey, look)?);
    }
    all.extend(long_steps(survey, look));
    all.extend(jammed(survey));
    for (side, peak) in peaks.into_iter().enumerate() {
        all.extend(overlap(survey, look, side)?);
        all.extend(held_open(survey, look, side)?);
        if let Some(t) = peak {
            all.extend(unresolved(look, side, t)?);
        }
    }
    Ok(all)
}

/// The inertia force that the motion found would have asked for, were it not left out.
fn inertia(survey: &Survey, look: &mut Look<'_>) -> Result<Option<Note>, EvalError> {
    let [top, bottom] = look.a.piston.body.matrix();
    let force = |[a, b]: [f64; 2]| (top[0] + bottom[0]) * a + (top[1] + bottom[1]) * b;
    let rates = [index("skirt.e_top_rate"), index("skirt.e_bottom_rate")];
    let found = survey.inertia(force, rates);
    let (theta, most) = found
        .into_iter()
        .fold((0.0, 0.0), |m: (f64, f64), f| if f.1.abs() > m.1 { (f.0, f.1.abs()) } else { m });
    let column = index("skirt.side_force");
    let whole = (0.0, look.a.period);
    let (side, _) = survey.extreme(look, Which::Max, whole, &|r: &Row| r[column].abs())?;
    let part = if side > 0.0 { most / side } else { 0.0 };
    Ok((part > INERTIA_TOLD).then(|| {
        let text = format!(
            "`{}` leaves out the inertia across the bore, which the motion found asks for with up to {most:.0} N at {:.0} deg, {:.1} % of the largest side force: impacts and solid contact come out too gentle. `full_inertia` counts it.",
            look.a.motion_name,
            theta.to_degrees(),
            100.0 * part
        );
        Note::caution("inertia_left_out", text)
            .amount("inertia_force", most, "N")
            .amount("inertia_share", part, "1")
    }))
}

/// Both sides in solid contact at once for much of the cycle: the skirt has no room.
fn jammed(survey: &Survey) -> Option<Note> {
    let [thrust, anti] = SIDES.map(|(side, _)| index(&format!("{side}.contact_force")));
    let least = survey.values(|r| r[thrust].abs().min(r[anti].abs()));
    let angles = survey.angles();
    let (mut touching, mut whole) = (0.0, 0.0);
    for (t, f) in angles.windows(2).zip(least.windows(2)) {
        whole += t[1] - t[0];
        if f[0] > 0.0 && f[1] > 0.0 {
            touching += t[1] - t[0];
        }
    }
    let share = if whole > 0.0 { touching / whole } else { 0.0 };
    (share > JAMMED).then(|| {
        let force = least.into_iter().fold(0.0, f64::max);
        let text = format!(
            "The skirt is jammed: both sides are in solid contact at once for {:.0} % of the cycle, pressed together with up to {force:.0} N. A piston that runs like this seizes. Its running clearance is too small for its profile and the grooves or waves of its surface.",
            100.0 * share
        );
        Note::exceeded("jammed", text).amount("share", share, "1").amount("force", force, "N")
    })
}

/// Steps of the oil in which the piston crosses much of its clearance.
fn long_steps(survey: &Survey, look: &Look<'_>) -> Option<Note> {
    let oil = look.trajectory.oil.as_ref().filter(|o| look.a.motion.moves() && !o.steps.is_empty())?;
    let step = look.a.period / oil.steps.len() as f64;
    let [top, bottom] = [index("skirt.e_top_rate"), index("skirt.e_bottom_rate")];
    let fastest = survey.values(|r| r[top].abs().max(r[bottom].abs())).into_iter().fold(0.0, f64::max);
    let crossed = fastest * step / look.a.omega() / look.a.clearance;
    (crossed > CROSSED).then(|| {
        let text = format!(
            "An edge of the skirt crosses up to {crossed:.2} of the clearance in a step of its oil ({:.3} deg): the films that it meets fill all at once, and the highest pressure there goes with the step. Make `models.skirt_oil.step` smaller.",
            step.to_degrees()
        );
        Note::caution("oil_step_too_long", text).amount("part_of_clearance", crossed, "1")
    })
}

/// Mean planes inside one another.
fn overlap(survey: &Survey, look: &mut Look<'_>, side: usize) -> Result<Option<Note>, EvalError> {
    let (name, words) = SIDES[side];
    let column = index(&format!("{name}.h_min"));
    let gaps = survey.values(|r| r[column]);
    if gaps.iter().all(|g| *g > 0.0) {
        return Ok(None);
    }
    let mut at = |look: &mut Look<'_>, t: f64| Ok(look.gaps(t)?[side]);
    let whole = (0.0, look.a.period);
    let (deepest, theta) = survey.extreme_of(look, Which::Min, whole, &gaps, &mut at)?;
    let stretches = survey.stretches(look, &gaps, &mut at)?;
    let share = stretches.iter().map(|(a, b)| b - a).sum::<f64>() / look.a.period;
    let text = format!(
        "The mean planes of skirt and liner stand up to {:.2} um inside one another on the {words} (at {:.0} deg, {:.2} % of the cycle): roughness is flattened and the surfaces below it yield, which no contact model here describes.",
        -1e6 * deepest,
        theta.to_degrees(),
        100.0 * share
    );
    let note = Note::caution(format!("overlap.{name}"), text);
    Ok(Some(note.amount("depth", -1e6 * deepest, "um").amount("share_of_cycle", share, "1")))
}

/// A film that its floor, or the model of the rough surfaces, holds open.
fn held_open(survey: &Survey, look: &mut Look<'_>, side: usize) -> Result<Option<Note>, EvalError> {
    let (name, words) = SIDES[side];
    let Some(open) = look.a.piston.sides[side].held_open_below() else { return Ok(None) };
    let column = index(&format!("{name}.h_min"));
    let above = survey.values(|r| r[column] - open);
    let mut at = |look: &mut Look<'_>, t: f64| Ok(look.gaps(t)?[side] - open);
    let stretches = survey.stretches(look, &above, &mut at)?;
    let share = stretches.iter().map(|(a, b)| b - a).sum::<f64>() / look.a.period;
    if share <= 0.0 {
        return Ok(None);
    }
    let mut most = 0.0_f64;
    for (a, b) in &stretches {
        look.row(0.5 * (a + b), 0.0)?;
        most = most.max(look.a.piston.sides[side].held_open());
    }
    let text = format!(
        "The film on the {words} is held open where the gap is below {:.2} um: by up to {:.2} um, for {:.2} % of the cycle. Its pressure there depends on that limit.",
        1e6 * open,
        1e6 * most,
        100.0 * share
    );
    let note = Note::caution(format!("film_held_open.{name}"), text);
    Ok(Some(note.amount("raised_by", 1e6 * most, "um").amount("share_of_cycle", share, "1")))
}

/// A pressure peak that is narrower than the grid can show.
fn unresolved(look: &mut Look<'_>, side: usize, t: f64) -> Result<Option<Note>, EvalError> {
    let (name, words) = SIDES[side];
    let p = &look.pressures(t)?[side];
    let nx = look.a.piston.sides[side].grid().x.len();
    let [along, across] = half_height(p, nx);
    let least = along.min(across);
    Ok((least < RESOLVED).then(|| {
        let text = format!(
            "The highest film pressure on the {words} (at {:.0} deg) stands on {along:.1} intervals along the skirt and {across:.1} across it at half its height: the grid is too coarse for it, and for solid contact beside it. {}; a peak that stays as narrow is that of a sharp edge, which the profile of the skirt has to draw back.",
            t.to_degrees(),
            if along <= across {
                "Raise `solver.intervals_along`, or let nodes lie closer at the edges: `solver.crowding` down to -0.5"
            } else {
                "Raise `solver.intervals_across`"
            }
        );
        Note::caution(format!("grid_too_coarse.{name}"), text)
            .amount("intervals_along_peak", along, "1")
            .amount("intervals_across_peak", across, "1")
    }))
}
