//! What the gas-flow models of a ring pack share: the network of lands and spaces behind rings, and the geometry of the end gap.

use std::f64::consts::{PI, TAU};

use gudgeon_core::geometry::{BackVolume, PackGeometry, RingGeometry, RingPlace};
use gudgeon_core::kinds::{GasFlow, GasIn, GasOut, GasSlopes};
use gudgeon_core::quantity::{PosLength, PosTime, quantity};
use gudgeon_core::{BuildError, EvalError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::network::{Network, Node, Passage, through};
use crate::orifice::{Orifice, OrificeLaw};

/// Which film thickness sets the passages and the volume behind a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FilmHeight {
    /// The film thickness of the instant: gas flow and film are solved together.
    #[default]
    Instantaneous,
    /// The constant thickness `nominal_film`: the gas flow does not need the films.
    Nominal,
}

/// What becomes of spaces behind rings that fill much faster than anything else changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Elimination {
    /// Every space stores gas and is integrated.
    #[default]
    Never,
    /// Spaces that fill in less than `eliminate_below` store nothing: what enters past one flank leaves past the other, and the
    /// pressure between follows from that.
    Auto,
}

/// Thickness that flooded films of rings stay below.
pub(crate) fn fifty_micrometres() -> PosLength {
    quantity(50e-6)
}

/// Default of `eliminate_below`.
pub(crate) fn ten_nanoseconds() -> PosTime {
    quantity(1e-8)
}

impl Elimination {
    /// Filling time \[s\] below which a space is left out.
    pub(crate) fn below(self, limit: PosTime) -> Option<f64> {
        (self == Self::Auto).then(|| limit.si())
    }
}

/// The openings around one ring at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Openings {
    /// Film thickness that counts \[m\].
    pub h: f64,
    /// Liner radius \[m\].
    pub liner_radius: f64,
    /// Axial distance from the lower groove flank \[m\], not negative unless the pack is unbound.
    pub lower: f64,
    /// Axial distance from the upper groove flank \[m\], likewise.
    pub upper: f64,
    /// Position in the groove, 0 lower flank, 1 upper flank.
    pub e: f64,
    /// End-gap area \[m²\], with the chamfer.
    pub gap: f64,
    /// Volume behind the ring \[m³\].
    pub back_volume: f64,
}

/// The passages of one ring.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RingPassages {
    /// Past the upper flank: land above to the space behind (drained groove: to the land below).
    pub upper: Passage,
    /// Past the lower flank: space behind to land below.
    pub lower: Passage,
    /// Directly from land to land through the gap.
    pub gap: Passage,
    /// Directly from land to land past the face.
    pub face: Passage,
}

/// What distinguishes the models.
pub(crate) trait Passages: Send {
    /// Name of the model.
    const NAME: &'static str;
    /// Whether any ring has a passage past its face.
    const FACE: bool;
    /// Whether an opening below zero means something: an area does, a height whose cube counts does not.
    const SIGNED: bool = false;
    /// The passages of ring `i`. Upper and lower flank are ignored for a sealed ring, the lower one for a drained groove.
    fn passages(&self, i: usize, ring: &RingGeometry, o: &Openings) -> RingPassages;
    /// Time \[s\] within which the space behind a seated ring takes on the pressure of the land it faces, when the model ties them.
    fn tie_time(&self) -> Option<f64> {
        None
    }
    /// Whether the passages themselves (not gap, clearance and volume) depend on `Openings::h`.
    fn uses_film_height(&self, ring: &RingGeometry) -> bool;
}

#[derive(Debug, Clone, Copy)]
struct RingLinks {
    upper: Option<usize>,
    lower: Option<usize>,
    gap: usize,
    face: Option<usize>,
    /// Whether the upper link goes on past the lower flank, through a space behind the ring that stores nothing.
    through: bool,
    /// Node of the space behind the ring.
    back: Option<usize>,
    /// The pressure behind the ring is the mean of these two nodes': its own volume twice, the land below twice when it is drained
    /// into that, both lands when it has no room.
    behind: [usize; 2],
}

/// A gas-flow model over a pack.
pub(crate) struct Pack<M> {
    model: M,
    pack: PackGeometry,
    /// `None`: instantaneous.
    nominal_film: Option<f64>,
    chamfer_fade: f64,
    /// Whether openings end at zero.
    bounded: bool,
    net: Network,
    links: Vec<RingLinks>,
    /// Nodes of the lands.
    lands: Vec<usize>,
}

/// Gap, piston and groove of a pack make sense for a gas-flow model.
fn check(pack: &PackGeometry, film: f64) -> Result<(), BuildError> {
    let n = pack.rings.len();
    if n == 0 {
        return Err(BuildError::new("a gas-flow model needs at least one ring"));
    }
    if pack.lands.len() != n + 1 {
        return Err(BuildError::new(format!(
            "{n} rings need {} spaces above, between and below, not {}",
            n + 1,
            pack.lands.len()
        )));
    }
    for (i, land) in pack.lands.iter().enumerate().take(n).skip(1) {
        if !(land.volume > 0.0 && land.volume.is_finite()) {
            return Err(BuildError::new(format!(
                "land {} has the gas volume {:e} m3, which must be greater than zero",
                i + 1,
                land.volume
            ))
            .help("give its height and the piston diameter, or its volume"));
        }
    }
    for (i, ring) in pack.rings.iter().enumerate() {
        let number = i + 1;
        let clearance = pack.bore_radius - ring.piston_radius_above;
        match ring.gap_area {
            Some(a) if !(a >= 0.0 && a.is_finite()) => {
                return Err(BuildError::new(format!("the gap area of ring {number} is {a:e} m2")));
            }
            None if clearance - film <= 0.0 || clearance.is_nan() => {
                return Err(BuildError::new(format!(
                    "above ring {number} the piston has the radius {:.6} m in a liner of {:.6} m: no clearance is left for \
                     the end gap",
                    ring.piston_radius_above, pack.bore_radius
                )));
            }
            _ => {}
        }
        let no_volume = |v: f64, why: String| {
            BuildError::new(format!("the volume behind ring {number} is {v:e} m3: {why}"))
        };
        match ring.back {
            BackVolume::Fixed(v) if !(v > 0.0 && v.is_finite()) => {
                return Err(no_volume(v, "it must be greater than zero".to_owned()));
            }
            BackVolume::Geometric => {
                let v = back_volume(ring, pack.bore_radius, film);
                if !(v > 0.0 && v.is_finite()) {
                    let behind = ring.h_max(pack.bore_radius) - film;
                    return Err(no_volume(
                        v,
                        format!(
                            "the radial distance behind it is {behind:e} m, the groove is {:e} m high at its root",
                            ring.groove_height_inner
                        ),
                    )
                    .help("check groove root diameter, radial thickness and groove height"));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// `½ [B_in + B_in + (c_1 + c_2) DR] π (R_int² - R_root²)`, the groove behind the ring.
fn back_volume(ring: &RingGeometry, liner_radius: f64, film: f64) -> f64 {
    let behind = ring.h_max(liner_radius) - film;
    let r_int = ring.root_radius + behind;
    let height = ring.groove_height_inner + 0.5 * (ring.slope_upper + ring.slope_lower) * behind;
    height * PI * (r_int * r_int - ring.root_radius * ring.root_radius)
}

/// Time \[s\] in which the space behind ring `i` fills when the pressures around differ by a tenth at 1 bar, at its longest over the
/// positions of the ring: `V/(R T Σ ṁ/Δp)`.
fn filling_time<M: Passages>(model: &M, pack: &PackGeometry, i: usize, law: &OrificeLaw, film: f64) -> f64 {
    let ring = &pack.rings[i];
    let volume = match ring.back {
        BackVolume::Fixed(v) => v,
        _ => back_volume(ring, pack.bore_radius, film),
    };
    let radial = (pack.bore_radius - ring.piston_radius_above - film).max(0.0);
    let behind = ring.h_max(pack.bore_radius) - film;
    let clearance = (ring.clearance_inner + (ring.slope_upper + ring.slope_lower) * behind).max(0.0);
    let rt = pack.gas_constant * ring.back_temperature;
    let [mut full, mut less] = [Node::at(rt); 2];
    full.set(1e5, law.discharge());
    less.set(0.9e5, law.discharge());
    [0.0, 0.5, 1.0].into_iter().fold(0.0, |longest: f64, e| {
        let passages = model.passages(
            i,
            ring,
            &Openings {
                h: film,
                liner_radius: pack.bore_radius,
                lower: e * clearance,
                upper: (1.0 - e) * clearance,
                e,
                gap: ring.gap_area.unwrap_or(ring.gap * radial),
                back_volume: volume,
            },
        );
        let flow = through(law, passages.upper, &full, &less) + through(law, passages.lower, &full, &less);
        longest.max(volume * 1e4 / (rt * flow))
    })
}

impl<M: Passages> Pack<M> {
    /// `eliminate`: filling time \[s\] below which a space behind a ring stores nothing.
    pub(crate) fn new(
        model: M,
        pack: &PackGeometry,
        orifice: &Orifice,
        nominal_film: Option<f64>,
        chamfer_fade: f64,
        eliminate: Option<f64>,
    ) -> Result<Self, BuildError> {
        let film = nominal_film.unwrap_or(0.0);
        check(pack, film)?;
        let within = |e: BuildError| e.within("orifice");
        let law = orifice.build(pack.gamma, pack.gas_constant).map_err(within)?;
        let n = pack.rings.len();
        let with_room = |r: &RingGeometry| matches!(r.back, BackVolume::Geometric | BackVolume::Fixed(_));
        let fast: Vec<bool> = (0..n)
            .map(|i| {
                with_room(&pack.rings[i])
                    && eliminate.is_some_and(|limit| filling_time(&model, pack, i, &law, film) < limit)
            })
            .collect();
        // Volumes from the top: behind ring 1, land 2, behind ring 2, ...; then chamber and crankcase.
        let mut temperatures = Vec::with_capacity(2 * n + 1);
        let mut backs = vec![None; n];
        let mut lands = vec![0; n + 1];
        for (i, ring) in pack.rings.iter().enumerate() {
            if i > 0 {
                lands[i] = temperatures.len();
                temperatures.push(pack.lands[i].temperature);
            }
            if with_room(ring) && !fast[i] {
                backs[i] = Some(temperatures.len());
                temperatures.push(ring.back_temperature);
            }
        }
        let volumes = temperatures.len();
        for i in [0, n] {
            lands[i] = temperatures.len();
            temperatures.push(pack.lands[i].temperature);
        }
        let mut ends = Vec::with_capacity(4 * n);
        let mut link = |a: usize, b: usize| {
            ends.push((a, b));
            ends.len() - 1
        };
        let links: Vec<_> = (0..n)
            .map(|i| {
                let (above, below) = (lands[i], lands[i + 1]);
                RingLinks {
                    upper: match pack.rings[i].back {
                        BackVolume::Sealed => None,
                        _ => Some(link(above, backs[i].unwrap_or(below))),
                    },
                    lower: backs[i].map(|b| link(b, below)),
                    through: fast[i],
                    gap: link(above, below),
                    face: M::FACE.then(|| link(above, below)),
                    back: backs[i],
                    behind: match (backs[i], pack.rings[i].back) {
                        (Some(node), _) => [node; 2],
                        (None, BackVolume::Drained) => [below; 2],
                        (None, _) => [above, below],
                    },
                }
            })
            .collect();
        let own = orifice.laws(&temperatures, pack.gamma, pack.gas_constant).map_err(within)?;
        let mut net = Network::new(law, pack.gas_constant, &temperatures, volumes, &ends)?;
        net.set_laws(own);
        for (i, link) in links.iter().enumerate() {
            if let RingLinks { through: true, upper: Some(upper), .. } = link {
                net.split_link(*upper, pack.gas_constant * pack.rings[i].back_temperature);
            }
        }
        Ok(Self { model, pack: pack.clone(), nominal_film, chamfer_fade, bounded: true, net, links, lands })
    }

    /// Capacity `V/(R T)` of the space behind ring `i`, and of land `i + 1` when that has a volume, in the nominal liner \[kg/Pa\].
    fn capacities(&self, i: usize) -> (f64, Option<f64>) {
        let (ring, rt) = (&self.pack.rings[i], |node: usize| self.net.rt(node));
        let volume = match ring.back {
            BackVolume::Fixed(v) => v,
            BackVolume::Geometric => {
                back_volume(ring, self.pack.bore_radius, self.nominal_film.unwrap_or(0.0))
            }
            _ => 0.0,
        };
        let behind = self.links[i].back.map_or(0.0, |node| volume / rt(node));
        let land = (i + 1 < self.links.len()).then(|| self.pack.lands[i + 1].volume / rt(self.lands[i + 1]));
        (behind, land)
    }

    /// Volume behind ring `i`, not yet checked.
    fn volume_behind(&self, i: usize, place: &RingPlace) -> f64 {
        let ring = &self.pack.rings[i];
        match (ring.back, self.nominal_film) {
            (BackVolume::Fixed(v), _) => v,
            (BackVolume::Geometric, None) => place.back_volume,
            (BackVolume::Geometric, Some(h)) => back_volume(ring, place.liner_radius, h),
            _ => 0.0,
        }
    }

    fn openings(&self, i: usize, place: &RingPlace) -> Result<Openings, EvalError> {
        let ring = &self.pack.rings[i];
        let h = self.nominal_film.unwrap_or(place.h);
        let clearance = match self.nominal_film {
            _ if !ring.has_clearance => 0.0,
            None => place.clearance,
            Some(h) => {
                ring.clearance_inner
                    + (ring.slope_upper + ring.slope_lower) * (ring.h_max(place.liner_radius) - h)
            }
        }
        .max(0.0);
        let e = place.e.clamp(0.0, 1.0);
        let seated = |distance: f64| {
            if self.chamfer_fade > 0.0 {
                (1.0 - distance / self.chamfer_fade).max(0.0)
            } else if distance == 0.0 {
                1.0
            } else {
                0.0
            }
        };
        let chamfer = ring.chamfer.area_lower * seated(e) + ring.chamfer.area_upper * seated(1.0 - e);
        let area = match ring.gap_area {
            Some(a) => a,
            None => {
                let running = ring.gap + TAU * (place.liner_radius - self.pack.bore_radius);
                let radial = place.liner_radius - ring.piston_radius_above;
                if running <= 0.0 || radial <= 0.0 {
                    return Err(EvalError::fatal(
                        M::NAME,
                        format!(
                            "the end gap of ring {} closes when hot: {:e} m at the nominal bore, {running:e} m in the liner of \
                             radius {} m, under a radial clearance of {radial:e} m",
                            i + 1,
                            ring.gap,
                            place.liner_radius
                        ),
                    ));
                }
                // A ring that has retreated behind its land leaves no gap of this kind.
                let radial = radial - h;
                running * if self.bounded { radial.max(0.0) } else { radial }
            }
        };
        let (lower, upper) = if self.bounded {
            (e * clearance, (1.0 - e) * clearance)
        } else {
            (place.s, clearance - place.s)
        };
        Ok(Openings {
            h,
            liner_radius: place.liner_radius,
            lower,
            upper,
            e,
            gap: area + chamfer,
            back_volume: self.volume_behind(i, place),
        })
    }

    /// Pressures of all nodes.
    fn set_pressures(&mut self, inp: &GasIn<'_>, state: &[f64]) -> Result<(), EvalError> {
        let n = self.links.len();
        self.net.set_pressure(M::NAME, self.lands[0], inp.p_cylinder)?;
        self.net.set_pressure(M::NAME, self.lands[n], inp.p_crankcase)?;
        for i in 0..n {
            if i > 0 {
                let node = self.lands[i];
                self.net.set_mass(M::NAME, node, state[node], self.pack.lands[i].volume)?;
            }
            if let Some(node) = self.links[i].back {
                let volume = self.volume_behind(i, &inp.rings[i]);
                self.net.set_mass(M::NAME, node, state[node], volume)?;
            }
        }
        Ok(())
    }

    /// The passages of ring `i` as they are now.
    fn set_passages(&mut self, i: usize, place: &RingPlace) -> Result<(), EvalError> {
        let o = self.openings(i, place)?;
        let links = self.links[i];
        let p = self.model.passages(i, &self.pack.rings[i], &o);
        if let Some(l) = links.upper {
            if links.through {
                self.net.set_passages(l, p.upper, p.lower);
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

    /// Everything the flows follow from.
    fn set(&mut self, inp: &GasIn<'_>, state: &[f64]) -> Result<(), EvalError> {
        self.set_pressures(inp, state)?;
        for (i, place) in inp.rings.iter().enumerate().take(self.links.len()) {
            self.set_passages(i, place)?;
        }
        Ok(())
    }

    fn tell_pressures(&self, out: &mut GasOut) {
        for (p, &node) in out.p_land.iter_mut().zip(&self.lands) {
            *p = self.net.pressure(node);
        }
        for (p, links) in out.p_back.iter_mut().zip(&self.links) {
            *p = match links.upper {
                Some(upper) if links.through => self.net.middle_pressure(upper),
                _ => {
                    let [a, b] = links.behind;
                    0.5 * (self.net.pressure(a) + self.net.pressure(b))
                }
            };
        }
    }

    fn tell_flows(&self, d_state: &mut [f64], out: &mut GasOut) {
        self.net.rates(d_state);
        for (i, links) in self.links.iter().enumerate() {
            let flow = |link: Option<usize>| link.map_or(0.0, |l| self.net.flow(l));
            let direct = self.net.flow(links.gap) + flow(links.face);
            let upper = flow(links.upper);
            out.flow_in[i] = direct + upper;
            out.flow_out[i] = direct + if links.back.is_some() { flow(links.lower) } else { upper };
        }
    }
}

impl<M: Passages> GasFlow for Pack<M> {
    /// Spaces of capacity `C_k` tied to a land of capacity `C_0`, each by `C_k/τ`, come together at `1/τ` and `(1 + Σ C_k/C_0)/τ`; the quickest
    /// has the rings above and below a land both seated against it.
    fn longest_explicit_step(&self) -> Option<f64> {
        let tau = self.model.tie_time()?;
        let most = (1..self.links.len()).fold(1.0_f64, |most, i| {
            let ((above, land), (below, _)) = (self.capacities(i - 1), self.capacities(i));
            most.max(1.0 + land.map_or(0.0, |land| (above + below) / land))
        });
        Some(tau / most)
    }

    fn unbound(&mut self) {
        self.bounded = !M::SIGNED;
    }

    fn n_states(&self) -> usize {
        self.net.volumes()
    }

    fn state_names(&self) -> Vec<String> {
        let mut names = vec![String::new(); self.net.volumes()];
        for i in 0..self.links.len() {
            if i > 0 {
                names[self.lands[i]] = format!("land{}", i + 1);
            }
            if let Some(node) = self.links[i].back {
                names[node] = format!("ring{}.back", i + 1);
            }
        }
        names
    }

    fn uses_film_height(&self) -> bool {
        self.nominal_film.is_none()
            && self.pack.rings.iter().any(|r| {
                r.gap_area.is_none()
                    || r.back == BackVolume::Geometric
                    || (r.has_clearance && r.slope_upper + r.slope_lower != 0.0)
                    || self.model.uses_film_height(r)
            })
    }

    fn initial(&self, inp: &GasIn<'_>, p_land: &[f64], state: &mut [f64]) {
        for i in 0..self.links.len() {
            if i > 0 {
                let node = self.lands[i];
                state[node] = p_land[i] * self.pack.lands[i].volume / self.net.rt(node);
            }
            if let Some(node) = self.links[i].back {
                let p = 0.5 * (p_land[i] + p_land[i + 1]);
                state[node] = p * self.volume_behind(i, &inp.rings[i]) / self.net.rt(node);
            }
        }
    }

    fn pressures(&mut self, inp: &GasIn<'_>, state: &[f64], out: &mut GasOut) -> Result<(), EvalError> {
        self.set_pressures(inp, state)?;
        for (i, place) in inp.rings.iter().enumerate().take(self.links.len()) {
            if let RingLinks { through: true, upper: Some(upper), .. } = self.links[i] {
                self.set_passages(i, place)?;
                self.net.update_flow(upper);
            }
        }
        self.tell_pressures(out);
        Ok(())
    }

    fn rates(
        &mut self,
        inp: &GasIn<'_>,
        state: &[f64],
        d_state: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.set(inp, state)?;
        self.net.update_flows();
        self.tell_pressures(out);
        self.tell_flows(d_state, out);
        Ok(())
    }

    fn slopes(&mut self, inp: &GasIn<'_>, state: &[f64], out: &mut GasSlopes) -> Result<bool, EvalError> {
        self.set(inp, state)?;
        self.net.update_slopes();
        self.net.jacobian(&mut out.d_state);
        let m = self.net.volumes();
        for rows in [&mut out.p_land, &mut out.p_back, &mut out.flow_in, &mut out.flow_out] {
            rows.fill(0.0);
        }
        // A pressure follows from the mass of its own volume, the boundaries from none.
        let add = |row: &mut [f64], node: usize, factor: f64| {
            if let Some(slot) = row.get_mut(node) {
                *slot += factor * self.net.pressure_per_mass(node);
            }
        };
        for (i, &node) in self.lands.iter().enumerate() {
            add(&mut out.p_land[i * m..(i + 1) * m], node, 1.0);
        }
        for (i, links) in self.links.iter().enumerate() {
            let columns = i * m..(i + 1) * m;
            let behind = match links.upper {
                Some(upper) if links.through => {
                    let [above, below] = self.net.middle_slope(upper);
                    [(self.lands[i], above), (self.lands[i + 1], below)]
                }
                _ => links.behind.map(|node| (node, 0.5)),
            };
            for (node, weight) in behind {
                add(&mut out.p_back[columns.clone()], node, weight);
            }
            let arriving = if links.back.is_some() { links.lower } else { links.upper };
            for (last, rows) in [(links.upper, &mut out.flow_in), (arriving, &mut out.flow_out)] {
                for link in [Some(links.gap), links.face, last].into_iter().flatten() {
                    self.net.add_flow_gradient(link, 1.0, &mut rows[columns.clone()]);
                }
            }
        }
        Ok(true)
    }

    fn rates_moved(
        &mut self,
        ring: usize,
        inp: &GasIn<'_>,
        state: &[f64],
        d_state: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        // A ring touches its own passages and the space behind it, which no other ring's passage reaches.
        let RingLinks { upper, lower, gap, face, back, .. } = self.links[ring];
        let place = &inp.rings[ring];
        let before = back.map(|node| (node, self.net.node(node)));
        if let Some(node) = back {
            self.net.set_mass(M::NAME, node, state[node], self.volume_behind(ring, place))?;
        }
        let outcome = self.set_passages(ring, place);
        if outcome.is_ok() {
            let links = [Some(gap), face, upper, lower];
            let flows = links.map(|l| l.map(|l| (l, self.net.update_flow(l))));
            self.tell_pressures(out);
            self.tell_flows(d_state, out);
            for (link, flow) in flows.into_iter().flatten() {
                self.net.restore_flow(link, flow);
            }
        }
        if let Some((node, before)) = before {
            self.net.restore_node(node, before);
        }
        outcome
    }
}
