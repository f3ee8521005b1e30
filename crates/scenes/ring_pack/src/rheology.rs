//! The oil and the surfaces of the films of a ring, beside a constant viscosity between smooth walls.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{HydrodynamicsSpec, Rheology, RheologySpecs, RoughFlow};

use super::case::RingPackCase;

/// What the films of ring `i` get.
///
/// # Errors
/// What a model refuses, and what the film model of the ring does not know, at the place in the case.
pub fn rheology(case: &RingPackCase, i: usize, film: &dyn HydrodynamicsSpec) -> Result<Rheology, BuildError> {
    let (m, own) = (&case.models, &case.rings[i].models);
    let specs = RheologySpecs {
        roughness: own.roughness.as_deref().or(m.roughness.as_deref()),
        shear_thinning: m.shear_thinning.as_deref(),
        piezoviscosity: m.piezoviscosity.as_deref(),
        compressibility: m.compressibility.as_deref(),
    };
    let at = |kind: &str| match (kind, &own.roughness) {
        ("roughness", Some(_)) => format!("rings.{i}.models"),
        _ => "models".to_owned(),
    };
    let built = specs.build().map_err(|e| {
        let kind = e.field.split('.').next().unwrap_or_default().to_owned();
        e.within(&at(&kind))
    })?;
    match built.beyond(film.scope()) {
        None => Ok(built),
        Some(kind) => {
            let what = format!("the film `{}` of ring {} has no `{kind}`", film.typetag_name(), i + 1);
            Err(BuildError::at(format!("{}.{kind}", at(kind)), what)
                .help("use `hydrodynamics = { model = \"gridded_face\" }`, or leave it out"))
        }
    }
}

/// Film thickness \[m\] below which flow factors are held at those of a thicker film, where they are.
pub fn factors_end(rheology: &Rheology) -> Option<f64> {
    let law = rheology.roughness.as_ref()?;
    let separation = law.held_below()?;
    let mut flow = RoughFlow::new(1);
    law.flow(&[separation], &mut flow).ok()?;
    Some(flow.content[0])
}

/// Kind and name of the models of ring `i` that its case gives.
pub fn given(case: &RingPackCase, i: usize) -> [Option<(&'static str, &'static str)>; 4] {
    let (m, own) = (&case.models, &case.rings[i].models);
    let roughness = own.roughness.as_ref().or(m.roughness.as_ref());
    [
        roughness.map(|s| ("roughness", s.typetag_name())),
        m.shear_thinning.as_ref().map(|s| ("shear_thinning", s.typetag_name())),
        m.piezoviscosity.as_ref().map(|s| ("piezoviscosity", s.typetag_name())),
        m.compressibility.as_ref().map(|s| ("compressibility", s.typetag_name())),
    ]
}
