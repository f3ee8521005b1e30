//! Oil on the liner and under the faces: who holds it, who takes it up, who leaves it behind.
//!
//! Each running face has two states, the volumes of oil per circumference that it holds below and above its narrowest place.
//! They say how far the film reaches (`extent`), and the flux of the film moves oil from one to the other (`rates`). The liner
//! carries a film on a fixed grid. What a leading edge takes up is known before it gets there: it is added to the state as the
//! integral of the film over the way it went, so that no step needs to resolve the film it passes. What a trailing edge leaves
//! is what the states of its face lost over a step, laid down over the way the edge went. Nothing is therefore ever gained or
//! lost, whatever the tolerance.
//!
//! In a cell of the grid that an edge stands in, the thickness is that of the part outside the face.

use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::OilTransport;

/// Least reach of a film to either side of the narrowest place, as a part of the face: a face without oil still has a film to
/// evaluate, which carries next to nothing.
const LEAST_REACH: f64 = 0.1;
/// How steeply the gap opens before an edge, where oil stands as a wave.
const WAVE_SLOPE: f64 = 0.02;
/// Part of each side of a face that is wetted at the start.
const FIRST_REACH: f64 = 0.1;
/// Film of the unit of the volume states \[m\].
const UNIT_FILM: f64 = 1e-6;

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
    /// Index of the volume below; that above follows.
    pub state: usize,
    /// Length of the face \[m\].
    pub length: f64,
    /// Narrowest place above the bottom edge \[m\].
    pub narrowest: f64,
    profile: FaceProfile,
    /// Bottom edge above the pin \[m\].
    offset: f64,
    /// Volume for which there is room before each edge \[m²\].
    room: [f64; SIDES],
    /// Where oil goes that has no room.
    exit: [Exit; SIDES],
    /// Taken up since the states were last told \[m²\].
    taken: [f64; SIDES],
    /// Lost and not laid down yet \[m²\]: negative where the face has more than it took up.
    owed: f64,
    /// Edges at the start of the step \[m\].
    edge: [f64; SIDES],
    /// Volumes now \[m²\].
    pub volume: [f64; SIDES],
    /// Extent of the film now, and the menisci.
    pub reach: [Reach; SIDES],
    /// Rates of the volumes without what is taken up \[m²/s\].
    pub rate: [f64; SIDES],
}

/// Where oil goes that has no room before an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Exit {
    Crankcase,
    Chamber,
}

/// What left and what came, per circumference \[m²\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ledger {
    /// From the crankcase onto the liner, net of what was there.
    pub supplied: f64,
    /// Into the crankcase.
    pub drained: f64,
    /// Into the combustion chamber.
    pub thrown: f64,
    /// Taken up by all faces.
    pub taken: f64,
}

/// A ring's oil at an instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RingOil {
    /// Share of its faces under full film.
    pub wetted: f64,
    /// Oil held, per circumference \[m²\].
    pub held: f64,
    /// Film left on the liner \[m\].
    pub left: f64,
}

/// Description of a face for [`OilPack::new`].
#[derive(Debug, Clone)]
pub struct FacePlace {
    /// Ring, from 0.
    pub ring: usize,
    /// Land of a twin-land ring.
    pub land: usize,
    /// Shape.
    pub profile: FaceProfile,
    /// Bottom edge above the pin \[m\].
    pub offset: f64,
    /// Radial clearance of the lands below and above \[m\]; `None` where oil drains at once.
    pub clearance: [Option<f64>; SIDES],
}

/// All oil of a pack.
#[derive(Debug)]
pub struct OilPack {
    /// The model.
    pub model: Box<dyn OilTransport>,
    /// Faces, from the top down.
    pub faces: Vec<OilFace>,
    /// Film on the liner \[m\], from the lowest cell up.
    pub film: Vec<f64>,
    /// Height of the lower end of the lowest cell \[m\].
    pub bottom: f64,
    /// Height of a cell \[m\].
    pub cell: f64,
    /// Volume of the film below each cell.
    sum: Vec<f64>,
    /// What came and went.
    pub ledger: Ledger,
    /// Smallest distance between two faces \[m\].
    pub least_gap: f64,
}

impl OilPack {
    /// Sets up the oil of faces listed from the top down; the pin moves between `lowest` and `highest` \[m\]. The states of the
    /// faces begin at `state`.
    #[must_use]
    pub fn new(
        model: Box<dyn OilTransport>,
        places: Vec<FacePlace>,
        lowest: f64,
        highest: f64,
        state: usize,
    ) -> Self {
        let mut least = model.spacing();
        let mut least_gap = f64::INFINITY;
        for p in &places {
            least = least.min(0.5 * p.profile.length());
        }
        for w in places.windows(2) {
            let gap = w[0].offset - (w[1].offset + w[1].profile.length());
            least_gap = least_gap.min(gap);
        }
        // A cell holds the edge of one face at most.
        let least = least.min(0.5 * least_gap.max(1e-6));
        let wave = model.highest_wave();
        let faces: Vec<OilFace> = places
            .into_iter()
            .enumerate()
            .map(|(k, p)| {
                let length = p.profile.length();
                let narrowest = match &p.profile {
                    FaceProfile::Parabola { apex, .. } => apex.clamp(0.0, length),
                    FaceProfile::Taper { land, .. } => 0.5 * land,
                    FaceProfile::Table { drops, .. } => {
                        let low = drops.iter().copied().fold(f64::INFINITY, f64::min);
                        // The middle of a flat bottom.
                        let first = drops.iter().position(|d| *d == low).unwrap_or(0);
                        let last = drops.iter().rposition(|d| *d == low).unwrap_or(0);
                        0.5 * (first + last) as f64 * length / (drops.len() - 1) as f64
                    }
                };
                OilFace {
                    ring: p.ring,
                    land: p.land,
                    state: state + SIDES * k,
                    length,
                    narrowest,
                    profile: p.profile,
                    offset: p.offset,
                    room: p.clearance.map(|c| c.map_or(0.0, |c| 0.5 * c.min(wave).powi(2) / WAVE_SLOPE)),
                    exit: [Exit::Crankcase, if k == 0 { Exit::Chamber } else { Exit::Crankcase }],
                    taken: [0.0; SIDES],
                    owed: 0.0,
                    edge: [0.0; SIDES],
                    volume: [0.0; SIDES],
                    reach: [Reach::default(); SIDES],
                    rate: [0.0; SIDES],
                }
            })
            .collect();
        let top = faces.first().map_or(0.0, |f| f.offset + f.length) + highest;
        let low = faces.last().map_or(0.0, |f| f.offset) + lowest;
        let margin = 2e-3;
        let cells = (((top - low + 2.0 * margin) / least).ceil() as usize).max(8);
        let cell = (top - low + 2.0 * margin) / cells as f64;
        let film = vec![model.initial(); cells];
        Self {
            model,
            faces,
            film,
            bottom: low - margin,
            cell,
            sum: vec![0.0; cells + 1],
            ledger: Ledger::default(),
            least_gap,
        }
    }

    /// Number of volume states.
    #[must_use]
    pub fn states(&self) -> usize {
        SIDES * self.faces.len()
    }

    /// Volume of one unit of the states of face `f` \[m²\].
    #[must_use]
    pub fn unit(&self, f: usize) -> f64 {
        UNIT_FILM * self.faces[f].length
    }

    /// Faces that hold a little at film thickness `h` \[m\], for the first cycle: oil comes with the first stroke, and what there is
    /// too much of takes many cycles to go.
    pub fn start(&mut self, h: impl Fn(usize) -> f64, y: &mut [f64]) {
        for k in 0..self.faces.len() {
            let f = &self.faces[k];
            let (h, unit, at) = (h(f.ring), self.unit(k), f.state);
            for side in 0..SIDES {
                y[at + side] = f.held(h, FIRST_REACH * f.span(side), side) / unit;
            }
        }
        self.film.fill(self.model.initial());
    }

    /// Begins a cycle: nothing is taken up yet, the edges stand where they are with the pin at `pin` \[m\], and the liner below
    /// the pack is supplied.
    pub fn begin(&mut self, pin: f64) {
        self.ledger = Ledger::default();
        for f in &mut self.faces {
            (f.taken, f.owed) = ([0.0; SIDES], 0.0);
            f.edge = f.edges(pin);
        }
        if let Some(z) = self.faces.last().map(|f| f.edge[0]) {
            self.supply(self.bottom, z);
        }
        self.add_up();
    }

    /// Ends a cycle: what was taken up becomes part of the states.
    pub fn fold(&mut self, y: &mut [f64]) {
        for k in 0..self.faces.len() {
            let unit = self.unit(k);
            let f = &mut self.faces[k];
            for side in 0..SIDES {
                y[f.state + side] += f.taken[side] / unit;
                f.taken[side] = 0.0;
            }
            y[f.state] += f.owed / unit;
            f.owed = 0.0;
        }
    }

    fn add_up(&mut self) {
        let mut sum = 0.0;
        for (s, h) in self.sum.iter_mut().zip(&self.film) {
            *s = sum;
            sum += h * self.cell;
        }
        if let Some(last) = self.sum.last_mut() {
            *last = sum;
        }
    }

    /// Volume of the film on the liner below height `z`.
    fn below(&self, z: f64) -> f64 {
        let x = ((z - self.bottom) / self.cell).clamp(0.0, self.film.len() as f64);
        let k = (x as usize).min(self.film.len() - 1);
        self.sum[k] + (x - k as f64) * self.cell * self.film[k]
    }

    /// Volumes for a state, with the pin at `pin` \[m\].
    pub fn set_volumes(&mut self, y: &[f64], pin: f64) {
        for k in 0..self.faces.len() {
            let unit = self.unit(k);
            let swept = self.swept(k, pin);
            let f = &mut self.faces[k];
            for side in 0..SIDES {
                f.volume[side] = y[f.state + side] * unit + f.taken[side] + swept[side];
            }
        }
    }

    /// Volumes of the faces as they were at some instant.
    pub fn hold_volumes(&mut self, held: &[[f64; SIDES]]) {
        for (f, held) in self.faces.iter_mut().zip(held) {
            f.volume = *held;
        }
    }

    /// What the edges of face `k` have passed since the start of the step.
    fn swept(&self, k: usize, pin: f64) -> [f64; SIDES] {
        let f = &self.faces[k];
        let e = f.edges(pin);
        [
            if e[0] < f.edge[0] { self.below(f.edge[0]) - self.below(e[0]) } else { 0.0 },
            if e[1] > f.edge[1] { self.below(e[1]) - self.below(f.edge[1]) } else { 0.0 },
        ]
    }

    /// Sets the rates of face `k`: `h`, `hdot` film thickness and its rate, `u` velocity of the liner seen from the ring, `flux` of the
    /// film at its lower end.
    pub fn set_rates(&mut self, k: usize, h: f64, hdot: f64, u: f64, flux: f64) {
        let f = &mut self.faces[k];
        let least = h * LEAST_REACH * f.length;
        // A side that has no oil gives none; one that errors have made owe some takes it back in the same time. With a corner at zero,
        // near which a nearly dry side rests, every other step would be wrong.
        let has = |side: usize| {
            let x = (f.volume[side] / least).clamp(-1.0, 1.0);
            x * (2.0 - x.abs())
        };
        let through = flux - hdot * f.reach[0].length + self.model.through_valleys(h, u.abs()).copysign(u);
        let through = through * if through > 0.0 { has(0) } else { has(1) };
        let mut rate = [-through, through];
        let trailing = usize::from(u > 0.0);
        rate[trailing] -= u.abs() * self.model.left_behind(f.reach[trailing].gap, u.abs()) * has(trailing);
        f.rate = rate;
    }

    /// Books a step from `y0` to `y1` that ended with the pin at `pin` \[m\]; `h` are the film thicknesses of the rings at its end.
    pub fn book(&mut self, y0: &[f64], y1: &[f64], pin: f64, h: impl Fn(usize) -> f64) {
        for k in 0..self.faces.len() {
            let (unit, swept, from) = (self.unit(k), self.swept(k, pin), self.faces[k].edge);
            let f = &mut self.faces[k];
            let to = f.edges(pin);
            let s = f.state;
            for side in 0..SIDES {
                f.taken[side] += swept[side];
                self.ledger.taken += swept[side];
            }
            // What the face lost stays behind its trailing edge. Integration errors may make it less than nothing: that is owed,
            // for the volumes must not jump, which would spoil the time derivatives of the next step.
            let lost = f.owed - ((y1[s] - y0[s]) + (y1[s + 1] - y0[s + 1])) * unit;
            let trailing = usize::from(to[1] < from[1]);
            let way = (to[trailing] - from[trailing]).abs();
            // The wave before the leading edge, beyond what there is room for, goes; nothing else depends on it.
            let leading = 1 - trailing;
            let volume = y1[s + leading] * unit + f.taken[leading];
            let left = (volume - f.capacity(h(f.ring), leading) - f.room[leading]).max(0.0);
            f.taken[leading] -= left;
            let laid = if way > 0.0 { lost.max(0.0) } else { 0.0 };
            f.owed = lost - laid;
            match f.exit[leading] {
                Exit::Crankcase => self.ledger.drained += left,
                Exit::Chamber => self.ledger.thrown += left,
            }
            if way > 0.0 {
                self.lay(from[trailing], to[trailing], laid / way, trailing);
            }
            self.faces[k].edge = to;
        }
        // The crankcase wets what the lowest ring uncovers.
        if let Some(f) = self.faces.last() {
            let z = f.edge[0];
            self.supply(self.bottom, z);
        }
        self.add_up();
    }

    /// Lays a film of `thickness` where an edge went from `a` to `b`; outside the face is above a top edge (`side` 1), below a
    /// bottom edge.
    fn lay(&mut self, a: f64, b: f64, thickness: f64, side: usize) {
        let (lo, hi) = (a.min(b), a.max(b));
        let n = self.film.len();
        let first = (((lo - self.bottom) / self.cell).max(0.0) as usize).min(n - 1);
        let last = (((hi - self.bottom) / self.cell).max(0.0) as usize).min(n - 1);
        for k in first..=last {
            let (low, high) = (self.bottom + k as f64 * self.cell, self.bottom + (k + 1) as f64 * self.cell);
            let new = hi.min(high) - lo.max(low);
            if new <= 0.0 {
                continue;
            }
            // The part that was outside before.
            let old =
                if side == 1 { (high - a).clamp(0.0, self.cell) } else { (a - low).clamp(0.0, self.cell) };
            self.film[k] = (self.film[k] * old + thickness * new) / (old + new);
        }
    }

    /// Sets the film between `lo` and `hi` to that of the crankcase.
    fn supply(&mut self, lo: f64, hi: f64) {
        let film = self.model.supply();
        let n = self.film.len();
        let last = (((hi - self.bottom) / self.cell).max(0.0) as usize).min(n - 1);
        let first = (((lo - self.bottom) / self.cell).max(0.0) as usize).min(n - 1);
        for k in first..=last {
            let low = self.bottom + k as f64 * self.cell;
            let outside = (hi - low).clamp(0.0, self.cell);
            self.ledger.supplied += (film - self.film[k]) * outside;
            self.film[k] = film;
        }
    }

    /// What ring `i` does with the oil while the piston moves at `v` \[m/s\].
    #[must_use]
    pub fn ring(&self, i: usize, v: f64) -> RingOil {
        let (mut wetted, mut length) = (0.0, 0.0);
        let mut out = RingOil::default();
        let trailing = usize::from(v < 0.0);
        for f in self.faces.iter().filter(|f| f.ring == i) {
            wetted += f.reach[0].length + f.reach[1].length;
            length += f.length;
            out.held += f.volume[0] + f.volume[1];
            // The last land to pass decides what stays: the upper one on the way down.
            if out.left == 0.0 || trailing == 0 {
                out.left = self.model.left_behind(f.reach[trailing].gap, v.abs());
            }
        }
        out.wetted = if length > 0.0 { wetted / length } else { 0.0 };
        out
    }

    /// All oil per circumference \[m²\]: on the liner outside the faces, and under them.
    #[must_use]
    pub fn total(&self, y: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (k, film) in self.film.iter().enumerate() {
            let (low, high) = (self.bottom + k as f64 * self.cell, self.bottom + (k + 1) as f64 * self.cell);
            let covered: f64 =
                self.faces.iter().map(|f| (high.min(f.edge[1]) - low.max(f.edge[0])).max(0.0)).sum();
            sum += film * (self.cell - covered);
        }
        for (k, f) in self.faces.iter().enumerate() {
            for side in 0..SIDES {
                sum += y[f.state + side] * self.unit(k) + f.taken[side];
            }
            sum += f.owed;
        }
        sum
    }
}

impl OilFace {
    /// Bottom and top edge \[m\] with the pin at `pin`.
    fn edges(&self, pin: f64) -> [f64; SIDES] {
        [pin + self.offset, pin + self.offset + self.length]
    }

    /// Distance from the narrowest place to an edge \[m\].
    fn span(&self, side: usize) -> f64 {
        if side == 0 { self.narrowest } else { self.length - self.narrowest }
    }

    /// Drop at distance `t` \[m\] from the narrowest place.
    fn drop_at(&self, t: f64, side: usize) -> f64 {
        let x = if side == 0 { self.narrowest - t } else { self.narrowest + t };
        self.profile.drop_at(x)
    }

    /// Volume \[m²\] between the narrowest place and distance `t` from it under a film of `h` \[m\].
    fn held(&self, h: f64, t: f64, side: usize) -> f64 {
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
    fn capacity(&self, h: f64, side: usize) -> f64 {
        self.held(h, self.span(side), side)
    }

    /// Where the oil of a side ends under a film of `h` \[m\].
    fn reach_of(&self, h: f64, side: usize) -> Reach {
        let (volume, span) = (self.volume[side], self.span(side));
        let full = self.capacity(h, side);
        if volume >= full {
            let edge = h + self.drop_at(span, side);
            return Reach { length: span, gap: (edge * edge + 2.0 * WAVE_SLOPE * (volume - full)).sqrt() };
        }
        let least = (LEAST_REACH * self.length).min(span);
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
    pub fn set_reach(&mut self, h: f64) -> (f64, f64) {
        for side in 0..SIDES {
            self.reach[side] = self.reach_of(h, side);
        }
        let from = (self.narrowest - self.reach[0].length).max(0.0);
        let to = (self.narrowest + self.reach[1].length).min(self.length);
        (from, to)
    }

    /// Drops at the ends of the face and of the film: bottom edge, lower meniscus, upper meniscus, top edge \[m\].
    #[must_use]
    pub fn drops(&self) -> [f64; 4] {
        [
            self.drop_at(self.span(0), 0),
            self.drop_at(self.reach[0].length, 0),
            self.drop_at(self.reach[1].length, 1),
            self.drop_at(self.span(1), 1),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct Half;
    impl OilTransport for Half {
        fn left_behind(&self, gap: f64, _: f64) -> f64 {
            0.5 * gap
        }
        fn through_valleys(&self, _: f64, _: f64) -> f64 {
            0.0
        }
        fn supply(&self) -> f64 {
            5e-6
        }
        fn spacing(&self) -> f64 {
            0.2e-3
        }
        fn highest_wave(&self) -> f64 {
            50e-6
        }
        fn initial(&self) -> f64 {
            1e-6
        }
    }

    fn pack() -> OilPack {
        let barrel = FaceProfile::Parabola { length: 1.2e-3, curvature: 15.0, apex: 0.5e-3 };
        let table = FaceProfile::Table { length: 0.8e-3, drops: vec![3e-6, 0.0, 0.0, 2e-6] };
        let place = |ring, profile: &FaceProfile, offset, clearance| FacePlace {
            ring,
            land: 0,
            profile: profile.clone(),
            offset,
            clearance,
        };
        OilPack::new(
            Box::new(Half),
            vec![place(0, &barrel, 8e-3, [Some(0.2e-3); 2]), place(1, &table, 0.0, [None, Some(0.2e-3)])],
            0.0,
            0.1,
            0,
        )
    }

    #[test]
    fn a_reach_holds_its_volume() {
        let mut p = pack();
        for k in 0..2 {
            for side in 0..SIDES {
                let h = 1.3e-6;
                let full = p.faces[k].capacity(h, side);
                for part in [0.1, 0.5, 0.99] {
                    p.faces[k].volume[side] = part * full;
                    let r = p.faces[k].reach_of(h, side);
                    // Joined to the least reach without a corner, and not beyond the edge.
                    let least = (LEAST_REACH * p.faces[k].length).min(p.faces[k].span(side));
                    if r.length >= p.faces[k].span(side) {
                        continue;
                    }
                    let t = (r.length * r.length - least * least).sqrt();
                    let held = p.faces[k].held(h, t, side);
                    // Newton's method ends where the length no longer changes by a rounding; the difference of squares loses a digit or two.
                    assert!((held - part * full).abs() <= 1e-13 * full, "{k} {side} {part}");
                    let gap = h + p.faces[k].drop_at(r.length, side);
                    assert_eq!(r.gap, gap);
                }
                p.faces[k].volume[side] = full + 2e-9;
                let r = p.faces[k].reach_of(h, side);
                assert_eq!(r.length, p.faces[k].span(side));
                let edge = h + p.faces[k].drop_at(r.length, side);
                let wave = 0.5 * (r.gap * r.gap - edge * edge) / WAVE_SLOPE;
                assert!((wave - 2e-9).abs() < 1e-20, "{wave:e}");
            }
        }
    }

    #[test]
    fn a_volume_under_a_table_is_that_of_its_trapezoids() {
        let p = pack();
        // From the middle of the flat bottom, 0.4 mm, to the bottom edge: 0.1333 mm flat, then a triangle of 3 um by 0.2667 mm.
        let v = p.faces[1].held(1e-6, 0.4e-3, 0);
        let exact = 1e-6 * 0.4e-3 + 0.5 * 3e-6 * (0.8e-3 / 3.0);
        assert!((v - exact).abs() <= 1e-14 * exact);
    }

    /// Edges that go up and down by odd steps, with faces that lose what they are told to lose: all oil is accounted for.
    #[test]
    fn nothing_is_gained_or_lost() {
        let mut p = pack();
        let mut y = vec![0.0; p.states()];
        p.start(|_| 2e-6, &mut y);
        p.begin(0.1);
        let before = p.total(&y);
        let supplied = p.ledger.supplied;
        let mut pin: f64 = 0.1;
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 40) as f64 / (1u64 << 24) as f64
        };
        for stroke in 0..8 {
            let down = stroke % 2 == 0;
            loop {
                let next = (pin + (random() + 0.01) * if down { -3e-3 } else { 3e-3 }).clamp(0.0, 0.1);
                let y0 = y.clone();
                for k in 0..2 {
                    // Moves oil through the face and loses some.
                    y[2 * k] += 0.01 * (random() - 0.5);
                    y[2 * k + 1] -= 0.02 * random();
                }
                p.book(&y0, &y, next, |_| 2e-6);
                pin = next;
                if pin <= 0.0 || pin >= 0.1 {
                    break;
                }
            }
        }
        let l = p.ledger;
        let stored = p.total(&y) - before;
        let closure = (l.supplied - supplied) - l.drained - l.thrown - stored;
        // A few hundred steps of additions, each exact to rounding.
        assert!(l.taken > 1e-7, "the faces took up {:e}", l.taken);
        assert!(closure.abs() <= 1e-12 * l.taken, "{closure:e} of {:e}", l.taken);
        assert!(p.film.iter().all(|h| *h >= 0.0));
    }

    /// A film that an edge lays down in several steps is what another takes up in others.
    #[test]
    fn what_is_laid_down_is_taken_up() {
        let mut p = pack();
        let mut y = vec![5.0; p.states()];
        p.film.fill(0.0);
        p.begin(0.1);
        // Down to 60 mm in uneven steps, the upper face losing 2 units of volume for every mm.
        let unit = p.unit(0);
        let mut pin: f64 = 0.1;
        let mut lost = 0.0;
        for d in [0.3e-3, 1.1e-3, 0.05e-3, 2.0e-3, 3.3e-3, 0.7e-3].into_iter().cycle() {
            let next = (pin - d).max(0.06);
            let y0 = y.clone();
            y[1] -= 2.0 * (pin - next) / 1e-3;
            lost += 2.0 * (pin - next) / 1e-3 * unit;
            p.book(&y0, &y, next, |_| 2e-6);
            pin = next;
            if pin <= 0.06 {
                break;
            }
        }
        let taken = p.faces[0].taken[1];
        let (y0, y1) = (y.clone(), y.clone());
        p.book(&y0, &y1, 0.1, |_| 2e-6);
        let back = p.faces[0].taken[1] - taken;
        // Some forty cells added up.
        assert!((back - lost).abs() <= 1e-12 * lost, "{back:e} of {lost:e}");
    }
}
