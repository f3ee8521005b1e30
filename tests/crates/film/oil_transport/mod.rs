//! Oil on the liner.

mod carried;
mod lands;
mod side;
