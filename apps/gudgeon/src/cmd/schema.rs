//! `gudgeon schema`

use gudgeon_core::schemars::schema_for;
use gudgeon_sim::case::RingPackCase;

use crate::failure::Failure;
use crate::ui::Ui;

pub fn schema(ui: &Ui) -> Result<(), Failure> {
    ui.json(&schema_for!(RingPackCase).to_value());
    Ok(())
}
