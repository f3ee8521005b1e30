//! Sizes of the gas spaces and openings of a ring pack, from where its rings are.

use std::f64::consts::{PI, TAU};

use gudgeon_core::EvalError;
use gudgeon_core::geometry::{BackVolume, PackGeometry, RingGeometry, RingPlace};

use crate::ring_passages::{FlankGap, Openings};

/// `½ [B_in + B_in + (c_1 + c_2) DR] π (R_int² - R_root²)`, the groove behind the ring.
pub(crate) fn back_volume(ring: &RingGeometry, liner_radius: f64, film: f64) -> f64 {
    let behind = ring.h_max(liner_radius) - film;
    let r_int = ring.root_radius + behind;
    let height = ring.groove_height_inner + 0.5 * (ring.slope_upper + ring.slope_lower) * behind;
    height * PI * (r_int * r_int - ring.root_radius * ring.root_radius)
}

/// Height \[m\] of the opening under a ring whose film thickness `film` is greater than its oil reaches; it opens without a corner.
pub(crate) fn lifted(film: f64, oil: f64) -> f64 {
    let x = (film - oil).max(0.0);
    x * x / (x + 0.1 * oil)
}

/// A pack and what of it a gas-flow model takes as constant.
#[derive(Debug, Clone)]
pub(crate) struct Spaces {
    pub pack: PackGeometry,
    /// `None`: that of the instant.
    pub nominal_film: Option<f64>,
    /// Lift, as a fraction of the clearance, over which the leak of a chamfer fades away.
    pub chamfer_fade: f64,
    /// Whether openings end at zero.
    pub bounded: bool,
}

impl Spaces {
    /// Film thickness \[m\] for sizes that are needed before a run.
    pub fn film(&self) -> f64 {
        self.nominal_film.unwrap_or(0.0)
    }

    /// Volume behind ring `i` in the nominal liner \[m³\]; 0 where it has no room.
    pub fn nominal_volume(&self, i: usize) -> f64 {
        let ring = &self.pack.rings[i];
        match ring.back {
            BackVolume::Fixed(v) if ring.has_room() => v,
            BackVolume::Geometric if ring.has_room() => back_volume(ring, self.pack.bore_radius, self.film()),
            _ => 0.0,
        }
    }

    /// Openings of ring `i` at the position `e`, in the nominal liner and without chamfers.
    pub fn nominal_openings(&self, i: usize, e: f64) -> Openings {
        let (pack, film) = (&self.pack, self.film());
        let ring = &pack.rings[i];
        let radial = (pack.bore_radius - ring.piston_radius_above - film).max(0.0);
        let behind = ring.h_max(pack.bore_radius) - film;
        let clearance = (ring.clearance_inner + (ring.slope_upper + ring.slope_lower) * behind).max(0.0);
        Openings {
            h: film,
            liner_radius: pack.bore_radius,
            lower: FlankGap::parallel(e * clearance),
            upper: FlankGap::parallel((1.0 - e) * clearance),
            leak: [ring.leak_lower, ring.leak_upper],
            lift_fraction: e,
            gap: ring.gap_area.unwrap_or(ring.gap * radial),
            back_volume: self.nominal_volume(i),
        }
    }

    /// Volume behind ring `i` at its place \[m³\], not yet checked; 0 where it has no room.
    pub fn volume_behind(&self, i: usize, place: &RingPlace) -> f64 {
        let ring = &self.pack.rings[i];
        match (ring.back, self.nominal_film) {
            _ if !ring.has_room() => 0.0,
            (BackVolume::Fixed(v), _) => v,
            (BackVolume::Geometric, None) => place.back_volume,
            (BackVolume::Geometric, Some(h)) => back_volume(ring, place.liner_radius, h),
            _ => 0.0,
        }
    }

    /// Distance of the walls of land `i` \[m\].
    pub fn land_width(&self, i: usize) -> f64 {
        self.pack.bore_radius - self.pack.rings[i].piston_radius_above
    }

    /// Distance of the walls behind ring `i` in the nominal liner \[m\].
    pub fn nominal_width_behind(&self, i: usize) -> f64 {
        self.pack.rings[i].h_max(self.pack.bore_radius) - self.film()
    }

    /// Distance of the walls behind ring `i` at its place \[m\]: that of the nominal liner where the volume is given.
    pub fn width_behind(&self, i: usize, place: &RingPlace) -> f64 {
        let ring = &self.pack.rings[i];
        match (ring.back, self.nominal_film) {
            (BackVolume::Geometric, None) => place.r_inner - ring.root_radius,
            (BackVolume::Geometric, Some(h)) => ring.h_max(place.liner_radius) - h,
            _ => self.nominal_width_behind(i),
        }
    }

    /// Openings of ring `i` at its place.
    ///
    /// # Errors
    /// Fatal, in the name of `model`, when the end gap is closed.
    pub fn openings(&self, model: &'static str, i: usize, place: &RingPlace) -> Result<Openings, EvalError> {
        let ring = &self.pack.rings[i];
        let h = self.nominal_film.unwrap_or(place.h);
        let clearance = self.clearance(ring, place);
        let e = place.lift_fraction.clamp(0.0, 1.0);
        let (lower, upper) = if self.bounded {
            (e * clearance, (1.0 - e) * clearance)
        } else {
            (place.s, clearance - place.s)
        };
        let chamfer = self.chamfer_area(ring, e);
        let area = match ring.gap_area {
            Some(a) => a,
            None => self.gap_area(model, i, place, h)?,
        };
        // A ring whose outer edge rises opens the lower gap outwards and closes the upper one.
        let rise = 0.5 * place.twist * (place.r_outer - place.r_inner);
        let open = place.flank.open;
        Ok(Openings {
            h,
            liner_radius: place.liner_radius,
            lower: FlankGap::wedge(lower, rise).times(open[0]),
            upper: FlankGap::wedge(upper, -rise).times(open[1]),
            leak: [ring.leak_lower * open[0], ring.leak_upper * open[1]],
            lift_fraction: e,
            gap: area + chamfer,
            back_volume: self.volume_behind(i, place),
        })
    }

    /// Axial clearance of a ring \[m\].
    fn clearance(&self, ring: &RingGeometry, place: &RingPlace) -> f64 {
        match self.nominal_film {
            _ if !ring.has_clearance => 0.0,
            None => place.clearance,
            Some(h) => {
                ring.clearance_inner
                    + (ring.slope_upper + ring.slope_lower) * (ring.h_max(place.liner_radius) - h)
            }
        }
        .max(0.0)
    }

    /// Area that the chamfers of the groove add to the end gap \[m²\].
    fn chamfer_area(&self, ring: &RingGeometry, e: f64) -> f64 {
        let seated = |distance: f64| {
            if self.chamfer_fade > 0.0 {
                (1.0 - distance / self.chamfer_fade).max(0.0)
            } else if distance == 0.0 {
                1.0
            } else {
                0.0
            }
        };
        ring.chamfer.area_lower * seated(e) + ring.chamfer.area_upper * seated(1.0 - e)
    }

    /// Area of the end gap \[m²\] where it follows from gap and land clearance.
    fn gap_area(&self, model: &'static str, i: usize, place: &RingPlace, h: f64) -> Result<f64, EvalError> {
        let ring = &self.pack.rings[i];
        let running = ring.gap + TAU * (place.liner_radius - self.pack.bore_radius);
        let radial = place.liner_radius - ring.piston_radius_above;
        if running <= 0.0 || radial <= 0.0 {
            return Err(EvalError::fatal(
                model,
                format!(
                    "the end gap of ring {} closes when hot: {:e} m at the nominal bore, {running:e} m in the liner of \
                     radius {} m, under a radial clearance of {radial:e} m",
                    i + 1,
                    ring.gap,
                    place.liner_radius
                ),
            ));
        }
        // A ring that has retreated behind its land leaves no gap of this kind.
        let radial = radial - h;
        Ok(running * if self.bounded { radial.max(0.0) } else { radial })
    }
}
