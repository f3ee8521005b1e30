//! The results of a ring pack that a reader looks at first.

use gudgeon_core::result::Headline;

use super::plan::Names;

/// Those of the rings with these names, crown first.
#[must_use]
pub fn headlines(names: &Names) -> Vec<Headline> {
    let n = names.rings.len();
    let rings = |what: &str| -> Vec<(String, String)> {
        names
            .rings
            .iter()
            .enumerate()
            .map(|(i, (name, _))| (name.clone(), format!("ring{}.{what}", i + 1)))
            .collect()
    };
    let columns = |what: &str| (1..=n).map(|k| format!("ring{k}.{what}")).collect::<Vec<_>>();
    let each = |title: &str, result: &str, column: &str| Headline {
        curves: columns(column),
        ..Headline::each(title, rings(result))
    };
    let lands = names.lands.iter().enumerate().skip(1);
    let between = lands.map(|(i, name)| (name.clone(), format!("land{}.p_max", i + 1)));
    let pressures = (2..=n).map(|k| format!("land{k}.p")).collect();
    let of = |label: &str, name: &str| (label.to_owned(), name.to_owned());
    vec![
        Headline::one("Blow-by", "blow_by").over(&["blow_by.rate"]),
        Headline::each(
            "Friction mean effective pressure",
            [of("all", "fmep"), of("contact", "fmep_boundary")],
        ),
        Headline::one("Oil upwards, a lower limit of consumption", "oil_up"),
        Headline::one("Highest cylinder pressure", "cylinder.p_max").over(&["cylinder.p"]),
        Headline::one("Crank angle of that", "cylinder.p_max_angle"),
        each("Friction power", "friction_power", "friction_power"),
        each("Thinnest film", "h_min", "h_min"),
        Headline { curves: pressures, ..Headline::each("Highest pressure between the rings", between) },
        each("Wear load of solid contact", "wear_load", "contact_load"),
        each("Part of the cycle off the lower flank", "lifted_share", "position"),
    ]
}
