//! The native part of the Python package `gudgeon`: cases, runs and results as objects. Everything a person meets is written in Python, in
//! `python/gudgeon` beside this folder; what crosses the border are plain values, lists of `--set` arguments, and numbers as bytes.

mod case;
mod compare;
mod errors;
mod interrupt;
mod many;
mod result;
mod study;
mod values;

use pyo3::prelude::*;

/// What the package `gudgeon` builds on. Its interface may change with every version.
#[pymodule(name = "_native")]
mod native {
    use gudgeon_case::{Diagnostic, catalogue};
    use gudgeon_core::Registry;
    use gudgeon_numerics::table::Pchip;
    use gudgeon_scene::{case_schemas, scenes};
    use pyo3::exceptions::PyValueError;
    use pyo3::prelude::*;
    use pyo3::types::PyByteArray;

    use crate::errors::unknown;
    use crate::values::{numbers, to_python};

    #[pymodule_export]
    use crate::case::Case;
    #[pymodule_export]
    use crate::compare::compare;
    #[pymodule_export]
    use crate::result::Outcome;
    #[pymodule_export]
    use crate::study::Study;
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        gudgeon_models::link();
        Ok(())
    }

    /// Cases that come with the package.
    const EXAMPLES: [(&str, &str); 4] = [
        ("compressor-6-throw", include_str!("../../../cases/compressor-6-throw.toml")),
        ("pin-85-alcohol", include_str!("../../../cases/pin-85-alcohol.toml")),
        ("slider-straight", include_str!("../../../cases/rigs/slider-straight.toml")),
        ("turbo-diesel-120", include_str!("../../../cases/turbo-diesel-120.toml")),
    ];

    /// Which columns form a figure over the cycle, as JSON.
    #[pyfunction]
    const fn over_cycle() -> &'static str {
        gudgeon_report::OVER_CYCLE
    }

    /// The text of a case that comes with the package.
    #[pyfunction]
    fn example(name: &str) -> PyResult<&'static str> {
        let found = EXAMPLES.iter().find(|(n, _)| *n == name).map(|(_, text)| *text);
        found.ok_or_else(|| {
            let help = gudgeon_case::advice(name, &EXAMPLES.map(|(n, _)| n));
            unknown(Diagnostic::new(format!("no example is called `{name}`")).help(help))
        })
    }

    /// The monotone cubic of Gudgeon's tables through rows, at other places; with a period, the rows repeat.
    #[pyfunction]
    fn interpolated<'py>(
        py: Python<'py>,
        x: Vec<f64>,
        y: Vec<f64>,
        period: Option<f64>,
        at: Vec<f64>,
    ) -> PyResult<Bound<'py, PyByteArray>> {
        let curve = match period {
            Some(p) => Pchip::periodic(x, y, p),
            None => Pchip::new(x, y),
        };
        let curve = curve.map_err(|e| PyValueError::new_err(e.to_string()))?;
        numbers(py, &at.into_iter().map(|x| curve.value(x)).collect::<Vec<_>>())
    }

    /// Kinds with their models, of one kind or of all.
    #[pyfunction]
    fn kinds(py: Python<'_>, kind: Option<&str>) -> PyResult<Py<PyAny>> {
        let registry = Registry::collect();
        let wanted = match kind {
            Some(name) => vec![catalogue::kind(&registry, name).map_err(unknown)?],
            None => registry.kinds().collect(),
        };
        let all: Vec<_> = wanted.into_iter().map(|k| catalogue::of_kind(&registry, k)).collect();
        to_python(py, &all.into())
    }

    /// Everything known of one model.
    #[pyfunction]
    fn model(py: Python<'_>, what: &str) -> PyResult<Py<PyAny>> {
        let registry = Registry::collect();
        let m = catalogue::model(&registry, what).map_err(unknown)?;
        to_python(py, &catalogue::of_model(&registry, m, &case_schemas()))
    }

    /// Names and summaries of all scenes.
    #[pyfunction]
    fn scene_names() -> Vec<(&'static str, &'static str)> {
        scenes().iter().map(|s| (s.name, s.summary)).collect()
    }
}
