//! The order of elimination of a line: every node before its parent.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::Line;

use super::data::NONE;

/// Nodes in the order of elimination, with parents and links by node of the line.
#[derive(Debug)]
pub(super) struct Order {
    /// Nodes by position; the last one is the root.
    pub nodes: Vec<usize>,
    /// Parent of each node.
    pub parent: Vec<usize>,
    /// Link of each node towards its parent.
    pub link: Vec<usize>,
}

/// Orders the nodes of a line.
pub(super) fn order(line: &Line) -> Result<Order, BuildError> {
    let n = line.nodes.len();
    if n == 0 {
        return Err(BuildError::at("inertias", "a shaft line needs at least one inertia"));
    }
    let neighbours = neighbours(line)?;
    // The root is the last node that ends the line, so that a chain keeps its order.
    let root = (0..n).rev().find(|&i| neighbours[i].len() <= 1).unwrap_or(n - 1);
    let mut found = Order { nodes: Vec::with_capacity(n), parent: vec![NONE; n], link: vec![NONE; n] };
    let mut seen = vec![false; n];
    let mut stack = vec![root];
    seen[root] = true;
    while let Some(i) = stack.pop() {
        found.nodes.push(i);
        for &(j, l) in &neighbours[i] {
            if l == found.link[i] {
                continue;
            }
            if seen[j] {
                let what = format!(
                    "`{}` closes a loop of links: only lines with branches are treated, a link joins two parts that nothing else joins",
                    line.links[l].name
                );
                return Err(BuildError::at(format!("links.{l}"), what));
            }
            seen[j] = true;
            found.parent[j] = i;
            found.link[j] = l;
            stack.push(j);
        }
    }
    if let Some(lost) = seen.iter().position(|s| !s) {
        let what = format!("`{}` is not connected with the rest", line.nodes[lost].name);
        return Err(BuildError::at(format!("inertias.{lost}"), what)
            .help("a link joins two inertias; every inertia needs one"));
    }
    found.nodes.reverse();
    Ok(found)
}

/// Neighbours of each node, with the link to each.
fn neighbours(line: &Line) -> Result<Vec<Vec<(usize, usize)>>, BuildError> {
    let n = line.nodes.len();
    let mut at = vec![Vec::new(); n];
    for (l, link) in line.links.iter().enumerate() {
        let [a, b] = link.nodes;
        if a == b || a >= n || b >= n {
            let what = format!("`{}` joins an inertia with itself or with none", link.name);
            return Err(BuildError::at(format!("links.{l}"), what));
        }
        at[a].push((b, l));
        at[b].push((a, l));
    }
    Ok(at)
}
