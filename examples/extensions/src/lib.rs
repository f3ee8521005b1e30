//! Plug-ins outside of Gudgeon, one file each.
