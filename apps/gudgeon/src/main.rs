//! The Gudgeon command line.
fn main() {}
