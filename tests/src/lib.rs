//! Integration and validation tests.
