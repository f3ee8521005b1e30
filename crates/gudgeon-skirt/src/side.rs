//! One side of the skirt: gap, film, contact, and the forces that belong to the motions of the gap.

use gudgeon_core::kinds::{
    BoundaryFrictionSpec, ContactSpec, Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec,
    FilmMode, RoughShear, Roughness, RoughnessSpec, ShearThinning, SkirtCompliance, SkirtProfile,
    Superposition,
};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::vectors::widest;

mod beside;
mod contact;
mod gap;
mod kept;
mod loads;
mod nodes;
mod outflow;
mod shape;
mod slopes;
mod sums;
mod told;

pub use contact::ContactGrid;
pub use kept::{Filling, OilMoved, OilWay};
pub use loads::{SideLoads, Slopes};

use contact::{ContactRows, Touch};
use gap::{Gap, film_input};
use kept::Kept;
use nodes::Nodes;
use outflow::Rim;
use sums::{ContentRates, ContentShapes, CutOff, Over, Superposed, Taken};
use told::Told;

use crate::geometry::Panel;

const MODEL: &str = "skirt";

/// What a [`Side`] is made of.
pub struct SideSetup<'a> {
    /// Surface.
    pub panel: Panel,
    /// 1 on the thrust side, -1 on the anti-thrust side.
    pub sign: f64,
    /// Radial clearance of the centred skirt \[m\].
    pub clearance: f64,
    /// Whole grid of the film, from [`Panel::grid`].
    pub grid: &'a Film2dGrid,
    /// Film.
    pub film: &'a dyn Film2dSpec,
    /// Rough surfaces, the skirt being the body.
    pub roughness: &'a dyn RoughnessSpec,
    /// Contact.
    pub contact: &'a dyn ContactSpec,
    /// Friction of that contact; none: the coefficient of the contact model at every speed.
    pub boundary_friction: Option<&'a dyn BoundaryFrictionSpec>,
    /// Where contact is summed.
    pub contact_grid: ContactGrid,
    /// Shape.
    pub profile: &'a dyn SkirtProfile,
    /// How it yields, in shapes on the whole grid.
    pub compliance: Box<dyn SkirtCompliance>,
    /// Shear dependence of the viscosity; none: Newtonian.
    pub shear_thinning: Option<Box<dyn ShearThinning>>,
    /// Cavitation pressure above that of the crankcase \[Pa\], not positive.
    pub p_cav: f64,
    /// Film between smooth surfaces that the gap is held above \[m\].
    pub floor: f64,
}

/// One side of a skirt in its liner. Allocates when built.
pub struct Side {
    /// Surface.
    pub panel: Panel,
    /// 1 on the thrust side, -1 on the anti-thrust side.
    pub sign: f64,
    clearance: f64,
    floor: f64,
    whole: Film2dGrid,
    is_half: bool,
    nodes: Nodes,
    /// Drop of the profile at nodes, at faces along `x` and along `y`; empty for a cylinder.
    drop: [Vec<f64>; 3],
    least_drop: f64,
    /// Shapes of the gap's rates at the nodes: upper edge, lower edge, elastic ones.
    shapes: Vec<f64>,
    over: Over,
    /// Shapes at faces along `x` and along `y`.
    face_shapes: [Vec<f64>; 2],
    /// Nodes over which oil leaves.
    rim: Vec<Rim>,
    elastic: usize,
    /// How the surface yields.
    pub compliance: Box<dyn SkirtCompliance>,
    film: Box<dyn Film2d>,
    superposition: Superposition,
    rough: Box<dyn Roughness>,
    rows: ContactRows,
    thinning: Option<Box<dyn ShearThinning>>,
    p_cav: f64,
    shear: RoughShear,
    work: [Vec<f64>; 3],
    now: Gap,
    trial: Gap,
    /// Where `now` is: displacements, elastic amplitudes, speed (when viscosity depends on it).
    placed: Vec<f64>,
    /// Whether `raw` is that of the only rates that are asked for at the present place.
    is_moving: bool,
    /// Whether the skirt moves away from the head (1) or towards it (-1).
    sense: f64,
    /// Pressure per viscosity and cause: sliding, then every rate.
    fields: Vec<f64>,
    /// Changes of the filling per rate.
    fills: Vec<f64>,
    rates: Vec<f64>,
    modes_of_rates: Vec<f64>,
    /// Uncut pressure per viscosity, flows left over beside the present place, coordinates there, one row of sums.
    raw: Vec<f64>,
    beside: Vec<f64>,
    moved: Vec<f64>,
    row: Vec<f64>,
    /// Pressure above the crankcase and the part of it that takes part in changes.
    p: Vec<f64>,
    open: Vec<f64>,
    fill: Vec<f64>,
    contact_now: [f64; 6],
    /// What was told last, as long as `p`, `open` and `fill` are those of it.
    told: Told,
    /// Oil that is kept, when it is.
    kept: Option<Kept>,
    /// Film evaluations so far: linear systems set up.
    pub evaluations: u64,
}

impl Side {
    /// Builds the side.
    ///
    /// # Errors
    /// What film, roughness, contact and its friction refuse, at `film_2d`, `roughness`, `contact` and `boundary_friction`.
    pub fn new(setup: SideSetup<'_>) -> Result<Self, Vec<BuildError>> {
        let SideSetup { panel, sign, clearance, .. } = setup;
        let whole = setup.grid.clone();
        let elastic = setup.compliance.states().len();
        let symmetric = setup.profile.is_symmetric() && are_symmetric(&whole, setup.compliance.shapes());
        let half = if symmetric { Panel::half(&whole) } else { None };
        let is_half = half.is_some();
        let grid = half.unwrap_or_else(|| whole.clone());
        let film = setup.film.build(&Film2dCtx { grid: &grid }).map_err(|e| e.within("film_2d"));
        let rough = setup.roughness.build().map_err(|e| e.within("roughness"));
        let touch = Touch::new(setup.contact, setup.boundary_friction);
        let (film, rough, touch) = match (film, rough, touch) {
            (Ok(film), Ok(rough), Ok(touch)) => (film, rough, touch),
            (film, rough, touch) => {
                return Err(film.err().into_iter().chain(rough.err()).chain(touch.err()).collect());
            }
        };
        let nodes = Nodes::new(&grid, &panel, is_half);
        let n = nodes.len();
        let shapes = nodes.shapes(sign, setup.compliance.shapes(), whole.len());
        let mut drop = nodes.drops(&panel, setup.profile);
        let least_drop = drop[0].iter().chain(&drop[1]).fold(f64::INFINITY, |a, &b| a.min(b));
        let is_cylinder = drop.iter().flatten().all(|d| *d == 0.0);
        if is_cylinder {
            drop = Default::default();
        }
        let profile = (!is_cylinder).then_some(setup.profile);
        let (cg, own) = (setup.contact_grid, &shapes[2 * n..]);
        let rows = ContactRows::new(panel, sign, clearance, cg, touch, symmetric, profile, &nodes, own);
        let is_rough = !rough.is_smooth();
        let over = Over::new(&nodes, &shapes, panel.radius);
        let rim = Rim::of(&grid, is_half);
        Ok(Self {
            panel,
            sign,
            clearance,
            floor: setup.floor,
            is_half,
            drop,
            least_drop,
            over,
            rim,
            face_shapes: nodes.face_shapes(sign, own),
            nodes,
            elastic,
            compliance: setup.compliance,
            superposition: film.superposition(),
            film,
            rough,
            rows,
            thinning: setup.shear_thinning.filter(|t| !t.is_off()),
            p_cav: setup.p_cav,
            shear: RoughShear::new(n),
            work: [vec![0.0; n], vec![0.0; n], vec![0.0; n]],
            now: Gap::new(n, is_rough),
            trial: Gap::new(n, is_rough),
            placed: Vec::with_capacity(4 + elastic),
            is_moving: false,
            sense: 1.0,
            fields: vec![0.0; (3 + elastic) * n],
            fills: Vec::new(),
            rates: vec![0.0; n],
            modes_of_rates: vec![0.0; (2 + elastic) * n],
            raw: vec![0.0; n],
            beside: vec![0.0; (2 + elastic) * n],
            moved: Vec::with_capacity(elastic),
            row: vec![0.0; 4 + elastic],
            shapes,
            p: vec![0.0; n],
            open: vec![0.0; n],
            fill: vec![1.0; n],
            contact_now: [0.0; 6],
            told: Told::default(),
            kept: None,
            evaluations: 0,
            whole,
        })
    }

    /// Elastic shapes.
    #[must_use]
    pub fn elastic(&self) -> usize {
        self.elastic
    }

    /// Whether the film is linear in the rates but for a cut.
    #[must_use]
    pub fn is_superposed(&self) -> bool {
        self.superposition != Superposition::None
    }

    /// Nodes that are solved.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Whole grid.
    #[must_use]
    pub fn grid(&self) -> &Film2dGrid {
        &self.whole
    }

    /// Smallest gap at the nodes of the place set last \[m\].
    #[must_use]
    pub fn smallest_gap(&self) -> f64 {
        self.now.smallest
    }

    /// Pressure above that of the crankcase \[Pa\] that was found last, at the nodes of the whole grid.
    #[must_use]
    pub fn pressure(&self) -> Vec<f64> {
        self.unfold(&self.p)
    }

    /// Gap \[m\] of the place set last, at the nodes of the whole grid.
    #[must_use]
    pub fn gap(&self) -> Vec<f64> {
        self.unfold(&self.now.h)
    }

    /// Gap \[m\] below which the film is held open; none when that depends on more than the gap.
    #[must_use]
    pub fn held_open_below(&self) -> Option<f64> {
        if self.rough.is_smooth() { Some(2.0 * self.floor) } else { self.rough.held_below() }
    }

    /// By how much the film of the place set last is held open at most \[m\].
    #[must_use]
    pub fn held_open(&self) -> f64 {
        self.now.flow.film.iter().zip(&self.now.h).fold(0.0, |m, (film, h)| m.max(film - h))
    }

    fn unfold(&self, f: &[f64]) -> Vec<f64> {
        let mut all = f.to_vec();
        if self.is_half {
            let (nx, ny) = (self.nodes.nx, self.nodes.ny);
            (0..ny - 1).rev().for_each(|j| all.extend_from_slice(&f[j * nx..(j + 1) * nx]));
        }
        all
    }

    /// Highest pressure above that of the crankcase found last \[Pa\].
    #[must_use]
    pub fn p_max(&self) -> f64 {
        self.p.iter().fold(0.0, |a, &b| a.max(b))
    }

    /// Amplitudes \[m\] with which the shapes of this side yield to the pressure that `other`, the same side without shapes, found last.
    #[must_use]
    pub fn yields_to(&self, other: &Self) -> Vec<f64> {
        let n = self.nodes();
        let full = other.pressure();
        let load = |test: &[f64]| test.iter().zip(&full).map(|(t, p)| t * p).sum::<f64>();
        let tests = self.over.tests[2 * n..].chunks_exact(n.max(1)).enumerate();
        tests.map(|(k, test)| self.compliance.rest(k, load(test))).collect()
    }

    /// Largest elastic displacement with the amplitudes `q` over the gap of `other`, the same side without shapes.
    #[must_use]
    pub fn part_of_gap(&self, q: &[f64], other: &Self) -> f64 {
        let n = self.nodes();
        let gap = other.gap();
        (0..n)
            .map(|k| {
                let d: f64 = q.iter().enumerate().map(|(m, q)| q * self.shapes[(2 + m) * n + k]).sum();
                (d / gap[k].abs().max(1e-12)).abs()
            })
            .fold(0.0, f64::max)
    }

    /// Puts the skirt at the displacements `e` of both edges \[m\], with the elastic amplitudes `q` \[m\]; `speed` is that of the piston away from the
    /// head \[m/s\]. What is linear in the rates is solved here, once.
    ///
    /// # Errors
    /// A gap that is none, a film that cannot be solved.
    pub fn place(&mut self, e: [f64; 2], q: &[f64], speed: f64) -> Result<(), EvalError> {
        let key = if self.thinning.is_some() { speed } else { 0.0 };
        // Oil comes from upstream: a film may know which way that is.
        let sense = if speed < 0.0 { -1.0 } else { 1.0 };
        let same = self.placed.len() == 4 + q.len()
            && self.placed[..4] == [e[0], e[1], key, sense]
            && self.placed[4..] == *q;
        if same {
            return Ok(());
        }
        self.go(e, q, speed)?;
        if self.superposition != Superposition::None {
            self.full_films()?;
        }
        self.placed.extend_from_slice(&[e[0], e[1], key, sense]);
        self.placed.extend_from_slice(q);
        Ok(())
    }

    /// The same for one set of rates alone, for which [`Side::loads`] is then asked at the same speed: of a film that is linear in them but for a cut, one
    /// cause is solved in place of one for every rate. Slopes are told by the causes of the place before, [`Side::loads_beside`] is not.
    ///
    /// # Errors
    /// As [`Side::place`].
    pub fn place_moving(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        speed: f64,
        rates: &[f64],
    ) -> Result<(), EvalError> {
        if !self.is_superposed() {
            return self.place(e, q, speed);
        }
        self.go(e, q, speed)?;
        self.combine_rates(false, rates);
        let inp = film_input(&self.now, self.nodes());
        let mode = FilmMode { u: -speed, dhdt: &self.rates, edge_pressure: [0.0; 4] };
        self.film.solve_many(&inp, &[mode], &mut self.raw)?;
        self.evaluations += 1;
        self.is_moving = true;
        Ok(())
    }

    /// Goes to a place: its gap, its contact and what rates do there.
    fn go(&mut self, e: [f64; 2], q: &[f64], speed: f64) -> Result<(), EvalError> {
        self.placed.clear();
        self.told.forget();
        self.is_moving = false;
        self.sense = if speed < 0.0 { -1.0 } else { 1.0 };
        self.shape_gap(false, e, q, speed)?;
        self.contact_now = self.contact_loads(e, q);
        if self.kept.is_some() {
            self.fill.copy_from_slice(&self.now.fill);
        }
        let slope = &self.now.flow.content_derivative;
        widest(ContentShapes { shapes: &self.shapes, slope, out: &mut self.modes_of_rates });
        Ok(())
    }

    /// Pressures of full films at the present place, for sliding at one metre a second in the present sense and for each rate of one metre a second, into
    /// `fields`.
    ///
    /// # Errors
    /// A film that cannot be solved.
    fn full_films(&mut self) -> Result<(), EvalError> {
        let n = self.nodes();
        self.told.forget();
        let inp = film_input(&self.now, n);
        let [top, bottom] = [&self.modes_of_rates[..n], &self.modes_of_rates[n..2 * n]];
        let mode = |u: f64, dhdt| FilmMode { u, dhdt, edge_pressure: [0.0; 4] };
        let first = [mode(-self.sense, &[]), mode(0.0, top), mode(0.0, bottom)];
        if self.elastic == 0 {
            self.film.solve_many(&inp, &first, &mut self.fields)?;
        } else {
            let mut all = first.to_vec();
            all.extend(self.modes_of_rates[2 * n..].chunks_exact(n).map(|r| mode(0.0, r)));
            self.film.solve_many(&inp, &all, &mut self.fields)?;
        }
        self.evaluations += 1;
        Ok(())
    }

    /// Forces at the present place for the rates of both edges and of the elastic amplitudes \[m/s\], with their derivatives as `slopes` says.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn loads(
        &mut self,
        speed: f64,
        mu: f64,
        rates: &[f64],
        slopes: Slopes,
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        out.contact = self.contact_now;
        if self.told.is_of(speed, mu, rates) {
            self.told.loads(out);
        } else {
            if self.is_superposed() {
                self.pressures(speed, mu, rates);
            } else {
                self.solve_whole(false, speed, mu, rates)?;
            }
            self.sums(false, speed, mu, out);
            self.told.take(speed, mu, rates, out);
        }
        self.slopes(speed, mu, rates, slopes, out)
    }

    /// Rate of the gap's content at every node, into `self.rates`.
    fn combine_rates(&mut self, trial: bool, rates: &[f64]) {
        let gap = if trial { &self.trial } else { &self.now };
        let (shapes, slope) = (&self.shapes[..], &gap.flow.content_derivative[..]);
        widest(ContentRates { rates, shapes, slope, out: &mut self.rates });
    }

    /// The film with its cavitation, by the solver alone.
    fn solve_whole(
        &mut self,
        trial: bool,
        speed: f64,
        mu: f64,
        rates: &[f64],
    ) -> Result<Film2dOut, EvalError> {
        self.combine_rates(trial, rates);
        self.told.forget();
        let n = self.nodes();
        let gap = if trial { &self.trial } else { &self.now };
        let [scaled, _, _] = &mut self.work;
        let found = self.film.solve(&Film2dIn {
            u: -speed,
            mu: gap.viscosity(mu, scaled),
            dhdt: &self.rates,
            p_cav: self.p_cav,
            edge_pressure: [0.0; 4],
            ..film_input(gap, n)
        })?;
        self.evaluations += 1;
        self.p.copy_from_slice(self.film.pressure());
        self.fill.copy_from_slice(self.film.fill());
        Ok(found)
    }

    /// Whether all nodes count as full: the film is linear in the rates but for a cut, and no oil is kept.
    fn is_full(&self) -> bool {
        self.is_superposed() && self.kept.is_none()
    }

    /// Pressures of a film that is linear in the rates but for a cut: uncut ones per viscosity into `self.raw`, the others into `self.p`, and where they take
    /// part in changes into `self.open`.
    fn pressures(&mut self, speed: f64, mu: f64, rates: &[f64]) {
        if self.told.is_of(speed, mu, rates) {
            return;
        }
        self.told.forget();
        if !self.is_moving {
            widest(Superposed { speed: speed.abs(), rates, fields: &self.fields, out: &mut self.raw });
        }
        let cut = if self.superposition == Superposition::CutOff { self.p_cav } else { f64::NEG_INFINITY };
        widest(CutOff { mu, cut, raw: &self.raw, p: &mut self.p, open: &mut self.open });
    }

    /// Sums over the film in `self.p`.
    fn sums(&mut self, trial: bool, speed: f64, mu: f64, out: &mut SideLoads) {
        let width = 4 + self.elastic;
        let gap = if trial { &self.trial } else { &self.now };
        self.over.sums(&self.p, gap, &mut self.row[..width]);
        let mut found = [0.0; 4];
        found.copy_from_slice(&self.row[..4]);
        out.elastic.resize(self.elastic, 0.0);
        out.elastic.copy_from_slice(&self.row[4..width]);
        // Couette drag: the liner slides against the piston.
        let drag = if self.is_full() {
            gap.full_drag
        } else {
            let taken = &mut self.work[0];
            widest(Taken { factor: 1.0, open: Some(&self.fill), field: &gap.drag, out: taken });
            self.over.drag(taken)
        };
        found[2] -= mu * speed * drag[0];
        found[3] -= mu * speed * drag[1];
        out.film = found;
    }

    /// Smallest gap at the nodes \[m\] at the displacements `e` of both edges and the elastic amplitudes `q`; the present place stays.
    ///
    /// # Errors
    /// A gap that is none.
    pub fn gap_at(&mut self, e: [f64; 2], q: &[f64], speed: f64) -> Result<f64, EvalError> {
        self.shape_gap(true, e, q, speed)?;
        Ok(self.trial.smallest)
    }

    /// A bound from below of the gap where contact is summed.
    fn least_contact_gap(&self, e: [f64; 2], q: &[f64]) -> f64 {
        let (top, bottom) = (self.sign * e[0], self.sign * e[1]);
        self.clearance + self.least_drop.min(0.0) + top.min(bottom).min(0.0)
            - q.iter().map(|q| 2.0 * q.abs()).sum::<f64>()
    }

    /// Smallest gap where contact is summed, less the range of contact \[m\]; a bound from below of it while that is positive. Infinite for
    /// surfaces that do not touch.
    pub fn contact_gap(&mut self, e: [f64; 2], q: &[f64]) -> f64 {
        let range = self.rows.range();
        if range <= 0.0 {
            return f64::INFINITY;
        }
        let least = self.least_contact_gap(e, q) - range;
        if least > 0.0 { least } else { self.rows.smallest(e, q) - range }
    }

    /// Depth below the upper edge of every row along which solid contact is summed \[m\].
    #[must_use]
    pub fn contact_depths(&self) -> Vec<f64> {
        self.rows.depths()
    }

    /// Normal pressure of solid contact along these rows \[Pa\], mean over the arc of the side, at the displacements `e` of both edges and the elastic
    /// amplitudes `q`; the present place stays.
    pub fn contact_pressures(&mut self, e: [f64; 2], q: &[f64]) -> Vec<f64> {
        self.rows.pressures(e, q)
    }

    /// Solid contact: forces on both edges, normal force, and its moment arm.
    fn contact_loads(&mut self, e: [f64; 2], q: &[f64]) -> [f64; 6] {
        let range = self.rows.range();
        if range <= 0.0 || self.least_contact_gap(e, q) >= range {
            return [0.0; 6];
        }
        self.rows.loads(e, q)
    }

    /// Contact sums so far.
    #[must_use]
    pub fn contact_sums(&self) -> u64 {
        self.rows.sums
    }

    /// Whether solid contact can carry anything.
    #[must_use]
    pub fn has_contact(&self) -> bool {
        self.rows.range() > 0.0
    }

    /// Friction of solid contact on the skirt for what [`SideLoads::contact`] says, while it moves away from the head at `speed` \[m/s\]: axial force away
    /// from the head \[N\], and that force times `R cos φ` \[N m\].
    #[must_use]
    pub fn rubbing(&self, speed: f64, contact: &[f64; 6]) -> [f64; 2] {
        self.rows.rubbing(speed, contact)
    }
}

/// Whether all shapes are their own mirror images.
fn are_symmetric(grid: &Film2dGrid, shapes: &[f64]) -> bool {
    let fields: Vec<&[f64]> = shapes.chunks(grid.len().max(1)).collect();
    grid.is_symmetric_in_y(&[0.0; 4], &fields, 1e-9)
}
