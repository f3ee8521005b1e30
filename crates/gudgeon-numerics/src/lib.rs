//! Fallible stiff integrators, periodic-orbit solver, roots, tables and small linear algebra.
