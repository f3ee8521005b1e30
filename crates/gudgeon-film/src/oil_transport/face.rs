//! The oil under one running face: two volumes, how far they reach, what has no room.

use gudgeon_core::kinds::{OilExtent, OilFacePlace};

use super::side::Side;

/// Least reach of a film to either side of the narrowest place, as a part of the face: a face without oil still has a film to
/// evaluate, which carries next to nothing.
pub const MIN_REACH: f64 = 0.1;
/// How steeply the gap opens before an edge, where oil stands as a wave.
pub const WAVE_SLOPE: f64 = 0.02;

/// Below and above.
pub const SIDES: usize = 2;

/// Where the oil of one side of a face ends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reach {
    /// Distance of the meniscus from the narrowest place, not beyond the edge \[m\].
    pub length: f64,
    /// Drop of the face there \[m\].
    pub drop: f64,
    /// Gap at the meniscus \[m\]; before the edge it opens slowly as it gets longer.
    pub gap: f64,
}

/// Film that an edge left over its way.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Trail {
    /// Heights at which the way begins and ends \[m\].
    pub from: f64,
    pub to: f64,
    /// Thickness \[m\].
    pub film: f64,
}

/// One running face.
#[derive(Debug, Clone)]
pub struct OilFace {
    /// Ring, from 0.
    pub ring: usize,
    /// Land of a twin-land ring, upper first.
    pub land: usize,
    /// Length of the face \[m\].
    pub length: f64,
    /// Narrowest place above the bottom edge \[m\].
    pub narrowest: f64,
    /// What is below and what is above the narrowest place.
    sides: [Side; SIDES],
    /// Bottom edge above the pin \[m\].
    pub offset: f64,
    /// Volume for which there is room before each edge \[m²\].
    pub room: [f64; SIDES],
    /// Where oil goes that has no room: the land, from the crown down; the crankcase comes after the lowest.
    pub exit: [usize; SIDES],
    /// Share of the circumference that the end gap of the ring leaves open before each edge: where no other land of the ring has passed.
    pub gap: [f64; SIDES],
    /// Taken up since the states were last told \[m²\].
    pub taken: [f64; SIDES],
    /// Lost and not laid down yet \[m²\]: negative where the face has more than it took up.
    pub owed: f64,
    /// What the states hold at the start of the step \[m²\].
    pub before: f64,
    /// Film that the trailing edge has left over the step so far.
    pub trail: Trail,
    /// Edges at the start of the step \[m\].
    pub edge: [f64; SIDES],
    /// Film on the liner below those edges then \[m²\].
    pub below: [f64; SIDES],
    /// Volumes now \[m²\].
    pub volume: [f64; SIDES],
    /// Extent of the film now, and the menisci.
    pub reach: [Reach; SIDES],
}

impl OilFace {
    /// A face without oil; `exit`: where oil goes that has no room before each edge, `gap` the share of the circumference that is open there, and `wave` the
    /// highest wave \[m\] that stands before an edge.
    pub fn new(p: &OilFacePlace, exit: [usize; SIDES], gap: [f64; SIDES], wave: f64) -> Self {
        Self {
            ring: p.ring,
            land: p.land,
            length: p.profile.length(),
            narrowest: p.profile.narrowest(),
            sides: [Side::new(&p.profile, 0), Side::new(&p.profile, 1)],
            offset: p.offset,
            room: p.clearance.map(|c| c.map_or(0.0, |c| 0.5 * c.min(wave).powi(2) / WAVE_SLOPE)),
            exit,
            gap,
            taken: [0.0; SIDES],
            owed: 0.0,
            before: 0.0,
            trail: Trail::default(),
            edge: [0.0; SIDES],
            below: [0.0; SIDES],
            volume: [0.0; SIDES],
            reach: [Reach::default(); SIDES],
        }
    }

    /// Bottom and top edge \[m\] with the pin at `pin`.
    pub fn edges(&self, pin: f64) -> [f64; SIDES] {
        [pin + self.offset, pin + self.offset + self.length]
    }

    /// Which edge trails with the pin at `pin`: the upper one on the way down.
    pub fn trailing(&self, pin: f64) -> usize {
        usize::from(pin + self.offset < self.edge[0])
    }

    /// The film behind the trailing edge with the pin at `pin`, whose volume is `lost` \[m²\].
    pub fn trail(&self, pin: f64, lost: f64) -> Trail {
        let side = self.trailing(pin);
        let (from, to) = (self.edge[side], self.edges(pin)[side]);
        let way = (to - from).abs();
        Trail { from, to, film: if way > 0.0 { lost.max(0.0) / way } else { 0.0 } }
    }

    /// Distance from the narrowest place to an edge \[m\].
    pub fn span(&self, side: usize) -> f64 {
        self.sides[side].span
    }

    /// Drop at distance `t` \[m\] from the narrowest place.
    pub fn drop_at(&self, t: f64, side: usize) -> f64 {
        self.sides[side].drop_at(t)
    }

    /// Volume \[m²\] between the narrowest place and distance `t` from it under a film of `h` \[m\].
    pub fn held(&self, h: f64, t: f64, side: usize) -> f64 {
        self.sides[side].held(h, t)
    }

    /// Volume up to the edge \[m²\].
    pub fn capacity(&self, h: f64, side: usize) -> f64 {
        self.sides[side].capacity(h)
    }

    /// Where the oil of a side ends under a film of `h` \[m\].
    pub fn reach_of(&self, h: f64, side: usize) -> Reach {
        let (volume, side) = (self.volume[side], &self.sides[side]);
        let full = side.capacity(h);
        if volume >= full {
            let (length, drop) = (side.span, side.edge_drop);
            let edge = h + drop;
            return Reach { length, drop, gap: (edge * edge + 2.0 * WAVE_SLOPE * (volume - full)).sqrt() };
        }
        let t = if volume > 0.0 { side.distance(h, volume) } else { 0.0 };
        // What there is reaches so far, and never less than the least: joined without a corner.
        let least = (MIN_REACH * self.length).min(side.span);
        let length = (t * t + least * least).sqrt().min(side.span);
        let drop = side.drop_at(length);
        Reach { length, drop, gap: h + drop }
    }

    /// Sets the extent of the film for a film thickness \[m\] and gives it in coordinates of the face.
    pub fn set_reach(&mut self, h: f64) -> OilExtent {
        self.reach = [self.reach_of(h, 0), self.reach_of(h, 1)];
        let [below, above] = self.reach;
        OilExtent {
            from: (self.narrowest - below.length).max(0.0),
            to: (self.narrowest + above.length).min(self.length),
            drops: [self.sides[0].edge_drop, below.drop, above.drop, self.sides[1].edge_drop],
        }
    }
}
