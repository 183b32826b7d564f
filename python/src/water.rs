//! Arrays of the water: copies, and read-only arrays on its memory.

use std::{
    slice,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
};

use numpy::{
    Element, PyArray1, PyArray2, PyArrayMethods,
    ndarray::{ArrayView1, ArrayView2},
};
use pyo3::prelude::*;

use crate::{bodies::unknown, simulation::NativeSimulation, world::WaterArrays};

/// A stored field of the water.
#[derive(Clone, Copy)]
pub enum Field {
    /// Position, m.
    Position,
    /// Velocity, m/s.
    Velocity,
    /// Density, kg/m³.
    Density,
    /// Name of the particle for life.
    Id,
}

impl Field {
    /// Returns the field called `name`.
    ///
    /// # Errors
    /// `UsageError` with the nearest name.
    pub fn named(py: Python<'_>, name: &str) -> PyResult<Self> {
        Ok(match name {
            "position" => Self::Position,
            "velocity" => Self::Velocity,
            "density" => Self::Density,
            "id" => Self::Id,
            _ => return Err(unknown(py, "stored field", name, ["position", "velocity", "density", "id"].into_iter())),
        })
    }
}

/// Holds the memory of the water still: no step begins while it lives.
#[pyclass(frozen, module = "pontoon._pontoon")]
pub struct Lease {
    leases: Arc<AtomicUsize>,
    _simulation: Py<NativeSimulation>,
}

impl Lease {
    /// Creates one more lease of `simulation`. The caller holds the lock of the simulation.
    pub fn new(leases: Arc<AtomicUsize>, simulation: Py<NativeSimulation>) -> Self {
        leases.fetch_add(1, Ordering::AcqRel);
        Self { leases, _simulation: simulation }
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        self.leases.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Numbers in the memory of the water, `width` of each particle.
fn numbers<T>(pointer: *const T, count: usize, width: usize) -> &'static [T] {
    if count == 0 {
        return &[];
    }
    // SAFETY: the pointer is that of a live vector with `count` elements of `width` numbers without padding (arrays of
    // nalgebra are `repr(C)` arrays). The callers use the slice under a lease.
    #[expect(unsafe_code, reason = "NumPy reads the memory of the water")]
    unsafe {
        slice::from_raw_parts(pointer, count * width)
    }
}

/// Returns a copy of a field. The caller holds a lease.
///
/// # Errors
/// Those of NumPy.
pub fn copy<'py>(py: Python<'py>, water: &WaterArrays, field: Field, dimension: usize) -> PyResult<Bound<'py, PyAny>> {
    let count = water.count;
    let vectors = |pointer| {
        PyArray1::from_slice(py, numbers(pointer, count, dimension)).reshape([count, dimension]).map(Bound::into_any)
    };
    match field {
        Field::Position => vectors(water.position),
        Field::Velocity => vectors(water.velocity),
        Field::Density => Ok(PyArray1::from_slice(py, numbers(water.density, count, 1)).into_any()),
        Field::Id => Ok(PyArray1::from_slice(py, numbers(water.id, count, 1)).into_any()),
    }
}

/// Returns a read-only array on the memory of a field, which owns `lease`.
///
/// # Errors
/// Those of NumPy.
pub fn view<'py>(
    py: Python<'py>,
    water: &WaterArrays,
    field: Field,
    dimension: usize,
    lease: Lease,
) -> PyResult<Bound<'py, PyAny>> {
    let count = water.count;
    match field {
        Field::Position => vectors(py, numbers(water.position, count, dimension), [count, dimension], lease),
        Field::Velocity => vectors(py, numbers(water.velocity, count, dimension), [count, dimension], lease),
        Field::Density => scalars(py, numbers(water.density, count, 1), lease),
        Field::Id => scalars(py, numbers(water.id, count, 1), lease),
    }
}

fn scalars<'py, T: Element>(py: Python<'py>, numbers: &[T], lease: Lease) -> PyResult<Bound<'py, PyAny>> {
    let owner = Bound::new(py, lease)?.into_any();
    // SAFETY: the lease, which the array owns, keeps the simulation alive and its water unchanged; the array is made
    // read-only before it leaves this function.
    #[expect(unsafe_code, reason = "NumPy reads the memory of the water")]
    let array = unsafe { PyArray1::borrow_from_array(&ArrayView1::from(numbers), owner) };
    array.readwrite().make_nonwriteable();
    Ok(array.into_any())
}

fn vectors<'py>(py: Python<'py>, numbers: &[f64], shape: [usize; 2], lease: Lease) -> PyResult<Bound<'py, PyAny>> {
    let owner = Bound::new(py, lease)?.into_any();
    let view = ArrayView2::from_shape(shape, numbers)
        .map_err(|why| pyo3::exceptions::PyRuntimeError::new_err(why.to_string()))?;
    // SAFETY: as in `scalars`.
    #[expect(unsafe_code, reason = "NumPy reads the memory of the water")]
    let array = unsafe { PyArray2::borrow_from_array(&view, owner) };
    array.readwrite().make_nonwriteable();
    Ok(array.into_any())
}
