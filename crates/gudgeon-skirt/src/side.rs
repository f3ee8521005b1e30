//! One side of the skirt: gap, film, contact, and the forces that belong to the motions of the gap.

use gudgeon_core::kinds::{
    ContactSpec, Edge, Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec, FilmMode, FlowFactors,
    RoughFlow, RoughShear, Roughness, RoughnessSpec, ShearThinning, SkirtCompliance, SkirtProfile,
    Superposition, Viscosity,
};
use gudgeon_core::{BuildError, EvalError};

mod contact;
mod loads;
mod nodes;

pub use contact::ContactGrid;
pub use loads::{SideLoads, Slopes};

use contact::ContactRows;
use nodes::Nodes;

use crate::geometry::{Panel, between};

const MODEL: &str = "skirt";
/// How deep a skirt may stand inside the liner \[m\]: far beyond what contact allows, and yet within a start that is given wrongly.
const DEEPEST: f64 = 1e-4;

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

/// A film and what it depends on besides the rates.
#[derive(Default)]
struct Gap {
    h: Vec<f64>,
    flow: RoughFlow,
    face_x: Vec<f64>,
    face_y: Vec<f64>,
    /// Shear stress on the liner per viscosity and speed, without the filling.
    drag: Vec<f64>,
    /// Axial force per pressure of a node.
    lever: Vec<f64>,
    /// Relative viscosity, when it varies.
    thinning: Vec<f64>,
    smallest: f64,
    is_rough: bool,
}

impl Gap {
    fn new(n: usize, is_rough: bool) -> Self {
        let v = || vec![0.0; n];
        Self {
            h: v(),
            flow: RoughFlow::new(n),
            face_x: v(),
            face_y: v(),
            drag: v(),
            lever: v(),
            thinning: Vec::new(),
            smallest: f64::INFINITY,
            is_rough,
        }
    }
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
    /// Elastic shapes at faces along `x` and along `y`.
    face_shapes: [Vec<f64>; 2],
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
    contact_now: [f64; 4],
    /// Film evaluations so far: linear systems set up.
    pub evaluations: u64,
}

/// A gap held above `floor`: itself from twice the floor on, with continuous slope, and the floor where surfaces touch.
fn held_above(h: f64, floor: f64) -> f64 {
    if h >= 2.0 * floor {
        h
    } else if h <= 0.0 {
        floor
    } else {
        floor + 0.25 * h * h / floor
    }
}

impl Side {
    /// Builds the side.
    ///
    /// # Errors
    /// What film, roughness and contact refuse, at `film_2d`, `roughness` and `contact`.
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
        let contact = setup.contact.build().map_err(|e| e.within("contact"));
        let (film, rough, contact) = match (film, rough, contact) {
            (Ok(film), Ok(rough), Ok(contact)) => (film, rough, contact),
            (film, rough, contact) => {
                return Err(film.err().into_iter().chain(rough.err()).chain(contact.err()).collect());
            }
        };
        let nodes = Nodes::new(&grid, &panel, is_half);
        let n = nodes.len();
        let shapes = nodes.shapes(sign, setup.compliance.shapes(), whole.len());
        let tests: Vec<f64> = shapes.iter().enumerate().map(|(k, v)| v * nodes.weight[k % n]).collect();
        let mut drop = nodes.drops(&panel, setup.profile);
        let least_drop = drop[0].iter().chain(&drop[1]).fold(f64::INFINITY, |a, &b| a.min(b));
        let is_cylinder = drop.iter().flatten().all(|d| *d == 0.0);
        if is_cylinder {
            drop = Default::default();
        }
        let profile = (!is_cylinder).then_some(setup.profile);
        let (cg, own) = (setup.contact_grid, &shapes[2 * n..]);
        let rows = ContactRows::new(panel, sign, clearance, cg, contact, symmetric, profile, &nodes, own);
        let is_rough = !rough.is_smooth();
        let over = Over { tests, arm: nodes.cos.iter().map(|c| panel.radius * c).collect(), nx: nodes.nx };
        Ok(Self {
            panel,
            sign,
            clearance,
            floor: setup.floor,
            is_half,
            drop,
            least_drop,
            over,
            face_shapes: nodes.at_faces(own),
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
            contact_now: [0.0; 4],
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

    /// Gap and factors at the displacements `e` of both edges and the elastic amplitudes `q`.
    fn shape_gap(&mut self, trial: bool, e: [f64; 2], q: &[f64], speed: f64) -> Result<(), EvalError> {
        if !(e.iter().all(|e| e.is_finite()) && q.iter().all(|q| q.is_finite())) {
            return Err(EvalError::recoverable(MODEL, "a displacement is not finite"));
        }
        // Work arrays and a gap of the same side: taken apart for the while.
        let mut gap = std::mem::take(if trial { &mut self.trial } else { &mut self.now });
        self.open_gap(&mut gap, e, q);
        let outcome = self.fill_gap(&mut gap, speed);
        *(if trial { &mut self.trial } else { &mut self.now }) = gap;
        outcome
    }

    /// The film in a gap that is open, and what depends on it.
    fn fill_gap(&mut self, gap: &mut Gap, speed: f64) -> Result<(), EvalError> {
        gap.smallest = gap.h.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        if gap.smallest < -DEEPEST {
            let what = format!("the skirt would stand {:.0} um inside the liner", -1e6 * gap.smallest);
            return Err(EvalError::recoverable(MODEL, what));
        }
        if self.rough.is_smooth() {
            self.smooth_film(gap)
        } else {
            self.rough_film(gap)?
        }
        self.axial_levers(gap);
        self.thin(gap, speed)
    }

    /// Distance of the surfaces at nodes and faces.
    fn open_gap(&self, gap: &mut Gap, e: [f64; 2], q: &[f64]) {
        let nodes = &self.nodes;
        let (nx, ny, n) = (nodes.nx, nodes.ny, nodes.len());
        let (c, top, bottom) = (self.clearance, self.sign * e[0], self.sign * e[1]);
        for j in 0..ny {
            let (own, next) = (nodes.cos[j], nodes.cos_face[j]);
            let line = j * nx..(j + 1) * nx;
            let (h, fx, fy) =
                (&mut gap.h[line.clone()], &mut gap.face_x[line.clone()], &mut gap.face_y[line]);
            for i in 0..nx {
                let here = between(top, bottom, nodes.s[i]);
                h[i] = c + here * own;
                fx[i] = c + between(top, bottom, nodes.s_face[i]) * own;
                fy[i] = c + here * next;
            }
        }
        if !self.drop[0].is_empty() {
            for (f, d) in [(&mut gap.h, 0), (&mut gap.face_x, 1), (&mut gap.face_y, 2)] {
                f.iter_mut().zip(&self.drop[d]).for_each(|(f, d)| *f += d);
            }
        }
        for (m, q) in q.iter().enumerate() {
            let shapes = [
                &self.shapes[(2 + m) * n..(3 + m) * n],
                &self.face_shapes[0][m * n..(m + 1) * n],
                &self.face_shapes[1][m * n..(m + 1) * n],
            ];
            for (f, shape) in [&mut gap.h, &mut gap.face_x, &mut gap.face_y].into_iter().zip(shapes) {
                f.iter_mut().zip(shape).for_each(|(f, s)| *f += q * s);
            }
        }
    }

    /// Film between smooth surfaces; the axial lever of the pressure into `work[0]`.
    fn smooth_film(&mut self, gap: &mut Gap) {
        let floor = self.floor;
        let held = |h: f64| held_above(h, floor);
        let lever = &mut self.work[0];
        for k in 0..lever.len() {
            let film = held(gap.h[k]);
            gap.flow.film[k] = film;
            gap.flow.transport[k] = film;
            gap.flow.content_slope[k] = 1.0;
            gap.drag[k] = 1.0 / film;
            lever[k] = film;
        }
        if gap.smallest < 2.0 * floor {
            gap.face_x.iter_mut().chain(&mut gap.face_y).for_each(|h| *h = held(*h));
        }
    }

    /// Film between rough surfaces; the axial lever of the pressure into `work[0]`.
    fn rough_film(&mut self, gap: &mut Gap) -> Result<(), EvalError> {
        self.rough.flow(&gap.h, &mut gap.flow)?;
        self.rough.shear(&gap.h, &mut self.shear)?;
        let (shear, lever) = (&self.shear, &mut self.work[0]);
        for k in 0..lever.len() {
            gap.drag[k] = (shear.phi_f[k] + shear.phi_fs[k]) / shear.film[k];
            lever[k] = shear.phi_fp[k] * shear.film[k];
        }
        if gap.flow.film.iter().zip(&gap.h).any(|(f, h)| f != h) {
            // Where the model holds the film above contact, it does so between the nodes too.
            for k in 0..self.nodes.len() {
                let (east, north) = self.nodes.next(k);
                let (film, h) = (&gap.flow.film, &gap.h);
                let raise = |a: usize, b: usize| 0.5 * ((film[a] - h[a]) + (film[b] - h[b]));
                let least = |a: usize, b: usize| 0.5 * film[a].min(film[b]);
                gap.face_x[k] = (gap.face_x[k] + raise(k, east)).max(least(k, east));
                gap.face_y[k] = (gap.face_y[k] + raise(k, north)).max(least(k, north));
            }
        }
        Ok(())
    }

    /// Axial force per pressure of every node, from the levers in `work[0]`.
    fn axial_levers(&self, gap: &mut Gap) {
        let nx = self.nodes.nx;
        for (j, weight) in self.nodes.line_weight.iter().enumerate() {
            let w = 0.5 * weight;
            let own = &self.work[0][j * nx..(j + 1) * nx];
            for i in 0..nx {
                // Half the mean of both neighbours, for the face before and for the face after.
                let before = if i > 0 { 0.5 * (own[i - 1] + own[i]) } else { 0.0 };
                let after = if i + 1 < nx { 0.5 * (own[i] + own[i + 1]) } else { 0.0 };
                gap.lever[j * nx + i] = w * (before - after);
            }
        }
    }

    /// Viscosity that falls with the shear rate of sliding.
    fn thin(&mut self, gap: &mut Gap, speed: f64) -> Result<(), EvalError> {
        let Some(model) = &self.thinning else { return Ok(()) };
        let [rate, slope, _] = &mut self.work;
        gap.thinning.resize(rate.len(), 1.0);
        for (rate, film) in rate.iter_mut().zip(&gap.flow.film) {
            *rate = speed / film;
        }
        model.factor(rate, &mut gap.thinning, slope)?;
        gap.drag.iter_mut().zip(&gap.thinning).for_each(|(d, t)| *d *= t);
        Ok(())
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
        self.placed.clear();
        self.sense = sense;
        self.shape_gap(false, e, q, speed)?;
        self.contact_now = self.contact_loads(e, q);
        let n = self.nodes();
        for (m, rates) in self.modes_of_rates.chunks_exact_mut(n).enumerate() {
            let shape = &self.shapes[m * n..(m + 1) * n];
            for ((r, s), slope) in rates.iter_mut().zip(shape).zip(&self.now.flow.content_slope) {
                *r = s * slope;
            }
        }
        if self.superposition != Superposition::None {
            self.full_films()?;
        }
        self.placed.extend_from_slice(&[e[0], e[1], key, sense]);
        self.placed.extend_from_slice(q);
        Ok(())
    }

    /// Pressures of full films at the present place, for sliding at one metre a second in the present sense and for each rate of one metre a second, into
    /// `fields`.
    ///
    /// # Errors
    /// A film that cannot be solved.
    fn full_films(&mut self) -> Result<(), EvalError> {
        let n = self.nodes();
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
        if self.is_superposed() {
            self.superpose(speed, rates);
            self.cut(mu);
        } else {
            self.solve_whole(false, speed, mu, rates)?;
        }
        self.sums(false, speed, mu, out);
        self.slopes(speed, mu, rates, slopes, out)
    }

    /// Derivatives of the forces that [`Side::loads`] just found, with the same arguments, into `out.slope`.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn slopes(
        &mut self,
        speed: f64,
        mu: f64,
        rates: &[f64],
        slopes: Slopes,
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        if slopes == Slopes::None {
            return Ok(());
        }
        let (n, width) = (self.nodes(), 4 + self.elastic);
        out.slope.resize(rates.len() * width, 0.0);
        if slopes == Slopes::Full && !self.is_superposed() {
            self.full_films()?;
        }
        if self.is_superposed() || slopes == Slopes::Full {
            let all = if slopes == Slopes::Full { 1.0 } else { 0.0 };
            for (m, row) in out.slope.chunks_exact_mut(width).enumerate() {
                let field = &self.fields[(1 + m) * n..(2 + m) * n];
                let taken = &mut self.work[0];
                for k in 0..n {
                    taken[k] = mu * self.open[k].max(all) * field[k];
                }
                self.over.sums(taken, &self.now.lever, row);
            }
            return Ok(());
        }
        // The film of now waits where nothing else is kept meanwhile.
        self.set_aside();
        let outcome = self.slopes_of_whole(speed, mu, rates, out);
        self.set_aside();
        outcome
    }

    /// Changes pressure and filling for what waits in their place.
    fn set_aside(&mut self) {
        let [_, p, fill] = &mut self.work;
        std::mem::swap(&mut self.p, p);
        std::mem::swap(&mut self.fill, fill);
    }

    /// Derivatives of a film that is found with its cavities: what its model tells, or difference quotients.
    fn slopes_of_whole(
        &mut self,
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        let (n, width) = (self.nodes(), 4 + self.elastic);
        let mut changes = std::mem::take(&mut self.fields);
        changes[..rates.len() * n].copy_from_slice(&self.modes_of_rates);
        self.fills.resize(rates.len() * n, 0.0);
        let told = self.film.answer(&mut changes[..rates.len() * n], &mut self.fills);
        let mut there = SideLoads::default();
        let mut outcome = told;
        if let Ok(true) = outcome {
            for m in 0..rates.len() {
                self.p.copy_from_slice(&changes[m * n..(m + 1) * n]);
                self.fill.copy_from_slice(&self.fills[m * n..(m + 1) * n]);
                self.sums(false, speed, mu, &mut there);
                let row = &mut out.slope[m * width..(m + 1) * width];
                row[..4].copy_from_slice(&there.film);
                row[4..].copy_from_slice(&there.elastic);
            }
        } else if outcome.is_ok() {
            outcome = self.difference_quotients(speed, mu, rates, out).map(|()| false);
        }
        self.fields = changes;
        outcome.map(|_| ())
    }

    /// Derivatives by films at rates beside the present ones.
    fn difference_quotients(
        &mut self,
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        let width = 4 + self.elastic;
        let mut moved = rates.to_vec();
        let mut there = SideLoads::default();
        for m in 0..rates.len() {
            // Rates matter against the clearance per millisecond; the film is found to some 1e-9.
            let d = 1e-4 * rates[m].abs().max(1e-2 * self.clearance / 1e-3);
            moved[m] = rates[m] + d;
            self.solve_whole(false, speed, mu, &moved)?;
            moved[m] = rates[m];
            self.sums(false, speed, mu, &mut there);
            let row = &mut out.slope[m * width..(m + 1) * width];
            for k in 0..4 {
                row[k] = (there.film[k] - out.film[k]) / d;
            }
            for k in 0..self.elastic {
                row[4 + k] = (there.elastic[k] - out.elastic[k]) / d;
            }
        }
        Ok(())
    }

    /// Forces at places beside the present one, at `e` and `q`: coordinate after coordinate (upper edge, lower edge, elastic amplitudes) is moved by its `d`
    /// alone; to first order in it.
    ///
    /// The pressures of now leave a flow over in the film beside; the matrix that is set up says what pressures take it up.
    ///
    /// # Errors
    /// A film that cannot be solved.
    #[allow(clippy::too_many_arguments, reason = "a place, a motion and a step")]
    pub fn loads_beside(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        d: &[f64],
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut [SideLoads],
    ) -> Result<(), EvalError> {
        let n = self.nodes();
        let count = 2 + self.elastic;
        if self.is_superposed() {
            self.superpose(speed, rates);
            self.cut(mu);
        }
        let mut moved = std::mem::take(&mut self.moved);
        let mut outcome = Ok(true);
        for (c, out) in out.iter_mut().enumerate().take(count) {
            let at = |k: usize, x: f64| if k == c { x + d[k] } else { x };
            let there = [at(0, e[0]), at(1, e[1])];
            moved.clear();
            moved.extend(q.iter().enumerate().map(|(m, q)| at(2 + m, *q)));
            outcome = if self.is_superposed() {
                self.begin_beside(there, &moved, speed, mu, rates, c, out)
            } else {
                Ok(false)
            };
            if let Ok(false) = outcome {
                outcome = self.loads_elsewhere(there, &moved, speed, mu, rates, out).map(|()| false);
            }
            if outcome.is_err() {
                break;
            }
        }
        self.moved = moved;
        if !outcome? {
            return Ok(());
        }
        self.film.respond(&mut self.beside)?;
        let width = 4 + self.elastic;
        for (c, out) in out.iter_mut().enumerate().take(count) {
            let change = &self.beside[c * n..(c + 1) * n];
            let taken = &mut self.work[0];
            for k in 0..n {
                taken[k] = mu * self.open[k] * change[k];
            }
            self.over.sums(taken, &self.now.lever, &mut self.row[..width]);
            out.film.iter_mut().zip(&self.row).for_each(|(f, d)| *f += d);
            out.elastic.iter_mut().zip(&self.row[4..]).for_each(|(f, d)| *f += d);
        }
        Ok(())
    }

    /// The part of [`Side::loads_beside`] that needs no solution: forces of the pressures of now in the film beside, and the flow that they leave
    /// over. Whether the film's model can tell.
    #[allow(clippy::too_many_arguments, reason = "a place, a motion and a column")]
    fn begin_beside(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        speed: f64,
        mu: f64,
        rates: &[f64],
        column: usize,
        out: &mut SideLoads,
    ) -> Result<bool, EvalError> {
        self.shape_gap(true, e, q, speed)?;
        out.contact = self.contact_loads(e, q);
        self.sums(true, speed, mu, out);
        self.left_over(true, speed, rates, column)
    }

    /// Forces at another place for rates that are given: one film alone. The present place stays.
    fn loads_elsewhere(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        self.shape_gap(true, e, q, speed)?;
        out.contact = self.contact_loads(e, q);
        let kept = std::mem::take(&mut self.p);
        self.p = std::mem::take(&mut self.open);
        let outcome = if self.superposition == Superposition::None {
            let filled = self.fill.clone();
            let r = self.solve_whole(true, speed, mu, rates);
            if r.is_ok() {
                self.sums(true, speed, mu, out);
            }
            self.fill = filled;
            r.map(|_| ())
        } else {
            self.combine_rates(true, rates);
            let n = self.nodes();
            let inp = film_input(&self.trial, n);
            let mode = FilmMode { u: -speed, dhdt: &self.rates, edge_pressure: [0.0; 4] };
            // Close to that of the present place.
            self.p.iter_mut().zip(&kept).for_each(|(p, kept)| *p = kept / mu);
            let r = self.film.solve_many(&inp, &[mode], &mut self.p).map(|_| ());
            self.evaluations += 1;
            let cut =
                if self.superposition == Superposition::CutOff { self.p_cav } else { f64::NEG_INFINITY };
            self.p.iter_mut().for_each(|p| *p = (mu * *p).max(cut));
            if r.is_ok() {
                self.sums(true, speed, mu, out);
            }
            r
        };
        self.open = std::mem::take(&mut self.p);
        self.p = kept;
        outcome
    }

    /// Rate of the gap's content at every node, into `self.rates`.
    fn combine_rates(&mut self, trial: bool, rates: &[f64]) {
        let n = self.nodes();
        let gap = if trial { &self.trial } else { &self.now };
        for k in 0..n {
            self.rates[k] = rates[0] * self.shapes[k] + rates[1] * self.shapes[n + k];
        }
        for (m, rate) in rates[2..].iter().enumerate() {
            let shape = &self.shapes[(2 + m) * n..(3 + m) * n];
            self.rates.iter_mut().zip(shape).for_each(|(r, s)| *r += rate * s);
        }
        self.rates.iter_mut().zip(&gap.flow.content_slope).for_each(|(r, s)| *r *= s);
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
        let n = self.nodes();
        let gap = if trial { &self.trial } else { &self.now };
        let [scaled, _, _] = &mut self.work;
        let viscosity = if gap.thinning.is_empty() {
            Viscosity::Uniform(mu)
        } else {
            scaled.iter_mut().zip(&gap.thinning).for_each(|(s, t)| *s = mu * t);
            Viscosity::Nodes(scaled)
        };
        let found = self.film.solve(&Film2dIn {
            u: -speed,
            mu: viscosity,
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

    /// Oil that leaves the side at the rates given \[m³/s\]: over the upper edge, over the lower edge, over the flanks.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn oil_flow(&mut self, speed: f64, mu: f64, rates: &[f64]) -> Result<[f64; 3], EvalError> {
        let out = if self.is_superposed() {
            self.superpose(speed, rates);
            self.cut(mu);
            self.p.iter_mut().for_each(|p| *p /= mu);
            let known = self.left_over(false, speed, rates, 0);
            self.p.iter_mut().for_each(|p| *p *= mu);
            if known? { self.outflow() } else { self.whole_outflow(speed, mu, rates)? }
        } else {
            self.whole_outflow(speed, mu, rates)?
        };
        let both = if self.is_half { 2.0 } else { 1.0 };
        let flanks = if self.is_half { 2.0 * out[2] } else { out[2] + out[3] };
        Ok([both * out[0], both * out[1], flanks])
    }

    /// Flow over every edge, by a film of its own.
    fn whole_outflow(&mut self, speed: f64, mu: f64, rates: &[f64]) -> Result<[f64; 4], EvalError> {
        let kept = (self.p.clone(), self.fill.clone());
        let found = self.solve_whole(false, speed, mu, rates);
        (self.p, self.fill) = kept;
        // The matrix is no longer that of the present place.
        self.placed.clear();
        Ok(found?.outflow)
    }

    /// Flow over every edge that the first field of `self.beside` leaves over there.
    fn outflow(&self) -> [f64; 4] {
        let (nx, ny) = (self.nodes.nx, self.nodes.ny);
        let mut out = [0.0; 4];
        for (k, r) in self.beside[..nx * ny].iter().enumerate() {
            let (i, j) = (k % nx, k / nx);
            let at = [i == 0, i + 1 == nx, j == 0, j + 1 == ny];
            let edges = self.film.grid().edges;
            if let Some(e) = (0..4).find(|&e| at[e] && edges[e] == Edge::Pressure) {
                // A flank at the pressure of the cavity beside it gives no oil to a gap that opens.
                let inner = (i.clamp(1, nx - 2), j.clamp(1, if self.is_half { ny - 1 } else { ny - 2 }));
                let dry = e >= 2 && self.p_cav >= 0.0 && self.open[inner.1 * nx + inner.0] == 0.0;
                out[e] += if dry { r.max(0.0) } else { *r };
            }
        }
        out
    }

    /// Uncut pressure per viscosity for the rates, into `self.raw`.
    fn superpose(&mut self, speed: f64, rates: &[f64]) {
        let n = self.nodes();
        let (sliding, rest) = self.fields.split_at(n);
        self.raw.iter_mut().zip(sliding).for_each(|(p, f)| *p = speed.abs() * f);
        for (rate, field) in rates.iter().zip(rest.chunks_exact(n)) {
            self.raw.iter_mut().zip(field).for_each(|(p, f)| *p += rate * f);
        }
    }

    /// The pressure from `self.raw`, cut off, and where it takes part in changes.
    fn cut(&mut self, mu: f64) {
        let cut = if self.superposition == Superposition::CutOff { self.p_cav } else { f64::NEG_INFINITY };
        for ((p, open), raw) in self.p.iter_mut().zip(&mut self.open).zip(&self.raw) {
            let full = mu * raw;
            // A film without pressure, as that of a centred skirt at rest, answers like a full one.
            let is_open = full >= cut;
            *open = if is_open { 1.0 } else { 0.0 };
            *p = if is_open { full } else { cut };
        }
    }

    /// Flow per viscosity that a pressure per viscosity leaves over in the film, into field `column` of `self.beside`: `self.raw` for the film beside the
    /// present place, `self.p` for the present one. Whether the film's model can tell.
    fn left_over(
        &mut self,
        trial: bool,
        speed: f64,
        rates: &[f64],
        column: usize,
    ) -> Result<bool, EvalError> {
        self.combine_rates(trial, rates);
        let n = self.nodes();
        let gap = if trial { &self.trial } else { &self.now };
        let mode = FilmMode { u: -speed, dhdt: &self.rates, edge_pressure: [0.0; 4] };
        let p = if trial { &self.raw } else { &self.p };
        self.film.imbalance(&film_input(gap, n), &mode, p, &mut self.beside[column * n..(column + 1) * n])
    }

    /// Sums over the film in `self.p`.
    fn sums(&mut self, trial: bool, speed: f64, mu: f64, out: &mut SideLoads) {
        let width = 4 + self.elastic;
        let gap = if trial { &self.trial } else { &self.now };
        let nx = self.nodes.nx;
        self.over.sums(&self.p, &gap.lever, &mut self.row[..width]);
        let mut found = [0.0; 4];
        found.copy_from_slice(&self.row[..4]);
        out.elastic.resize(self.elastic, 0.0);
        out.elastic.copy_from_slice(&self.row[4..width]);
        // Couette drag: the liner slides against the piston.
        for j in 0..self.nodes.ny {
            let line = j * nx..(j + 1) * nx;
            let full: f64 = self.nodes.weight[line.clone()]
                .iter()
                .zip(&gap.drag[line.clone()])
                .zip(&self.fill[line])
                .map(|((w, d), f)| w * d * f)
                .sum();
            found[2] -= mu * speed * full;
            found[3] -= mu * speed * full * self.panel.radius * self.nodes.cos[j];
        }
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

    /// Solid contact: forces on both edges, normal force, and its moment arm.
    fn contact_loads(&mut self, e: [f64; 2], q: &[f64]) -> [f64; 4] {
        let range = self.rows.range();
        if range <= 0.0 || self.least_contact_gap(e, q) >= range {
            return [0.0; 4];
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

    /// Coefficient of friction of solid contact.
    #[must_use]
    pub fn friction_coefficient(&self) -> f64 {
        self.rows.friction_coefficient()
    }
}

/// A film of unit viscosity without causes.
fn film_input<'a>(gap: &'a Gap, n: usize) -> Film2dIn<'a> {
    let flow = &gap.flow;
    let factor = |f: &'a [f64]| if gap.is_rough { f } else { &[] };
    Film2dIn {
        h_face_x: &gap.face_x,
        h_face_y: &gap.face_y,
        mu: if gap.thinning.len() == n { Viscosity::Nodes(&gap.thinning) } else { Viscosity::Uniform(1.0) },
        p_cav: 0.0,
        factors: FlowFactors {
            pressure_x: factor(&flow.phi_x),
            pressure_y: factor(&flow.phi_y),
            transport: factor(&flow.transport),
            content: &[],
        },
        ..Film2dIn::new(&flow.film, 0.0, 1.0)
    }
}

/// What sums over a film need besides its lever.
struct Over {
    /// Shapes of the gap's rates times the areas of the nodes.
    tests: Vec<f64>,
    /// `R cos φ` of every line.
    arm: Vec<f64>,
    nx: usize,
}

impl Over {
    /// `out`: forces of a pressure on both edges, along the bore, along the bore times `R cos φ`, and on the elastic shapes.
    fn sums(&self, p: &[f64], lever: &[f64], out: &mut [f64]) {
        let (n, nx) = (p.len(), self.nx);
        let dot = gudgeon_numerics::linalg::dot;
        let (head, elastic) = out.split_at_mut(4);
        let mut tests = self.tests.chunks_exact(n);
        for out in head[..2].iter_mut().chain(elastic) {
            *out = tests.next().map_or(0.0, |test| dot(test, p));
        }
        (head[2], head[3]) = (0.0, 0.0);
        for ((lever, p), arm) in lever.chunks_exact(nx).zip(p.chunks_exact(nx)).zip(&self.arm) {
            let line = dot(lever, p);
            head[2] += line;
            head[3] += line * arm;
        }
    }
}

/// Whether all shapes are their own mirror images.
fn are_symmetric(grid: &Film2dGrid, shapes: &[f64]) -> bool {
    let fields: Vec<&[f64]> = shapes.chunks(grid.len().max(1)).collect();
    grid.is_symmetric_in_y(&[0.0; 4], &fields, 1e-9)
}
