//! Inter-ring gas flow.
