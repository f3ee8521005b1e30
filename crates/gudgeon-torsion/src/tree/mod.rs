//! The one data structure behind everything here: a shaft line as a tree in the order of its elimination.
//!
//! Angles are divided by the speed ratio of their inertia, `φ = θ/ratio`, so that the rigid motion is `φ = const` and gears leave no
//! trace but in the coefficients. Every node but the last (the root) has one link to its parent, which stands behind it. A
//! branch is then known to the rest by its dynamic stiffness alone,
//!
//! ```text
//! S_i = g_i + z c_i + z² J_i + Σ_children κ_c S_c/(κ_c + S_c),      κ = k (1 + iη) + z d
//! ```
//!
//! with `z = iω` for forced vibration, any `z` for damped eigenvalues and `z² = -λ` for undamped ones. One pass from the leaves to the
//! root is an elimination (`D_i = κ_i + S_i` are its pivots), one pass back the solution: both grow linearly with the number of
//! inertias, for chains and trees alike.
//!
//! Spring and branch come in as springs in series, never as the difference of large numbers. A link of any stiffness is therefore
//! as good as any other: a rigid one passes `S` on as it is (`κ S/(κ+S) → S`), an inertia of zero adds nothing, and neither has to be
//! removed first. Rounding in this recursion equals relative changes of a few ulps of single inertias and stiffnesses, so the number of
//! negative pivots at `z² = -λ`, which is the number of eigenvalues below λ (Sylvester), places even the smallest eigenvalue to a
//! relative accuracy that does not know the ratio of the stiffnesses.

mod characteristic;
mod data;
mod new;
mod order;
mod solve;

pub use data::Tree;
pub use solve::{Resonance, Singular, Work};
