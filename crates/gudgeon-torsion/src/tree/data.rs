//! The tree with its coefficients.

use gudgeon_core::kinds::Line;

/// Position of a node that is not there: the parent of the root.
pub(super) const NONE: usize = usize::MAX;

/// A shaft line in the order of elimination, with the coefficients of small vibration.
#[derive(Debug, Clone)]
pub struct Tree {
    /// Node of the line at each position.
    pub node: Vec<usize>,
    /// Position of each node of the line.
    pub position: Vec<usize>,
    /// Position of the parent, behind the own one; the last has none.
    pub parent: Vec<usize>,
    /// Link of the line towards the parent.
    pub link: Vec<usize>,
    /// Whether the link's first node is the child.
    pub forward: Vec<bool>,
    /// Speed ratio of the nodes.
    pub ratio: Vec<f64>,
    /// Speed ratio of the first node of the link towards the parent.
    pub link_ratio: Vec<f64>,
    /// Inertias times ratio² \[kg m²\].
    pub inertia: Vec<f64>,
    /// Damping against the ground times ratio² \[N m s/rad\].
    pub damping: Vec<f64>,
    /// Stiffness against the ground times ratio² \[N m/rad\].
    pub ground: Vec<f64>,
    /// Stiffness of the link towards the parent \[N m/rad\]; infinite when rigid; of the root: zero.
    pub k: Vec<f64>,
    /// Damping of the link towards the parent \[N m s/rad\].
    pub c: Vec<f64>,
    /// Loss factor of the link towards the parent.
    pub eta: Vec<f64>,
    /// Whether it is a chain: every parent stands right behind.
    pub chain: bool,
}

impl Tree {
    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.node.len()
    }

    /// Whether there is no node; never so for one that was built.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.node.is_empty()
    }

    /// Takes the coefficients of the links at angular frequency `omega` about mean torques by link (empty: none).
    pub fn linearise(&mut self, line: &Line, omega: f64, mean_torque: &[f64]) {
        for p in 0..self.len() {
            let l = self.link[p];
            if l == NONE {
                continue;
            }
            let mean = mean_torque.get(l).copied().unwrap_or(0.0);
            let v = line.links[l].coupling.linear(omega, mean);
            let r2 = self.link_ratio[p] * self.link_ratio[p];
            self.k[p] = v.stiffness * r2;
            self.c[p] = v.damping * r2;
            self.eta[p] = v.loss_factor;
        }
    }

    /// Whether any node is held against the ground.
    #[must_use]
    pub fn is_grounded(&self) -> bool {
        self.ground.iter().any(|g| *g != 0.0)
    }

    /// The sum of all inertias, as the reference shaft feels it \[kg m²\].
    #[must_use]
    pub fn total_inertia(&self) -> f64 {
        self.inertia.iter().sum()
    }

    /// The line as it is without damping.
    #[must_use]
    pub fn undamped(&self) -> Self {
        let n = self.len();
        Self { damping: vec![0.0; n], c: vec![0.0; n], eta: vec![0.0; n], ..self.clone() }
    }

    /// Whether the link of a position towards its parent is rigid.
    #[inline]
    pub(super) fn is_rigid(&self, position: usize) -> bool {
        self.parent[position] != NONE && self.k[position] == f64::INFINITY
    }
}
