//! The passages of the built-in models: orifices, narrow channels, and their combinations.

use crate::channel::{flow_share, turbulent_share};
use crate::orifice_law::OrificeLaw;
use crate::passage_law::{Area, FlowPartials, GasState, Link, Node, PassageLaw};
use gudgeon_core::elementary;

/// What lets gas through between two nodes, for the orifice law: the [`PassageLaw`] of the built-in models.
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
        /// Conductance \[kg/(s Pa²)\], see [`channel_conductance`](crate::channel_conductance).
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
    /// [`TRANSITION`](crate::TRANSITION), `Re_c`, that is the flow with Blasius' friction factor `0.3164 Re^(-1/4)`, far below the laminar one; at it, 9 %
    /// below both. Smooth throughout.
    BlendedChannel {
        /// Conductance \[kg/(s Pa²)\] of the laminar flow.
        conductance: f64,
        /// Cross section \[m²\].
        area: f64,
        /// `perimeter μ/2` \[kg/s\]: the flow whose Reynolds number is one.
        unit_flow: f64,
    },
    /// An orifice or a channel, whichever lets less through, with a smooth change between the two: with the flows `c` of the channel alone and `o`
    /// of the orifice alone (without its laminar branch),
    ///
    /// ```text
    /// ṁ = [ |c|^-n + |o|^-n ]^(-1/n)        ∂ṁ/∂c = (ṁ/c)^(n+1)        ∂ṁ/∂o = (ṁ/o)^(n+1)
    /// ```
    ///
    /// Both laws give the same at small pressure differences where the loss by friction, `96/Re L/(2H)` times the dynamic pressure, is that of
    /// the mouth, `1/C_d²` times: `Re = 48 C_d² L/H`, formed with twice the height `H` of a channel of the length `L`. Below that the channel
    /// governs, above it the orifice. Friction turns turbulent as in [`BlendedChannel`](Self::BlendedChannel).
    AutomaticChannel {
        /// Conductance \[kg/(s Pa²)\] of the laminar flow.
        conductance: f64,
        /// Cross section \[m²\].
        area: f64,
        /// `perimeter μ/2` \[kg/s\]: the flow whose Reynolds number is one; infinite: friction is laminar whatever the flow.
        unit_flow: f64,
        /// `n`, at least 1.
        sharpness: f64,
    },
    /// An opening and, beside it, a linear leak `ṁ = leak (p_a - p_b)` that makes the pressures of two volumes equal.
    Tied {
        /// Geometric area \[m²\].
        area: f64,
        /// Conductance of the leak \[kg/(s Pa)\].
        leak: f64,
    },
}

impl From<Area> for Passage {
    fn from(Area(area): Area) -> Self {
        Self::Orifice { area }
    }
}

impl PassageLaw for OrificeLaw {
    type Passage = Passage;

    fn discharge(&self) -> f64 {
        self.discharge_coefficient()
    }

    #[inline]
    fn mass_flow(&self, passage: Passage, a: &GasState, b: &GasState) -> f64 {
        match passage {
            Passage::Closed => 0.0,
            Passage::Orifice { area } => opening(self, area, a, b),
            Passage::Channel { conductance } => channel(conductance, a, b),
            Passage::LimitedChannel { conductance, area } => {
                limited(self, channel(conductance, a, b), area, a, b)
            }
            Passage::BlendedChannel { conductance, area, unit_flow } => {
                limited(self, turbulent(channel(conductance, a, b), unit_flow), area, a, b)
            }
            Passage::AutomaticChannel { conductance, area, unit_flow, sharpness } => {
                let c = turbulent(channel(conductance, a, b), unit_flow);
                lesser(c, self.flow_bare(area, a, b), sharpness)
            }
            Passage::Tied { area, leak } => opening(self, area, a, b) + leak * (a.pressure() - b.pressure()),
        }
    }

    fn mass_flow_partials(&self, passage: Passage, a: &GasState, b: &GasState) -> FlowPartials {
        match passage {
            Passage::Closed => FlowPartials::default(),
            Passage::Orifice { area } => opening_partials(self, area, a, b),
            Passage::Channel { conductance } => channel_partials(conductance, a, b),
            Passage::LimitedChannel { conductance, area } => {
                limited_partials(self, channel_partials(conductance, a, b), area, a, b)
            }
            Passage::BlendedChannel { conductance, area, unit_flow } => {
                let c = turbulent_partials(channel_partials(conductance, a, b), unit_flow);
                limited_partials(self, c, area, a, b)
            }
            Passage::AutomaticChannel { conductance, area, unit_flow, sharpness } => {
                let c = turbulent_partials(channel_partials(conductance, a, b), unit_flow);
                lesser_partials(c, self.flow_bare_partials(area, a, b), sharpness)
            }
            Passage::Tied { area, leak } => {
                let o = opening_partials(self, area, a, b);
                let flow = o.flow + leak * (a.pressure() - b.pressure());
                FlowPartials { flow, by_a: o.by_a + leak, by_b: o.by_b - leak }
            }
        }
    }

    #[inline]
    fn node_factor(&self, gas: &GasState) -> f64 {
        self.strength(gas)
    }

    /// Where most of several links are orifices these are computed at once, as if all were such; then what else there is.
    #[inline]
    fn mass_flows(&self, links: &[Link<Passage>], nodes: &[Node], flow: &mut [f64]) {
        let (fours, rest) = links.as_chunks::<LANES>();
        let (flows, of_rest) = flow.as_chunks_mut::<LANES>();
        for (links, flow) in fours.iter().zip(flows) {
            let orifices = links.iter().filter(|l| matches!(l.passage, Passage::Orifice { .. })).count();
            let at_once = orifices >= WORTH && !self.is_truncated();
            if at_once {
                self.openings(links, nodes, flow);
            }
            for (link, flow) in links.iter().zip(flow) {
                let done = at_once && matches!(link.passage, Passage::Orifice { .. } | Passage::Closed);
                if !done && !link.is_split() {
                    *flow = self.mass_flow(link.passage, &nodes[link.from].gas, &nodes[link.to].gas);
                }
            }
        }
        for (link, flow) in rest.iter().zip(of_rest) {
            if !link.is_split() {
                *flow = self.mass_flow(link.passage, &nodes[link.from].gas, &nodes[link.to].gas);
            }
        }
    }
}

/// Links whose flows are computed at once, and the number of orifices among them from which that costs less.
const LANES: usize = 4;
const WORTH: usize = 2;

impl OrificeLaw {
    /// Flows through links as if all were orifices or closed.
    #[inline]
    fn openings<const N: usize>(&self, links: &[Link<Passage>; N], nodes: &[Node], flow: &mut [f64; N]) {
        let (mut fronts, mut drops) = ([0.0; N], [0.0; N]);
        for ((link, front), drop) in links.iter().zip(&mut fronts).zip(&mut drops) {
            let area = if let Passage::Orifice { area } = link.passage { area } else { 0.0 };
            let (a, b) = (&nodes[link.from], &nodes[link.to]);
            let difference = a.gas.pressure() - b.gas.pressure();
            let up = if difference >= 0.0 { a } else { b };
            (*front, *drop) = (area * up.factor, difference * up.gas.inv_pressure());
        }
        let psi = self.psi_lanes(drops);
        *flow = std::array::from_fn(|i| (fronts[i] * psi[i]).copysign(drops[i]));
    }
}

/// What stands before `ψ` \[kg/s\], and the relative pressure drop of an orifice, positive from `a` to `b`.
#[inline]
fn front_and_drop(law: &OrificeLaw, area: f64, a: &GasState, b: &GasState) -> (f64, f64) {
    let drop = a.pressure() - b.pressure();
    let up = if drop >= 0.0 { a } else { b };
    (area * law.strength(up), drop * up.inv_pressure())
}

/// Flow \[kg/s\] through an orifice.
#[inline]
fn opening(law: &OrificeLaw, area: f64, a: &GasState, b: &GasState) -> f64 {
    if law.is_truncated() {
        return law.flow(area, a, b);
    }
    let (front, drop) = front_and_drop(law, area, a, b);
    let [psi] = law.psi_lanes([drop]);
    (front * psi).copysign(drop)
}

/// The same with its partial derivatives.
fn opening_partials(law: &OrificeLaw, area: f64, a: &GasState, b: &GasState) -> FlowPartials {
    if law.is_truncated() {
        return law.flow_partials(area, a, b);
    }
    let (front, drop) = front_and_drop(law, area, a, b);
    let (psi, by_up, by_down) = law.psi_partials(drop.abs());
    let flow = (front * psi).copysign(drop);
    if drop >= 0.0 {
        let front = front * a.inv_pressure();
        FlowPartials { flow, by_a: front * by_up, by_b: front * by_down }
    } else {
        let front = front * b.inv_pressure();
        FlowPartials { flow, by_a: -front * by_down, by_b: -front * by_up }
    }
}

/// Laminar flow \[kg/s\] through a channel.
#[inline]
fn channel(conductance: f64, a: &GasState, b: &GasState) -> f64 {
    conductance * (a.pressure() - b.pressure()) * (a.pressure() + b.pressure())
}

/// The same with its partial derivatives.
fn channel_partials(k: f64, a: &GasState, b: &GasState) -> FlowPartials {
    FlowPartials { flow: channel(k, a, b), by_a: 2.0 * k * a.pressure(), by_b: -2.0 * k * b.pressure() }
}

/// What turbulence leaves of the laminar flow `c` \[kg/s\] of a channel.
#[inline]
fn turbulent(c: f64, unit_flow: f64) -> f64 {
    c * flow_share(c.abs() / unit_flow)
}

/// The same with its partial derivatives.
fn turbulent_partials(c: FlowPartials, unit_flow: f64) -> FlowPartials {
    let (share, slope) = turbulent_share(c.flow.abs() / unit_flow);
    FlowPartials { flow: share * c.flow, by_a: slope * c.by_a, by_b: slope * c.by_b }
}

/// `[ |c|^-n + |o|^-n ]^(-1/n)` with the sign of both: the lesser of the two, rounded where they are near each other.
#[inline]
fn lesser(c: f64, o: f64, n: f64) -> f64 {
    let (low, high) = if c.abs() <= o.abs() { (c, o) } else { (o, c) };
    if low == 0.0 { 0.0 } else { low * elementary::powf(1.0 + elementary::powf(low / high, n), -1.0 / n) }
}

/// The same with its partial derivatives.
fn lesser_partials(c: FlowPartials, o: FlowPartials, n: f64) -> FlowPartials {
    let flow = lesser(c.flow, o.flow, n);
    if flow == 0.0 {
        // Near equal pressures the channel is the narrow part.
        return c;
    }
    let (by_c, by_o) = (elementary::powf(flow / c.flow, n + 1.0), elementary::powf(flow / o.flow, n + 1.0));
    FlowPartials { flow, by_a: by_c * c.by_a + by_o * o.by_a, by_b: by_c * c.by_b + by_o * o.by_b }
}

/// Flow \[kg/s\] through a channel that alone would pass `c`, behind a mouth: loss by friction, in proportion to the flow, and at the
/// mouth, to its square.
#[inline]
fn limited(law: &OrificeLaw, c: f64, area: f64, a: &GasState, b: &GasState) -> f64 {
    let o = law.flow_bare(area, a, b).abs();
    let sum = o + (o * o + 4.0 * c * c).sqrt();
    if sum > 0.0 { 2.0 * c * (o / sum) } else { 0.0 }
}

/// The same with its partial derivatives.
fn limited_partials(
    law: &OrificeLaw,
    c: FlowPartials,
    area: f64,
    a: &GasState,
    b: &GasState,
) -> FlowPartials {
    let o = law.flow_bare_partials(area, a, b);
    let size = o.flow.abs();
    let sum = size + (size * size + 4.0 * c.flow * c.flow).sqrt();
    if sum <= 0.0 {
        // Near equal pressures the channel is the narrow part.
        return c;
    }
    // ṁ/c + (ṁ/o)² = 1, differentiated, with k = ṁ/c and n = ṁ/o.
    let (k, n) = (2.0 * size / sum, 2.0 * c.flow / sum);
    let by_c = k * k / (1.0 + n * n);
    // n carries the sign of the flow, and so does the orifice: |n|³ times its signed derivative.
    let by_o = 2.0 * n * n * n.abs() / (1.0 + n * n);
    FlowPartials {
        flow: k * c.flow,
        by_a: by_c * c.by_a + by_o * o.by_a,
        by_b: by_c * c.by_b + by_o * o.by_b,
    }
}
