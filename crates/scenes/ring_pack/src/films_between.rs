//! What films do between the instants of a step at which they were solved.

use gudgeon_numerics::sdirk::GAMMA;

use super::instant::RingInstant;

/// Number of things that films do.
const COUNT: usize = 14;

/// What the film of a ring does at an instant, in the order of [`film`].
pub type Told = [f64; COUNT];

/// Film rate, viscosity, contact, perimeter, shear and force on the slope of the face, highest pressure, and what limits did. Friction follows from them, and bends
/// where the ring turns.
const fn film(r: &mut RingInstant) -> [&mut f64; COUNT] {
    let (f, l) = (&mut r.film, &mut r.limited);
    [
        &mut r.hdot,
        &mut r.mu,
        &mut r.contact,
        &mut r.perimeter,
        &mut f.ring_shear,
        &mut f.liner_shear,
        &mut f.slope_force,
        &mut r.film_p_max,
        &mut l.floor,
        &mut l.drag,
        &mut l.contact_drag,
        &mut l.slowed,
        &mut l.lifted,
        &mut l.thickest,
    ]
}

/// Films of all rings at the start of a step and at its stages, and the parabolas through them, which leave the range of the three nowhere.
#[derive(Debug, Clone)]
pub struct FilmsBetween {
    /// Start and length of the step \[rad\].
    step: (f64, f64),
    instants: [Vec<Told>; 3],
}

impl FilmsBetween {
    /// For as many rings.
    pub fn new(rings: usize) -> Self {
        let instant = || vec![[0.0; COUNT]; rings];
        Self { step: (0.0, 1.0), instants: [instant(), instant(), instant()] }
    }

    /// Keeps the rings at an instant of a step: its start, or a stage.
    pub fn keep(&mut self, instant: usize, rings: &[RingInstant]) {
        for (kept, ring) in self.instants[instant].iter_mut().zip(rings) {
            *kept = film(&mut { *ring }).map(|does| *does);
        }
    }

    /// The step from `t0` to `t1` was taken.
    pub const fn took(&mut self, t0: f64, t1: f64) {
        self.step = (t0, t1 - t0);
    }

    /// The end of the step is the start of the next.
    pub fn go_on(&mut self) {
        self.instants.swap(0, 2);
    }

    /// What the films of all rings do at `t`.
    pub fn at(&self, t: f64) -> impl Iterator<Item = Told> {
        let x = (t - self.step.0) / self.step.1;
        let weights = [
            (x - GAMMA) * (x - 1.0) / GAMMA,
            x * (1.0 - x) / (GAMMA * (1.0 - GAMMA)),
            x * (x - GAMMA) / (1.0 - GAMMA),
        ];
        let [first, second, last] = &self.instants;
        first.iter().zip(second).zip(last).map(move |((a, b), c)| between(&weights, a, b, c))
    }
}

/// Sum of three instants by their weights, within the range of these.
fn between(weights: &[f64; 3], a: &Told, b: &Told, c: &Told) -> Told {
    let (lower, higher) =
        (|a: f64, b: f64| if a < b { a } else { b }, |a: f64, b: f64| if a > b { a } else { b });
    let mut out = [0.0; COUNT];
    for (out, ((a, b), c)) in out.iter_mut().zip(a.iter().zip(b).zip(c)) {
        let parabola = weights[0] * a + weights[1] * b + weights[2] * c;
        *out = lower(higher(parabola, lower(lower(*a, *b), *c)), higher(higher(*a, *b), *c));
    }
    out
}

/// Has films do what is known of them.
pub fn tell(films: impl Iterator<Item = Told>, rings: &mut [RingInstant]) {
    for (told, ring) in films.zip(rings) {
        film(ring).into_iter().zip(told).for_each(|(does, told)| *does = told);
        ring.film_known = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_films_do_goes_by_a_parabola_within_the_range_of_its_ends() {
        let ring =
            |x: f64| RingInstant { hdot: x * (3.0 - x), contact: (x - 0.6).powi(2), ..Default::default() };
        let mut films = FilmsBetween::new(1);
        for (instant, x) in [0.0, GAMMA, 1.0].into_iter().enumerate() {
            films.keep(instant, &[ring(x)]);
        }
        films.took(2.0, 6.0);
        let at = |films: &FilmsBetween, t: f64| {
            let mut ring = [RingInstant::default()];
            tell(films.at(t), &mut ring);
            ring[0]
        };
        for x in [0.0, 0.2, 0.7, 0.95, 1.0] {
            let ring = at(&films, 2.0 + 4.0 * x);
            // Three products of numbers below ten.
            assert!((ring.hdot - x * (3.0 - x)).abs() < 1e-14, "{x}: {}", ring.hdot);
            // The least of the three is that at the first stage.
            let contact = (x - 0.6).powi(2).max((GAMMA - 0.6).powi(2));
            assert!((ring.contact - contact).abs() < 1e-14, "{x}: {}", ring.contact);
        }
        films.go_on();
        films.took(6.0, 7.0);
        assert!((at(&films, 6.0).hdot - 2.0).abs() < 1e-14);
    }
}
