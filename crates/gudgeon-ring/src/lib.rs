//! Axial motion of rings in their grooves, oil between ring and groove flanks, friction on the flanks.
//!
//! Heights `s` are measured from the lower groove flank, velocities and forces are positive towards the head.

pub mod axial_gas {
    //! Axial gas force on a ring.
    mod full_perimeter;
    mod laminar_profile;
    mod linear_profile;
    pub use full_perimeter::FullPerimeter;
    pub use laminar_profile::LaminarProfile;
    pub use linear_profile::LinearProfile;
}
pub mod cavitation_datum {
    //! Pressure at which films of rings cavitate.
    mod absolute;
    mod gauge;
    pub use absolute::Absolute;
    pub use gauge::Gauge;
}
pub mod drag {
    //! Friction that friction power counts.
    mod face_shear;
    mod liner;
    pub use face_shear::FaceShear;
    pub use liner::Liner;
}
pub mod film_force {
    //! Film in the axial balance of a ring.
    mod face_shear;
    mod liner_reaction;
    mod total;
    pub use face_shear::FaceShear;
    pub use liner_reaction::LinerReaction;
    pub use total::Total;
}
mod flank_damping {
    //! Resistance of the oil in the groove to axial motion.
    pub mod off;
    pub mod squeeze_film;
    pub mod tangent_degrees;
    pub mod tangent_radians;
}
mod flank_friction {
    //! Friction on the flanks against radial motion.
    pub mod off;
    pub mod rational_saturation;
    pub mod tanh_stribeck;
}
pub mod hoop {
    //! Force of a ring by its own tension.
    mod as_printed;
    mod correct;
    pub use as_printed::AsPrinted;
    pub use correct::Correct;
}
pub mod radial_gas {
    //! Surfaces on which gas presses radially.
    mod back_and_face;
    mod back_face_and_gap;
    mod back_only;
    mod bore_perimeter;
    pub use back_and_face::BackAndFace;
    pub use back_face_and_gap::BackFaceAndGap;
    pub use back_only::BackOnly;
    pub use bore_perimeter::BorePerimeter;
}
mod radial_motion;
mod ring_motion {
    //! Motion in the groove.
    mod flank;
    mod hold;
    pub mod newton_groove;
    pub mod seated;
    pub mod three_seat;
}
pub mod twin_land_friction {
    //! Friction of a twin-land ring.
    mod both_lands;
    mod lower_twice;
    pub use both_lands::BothLands;
    pub use lower_twice::LowerTwice;
}

pub use flank_damping::off::Off as DampingOff;
pub use flank_damping::squeeze_film::SqueezeFilm;
pub use flank_damping::tangent_degrees::TangentDegrees;
pub use flank_damping::tangent_radians::TangentRadians;
pub use flank_friction::off::Off as FrictionOff;
pub use flank_friction::rational_saturation::RationalSaturation;
pub use flank_friction::tanh_stribeck::TanhStribeck;
pub use radial_motion::film_balance::FilmBalance;
pub use ring_motion::newton_groove::NewtonGroove;
pub use ring_motion::seated::{Flank, Seated};
pub use ring_motion::three_seat::ThreeSeat;

use gudgeon_core::BuildError;
use gudgeon_core::kinds::FlankDampingCtx;

/// The oil-filled fraction is one.
fn check_fill(ctx: &FlankDampingCtx) -> Result<(), BuildError> {
    if (0.0..=1.0).contains(&ctx.oil_fill) {
        Ok(())
    } else {
        Err(BuildError::new(format!(
            "the groove of ring {} is filled with oil to {}, which is not between 0 and 1",
            ctx.ring + 1,
            ctx.oil_fill
        ))
        .help("write 60 % as \"60 %\" or 0.6"))
    }
}

/// Width and viscosity are positive.
fn check_oil(ctx: &FlankDampingCtx) -> Result<(), BuildError> {
    for (value, what, unit) in
        [(ctx.width, "the radial width of the flank", "m"), (ctx.mu, "the oil viscosity", "Pa s")]
    {
        if !(value > 0.0 && value.is_finite()) {
            return Err(BuildError::new(format!(
                "{what} of ring {} is {value:e} {unit}, which must be greater than zero",
                ctx.ring + 1
            )));
        }
    }
    Ok(())
}

/// Compares the analytic slope with central differences over the velocities around `scale`.
#[cfg(test)]
fn check_slope(m: &dyn gudgeon_core::kinds::FlankFriction, scale: f64) {
    let load = 250.0;
    for k in -60..=60 {
        let v = scale * f64::from(k) / 10.0;
        let d = 1e-5 * scale;
        let central = (m.force(v + d, load) - m.force(v - d, load)) / (2.0 * d);
        let largest = m.slope(0.0, load);
        // Truncation (d/scale)² ~ 1e-10 and rounding 1e-16/1e-5 of the largest slope; at v = 0 the second derivative of |v| jumps,
        // which costs one order, 1e-5.
        let tolerance = if k == 0 { 2e-5 } else { 1e-9 };
        assert!(
            (m.slope(v, load) - central).abs() < tolerance * largest,
            "{v}: {} {central}",
            m.slope(v, load)
        );
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn registered() {
        let registry = gudgeon_core::Registry::collect();
        for (kind, names) in [
            ("ring_motion", &["newton_groove", "seated", "three_seat"][..]),
            ("flank_damping", &["off", "squeeze_film", "tangent_degrees", "tangent_radians"]),
            ("flank_friction", &["off", "rational_saturation", "tanh_stribeck"]),
        ] {
            let found: Vec<_> = registry.models(kind).iter().map(|m| m.name).collect();
            assert_eq!(found, names);
        }
    }
}

gudgeon_core::link!(
    DampingOff,
    FilmBalance,
    FrictionOff,
    NewtonGroove,
    RationalSaturation,
    Seated,
    SqueezeFilm,
    TangentDegrees,
    TangentRadians,
    TanhStribeck,
    ThreeSeat,
    axial_gas::FullPerimeter,
    axial_gas::LaminarProfile,
    axial_gas::LinearProfile,
    cavitation_datum::Absolute,
    cavitation_datum::Gauge,
    drag::FaceShear,
    drag::Liner,
    film_force::FaceShear,
    film_force::LinerReaction,
    film_force::Total,
    hoop::AsPrinted,
    hoop::Correct,
    radial_gas::BackAndFace,
    radial_gas::BackFaceAndGap,
    radial_gas::BackOnly,
    radial_gas::BorePerimeter,
    twin_land_friction::BothLands,
    twin_land_friction::LowerTwice,
);
