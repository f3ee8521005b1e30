//! The network of lands and spaces behind rings: any law of a passage and any passages around the rings as one gas-flow model.

use gudgeon_core::geometry::{BackVolume, Drain, PackGeometry, RingPlace, Vent};
use gudgeon_core::kinds::{GasIn, GasPassage, GasSpace, GasWay, gas_energy, gas_mass};
use gudgeon_core::states::StateInfo;
use gudgeon_core::{BuildError, EvalError};

use crate::gas_temperature::{LandEnergy, wide_enough};
use crate::network::Network;
use crate::orifice::Orifice;
use crate::orifice_law::OrificeLaw;
use crate::passage_law::{GasState, PassageLaw};
use crate::ring_passages::PassageModel;
use crate::spaces::Spaces;
use crate::validate::validate;

/// What a [`PackNetwork`] takes as constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PackOptions {
    /// Film thickness \[m\] for gap area, clearance and volume behind the rings; `None` for that of the instant.
    pub nominal_film: Option<f64>,
    /// Lift, as a fraction of the axial clearance, over which the leak of a groove-edge chamfer fades away linearly; 0 closes it at
    /// the moment of lift-off.
    pub chamfer_fade: f64,
    /// Filling time \[s\] below which a space behind a ring stores nothing; `None`: all of them do.
    pub eliminate_below: Option<f64>,
    /// Nusselt number of the heat between gas and walls where the temperature of the gas follows from a balance of energy; `None`: it is that of
    /// the walls.
    pub nusselt: Option<f64>,
}

impl Default for PackOptions {
    fn default() -> Self {
        Self { nominal_film: None, chamfer_fade: 0.01, eliminate_below: None, nusselt: None }
    }
}

/// The links of one ring.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RingLinks {
    pub upper: Option<usize>,
    pub lower: Option<usize>,
    pub gap: usize,
    pub face: Option<usize>,
    /// Whether the upper link goes on past the lower flank, through a space behind the ring that stores nothing.
    pub through: bool,
    /// Node of the space behind the ring, where that has a state.
    pub back: Option<usize>,
    /// From there to the crankcase.
    pub drain: Option<usize>,
    /// The pressure behind the ring is the mean of these two nodes': that of the space behind it twice, or both lands when it has no room.
    pub behind: [usize; 2],
}

impl RingLinks {
    /// Past the first flank that the gas comes to on its way down, and past the last.
    pub fn flanks(&self) -> [Option<usize>; 2] {
        [self.upper.or(self.lower), self.lower.or(self.upper)]
    }
}

/// A gas-flow model of a ring pack from two halves: the [law](PassageLaw) of a passage, and the [passages](PassageModel) around a ring.
///
/// The lands between the rings and the spaces behind rings with room are the volumes of a [`Network`]; cylinder and crankcase are its
/// boundaries. Where the rings are, their end gaps and the sizes of the volumes come from the geometry of the pack. The result is a
/// [`GasFlow`](gudgeon_core::kinds::GasFlow): states, rates, and their Jacobian from the partial derivatives of the law. The models
/// [`OrificeNetwork`](crate::OrificeNetwork), [`NarrowChannel`](crate::NarrowChannel) and [`GapOrifice`](crate::GapOrifice) are built
/// with it.
///
/// A new gas law on a pack of two rings:
///
/// ```
/// use gudgeon_core::kinds::{GasFlow, GasIn, GasOut};
/// use gudgeon_gas::{Area, FlowPartials, GasState, OrificeAreas, PackNetwork, PackOptions, PassageLaw, plain_pack};
///
/// /// Darcy flow through passages that are full of deposits: `ṁ = k A (p_a² - p_b²) / (R T_a + R T_b)`, `k` in s.
/// struct Darcy { k: f64 }
///
/// impl PassageLaw for Darcy {
///     type Passage = Area;
///     fn mass_flow_partials(&self, Area(area): Area, a: &GasState, b: &GasState) -> FlowPartials {
///         let c = self.k * area / (a.rt() + b.rt());
///         let (p, q) = (a.pressure(), b.pressure());
///         FlowPartials { flow: c * (p * p - q * q), by_a: 2.0 * c * p, by_b: -2.0 * c * q }
///     }
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let (pack, places) = plain_pack(2);
/// let mut gas = PackNetwork::new("darcy", OrificeAreas::default(), Darcy { k: 1e-4 }, &pack, PackOptions::default())?;
/// let inputs = GasIn { p_cylinder: 20e5, p_crankcase: 1e5, rings: &places };
/// let (mut masses, mut rates) = (vec![0.0; gas.n_masses()], vec![0.0; gas.n_masses()]);
/// let mut out = GasOut::new(2);
/// gas.at_pressures(&inputs, &[20e5, 5e5, 1e5], &mut masses);
/// gas.rates(&inputs, &masses, &mut rates, &mut out)?;
/// // What flows in and not out is stored.
/// let stored: f64 = rates.iter().sum();
/// assert!((stored - (out.flow_in[0] - out.flow_out[1])).abs() < 1e-14 * out.flow_in[0]);
/// # Ok(())
/// # }
/// ```
///
/// A specification that implements [`GasFlowSpec`](gudgeon_core::kinds::GasFlowSpec), boxes this in its `build` and is registered
/// makes the law a model that a case file can name.
#[derive(Debug, Clone)]
pub struct PackNetwork<M, L: PassageLaw = OrificeLaw> {
    /// Name of the model, for errors.
    pub(crate) name: &'static str,
    pub(crate) model: M,
    pub(crate) spaces: Spaces,
    pub(crate) net: Network<L>,
    pub(crate) links: Vec<RingLinks>,
    /// Nodes of the lands: those that are open to the crankcase have its node.
    pub(crate) lands: Vec<usize>,
    /// Links to the crankcase (1) and from it (-1) beside those of the last ring.
    pub(crate) drained: Vec<(usize, f64)>,
    /// What the links are, in the order of the links.
    pub(crate) passages: Vec<GasPassage>,
    /// Of all nodes \[K\].
    temperatures: Vec<f64>,
    /// Of all volumes: masses, then energies where there is a balance of them.
    pub(crate) states: Vec<StateInfo>,
    pub(crate) energy: Option<LandEnergy>,
}

/// Nodes and links of a pack.
struct Layout {
    /// Names of the volumes.
    names: Vec<String>,
    temperatures: Vec<f64>,
    volumes: usize,
    lands: Vec<usize>,
    ends: Vec<(usize, usize)>,
    passages: Vec<GasPassage>,
    /// What each node is.
    spaces: Vec<GasSpace>,
    links: Vec<RingLinks>,
    /// Links from spaces to the crankcase.
    drains: Vec<(usize, Drain)>,
}

impl Layout {
    /// Volumes from the top: behind ring 1, land 2, behind ring 2, ...; then chamber and crankcase. `fast` says which spaces behind
    /// rings store nothing.
    fn new<P, M: PassageModel<P>>(pack: &PackGeometry, fast: &[bool]) -> Self {
        let n = pack.rings.len();
        let mut temperatures = Vec::with_capacity(2 * n + 1);
        let mut spaces = Vec::with_capacity(2 * n + 1);
        let mut backs = vec![None; n];
        let mut lands = vec![0; n + 1];
        let mut names = Vec::with_capacity(2 * n);
        for (i, ring) in pack.rings.iter().enumerate() {
            if i > 0 && pack.lands[i].vent != Vent::Open {
                lands[i] = temperatures.len();
                temperatures.push(pack.lands[i].temperature);
                names.push(format!("land{}", i + 1));
                spaces.push(GasSpace::Land(i));
            }
            if ring.has_room() && !fast[i] {
                backs[i] = Some(temperatures.len());
                temperatures.push(ring.back_temperature);
                names.push(format!("ring{}.back", i + 1));
                spaces.push(GasSpace::Behind(i));
            }
        }
        let volumes = temperatures.len();
        for i in [0, n] {
            lands[i] = temperatures.len();
            temperatures.push(pack.lands[i].temperature);
            spaces.push(GasSpace::Land(i));
        }
        for (land, node) in pack.lands.iter().zip(&mut lands).take(n).skip(1) {
            if land.vent == Vent::Open {
                *node = volumes + 1;
            }
        }
        let mut all = Self {
            names,
            temperatures,
            volumes,
            lands,
            ends: Vec::new(),
            passages: Vec::new(),
            spaces,
            links: Vec::new(),
            drains: Vec::new(),
        };
        for i in 0..n {
            all.add_ring::<P, M>(pack, i, backs[i], fast[i]);
        }
        all.add_drains(pack);
        all
    }

    fn link(&mut self, ring: usize, way: GasWay, a: usize, b: usize) -> usize {
        self.ends.push((a, b));
        self.passages.push(GasPassage { ring, way, from: self.spaces[a], to: self.spaces[b] });
        self.ends.len() - 1
    }

    /// Node of the crankcase.
    const fn crankcase(&self) -> usize {
        self.volumes + 1
    }

    /// The links of ring `i`, whose space behind has the node `back` if it has a state.
    fn add_ring<P, M: PassageModel<P>>(
        &mut self,
        pack: &PackGeometry,
        i: usize,
        back: Option<usize>,
        through: bool,
    ) {
        let ring = &pack.rings[i];
        let (above, below) = (self.lands[i], self.lands[i + 1]);
        let space = match ring.back {
            BackVolume::Sealed => None,
            BackVolume::OpenBelow => Some(below),
            BackVolume::OpenAbove => Some(above),
            _ if through => None,
            _ => Some(back.unwrap_or(self.crankcase())),
        };
        let upper = match (space, ring.back) {
            (Some(space), b) => {
                (b != BackVolume::OpenAbove).then(|| self.link(i, GasWay::UpperFlank, above, space))
            }
            (None, _) => through.then(|| self.link(i, GasWay::Groove, above, below)),
        };
        let lower = space.filter(|s| *s != below).map(|space| self.link(i, GasWay::LowerFlank, space, below));
        let direct = if M::GAP_HOLDS_FACE { GasWay::GapAndFace } else { GasWay::Gap };
        let gap = self.link(i, direct, above, below);
        let face = M::HAS_FACE.then(|| self.link(i, GasWay::Face, above, below));
        let behind = space.map_or([above, below], |node| [node; 2]);
        self.links.push(RingLinks { upper, lower, gap, face, through, back, drain: None, behind });
    }

    /// Drains of the spaces between and behind the rings.
    fn add_drains(&mut self, pack: &PackGeometry) {
        let crankcase = self.crankcase();
        for (i, ring) in pack.rings.iter().enumerate() {
            if let (true, Vent::Drain(drain)) = (i > 0, pack.lands[i].vent) {
                let link = self.link(i, GasWay::Drain, self.lands[i], crankcase);
                self.drains.push((link, drain));
            }
            if let (Some(back), Vent::Drain(drain)) = (self.links[i].back, ring.vent) {
                let link = self.link(i, GasWay::Drain, back, crankcase);
                self.drains.push((link, drain));
                self.links[i].drain = Some(link);
            }
        }
    }

    /// Links to the crankcase and from it beside those of the last ring.
    fn drained(&self) -> Vec<(usize, f64)> {
        let Some(last) = self.links.last() else { return Vec::new() };
        let counted = [Some(last.gap), last.face, last.flanks()[1]];
        let crankcase = self.crankcase();
        let sign = |(from, to): (usize, usize)| {
            f64::from(u8::from(to == crankcase)) - f64::from(u8::from(from == crankcase))
        };
        let ends = self.ends.iter().enumerate();
        ends.map(|(k, e)| (k, sign(*e))).filter(|(k, s)| *s != 0.0 && !counted.contains(&Some(*k))).collect()
    }
}

/// The balances of energy of all volumes, in the order of their nodes.
fn land_energy(spaces: &Spaces, links: &[RingLinks], nusselt: f64) -> Result<LandEnergy, BuildError> {
    let pack = &spaces.pack;
    let mut energy = LandEnergy::new(pack);
    for (i, link) in links.iter().enumerate() {
        if i > 0 && pack.lands[i].vent != Vent::Open {
            wide_enough(spaces.land_width(i), || format!("land {}", i + 1))?;
            energy.add(pack, nusselt, pack.lands[i].temperature, pack.lands[i].volume);
        }
        if link.back.is_some() {
            wide_enough(spaces.nominal_width_behind(i), || format!("the space behind ring {}", i + 1))?;
            energy.add(pack, nusselt, pack.rings[i].back_temperature, spaces.nominal_volume(i));
        }
    }
    Ok(energy)
}

/// Time \[s\] in which the space behind ring `i` fills when the pressures around differ by a tenth at 1 bar, at its longest over the
/// positions of the ring: `V/(R T Σ ṁ/Δp)`.
fn filling_time<L: PassageLaw>(
    model: &impl PassageModel<L::Passage>,
    law: &L,
    spaces: &Spaces,
    i: usize,
) -> f64 {
    let ring = &spaces.pack.rings[i];
    let rt = spaces.pack.gas_constant * ring.back_temperature;
    let [full, less] = [1e5, 0.9e5].map(|p| GasState::new(p, rt));
    let volume = spaces.nominal_volume(i);
    [0.0, 0.5, 1.0].into_iter().fold(0.0, |longest: f64, e| {
        let passages = model.ring_passages(i, ring, &spaces.nominal_openings(i, e));
        let flow = law.mass_flow(passages.upper, &full, &less) + law.mass_flow(passages.lower, &full, &less);
        longest.max(volume * 1e4 / (rt * flow))
    })
}

impl<L: PassageLaw, M: PassageModel<L::Passage>> PackNetwork<M, L> {
    /// A gas-flow model called `name` (errors say so) over a pack.
    ///
    /// # Errors
    /// A pack without rings, or whose lands, end gaps, volumes or temperatures are not possible; each with its numbers.
    pub fn new(
        name: &'static str,
        model: M,
        law: L,
        pack: &PackGeometry,
        options: PackOptions,
    ) -> Result<Self, BuildError> {
        let PackOptions { nominal_film, chamfer_fade, eliminate_below, nusselt } = options;
        let spaces = Spaces { pack: pack.clone(), nominal_film, chamfer_fade, bounded: true };
        validate(pack, spaces.film())?;
        let is_fast = |i: usize| {
            pack.rings[i].has_room()
                && pack.rings[i].vent == Vent::Closed
                && eliminate_below.is_some_and(|limit| filling_time(&model, &law, &spaces, i) < limit)
        };
        let fast: Vec<bool> = (0..pack.rings.len()).map(is_fast).collect();
        let layout = Layout::new::<L::Passage, M>(pack, &fast);
        let drained = layout.drained();
        let Layout { names, temperatures, volumes, lands, ends, passages, links, drains, .. } = layout;
        let mut net = Network::new(law, pack.gas_constant, &temperatures, volumes, &ends)?;
        for (i, link) in links.iter().enumerate() {
            if let RingLinks { through: true, upper: Some(upper), .. } = link {
                net.split_link(*upper, pack.gas_constant * pack.rings[i].back_temperature);
            }
        }
        for (link, Drain { area, discharge }) in drains {
            let passage = model.drain(area * (discharge / net.law().discharge())).ok_or_else(|| {
                BuildError::new(format!("`{name}` has no passage for the drain of a groove"))
                    .help("leave the groove vented or closed, or take another `gas_flow`")
            })?;
            net.set_passage(link, passage);
        }
        let mut states: Vec<StateInfo> = names.iter().map(|name| gas_mass(name)).collect();
        let energy = nusselt.map(|number| land_energy(&spaces, &links, number)).transpose()?;
        if energy.is_some() {
            states.extend(names.iter().map(|name| gas_energy(name)));
        }
        Ok(Self { name, model, spaces, net, links, lands, drained, passages, temperatures, states, energy })
    }

    /// Gives every gas space the law that `law_at` has for gas of its temperature \[K\], for what flows out of it.
    ///
    /// # Errors
    /// What `law_at` refuses.
    pub fn with_source_laws(
        mut self,
        law_at: impl FnMut(f64) -> Result<L, BuildError>,
    ) -> Result<Self, BuildError> {
        let laws: Result<Vec<L>, BuildError> = self.temperatures.iter().copied().map(law_at).collect();
        self.net.set_source_laws(laws?);
        Ok(self)
    }

    /// `R T` \[J/kg\] of a node with the temperature of its walls.
    pub(crate) fn wall_rt(&self, node: usize) -> f64 {
        self.spaces.pack.gas_constant * self.temperatures[node]
    }

    /// Capacity `V/(R T)` of the space behind ring `i` in the nominal liner \[kg/Pa\]; 0 where it has no room.
    pub(crate) fn back_capacity(&self, i: usize) -> f64 {
        self.links[i].back.map_or(0.0, |node| self.spaces.nominal_volume(i) / self.wall_rt(node))
    }

    /// Capacity `V/(R T)` of a land between rings \[kg/Pa\]; infinite where it is open to the crankcase.
    pub(crate) fn land_capacity(&self, land: usize) -> f64 {
        if self.is_boundary(land) {
            return f64::INFINITY;
        }
        self.spaces.pack.lands[land].volume / self.wall_rt(self.lands[land])
    }

    /// Whether a land has no state: cylinder, crankcase, and what is open to that.
    pub(crate) fn is_boundary(&self, land: usize) -> bool {
        self.lands[land] >= self.net.volumes()
    }

    /// Pressures of all nodes.
    pub(crate) fn set_pressures(&mut self, inp: &GasIn<'_>, state: &[f64]) -> Result<(), EvalError> {
        let n = self.links.len();
        self.net.set_pressure(self.name, self.lands[0], inp.p_cylinder)?;
        self.net.set_pressure(self.name, self.lands[n], inp.p_crankcase)?;
        for (i, place) in inp.rings[..n].iter().enumerate() {
            if !self.is_boundary(i) {
                let node = self.lands[i];
                let width = self.spaces.land_width(i);
                self.set_space(node, state, self.spaces.pack.lands[i].volume, width)?;
            }
            self.set_back(i, place, state)?;
        }
        Ok(())
    }

    /// Pressure of the space behind ring `i`, if it has one.
    #[inline(always)]
    pub(crate) fn set_back(&mut self, i: usize, place: &RingPlace, state: &[f64]) -> Result<(), EvalError> {
        let Some(node) = self.links[i].back else { return Ok(()) };
        self.set_space(node, state, self.spaces.volume_behind(i, place), self.spaces.width_behind(i, place))
    }

    /// Pressure of a space of a size \[m³\] and the distance `width` \[m\] of its walls.
    #[inline(always)]
    fn set_space(&mut self, node: usize, state: &[f64], volume: f64, width: f64) -> Result<(), EvalError> {
        let mass = state[node];
        match &mut self.energy {
            None => self.net.set_mass(self.name, node, mass, volume),
            Some(energy) => {
                let rt = energy.set(node, mass, state[self.net.volumes() + node], volume, width);
                self.net.set_mass_at(self.name, node, mass, rt, volume)
            }
        }
    }

    /// The passages of ring `i` as they are now.
    pub(crate) fn set_passages(&mut self, i: usize, place: &RingPlace) -> Result<(), EvalError> {
        let openings = self.spaces.openings(self.name, i, place)?;
        let links = self.links[i];
        let p = self.model.ring_passages(i, &self.spaces.pack.rings[i], &openings);
        if let Some(l) = links.upper {
            if links.through {
                self.net.set_split_passages(l, p.upper, p.lower);
            } else {
                self.net.set_passage(l, p.upper);
            }
        }
        if let Some(l) = links.lower {
            self.net.set_passage(l, p.lower);
        }
        self.net.set_passage(links.gap, p.gap);
        if let Some(l) = links.face {
            self.net.set_passage(l, p.face);
        }
        Ok(())
    }
}

/// The network of a built-in model: its law is the orifice law, for gas of each temperature if it is to be.
pub(crate) fn with_orifice_law<M: PassageModel<<OrificeLaw as PassageLaw>::Passage>>(
    name: &'static str,
    model: M,
    orifice: &Orifice,
    pack: &PackGeometry,
    options: PackOptions,
) -> Result<PackNetwork<M>, BuildError> {
    // Before the law, so that what is wrong with the pack is said first.
    validate(pack, options.nominal_film.unwrap_or(0.0))?;
    let within = |e: BuildError| e.within("orifice");
    let law = orifice.build(pack.gamma, pack.gas_constant).map_err(within)?;
    let mut network = PackNetwork::new(name, model, law, pack, options)?;
    let laws = orifice.laws(&network.temperatures, pack.gamma, pack.gas_constant).map_err(within)?;
    network.net.set_source_laws(laws);
    Ok(network)
}
