//! `gudgeon check CASE`

use serde_json::json;

use crate::args::CheckArgs;
use crate::cmd::checked;
use crate::failure::Failure;
use crate::ui::Ui;

pub fn check(a: &CheckArgs, ui: &Ui) -> Result<(), Failure> {
    if a.json {
        return match gudgeon_scene::check(&a.case.case, &a.case.set) {
            Ok(c) => {
                let notes: Vec<String> =
                    c.notes.iter().cloned().chain(c.case.doubts().into_iter().map(|n| n.text)).collect();
                ui.json(&json!({ "case": c.name, "ok": true, "notes": notes, "mistakes": [] }));
                Ok(())
            }
            Err(report) => {
                ui.json(&json!({ "ok": false, "notes": [], "mistakes": report.to_json() }));
                Err(report.into())
            }
        };
    }
    let c = checked(&a.case.case, &a.case.set, ui)?;
    for doubt in c.case.doubts() {
        ui.note(&doubt.text);
    }
    ui.out(&format!("{}: ok", a.case.case.display()));
    Ok(())
}
