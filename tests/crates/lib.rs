//! Tests of the crates stand in folders of their own. Here is the example of `gudgeon-macros`: a test of that crate would be built with all it needs for the machine that builds.
#![cfg_attr(doctest, doc = include_str!("../../crates/gudgeon-macros/README.md"))]
