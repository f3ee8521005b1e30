//! Blocks of states that change their mode at events.

use std::ops::Range;

use gudgeon_core::EvalError;
use gudgeon_core::states::Stateful;

use super::pack::Pack;

/// A model with states of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Block {
    /// Gas.
    Gas,
    /// Radial motion of a ring.
    Radial(usize),
    /// Motion of a ring in its groove.
    Motion(usize),
    /// Oil on the flanks of a ring.
    Flank(usize),
    /// Oil.
    Oil,
    /// Film temperatures.
    Temperature,
}

/// An event function of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EventOf {
    /// The model.
    pub block: Block,
    /// Its event.
    pub event: usize,
}

impl Pack {
    /// The models that all rings share, each with what the names of its columns begin with.
    pub(super) fn shared_blocks(&self) -> impl Iterator<Item = (Block, &'static str)> + use<> {
        let oil = self.oil_pack.is_some().then_some((Block::Oil, "oil"));
        [(Block::Gas, "gas")].into_iter().chain(oil).chain([(Block::Temperature, "film_temperature")])
    }

    /// Every model that may have states.
    fn blocks(&self) -> impl Iterator<Item = Block> + use<> {
        let (n, oil) = (self.n_rings(), self.oil_pack.is_some());
        let rings =
            (0..n).map(Block::Radial).chain((0..n).map(Block::Motion)).chain((0..n).map(Block::Flank));
        std::iter::once(Block::Gas).chain(rings).chain(oil.then_some(Block::Oil)).chain([Block::Temperature])
    }

    /// Its part of the state vector.
    #[must_use]
    pub fn range(&self, b: Block) -> Range<usize> {
        match b {
            Block::Gas => self.layout.gas.clone(),
            Block::Radial(i) => self.layout.radial[i].clone(),
            Block::Motion(i) => self.layout.motion[i].clone(),
            Block::Flank(i) => self.layout.flank[i].clone(),
            Block::Oil => self.layout.oil.clone(),
            Block::Temperature => self.layout.temperature.clone(),
        }
    }

    /// The model itself; that of oil that is not followed is the film temperature's.
    #[must_use]
    pub fn block(&self, b: Block) -> &dyn Stateful {
        match (b, &self.oil_pack) {
            (Block::Gas, _) => &*self.gas,
            (Block::Radial(i), _) => &*self.rings[i].radial,
            (Block::Motion(i), _) => &*self.rings[i].motion,
            (Block::Flank(i), _) => &*self.rings[i].flank,
            (Block::Oil, Some(oil)) => &**oil,
            _ => &*self.film_temperature,
        }
    }

    /// As [`Pack::block`].
    pub fn block_mut(&mut self, b: Block) -> &mut dyn Stateful {
        match (b, &mut self.oil_pack) {
            (Block::Gas, _) => &mut *self.gas,
            (Block::Radial(i), _) => &mut *self.rings[i].radial,
            (Block::Motion(i), _) => &mut *self.rings[i].motion,
            (Block::Flank(i), _) => &mut *self.rings[i].flank,
            (Block::Oil, Some(oil)) => &mut **oil,
            _ => &mut *self.film_temperature,
        }
    }

    /// All event functions, into `out`.
    pub fn events(&self, out: &mut Vec<EventOf>) {
        out.clear();
        for block in self.blocks().filter(|b| !self.range(*b).is_empty()) {
            out.extend((0..self.block(block).n_events()).map(|event| EventOf { block, event }));
        }
    }

    /// Chooses the modes with which one cycle ends and the next starts: a function of the state alone, without what follows from balances.
    /// Evaluates the instant.
    ///
    /// # Errors
    /// What a sub-model refuses.
    pub fn start_modes(&mut self, theta: f64, y: &mut [f64]) -> Result<(), EvalError> {
        self.each_block(|b, _| b.free());
        let changes = self.blocks().any(|b| !self.range(b).is_empty() && self.block(b).n_events() > 0);
        if !changes {
            return Ok(());
        }
        self.evaluate(theta, y)?;
        self.each_block(|b, own| {
            if !own.is_empty() {
                b.start(&mut y[own]);
            }
        });
        Ok(())
    }

    /// Which states follow the others at once after the last choice of modes is added to `out`.
    pub(super) fn add_followers(&self, out: &mut [bool]) {
        for b in self.blocks() {
            for (k, own) in self.range(b).enumerate() {
                out[own] |= self.block(b).follows_at_once(k);
            }
        }
    }
}
