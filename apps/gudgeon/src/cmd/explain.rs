//! `gudgeon explain CASE`

use crate::args::CheckArgs;
use crate::cmd::checked;
use crate::failure::Failure;
use crate::ui::Ui;

pub fn explain(a: &CheckArgs, ui: &Ui) -> Result<(), Failure> {
    let c = checked(&a.case.case, &a.case.set, ui)?;
    let explanation = gudgeon_scene::explain(&c)?;
    if a.json {
        let value = serde_json::to_value(&explanation).map_err(|e| Failure::Run(e.to_string()))?;
        ui.json(&value);
    } else {
        ui.out(&explanation.to_text());
    }
    Ok(())
}
