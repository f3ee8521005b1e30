use serde::{Deserialize, Serialize};

/// Which film thickness counts for the flow between two nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Flux {
    /// That halfway between them: the mean of both nodes, or what the caller gives. Second order in a full film.
    #[default]
    Face,
    /// The mean of the cubes of both nodes for the pressure flow, and the film at the node upstream for what the surface carries, as many
    /// published programs have it. First order.
    Node,
}
