//! The pin: evaluation, published search, exact optimum with its proof, sweeps.

mod evaluation;
mod exact;
mod published;
mod refusals;
mod sweeps;

use gudgeon_core::Stopwatch;
use gudgeon_core::kinds::PinSize;
use gudgeon_core::result::RunResult;

pub use refusals::impossible;

use crate::case::{Method, PinCase};
use crate::draw;
use crate::output::model;
use crate::setup::{Setup, sizes};
use gudgeon_scene::{Progress, RunError, Stopped};

/// Runs what the case asks of its pin.
pub fn run(
    case: &PinCase,
    s: &Setup,
    out: &mut RunResult,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<(), RunError> {
    let begin = Stopwatch::start();
    let d = s.design();
    let size = match &case.optimise {
        None => given(s)?,
        Some(o) if o.method == Method::AsPublished => published::published(&d, s, given(s)?, o, out)?,
        Some(o) => exact::exact(&d, s, o, out)?,
    };
    out.seconds.insert("solve".into(), begin.seconds());
    if case.optimise.is_none() {
        out.solver.method = "evaluation".into();
    }
    // What was found comes before how.
    let how = std::mem::take(&mut out.results);
    evaluation::evaluate(case, s, &d, &size, out)?;
    evaluation::loads(case, s, out);
    out.results.extend(how);
    draw::section(case, s, &size, out);
    draw::utilisation(&d, &size, out).map_err(model)?;
    if let Some(o) = &case.optimise {
        progress(Progress { phase: "sweeping the outer diameter".into(), fraction: 0.5 })?;
        sweeps::sweep(&d, s, o, out);
        progress(Progress { phase: "drawing the design map".into(), fraction: 0.8 })?;
        draw::map(&d, &size, out);
        for q in &o.pareto {
            sweeps::front(&d, *q, out);
        }
        if let Some(stock) = &o.stock {
            sweeps::from_stock(&d, &sizes(stock), &size, out);
        }
    }
    evaluation::cycle(case, s, &d, &size, out)
}

fn given(s: &Setup) -> Result<PinSize, RunError> {
    s.given.ok_or_else(|| RunError::Refused("the pin has no dimensions".into()))
}
