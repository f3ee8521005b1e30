//! Oil that evaporates from the liner, as the models of a case have it.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{Evaporation, EvaporationCtx, FilmTemperature, Kinematics, Volatile};
use gudgeon_core::result::{Note, Skipped};

use super::case::{Models, RingPackCase};
use super::plan::Plan;
use super::record::Totals;

/// Why nothing evaporates although there is a model of it.
const NO_FILM: &str = "no oil is followed on the liner (`oil_transport`), so none is there to evaporate";

/// Whether there is a model of evaporation, and oil for it.
pub fn acts(m: &Models) -> bool {
    !m.evaporation.is_off() && m.oil_transport.follows_oil()
}

/// The model that is left out for want of oil on the liner.
pub fn skipped(m: &Models, plan: &Plan) -> Option<Skipped> {
    let left_out = plan.film && !m.evaporation.is_off() && !acts(m);
    left_out.then(|| Skipped { what: "evaporation".into(), why: NO_FILM.into() })
}

/// The model of a case.
///
/// # Errors
/// What the model refuses.
pub fn model(
    case: &RingPackCase,
    kinematics: &dyn Kinematics,
) -> Result<Option<Box<dyn Evaporation>>, BuildError> {
    let stroke = kinematics.stroke();
    let ctx = EvaporationCtx {
        swept: case.engine.area() * stroke,
        mean_speed: stroke * kinematics.omega() / std::f64::consts::PI,
    };
    let built = case.models.evaporation.build(&ctx).map_err(|e| e.within("models.evaporation"))?;
    Ok(built.filter(|_| acts(&case.models)))
}

/// The same on a liner whose temperature is known; `top`: height of ring 1 at top dead centre over the crank axis \[m\].
///
/// # Errors
/// A film temperature that does not tell that of the liner.
pub fn volatile<'a>(
    model: Option<&'a (dyn Evaporation + 'static)>,
    temperature: &'a dyn FilmTemperature,
    top: f64,
) -> Result<Option<Volatile<'a>>, BuildError> {
    let Some(model) = model else { return Ok(None) };
    if temperature.liner(0.0).is_none() {
        let what = "the oil evaporates at the temperature of the liner, which this model does not tell";
        return Err(BuildError::at("models.film_temperature", what)
            .help("use `film_temperature = { model = \"liner_linear\", … }`, or `evaporation = { model = \"off\" }`"));
    }
    Ok(Some(Volatile { model, temperature, top }))
}

/// What is said of a liner that dries: there is no more to evaporate than comes there.
pub fn note(totals: &Totals) -> Option<Note> {
    let mm = 1e3 * totals.dried;
    (mm > 0.0).then(|| {
        let text = format!(
            "over {mm:.1} mm of its way ring 1 leaves a dry liner above it: there the oil that comes decides what evaporates, and no longer its vapour pressure"
        );
        Note::info("liner_dries", text).amount("height", mm, "mm")
    })
}
