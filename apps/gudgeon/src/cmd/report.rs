//! `gudgeon report DIR`

use crate::args::ReportArgs;
use crate::failure::Failure;
use crate::ui::Ui;

pub fn report(a: &ReportArgs, ui: &Ui) -> Result<(), Failure> {
    let page = gudgeon_report::rewrite(&a.dir)?;
    ui.out(&page.display().to_string());
    Ok(())
}
