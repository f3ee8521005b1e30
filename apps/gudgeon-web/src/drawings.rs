//! The scripts of the report as one function that the page calls again and again.

use gudgeon_report::{OVER_CYCLE, RUN_SCRIPTS};

/// The text of `reportScripts(document, location, addEventListener, scope)`: the scripts, with what they read from outside as arguments. Between the
/// first, which has the crank angle that all drawings share, and the others that angle is told to whoever draws again.
pub fn drawings() -> String {
    let (first, rest) = RUN_SCRIPTS.split_first().unwrap_or((&"", &[]));
    format!(
        "function reportScripts(document, location, addEventListener, scope) {{\nconst OVER_CYCLE = {};\n{first}\n{{ const Plain = Cycle; Cycle = class \
         extends Plain {{ constructor(...all) {{ super(...all); scope.cycle = this; }} }}; }}\n{}\n}}\n",
        OVER_CYCLE.trim_end(),
        rest.concat()
    )
}
