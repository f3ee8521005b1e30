//! The inputs of a film along a line, checked and turned into the direction of sliding.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Film1dIn, FilmEnd, FilmTime, PanelFactors};

use super::line::{Change, Line, volumes};

impl Line {
    /// Takes the inputs, turned into the direction of sliding, and computes the coefficients of the panels. With `clip` an end
    /// pressure below `p_cav` counts as `p_cav`.
    pub fn enter(&mut self, inp: &Film1dIn<'_>, clip: bool) -> Result<(), EvalError> {
        self.check_sizes(inp)?;
        let [first, last] = inp.ends.map(FilmEnd::pressure);
        if !(first + last + inp.p_cav + inp.u).is_finite() {
            return Err(self.fatal(format!(
                "these are no film: sliding {} m/s, ends {first} and {last} Pa, cavitation {} Pa",
                inp.u, inp.p_cav
            )));
        }
        self.turn(inp.u < 0.0);
        self.u = inp.u.abs();
        self.p_cav = inp.p_cav;
        self.enter_gap(inp)?;
        self.enter_roughness(inp.factors)?;
        self.coefficients();
        let floor = if clip { 0.0 } else { f64::NEG_INFINITY };
        let (p0, p1) = ((first - inp.p_cav).max(floor), (last - inp.p_cav).max(floor));
        (self.p_in, self.p_out) = if self.turned { (p1, p0) } else { (p0, p1) };
        self.supply = match inp.ends[usize::from(self.turned)] {
            FilmEnd::Flooded { .. } => None,
            FilmEnd::Starved { h_oil, .. } if h_oil.is_finite() && h_oil >= 0.0 => Some(self.u * h_oil),
            FilmEnd::Starved { h_oil, .. } => {
                return Err(self.fatal(format!("no layer of oil is {h_oil} m thick")));
            }
        };
        self.lead = 0;
        self.starved = false;
        self.enter_time(&inp.time)
    }

    fn check_sizes(&self, inp: &Film1dIn<'_>) -> Result<(), EvalError> {
        let n = self.n;
        let fits = inp.h_a.len() == n
            && inp.h_b.len() == n
            && inp.mu.len() == n
            && inp.factors.is_none_or(|f| f.len() == n);
        if fits {
            Ok(())
        } else {
            Err(self.fatal(format!("film, viscosity and roughness must be given for each of {n} panels")))
        }
    }

    /// Turns the coordinates into the direction of sliding, when that has changed.
    fn turn(&mut self, turned: bool) {
        if turned == self.turned {
            return;
        }
        self.turned = turned;
        if turned {
            self.x.iter_mut().zip(self.nodes.iter().rev()).for_each(|(x, n)| *x = -n);
        } else {
            self.x.copy_from_slice(&self.nodes);
        }
        self.dx.iter_mut().zip(self.x.windows(2)).for_each(|(d, w)| *d = w[1] - w[0]);
        self.per_dx.iter_mut().zip(&self.dx).for_each(|(r, d)| *r = 1.0 / d);
    }

    fn enter_gap(&mut self, inp: &Film1dIn<'_>) -> Result<(), EvalError> {
        if self.turned {
            copy_back(&mut self.ha, inp.h_b);
            copy_back(&mut self.hb, inp.h_a);
            copy_back(&mut self.mu, inp.mu);
        } else {
            self.ha.copy_from_slice(inp.h_a);
            self.hb.copy_from_slice(inp.h_b);
            self.mu.copy_from_slice(inp.mu);
        }
        // A comparison with what is not a number is false, and a sum with it is not finite.
        let positive = |v: &[f64]| v.iter().fold(true, |ok, x| ok & (*x > 0.0));
        let sum = |v: &[f64]| v.iter().sum::<f64>();
        if !(sum(&self.ha) + sum(&self.hb) + sum(&self.mu)).is_finite() || !positive(&self.mu) {
            return Err(self.fatal("film thickness and viscosity must be finite, viscosity positive"));
        }
        if !positive(&self.ha) || !positive(&self.hb) {
            let smallest = self.ha.iter().chain(&self.hb).copied().fold(f64::INFINITY, f64::min);
            return Err(self.recoverable(format!("a film of {smallest} m leaves no gap")));
        }
        Ok(())
    }

    fn enter_roughness(&mut self, factors: Option<&[PanelFactors]>) -> Result<(), EvalError> {
        let Some(factors) = factors else {
            if !self.smooth {
                self.rough.fill(PanelFactors::SMOOTH);
                self.smooth = true;
            }
            return Ok(());
        };
        let bad = |f: &PanelFactors| {
            let shear = f.sliding_shear + f.pressure_shear + f.shear_difference;
            let all = f.pressure_flow + f.sliding_flow + shear;
            !all.is_finite() || f.pressure_flow <= 0.0 || f.sliding_flow < 0.0
        };
        if factors.iter().any(bad) {
            return Err(self.fatal("roughness factors must be finite, that of the pressure flow positive"));
        }
        self.smooth = false;
        if self.turned {
            copy_back(&mut self.rough, factors);
        } else {
            self.rough.copy_from_slice(factors);
        }
        Ok(())
    }

    fn enter_time(&mut self, time: &FilmTime<'_>) -> Result<(), EvalError> {
        let n = self.n;
        self.change = match time {
            FilmTime::Steady => Change::Steady,
            FilmTime::Squeeze(v) => {
                if v.len() != n || !v.iter().sum::<f64>().is_finite() {
                    return Err(
                        self.fatal(format!("a finite squeeze velocity is needed for each of {n} panels"))
                    );
                }
                self.rate.fill(0.0);
                for i in 0..n {
                    let half = 0.5 * self.dx[i] * if self.turned { v[n - 1 - i] } else { v[i] };
                    self.rate[i] += half;
                    self.rate[i + 1] += half;
                }
                if self.rate.iter().all(|r| *r == 0.0) { Change::Steady } else { Change::Rates }
            }
            FilmTime::Step { dt, content } => {
                if !(dt.is_finite() && *dt > 0.0) {
                    return Err(self.fatal(format!("a step of {dt} s is none")));
                }
                let sum: f64 = content.iter().sum();
                if content.len() != n + 1 || !sum.is_finite() || content.iter().any(|c| *c < 0.0) {
                    return Err(
                        self.fatal(format!("the oil at each of {} nodes must be zero or more", n + 1))
                    );
                }
                if self.turned {
                    copy_back(&mut self.before, content);
                } else {
                    self.before.copy_from_slice(content);
                }
                volumes(&self.dx, &self.ha, &self.hb, &mut self.volume);
                Change::Step(*dt)
            }
        };
        Ok(())
    }

    /// Conductance and sliding flux of the panels.
    fn coefficients(&mut self) {
        let n = self.n;
        let (ha, hb, dx, mu) = (&self.ha[..n], &self.hb[..n], &self.dx[..n], &self.mu[..n]);
        let (g, d, c) = (&mut self.g[..n], &mut self.d[..n], &mut self.c[..n]);
        for i in 0..n {
            let (product, sum) = (ha[i] * hb[i], ha[i] + hb[i]);
            let resistance = 6.0 * mu[i] * dx[i] * sum;
            let square = product * product;
            g[i] = square / resistance;
            d[i] = resistance / square;
            c[i] = self.u * product / sum;
        }
        self.thick.copy_from_slice(mu);
        if !self.smooth {
            for i in 0..n {
                let f = &self.rough[i];
                self.thick[i] /= f.pressure_flow;
                g[i] *= f.pressure_flow;
                d[i] /= f.pressure_flow;
                c[i] *= f.sliding_flow;
            }
        }
    }
}

fn copy_back<T: Copy>(to: &mut [T], from: &[T]) {
    to.iter_mut().zip(from.iter().rev()).for_each(|(t, f)| *t = *f);
}
