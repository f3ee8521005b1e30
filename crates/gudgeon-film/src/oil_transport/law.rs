//! What a meniscus leaves on the liner, and what rough surfaces carry in their valleys.

use gudgeon_core::result::Note;

use crate::roughness::GaussianGap;

/// The constants of a model of the oil on the liner, and what follows from them.
#[derive(Debug)]
pub struct Law {
    /// Film that splash and skirt leave below the pack \[m\].
    pub supply: f64,
    /// Part of the gap at a trailing meniscus that stays on the liner.
    pub split: f64,
    /// Composite roughness \[m\].
    pub roughness: f64,
    /// Mean gap of Gaussian surfaces.
    pub mean_gap: GaussianGap,
    /// Highest wave of oil that stands before an edge \[m\].
    pub wave: f64,
    /// Largest spacing of the film on the liner \[m\].
    pub spacing: f64,
    /// Film of the first cycle \[m\].
    pub initial: f64,
    /// Density of the oil \[kg/m³\].
    pub density: f64,
}

impl Law {
    /// Mean gap of two Gaussian surfaces less the distance of their mean planes, `σ F_1(h/σ)` (Patir and Cheng): where they overlap
    /// there is no gap.
    fn valleys(&self, h: f64) -> f64 {
        if self.roughness > 0.0 {
            let over = h / self.roughness;
            self.roughness * (self.mean_gap.at(over).0 - over).max(0.0)
        } else {
            0.0
        }
    }

    /// Thickness \[m\] of the film that the meniscus at a trailing edge leaves on the liner, for the gap \[m\] at the meniscus.
    pub fn deposited(&self, gap: f64) -> f64 {
        self.split * (gap + self.valleys(gap))
    }

    /// How to see what the supply does to the results: from half of it to twice as much, or about 5 µm where there is none.
    pub fn supply_note(&self) -> Note {
        let um = 1e6 * self.supply;
        let about = if um > 0.0 { um } else { 5.0 };
        let (from, to) = (0.5 * about, 2.0 * about);
        let text = format!(
            "the film of {um} um that the crankcase leaves below the rings is an input (`models.oil_transport.supply`). What blow-by, friction, films and oil upwards owe to it the \
             report draws with `--set 'sweeps=[{{path=\"models.oil_transport.supply\",from=\"{from} um\",to=\"{to} um\",points=5,spacing=\"log\",\
             results=[\"blow_by\",\"fmep\",\"ring1.h_min\",\"oil_up\"]}}]'`"
        );
        Note::info("oil_supply", text).amount("supply", um, "um")
    }

    /// Flux \[m²/s\] that the valleys carry through a gap \[m\] beside what the smooth film does, at the sliding speed \[m/s\].
    pub fn through_valleys(&self, gap: f64, speed: f64) -> f64 {
        0.5 * speed * self.valleys(gap)
    }
}
