//! Oil on the liner and under the faces: who holds it, who takes it up, who leaves it behind.
//!
//! Each running face has two states, the volumes of oil per circumference that it holds below and above its narrowest place.
//! They say how far the film reaches (`extent`), and the flux of the film moves oil from one to the other (`rates`). The liner
//! carries a film on a fixed grid. What a leading edge takes up is known before it gets there: it is added to the state as the
//! integral of the film over the way it went, so that no step needs to resolve the film it passes. What a trailing edge leaves
//! is what the states of its face lost over a step, laid down over the way the edge went; a face that comes there in the same step
//! takes it up again. Nothing is therefore ever gained or lost, whatever the tolerance.

use gudgeon_core::kinds::{
    OilDrive, OilExtent, OilFaceIn, OilFacePlace, OilLand, OilLedger, OilPassed, OilStep, OilTransport,
    OilTransportCtx, RingOil,
};
use gudgeon_core::result::Note;
use gudgeon_core::states::{Signals, StateInfo, Stateful};

use super::face::{MIN_REACH, OilFace, SIDES};
use super::land_cycle::LandCycle;
use super::law::Law;
use super::liner::Liner;

/// Part of each side of a face that is wetted at the start: of ring 1, which stands at its upper dead centre then and has all but run dry there, and of the others. What ring 1 has too much
/// of takes tens of cycles to go, and what it lacks comes more slowly still.
const FIRST_REACH: (f64, f64) = (0.02, 0.1);
/// Film of the unit of the volume states \[m\].
const UNIT_FILM: f64 = 1e-6;
/// Unit of the film on the liner, where it is handed out \[m\].
const LINER_UNIT: f64 = 1e-6;
/// Film of one cell that counts as one, in its unit: which cells a step ends in differs from cycle to cycle, and a face is as long
/// as many of them.
const CELL_SCALE: f64 = 100.0;
/// Part of the smallest distance between two faces over which a step may go that takes up nothing of its own.
const WAY: f64 = 0.8;

/// All oil of a pack.
#[derive(Debug)]
pub struct Carried {
    law: Law,
    /// Faces, from the top down.
    pub faces: Vec<OilFace>,
    /// Ring and land of every face.
    places: Vec<(usize, usize)>,
    states: Vec<StateInfo>,
    /// Film on the liner.
    pub liner: Liner,
    /// Oil on the lands of the piston.
    pub lands: LandCycle,
    ledger: OilLedger,
    /// Smallest distance between two faces \[m\].
    min_gap: f64,
    /// Seconds per radian.
    per: f64,
}

impl Carried {
    /// Sets up the oil of faces listed from the top down.
    pub fn new(law: Law, ctx: &OilTransportCtx<'_>) -> Self {
        let mut least = law.spacing;
        let mut min_gap = f64::INFINITY;
        for p in ctx.faces {
            least = least.min(0.5 * p.profile.length());
        }
        for w in ctx.faces.windows(2) {
            let gap = w[0].offset - (w[1].offset + w[1].profile.length());
            min_gap = min_gap.min(gap);
        }
        // A cell holds the edge of one face at most.
        let least = least.min(0.5 * min_gap.max(1e-6));
        let lands = LandCycle::new(ctx.lands, law.density);
        let faces: Vec<OilFace> = (0..ctx.faces.len())
            .map(|k| {
                let (exit, gap) = ways(ctx.faces, k, ctx.lands);
                OilFace::new(&ctx.faces[k], exit, gap, law.wave)
            })
            .collect();
        let (lowest, highest) = ctx.pin;
        let top = faces.first().map_or(0.0, |f| f.offset + f.length) + highest;
        let low = faces.last().map_or(0.0, |f| f.offset) + lowest;
        let mut liner = Liner::new(low, top, least, law.supply, ctx.volatile);
        liner.start(law.initial);
        let mut new = Self {
            liner,
            places: faces.iter().map(|f| (f.ring, f.land)).collect(),
            states: states(&faces),
            faces,
            lands,
            law,
            ledger: OilLedger::default(),
            min_gap,
            per: 1.0 / ctx.omega,
        };
        new.mark();
        new
    }

    /// Volume of one unit of the states of face `k` \[m²\].
    #[must_use]
    pub fn unit(&self, k: usize) -> f64 {
        UNIT_FILM * self.faces[k].length
    }

    /// What the edges of face `k` have passed since the start of the step, and what of that the face before it has left meanwhile. The film on the liner is still
    /// that of the start, or where `laid` holds what the face before it has left lies there already.
    fn swept(&self, k: usize, pin: f64, laid: bool) -> [f64; SIDES] {
        let (f, e, liner) = (&self.faces[k], self.faces[k].edges(pin), &self.liner);
        let mut swept = [0.0; SIDES];
        // The cell in which the other began has a new film as well.
        let near = if laid { liner.cell } else { 0.0 };
        if e[0] < f.edge[0] {
            let ahead = self.faces.get(k + 1).filter(|a| e[0] < a.trail.from + near);
            swept[0] = match ahead {
                None => f.below[0] - liner.below(e[0]),
                Some(_) if laid => liner.between(e[0], f.edge[0]),
                Some(a) => f.below[0] - a.below[1] + (a.trail.from - e[0]) * a.trail.film,
            };
        }
        if e[1] > f.edge[1] {
            let ahead = k.checked_sub(1).map(|a| &self.faces[a]).filter(|a| e[1] > a.trail.from - near);
            swept[1] = match ahead {
                None => liner.below(e[1]) - f.below[1],
                Some(_) if laid => liner.between(f.edge[1], e[1]),
                Some(a) => a.below[0] - f.below[1] + (e[1] - a.trail.from) * a.trail.film,
            };
        }
        swept
    }

    /// Number of the face that comes `i`-th over a place of the liner, with the pin at `pin`.
    fn in_turn(&self, i: usize, pin: f64) -> usize {
        if self.faces[0].trailing(pin) == 1 { self.faces.len() - 1 - i } else { i }
    }

    /// The crankcase wets what the lowest ring uncovers, and the faces begin a step on the liner as it then is.
    fn supply(&mut self) {
        if let Some(z) = self.faces.last().map(|f| f.edge[0]) {
            self.ledger.supplied += self.liner.wet(z);
        }
        self.liner.add_up();
        self.mark();
    }

    /// Notes what lies below the edges of the faces.
    fn mark(&mut self) {
        for f in &mut self.faces {
            f.below = f.edge.map(|z| self.liner.below(z));
        }
    }

    /// The gas of the chamber dries what ring 1 has bared.
    fn evaporate(&mut self, drive: &OilDrive<'_>) {
        let density = self.law.density;
        if let (Some(face), Some(pressure)) = (self.faces.first(), drive.pressures.first()) {
            self.ledger.evaporated += self.liner.evaporate(face.edge[1], drive.dt, *pressure, density);
        }
    }

    /// Books face `k` over a step: `y0`, `y1` its two states, `h` its film at the end.
    fn book_face(&mut self, k: usize, y0: &[f64], y1: &[f64], pin: f64, h: f64) {
        let (unit, swept) = (self.unit(k), self.swept(k, pin, true));
        let f = &mut self.faces[k];
        let to = f.edges(pin);
        // What lies before the end gap passes it. The next ring, whose gap stands elsewhere, scrapes it off; above ring 1 it stays on the liner.
        let mut stays = 0.0;
        for side in 0..SIDES {
            let passes = f.gap[side] * swept[side];
            f.taken[side] += swept[side] - passes;
            self.ledger.taken += swept[side] - passes;
            self.lands.pass(f.ring, side == 0, passes, &mut self.ledger);
            if (f.ring, side) == (0, 0) {
                stays = passes;
            }
        }
        // What the face lost stays behind its trailing edge. Integration errors may make it less than nothing: that is owed,
        // for the volumes must not jump, which would spoil the time derivatives of the next step.
        let lost = f.owed + stays - ((y1[0] - y0[0]) + (y1[1] - y0[1])) * unit;
        let trailing = f.trailing(pin);
        let moved = to[trailing] != f.edge[trailing];
        // The wave before the leading edge, beyond what there is room for, goes; nothing else depends on it.
        let leading = 1 - trailing;
        let volume = y1[leading] * unit + f.taken[leading];
        let left = (volume - f.capacity(h, leading) - f.room[leading]).max(0.0);
        f.taken[leading] -= left;
        f.trail = f.trail(pin, lost);
        f.owed = lost - if moved { lost.max(0.0) } else { 0.0 };
        f.before = (y1[0] + y1[1]) * unit;
        self.lands.scrape(f.ring, f.exit[leading], left, &mut self.ledger);
        f.edge = to;
        if moved {
            self.liner.lay(&f.trail, trailing);
        }
    }
}

/// Where oil goes that has no room before the edges of face `k`, and the share of the circumference that is open there. What a land of a twin-land ring
/// has before its edge towards the other drains, and the end gap lets pass what no land of the ring has passed.
fn ways(faces: &[OilFacePlace], k: usize, lands: &[OilLand]) -> ([usize; SIDES], [f64; SIDES]) {
    let ring = faces[k].ring;
    let inside = |other: Option<&OilFacePlace>| other.is_some_and(|f| f.ring == ring);
    let (below, above) = (inside(faces.get(k + 1)), inside(k.checked_sub(1).map(|k| &faces[k])));
    let (crankcase, gap) = (lands.len(), lands[ring].gap);
    (
        [if below { crankcase } else { ring + 1 }, if above { crankcase } else { ring }],
        [if below { 0.0 } else { gap }, if above { 0.0 } else { gap }],
    )
}

/// Two volumes a face.
fn states(faces: &[OilFace]) -> Vec<StateInfo> {
    let side = |f: &OilFace, where_: &str| {
        // What a face took up stands beside its states, which may therefore be anything.
        StateInfo::new(format!(
            "oil {where_} the narrowest place of face {} of ring{}",
            f.land + 1,
            f.ring + 1
        ))
        .absolute(1.0)
        .over_cycle(1.0, true)
        .changes(Signals::EXTENT)
    };
    faces.iter().flat_map(|f| [side(f, "below"), side(f, "above")]).collect()
}

impl Stateful for Carried {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }

    fn reads(&self) -> Signals {
        Signals::EXTENT | Signals::FILM_THICKNESS | Signals::FILM_FORCE
    }

    /// The volumes of the last instant, which the states alone do not say.
    fn save(&self, out: &mut Vec<f64>) {
        out.extend(self.faces.iter().flat_map(|f| f.volume));
    }

    fn restore(&mut self, saved: &[f64]) -> usize {
        for (f, v) in self.faces.iter_mut().zip(saved.chunks_exact(SIDES)) {
            f.volume.copy_from_slice(v);
        }
        SIDES * self.faces.len()
    }
}

impl OilTransport for Carried {
    fn faces(&self) -> &[(usize, usize)] {
        &self.places
    }

    fn ring_of(&self, k: usize) -> usize {
        self.faces[k / SIDES].ring
    }

    fn place(&mut self, y: &[f64], pin: f64) {
        for i in 0..self.faces.len() {
            let k = self.in_turn(i, pin);
            let unit = self.unit(k);
            let swept = self.swept(k, pin, false);
            let f = &mut self.faces[k];
            let lost = f.owed + f.before - (y[SIDES * k] + y[SIDES * k + 1]) * unit;
            f.trail = f.trail(pin, lost);
            for side in 0..SIDES {
                let taken = f.taken[side] + (1.0 - f.gap[side]) * swept[side];
                f.volume[side] = y[SIDES * k + side] * unit + taken;
            }
        }
    }

    fn extent(&mut self, k: usize, h: f64) -> OilExtent {
        self.faces[k].set_reach(h)
    }

    fn rates(&mut self, k: usize, face: &OilFaceIn, dy: &mut [f64]) {
        let per_unit = self.per / self.unit(k);
        let f = &self.faces[k];
        let OilFaceIn { h, hdot, u, flux } = *face;
        let per_least = 1.0 / (h * MIN_REACH * f.length);
        // A side that has no oil gives none; one that errors have made owe some takes it back in the same time. With a corner at zero,
        // near which a nearly dry side rests, every other step would be wrong.
        let has = |side: usize| {
            let x = (f.volume[side] * per_least).clamp(-1.0, 1.0);
            x * (2.0 - x.abs())
        };
        let through = flux - hdot * f.reach[0].length + self.law.through_valleys(h, u.abs()).copysign(u);
        let through = through * if through > 0.0 { has(0) } else { has(1) };
        let mut rate = [-through, through];
        let trailing = usize::from(u > 0.0);
        rate[trailing] -= u.abs() * self.law.deposited(f.reach[trailing].gap) * has(trailing);
        for side in 0..SIDES {
            dy[SIDES * k + side] = rate[side] * per_unit;
        }
    }

    fn first(&mut self, films: &[f64], y: &mut [f64]) {
        // Oil comes with the first stroke, and what there is too much of takes many cycles to go.
        for k in 0..self.faces.len() {
            let f = &self.faces[k];
            let (h, unit) = (films[f.ring], self.unit(k));
            let reach = if f.ring == 0 { FIRST_REACH.0 } else { FIRST_REACH.1 };
            for side in 0..SIDES {
                y[SIDES * k + side] = f.held(h, reach * f.span(side), side) / unit;
            }
        }
        self.liner.start(self.law.initial);
        self.mark();
    }

    fn carried(&self) -> usize {
        self.liner.film.len()
    }

    fn carried_scale(&self) -> f64 {
        CELL_SCALE
    }

    fn field(&self, out: &mut [f64]) {
        for (out, film) in out.iter_mut().zip(&self.liner.film) {
            *out = film / LINER_UNIT;
        }
    }

    fn begin_cycle(&mut self, y: &[f64], field: &[f64], pin: f64) {
        // An extrapolated film may be less than none.
        for (film, y) in self.liner.film.iter_mut().zip(field) {
            *film = (y * LINER_UNIT).max(0.0);
        }
        self.clear_ledger();
        self.liner.refresh();
        for (k, held) in y.chunks_exact(SIDES).enumerate() {
            let unit = self.unit(k);
            let f = &mut self.faces[k];
            (f.taken, f.owed) = ([0.0; SIDES], 0.0);
            f.before = (held[0] + held[1]) * unit;
            f.edge = f.edges(pin);
        }
        self.supply();
    }

    fn end_cycle(&mut self, y: &mut [f64], field: &mut [f64]) {
        for k in 0..self.faces.len() {
            let unit = self.unit(k);
            let f = &mut self.faces[k];
            for side in 0..SIDES {
                y[SIDES * k + side] += f.taken[side] / unit;
                f.taken[side] = 0.0;
            }
            y[SIDES * k] += f.owed / unit;
            f.owed = 0.0;
        }
        self.field(field);
    }

    fn book(&mut self, step: &OilStep<'_>) {
        for i in 0..self.faces.len() {
            let k = self.in_turn(i, step.pin);
            let own = SIDES * k..SIDES * (k + 1);
            let h = step.films[self.faces[k].ring];
            self.book_face(k, &step.y0[own.clone()], &step.y1[own], step.pin, h);
        }
        self.lands.step(&step.drive);
        self.evaporate(&step.drive);
        self.supply();
    }

    fn longest_way(&self) -> f64 {
        WAY * self.min_gap
    }

    fn ring(&self, i: usize, v: f64) -> RingOil {
        let (mut wetted, mut length) = (0.0, 0.0);
        let mut out = RingOil::default();
        let trailing = usize::from(v < 0.0);
        for f in self.faces.iter().filter(|f| f.ring == i) {
            wetted += f.reach[0].length + f.reach[1].length;
            length += f.length;
            out.held += f.volume[0] + f.volume[1];
            // The last land to pass decides what stays: the upper one on the way down.
            if out.left == 0.0 || trailing == 0 {
                out.left = self.law.deposited(f.reach[trailing].gap);
            }
        }
        out.wetted = if length > 0.0 { wetted / length } else { 0.0 };
        out
    }

    fn total(&self, y: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (k, film) in self.liner.film.iter().enumerate() {
            let (low, high) = self.liner.ends(k);
            let covered: f64 =
                self.faces.iter().map(|f| (high.min(f.edge[1]) - low.max(f.edge[0])).max(0.0)).sum();
            sum += film * (self.liner.cell - covered);
        }
        for (k, f) in self.faces.iter().enumerate() {
            for side in 0..SIDES {
                sum += y[SIDES * k + side] * self.unit(k) + f.taken[side];
            }
            sum += f.owed;
        }
        sum + self.lands.gained()
    }

    fn ledger(&self) -> OilLedger {
        self.ledger
    }

    fn settle(&mut self) {
        self.lands.settle(&mut self.ledger);
    }

    fn passed(&self, i: usize) -> OilPassed {
        self.lands.lands().passed().nth(i).unwrap_or_default()
    }

    fn on_land(&self, i: usize) -> f64 {
        self.lands.lands().volumes().nth(i).unwrap_or(0.0)
    }

    fn dried(&self) -> f64 {
        self.liner.dried()
    }

    fn density(&self) -> f64 {
        self.lands.lands().density
    }

    fn notes(&self) -> Vec<Note> {
        vec![self.law.supply_note()]
    }

    fn clear_ledger(&mut self) {
        self.ledger = OilLedger::default();
        self.lands.clear();
    }

    fn liner(&self) -> (Vec<f64>, Vec<f64>) {
        let l = &self.liner;
        let z = (0..l.film.len()).map(|k| l.bottom + (k as f64 + 0.5) * l.cell).collect();
        (z, l.film.clone())
    }
}
