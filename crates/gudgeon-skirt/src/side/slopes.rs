//! Derivatives of the forces of one side with respect to its rates.

use gudgeon_core::EvalError;
use gudgeon_numerics::vectors::widest;

use super::sums::Taken;
use super::{Side, SideLoads, Slopes};

impl Side {
    /// Derivatives of the forces that [`Side::loads`] just found, with the same arguments, into `out.slope`.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn slopes(
        &mut self,
        speed: f64,
        mu: f64,
        rates: &[f64],
        slopes: Slopes,
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        if slopes == Slopes::None {
            return Ok(());
        }
        let (n, width) = (self.nodes(), 4 + self.elastic);
        out.slope.resize(rates.len() * width, 0.0);
        if self.told.is_of(speed, mu, rates) && self.told.slope(slopes, &mut out.slope) {
            return Ok(());
        }
        if slopes == Slopes::Full && !self.is_superposed() {
            self.full_films()?;
        }
        if self.is_superposed() || slopes == Slopes::Full {
            let open = (slopes != Slopes::Full).then_some(&self.open[..]);
            for (m, row) in out.slope.chunks_exact_mut(width).enumerate() {
                let field = &self.fields[(1 + m) * n..(2 + m) * n];
                widest(Taken { factor: mu, open, field, out: &mut self.work[0] });
                self.over.sums(&self.work[0], &self.now, row);
            }
        } else {
            // The film of now waits where nothing else is kept meanwhile.
            self.set_aside();
            let outcome = self.slopes_of_whole(speed, mu, rates, out);
            self.set_aside();
            outcome?;
        }
        if self.told.is_of(speed, mu, rates) {
            self.told.take_slope(slopes, &out.slope);
        }
        Ok(())
    }

    /// Changes pressure and filling for what waits in their place.
    fn set_aside(&mut self) {
        let [_, p, fill] = &mut self.work;
        std::mem::swap(&mut self.p, p);
        std::mem::swap(&mut self.fill, fill);
    }

    /// Derivatives of a film that is found with its cavities: what its model tells, or difference quotients.
    fn slopes_of_whole(
        &mut self,
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        let (n, width) = (self.nodes(), 4 + self.elastic);
        let mut changes = std::mem::take(&mut self.fields);
        changes[..rates.len() * n].copy_from_slice(&self.modes_of_rates);
        self.fills.resize(rates.len() * n, 0.0);
        let told = self.film.answer(&mut changes[..rates.len() * n], &mut self.fills);
        let mut there = SideLoads::default();
        let mut outcome = told;
        if let Ok(true) = outcome {
            for m in 0..rates.len() {
                self.p.copy_from_slice(&changes[m * n..(m + 1) * n]);
                self.fill.copy_from_slice(&self.fills[m * n..(m + 1) * n]);
                self.sums(false, speed, mu, &mut there);
                let row = &mut out.slope[m * width..(m + 1) * width];
                row[..4].copy_from_slice(&there.film);
                row[4..].copy_from_slice(&there.elastic);
            }
        } else if outcome.is_ok() {
            outcome = self.difference_quotients(speed, mu, rates, out).map(|()| false);
        }
        self.fields = changes;
        outcome.map(|_| ())
    }

    /// Derivatives by films at rates beside the present ones.
    fn difference_quotients(
        &mut self,
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        let width = 4 + self.elastic;
        let mut moved = rates.to_vec();
        let mut there = SideLoads::default();
        for m in 0..rates.len() {
            // Rates matter against the clearance per millisecond; the film is found to some 1e-9.
            let d = 1e-4 * rates[m].abs().max(1e-2 * self.clearance / 1e-3);
            moved[m] = rates[m] + d;
            self.solve_whole(false, speed, mu, &moved)?;
            moved[m] = rates[m];
            self.sums(false, speed, mu, &mut there);
            let row = &mut out.slope[m * width..(m + 1) * width];
            for k in 0..4 {
                row[k] = (there.film[k] - out.film[k]) / d;
            }
            for k in 0..self.elastic {
                row[4 + k] = (there.elastic[k] - out.elastic[k]) / d;
            }
        }
        Ok(())
    }
}
