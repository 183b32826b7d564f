//! Errors of the library as exceptions of Python.

use pontoon::error::{Error, ErrorCode, ErrorKind};
use pyo3::{prelude::*, types::PyDict};

/// Returns the exception for `error`: the class that belongs to its kind, with code, place, remedy and fault.
pub fn exception(py: Python<'_>, error: &Error) -> PyErr {
    raised(py, error).unwrap_or_else(|other| other)
}

fn raised(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let class = match error.kind {
        ErrorKind::Scene => "SceneError",
        ErrorKind::File => "FileError",
        ErrorKind::Fault => "Fault",
        ErrorKind::Restart => "RestartError",
        ErrorKind::Usage if error.code() == ErrorCode::UnknownName => "UnknownNameError",
        _ => "UsageError",
    };
    let fields = PyDict::new(py);
    fields.set_item("code", error.code().as_str())?;
    fields.set_item("message", &error.message)?;
    fields.set_item("help", error.help.as_deref())?;
    if let Some(place) = &error.location {
        fields.set_item("file", Some(&place.file).filter(|file| !file.is_empty()))?;
        fields.set_item("line", place.line_column.map(|(line, _)| line))?;
        fields.set_item("column", place.line_column.map(|(_, column)| column))?;
        fields.set_item("key", Some(&place.key).filter(|key| !key.is_empty()))?;
    }
    if let Some(fault) = &error.fault {
        fields.set_item("reason", &fault.reason)?;
        fields.set_item("who", &fault.who)?;
        fields.set_item("step", fault.step)?;
        fields.set_item("time", fault.time)?;
        fields.set_item("position", &fault.position)?;
        fields.set_item("velocity", &fault.velocity)?;
        fields.set_item("density", fault.density)?;
        fields.set_item("cause", &fault.cause)?;
    }
    let value = py.import("pontoon._errors")?.getattr(class)?.call((error.to_string(),), Some(&fields))?;
    Ok(PyErr::from_value(value))
}

/// Turns the error of a result into an exception.
pub trait OrRaise<T> {
    /// Returns the value, or the exception for the error.
    fn or_raise(self, py: Python<'_>) -> PyResult<T>;
}

impl<T> OrRaise<T> for pontoon::Result<T> {
    fn or_raise(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| exception(py, &error))
    }
}

/// Returns the exception for a call that cannot be carried out.
pub fn usage(py: Python<'_>, what: &str, help: &str) -> PyErr {
    exception(py, &Error::new(ErrorKind::Usage, what).help(help))
}
