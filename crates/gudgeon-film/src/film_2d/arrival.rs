//! Oil that the sliding surface brings over an edge, and what the nodes there hold of it.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Edge, Film2dIn};

use super::problem::Problem;

impl Problem {
    /// Whether what is said of the film's filling is possible.
    pub fn check_filling(&self, model: &'static str, inp: &Film2dIn<'_>) -> Result<(), EvalError> {
        let n = self.len();
        if let Some(old) = inp.history {
            if old.content.len() != n || !old.content.iter().sum::<f64>().is_finite() {
                return Err(EvalError::fatal(model, "the history does not hold one finite content per node"));
            }
            if !(old.dt > 0.0 && old.dt.is_finite()) {
                return Err(EvalError::fatal(model, format!("the time step is {} s", old.dt)));
            }
        }
        if inp.arriving.is_some_and(|films| !films.iter().all(|f| *f >= 0.0 && f.is_finite())) {
            return Err(EvalError::fatal(model, "a film that arrives is negative or not finite"));
        }
        if let Some(unfilled) = inp.unfilled {
            let fields = [unfilled.engaged, unfilled.fill];
            if !fields.iter().all(|f| f.len() == n && f.iter().all(|f| (0.0..=1.0).contains(f))) {
                return Err(EvalError::fatal(
                    model,
                    "what is unfilled is not one filling from 0 to 1 per node",
                ));
            }
        }
        Ok(())
    }

    /// What nodes that are partly engaged lose of their pressure on the spot.
    pub fn engage(&mut self, inp: &Film2dIn<'_>) {
        let Some(unfilled) = inp.unfilled else {
            self.m.leak.fill(0.0);
            return;
        };
        for k in 0..self.len() {
            let s = unfilled.engaged[k];
            let (i, j) = (k % self.nx, k / self.nx);
            let below = if j > 0 { self.m.gy[k - self.nx] } else { 0.0 };
            let before = self.before(i, k);
            let along = if before == k { 0.0 } else { self.m.gx[before] };
            let all = along + self.m.gx[k] + below + self.m.gy[k];
            // A node that is not engaged at all has no pressure to lose.
            self.m.leak[k] = if s > 0.0 { (1.0 / s - 1.0) * all } else { 0.0 };
        }
    }

    /// The edge of `x` over which the surface comes in, and that over which it goes out, where they are at the pressure of the cavity and a film arrives.
    fn crossed(&self, inp: &Film2dIn<'_>) -> [Option<usize>; 2] {
        let ways = if inp.u >= 0.0 { [0, 1] } else { [1, 0] };
        ways.map(|e| {
            let open = self.grid.edges[e] == Edge::Pressure && inp.edge_pressure[e] <= inp.p_cav;
            (inp.arriving.is_some() && inp.history.is_some() && open).then_some(e)
        })
    }

    /// Nodes of an edge of `x`, from which the next one inwards stands in the same line.
    fn nodes_of(&self, edge: usize) -> impl Iterator<Item = usize> + use<> {
        let (nx, first) = (self.nx, if edge == 0 { 0 } else { self.nx - 1 });
        (0..self.ny).map(move |j| j * nx + first)
    }

    /// Flow that the surface carries over the edge at node `k` \[m³/s\] when the gap there is full.
    fn carried_over(&self, inp: &Film2dIn<'_>, k: usize) -> f64 {
        let film = if inp.factors.transport.is_empty() { inp.h[k] } else { inp.factors.transport[k] };
        0.5 * inp.u.abs() * film * self.width(k)
    }

    /// Void of the nodes at which the surface comes in: they take up the film that lies on it, as far as there is room for it in what moves on and in
    /// what they hold. What the film inside presses back is not mixed in; it leaves over the edge.
    pub fn fill_inlet(&self, inp: &Film2dIn<'_>, void: &mut [f64]) {
        let ([Some(edge), _], Some(films)) = (self.crossed(inp), inp.arriving) else { return };
        for k in self.nodes_of(edge) {
            let enters = inp.u.abs() * films[edge] * self.width(k) - self.fixed[k];
            let on = if edge == 0 { self.m.qx[k] } else { self.m.qx[k - 1] };
            let room = on.abs() + self.m.hold[k];
            void[k] = if room > 0.0 { 1.0 - (enters / room).clamp(0.0, 1.0) } else { 0.0 };
        }
    }

    /// Void of the nodes at which the surface goes out, from what it and the pressure `p` inside bring there.
    pub fn fill_outlet(&self, inp: &Film2dIn<'_>, p: &[f64], void: &mut [f64]) {
        let [_, Some(edge)] = self.crossed(inp) else { return };
        for k in self.nodes_of(edge) {
            let (inner, between) = if edge == 0 { (k + 1, k) } else { (k - 1, k - 1) };
            let brought = self.m.qx[between].abs() * (1.0 - void[inner]);
            let enters = brought + self.m.gx[between] * (p[inner] - p[k]) - self.fixed[k];
            let room = self.carried_over(inp, k) + self.m.hold[k];
            void[k] = if room > 0.0 { 1.0 - (enters / room).clamp(0.0, 1.0) } else { 0.0 };
        }
    }
}
