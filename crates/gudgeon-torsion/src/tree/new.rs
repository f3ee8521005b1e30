//! A line becomes a tree.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::Line;

use super::data::{NONE, Tree};
use super::order::{Order, order};

impl Tree {
    /// Orders a line for elimination. Links are linearised about zero mean torque at zero frequency (see [`Tree::linearise`]).
    ///
    /// # Errors
    /// No inertia, links that join a node with itself, close a loop or leave the line in pieces, ratios that are not numbers.
    pub fn new(line: &Line) -> Result<Self, BuildError> {
        let mut tree = Self::of_order(line, order(line)?);
        tree.take_nodes(line)?;
        tree.linearise(line, 0.0, &[]);
        tree.check_links()?;
        Ok(tree)
    }

    /// The topology: coefficients of nodes are empty, those of links zero.
    fn of_order(line: &Line, order: Order) -> Self {
        let n = order.nodes.len();
        let mut position = vec![0; n];
        for (p, &i) in order.nodes.iter().enumerate() {
            position[i] = p;
        }
        let first = |i: usize| match order.link[i] {
            NONE => None,
            l => Some(line.links[l].nodes[0]),
        };
        let parent_of = |i: usize| match order.parent[i] {
            NONE => NONE,
            j => position[j],
        };
        let parent: Vec<usize> = order.nodes.iter().map(|&i| parent_of(i)).collect();
        Self {
            chain: parent.iter().enumerate().all(|(p, &q)| q == p + 1 || q == NONE),
            parent,
            link: order.nodes.iter().map(|&i| order.link[i]).collect(),
            forward: order.nodes.iter().map(|&i| first(i) == Some(i)).collect(),
            ratio: order.nodes.iter().map(|&i| line.nodes[i].ratio).collect(),
            link_ratio: order.nodes.iter().map(|&i| first(i).map_or(1.0, |a| line.nodes[a].ratio)).collect(),
            inertia: Vec::new(),
            damping: Vec::new(),
            ground: Vec::new(),
            k: vec![0.0; n],
            c: vec![0.0; n],
            eta: vec![0.0; n],
            position,
            node: order.nodes,
        }
    }

    /// Coefficients of the nodes, checked.
    fn take_nodes(&mut self, line: &Line) -> Result<(), BuildError> {
        for (p, &i) in self.node.iter().enumerate() {
            let node = &line.nodes[i];
            let r2 = self.ratio[p] * self.ratio[p];
            for (name, v) in [
                ("inertia", line.mean_inertia(i)),
                ("damping", node.damping),
                ("ground", node.ground),
                ("ratio", node.ratio),
            ] {
                let bad = !v.is_finite()
                    || (name == "inertia" || name == "ground") && v < 0.0
                    || name == "ratio" && v == 0.0;
                if bad {
                    let what = format!("{name} of `{}` is {v}", node.name);
                    return Err(BuildError::at(format!("inertias.{i}.{name}"), what));
                }
            }
            self.inertia.push(line.mean_inertia(i) * r2);
            self.damping.push(node.damping * r2);
            self.ground.push(node.ground * r2);
        }
        if self.inertia.iter().all(|j| *j == 0.0) {
            return Err(BuildError::at("inertias", "all inertias are zero: nothing can vibrate"));
        }
        Ok(())
    }

    /// Refuses coefficients of links that are not numbers, and negative stiffness.
    fn check_links(&self) -> Result<(), BuildError> {
        for p in 0..self.len() {
            let (k, c, eta) = (self.k[p], self.c[p], self.eta[p]);
            if k.is_nan() || k < 0.0 || !c.is_finite() || !eta.is_finite() {
                let what = format!("stiffness {k}, damping {c}, loss factor {eta} cannot be");
                return Err(BuildError::at(format!("links.{}", self.link[p]), what));
            }
        }
        Ok(())
    }
}
