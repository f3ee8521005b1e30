//! Oil that leaves one side.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::Edge;

use super::Side;

impl Side {
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
}
