//! Inertias that rigid links join.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{Line, LineThrow};

use crate::tree::Tree;

/// An inertia of a crank below this part of its mean vanishes.
const VANISHES: f64 = 1e-6;

/// Groups of inertias on rigid links: the angle of inertia i is `scale[i]` times that of its group.
#[derive(Debug, Clone)]
pub(super) struct Groups {
    /// Group of each inertia.
    pub of: Vec<usize>,
    /// Angle of each inertia by that of its group.
    pub scale: Vec<f64>,
    /// First inertia of each group in the order of the line, so that a line without rigid links keeps its order.
    pub first: Vec<usize>,
    /// Groups in the order of elimination, each with the position of the inertia nearest to the root.
    pub heads: Vec<(usize, usize)>,
}

/// Constant coefficients of the groups: sums over their inertias, each times `scale²`.
#[derive(Debug, Clone)]
pub(super) struct Coefficients {
    /// Inertia without that of throws that varies \[kg m²\].
    pub inertia: Vec<f64>,
    /// Damping against the ground \[N m s/rad\].
    pub damping: Vec<f64>,
    /// Stiffness against the ground \[N m/rad\].
    pub ground: Vec<f64>,
    /// Inertia with the mean of all throws \[kg m²\].
    mean: Vec<f64>,
}

impl Groups {
    pub fn new(line: &Line, tree: &Tree) -> Self {
        let n = tree.len();
        let mut head: Vec<usize> = (0..n).collect();
        for p in (0..n).rev() {
            if tree.parent[p] < n && tree.k[p] == f64::INFINITY {
                head[p] = head[tree.parent[p]];
            }
        }
        let mut of_head = vec![usize::MAX; n];
        let mut first = Vec::new();
        let mut of = vec![0; n];
        for i in 0..n {
            let h = head[tree.position[i]];
            if of_head[h] == usize::MAX {
                of_head[h] = first.len();
                first.push(i);
            }
            of[i] = of_head[h];
        }
        let ratio = |i: usize| line.nodes[i].ratio;
        Self {
            scale: (0..n).map(|i| ratio(i) / ratio(first[of[i]])).collect(),
            heads: (0..n).filter(|&p| head[p] == p).map(|p| (of_head[p], p)).collect(),
            of,
            first,
        }
    }

    /// Number of groups.
    pub fn len(&self) -> usize {
        self.first.len()
    }

    /// Sums of the inertias.
    ///
    /// # Errors
    /// A group without inertia, or one whose inertia vanishes at an angle of its crank.
    pub fn coefficients(&self, line: &Line) -> Result<Coefficients, BuildError> {
        let zero = || vec![0.0; self.len()];
        let mut c = Coefficients { inertia: zero(), damping: zero(), ground: zero(), mean: zero() };
        for (i, node) in line.nodes.iter().enumerate() {
            let (g, square) = (self.of[i], self.scale[i] * self.scale[i]);
            c.inertia[g] += square * node.inertia;
            c.damping[g] += square * node.damping;
            c.ground[g] += square * node.ground;
            c.mean[g] += square * line.mean_inertia(i);
        }
        for t in line.throws.iter().filter(|t| t.inertia.is_constant()) {
            c.inertia[self.of[t.node]] += self.scale[t.node] * self.scale[t.node] * t.inertia.mean();
        }
        if let Some(g) = c.mean.iter().position(|j| *j <= 0.0) {
            let i = self.first[g];
            let what = format!("the inertia of `{}` is zero: motion over time wants one", line.nodes[i].name);
            return Err(BuildError::at(format!("inertias.{i}"), what).help(
                "join it to its neighbour by a rigid link (coupling `off`), or make one shaft of the two beside it (1/k = 1/k1 + 1/k2)",
            ));
        }
        if let Some(g) = (0..self.len()).find(|g| self.vanishes(line, &c, *g)) {
            let i = self.first[g];
            let what = format!("the inertia of `{}` vanishes at an angle of its crank", line.nodes[i].name);
            return Err(BuildError::at(format!("inertias.{i}"), what).help("give the crank its inertia"));
        }
        Ok(c)
    }

    /// Whether the inertia of a group vanishes at an angle: a crank without inertia stands still with its piston at the dead centres.
    fn vanishes(&self, line: &Line, c: &Coefficients, group: usize) -> bool {
        let varying: Vec<&LineThrow> =
            line.throws.iter().filter(|t| self.of[t.node] == group && !t.inertia.is_constant()).collect();
        if varying.is_empty() {
            return false;
        }
        let inertia = |angle: f64| {
            let of_throw = |t: &&LineThrow| {
                let s = self.scale[t.node];
                s * s * t.inertia.inertia(s * angle + t.phase).0
            };
            c.inertia[group] + varying.iter().map(of_throw).sum::<f64>()
        };
        let dead = varying.iter().flat_map(|t| [0.0, PI].map(|a| (a - t.phase) / self.scale[t.node]));
        let grid = (0..720).map(|i| PI / 360.0 * f64::from(i));
        let minimum = grid.chain(dead).map(inertia).fold(f64::INFINITY, f64::min);
        minimum.is_nan() || minimum <= VANISHES * c.mean[group]
    }

    /// Angles or speeds of the groups from those of the inertias, which rigid links have agree.
    pub fn condense(&self, of_nodes: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        for (i, v) in of_nodes.iter().enumerate().rev() {
            out[self.of[i]] = v / self.scale[i];
        }
        out
    }

    /// Angles or speeds of the inertias from those of the groups.
    pub fn expand(&self, of_groups: &[f64]) -> Vec<f64> {
        self.of.iter().zip(&self.scale).map(|(g, s)| s * of_groups[*g]).collect()
    }
}
