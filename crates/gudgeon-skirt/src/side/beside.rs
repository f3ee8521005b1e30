//! Forces of one side at places beside the present one.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{FilmMode, Superposition};
use gudgeon_numerics::vectors::widest;

use super::gap::film_input;
use super::sums::Taken;
use super::{Side, SideLoads};

impl Side {
    /// Forces at places beside the present one, at `e` and `q`: coordinate after coordinate (upper edge, lower edge, elastic amplitudes) is moved by its `d`
    /// alone; to first order in it.
    ///
    /// The pressures of now leave a flow over in the film beside; the matrix that is set up says what pressures take it up.
    ///
    /// # Errors
    /// A film that cannot be solved.
    #[allow(clippy::too_many_arguments, reason = "a place, a motion and a step")]
    pub fn loads_beside(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        d: &[f64],
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut [SideLoads],
    ) -> Result<(), EvalError> {
        let n = self.nodes();
        let count = 2 + self.elastic;
        if self.is_superposed() {
            self.pressures(speed, mu, rates);
        }
        let mut moved = std::mem::take(&mut self.moved);
        let mut outcome = Ok(true);
        for (c, out) in out.iter_mut().enumerate().take(count) {
            let at = |k: usize, x: f64| if k == c { x + d[k] } else { x };
            let there = [at(0, e[0]), at(1, e[1])];
            moved.clear();
            moved.extend(q.iter().enumerate().map(|(m, q)| at(2 + m, *q)));
            outcome = if self.is_superposed() {
                self.begin_beside(there, &moved, speed, mu, rates, c, out)
            } else {
                Ok(false)
            };
            if let Ok(false) = outcome {
                outcome = self.loads_elsewhere(there, &moved, speed, mu, rates, out).map(|()| false);
            }
            if outcome.is_err() {
                break;
            }
        }
        self.moved = moved;
        if !outcome? {
            return Ok(());
        }
        self.film.respond(&mut self.beside)?;
        let width = 4 + self.elastic;
        for (c, out) in out.iter_mut().enumerate().take(count) {
            let field = &self.beside[c * n..(c + 1) * n];
            let open = Some(&self.open[..]);
            widest(Taken { factor: mu, open, field, out: &mut self.work[0] });
            self.over.sums(&self.work[0], &self.now, &mut self.row[..width]);
            out.film.iter_mut().zip(&self.row).for_each(|(f, d)| *f += d);
            out.elastic.iter_mut().zip(&self.row[4..]).for_each(|(f, d)| *f += d);
        }
        Ok(())
    }

    /// The part of [`Side::loads_beside`] that needs no solution: forces of the pressures of now in the film beside, and the flow that they leave
    /// over. Whether the film's model can tell.
    #[allow(clippy::too_many_arguments, reason = "a place, a motion and a column")]
    fn begin_beside(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        speed: f64,
        mu: f64,
        rates: &[f64],
        column: usize,
        out: &mut SideLoads,
    ) -> Result<bool, EvalError> {
        self.shape_gap(true, e, q, speed)?;
        out.contact = self.contact_loads(e, q);
        self.sums(true, speed, mu, out);
        self.left_over(speed, rates, column)
    }

    /// Forces at another place for rates that are given: one film alone. The present place stays.
    fn loads_elsewhere(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        speed: f64,
        mu: f64,
        rates: &[f64],
        out: &mut SideLoads,
    ) -> Result<(), EvalError> {
        self.shape_gap(true, e, q, speed)?;
        out.contact = self.contact_loads(e, q);
        self.told.forget();
        let kept = std::mem::take(&mut self.p);
        self.p = std::mem::take(&mut self.open);
        let outcome = if self.superposition == Superposition::None {
            let filled = self.fill.clone();
            let r = self.solve_whole(true, speed, mu, rates);
            if r.is_ok() {
                self.sums(true, speed, mu, out);
            }
            self.fill = filled;
            r.map(|_| ())
        } else {
            self.combine_rates(true, rates);
            let n = self.nodes();
            let inp = film_input(&self.trial, n);
            let mode = FilmMode { u: -speed, dhdt: &self.rates, edge_pressure: [0.0; 4] };
            // Close to that of the present place.
            self.p.iter_mut().zip(&kept).for_each(|(p, kept)| *p = kept / mu);
            let r = self.film.solve_many(&inp, &[mode], &mut self.p).map(|_| ());
            self.evaluations += 1;
            let cut =
                if self.superposition == Superposition::CutOff { self.p_cav } else { f64::NEG_INFINITY };
            self.p.iter_mut().for_each(|p| *p = (mu * *p).max(cut));
            if r.is_ok() {
                self.sums(true, speed, mu, out);
            }
            r
        };
        self.open = std::mem::take(&mut self.p);
        self.p = kept;
        outcome
    }

    /// Flow per viscosity that the uncut pressures per viscosity leave over in the film beside the present place, into field `column` of `self.beside`.
    /// Whether the film's model can tell.
    fn left_over(&mut self, speed: f64, rates: &[f64], column: usize) -> Result<bool, EvalError> {
        self.combine_rates(true, rates);
        let n = self.nodes();
        let mode = FilmMode { u: -speed, dhdt: &self.rates, edge_pressure: [0.0; 4] };
        let out = &mut self.beside[column * n..(column + 1) * n];
        self.film.imbalance(&film_input(&self.trial, n), &mode, &self.raw, out)
    }
}
