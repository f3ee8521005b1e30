//! Integration and validation tests: see the files in `tests`.
