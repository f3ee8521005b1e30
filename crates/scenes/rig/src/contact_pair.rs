use gudgeon_core::kinds::{
    BoundaryFriction, BoundaryFrictionSpec, Contact, ContactSpec, Rig, RigCtx, RigOut, RigSpec, Rubbing,
    named, real_area_is_known,
};
use gudgeon_core::quantity::{Length, Velocity, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::draw::{self, Scales, line};

/// Solid contact of two surfaces over their separation.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactPairRig {
    /// Smallest separation of the mean planes that is drawn. May be negative.
    #[serde(default = "zero")]
    pub from: Length,
    /// Largest separation that is drawn.
    pub to: Length,
    /// Separation of the results.
    pub separation: Length,
    /// Sliding speed of the results; matters with `boundary_friction` alone.
    #[serde(default = "one")]
    pub speed: Velocity,
    /// The model of the load that the surfaces carry.
    pub contact: Box<dyn ContactSpec>,
    /// How friction depends on sliding speed, load and real area; absent: the coefficient of the contact model at every speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundary_friction: Option<Box<dyn BoundaryFrictionSpec>>,
}

fn zero() -> Length {
    quantity(0.0)
}
fn one() -> Velocity {
    quantity(1.0)
}

#[register_model(
    name = "contact_pair",
    summary = "solid contact over the separation of the surfaces: pressure, real area, friction",
    equations = "p(h);  A_c/A (h) where the model knows it;  tau = mu p",
    validity = "Nominally flat surfaces at rest or sliding; no film between them.",
    references = [],
    example = "to = \"2 um\"\nseparation = \"0.4 um\"\n\
              contact = { model = \"linear_penalty\", stiffness = \"1e14 N/m3\", touching = \"0.5 um\" }\n",
)]
impl RigSpec for ContactPairRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        let mut all = vec![("contact", self.contact.typetag_name())];
        all.extend(self.boundary_friction.as_ref().map(|f| ("boundary_friction", f.typetag_name())));
        all
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        if self.from.si() >= self.to.si() {
            errors.push(
                BuildError::at("to", "the largest separation is not larger than the smallest")
                    .help("`from` is zero when it is not given"),
            );
        }
        let contact = self.contact.build().map_err(|e| errors.push(e.within("contact")));
        let friction = match &self.boundary_friction {
            Some(f) => f.build().map(Some).map_err(|e| errors.push(e.within("boundary_friction"))),
            None => Ok(None),
        };
        if let (Ok(contact), Ok(Some(friction))) = (&contact, &friction) {
            let known = real_area_is_known(&**friction, &**contact, self.contact.typetag_name());
            errors.extend(known.err().map(|e| e.within("boundary_friction")));
        }
        match (contact, friction) {
            (Ok(contact), Ok(friction)) if errors.is_empty() => Ok(Box::new(Bench {
                contact,
                friction,
                ends: (self.from.si(), self.to.si()),
                at: self.separation.si(),
                speed: self.speed.si(),
            })),
            _ => Err(errors),
        }
    }
}

struct Bench {
    contact: Box<dyn Contact>,
    friction: Option<Box<dyn BoundaryFriction>>,
    ends: (f64, f64),
    at: f64,
    speed: f64,
}

const MODEL: &str = "contact_pair";
/// Separations of the series, and speeds of the friction table.
const POINTS: usize = 201;

impl Bench {
    /// Coefficient of friction at the separation of the case.
    fn coefficient(&self, speed: f64) -> Result<f64, EvalError> {
        let (mut p, mut area) = ([0.0], [0.0]);
        self.contact.pressure(&[self.at], &mut p);
        self.contact.real_area(&[self.at], &mut area);
        Ok(self.coefficients(speed, &p, &area)?[0])
    }

    /// Coefficients of friction at pressures \[Pa\] and real over nominal areas, all at one speed.
    fn coefficients(&self, speed: f64, p: &[f64], area: &[f64]) -> Result<Vec<f64>, EvalError> {
        let Some(f) = &self.friction else { return Ok(vec![self.contact.friction_coefficient(); p.len()]) };
        let (mut c, mut s) = (vec![0.0; p.len()], vec![0.0; p.len()]);
        let speed = vec![speed; p.len()];
        f.coefficient(&Rubbing { speed: &speed, pressure: p, real_area: area }, &mut c, &mut s)?;
        Ok(c)
    }

    /// Results at the separation of the case.
    fn here(&self, mu: f64, out: &mut RigOut) {
        let (mut here, mut area_here) = ([0.0], [0.0]);
        self.contact.pressure(&[self.at], &mut here);
        let known = self.contact.real_area(&[self.at], &mut area_here);

        out.result("pressure", here[0] / 1e6, "MPa", "nominal contact pressure at `separation`");
        if known {
            out.result("real_area", area_here[0], "1", "real over nominal area of contact at `separation`");
        }
        out.result("friction_coefficient", mu, "1", "coefficient of friction of the contact at `speed`");
        out.result(
            "shear",
            mu * here[0] / 1e6,
            "MPa",
            "shear stress of the contact at `separation` and `speed`",
        );
        out.result("range", 1e6 * self.contact.range(), "um", "separation above which nothing is carried");
        if let Some(floor) = self.contact.floor() {
            out.result("floor", 1e6 * floor, "um", "film thickness at which the surfaces carry what is left");
        }
    }

    /// Pressure, shear stress and real area over the separation.
    fn over_separation(&self, out: &mut RigOut) -> Result<(), EvalError> {
        let h = draw::linear(self.ends.0, self.ends.1, POINTS);
        let (mut p, mut area) = (vec![0.0; POINTS], vec![0.0; POINTS]);
        self.contact.pressure(&h, &mut p);
        let known = self.contact.real_area(&h, &mut area);
        out.axis("separation", "m", h);
        out.column("p", "Pa", p.clone());
        let mu = self.coefficients(self.speed, &p, &area)?;
        let tau: Vec<f64> = p.iter().zip(mu).map(|(p, mu)| mu * p).collect();
        out.column("shear", "Pa", tau);
        draw::curves(
            out,
            "series",
            "Contact pressure",
            "nominal, over the separation of the mean planes",
            Scales::default(),
            &[line("pressure", "p"), line("shear stress", "shear")],
        );
        if p.iter().any(|p| *p > 0.0) {
            let steep = Scales { log_x: false, log_y: true };
            draw::curves(
                out,
                "series",
                "Contact pressure, small values",
                "",
                steep,
                &[line("pressure", "p")],
            );
        }
        if known {
            out.column("real_area", "1", area);
            let steep = Scales { log_x: false, log_y: true };
            draw::curves(
                out,
                "series",
                "Real area of contact",
                "over the nominal area",
                steep,
                &[line("real area", "real_area")],
            );
        }
        Ok(())
    }

    /// Coefficient of friction over the sliding speed.
    fn over_speed(&self, out: &mut RigOut) -> Result<(), EvalError> {
        let max = if self.speed == 0.0 { 1.0 } else { 2.0 * self.speed.abs() };
        let speeds = draw::linear(-max, max, POINTS);
        let mu = speeds.iter().map(|v| self.coefficient(*v)).collect::<Result<Vec<_>, _>>()?;
        let axis = draw::column("speed", "m/s", speeds);
        draw::table(out, "friction", axis, vec![draw::column("friction_coefficient", "1", mu)]);
        draw::curves(
            out,
            "friction",
            "Coefficient of friction",
            "over the sliding speed",
            Scales::default(),
            &[line("friction coefficient", "friction_coefficient")],
        );
        Ok(())
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        let mut names = named(&["pressure", "real_area", "friction_coefficient", "shear", "range"]);
        names.extend(self.contact.floor().map(|_| "floor".into()));
        names
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let mu = self.coefficient(self.speed)?;
        self.here(mu, out);
        self.over_separation(out)?;
        if self.friction.is_some() {
            self.over_speed(out)?;
        }
        draw::finite(MODEL, out)
    }
}
