//! The oil under one running face: two volumes, how far they reach, what has no room.

use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{OilExtent, OilFacePlace};

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
    /// Gap at the meniscus \[m\]; before the edge it opens slowly as it gets longer.
    pub gap: f64,
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
    /// Shape.
    pub profile: FaceProfile,
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
    /// Edges at the start of the step \[m\].
    pub edge: [f64; SIDES],
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
            profile: p.profile.clone(),
            offset: p.offset,
            room: p.clearance.map(|c| c.map_or(0.0, |c| 0.5 * c.min(wave).powi(2) / WAVE_SLOPE)),
            exit,
            gap,
            taken: [0.0; SIDES],
            owed: 0.0,
            edge: [0.0; SIDES],
            volume: [0.0; SIDES],
            reach: [Reach::default(); SIDES],
        }
    }

    /// Bottom and top edge \[m\] with the pin at `pin`.
    pub fn edges(&self, pin: f64) -> [f64; SIDES] {
        [pin + self.offset, pin + self.offset + self.length]
    }

    /// Distance from the narrowest place to an edge \[m\].
    pub fn span(&self, side: usize) -> f64 {
        if side == 0 { self.narrowest } else { self.length - self.narrowest }
    }

    /// Drop at distance `t` \[m\] from the narrowest place.
    pub fn drop_at(&self, t: f64, side: usize) -> f64 {
        let x = if side == 0 { self.narrowest - t } else { self.narrowest + t };
        self.profile.drop_at(x)
    }

    /// Volume \[m²\] between the narrowest place and distance `t` from it under a film of `h` \[m\].
    pub fn held(&self, h: f64, t: f64, side: usize) -> f64 {
        match &self.profile {
            FaceProfile::Parabola { curvature, apex, .. } => {
                let e = (self.narrowest - apex) * if side == 0 { -1.0 } else { 1.0 };
                h * t + curvature * t * (e * e + t * (e + t / 3.0))
            }
            FaceProfile::Taper { length, land, drop } => {
                // Only above its narrowest place, the middle of the land, does the face fall.
                let over = (self.narrowest + t - land).max(0.0) * if side == 0 { 0.0 } else { 1.0 };
                h * t + 0.5 * over * over * drop / (length - land)
            }
            FaceProfile::Table { length, drops } => {
                let n = drops.len() - 1;
                let step = length / n as f64;
                let (a, b) = if side == 0 {
                    (self.narrowest - t, self.narrowest)
                } else {
                    (self.narrowest, self.narrowest + t)
                };
                let mut sum = h * t;
                for k in 0..n {
                    let (lo, hi) = ((k as f64 * step).max(a), ((k + 1) as f64 * step).min(b));
                    if hi > lo {
                        sum += 0.5 * (hi - lo) * (self.profile.drop_at(lo) + self.profile.drop_at(hi));
                    }
                }
                sum
            }
        }
    }

    /// Volume up to the edge \[m²\].
    pub fn capacity(&self, h: f64, side: usize) -> f64 {
        self.held(h, self.span(side), side)
    }

    /// Where the oil of a side ends under a film of `h` \[m\].
    pub fn reach_of(&self, h: f64, side: usize) -> Reach {
        let (volume, span) = (self.volume[side], self.span(side));
        let full = self.capacity(h, side);
        if volume >= full {
            let edge = h + self.drop_at(span, side);
            return Reach { length: span, gap: (edge * edge + 2.0 * WAVE_SLOPE * (volume - full)).sqrt() };
        }
        let least = (MIN_REACH * self.length).min(span);
        // What there is reaches so far, and never less than the least: joined without a corner.
        let joined = |t: f64| {
            let length = (t * t + least * least).sqrt().min(span);
            Reach { length, gap: h + self.drop_at(length, side) }
        };
        if volume <= 0.0 {
            return joined(0.0);
        }
        // The volume grows faster than h t, and under a parabola faster than its cube: Newton's method comes from the right, inside a
        // bracket.
        let (mut lo, mut hi) = (0.0, (volume / h).min(span));
        if let FaceProfile::Parabola { curvature, .. } = &self.profile
            && *curvature > 0.0
        {
            hi = hi.min((3.0 * volume / curvature).cbrt());
        }
        let mut t = hi;
        for _ in 0..60 {
            let f = self.held(h, t, side) - volume;
            if f > 0.0 {
                hi = t;
            } else {
                lo = t;
            }
            let step = f / (h + self.drop_at(t, side));
            if step.abs() <= 4.0 * f64::EPSILON * t {
                break;
            }
            let next = t - step;
            t = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
        }
        joined(t)
    }

    /// Sets the extent of the film for a film thickness \[m\] and gives it in coordinates of the face.
    pub fn set_reach(&mut self, h: f64) -> OilExtent {
        for side in 0..SIDES {
            self.reach[side] = self.reach_of(h, side);
        }
        let from = (self.narrowest - self.reach[0].length).max(0.0);
        let to = (self.narrowest + self.reach[1].length).min(self.length);
        OilExtent { from, to, drops: self.drops() }
    }

    /// Drops at the ends of the face and of the film: bottom edge, lower meniscus, upper meniscus, top edge \[m\].
    fn drops(&self) -> [f64; 4] {
        [
            self.drop_at(self.span(0), 0),
            self.drop_at(self.reach[0].length, 0),
            self.drop_at(self.reach[1].length, 1),
            self.drop_at(self.span(1), 1),
        ]
    }
}
