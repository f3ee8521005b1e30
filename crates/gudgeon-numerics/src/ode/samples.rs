//! Where event functions are evaluated inside a step.

/// Points θ in (0, 1] of a step, ascending, the last one 1: geometric from the start while the sign of an event function is unknown
/// there, otherwise equidistant.
pub(super) struct Samples {
    /// Number of equidistant parts.
    parts: f64,
    next_geometric: f64,
    next_even: f64,
    ended: bool,
}

impl Samples {
    /// `inside`: equidistant points between the ends; `geometric`: resolution of θ, when points shall begin there.
    pub fn new(inside: u32, geometric: Option<f64>) -> Self {
        Self {
            parts: f64::from(inside) + 1.0,
            next_geometric: geometric.map_or(f64::INFINITY, |resolution| resolution.max(1e-13) * 2.0),
            next_even: 1.0,
            ended: false,
        }
    }
}

impl Iterator for Samples {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        if self.ended {
            return None;
        }
        let even = (self.next_even / self.parts).min(1.0);
        let point = if self.next_geometric < even {
            let point = self.next_geometric;
            self.next_geometric *= 4.0;
            point
        } else {
            self.next_even += 1.0;
            even
        };
        self.ended = point >= 1.0;
        Some(point)
    }
}
