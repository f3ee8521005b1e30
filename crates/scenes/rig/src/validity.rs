//! What a film on a bench must say of itself: where Reynolds' equation no longer holds, and where oil is lost.

use gudgeon_core::kinds::RigOut;
use gudgeon_core::result::Note;

/// Thinnest film that is one \[m\]: liquids confined to less than some molecular diameters are no longer those of the bulk (S. Granick, Science 253
/// (1991) 1374).
const THINNEST: f64 = 1e-9;
/// Highest pressure between rigid surfaces \[Pa\]: at a contact stress of 4.2 GPa balls and races of hardened steel keep a dent (the static limit of ball
/// bearings, ISO 76).
const HIGHEST: f64 = 4e9;
/// Part of the oil passing through that a balance may be open: rounding and the tolerances of the films leave less.
const OPEN: f64 = 1e-6;

/// Adds the notes that the film of `out` deserves, from its column `h` \[m\], its result `p_max` \[bar\] and its oil balance.
pub(crate) fn tell(out: &mut RigOut) {
    let thinnest = out
        .series
        .columns
        .iter()
        .filter(|c| c.name == "h")
        .flat_map(|c| &c.values)
        .fold(f64::INFINITY, |a, &b| a.min(b));
    if thinnest < THINNEST {
        let text = format!(
            "the film is {:.2e} nm at its thinnest: below 1 nm oil is molecules, and Reynolds' equation does not hold",
            1e9 * thinnest
        );
        out.notes.push(Note::caution("film_of_molecules", text).amount("h_min", thinnest, "m"));
    }
    let highest = out.results.get("p_max").map_or(0.0, |v| 1e5 * v.value);
    if highest > HIGHEST {
        let text = format!(
            "the pressure reaches {:.2e} GPa: above {} GPa steel yields, and these surfaces are rigid",
            1e-9 * highest,
            1e-9 * HIGHEST
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

#[cfg(test)]
mod tests {
    use super::*;

    fn noted(h: f64, p_max: f64, open: f64) -> Vec<String> {
        let mut out = RigOut::default();
        out.axis("x", "m", vec![0.0, 1.0]);
        out.column("h", "m", vec![1e-6, h]);
        out.result("p_max", p_max / 1e5, "bar", "highest pressure");
        out.balance.oil_mass = Some(open);
        tell(&mut out);
        out.notes.into_iter().map(|n| n.topic).collect()
    }

    #[test]
    fn a_film_says_where_its_equation_ends() {
        assert!(noted(2e-9, 3e9, 1e-9).is_empty());
        assert_eq!(noted(2e-10, 3e9, 0.0), ["film_of_molecules"]);
        assert_eq!(noted(2e-9, 5e9, 0.0), ["surfaces_would_yield"]);
        assert_eq!(noted(2e-9, 3e9, -0.5), ["oil_not_conserved"]);
    }
}
