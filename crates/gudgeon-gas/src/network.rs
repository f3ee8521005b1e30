//! A network of gas volumes and boundaries joined by passages.

use gudgeon_core::{BuildError, EvalError};

use crate::orifice::{FlowSlopes, OrificeLaw, Side};

/// What lets gas through between two nodes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Passage {
    /// Nothing passes.
    #[default]
    Closed,
    /// An opening of the geometric area \[m²\], by the orifice law.
    Orifice {
        /// Geometric area \[m²\].
        area: f64,
    },
    /// A narrow channel with compressible isothermal laminar flow, `ṁ = conductance (p_a² - p_b²)`.
    Channel {
        /// Conductance \[kg/(s Pa²)\], see [`channel_conductance`].
        conductance: f64,
    },
    /// The same channel behind its own mouth, which passes no more than an orifice of its cross section.
    ///
    /// The viscous pressure loss of the channel is proportional to the flow and the loss at the mouth to its square; adding
    /// them gives, with the flows `c` of the channel alone and `o` of the orifice alone (without its laminar branch),
    ///
    /// ```text
    /// ṁ = 2 c o / ( o + sqrt(o² + 4 c²) )
    /// ```
    ///
    /// which is below both, tends to `c` for a narrow passage and to `o` for a wide one, and is smooth through zero.
    LimitedChannel {
        /// Conductance \[kg/(s Pa²)\].
        conductance: f64,
        /// Cross section \[m²\].
        area: f64,
    },
    /// The same, with friction that turns turbulent: the flow of the channel alone is `c [1 + (Re/Re_c)³]^(-1/7)`.
    ///
    /// `Re = 2 c/(perimeter μ)`, of the laminar flow `c`, is formed with the hydraulic diameter, twice the height. Far above
    /// [`TRANSITION`], `Re_c`, that is the flow with Blasius' friction factor `0.3164 Re^(-1/4)`, far below the laminar one; at it, 9 %
    /// below both. Smooth throughout.
    BlendedChannel {
        /// Conductance \[kg/(s Pa²)\] of the laminar flow.
        conductance: f64,
        /// Cross section \[m²\].
        area: f64,
        /// `perimeter μ/2` \[kg/s\]: the flow whose Reynolds number is one.
        unit_flow: f64,
    },
    /// An opening and, beside it, a linear leak `ṁ = leak (p_a - p_b)` that ties two volumes together.
    Tied {
        /// Geometric area \[m²\].
        area: f64,
        /// Conductance of the leak \[kg/(s Pa)\].
        leak: f64,
    },
}

/// Conductance \[kg/(s Pa²)\] of a channel between parallel walls: `perimeter height³ / (24 μ R T length)`, with the
/// `perimeter` \[m\] across the flow, the distance `height` \[m\] of the walls and the `length` \[m\] along the flow.
///
/// Holds while the flow is laminar and its Mach number small.
#[must_use]
pub fn channel_conductance(perimeter: f64, height: f64, length: f64, mu: f64, rt: f64) -> f64 {
    perimeter * height * height * height / (24.0 * mu * rt * length)
}

/// Reynolds number at which the laminar friction factor of a flat channel, `96/Re`, and Blasius', `0.3164 Re^(-1/4)`, are equal:
/// `(96/0.3164)^(4/3)`.
pub const TRANSITION: f64 = 2_038.823_720_100_052_5;

/// What turbulence leaves of the laminar flow of a channel, and of its derivative, at the Reynolds number that it would have.
#[inline]
fn turbulent_share(reynolds: f64) -> (f64, f64) {
    // The bound keeps the cube a number.
    let x = (reynolds / TRANSITION).min(1e100);
    let cube = x * x * x;
    let share = (1.0 + cube).powf(-1.0 / 7.0);
    (share, share * (1.0 - 3.0 / 7.0 * cube / (1.0 + cube)))
}

/// Dynamic viscosity \[Pa s\] of air at the temperature \[K\] by Sutherland's law,
/// `μ = μ_0 (T/T_0)^1.5 (T_0 + S)/(T + S)` with `μ_0` = 17.16 µPa s at `T_0` = 273.15 K and `S` = 110.4 K.
///
/// Within 2 % of handbook values from 200 K to 700 K.
#[must_use]
pub fn sutherland_viscosity(temperature: f64) -> f64 {
    const MU_0: f64 = 1.716e-5;
    const T_0: f64 = 273.15;
    const S: f64 = 110.4;
    let t = temperature / T_0;
    MU_0 * t * t.sqrt() * (T_0 + S) / (temperature + S)
}

#[derive(Debug, Clone, Copy)]
struct Link {
    from: usize,
    to: usize,
    passage: Passage,
    /// That of a plain orifice, 0 for everything else.
    area: f64,
    /// A second passage behind the first, with a space between them that stores nothing.
    second: Option<Passage>,
}

/// A node and what its links need of it, computed once for all of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    /// `R T` \[J/kg\].
    rt: f64,
    side: Side,
    /// `1 / p` \[1/Pa\]; 0 before a pressure is set.
    inv_p: f64,
    /// `C_d p / sqrt(R T)`, the choked flow per area but for its constant \[kg/(s m²)\].
    strength: f64,
    /// `∂p/∂m = R T / V` \[Pa/kg\].
    per_mass: f64,
}

/// The flow through a link, and the space between its passages when it has two, as they were.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flow {
    flow: f64,
    between: Option<Node>,
}

/// Links that are computed together.
const LANES: usize = 4;

/// Gas volumes, each at its own constant temperature, and boundaries at given pressures, joined by passages.
///
/// Nodes `0..volumes` are volumes, whose pressure follows from their mass, `p = m R T / V`; the others are boundaries. A volume's
/// walls hold its temperature, so the balance of mass is the only one:
///
/// ```text
/// dm_i/dt = Σ flows into i - Σ flows out of i
/// ```
///
/// Volumes may change with time: the mass is the state, hence no term with `dV/dt`.
#[derive(Debug, Clone)]
pub struct Network {
    law: OrificeLaw,
    nodes: Vec<Node>,
    links: Vec<Link>,
    /// One per link, filled up with zeros to whole lanes; so are `front` and `drop`.
    flow: Vec<f64>,
    /// What stands before `ψ` in the orifice law \[kg/s\].
    front: Vec<f64>,
    /// Relative pressure drop, positive in the direction of the link.
    drop: Vec<f64>,
    /// Whether any link has been more than an orifice.
    others: bool,
    /// Derivatives of the flows by the pressures of both ends.
    slope: Vec<[f64; 2]>,
    /// Spaces between the two passages of links that have two; as many as links, or none.
    middle: Vec<Node>,
    /// Derivatives of their pressures by the pressures of both ends.
    middle_slope: Vec<[f64; 2]>,
    /// One law per node, for gas that comes from it; or none, and `law` is that of all.
    own: Vec<OrificeLaw>,
    volumes: usize,
}

impl Network {
    /// A network whose first `volumes` nodes are volumes. Every link starts closed; its positive direction is from the first
    /// to the second node.
    ///
    /// # Errors
    /// A temperature or the gas constant that is not positive, a link to a node that does not exist.
    pub fn new(
        law: OrificeLaw,
        gas_constant: f64,
        temperatures: &[f64],
        volumes: usize,
        links: &[(usize, usize)],
    ) -> Result<Self, BuildError> {
        let possible = |t: &f64| gas_constant * t > 0.0 && (gas_constant * t).is_finite();
        if let Some(i) = temperatures.iter().position(|t| !possible(t)) {
            return Err(BuildError::new(format!(
                "the gas temperature {} K with the gas constant {gas_constant} J/(kg K) is not possible",
                temperatures[i]
            )));
        }
        let count = temperatures.len();
        if volumes > count || links.iter().any(|&(a, b)| a.max(b) >= count) {
            return Err(BuildError::new(format!("the gas network has only {count} nodes")));
        }
        let node = |t: &f64| Node::at(gas_constant * t);
        let padded = links.len().next_multiple_of(LANES);
        Ok(Self {
            law,
            nodes: temperatures.iter().map(node).collect(),
            links: links
                .iter()
                .map(|&(from, to)| Link { from, to, passage: Passage::Closed, area: 0.0, second: None })
                .collect(),
            flow: vec![0.0; padded],
            front: vec![0.0; padded],
            drop: vec![0.0; padded],
            others: false,
            slope: vec![[0.0; 2]; links.len()],
            middle: Vec::new(),
            middle_slope: Vec::new(),
            own: Vec::new(),
            volumes,
        })
    }

    /// Gives every node the law for the gas that comes from it: one per node, or none, and all have the law of the network.
    pub fn set_laws(&mut self, laws: Vec<OrificeLaw>) {
        self.own = laws;
    }

    /// Makes a link one of two passages, with a space at `R T` = `rt` \[J/kg\] between them that stores nothing.
    pub(crate) fn split_link(&mut self, link: usize, rt: f64) {
        let between = Node::at(rt);
        self.middle.resize(self.links.len(), between);
        self.middle_slope.resize(self.links.len(), [0.0; 2]);
        self.middle[link] = between;
        self.links[link].second = Some(Passage::Closed);
        self.others = true;
    }

    /// Opens or closes both passages of a link made by [`split_link`](Self::split_link).
    pub(crate) fn set_passages(&mut self, link: usize, first: Passage, second: Passage) {
        let link = &mut self.links[link];
        (link.passage, link.second, link.area) = (first, Some(second), 0.0);
    }

    /// Pressure \[Pa\] between the two passages of a link, at the last update of its flow.
    pub(crate) fn middle_pressure(&self, link: usize) -> f64 {
        self.middle[link].side.p
    }

    /// Its derivatives by the pressures of both ends, at the last [`update_slopes`](Self::update_slopes).
    pub(crate) fn middle_slope(&self, link: usize) -> [f64; 2] {
        self.middle_slope[link]
    }

    /// Number of nodes that are volumes.
    #[must_use]
    pub const fn volumes(&self) -> usize {
        self.volumes
    }

    /// `R T` of a node \[J/kg\].
    #[must_use]
    pub fn rt(&self, node: usize) -> f64 {
        self.nodes[node].rt
    }

    /// Sets the pressure of a volume \[Pa\] from its mass \[kg\] and size \[m³\].
    ///
    /// # Errors
    /// Recoverable, when mass or size is not positive.
    #[inline]
    pub fn set_mass(
        &mut self,
        model: &'static str,
        node: usize,
        mass: f64,
        volume: f64,
    ) -> Result<(), EvalError> {
        if mass > 0.0 && volume > 0.0 {
            let n = &mut self.nodes[node];
            let per_mass = n.rt / volume;
            let p = mass * per_mass;
            if p >= f64::MIN_POSITIVE && p.is_finite() {
                n.per_mass = per_mass;
                n.set(p, self.law.discharge());
                return Ok(());
            }
        }
        Err(refused_volume(model, mass, volume))
    }

    /// Sets the pressure of a boundary \[Pa\].
    ///
    /// # Errors
    /// Recoverable, when it is not positive.
    #[inline]
    pub fn set_pressure(&mut self, model: &'static str, node: usize, p: f64) -> Result<(), EvalError> {
        if p >= f64::MIN_POSITIVE && p.is_finite() {
            self.nodes[node].set(p, self.law.discharge());
            Ok(())
        } else {
            Err(refused_pressure(model, p))
        }
    }

    /// A node as it is, for [`restore_node`](Self::restore_node).
    pub(crate) fn node(&self, node: usize) -> Node {
        self.nodes[node]
    }

    /// Puts back a node as it was.
    pub(crate) fn restore_node(&mut self, node: usize, as_it_was: Node) {
        self.nodes[node] = as_it_was;
    }

    /// Opens or closes a link.
    #[inline]
    pub fn set_passage(&mut self, link: usize, passage: Passage) {
        let link = &mut self.links[link];
        link.passage = passage;
        link.area = match passage {
            Passage::Orifice { area } => area,
            Passage::Closed => 0.0,
            _ => {
                self.others = true;
                0.0
            }
        };
    }

    /// Pressure of a node \[Pa\].
    #[inline]
    #[must_use]
    pub fn pressure(&self, node: usize) -> f64 {
        self.nodes[node].side.p
    }

    /// `∂p/∂m = R T / V` \[Pa/kg\] of a volume, for the size at the last [`set_mass`](Self::set_mass).
    #[inline]
    #[must_use]
    pub fn pressure_per_mass(&self, node: usize) -> f64 {
        self.nodes[node].per_mass
    }

    /// Computes the flows through all links from the pressures and passages set before.
    pub fn update_flows(&mut self) {
        if self.law.is_truncated() || !self.own.is_empty() {
            for link in 0..self.links.len() {
                self.flow[link] = self.flow_now(link);
            }
            return;
        }
        let nodes = self.nodes.as_slice();
        for ((link, front), drop) in self.links.iter().zip(&mut self.front).zip(&mut self.drop) {
            (*front, *drop) = orifice(link.area, &nodes[link.from], &nodes[link.to]);
        }
        let lanes = self.front.as_chunks::<LANES>().0.iter().zip(self.drop.as_chunks::<LANES>().0);
        for (flow, (front, drop)) in self.flow.as_chunks_mut::<LANES>().0.iter_mut().zip(lanes) {
            let psi = self.law.psi_lanes(*drop);
            *flow = std::array::from_fn(|i| (front[i] * psi[i]).copysign(drop[i]));
        }
        if self.others {
            for link in 0..self.links.len() {
                let Link { passage, second, .. } = self.links[link];
                if second.is_some() || !matches!(passage, Passage::Orifice { .. } | Passage::Closed) {
                    self.flow[link] = self.flow_now(link);
                }
            }
        }
    }

    /// Flow through a link, and the pressure between its passages when it has two.
    fn flow_now(&mut self, link: usize) -> f64 {
        let Link { from, to, passage, second, .. } = self.links[link];
        let (a, b) = (&self.nodes[from], &self.nodes[to]);
        let law = law_from(&self.law, &self.own, a, b, [from, to]);
        match second {
            None => through(law, passage, a, b),
            Some(second) => in_series(law, [passage, second], a, &mut self.middle[link], b).0.flow,
        }
    }

    /// Computes the flow through one link alone, and gives what it was before.
    pub(crate) fn update_flow(&mut self, link: usize) -> Flow {
        let between = self.middle.get(link).copied();
        let flow = self.flow_now(link);
        Flow { flow: std::mem::replace(&mut self.flow[link], flow), between }
    }

    /// Puts back a flow that was found before.
    #[inline]
    pub(crate) fn restore_flow(&mut self, link: usize, as_it_was: Flow) {
        self.flow[link] = as_it_was.flow;
        if let (Some(now), Some(before)) = (self.middle.get_mut(link), as_it_was.between) {
            *now = before;
        }
    }

    /// Computes flows and their derivatives by the pressures, see [`slope`](Self::slope) and [`jacobian`](Self::jacobian).
    pub fn update_slopes(&mut self) {
        for (i, ((link, flow), slope)) in
            self.links.iter().zip(&mut self.flow).zip(&mut self.slope).enumerate()
        {
            let (a, b) = (&self.nodes[link.from], &self.nodes[link.to]);
            let law = law_from(&self.law, &self.own, a, b, [link.from, link.to]);
            let s = match link.second {
                None => slopes_through(law, link.passage, a, b),
                Some(second) => {
                    let (s, between) = in_series(law, [link.passage, second], a, &mut self.middle[i], b);
                    self.middle_slope[i] = between;
                    s
                }
            };
            *flow = s.flow;
            *slope = [s.by_a, s.by_b];
        }
    }

    /// Derivatives \[kg/(s Pa)\] of the flow through a link by the pressures of its first and of its second node, at the last
    /// [`update_slopes`](Self::update_slopes).
    #[inline]
    #[must_use]
    pub fn slope(&self, link: usize) -> [f64; 2] {
        self.slope[link]
    }

    /// Adds `factor` times the derivatives of the flow through a link by the masses of all volumes to `row` \[1/s\].
    #[inline]
    pub fn add_flow_gradient(&self, link: usize, factor: f64, row: &mut [f64]) {
        let Link { from, to, .. } = self.links[link];
        for (node, slope) in [from, to].into_iter().zip(self.slope[link]) {
            if node < self.volumes {
                row[node] += factor * slope * self.nodes[node].per_mass;
            }
        }
    }

    /// Derivatives \[1/s\] of the [`rates`](Self::rates) by the masses, row-major, one row per volume, from the last
    /// [`update_slopes`](Self::update_slopes). The columns of a closed network add up to zero within rounding.
    pub fn jacobian(&self, jac: &mut [f64]) {
        let n = self.volumes;
        jac[..n * n].fill(0.0);
        for (&Link { from, to, .. }, slope) in self.links.iter().zip(&self.slope) {
            for (node, slope) in [from, to].into_iter().zip(slope) {
                if node < n {
                    let rate = slope * self.nodes[node].per_mass;
                    if from < n {
                        jac[from * n + node] -= rate;
                    }
                    if to < n {
                        jac[to * n + node] += rate;
                    }
                }
            }
        }
    }

    /// Flow \[kg/s\] through a link at the last [`update_flows`](Self::update_flows).
    #[inline]
    #[must_use]
    pub fn flow(&self, link: usize) -> f64 {
        self.flow[link]
    }

    /// Rates of change of the masses \[kg/s\] of all volumes.
    pub fn rates(&self, d_mass: &mut [f64]) {
        d_mass.fill(0.0);
        for (link, &flow) in self.links.iter().zip(&self.flow) {
            if link.from < self.volumes {
                d_mass[link.from] -= flow;
            }
            if link.to < self.volumes {
                d_mass[link.to] += flow;
            }
        }
    }
}

impl Node {
    pub(crate) fn at(rt: f64) -> Self {
        let side = Side { p: 0.0, inv_sqrt_rt: rt.sqrt().recip() };
        Self { rt, side, inv_p: 0.0, strength: 0.0, per_mass: 0.0 }
    }

    #[inline]
    pub(crate) fn set(&mut self, p: f64, discharge: f64) {
        self.side.p = p;
        self.inv_p = 1.0 / p;
        self.strength = discharge * p * self.side.inv_sqrt_rt;
    }
}

#[cold]
fn refused_volume(model: &'static str, mass: f64, volume: f64) -> EvalError {
    EvalError::recoverable(model, format!("a gas volume of {volume:e} m3 holds a mass of {mass:e} kg"))
}

#[cold]
fn refused_pressure(model: &'static str, p: f64) -> EvalError {
    EvalError::recoverable(model, format!("a boundary has the absolute pressure {p:e} Pa"))
}

/// What stands before `ψ`, and the relative pressure drop of an opening, positive from `a` to `b`.
#[inline]
fn orifice(area: f64, a: &Node, b: &Node) -> (f64, f64) {
    let drop = a.side.p - b.side.p;
    let up = if drop >= 0.0 { a } else { b };
    (area * up.strength, drop * up.inv_p)
}

/// The law for the gas that goes from `a` to `b`, or back: that of the node it comes from.
#[inline]
fn law_from<'a>(
    common: &'a OrificeLaw,
    own: &'a [OrificeLaw],
    a: &Node,
    b: &Node,
    nodes: [usize; 2],
) -> &'a OrificeLaw {
    let up = if a.side.p >= b.side.p { nodes[0] } else { nodes[1] };
    own.get(up).unwrap_or(common)
}

/// Flow \[kg/s\] through a passage.
#[inline]
pub(crate) fn through(law: &OrificeLaw, passage: Passage, from: &Node, to: &Node) -> f64 {
    let (a, b) = (from.side, to.side);
    let channel = |conductance: f64| conductance * (a.p - b.p) * (a.p + b.p);
    // Loss by friction, in proportion to the flow, and at the mouth, to its square.
    let limited = |c: f64, area: f64| {
        let o = law.flow_bare(area, a, b).abs();
        let sum = o + (o * o + 4.0 * c * c).sqrt();
        if sum > 0.0 { 2.0 * c * (o / sum) } else { 0.0 }
    };
    let opening = |area: f64| {
        if law.is_truncated() {
            return law.flow(area, a, b);
        }
        let (front, drop) = orifice(area, from, to);
        let [psi] = law.psi_lanes([drop]);
        (front * psi).copysign(drop)
    };
    match passage {
        Passage::Closed => 0.0,
        Passage::Orifice { area } => opening(area),
        Passage::Channel { conductance } => channel(conductance),
        Passage::LimitedChannel { conductance, area } => limited(channel(conductance), area),
        Passage::BlendedChannel { conductance, area, unit_flow } => {
            let c = channel(conductance);
            limited(c * turbulent_share(c.abs() / unit_flow).0, area)
        }
        Passage::Tied { area, leak } => opening(area) + leak * (a.p - b.p),
    }
}

/// Flow from one node to another with its derivatives.
fn slopes_through(law: &OrificeLaw, passage: Passage, from: &Node, to: &Node) -> FlowSlopes {
    let (a, b) = (from.side, to.side);
    let opening = |area: f64| {
        if law.is_truncated() {
            return law.flow_slopes(area, a, b);
        }
        let (front, drop) = orifice(area, from, to);
        let (psi, by_up, by_down) = law.psi_slopes(drop.abs());
        let flow = (front * psi).copysign(drop);
        if drop >= 0.0 {
            let front = front * from.inv_p;
            FlowSlopes { flow, by_a: front * by_up, by_b: front * by_down }
        } else {
            let front = front * to.inv_p;
            FlowSlopes { flow, by_a: -front * by_down, by_b: -front * by_up }
        }
    };
    let channel = |k: f64| FlowSlopes {
        flow: k * (a.p - b.p) * (a.p + b.p),
        by_a: 2.0 * k * a.p,
        by_b: -2.0 * k * b.p,
    };
    let limited = |c: FlowSlopes, area: f64| {
        let o = law.flow_bare_slopes(area, a, b);
        let size = o.flow.abs();
        let sum = size + (size * size + 4.0 * c.flow * c.flow).sqrt();
        if sum <= 0.0 {
            // Near equal pressures the channel is the narrow part.
            return c;
        }
        // ṁ/c + (ṁ/o)² = 1, differentiated, with k = ṁ/c and n = ṁ/o.
        let (k, n) = (2.0 * size / sum, 2.0 * c.flow / sum);
        let by_c = k * k / (1.0 + n * n);
        // n carries the sign of the flow, and so does the orifice: |n|³ times its signed slope.
        let by_o = 2.0 * n * n * n.abs() / (1.0 + n * n);
        FlowSlopes {
            flow: k * c.flow,
            by_a: by_c * c.by_a + by_o * o.by_a,
            by_b: by_c * c.by_b + by_o * o.by_b,
        }
    };
    match passage {
        Passage::Closed => FlowSlopes::default(),
        Passage::Orifice { area } => opening(area),
        Passage::Channel { conductance } => channel(conductance),
        Passage::LimitedChannel { conductance, area } => limited(channel(conductance), area),
        Passage::BlendedChannel { conductance, area, unit_flow } => {
            let c = channel(conductance);
            let (share, slope) = turbulent_share(c.flow.abs() / unit_flow);
            limited(FlowSlopes { flow: share * c.flow, by_a: slope * c.by_a, by_b: slope * c.by_b }, area)
        }
        Passage::Tied { area, leak } => {
            let o = opening(area);
            FlowSlopes { flow: o.flow + leak * (a.p - b.p), by_a: o.by_a + leak, by_b: o.by_b - leak }
        }
    }
}

/// Flow \[kg/s\] through two passages, one after the other, with its derivatives by the pressures of both ends, and the derivatives of
/// the pressure between them, to which `between` is set.
///
/// What comes in through the first falls with that pressure, what leaves through the second grows: one root between the pressures
/// of the ends, by Newton's method with halving where that leaves the bracket. The start does not depend on earlier calls.
fn in_series(
    law: &OrificeLaw,
    [first, second]: [Passage; 2],
    a: &Node,
    between: &mut Node,
    b: &Node,
) -> (FlowSlopes, [f64; 2]) {
    const NEWTON: u32 = 25;
    const HALVING: u32 = 60;
    let (pa, pb) = (a.side.p, b.side.p);
    let (mut low, mut high) = (pa.min(pb), pa.max(pb));
    // As if each flow went with the root of its pressure drop.
    let [c1, c2] = [first, second].map(|passage| through(law, passage, a, b));
    let (w1, w2) = (c1 * c1, c2 * c2);
    let share = if w1 + w2 > 0.0 { w2 / (w1 + w2) } else { 0.5 };
    let mut p = (pa + share * (pb - pa)).clamp(low, high);
    let (mut inflow, mut outflow);
    let mut step = 0;
    loop {
        between.set(p, law.discharge());
        inflow = slopes_through(law, first, a, between);
        outflow = slopes_through(law, second, between, b);
        let surplus = inflow.flow - outflow.flow;
        step += 1;
        if surplus == 0.0 || step == NEWTON + HALVING {
            break;
        }
        if surplus > 0.0 {
            low = p;
        } else {
            high = p;
        }
        let next = p - surplus / (inflow.by_b - outflow.by_a);
        let next = if step < NEWTON && next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - p).abs() <= 2.0 * f64::EPSILON * p {
            break;
        }
        p = next;
    }
    // Rounding of the pressure between shows least in the passage whose flow depends on it least.
    let flow = if inflow.by_b.abs() <= outflow.by_a { inflow.flow } else { outflow.flow };
    let stiffness = outflow.by_a - inflow.by_b;
    if stiffness > 0.0 {
        let by = [inflow.by_a / stiffness, -outflow.by_b / stiffness];
        (FlowSlopes { flow, by_a: outflow.by_a * by[0], by_b: inflow.by_b * by[1] }, by)
    } else {
        // Both closed, or choked: nothing follows from the pressure between.
        (FlowSlopes { flow, by_a: inflow.by_a, by_b: 0.0 }, [0.0; 2])
    }
}

#[cfg(test)]
#[allow(clippy::needless_range_loop, clippy::excessive_precision)] // Reference values stand as they were computed.
mod tests {
    use super::*;
    use crate::orifice::{Orifice, OrificeFormula};
    use gudgeon_core::quantity::quantity;

    const R: f64 = 287.0;

    fn law(formula: OrificeFormula, discharge: f64, eps: f64, gamma: f64) -> OrificeLaw {
        Orifice { discharge: quantity(discharge), law: formula, laminar: quantity(eps), ..Orifice::default() }
            .build(gamma, R)
            .expect("builds")
    }

    fn isentropic(eps: f64) -> OrificeLaw {
        law(OrificeFormula::Isentropic, 1.0, eps, 1.4)
    }

    /// One classical Runge-Kutta step.
    fn rk4(y: &mut [f64], t: f64, dt: f64, mut f: impl FnMut(f64, &[f64], &mut [f64])) {
        let n = y.len();
        let (mut k, mut z, mut sum) = (vec![0.0; n], y.to_vec(), vec![0.0; n]);
        for (stage, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            for i in 0..n {
                z[i] = y[i] + stage * dt * k[i];
            }
            f(t + stage * dt, &z, &mut k);
            for i in 0..n {
                sum[i] += weight * k[i];
            }
        }
        for i in 0..n {
            y[i] += dt / 6.0 * sum[i];
        }
    }

    #[test]
    fn channel_and_viscosity() {
        // w h³ (p1² - p2²)/(24 μ R T L) with w 0.3 m, h 10 µm, L 2 mm, μ 20 µPa s, T 450 K, 10 and 2 bar; 25-digit value.
        let conductance = channel_conductance(0.3, 1e-5, 2e-3, 2e-5, R * 450.0);
        let mut net = Network::new(isentropic(0.0), R, &[450.0, 450.0], 0, &[(0, 1)]).expect("builds");
        net.set_pressure("test", 0, 1e6).expect("p");
        net.set_pressure("test", 1, 2e5).expect("p");
        net.set_passage(0, Passage::Channel { conductance });
        net.update_flows();
        assert!((net.flow(0) / 0.002322880371660859465737515 - 1.0).abs() < 1e-14);
        // Handbook values for air, against the 2 % the law claims.
        for (t, mu) in [(200.0, 13.25e-6), (300.0, 18.46e-6), (500.0, 27.01e-6), (700.0, 33.88e-6)] {
            assert!((sutherland_viscosity(t) / mu - 1.0).abs() < 0.02);
        }
        assert_eq!(sutherland_viscosity(273.15), 1.716e-5);
    }

    #[test]
    fn limited_channel_lies_below_both_and_joins_them() {
        let mut net =
            Network::new(isentropic(1e-3), R, &[500.0, 400.0], 0, &[(0, 1), (0, 1), (0, 1)]).expect("builds");
        let bare = isentropic(0.0);
        for height in [1e-7, 1e-6, 1e-5, 1e-4, 1e-3] {
            let (perimeter, length) = (0.37, 5e-3);
            let area = perimeter * height;
            let conductance = channel_conductance(perimeter, height, length, 2.5e-5, R * 450.0);
            net.set_passage(0, Passage::LimitedChannel { conductance, area });
            net.set_passage(1, Passage::Channel { conductance });
            for (p_a, p_b) in [(1e7, 1e5), (2e5, 1e5), (1e5, 9.99e4), (1e5, 1e5), (3e5, 7e6)] {
                net.set_pressure("test", 0, p_a).expect("p");
                net.set_pressure("test", 1, p_b).expect("p");
                net.update_flows();
                let (both, channel) = (net.flow(0), net.flow(1));
                let orifice = bare.flow(area, net.nodes[0].side, net.nodes[1].side);
                assert!(both.abs() <= channel.abs() && both.abs() <= orifice.abs() && both * channel >= 0.0);
                // c/o is the small parameter of one limit, o/c of the other.
                if orifice != 0.0 {
                    let x = channel / orifice;
                    assert!((both / channel - 1.0).abs() <= x * x * 1.0001 + 1e-15);
                    assert!((both / orifice - 1.0).abs() <= 0.5001 / x);
                    // The pressure losses add: both/c + (both/o)² = 1.
                    assert!((both / channel + (both / orifice).powi(2) - 1.0).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn labyrinth_passes_the_same_flow_everywhere() {
        // Pressures of 2, 3 and 5 equal orifices in series between 50 bar and 1 bar, γ = 1.4, with the flow p ψ; 25 digits.
        let cases: [(&[f64], f64); 3] = [
            (&[5e6, 4037291.647775880506623197, 1e5], 2764460.589801368356122553),
            (&[5e6, 4330714.559772494691558063, 3496871.54421417840905119, 1e5], 2394417.945234008797724973),
            (
                &[
                    5e6,
                    4575641.023314173384465554,
                    4101443.292001157998426206,
                    3552436.036150129271888198,
                    2868444.067601394563767816,
                    1e5,
                ],
                1964113.883945444297182067,
            ),
        ];
        let t = 400.0;
        for (p, norm) in cases {
            let n = p.len() - 1;
            let links: Vec<_> = (0..n).map(|i| (i, i + 1)).collect();
            let mut net = Network::new(isentropic(0.0), R, &vec![t; n + 1], 0, &links).expect("builds");
            for (i, &p) in p.iter().enumerate() {
                net.set_pressure("test", i, p).expect("p");
            }
            for l in 0..n {
                net.set_passage(l, Passage::Orifice { area: 1e-7 });
            }
            net.update_flows();
            for l in 0..n {
                let scaled = net.flow(l) / 1e-7 * (R * t).sqrt();
                // The fast form of ψ.
                assert!((scaled / norm - 1.0).abs() < 2e-9, "{l} {scaled}");
            }
        }
    }

    #[test]
    fn choked_vessel_with_the_published_constants() {
        // p = p0 exp(-t/τ), τ = V/(0.259 k A R T sqrt(3.5·2/(R T))) = 0.01573926 s.
        let (volume, t, area, p0) = (5e-7, 450.0, 1.5e-7, 50e5);
        let law = law(OrificeFormula::IsentropicTruncated, 0.86, 0.0, 1.4);
        let mut net = Network::new(law, R, &[t, t], 1, &[(0, 1)]).expect("builds");
        net.set_passage(0, Passage::Orifice { area });
        net.set_pressure("test", 1, 1e5).expect("p");
        let mut f = |m: f64| {
            net.set_mass("test", 0, m, volume).expect("mass");
            net.update_flows();
            let mut d = [0.0];
            net.rates(&mut d);
            d[0]
        };
        let mut m = p0 * volume / (R * t);
        let tau = -m / f(m);
        assert!((tau / 0.01573926 - 1.0).abs() < 4e-7, "{tau}");
        let steps = 15_361; // The published explicit step 1.302e-6 s.
        let dt = 0.02 / f64::from(steps);
        for _ in 0..steps {
            m += dt * f(m);
        }
        let p = m * R * t / volume;
        // (1 - dt/τ)^n against exp: -t dt/(2 τ²) = -5.3e-5.
        assert!((p / 14.0316e5 - 1.0 + 5.3e-5).abs() < 0.5e-5, "{p}");
    }

    #[test]
    fn blow_down_of_an_isothermal_vessel() {
        // 0.2 cm³ at 50 bar and 400 K through C_d A = 0.02 mm² into 1 bar, γ = 1.4; times from quadrature with 25 digits.
        let (volume, t, area, p_back) = (2e-7, 400.0, 2e-8, 1e5);
        let mut net = Network::new(isentropic(0.0), R, &[t, t], 1, &[(0, 1)]).expect("builds");
        net.set_passage(0, Passage::Orifice { area });
        net.set_pressure("test", 1, p_back).expect("p");
        let to_p = R * t / volume;
        let rate = |net: &mut Network, m: f64| {
            net.set_mass("test", 0, m, volume).expect("mass");
            net.update_flows();
            let mut d = [0.0];
            net.rates(&mut d);
            d[0]
        };
        // Steps of 1/40000 of the time; the law is smooth but for a jump of the third derivative at the choking point, which costs
        // dt³ there, 1e-10 of the time scale. ψ itself is right within 2e-9.
        let tolerance = 1e-8;
        let mut y = [5e6 / to_p];
        let dt = 0.1411152215951236159775142 / 40_000.0;
        let expected = [2205520.473109538790333043, 972864.1114610647636692721, 189292.9158737854088107288];
        let mut time = 0.0;
        let mut ratios = vec![
            (0.6, 0.1466225236848892669558042),
            (0.8, 0.1600403753911447764360531),
            (0.9, 0.1670407944979906629207547),
            (0.99, 0.1767768590811943182134717),
            (0.999, 0.1796517250930519803580495),
        ]
        .into_iter()
        .peekable();
        for step in 1..60_000 {
            let before = y[0];
            rk4(&mut y, 0.0, dt, |_, y, d| d[0] = rate(&mut net, y[0]));
            for (k, at) in [10_000, 20_000, 40_000].into_iter().enumerate() {
                if step == at {
                    assert!((y[0] * to_p / expected[k] - 1.0).abs() < tolerance);
                }
            }
            if let Some(&(ratio, at)) = ratios.peek()
                && p_back / (y[0] * to_p) >= ratio
            {
                // Back to the crossing by one integral over the mass, dt = dm/m'.
                let target = p_back / ratio / to_p;
                let dm = target - before;
                let inverse: f64 = [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)]
                    .into_iter()
                    .map(|(x, w)| w / 6.0 / rate(&mut net, before + x * dm))
                    .sum();
                let crossing = time + dm * inverse;
                assert!((crossing / at - 1.0).abs() < tolerance, "{ratio}: {crossing} {at}");
                ratios.next();
            }
            time += dt;
            if ratios.peek().is_none() {
                return;
            }
        }
        panic!("did not reach the last ratio");
    }

    #[test]
    fn isolated_volume_and_two_vessels() {
        // Closed: nothing changes.
        let mut net = Network::new(isentropic(1e-3), R, &[350.0, 600.0], 2, &[(0, 1)]).expect("builds");
        let volumes = [3e-7, 1e-7];
        let mut d = [1.0; 2];
        for i in 0..2 {
            net.set_mass("test", i, 1e-6, volumes[i]).expect("mass");
        }
        net.update_flows();
        net.rates(&mut d);
        assert_eq!(d, [0.0; 2]);
        // Open: the pressures meet monotonically at m R/(V1/T1 + V2/T2).
        net.set_passage(0, Passage::Orifice { area: 1e-7 });
        let mut y = [1e-8, 3e-6];
        let total: f64 = y.iter().sum();
        let end = total * R / (volumes[0] / 350.0 + volumes[1] / 600.0);
        let mut last = f64::INFINITY;
        // The linear branch decays within 1e-5 s; steps a tenth of that.
        for _ in 0..40_000 {
            rk4(&mut y, 0.0, 1e-6, |_, y, d| {
                for i in 0..2 {
                    net.set_mass("test", i, y[i], volumes[i]).expect("mass");
                }
                net.update_flows();
                net.rates(d);
            });
            let difference = net.pressure(1) - net.pressure(0);
            // At the end both pressures are equal within a few roundings.
            assert!(difference >= -1e-14 * end && difference <= last + 1e-14 * end);
            last = difference;
        }
        assert!((y[0] + y[1] - total).abs() <= 40_000.0 * 1.2e-16 * total, "mass");
        for i in 0..2 {
            assert!((net.pressure(i) / end - 1.0).abs() < 1e-11, "{}", net.pressure(i) / end - 1.0);
        }
    }

    /// A five-volume network with a compression and combustion pulse: volumes 0.12, 0.6, 0.1, 0.5 and 0.2 cm³ at 450 K, `γ` = 1.33,
    /// 3000 rpm, areas times discharge coefficient on the links, `ε` = 1e-3.
    #[test]
    fn five_volumes_over_a_cycle() {
        const CH: usize = 5;
        const CC: usize = 6;
        let links = [
            ((CH, 0), 3e-7),
            ((CH, 1), 1.2e-7),
            ((0, 1), 1.5e-7),
            ((1, 2), 3e-7),
            ((1, 3), 1.6e-7),
            ((2, 3), 1e-7),
            ((3, 4), 4e-7),
            ((3, CC), 1e-6),
            ((4, CC), 2e-6),
        ];
        let volumes = [1.2e-7, 6e-7, 1e-7, 5e-7, 2e-7];
        let t = 450.0;
        let ends: Vec<_> = links.iter().map(|l| l.0).collect();
        let law = law(OrificeFormula::Isentropic, 1.0, 1e-3, 1.33);
        let mut net = Network::new(law, R, &[t; 7], 5, &ends).expect("builds");
        for (l, &(_, area)) in links.iter().enumerate() {
            net.set_passage(l, Passage::Orifice { area });
        }
        net.set_pressure("test", CC, 1e5).expect("p");
        let start = [
            100018.5728228574880631641,
            100049.1854464881180319935,
            100046.3416580167831853032,
            100008.2727634799521183595,
            100001.4000864467234350741,
        ];
        // Start, then the two integrals chamber out and crankcase in.
        let mut y: Vec<f64> =
            start.iter().zip(volumes).map(|(p, v)| p * v / (R * t)).chain([0.0; 2]).collect();
        let omega = 3000.0 / 60.0 * 360.0;
        let chamber = |deg: f64| {
            1e5 * (1.0 + 11.0 * (-((deg - 360.0) / 55.0).powi(2)).exp())
                + 68e5 * (-0.5 * ((deg - 370.0) / 18.0).powi(2)).exp()
        };
        // Pressures from implicit integrations with three codes that agree within 6e-9.
        let table: [(usize, [f64; 5]); 14] = [
            (
                30,
                [
                    100000.00000269547,
                    100000.00000680146,
                    100000.00000638631,
                    100000.00000133658,
                    100000.0000002344,
                ],
            ),
            (
                90,
                [
                    100000.00002839003,
                    100000.00001449736,
                    100000.00001082661,
                    100000.00000200637,
                    100000.00000032884,
                ],
            ),
            (
                180,
                [
                    100019.11179929058,
                    100010.22054356645,
                    100007.78697556417,
                    100001.41583712418,
                    100000.2325359551,
                ],
            ),
            (
                270,
                [
                    144665.90257287727,
                    110085.45855362009,
                    108248.09872754513,
                    100374.30293821683,
                    100037.65752634495,
                ],
            ),
            (
                330,
                [
                    833858.0314830174,
                    213646.3416279023,
                    186223.84834795093,
                    102899.79093401221,
                    100166.69093595177,
                ],
            ),
            (
                345,
                [
                    1756171.868262545,
                    338391.62590287905,
                    266676.9812846577,
                    105723.32206064081,
                    100282.67855751743,
                ],
            ),
            (
                360,
                [
                    3800559.4715652512,
                    623935.8094986454,
                    448567.93260020576,
                    114411.24000031223,
                    100610.53310064341,
                ],
            ),
            (
                370,
                [
                    5539579.50839363,
                    911784.8535876133,
                    659021.262862862,
                    127198.1270314181,
                    101070.76598519301,
                ],
            ),
            (
                380,
                [
                    6503286.962930775,
                    1219268.918130748,
                    937951.7169532425,
                    147820.698940349,
                    101792.31519210382,
                ],
            ),
            (
                400,
                [
                    3305672.742793083,
                    1564019.5378006801,
                    1446395.2870262037,
                    205291.18006453535,
                    103779.51479370671,
                ],
            ),
            (
                450,
                [
                    821024.2201570712,
                    1098868.9748361965,
                    1096134.3408979427,
                    235576.14136201103,
                    105228.63418797863,
                ],
            ),
            (
                540,
                [
                    305222.68858906196,
                    447412.0876189741,
                    446381.1183765451,
                    123191.57150133968,
                    100976.74639800352,
                ],
            ),
            (
                630,
                [
                    129073.0149576085,
                    181651.46419352494,
                    181224.35083905078,
                    102970.50550873489,
                    100171.70855174659,
                ],
            ),
            (
                720,
                [
                    100018.57282329368,
                    100049.18544649144,
                    100046.34165776463,
                    100008.27276379244,
                    100001.40008649013,
                ],
            ),
        ];
        // 60 steps a degree leave 1.7e-8 where links choke and unchoke (ψ has no second derivative there), 240 leave 2e-10.
        let per_degree = 240;
        let dt = 1.0 / (omega * f64::from(per_degree));
        let mut rows = table.iter().peekable();
        let mut worst = 0.0f64;
        for degree in 0..720usize {
            for sub in 0..per_degree {
                let time = (degree as f64 + f64::from(sub) / f64::from(per_degree)) / omega;
                rk4(&mut y, time, dt, |time, y, d| {
                    for i in 0..5 {
                        net.set_mass("test", i, y[i], volumes[i]).expect("mass");
                    }
                    net.set_pressure("test", CH, chamber(time * omega)).expect("p");
                    net.update_flows();
                    net.rates(&mut d[..5]);
                    d[5] = net.flow(0) + net.flow(1);
                    d[6] = net.flow(7) + net.flow(8);
                });
            }
            if let Some((at, expected)) = rows.peek()
                && *at == degree + 1
            {
                for i in 0..5 {
                    let p = y[i] * R * t / volumes[i];
                    worst = worst.max((p / expected[i] - 1.0).abs());
                }
                rows.next();
            }
        }
        assert!(rows.next().is_none());
        // The reference codes agree among each other within 6e-9.
        assert!(worst < 6e-9, "{worst:e}");
        let blow_by = y[6];
        assert!((blow_by / 6.2493570768654555e-06 - 1.0).abs() < 6e-9, "{blow_by:e}");
        // What left the chamber is in the volumes or the crankcase: a linear invariant, kept to round-off by the integrator
        // (sums of 172 800 steps, each rounded to 1e-16).
        let stored: f64 =
            y[..5].iter().sum::<f64>() - start.iter().zip(volumes).map(|(p, v)| p * v / (R * t)).sum::<f64>();
        assert!((y[5] - y[6] - stored).abs() < 1e-13 * y[6], "{:e}", y[5] - y[6] - stored);
    }

    #[test]
    fn turbulent_friction_far_above_the_transition() {
        assert!((TRANSITION / (96.0_f64 / 0.3164).powf(4.0 / 3.0) - 1.0).abs() < 1e-15);
        // Far above, the flow has the Reynolds number Re with f = 0.3164 Re^(-1/4) and f Re² = 96 Re_laminar; far below it is laminar.
        // What is left of the other branch is x^∓3/7: 1e-9 each at 2e2.7 times the transition.
        for laminar in [1e9, 1e12] {
            let re = turbulent_share(laminar).0 * laminar;
            assert!((0.3164 * re.powf(1.75) / (96.0 * laminar) - 1.0).abs() < 1e-9);
        }
        assert!((turbulent_share(2.0).0 - 1.0).abs() < 2e-10);
        // 2^(-1/7) at the transition.
        assert!((turbulent_share(TRANSITION).0 - 0.5f64.powf(1.0 / 7.0)).abs() < 1e-15);
        // The share of the slope is the derivative of the flow by the laminar flow.
        for re in [10.0, 1e3, 2e3, 1e4, 1e7] {
            let d = 1e-5 * re;
            let flow = |re: f64| re * turbulent_share(re).0;
            let central = (flow(re + d) - flow(re - d)) / (2.0 * d);
            // Truncation 1e-10, rounding 1e-16/1e-5.
            assert!((central - turbulent_share(re).1).abs() < 1e-9, "{re}");
        }
        // Overflowing Reynolds numbers leave a share that is a number.
        assert!(turbulent_share(f64::INFINITY).0 > 0.0);
    }

    #[test]
    fn blended_channel_lies_below_the_laminar_one() {
        let law = isentropic(0.0);
        let (mut a, mut b) = (Node::at(R * 450.0), Node::at(R * 450.0));
        b.set(1e5, 1.0);
        for p in [1.0001e5, 2e5, 1e6, 1e7] {
            a.set(p, 1.0);
            for height in [1e-6, 1e-5, 1e-4] {
                let (conductance, area) =
                    (channel_conductance(0.3, height, 2e-3, 2e-5, R * 450.0), 0.3 * height);
                let limited = Passage::LimitedChannel { conductance, area };
                let blended = Passage::BlendedChannel { conductance, area, unit_flow: 0.5 * 0.3 * 2e-5 };
                let (l, f) = (through(&law, limited, &a, &b), through(&law, blended, &a, &b));
                assert!(f > 0.0 && f <= l, "{p} {height}");
                assert_eq!(through(&law, blended, &b, &a), -f);
                // Reynolds number of the laminar channel 2 c/(w μ): the two differ by x³/7 while that is small.
                let x = conductance * (p * p - 1e10) / (0.5 * 0.3 * 2e-5) / TRANSITION;
                if x < 0.1 {
                    assert!(1.0 - f / l <= x * x * x / 7.0 + 1e-15);
                }
                let s = slopes_through(&law, blended, &a, &b);
                let d = 1e-4 * (p - 1e5);
                let mut shifted = |delta: f64| {
                    a.set(p + delta, 1.0);
                    through(&law, blended, &a, &b)
                };
                let central = (shifted(d) - shifted(-d)) / (2.0 * d);
                // Truncation 1e-8; the flow function's own derivative is good to 1e-7.
                assert!((central / s.by_a - 1.0).abs() < 3e-7, "{p} {height}: {central} {}", s.by_a);
                assert!((s.flow / f - 1.0).abs() < 1e-14);
                a.set(p, 1.0);
            }
        }
    }

    #[test]
    fn two_passages_in_series() {
        let mut random = 1u64;
        let mut number = |from: f64, to: f64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            from * (to / from).powf((random >> 11) as f64 / (1u64 << 53) as f64)
        };
        for case in 0..2000 {
            let eps = [0.0, 1e-3, 1e-6][case % 3];
            let law = isentropic(eps);
            let ends = |n: &mut Network, p: [f64; 2]| {
                n.set_pressure("test", 0, p[0]).expect("p");
                n.set_pressure("test", 1, p[1]).expect("p");
            };
            let mut net = Network::new(law, R, &[number(300.0, 900.0), number(300.0, 900.0)], 0, &[(0, 1)])
                .expect("builds");
            net.split_link(0, R * 500.0);
            let areas = [number(1e-12, 1e-4), number(1e-12, 1e-4)];
            let passage = |k: usize| match (case / 3 + k) % 3 {
                0 => Passage::Orifice { area: areas[k] },
                1 => Passage::Channel { conductance: 1e-7 * areas[k] },
                _ => Passage::LimitedChannel { conductance: 1e-6 * areas[k], area: areas[k] },
            };
            net.set_passages(0, passage(0), passage(1));
            let p = [number(5e4, 1e7), number(5e4, 1e7)];
            ends(&mut net, p);
            net.update_slopes();
            let (flow, slope, middle, by) =
                (net.flow(0), net.slope(0), net.middle_pressure(0), net.middle_slope(0));
            assert!(middle >= p[0].min(p[1]) && middle <= p[0].max(p[1]));
            assert!(flow == 0.0 || (flow > 0.0) == (p[0] > p[1]), "{case}: {flow} {p:?}");
            // What comes in leaves, but for the rounding of the pressure between: the search ends at
            // 2 ε of it and the drop is rounded, together below 9 ε, times how the flows depend on it. (Below a
            // relative pressure drop of 1e-8 a mouth without laminar branch gives a slope that stands for a much larger one.)
            let [a, b] = [net.nodes[0], net.nodes[1]];
            let between = net.middle[0];
            let law = net.law.clone();
            let [s, t] = [
                slopes_through(&law, passage(0), &a, &between),
                slopes_through(&law, passage(1), &between, &b),
            ];
            let smallest = p.map(|p| (p / middle - 1.0).abs()).into_iter().fold(1.0, f64::min);
            let rounding = 2e-15 * middle * (s.by_b.abs() + t.by_a);
            assert!(
                smallest < 1e-8 || (s.flow - t.flow).abs() <= rounding + 1e-14 * s.flow.abs(),
                "{case}: {:e} {:e} {rounding:e}",
                s.flow,
                t.flow
            );
            // The same at once with the other call, to the last bit.
            net.update_flows();
            assert_eq!((net.flow(0), net.middle_pressure(0)), (flow, middle));
            if smallest < 1e-4 || (p[0] / p[1]).ln().abs() < 1e-2 {
                continue;
            }
            for end in 0..2 {
                let mut at = |d: f64| {
                    let mut q = p;
                    q[end] += d;
                    ends(&mut net, q);
                    net.update_flows();
                    (net.flow(0), net.middle_pressure(0))
                };
                let d = 1e-5 * p[end];
                let (up, down) = (at(d), at(-d));
                let central = [(up.0 - down.0) / (2.0 * d), (up.1 - down.1) / (2.0 * d)];
                // Truncation and the kink where a passage chokes: 1e-5 of the scales flow/p and 1; rounding of the pressure between,
                // 1e-16/1e-5, on what depends on it.
                let scale = flow.abs() / p[end];
                assert!(
                    (central[0] - slope[end]).abs() < 1e-3 * (scale + slope[end].abs()),
                    "{case} {end}: {:e} {:e}",
                    central[0],
                    slope[end]
                );
                assert!(
                    (central[1] - by[end]).abs() < 1e-3 * (1.0 + by[end].abs() + middle / p[end]),
                    "{case} {end}"
                );
            }
        }
        // Closed on one side, on both, and equal pressures.
        let mut net = Network::new(isentropic(1e-3), R, &[400.0; 2], 0, &[(0, 1)]).expect("builds");
        net.split_link(0, R * 400.0);
        net.set_pressure("test", 0, 3e5).expect("p");
        net.set_pressure("test", 1, 1e5).expect("p");
        let open = Passage::Orifice { area: 1e-7 };
        for (first, second, p) in [
            (open, Passage::Closed, Some(3e5)),
            (Passage::Closed, open, Some(1e5)),
            (Passage::Closed, Passage::Closed, None),
        ] {
            net.set_passages(0, first, second);
            net.update_slopes();
            assert_eq!((net.flow(0), net.slope(0)), (0.0, [0.0; 2]));
            // The laminar branch ends within rounding of the open side.
            assert!(p.is_none_or(|p: f64| (net.middle_pressure(0) / p - 1.0).abs() < 1e-15));
        }
        net.set_passages(0, open, open);
        net.set_pressure("test", 1, 3e5).expect("p");
        net.update_flows();
        assert_eq!((net.flow(0), net.middle_pressure(0)), (0.0, 3e5));
    }

    #[test]
    fn says_what_is_wrong() {
        let law = isentropic(1e-3);
        assert!(Network::new(law.clone(), R, &[300.0, 0.0], 1, &[]).is_err());
        assert!(Network::new(law.clone(), R, &[300.0], 1, &[(0, 1)]).is_err());
        let mut net = Network::new(law, R, &[300.0, 300.0], 1, &[(0, 1)]).expect("builds");
        for (m, v) in [(0.0, 1.0), (-1.0, 1.0), (1.0, 0.0), (f64::NAN, 1.0), (f64::MAX, f64::MIN_POSITIVE)] {
            assert!(net.set_mass("test", 0, m, v).expect_err("refused").is_recoverable());
        }
        for p in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(net.set_pressure("test", 1, p).is_err());
        }
    }
}
