//! The ruptured film of a crowned face in its natural coordinate, from films that are solutions by construction.
//!
//! For a place of rupture, a place of reformation and a squeeze velocity that are given, the pressures at the edges and the load follow by quadrature. The
//! searches must find the places again.

use gudgeon_film::parts::{Asked, Crown, Crowned};

/// Nodes and weights of Gauss's 5-point rule.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let n = 200;
    let half = 0.5 * (to - from) / f64::from(n);
    let panel = |k: i32| -> f64 {
        let middle = from + half * f64::from(2 * k + 1);
        GAUSS.iter().map(|(x, w)| w * f(middle + half * x)).sum()
    };
    half * (0..n).map(panel).sum::<f64>()
}

/// A film that ruptures at `xr` and reforms at `xf` while its thickness changes at the rate `v`. Pressures over `12 μ`.
#[derive(Debug, Clone, Copy)]
struct Known {
    length: f64,
    apex: f64,
    curvature: f64,
    h: f64,
    v: f64,
    xr: f64,
    xf: f64,
    asked: Asked,
    load: f64,
    /// What the rounding of all pressures and loads in play makes of the two places and of the velocity under a load.
    unit: [f64; 3],
}

impl Known {
    fn drop(&self, s: f64) -> f64 {
        self.curvature * s * s
    }

    /// Film thickness to the third power at `s` from the apex.
    fn cube(&self, s: f64) -> f64 {
        (self.h + self.drop(s)).powi(3)
    }

    fn flux(&self) -> f64 {
        let s = self.xr - self.apex;
        self.asked.u * self.drop(s) + self.v * s
    }

    /// Second derivative of the pressure at the rupture, times `h³`.
    fn rising(&self) -> f64 {
        2.0 * self.asked.u * self.curvature * (self.xr - self.apex) + self.v
    }

    /// `∫ s^k dp/dx dx` between two places, and the same with the absolute values of its three terms.
    fn moment(&self, from: f64, to: f64, k: i32) -> (f64, f64) {
        let (u, v, q) = (self.asked.u, self.v, self.flux());
        let part = |g: &dyn Fn(f64) -> f64| {
            integral(from - self.apex, to - self.apex, |s| g(s) * s.powi(k) / self.cube(s))
        };
        let whole = part(&|s| u * self.drop(s) + v * s - q);
        let size = part(&|s| (u * self.drop(s) + (v * s).abs() + q.abs()) * s.signum().powi(k));
        (whole, size)
    }

    /// `∫ s^k/h³ dx` between two places.
    fn weight(&self, from: f64, to: f64, k: i32) -> f64 {
        integral(from - self.apex, to - self.apex, |s| s.powi(k) / self.cube(s))
    }

    /// Completes what follows from the places. `None` where an edge would need suction.
    fn complete(mut self) -> Option<Self> {
        let (l, xr, xf) = (self.length, self.xr, self.xf);
        let ((lead, lead_size), (trail, trail_size)) = (self.moment(0.0, xr, 0), self.moment(xf, l, 0));
        (self.asked.pa, self.asked.pb) = (-lead, trail);
        if !(self.asked.pa > 0.0 && self.asked.pb > 0.0) {
            return None;
        }
        let ((lead_s, lead_s_size), (trail_s, trail_s_size)) =
            (self.moment(0.0, xr, 1), self.moment(xf, l, 1));
        let (a, b) = (-self.apex, l - self.apex);
        self.load = b * self.asked.pb - a * self.asked.pa - lead_s - trail_s;
        let load_size = l * (self.asked.pa + self.asked.pb) + lead_s_size + trail_s_size;
        let sf = xf - self.apex;
        let rising = self.rising();
        let [i3, x3, xx3] = [0, 1, 2].map(|k| self.weight(0.0, xr, k));
        let gradient = (self.asked.u * self.drop(sf) + self.v * sf - self.flux()) / self.cube(sf);
        let rupture = (self.asked.pa + lead_size) / (rising * i3);
        let front = (self.asked.pb + trail_size + self.weight(xf, l, 0) * rising * rupture) / gradient;
        let rate = load_size / (xx3 - x3 * x3 / i3);
        // Places count from the edge, so that their own rounding is that of the length.
        self.unit = [rupture + l, front + l, rate].map(|u| f64::EPSILON * u);
        Some(self)
    }

    fn crown(&self) -> Crown {
        Crown::new(self.length, self.apex, self.curvature, 1.0 / self.curvature, self.h)
    }

    /// Unit of the natural coordinate.
    fn natural(&self) -> f64 {
        (self.h / self.curvature).sqrt()
    }
}

/// Films of barrels with 1 µm to 30 µm drop, thin and thick, standing still, rising and falling, whose two places are where differences
/// in the natural coordinate keep their digits: the film at the front is less than ten times the thinnest.
fn films() -> Vec<Known> {
    let mut all = Vec::new();
    let (length, load, unit) = (1.2e-3, 0.0, [0.0; 3]);
    for apex in [0.3e-3, 0.5e-3, 0.7e-3] {
        for drop in [1e-6, 6e-6, 30e-6] {
            for h in [0.3e-6, 1e-6, 4e-6] {
                for v in [-3e-3, -1e-4, 0.0, 2e-3] {
                    for (r, f) in [(0.1, 0.5), (0.2, 0.6), (0.4, 0.8), (0.6, 0.7)] {
                        let (xr, xf) = (apex + r * (length - apex), apex + f * (length - apex));
                        let asked = Asked { u: 4.0, pa: 0.0, pb: 0.0, trailing: true };
                        let curvature = drop / 0.36e-6;
                        let film = Known { length, apex, curvature, h, v, xr, xf, asked, load, unit };
                        if film.drop(xf - apex) < 9.0 * h {
                            all.extend(film.complete());
                        }
                    }
                }
            }
        }
    }
    all
}

/// Starts off the two places by up to 3 % of the natural unit, or of what there is behind the front. Small enough that what is asked first is
/// whether the last step, after which the search does not look again, has the order that its stopping rule counts on.
fn starts(film: &Known) -> impl Iterator<Item = (f64, f64)> {
    let (lead, front) = (film.natural(), film.natural().min(film.length - film.xf));
    let (xr, xf) = (film.xr, film.xf);
    (0..32).flat_map(move |k| {
        let d = 5e-6 * 1.3_f64.powi(k);
        [(d, 0.0), (-d, 0.0), (0.0, d), (0.0, -d), (d, -d)].map(|(a, b)| (xr + a * lead, xf + b * front))
    })
}

/// Units of rounding that a found film may be off by: some ten sums of terms, of which differences in the natural coordinate lose up to a digit.
const ROUNDINGS: f64 = 50.0;

/// Whether places and velocity are those known, to rounding. What a step short of its order would leave is 1e-12 of the natural unit.
fn check(what: &str, film: &Known, found: &Crowned) {
    let front = found.front.map_or(f64::NAN, |f| f.0);
    for (name, got, want, unit) in [
        ("rupture", found.x, film.xr, film.unit[0]),
        ("front", front, film.xf, film.unit[1]),
        ("velocity", found.v, film.v, film.unit[2]),
        ("flux", found.q, film.flux(), film.unit[0] * film.rising() + film.unit[2] * (film.xr - film.apex)),
    ] {
        assert!((got - want).abs() <= ROUNDINGS * unit, "{what} {name}: {got:e} {want:e} {unit:e}\n{film:?}");
    }
}

#[test]
fn films_at_a_squeeze_velocity_are_found_from_places_nearby() {
    let all = films();
    assert!(all.len() > 100, "{}", all.len());
    for film in &all {
        for (xr, xf) in starts(film) {
            let found = film.crown().at_rate(&film.asked, film.v, xr, xf);
            check("at rate", film, &found.unwrap_or_else(|| panic!("found in six steps: {film:?}")));
        }
    }
}

#[test]
fn films_under_a_load_are_found_from_places_nearby() {
    for film in &films() {
        for (xr, xf) in starts(film) {
            let found = film.crown().under_load(&film.asked, film.load, xr, xf);
            check("under load", film, &found.unwrap_or_else(|| panic!("found in six steps: {film:?}")));
        }
    }
}
