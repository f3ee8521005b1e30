//! The law of a passage: the interface that a new gas law implements.

use std::fmt::Debug;

/// State of the gas at one end of a passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GasState {
    p: f64,
    rt: f64,
    inv_sqrt_rt: f64,
    inv_p: f64,
}

impl GasState {
    /// Gas of the absolute pressure `p` \[Pa\] with the product `rt` \[J/kg\] of gas constant and temperature.
    ///
    /// Valid for `p >= 0` and `rt > 0`, both finite; nothing is checked. [`Network`](crate::Network) refuses other values.
    #[must_use]
    pub fn new(p: f64, rt: f64) -> Self {
        Self { p, rt, inv_sqrt_rt: rt.sqrt().recip(), inv_p: if p > 0.0 { 1.0 / p } else { 0.0 } }
    }

    /// The same gas at another absolute pressure `p` \[Pa\].
    #[must_use]
    pub fn with_pressure(self, p: f64) -> Self {
        Self { p, inv_p: if p > 0.0 { 1.0 / p } else { 0.0 }, ..self }
    }

    /// Sets a pressure \[Pa\] above zero.
    #[inline]
    pub(crate) fn set_pressure(&mut self, p: f64) {
        self.p = p;
        self.inv_p = 1.0 / p;
    }

    /// Absolute pressure `p` \[Pa\].
    #[inline]
    #[must_use]
    pub const fn pressure(&self) -> f64 {
        self.p
    }

    /// `R T` \[J/kg\].
    #[inline]
    #[must_use]
    pub const fn rt(&self) -> f64 {
        self.rt
    }

    /// `1 / sqrt(R T)` \[s/m\], computed once for all passages of a volume.
    #[inline]
    #[must_use]
    pub const fn inv_sqrt_rt(&self) -> f64 {
        self.inv_sqrt_rt
    }

    /// `1 / p` \[1/Pa\], computed once for all passages of a volume; 0 where the pressure is 0.
    #[inline]
    #[must_use]
    pub const fn inv_pressure(&self) -> f64 {
        self.inv_p
    }

    /// Density `p / (R T)` \[kg/m³\].
    #[inline]
    #[must_use]
    pub fn density(&self) -> f64 {
        self.p / self.rt
    }
}

/// A mass flow and its partial derivatives by the pressures at both ends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlowPartials {
    /// Mass flow \[kg/s\] from `a` to `b`.
    pub flow: f64,
    /// Its partial derivative by the pressure of `a` \[kg/(s Pa)\].
    pub by_a: f64,
    /// Its partial derivative by the pressure of `b` \[kg/(s Pa)\].
    pub by_b: f64,
}

/// A passage that is described by its flow area \[m²\] alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Area(pub f64);

/// A passage between two nodes of a network.
#[derive(Debug, Clone, Copy)]
pub struct Link<P> {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) passage: P,
    /// A second passage behind the first, with a space between them that stores nothing.
    pub(crate) second: Option<P>,
}

impl<P: Copy> Link<P> {
    /// The node where the link starts. Flow towards [`to`](Self::to) is positive.
    #[inline]
    #[must_use]
    pub const fn from(&self) -> usize {
        self.from
    }

    /// The node where the link ends.
    #[inline]
    #[must_use]
    pub const fn to(&self) -> usize {
        self.to
    }

    /// The passage; the first one of two in series.
    #[inline]
    #[must_use]
    pub const fn passage(&self) -> P {
        self.passage
    }

    /// Whether the link is two passages in series. The network computes its flow from that of the single ones.
    #[inline]
    #[must_use]
    pub const fn is_split(&self) -> bool {
        self.second.is_some()
    }
}

/// A node of a network, as [`PassageLaw::mass_flows`] sees it.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    pub(crate) gas: GasState,
    pub(crate) factor: f64,
    /// `∂p/∂m = R T / V` of a volume \[Pa/kg\]; 0 for a boundary.
    pub(crate) per_mass: f64,
}

impl Node {
    /// State of the gas.
    #[inline]
    #[must_use]
    pub const fn gas(&self) -> &GasState {
        &self.gas
    }

    /// [`PassageLaw::node_factor`] of the state, computed once for all passages of the node.
    #[inline]
    #[must_use]
    pub const fn factor(&self) -> f64 {
        self.factor
    }
}

/// Law of the mass flow through one passage.
///
/// This is what a new gas law implements. A [`Network`](crate::Network) turns it into mass balances of any number of volumes, a
/// [`PackNetwork`](crate::PackNetwork) into a [`GasFlow`](gudgeon_core::kinds::GasFlow) model of a ring pack.
///
/// Notation: the passage leads from `a` to `b`; the flow `ṁ` is positive in that direction. A law must
///
/// - be finite, with finite derivatives, for all finite positive pressures;
/// - be zero for equal pressures, and for the passage `Self::Passage::default()`, which is closed;
/// - have `∂ṁ/∂p_a >= 0` and `∂ṁ/∂p_b <= 0` (two passages in series have one flow then, which the network searches);
/// - give the same number for the same arguments, and allocate nothing.
///
/// Where the derivative of a law is infinite or has a jump, the law gives a finite one-sided value in its place.
pub trait PassageLaw: Send {
    /// What describes a passage at an instant, for example its [`Area`]. The default is a closed passage.
    type Passage: Copy + Debug + Default + Send;

    /// Mass flow through a passage with its partial derivatives.
    fn mass_flow_partials(&self, passage: Self::Passage, a: &GasState, b: &GasState) -> FlowPartials;

    /// Mass flow \[kg/s\] through a passage from `a` to `b`: that of [`mass_flow_partials`](Self::mass_flow_partials) within
    /// rounding. Worth its own code where the flow costs much less than its derivatives.
    #[inline]
    fn mass_flow(&self, passage: Self::Passage, a: &GasState, b: &GasState) -> f64 {
        self.mass_flow_partials(passage, a, b).flow
    }

    /// Discharge coefficient that its flows through an opening have into a vacuum; a drain with a coefficient of its own is an opening of another
    /// size.
    fn discharge(&self) -> f64 {
        1.0
    }

    /// A number that [`mass_flows`](Self::mass_flows) wants of a node whatever the passage: [`Node::factor`].
    #[inline]
    fn node_factor(&self, _gas: &GasState) -> f64 {
        0.0
    }

    /// Mass flows \[kg/s\] through all links of a network that are not [split](Link::is_split), into `flow`.
    ///
    /// The provided method calls [`mass_flow`](Self::mass_flow) for each link. A law for which several links are cheaper together
    /// has its own; the results must be the same to the last bit.
    #[inline]
    fn mass_flows(&self, links: &[Link<Self::Passage>], nodes: &[Node], flow: &mut [f64]) {
        for (link, flow) in links.iter().zip(flow) {
            if !link.is_split() {
                *flow = self.mass_flow(link.passage, &nodes[link.from].gas, &nodes[link.to].gas);
            }
        }
    }
}
