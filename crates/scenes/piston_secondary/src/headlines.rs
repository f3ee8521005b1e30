//! The results of a skirt that a reader looks at first.

use gudgeon_core::result::Headline;

/// In the order of the first page.
pub fn headlines() -> Vec<Headline> {
    let pair = |label: &str, name: &str| (label.to_owned(), name.to_owned());
    let side = [pair("thrust", "side_force_max"), pair("anti-thrust", "side_force_min")];
    vec![
        Headline::one("Friction power", "friction_power").over(&["skirt.friction_power"]),
        Headline::one("Smallest gap", "h_min").over(&["thrust.h_min", "anti_thrust.h_min"]),
        Headline::one("Highest film pressure", "p_max").over(&["thrust.p_max", "anti_thrust.p_max"]),
        Headline::each("Side force of film and contact", side).over(&["skirt.side_force"]),
        Headline::one("Largest difference of both edges", "tilt_max").over(&["skirt.tilt"]),
        Headline::one("Energy of the slap", "slap_energy").over(&["skirt.lateral_energy"]),
        Headline::one("Largest force of solid contact", "contact_force_max")
            .over(&["thrust.contact_force", "anti_thrust.contact_force"]),
        Headline::one("Friction mean effective pressure", "fmep"),
    ]
}
