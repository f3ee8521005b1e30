//! Axial motion of rings in their grooves, groove oil and flank friction.
