//! What a film on a bench must say of itself: where Reynolds' equation no longer holds, and where oil is lost.

use gudgeon_core::kinds::RigOut;
use gudgeon_core::result::Note;

/// Thinnest film that is one \[m\]: liquids confined to less than some molecular diameters are no longer those of the bulk (S. Granick, Science 253
/// (1991) 1374).
const MIN_FILM: f64 = 1e-9;
/// Highest pressure between rigid surfaces \[Pa\]: at a contact stress of 4.2 GPa balls and races of hardened steel keep a dent (the static limit of ball
/// bearings, ISO 76).
const MAX_PRESSURE: f64 = 4e9;
/// Part of the oil passing through that a balance may be open: rounding and the tolerances of the films leave less.
const OPEN: f64 = 1e-6;

/// Adds the notes that the film of `out` deserves, from its column `h` \[m\], its result `p_max` \[bar\] and its oil balance.
pub fn note_limits(out: &mut RigOut) {
    let thinnest = out
        .series
        .columns
        .iter()
        .filter(|c| c.name == "h")
        .flat_map(|c| &c.values)
        .fold(f64::INFINITY, |a, &b| a.min(b));
    if thinnest < MIN_FILM {
        let text = format!(
            "the film is {:.2e} nm at its thinnest: below 1 nm oil is molecules, and Reynolds' equation does not hold",
            1e9 * thinnest
        );
        out.notes.push(Note::caution("film_of_molecules", text).amount("h_min", thinnest, "m"));
    }
    let highest = out.results.get("p_max").map_or(0.0, |v| 1e5 * v.value);
    if highest > MAX_PRESSURE {
        let text = format!(
            "the pressure reaches {:.2e} GPa: above {} GPa steel yields, and these surfaces are rigid",
            1e-9 * highest,
            1e-9 * MAX_PRESSURE
        );
        out.notes.push(Note::caution("surfaces_would_yield", text).amount("p_max", highest, "Pa"));
    }
    if let Some(open) = out.balance.oil_mass.filter(|open| open.abs() > OPEN) {
        let text = format!(
            "oil is not conserved: the balance of the film is open by {:.2e} of the oil that passes",
            open.abs()
        );
        out.notes.push(Note::caution("oil_not_conserved", text).amount("open", open, "1"));
    }
}
