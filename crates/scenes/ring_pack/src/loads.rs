//! What presses a ring against the liner and what carries it, as its radial motion asks for it.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::{RingGeometry, RingPlace};
use gudgeon_core::kinds::{
    FaceForces, FaceIn, FlankFriction, Hydrodynamics, OilTransport, RadialLoads, RadialResponse, RadialState,
    RadialTrials,
};

use super::contact_line::ContactLine;
use super::instant::RingInstant;

/// One ring at an instant, with the models that answer for it.
pub struct Loads<'a> {
    /// Geometry.
    pub geo: &'a RingGeometry,
    /// Where it is.
    pub place: &'a RingPlace,
    /// Pressures and viscosity.
    pub at: &'a RingInstant,
    /// Velocity of the liner seen from the ring, towards the top edge positive \[m/s\].
    pub u: f64,
    /// Zero-based number of the ring.
    pub ring: usize,
    /// Oil under the faces, where it is followed.
    pub oil: Option<&'a mut (dyn OilTransport + 'static)>,
    /// What gas on the dry parts of the faces carries per circumference \[N/m\], and its force along the liner.
    pub dry: (f64, f64),
    /// Solid contact.
    pub contact: &'a ContactLine,
    /// What its radial motion sees.
    pub state: RadialState,
    /// Circumference of all rails, which turns forces per length into forces \[m\].
    pub perimeter: f64,
    /// Parts of the friction of each land that are counted.
    pub shares: [f64; 2],
    /// Films of the lands.
    pub films: &'a mut [Box<dyn Hydrodynamics>],
    /// Friction on the flanks.
    pub friction: Option<&'a dyn FlankFriction>,
    /// Flux at the lower end of each film \[m²/s\].
    pub flux: [f64; 2],
    /// Counter of film evaluations.
    pub count: &'a mut u64,
}

/// Conditions of land `land` of a running face whose film is `h` \[m\] thick, between pressures; `u` is the velocity of the liner \[m/s\].
#[inline]
pub fn face_in(geo: &RingGeometry, h: f64, r: &RingInstant, u: f64, land: usize) -> FaceIn {
    let [p_bottom, p_top] = around_land(geo, r, land);
    FaceIn { h, u, p_bottom, p_top, p_cav: r.p_cav, mu: r.mu }
}

/// Pressures \[Pa\] below and above land `land` of the running face, the upper one being 0: slots join the space between two lands with that behind
/// the ring.
#[inline]
pub fn around_land(geo: &RingGeometry, r: &RingInstant, land: usize) -> [f64; 2] {
    match (geo.lands, land) {
        (2, 0) => [r.p_back, r.p_above],
        (2, _) => [r.p_below, r.p_back],
        _ => [r.p_below, r.p_above],
    }
}

/// Axial load that presses the flanks together, as the radial friction laws take it \[N\].
pub fn flank_load(place: &RingPlace, r: &RingInstant) -> f64 {
    0.5 * place.flank_area() * (r.p_below - r.p_above).abs()
}

impl Loads<'_> {
    /// The ring at this instant, its motion and its film found.
    pub fn found(&self, response: &RadialResponse, film: FaceForces) -> RingInstant {
        RingInstant {
            dry: self.dry,
            flux: self.flux,
            perimeter: self.perimeter,
            load: self.state.load,
            contact: self.state.contact,
            limited: response.limited,
            hdot: response.hdot,
            film,
            film_known: true,
            ..*self.at
        }
    }

    fn face(&self, land: usize) -> FaceIn {
        face_in(self.geo, self.state.thickness, self.at, self.u, land)
    }
}

impl RadialLoads for Loads<'_> {
    fn state(&self) -> &RadialState {
        &self.state
    }
    fn friction(&self, hdot: f64) -> (f64, f64) {
        let Some(f) = self.friction else { return (0.0, 0.0) };
        let axial = flank_load(self.place, self.at);
        (f.force(hdot, axial) / self.perimeter, f.derivative(hdot, axial) / self.perimeter)
    }
    fn film(&mut self, hdot: f64) -> Result<FaceForces, EvalError> {
        let mut sum = FaceForces::default();
        for land in 0..self.films.len() {
            *self.count += 1;
            let inp = self.face(land);
            let o = self.films[land].forces(&inp, hdot)?;
            let share = self.shares[land];
            self.flux[land] = o.flux;
            sum.load += o.load;
            sum.squeeze_damping += o.squeeze_damping;
            sum.ring_shear += share * o.ring_shear;
            sum.liner_shear += share * o.liner_shear;
            sum.slope_force += share * o.slope_force;
        }
        Ok(sum)
    }

    fn film_load(&mut self, hdot: f64) -> Result<(f64, f64), EvalError> {
        let mut sum = (0.0, 0.0);
        for land in 0..self.films.len() {
            *self.count += 1;
            let inp = self.face(land);
            let (load, damping) = self.films[land].load(&inp, hdot)?;
            sum = (sum.0 + load, sum.1 - damping);
        }
        Ok(sum)
    }

    fn carry(&mut self, load: f64) -> Result<(f64, FaceForces), EvalError> {
        *self.count += 1;
        let inp = self.face(0);
        self.films[0].carry(&inp, load)
    }

    fn flux(&mut self) -> &mut [f64; 2] {
        &mut self.flux
    }
}

impl RadialTrials for Loads<'_> {
    fn set_thickness(&mut self, h: f64) -> Result<(), EvalError> {
        (self.state.thickness, self.state.contact) = (h, self.contact.load(h));
        if let Some(oil) = self.oil.as_deref_mut() {
            self.dry = wet_faces(oil, self.ring, h, (self.geo, self.at), self.films)?;
            self.state.dry = self.dry.0;
        }
        Ok(())
    }
}

/// Film thickness at which a ring is flush with its land or touches the groove root \[m\]: it cannot retreat further.
pub fn furthest(geo: &RingGeometry, place: &RingPlace) -> f64 {
    geo.h_max(place.liner_radius).min(place.liner_radius - geo.piston_radius_above)
}

/// Lets the films of ring `i`, `h` \[m\] thick, reach as far as its oil does. What gas on the dry parts of the faces carries per circumference \[N/m\], and its force
/// along the liner.
pub fn wet_faces(
    oil: &mut dyn OilTransport,
    i: usize,
    h: f64,
    (geo, at): (&RingGeometry, &RingInstant),
    films: &mut [Box<dyn Hydrodynamics>],
) -> Result<(f64, f64), EvalError> {
    let mut dry = (0.0, 0.0);
    for k in 0..oil.faces().len() {
        let (ring, land) = oil.faces()[k];
        if ring != i {
            continue;
        }
        let e = oil.extent(k, h);
        if !films[land].set_extent(e.from, e.to) {
            return Err(EvalError::fatal("ring_pack", "this film cannot be confined to a part of its face"));
        }
        let [bottom, top] = around_land(geo, at, land).map(|p| p - at.p_cav);
        let (d, length) = (e.drops, geo.face.length());
        dry.0 += bottom * e.from + top * (length - e.to);
        dry.1 -= bottom * (d[1] - d[0]) + top * (d[3] - d[2]);
    }
    Ok(dry)
}
