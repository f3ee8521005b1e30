//! Oil that leaves one side.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Edge, Film2dGrid, FilmMode};

use super::Side;
use super::gap::film_input;

impl Side {
    /// Oil that leaves the side at the rates given \[m³/s\]: over the upper edge, over the lower edge, over the flanks.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn oil_flow(&mut self, speed: f64, mu: f64, rates: &[f64]) -> Result<[f64; 3], EvalError> {
        let out = if self.is_superposed() && self.left_here(speed, mu, rates)? {
            self.outflow()
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

    /// Flow that the pressures leave over in the film of the present place, into the first field of `self.beside`. Whether the film's model can tell.
    fn left_here(&mut self, speed: f64, mu: f64, rates: &[f64]) -> Result<bool, EvalError> {
        self.pressures(speed, mu, rates);
        self.combine_rates(false, rates);
        let n = self.nodes();
        let [per_viscosity, _, _] = &mut self.work;
        per_viscosity.iter_mut().zip(&self.p).for_each(|(out, p)| *out = p / mu);
        let mode = FilmMode { u: -speed, dhdt: &self.rates, edge_pressure: [0.0; 4] };
        self.film.imbalance_here(&film_input(&self.now, n), &mode, per_viscosity, &mut self.beside[..n])
    }

    /// Flow over every edge that the first field of `self.beside` leaves over there.
    fn outflow(&self) -> [f64; 4] {
        let mut out = [0.0; 4];
        for rim in &self.rim {
            let r = self.beside[rim.node];
            // A flank at the pressure of the cavity beside it gives no oil to a gap that opens.
            let dry = rim.edge >= 2 && self.p_cav >= 0.0 && self.open[rim.inner] == 0.0;
            out[rim.edge] += if dry { r.max(0.0) } else { r };
        }
        out
    }
}

/// A node on an edge that gives a pressure.
pub(super) struct Rim {
    node: usize,
    edge: usize,
    /// The node beside it, towards the middle of the side.
    inner: usize,
}

impl Rim {
    /// All those of a grid, or of one that is half a side.
    pub(super) fn of(grid: &Film2dGrid, is_half: bool) -> Vec<Self> {
        let (nx, ny) = (grid.x.len(), grid.y.len());
        let on = |k: usize| {
            let (i, j) = (k % nx, k / nx);
            let at = [i == 0, i + 1 == nx, j == 0, j + 1 == ny];
            let edge = (0..4).find(|&e| at[e] && grid.edges[e] == Edge::Pressure)?;
            let (i, j) = (i.clamp(1, nx - 2), j.clamp(1, if is_half { ny - 1 } else { ny - 2 }));
            Some(Self { node: k, edge, inner: j * nx + i })
        };
        (0..nx * ny).filter_map(on).collect()
    }
}
