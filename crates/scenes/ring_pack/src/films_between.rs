//! Films between the instants of a step at which they were solved.

use gudgeon_numerics::sdirk::GAMMA;

use super::instant::RingInstant;

/// Films of all rings at the start of a step and at its stages, and the parabolas through them, which leave the range of the three nowhere.
#[derive(Debug, Clone)]
pub struct FilmsBetween {
    /// Start and length of the step \[rad\].
    step: (f64, f64),
    instants: [Vec<RingInstant>; 3],
}

impl FilmsBetween {
    /// For as many rings.
    pub fn new(rings: usize) -> Self {
        let instant = || vec![RingInstant::default(); rings];
        Self { step: (0.0, 1.0), instants: [instant(), instant(), instant()] }
    }

    /// Keeps the rings at an instant of a step: its start, or a stage.
    pub fn keep(&mut self, instant: usize, rings: &[RingInstant]) {
        self.instants[instant].copy_from_slice(rings);
    }

    /// The step from `t0` to `t1` was taken.
    pub const fn took(&mut self, t0: f64, t1: f64) {
        self.step = (t0, t1 - t0);
    }

    /// The end of the step is the start of the next.
    pub fn go_on(&mut self) {
        self.instants.swap(0, 2);
    }

    /// Tells what the films do at `t`: film rate, viscosity, load, friction and what limits did.
    pub fn tell(&self, t: f64, rings: &mut [RingInstant]) {
        let x = (t - self.step.0) / self.step.1;
        let weights = [
            (x - GAMMA) * (x - 1.0) / GAMMA,
            x * (1.0 - x) / (GAMMA * (1.0 - GAMMA)),
            x * (x - GAMMA) / (1.0 - GAMMA),
        ];
        for (i, ring) in rings.iter_mut().enumerate() {
            tell(ring, &self.instants.each_ref().map(|rings| rings[i]), &weights);
        }
    }
}

/// One ring between three instants.
fn tell(ring: &mut RingInstant, at: &[RingInstant; 3], weights: &[f64; 3]) {
    let mix = |of: fn(&RingInstant) -> f64| {
        let [a, b, c] = at.each_ref().map(of);
        let parabola = weights[0] * a + weights[1] * b + weights[2] * c;
        parabola.clamp(a.min(b).min(c), a.max(b).max(c))
    };
    (ring.hdot, ring.mu, ring.load) = (mix(|r| r.hdot), mix(|r| r.mu), mix(|r| r.load));
    (ring.contact, ring.perimeter) = (mix(|r| r.contact), mix(|r| r.perimeter));
    (ring.friction, ring.axial.film) = (mix(|r| r.friction), mix(|r| r.axial.film));
    (ring.power, ring.boundary_power) = (mix(|r| r.power), mix(|r| r.boundary_power));
    ring.film_known = false;
    let l = &mut ring.limited;
    (l.floor, l.drag) = (mix(|r| r.limited.floor), mix(|r| r.limited.drag));
    (l.contact_drag, l.slowed) = (mix(|r| r.limited.contact_drag), mix(|r| r.limited.slowed));
    (l.lifted, l.thickest) = (mix(|r| r.limited.lifted), mix(|r| r.limited.thickest));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_films_do_goes_by_a_parabola_within_the_range_of_its_ends() {
        let ring = |x: f64| RingInstant {
            friction: x * (3.0 - x),
            contact: (x - 0.6).powi(2),
            ..Default::default()
        };
        let mut films = FilmsBetween::new(1);
        for (instant, x) in [0.0, GAMMA, 1.0].into_iter().enumerate() {
            films.keep(instant, &[ring(x)]);
        }
        films.took(2.0, 6.0);
        let mut at = [RingInstant::default()];
        for x in [0.0, 0.2, 0.7, 0.95, 1.0] {
            films.tell(2.0 + 4.0 * x, &mut at);
            // Three products of numbers below ten.
            assert!((at[0].friction - x * (3.0 - x)).abs() < 1e-14, "{x}: {}", at[0].friction);
            // The least of the three is that at the first stage.
            let contact = (x - 0.6).powi(2).max((GAMMA - 0.6).powi(2));
            assert!((at[0].contact - contact).abs() < 1e-14, "{x}: {}", at[0].contact);
        }
        films.go_on();
        films.took(6.0, 7.0);
        films.tell(6.0, &mut at);
        assert!((at[0].friction - 2.0).abs() < 1e-14);
    }
}
