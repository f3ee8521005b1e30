//! The results of a pin and of a skirt profile that a reader looks at first.

use gudgeon_core::result::Headline;

/// In the order of the first page.
pub fn headlines() -> Vec<Headline> {
    let each = |title: &str, names: &[(&str, &str)]| {
        Headline::each(title, names.iter().map(|(l, n)| ((*l).to_owned(), (*n).to_owned())))
    };
    vec![
        Headline::one("Most used limit", "utilisation"),
        Headline::one("Mass of the pin", "pin_mass"),
        each("Size", &[("outer", "outer"), ("inner", "inner"), ("length", "length")]),
        each(
            "Stress",
            &[
                ("bending", "bending_stress"),
                ("ovalisation", "ovalisation_stress"),
                ("shear", "shear_stress"),
                ("resultant", "resultant_stress"),
            ],
        ),
        each("Pressure", &[("bosses", "boss_pressure"), ("small end", "rod_pressure")]),
        each("Deformation", &[("ovalisation", "ovalisation"), ("deflection", "deflection")]),
        Headline::one("Force on the pin", "pin_force"),
    ]
}
