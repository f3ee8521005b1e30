//! Links that are not rigid, between groups.

use gudgeon_core::kinds::{CouplingTorque, Line};

use super::groups::Groups;

/// A link that is not rigid.
#[derive(Debug, Clone)]
pub(super) struct Elastic {
    /// Link of the line.
    pub link: usize,
    /// Groups, and what an angle of each twists the link.
    pub groups: [usize; 2],
    pub scale: [f64; 2],
    /// Stiffness and damping; `None` when the law is not linear.
    pub law: Option<[f64; 2]>,
}

impl Elastic {
    /// All such links of a line, and the place of each link of the line among them.
    pub fn of_line(line: &Line, groups: &Groups) -> (Vec<Self>, Vec<Option<usize>>) {
        let ratio = |i: usize| line.nodes[i].ratio;
        let mut links = Vec::new();
        let mut number = vec![None; line.links.len()];
        for (l, link) in line.links.iter().enumerate() {
            let law = link.coupling.linear(0.0, 0.0);
            if law.stiffness == f64::INFINITY {
                continue;
            }
            let [a, b] = link.nodes;
            let gear = ratio(a) / ratio(b);
            number[l] = Some(links.len());
            links.push(Self {
                link: l,
                groups: [groups.of[a], groups.of[b]],
                scale: [groups.scale[a], gear * groups.scale[b]],
                law: link.coupling.is_linear().then_some([law.stiffness, law.damping]),
            });
        }
        (links, number)
    }

    /// Twist and rate of twist, or any pair of differences between the two ends.
    #[inline]
    pub fn twist(&self, theta: &[f64], omega: &[f64]) -> (f64, f64) {
        let ([a, b], [x, y]) = (self.groups, self.scale);
        (x * theta[a] - y * theta[b], x * omega[a] - y * omega[b])
    }

    /// Torque of the law of the line.
    pub fn torque(&self, line: &Line, theta: &[f64], omega: &[f64]) -> CouplingTorque {
        let (twist, rate) = self.twist(theta, omega);
        line.links[self.link].coupling.torque(twist, rate)
    }

    /// Scale of group `g`, scale of the other end, and the other end.
    pub fn ends(&self, g: usize) -> (f64, f64, usize) {
        if self.groups[0] == g {
            (self.scale[0], self.scale[1], self.groups[1])
        } else {
            (self.scale[1], self.scale[0], self.groups[0])
        }
    }
}
