use gudgeon_core::face::Face;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{
    CompressibilitySpec, FaceCtx, FaceIn, Hydrodynamics, HydrodynamicsSpec, PiezoviscositySpec,
    RheologySpecs, Rig, RigCtx, RigOut, RigSpec, RoughnessSpec, ShearThinningSpec, named,
};
use gudgeon_core::quantity::{Force, PosLength, PosViscosity, Pressure, Velocity, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::{along, validity};

/// The film under a running face at one instant: geometry, thickness, speeds and pressures given.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RingFaceRig {
    /// Axial length of the face.
    pub length: PosLength,
    /// Shape of the face.
    pub face: Face,
    /// Film thickness at the point nearest to the liner; between rough surfaces the mean gap.
    pub film: PosLength,
    /// Velocity of the liner seen from the ring, from the bottom edge to the top edge positive.
    pub speed: Velocity,
    /// Squeeze velocity, opening positive. Not together with `load`.
    #[serde(default = "still")]
    pub squeeze: Velocity,
    /// Load per metre of circumference to be carried, measured above `p_cav`: the squeeze velocity is then a result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<Force>,
    /// Absolute pressure at the bottom edge.
    pub p_bottom: Pressure,
    /// Absolute pressure at the top edge.
    pub p_top: Pressure,
    /// Absolute cavitation pressure.
    #[serde(default = "vacuum")]
    pub p_cav: Pressure,
    /// Viscosity.
    pub viscosity: PosViscosity,
    /// The model.
    pub hydrodynamics: Box<dyn HydrodynamicsSpec>,
    /// Flow and shear factors of rough surfaces, the ring being the body; absent: smooth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness: Option<Box<dyn RoughnessSpec>>,
    /// Fall of the viscosity with the shear rate; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_thinning: Option<Box<dyn ShearThinningSpec>>,
    /// Rise of the viscosity with pressure; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub piezoviscosity: Option<Box<dyn PiezoviscositySpec>>,
    /// Rise of the density with pressure; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compressibility: Option<Box<dyn CompressibilitySpec>>,
}

impl RingFaceRig {
    /// The film of a face, with the oil and the surfaces of the case.
    fn film(&self, face: &FaceProfile) -> Result<Box<dyn Hydrodynamics>, BuildError> {
        let specs = RheologySpecs {
            roughness: self.roughness.as_deref(),
            shear_thinning: self.shear_thinning.as_deref(),
            piezoviscosity: self.piezoviscosity.as_deref(),
            compressibility: self.compressibility.as_deref(),
        };
        let rheology = specs.build()?;
        if let Some(kind) = rheology.beyond(self.hydrodynamics.scope()) {
            let what = format!("the film `{}` has no `{kind}`", self.hydrodynamics.typetag_name());
            return Err(BuildError::at(kind, what)
                .help("use `hydrodynamics = { model = \"gridded_face\" }`, or leave it out"));
        }
        self.hydrodynamics.build_with(&FaceCtx { face }, &rheology).map_err(|e| e.within("hydrodynamics"))
    }
}

fn still() -> Velocity {
    quantity(0.0)
}
fn vacuum() -> Pressure {
    quantity(0.0)
}

#[register_model(
    name = "ring_face",
    summary = "film of a ring face at one instant: load, friction and pressure along the face",
    equations = "load = int (p - p_cav) dx;  shear = int (mu u/h -+ h p'/2) dx",
    validity = "One instant; the film has no history.",
    references = [],
    example = "length = \"1.2 mm\"\nface = { shape = \"parabola\", drop = \"6 um\" }\nfilm = \"2 um\"\nspeed = \"10 m/s\"\n\
              p_bottom = \"1 bar\"\np_top = \"1 bar\"\nviscosity = \"10 mPa s\"\nhydrodynamics = { model = \"closed_form_face\" }\n",
)]
impl RigSpec for RingFaceRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        let mut all = vec![("hydrodynamics", self.hydrodynamics.typetag_name())];
        all.extend(self.roughness.as_ref().map(|m| ("roughness", m.typetag_name())));
        all.extend(self.shear_thinning.as_ref().map(|m| ("shear_thinning", m.typetag_name())));
        all.extend(self.piezoviscosity.as_ref().map(|m| ("piezoviscosity", m.typetag_name())));
        all.extend(self.compressibility.as_ref().map(|m| ("compressibility", m.typetag_name())));
        all
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        if self.load.is_some() && self.squeeze.si() != 0.0 {
            errors.push(BuildError::at(
                "squeeze",
                "the squeeze velocity follows from `load`; give one of them",
            ));
        }
        errors.extend(along::cavitation_below(self.p_cav.si(), &[self.p_bottom.si(), self.p_top.si()]));
        let shape = self.face.profile(self.length.si()).map_err(|e| e.within("face"));
        let film = shape.and_then(|f| self.film(&f));
        match film {
            Ok(film) if errors.is_empty() => Ok(Box::new(Bench {
                film,
                inp: FaceIn {
                    h: self.film.si(),
                    u: self.speed.si(),
                    p_bottom: self.p_bottom.si(),
                    p_top: self.p_top.si(),
                    p_cav: self.p_cav.si(),
                    mu: self.viscosity.si(),
                },
                squeeze: self.squeeze.si(),
                load: self.load.map(|l| l.si()),
            })),
            Ok(_) => Err(errors),
            Err(e) => {
                errors.push(e);
                Err(errors)
            }
        }
    }
}

struct Bench {
    film: Box<dyn Hydrodynamics>,
    inp: FaceIn,
    squeeze: f64,
    load: Option<f64>,
}

/// Points along the face.
const POINTS: usize = 401;

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&["load", "squeeze", "load_rate", "ring_shear", "liner_shear", "p_max", "film_from", "film_to"])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let hdot = match self.load {
            Some(l) => self.film.squeeze_rate(&self.inp, l)?,
            None => self.squeeze,
        };
        let o = self.film.evaluate(&self.inp, hdot)?;
        out.result("load", o.load, "N/m", "load above the cavitation pressure, per metre of circumference");
        out.result("squeeze", hdot, "m/s", "squeeze velocity, opening positive");
        out.result("load_rate", -o.squeeze_damping, "N s/m2", "change of the load with the squeeze velocity");
        out.result(
            "ring_shear",
            o.ring_shear,
            "N/m",
            "shear force on the ring, towards the top edge positive",
        );
        out.result(
            "liner_shear",
            o.liner_shear,
            "N/m",
            "shear force on the liner, towards the bottom edge positive",
        );
        out.result("p_max", o.p_max / 1e5, "bar", "highest pressure");
        out.result(
            "film_from",
            1e3 * o.full_film.0,
            "mm",
            "lower end of the full film above the bottom edge",
        );
        out.result("film_to", 1e3 * o.full_film.1, "mm", "upper end of the full film above the bottom edge");
        let mut rows = vec![(0.0, 0.0, 0.0); POINTS];
        self.film.profile(&self.inp, hdot, &mut rows)?;
        out.axis("x", "m", rows.iter().map(|r| r.0).collect());
        out.column("p", "Pa", rows.iter().map(|r| r.2).collect());
        out.column("h", "m", rows.iter().map(|r| r.1).collect());
        out.curves(
            "Pressure along the face",
            "absolute; from the bottom edge to the top edge",
            &[("pressure", "p")],
        );
        out.curves("Film thickness", "", &[("film", "h")]);
        validity::note_limits(out);
        Ok(())
    }
}
