//! Values that cross the border.

use gudgeon_core::result::{Column, Series};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict, PyList};
use serde_json::Value;

/// A tree of JSON as Python's dictionaries, lists, texts and numbers.
///
/// # Errors
/// Python has no memory left.
pub fn to_python(py: Python<'_>, value: &Value) -> PyResult<Py<PyAny>> {
    match value {
        Value::Null => Ok(py.None()),
        Value::Bool(b) => b.into_py_any(py),
        Value::String(s) => s.into_py_any(py),
        Value::Number(n) => match n.as_i64() {
            Some(whole) => whole.into_py_any(py),
            None => n.as_f64().into_py_any(py),
        },
        Value::Array(all) => {
            let list = PyList::empty(py);
            for v in all {
                list.append(to_python(py, v)?)?;
            }
            list.into_py_any(py)
        }
        Value::Object(all) => {
            let dict = PyDict::new(py);
            for (k, v) in all {
                dict.set_item(k, to_python(py, v)?)?;
            }
            dict.into_py_any(py)
        }
    }
}

/// Numbers as bytes that NumPy takes without a further copy.
///
/// # Errors
/// Python has no memory left.
pub fn numbers<'py>(py: Python<'py>, values: &[f64]) -> PyResult<Bound<'py, PyByteArray>> {
    PyByteArray::new_with(py, size_of_val(values), |bytes| {
        for (to, v) in bytes.chunks_exact_mut(size_of::<f64>()).zip(values) {
            to.copy_from_slice(&v.to_ne_bytes());
        }
        Ok(())
    })
}

/// Name and unit of every column of a table, its axis first.
pub fn columns(table: &Series) -> Vec<(&str, &str)> {
    all(table).map(|c| (c.name.as_str(), c.unit.as_str())).collect()
}

/// Axis and columns.
pub fn all(table: &Series) -> impl Iterator<Item = &Column> {
    std::iter::once(&table.axis).chain(&table.columns)
}
