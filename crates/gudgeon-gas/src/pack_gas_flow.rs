//! A [`PackNetwork`] as a running model of the kind `gas_flow`.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::BackVolume;
use gudgeon_core::kinds::{GasFlow, GasIn, GasOut, GasPartials, GasPassage};
use gudgeon_core::states::{ColumnInfo, StateInfo, Stateful};

use crate::gas_temperature::LandEnergy;
use crate::pack_network::{PackNetwork, RingLinks};
use crate::passage_law::PassageLaw;
use crate::ring_passages::PassageModel;

impl<L: PassageLaw, M: PassageModel<L::Passage>> PackNetwork<M, L> {
    /// Everything the flows follow from.
    fn set(&mut self, inp: &GasIn<'_>, state: &[f64]) -> Result<(), EvalError> {
        self.set_pressures(inp, state)?;
        for (i, place) in inp.rings[..self.links.len()].iter().enumerate() {
            self.set_passages(i, place)?;
        }
        Ok(())
    }

    /// Computes all flows and writes what follows from them.
    fn flow(&mut self, d_state: &mut [f64], out: &mut GasOut) {
        self.net.update_flows();
        self.write_pressures(out);
        self.write_flows(d_state, out);
    }

    fn write_pressures(&self, out: &mut GasOut) {
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

    fn write_flows(&self, d_state: &mut [f64], out: &mut GasOut) {
        let (masses, energies) = d_state.split_at_mut(self.net.volumes());
        self.net.rates(masses);
        out.power = self.energy.as_ref().map_or(0.0, |energy| self.write_energies(energy, energies));
        let flows = self.net.flows();
        let flow = |link: Option<usize>| link.map_or(0.0, |l| flows[l]);
        for ((links, into), out_of) in self.links.iter().zip(&mut out.flow_in).zip(&mut out.flow_out) {
            let direct = flows[links.gap] + flow(links.face);
            let [first, last] = links.flanks();
            (*into, *out_of) = (direct + flow(first), direct + flow(last));
        }
        if let Some(blow_by) = out.flow_out.last_mut() {
            for (link, sign) in &self.drained {
                *blow_by += sign * flows[*link];
            }
        }
        out.passages.iter_mut().zip(flows).for_each(|(passage, flow)| *passage = *flow);
    }
}

impl<L: PassageLaw, M: PassageModel<L::Passage>> PackNetwork<M, L> {
    /// Rates of the energies; what gas brings over the boundaries, less the heat to the walls \[W\].
    fn write_energies(&self, energy: &LandEnergy, rates: &mut [f64]) -> f64 {
        let mut power = self.net.enthalpy(energy.cp_over_r(), rates);
        for (k, rate) in rates.iter_mut().enumerate() {
            let heat = energy.heat(k, self.net.rt(k));
            power -= heat;
            *rate = energy.rate(k, *rate - heat);
        }
        power
    }
}

impl<L: PassageLaw, M: PassageModel<L::Passage>> Stateful for PackNetwork<M, L> {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }

    /// Temperature of every space with a balance of energy.
    fn columns(&self) -> Vec<ColumnInfo> {
        let energies = self.states.iter().skip(self.net.volumes());
        energies
            .map(|s| ColumnInfo::new(format!("{}.temperature", s.name.trim_start_matches("energy of ")), "K"))
            .collect()
    }

    fn record(&self, _: &[f64], row: &mut Vec<f64>) {
        if self.energy.is_some() {
            row.extend((0..self.net.volumes()).map(|k| self.net.rt(k) / self.spaces.pack.gas_constant));
        }
    }
}

impl<L: PassageLaw, M: PassageModel<L::Passage>> GasFlow for PackNetwork<M, L> {
    /// Spaces of capacity `C_k` tied to a land of capacity `C_0`, each by `C_k/τ`, come together at `1/τ` and `(1 + Σ C_k/C_0)/τ`; the quickest
    /// has the rings above and below a land both seated against it.
    fn max_explicit_step(&self) -> Option<f64> {
        let tau = self.model.merge_time()?;
        let max = (1..self.links.len()).fold(1.0_f64, |max, i| {
            let around = self.back_capacity(i - 1) + self.back_capacity(i);
            max.max(1.0 + around / self.land_capacity(i))
        });
        Some(tau / max)
    }

    fn n_masses(&self) -> usize {
        self.net.volumes()
    }

    fn passages(&self) -> &[GasPassage] {
        &self.passages
    }

    fn has_energy(&self) -> bool {
        self.energy.is_some()
    }

    fn each_space(&self, visit: &mut dyn FnMut(f64, f64, f64)) {
        let Some(energy) = &self.energy else { return };
        for k in 0..self.net.volumes() {
            let p = self.net.pressure(k);
            let volume = self.net.rt(k) / self.net.pressure_per_mass(k);
            visit(p, volume, energy.content(p, volume));
        }
    }

    fn unbound(&mut self) {
        self.spaces.bounded = !M::SIGNED;
    }

    fn uses_film_height(&self) -> bool {
        self.spaces.nominal_film.is_none()
            && self.spaces.pack.rings.iter().any(|r| {
                r.gap_area.is_none()
                    || (r.back == BackVolume::Geometric && r.has_room())
                    || (r.has_clearance && r.slope_upper + r.slope_lower != 0.0)
                    || self.model.uses_film_height(r)
            })
    }

    fn at_pressures(&self, inp: &GasIn<'_>, p_land: &[f64], state: &mut [f64]) {
        let mut fill = |node: usize, p: f64, volume: f64| {
            state[node] = p * volume / self.wall_rt(node);
            if let Some(energy) = &self.energy {
                state[self.net.volumes() + node] = energy.state(node, p, volume);
            }
        };
        for i in 0..self.links.len() {
            if !self.is_boundary(i) {
                fill(self.lands[i], p_land[i], self.spaces.pack.lands[i].volume);
            }
            if let Some(node) = self.links[i].back {
                let p = 0.5 * (p_land[i] + p_land[i + 1]);
                fill(node, p, self.spaces.volume_behind(i, &inp.rings[i]));
            }
        }
    }

    fn pressures(&mut self, inp: &GasIn<'_>, state: &[f64], out: &mut GasOut) -> Result<(), EvalError> {
        self.set_pressures(inp, state)?;
        for (i, place) in inp.rings[..self.links.len()].iter().enumerate() {
            if let RingLinks { through: true, upper: Some(upper), .. } = self.links[i] {
                self.set_passages(i, place)?;
                self.net.update_flow(upper);
            }
        }
        self.write_pressures(out);
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
        self.flow(d_state, out);
        Ok(())
    }

    fn rates_standing(
        &mut self,
        inp: &GasIn<'_>,
        state: &[f64],
        d_state: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.set_pressures(inp, state)?;
        self.flow(d_state, out);
        Ok(())
    }

    fn partials(&mut self, inp: &GasIn<'_>, state: &[f64], out: &mut GasPartials) -> Result<bool, EvalError> {
        if self.energy.is_some() {
            // A law of passages has no derivatives by temperatures.
            return Ok(false);
        }
        self.set(inp, state)?;
        self.net.update_partials();
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
                    let [above, below] = self.net.middle_partials(upper);
                    [(self.lands[i], above), (self.lands[i + 1], below)]
                }
                _ => links.behind.map(|node| (node, 0.5)),
            };
            for (node, weight) in behind {
                add(&mut out.p_back[columns.clone()], node, weight);
            }
            for (flank, rows) in links.flanks().into_iter().zip([&mut out.flow_in, &mut out.flow_out]) {
                for link in [Some(links.gap), links.face, flank].into_iter().flatten() {
                    self.net.add_flow_gradient(link, 1.0, &mut rows[columns.clone()]);
                }
            }
        }
        let blow_by = (self.links.len() - 1) * m..self.links.len() * m;
        for (link, sign) in &self.drained {
            self.net.add_flow_gradient(*link, *sign, &mut out.flow_out[blow_by.clone()]);
        }
        for (link, row) in out.passages.chunks_exact_mut(m.max(1)).enumerate() {
            row.fill(0.0);
            self.net.add_flow_gradient(link, 1.0, row);
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
        let RingLinks { upper, lower, gap, face, back, drain, .. } = self.links[ring];
        let place = &inp.rings[ring];
        let before = back.map(|node| (node, self.net.node_memo(node)));
        let space = back.and_then(|node| Some((node, self.energy.as_ref()?.memo(node))));
        let outcome = self.set_back(ring, place, state).and_then(|()| self.set_passages(ring, place));
        if outcome.is_ok() {
            let links = [Some(gap), face, upper, lower, drain];
            let flows = links.map(|l| l.map(|l| (l, self.net.update_flow(l))));
            self.write_pressures(out);
            self.write_flows(d_state, out);
            for (link, flow) in flows.into_iter().flatten() {
                self.net.restore_flow(link, flow);
            }
        }
        if let Some((node, before)) = before {
            self.net.restore_node(node, before);
        }
        if let (Some(energy), Some((node, before))) = (&mut self.energy, space) {
            energy.restore(node, before);
        }
        outcome
    }
}
