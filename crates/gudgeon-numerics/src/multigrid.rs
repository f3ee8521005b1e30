//! Five-point matrices on a rectangular grid, and a multigrid solver for them.

mod coarsen;
mod five_point;
mod krylov;
mod level;

use crate::elementary;
use crate::linalg::Singular;
pub use five_point::{FivePoint, Role, Row};
use five_point::{larger, max_abs};
use krylov::{DIRECTIONS, Krylov};
use level::Level;

/// How a [`LineMultigrid::solve`] ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycles {
    /// Cycles done.
    pub cycles: usize,
    /// Largest residual at the end.
    pub residual: f64,
    /// Largest residual at the end over that at the start, to the power of one over the cycles: the mean convergence factor.
    pub rate: f64,
}

impl Cycles {
    fn set_rate(&mut self, start: f64) {
        if self.cycles > 0 && start > 0.0 {
            self.rate = elementary::powf(self.residual / start, 1.0 / self.cycles as f64);
        }
    }
}

/// Multigrid for [`FivePoint`] matrices: whole lines along `x` are solved exactly, odd ones and even ones in turn, and every grid keeps the
/// even lines of the one before, down to a single line.
///
/// Lines take care of strong diffusion along `x`, coarsening across of strong diffusion along `y`: the convergence does not depend on the
/// ratio of the two, nor on jumps of the coefficients across lines. Unknowns that are carried along the lines
/// ([`Role::Carried`]) are solved with them.
///
/// After Schaffer 1998 (semicoarsening with line relaxation), with the coefficients of the coarse grids lumped to five points.
#[derive(Debug, Clone)]
pub struct LineMultigrid {
    levels: Vec<Level>,
    /// Whether the matrix carries unknowns along lines.
    carries: bool,
    krylov: Krylov,
}

impl LineMultigrid {
    /// Work space for a grid of `ny` lines of `nx` nodes: some 60 values per node.
    #[must_use]
    pub fn new(nx: usize, ny: usize, periodic: bool) -> Self {
        // A line of one node has no neighbour, not itself.
        let periodic = periodic && nx > 1;
        let mut levels = vec![Level::new(nx, ny, periodic)];
        let mut lines = ny;
        while lines > 1 {
            lines = lines.div_ceil(2);
            levels.push(Level::new(nx, lines, periodic));
        }
        Self { levels, carries: false, krylov: Krylov::new(nx * ny) }
    }

    /// Prepares the solution of systems with this matrix.
    ///
    /// # Errors
    /// [`Singular`] when a line has no solution of its own.
    ///
    /// # Panics
    /// When the matrix is not of the size this was made for.
    pub fn setup(&mut self, m: &FivePoint) -> Result<(), Singular> {
        let fine = &mut self.levels[0];
        let (nx, ny) = (fine.nx, fine.ny);
        assert!(m.nx == nx && m.ny == ny && (m.periodic && nx > 1) == fine.periodic, "another grid");
        let carries = m.role.contains(&Role::Carried);
        // Eight columns at a time: each side of the transposition stays in the cache.
        for block in (0..nx).step_by(8) {
            for j in 0..ny {
                let place = fine.place(j);
                for i in block..nx.min(block + 8) {
                    let (k, t) = (j * nx + i, i * ny + place);
                    fine.gx[t] = m.gx[k];
                    fine.gy[t] = m.gy[k];
                    fine.role[t] = m.role[k];
                    if carries {
                        fine.qx[t] = m.qx[k];
                        fine.hold[t] = m.hold[k];
                    }
                }
            }
        }
        self.carries = carries;
        fine.couple(carries);
        fine.eliminate()?;
        for l in 1..self.levels.len() {
            let (fine, coarse) = self.levels.split_at_mut(l);
            fine[l - 1].coarsen(&mut coarse[0], carries);
            coarse[0].couple(carries);
            coarse[0].eliminate()?;
        }
        Ok(())
    }

    /// Improves `v` until no residual is larger than `target`, for at most `max_cycles` cycles, or until they stop helping. Where unknowns are
    /// carried, or cycles alone are slow, the cycles precondition a minimisation of the residual (GCR, Eisenstat, Elman and Schultz 1983).
    pub fn solve(&mut self, b: &[f64], v: &mut [f64], target: f64, max_cycles: usize) -> Cycles {
        if self.carries {
            return self.minimise(b, v, target, max_cycles);
        }
        let plain = self.repeat(b, v, target, max_cycles);
        if plain.residual <= target || plain.cycles >= max_cycles || !plain.residual.is_finite() {
            return plain;
        }
        let more = self.minimise(b, v, target, max_cycles - plain.cycles);
        Cycles { cycles: plain.cycles + more.cycles, ..more }
    }

    /// Cycles alone.
    fn repeat(&mut self, b: &[f64], v: &mut [f64], target: f64, max_cycles: usize) -> Cycles {
        self.levels[0].load(b, v);
        let (mut start, mut out) = (f64::NAN, Cycles { cycles: 0, residual: f64::INFINITY, rate: 0.0 });
        loop {
            let largest = Self::descend(&mut self.levels, 0);
            if start.is_nan() {
                start = largest;
            }
            let slow = out.cycles > 4 && largest > 0.5 * out.residual;
            out.residual = largest;
            if largest <= target || out.cycles >= max_cycles || slow || !largest.is_finite() {
                break;
            }
            Self::correct(&mut self.levels, 0);
            out.cycles += 1;
        }
        out.set_rate(start);
        let fine = &self.levels[0];
        fine.gather(&fine.v, v);
        out
    }

    /// Cycles as a preconditioner of the minimisation of the residual.
    fn minimise(&mut self, b: &[f64], v: &mut [f64], target: f64, max_cycles: usize) -> Cycles {
        let mut out = Cycles { cycles: 0, residual: f64::INFINITY, rate: 0.0 };
        self.start_krylov(b, v);
        let start = max_abs(&self.krylov.r);
        out.residual = start;
        let mut last = start;
        let mut kept = 0;
        while out.residual > target && out.cycles < max_cycles && out.residual.is_finite() {
            let now = out.cycles % DIRECTIONS;
            // A round of all directions that brought less than a tenth is the end of what can be had.
            if now == 0 && out.cycles > 0 {
                if out.residual > 0.9 * last {
                    break;
                }
                last = out.residual;
            }
            self.direction(now);
            out.cycles += 1;
            let k = &mut self.krylov;
            if k.orthogonalise(now) <= 0.0 {
                break;
            }
            k.descend(now);
            kept = now + 1;
            out.residual = max_abs(&k.r);
            if kept == DIRECTIONS {
                k.move_along(kept);
                kept = 0;
            }
        }
        self.krylov.move_along(kept);
        out.set_rate(start);
        let (fine, solution) = (&self.levels[0], &self.krylov.v);
        fine.gather(solution, v);
        out
    }

    /// Solution and residual at the start of the minimisation.
    fn start_krylov(&mut self, b: &[f64], v: &[f64]) {
        let (fine, k) = (&self.levels[0], &mut self.krylov);
        fine.scatter(v, &mut k.v);
        fine.scatter(b, &mut k.r);
        for (v, role) in k.v.iter_mut().zip(&fine.role) {
            if *role == Role::Fixed {
                *v = 0.0;
            }
        }
        fine.apply(&k.v, &mut k.q[0]);
        for m in 0..k.r.len() {
            k.r[m] = if fine.role[m] == Role::Fixed { 0.0 } else { k.r[m] - k.q[0][m] };
        }
    }

    /// A search direction: what a cycle makes of the residual, and what the matrix makes of that.
    fn direction(&mut self, now: usize) {
        let fine = &mut self.levels[0];
        fine.b.copy_from_slice(&self.krylov.r);
        fine.v.fill(0.0);
        Self::descend(&mut self.levels, 0);
        Self::correct(&mut self.levels, 0);
        let (fine, k) = (&self.levels[0], &mut self.krylov);
        k.z[now].copy_from_slice(&fine.v);
        fine.apply(&k.z[now], &mut k.q[now]);
    }

    /// Solves the odd lines of a level, and hands the residual of the even ones to the next. Returns the largest of them.
    fn descend(levels: &mut [Level], l: usize) -> f64 {
        let (head, tail) = levels.split_at_mut(l + 1);
        let level = &mut head[l];
        level.relax(true);
        let Some(coarse) = tail.first_mut() else { return level.line_residual() };
        let mut largest = 0.0_f64;
        for i in 0..level.nx {
            for k in 0..level.even {
                let m = i * level.ny + k;
                // Rows of fixed nodes have no inverse pivot.
                let r = if level.d[m] == 0.0 { 0.0 } else { level.even_residual(i, k) };
                largest = larger(largest, r.abs());
                let t = i * coarse.ny + coarse.place(k);
                coarse.b[t] = r;
            }
        }
        largest
    }

    /// Coarse correction and the lines once more, odd ones first: they carry the correction to where the coarse grid has no node.
    fn correct(levels: &mut [Level], l: usize) {
        if l + 1 < levels.len() {
            let coarsest = l + 2 == levels.len();
            let next = &mut levels[l + 1];
            next.v.fill(0.0);
            if !coarsest {
                next.relax(false);
                Self::descend(levels, l + 1);
            }
            Self::correct(levels, l + 1);
            let (head, tail) = levels.split_at_mut(l + 1);
            let (level, coarse) = (&mut head[l], &tail[0]);
            for i in 0..level.nx {
                for k in 0..level.even {
                    level.v[i * level.ny + k] += coarse.v[i * coarse.ny + coarse.place(k)];
                }
            }
        }
        let level = &mut levels[l];
        level.relax(true);
        level.relax(false);
    }
}
