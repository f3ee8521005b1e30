//! Asperity and boundary contact.
