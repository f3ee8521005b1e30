//! A network of gas volumes and boundaries joined by passages.

use gudgeon_core::{BuildError, EvalError};

use crate::orifice_law::OrificeLaw;
use crate::passage_law::{GasState, Link, Node, PassageLaw};
use crate::series::in_series;

/// Gas volumes, each at its own constant temperature, and boundaries at given pressures, joined by passages of one
/// [law](PassageLaw).
///
/// Nodes `0..volumes` are volumes, whose pressure follows from their mass, `p = m R T / V`; the others are boundaries. A volume's
/// walls hold its temperature, so the balance of mass is the only one:
///
/// ```text
/// dm_i/dt = Σ flows into i - Σ flows out of i
/// ```
///
/// Volumes may change with time: the mass is the state, hence no term with `dV/dt`. [`set_mass_at`](Self::set_mass_at) takes gas of any temperature,
/// for balances of energy, to which [`enthalpy`](Self::enthalpy) belongs.
///
/// An instant is evaluated in three steps: set the pressures ([`set_mass`](Self::set_mass), [`set_pressure`](Self::set_pressure))
/// and the passages ([`set_passage`](Self::set_passage)), then [`update_flows`](Self::update_flows) or
/// [`update_partials`](Self::update_partials), then read what is wanted. Node and link numbers are those given to
/// [`new`](Self::new); others panic.
///
/// ```
/// use gudgeon_gas::{Network, Orifice, Passage};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A vessel of 1 litre (node 0) that empties into the surroundings (node 1) through 1 mm².
/// let (r, kelvin) = (287.0, 300.0);
/// let law = Orifice::default().build(1.4, r)?;
/// let mut net = Network::new(law, r, &[kelvin, kelvin], 1, &[(0, 1)])?;
/// net.set_mass("vessel", 0, 5e5 * 1e-3 / (r * kelvin), 1e-3)?; // 5 bar
/// net.set_pressure("vessel", 1, 1e5)?;
/// net.set_passage(0, Passage::Orifice { area: 1e-6 });
/// net.update_flows();
/// let mut rates = [0.0];
/// net.rates(&mut rates);
/// assert!((net.pressure(0) - 5e5).abs() < 1e-9 * 5e5);
/// assert!(rates[0] == -net.flow(0) && net.flow(0) > 0.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Network<L: PassageLaw = OrificeLaw> {
    law: L,
    /// One law per node, for gas that comes from it; or none, and `law` is that of all.
    source_laws: Vec<L>,
    nodes: Vec<Node>,
    links: Vec<Link<L::Passage>>,
    /// One per link.
    flow: Vec<f64>,
    /// Partial derivatives of the flows by the pressures of both ends.
    partials: Vec<[f64; 2]>,
    /// Spaces between the two passages of links that have two; as many as links, or none.
    middle: Vec<GasState>,
    /// Partial derivatives of their pressures by the pressures of both ends.
    middle_partials: Vec<[f64; 2]>,
    volumes: usize,
}

/// The flow through a link, and the space between its passages when it has two, as they were.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FlowMemo {
    flow: f64,
    between: Option<GasState>,
}

/// Building.
impl<L: PassageLaw> Network<L> {
    /// A network whose first `volumes` nodes are volumes; `temperatures` \[K\] has one entry per node. Every link starts closed; its
    /// positive direction is from the first to the second node.
    ///
    /// # Errors
    /// A temperature or the gas constant \[J/(kg K)\] that is not positive and finite, a link to a node that does not exist.
    pub fn new(
        law: L,
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
        let node = |t: &f64| Node { gas: GasState::new(0.0, gas_constant * t), factor: 0.0, per_mass: 0.0 };
        let link =
            |&(from, to): &(usize, usize)| Link { from, to, passage: L::Passage::default(), second: None };
        Ok(Self {
            law,
            source_laws: Vec::new(),
            nodes: temperatures.iter().map(node).collect(),
            links: links.iter().map(link).collect(),
            flow: vec![0.0; links.len()],
            partials: vec![[0.0; 2]; links.len()],
            middle: Vec::new(),
            middle_partials: Vec::new(),
            volumes,
        })
    }

    /// Gives every node a law of its own, for the gas that comes from it: one per node, or none, and all have the law of the
    /// network. For laws whose constants depend on the temperature upstream.
    pub fn set_source_laws(&mut self, laws: Vec<L>) {
        self.source_laws = laws;
    }

    /// Makes a link one of two passages in series, both closed, with a space at `rt` = `R T` \[J/kg\] between them that stores nothing.
    pub fn split_link(&mut self, link: usize, rt: f64) {
        if self.middle.is_empty() {
            self.middle =
                self.links.iter().map(|l| GasState::new(0.0, self.nodes[l.from].gas.rt())).collect();
            self.middle_partials = vec![[0.0; 2]; self.links.len()];
        }
        self.middle[link] = GasState::new(0.0, rt);
        self.set_split_passages(link, L::Passage::default(), L::Passage::default());
    }

    /// The law of its passages.
    pub(crate) const fn law(&self) -> &L {
        &self.law
    }

    /// Number of nodes that are volumes.
    #[must_use]
    pub const fn volumes(&self) -> usize {
        self.volumes
    }
}

/// Setting an instant.
impl<L: PassageLaw> Network<L> {
    /// Sets the pressure of a volume \[Pa\] from its mass \[kg\] and size \[m³\]. `model` is named in the error.
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
            let node = &mut self.nodes[node];
            let per_mass = node.gas.rt() / volume;
            let p = mass * per_mass;
            if (f64::MIN_POSITIVE..=f64::MAX).contains(&p) {
                node.per_mass = per_mass;
                node.gas.set_pressure(p);
                node.factor = self.law.node_factor(&node.gas);
                return Ok(());
            }
        }
        Err(refused_volume(model, mass, volume))
    }

    /// The same for gas at another temperature than that given to [`new`](Self::new): `rt` = `R T` \[J/kg\].
    ///
    /// # Errors
    /// Recoverable, when mass, `rt` or size is not positive.
    pub fn set_mass_at(
        &mut self,
        model: &'static str,
        node: usize,
        mass: f64,
        rt: f64,
        volume: f64,
    ) -> Result<(), EvalError> {
        if rt > 0.0 && rt.is_finite() {
            let now = &mut self.nodes[node].gas;
            *now = GasState::new(now.pressure(), rt);
            return self.set_mass(model, node, mass, volume);
        }
        Err(refused_energy(model, mass, rt))
    }

    /// Sets the pressure of a boundary \[Pa\]. `model` is named in the error.
    ///
    /// # Errors
    /// Recoverable, when it is not positive.
    #[inline]
    pub fn set_pressure(&mut self, model: &'static str, node: usize, p: f64) -> Result<(), EvalError> {
        if (f64::MIN_POSITIVE..=f64::MAX).contains(&p) {
            let node = &mut self.nodes[node];
            node.gas.set_pressure(p);
            node.factor = self.law.node_factor(&node.gas);
            Ok(())
        } else {
            Err(refused_pressure(model, p))
        }
    }

    /// Opens or closes a link. One of two passages becomes one of a single passage.
    #[inline]
    pub fn set_passage(&mut self, link: usize, passage: L::Passage) {
        let link = &mut self.links[link];
        (link.passage, link.second) = (passage, None);
    }

    /// Opens or closes both passages of a link made by [`split_link`](Self::split_link); the next update panics where none was.
    #[inline]
    pub fn set_split_passages(&mut self, link: usize, first: L::Passage, second: L::Passage) {
        let link = &mut self.links[link];
        (link.passage, link.second) = (first, Some(second));
    }

    /// A node as it is, for [`restore_node`](Self::restore_node).
    pub(crate) fn node_memo(&self, node: usize) -> Node {
        self.nodes[node]
    }

    /// Puts back a node as it was.
    pub(crate) fn restore_node(&mut self, node: usize, memo: Node) {
        self.nodes[node] = memo;
    }
}

/// Computing flows.
impl<L: PassageLaw> Network<L> {
    /// Computes the flows through all links from the pressures and passages set before.
    pub fn update_flows(&mut self) {
        if !self.source_laws.is_empty() {
            for link in 0..self.links.len() {
                self.flow[link] = self.flow_now(link);
            }
            return;
        }
        self.law.mass_flows(&self.links, &self.nodes, &mut self.flow);
        if !self.middle.is_empty() {
            for link in 0..self.links.len() {
                if self.links[link].is_split() {
                    self.flow[link] = self.flow_now(link);
                }
            }
        }
    }

    /// Computes flows and their partial derivatives by the pressures, see [`partials`](Self::partials) and
    /// [`jacobian`](Self::jacobian).
    pub fn update_partials(&mut self) {
        for (i, ((link, flow), partials)) in
            self.links.iter().zip(&mut self.flow).zip(&mut self.partials).enumerate()
        {
            let (a, b) = (&self.nodes[link.from].gas, &self.nodes[link.to].gas);
            let law = upstream_law(&self.law, &self.source_laws, a, b, [link.from, link.to]);
            let s = match link.second {
                None => law.mass_flow_partials(link.passage, a, b),
                Some(second) => {
                    let (s, between) = in_series(law, [link.passage, second], a, &mut self.middle[i], b);
                    self.middle_partials[i] = between;
                    s
                }
            };
            *flow = s.flow;
            *partials = [s.by_a, s.by_b];
        }
    }

    /// Flow through a link, and the pressure between its passages when it has two.
    fn flow_now(&mut self, link: usize) -> f64 {
        let Link { from, to, passage, second, .. } = self.links[link];
        let (a, b) = (&self.nodes[from].gas, &self.nodes[to].gas);
        let law = upstream_law(&self.law, &self.source_laws, a, b, [from, to]);
        match second {
            None => law.mass_flow(passage, a, b),
            Some(second) => in_series(law, [passage, second], a, &mut self.middle[link], b).0.flow,
        }
    }

    /// Computes the flow through one link alone, and gives what it was before.
    pub(crate) fn update_flow(&mut self, link: usize) -> FlowMemo {
        let between = self.middle.get(link).copied();
        let flow = self.flow_now(link);
        FlowMemo { flow: std::mem::replace(&mut self.flow[link], flow), between }
    }

    /// Puts back a flow that was found before.
    #[inline]
    pub(crate) fn restore_flow(&mut self, link: usize, memo: FlowMemo) {
        self.flow[link] = memo.flow;
        if let (Some(now), Some(before)) = (self.middle.get_mut(link), memo.between) {
            *now = before;
        }
    }
}

/// Reading results.
impl<L: PassageLaw> Network<L> {
    /// `R T` of a node \[J/kg\].
    #[must_use]
    pub fn rt(&self, node: usize) -> f64 {
        self.nodes[node].gas.rt()
    }

    /// Pressure of a node \[Pa\].
    #[inline]
    #[must_use]
    pub fn pressure(&self, node: usize) -> f64 {
        self.nodes[node].gas.pressure()
    }

    /// `∂p/∂m = R T / V` \[Pa/kg\] of a volume, for the size at the last [`set_mass`](Self::set_mass).
    #[inline]
    #[must_use]
    pub fn pressure_per_mass(&self, node: usize) -> f64 {
        self.nodes[node].per_mass
    }

    /// Pressure \[Pa\] between the two passages of a [split](Self::split_link) link, at the last update of its flow.
    #[must_use]
    pub fn middle_pressure(&self, link: usize) -> f64 {
        self.middle[link].pressure()
    }

    /// Its partial derivatives by the pressures of both ends, at the last [`update_partials`](Self::update_partials).
    #[must_use]
    pub fn middle_partials(&self, link: usize) -> [f64; 2] {
        self.middle_partials[link]
    }

    /// Flow \[kg/s\] through a link at the last update.
    #[inline]
    #[must_use]
    pub fn flow(&self, link: usize) -> f64 {
        self.flow[link]
    }

    /// Flows \[kg/s\] through all links at the last update.
    #[inline]
    #[must_use]
    pub fn flows(&self) -> &[f64] {
        &self.flow
    }

    /// Partial derivatives \[kg/(s Pa)\] of the flow through a link by the pressures of its first and of its second node, at the last
    /// [`update_partials`](Self::update_partials).
    #[inline]
    #[must_use]
    pub fn partials(&self, link: usize) -> [f64; 2] {
        self.partials[link]
    }

    /// Adds `factor` times the derivatives of the flow through a link by the masses of all volumes to `row` \[1/s\], one entry per
    /// volume, from the last [`update_partials`](Self::update_partials).
    #[inline]
    pub fn add_flow_gradient(&self, link: usize, factor: f64, row: &mut [f64]) {
        let Link { from, to, .. } = self.links[link];
        for (node, partial) in [from, to].into_iter().zip(self.partials[link]) {
            if node < self.volumes {
                row[node] += factor * partial * self.nodes[node].per_mass;
            }
        }
    }

    /// Rates of change of the masses \[kg/s\] of all volumes, from the last update.
    pub fn rates(&self, d_mass: &mut [f64]) {
        d_mass.fill(0.0);
        let d_mass = &mut d_mass[..self.volumes];
        for (link, &flow) in self.links.iter().zip(&self.flow) {
            if let Some(rate) = d_mass.get_mut(link.from) {
                *rate -= flow;
            }
            if let Some(rate) = d_mass.get_mut(link.to) {
                *rate += flow;
            }
        }
    }

    /// Enthalpy \[W\] that gas brings into every volume, less what it takes, from the last update: `ṁ c_p T` with the temperature of the node
    /// where it comes from and `cp_over_r` = `c_p/R`; and what all volumes together get from the boundaries.
    pub fn enthalpy(&self, cp_over_r: f64, power: &mut [f64]) -> f64 {
        power.fill(0.0);
        let power = &mut power[..self.volumes];
        let mut through = 0.0;
        for (link, &flow) in self.links.iter().zip(&self.flow) {
            let up = if flow >= 0.0 { link.from } else { link.to };
            let h = flow * (cp_over_r * self.nodes[up].gas.rt());
            match power.get_mut(link.from) {
                Some(p) => *p -= h,
                None => through += h,
            }
            match power.get_mut(link.to) {
                Some(p) => *p += h,
                None => through -= h,
            }
        }
        through
    }

    /// Jacobian of the [`rates`](Self::rates): their derivatives \[1/s\] by the masses, row-major, one row per volume, from the last
    /// [`update_partials`](Self::update_partials). The columns of a closed network add up to zero within rounding.
    pub fn jacobian(&self, jac: &mut [f64]) {
        let n = self.volumes;
        jac[..n * n].fill(0.0);
        for (&Link { from, to, .. }, partials) in self.links.iter().zip(&self.partials) {
            for (node, partial) in [from, to].into_iter().zip(partials) {
                if node < n {
                    let rate = partial * self.nodes[node].per_mass;
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
}

#[cold]
fn refused_volume(model: &'static str, mass: f64, volume: f64) -> EvalError {
    EvalError::recoverable(model, format!("a gas volume of {volume:e} m3 holds a mass of {mass:e} kg"))
}

#[cold]
fn refused_energy(model: &'static str, mass: f64, rt: f64) -> EvalError {
    EvalError::recoverable(model, format!("a gas volume with a mass of {mass:e} kg has R T = {rt:e} J/kg"))
}

#[cold]
fn refused_pressure(model: &'static str, p: f64) -> EvalError {
    EvalError::recoverable(model, format!("a boundary has the absolute pressure {p:e} Pa"))
}

/// The law for the gas that goes from `a` to `b`, or back: that of the node it comes from.
#[inline]
fn upstream_law<'a, L>(
    common: &'a L,
    source_laws: &'a [L],
    a: &GasState,
    b: &GasState,
    nodes: [usize; 2],
) -> &'a L {
    let up = if a.pressure() >= b.pressure() { nodes[0] } else { nodes[1] };
    source_laws.get(up).unwrap_or(common)
}
