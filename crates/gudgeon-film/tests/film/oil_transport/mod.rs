//! Oil on the liner.

mod carried;
