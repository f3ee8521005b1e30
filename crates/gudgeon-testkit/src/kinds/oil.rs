use gudgeon_core::kinds::Oil;

/// Complaints about an oil: a viscosity between 1 K and 2000 K that is not positive and finite, or that changes when it is asked again.
#[must_use]
pub fn oil(model: &dyn Oil) -> Vec<String> {
    let mut wrong = Vec::new();
    for t in [1.0, 200.0, 250.0, 273.15, 313.15, 373.15, 473.15, 600.0, 1000.0, 2000.0] {
        let mu = model.viscosity(t);
        if !(mu > 0.0 && mu.is_finite()) {
            wrong.push(format!("the viscosity at {t} K is {mu} Pa s"));
        }
        if model.viscosity(t).to_bits() != mu.to_bits() {
            wrong.push(format!("the viscosity at {t} K changes"));
        }
    }
    wrong
}
