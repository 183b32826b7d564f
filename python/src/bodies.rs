//! The data and the commands of a callback, which is called between the motions of the water and of the bodies.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pontoon::{
    error::{Error, ErrorCode, ErrorKind, nearest_name},
    solid::MotorCommand,
};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    error::{exception, usage},
    world::{BodyData, Commands, Names, Push, StepData},
};

/// Returns a vector as an array of `dimension` numbers.
pub fn vector<'py>(py: Python<'py>, x: &[f64; 3], dimension: usize) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, &x[..dimension])
}

/// Returns an axial vector: a number in 2-D, an array of three in 3-D.
pub fn axial(py: Python<'_>, x: &[f64; 3], dimension: usize) -> PyResult<Py<PyAny>> {
    Ok(if dimension == 2 {
        x[0].into_pyobject(py)?.into_any().unbind()
    } else {
        PyArray1::from_slice(py, x).into_any().unbind()
    })
}

/// Returns `dimension` numbers of an array of doubles, followed by zeros, without a Python object for each number.
fn components(x: &Bound<'_, PyAny>, dimension: usize) -> Option<[f64; 3]> {
    let from = |numbers: &[f64]| {
        let mut three = [0.0; 3];
        three.get_mut(..numbers.len())?.copy_from_slice(numbers);
        (numbers.len() == dimension).then_some(three)
    };
    if let Ok(array) = x.cast::<PyArray1<f64>>()
        && let Ok(array) = array.try_readonly()
        && let Ok(numbers) = array.as_slice()
    {
        return from(numbers);
    }
    from(&x.extract::<Vec<f64>>().ok()?)
}

/// Returns three components of a vector of `dimension` numbers.
///
/// # Errors
/// `UsageError` for another number of components, or one that is not finite.
pub fn three(py: Python<'_>, x: &Bound<'_, PyAny>, dimension: usize, what: &str) -> PyResult<[f64; 3]> {
    match components(x, dimension).filter(|numbers| numbers.iter().all(|x| x.is_finite())) {
        Some(numbers) => Ok(numbers),
        None => {
            let count = if dimension == 1 { "one finite number".into() } else { format!("{dimension} finite numbers") };
            Err(usage(py, &format!("{what} cannot be {x}"), &format!("give {count}")))
        }
    }
}

/// Returns the components of an axial vector: a number in 2-D, three in 3-D.
///
/// # Errors
/// As [`three`].
pub fn three_axial(py: Python<'_>, x: &Bound<'_, PyAny>, dimension: usize, what: &str) -> PyResult<[f64; 3]> {
    match x.extract::<f64>() {
        Ok(number) if dimension == 2 && number.is_finite() => Ok([number, 0.0, 0.0]),
        _ => three(py, x, if dimension == 2 { 1 } else { 3 }, what),
    }
}

/// Force and torque of the water on a solid.
#[pyclass(frozen, module = "pontoon._pontoon")]
#[derive(Clone, Copy)]
pub struct Load {
    force: [f64; 3],
    torque: [f64; 3],
    dimension: usize,
}

#[pymethods]
impl Load {
    /// Force, N (N/m in 2-D), without weight: (D,).
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.force, self.dimension)
    }

    /// Torque about the centre of the solid, N m (N m/m in 2-D): a number in 2-D, (3,) in 3-D.
    #[getter]
    fn torque(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        axial(py, &self.torque, self.dimension)
    }

    fn __repr__(&self) -> String {
        format!("Load(force={:?})", &self.force[..self.dimension])
    }
}

/// Position, motion and load of a solid.
#[pyclass(frozen, module = "pontoon._pontoon")]
#[derive(Clone)]
pub struct BodyState {
    names: Arc<Names>,
    /// Number of the solid among the names.
    solid: usize,
    mass: Option<f64>,
    data: BodyData,
    dimension: usize,
}

impl BodyState {
    /// Creates the state of solid number `solid`.
    pub fn new(names: Arc<Names>, solid: usize, mass: Option<f64>, data: BodyData) -> Self {
        let dimension = names.dimension;
        Self { names, solid, mass, data, dimension }
    }
}

#[pymethods]
impl BodyState {
    /// Name.
    #[getter]
    fn name(&self) -> &str {
        &self.names.solids[self.solid].0
    }

    /// "fixed", "driven" or "free".
    #[getter]
    fn role(&self) -> &'static str {
        self.names.solids[self.solid].1
    }

    /// Mass of a free solid, kg (kg/m in 2-D); None of any other, and in a callback.
    #[getter]
    fn mass(&self) -> Option<f64> {
        self.mass
    }

    /// World position of the origin of its frame, m: (D,).
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.data.position, self.dimension)
    }

    /// World position of its centre, m: (D,); the centre of mass of a free solid.
    #[getter]
    fn centre<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.data.centre, self.dimension)
    }

    /// Velocity of its centre, m/s: (D,).
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.data.velocity, self.dimension)
    }

    /// Spin, rad/s: a number in 2-D, (3,) in 3-D.
    #[getter]
    fn spin(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        axial(py, &self.data.spin, self.dimension)
    }

    /// Rotation: an angle (rad) in 2-D, a matrix (3, 3) in 3-D.
    #[getter]
    fn rotation(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        if self.dimension == 2 {
            let [cosine, _, sine, ..] = self.data.rotation;
            return Ok(sine.atan2(cosine).into_pyobject(py)?.into_any().unbind());
        }
        let matrix: Bound<'_, PyArray2<f64>> = PyArray1::from_slice(py, &self.data.rotation).reshape([3, 3])?;
        Ok(matrix.into_any().unbind())
    }

    /// Force and torque of the water: a `Load`.
    #[getter]
    fn load(&self) -> Load {
        Load { force: self.data.force, torque: self.data.torque, dimension: self.dimension }
    }

    fn __repr__(&self) -> String {
        let centre = &self.data.centre[..self.dimension];
        let (name, role) = &self.names.solids[self.solid];
        format!("BodyState({name:?}, {role}, centre={centre:?})")
    }
}

/// The part of a step when the water has moved and the bodies have not.
#[pyclass(module = "pontoon._pontoon")]
pub struct BodyStep {
    names: Arc<Names>,
    step: StepData,
    commands: Commands,
    /// Whether the callback has returned.
    is_over: bool,
}

impl BodyStep {
    /// Creates the object that a callback gets.
    pub fn new(names: Arc<Names>, step: StepData) -> Self {
        Self { names, step, commands: Commands::default(), is_over: false }
    }

    /// Makes this the object of a later step, and leaves the memory of the last one in `step`.
    pub fn renew(&mut self, step: &mut StepData) {
        std::mem::swap(&mut self.step, step);
        self.is_over = false;
    }

    /// Exchanges `none`, empty commands, for those of the callback, which has returned.
    pub fn finish(&mut self, none: &mut Commands) {
        self.is_over = true;
        std::mem::swap(&mut self.commands, none);
    }

    /// Returns the commands of the present step.
    ///
    /// # Errors
    /// `UsageError` if the step is over.
    fn commands(&mut self, py: Python<'_>) -> PyResult<&mut Commands> {
        if self.is_over {
            let help = "act in the function that gets the step, or through the simulation";
            return Err(usage(py, "the step is over: nothing can be done in it", help));
        }
        Ok(&mut self.commands)
    }

    fn solid(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        let known = self.names.solids.iter().map(|(name, _)| name.as_str());
        known.clone().position(|known| known == name).ok_or_else(|| unknown(py, "solid", name, known))
    }

    fn free(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        let solid = self.solid(py, name)?;
        match self.names.solids[solid].1 {
            "free" => Ok(solid),
            role => {
                Err(usage(py, &format!("solid {name:?} is {role}: forces have no effect on it"), "push a free solid"))
            }
        }
    }
}

/// Returns the exception for a name that is none of `known`.
pub fn unknown<'a>(py: Python<'_>, kind: &str, name: &str, known: impl Iterator<Item = &'a str> + Clone) -> PyErr {
    let help = match nearest_name(name, known.clone()) {
        Some(near) => format!("did you mean {near:?}?"),
        None => format!("the {kind}s are: {}", known.collect::<Vec<_>>().join(", ")),
    };
    let error = Error::new(ErrorKind::Usage, format!("there is no {kind} called {name:?}"));
    exception(py, &error.with_code(ErrorCode::UnknownName).help(help))
}

/// Returns the number of `name` among `names`.
///
/// # Errors
/// `UsageError` with the nearest name.
pub fn find(py: Python<'_>, kind: &str, name: &str, names: &[String]) -> PyResult<usize> {
    let known = names.iter().map(String::as_str);
    known.clone().position(|known| known == name).ok_or_else(|| unknown(py, kind, name, known))
}

#[pymethods]
impl BodyStep {
    /// Time at the start of the step, s.
    #[getter]
    fn time(&self) -> f64 {
        self.step.time
    }

    /// Length of the step, s.
    #[getter]
    fn dt(&self) -> f64 {
        self.step.dt
    }

    /// Names of the solids.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.names.solids.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// Returns a solid at the start of the step, with the load of this step.
    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<BodyState> {
        let solid = self.solid(py, name)?;
        Ok(BodyState::new(self.names.clone(), solid, None, self.step.bodies[solid]))
    }

    /// Loads of the water in this step, by the name of the solid.
    #[getter]
    fn loads<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let loads = PyDict::new(py);
        for ((name, _), body) in self.names.solids.iter().zip(&self.step.bodies) {
            let load = Load { force: body.force, torque: body.torque, dimension: self.names.dimension };
            loads.set_item(name, load)?;
        }
        Ok(loads)
    }

    /// Returns coordinate, rate and motor of a joint in the last step: a `JointReading`.
    ///
    /// Raises:
    ///     UnknownNameError: there is no such joint.
    fn joint<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let joint = find(py, "joint", name, &self.names.joints)?;
        py.import("pontoon.simulation")?.getattr("JointReading")?.call1(PyTuple::new(py, self.step.joints[joint])?)
    }

    /// Returns length, tension and parameters of a spring in the last step: a `SpringReading`.
    ///
    /// Raises:
    ///     UnknownNameError: there is no such spring.
    fn spring<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let spring = find(py, "spring", name, &self.names.springs)?;
        py.import("pontoon.simulation")?.getattr("SpringReading")?.call1(PyTuple::new(py, self.step.springs[spring])?)
    }

    /// Pushes a free solid until the next call.
    ///
    /// Args:
    ///     name: the solid.
    ///     force: N (N/m in 2-D): (D,).
    ///     torque: about its centre, N m (N m/m in 2-D): a number in 2-D, (3,) in 3-D.
    ///     at: world point at which the force acts, m: (D,); by default its centre.
    ///
    /// Raises:
    ///     UnknownNameError: there is no such solid.
    ///     UsageError: it is not free, or a vector has another length or is not finite.
    #[pyo3(signature = (name, force=None, *, torque=None, at=None))]
    fn push(
        &mut self,
        py: Python<'_>,
        name: &str,
        force: Option<&Bound<'_, PyAny>>,
        torque: Option<&Bound<'_, PyAny>>,
        at: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        if self.names.hosted {
            let help = "apply forces in the program that moves the bodies";
            return Err(usage(py, "another program moves the bodies of this simulation", help));
        }
        let (solid, dimension) = (self.free(py, name)?, self.names.dimension);
        let force = force.map_or(Ok([0.0; 3]), |force| three(py, force, dimension, "force"))?;
        let mut torque = torque.map_or(Ok([0.0; 3]), |torque| three_axial(py, torque, dimension, "torque"))?;
        if let Some(at) = at {
            let (at, centre) = (three(py, at, dimension, "at")?, self.step.bodies[solid].centre);
            let arm: [f64; 3] = std::array::from_fn(|i| at[i] - centre[i]);
            let turn = |i: usize, j: usize| arm[i] * force[j] - arm[j] * force[i];
            let moment = if dimension == 2 { [turn(0, 1), 0.0, 0.0] } else { [turn(1, 2), turn(2, 0), turn(0, 1)] };
            torque.iter_mut().zip(moment).for_each(|(sum, part)| *sum += part);
        }
        self.commands(py)?.pushes.push(Push { solid, force, torque });
        Ok(())
    }

    /// Drives a hinge or a slider from the next step on with F = force + stiffness (position − x) + damping (velocity − ẋ),
    /// |F| at most `max_force`, in N, m or N m, rad (forces per metre in 2-D); `torque` is another name of `force`.
    ///
    /// Raises:
    ///     UnknownNameError: there is no such joint.
    ///     UsageError: both `force` and `torque` are given, or a number is not finite or negative where it must not be.
    #[pyo3(signature = (name, *, force=None, torque=None, position=0.0, velocity=0.0, stiffness=0.0, damping=0.0,
        max_force=f64::INFINITY))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn drive(
        &mut self,
        py: Python<'_>,
        name: &str,
        force: Option<f64>,
        torque: Option<f64>,
        position: f64,
        velocity: f64,
        stiffness: f64,
        damping: f64,
        max_force: f64,
    ) -> PyResult<()> {
        let joint = find(py, "joint", name, &self.names.joints)?;
        let command = motor(py, [force, torque], [position, velocity, stiffness, damping, max_force])?;
        self.commands(py)?.motors.push((joint, Some(command)));
        Ok(())
    }

    /// Changes stiffness (N/m), damping (N s/m) or rest length (m) of a spring from the next step on.
    ///
    /// Raises:
    ///     UnknownNameError: there is no such spring.
    ///     UsageError: a number is negative or not finite.
    #[pyo3(signature = (name, *, stiffness=None, damping=None, rest_length=None))]
    fn set_spring(
        &mut self,
        py: Python<'_>,
        name: &str,
        stiffness: Option<f64>,
        damping: Option<f64>,
        rest_length: Option<f64>,
    ) -> PyResult<()> {
        let number = find(py, "spring", name, &self.names.springs)?;
        let parameters = spring(py, [stiffness, damping, rest_length])?;
        self.commands(py)?.springs.push((number, parameters));
        Ok(())
    }

    /// Sets the motion of a body of another program at the end of the step: position of its frame (m), rotation matrix (D × D
    /// numbers), centre (m), velocity of its centre (m/s), spin (rad/s). `HostedSimulation` calls it.
    #[expect(clippy::too_many_arguments, reason = "the parts of a motion")]
    fn set_motion(
        &mut self,
        py: Python<'_>,
        name: &str,
        position: &Bound<'_, PyAny>,
        rotation: &Bound<'_, PyAny>,
        centre: &Bound<'_, PyAny>,
        velocity: &Bound<'_, PyAny>,
        spin: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (solid, dimension) = (self.free(py, name)?, self.names.dimension);
        let numbers: Vec<f64> = rotation.extract().unwrap_or_default();
        if numbers.len() != dimension * dimension {
            let help = format!("give a matrix of {dimension} × {dimension} numbers");
            return Err(usage(py, &format!("rotation cannot be {rotation}"), &help));
        }
        let mut motion = BodyData {
            position: three(py, position, dimension, "position")?,
            centre: three(py, centre, dimension, "centre")?,
            velocity: three(py, velocity, dimension, "velocity")?,
            spin: three_axial(py, spin, dimension, "spin")?,
            ..BodyData::default()
        };
        motion.rotation.iter_mut().zip(numbers).for_each(|(to, from)| *to = from);
        self.commands(py)?.motions.push((solid, motion));
        Ok(())
    }
}

/// Returns the command of a motor: its force or torque, which is the same, and position, velocity, stiffness, damping and
/// largest force.
///
/// # Errors
/// `UsageError` for both force and torque, numbers that are not finite, or negative stiffness, damping or largest force.
pub fn motor(py: Python<'_>, load: [Option<f64>; 2], rest: [f64; 5]) -> PyResult<MotorCommand> {
    let force = match load {
        [Some(_), Some(_)] => {
            let help = "give force to a slider, torque to a hinge";
            return Err(usage(py, "force and torque are two names of the same load of a motor", help));
        }
        [force, torque] => force.or(torque).unwrap_or(0.0),
    };
    let [position, velocity, stiffness, damping, max_force] = rest;
    let finite = [force, position, velocity, stiffness, damping].iter().all(|x| x.is_finite());
    if !finite || stiffness < 0.0 || damping < 0.0 || max_force.is_nan() || max_force < 0.0 {
        let help = "finite numbers; stiffness, damping and max_force 0 or more";
        return Err(usage(py, "this is no command of a motor", help));
    }
    Ok(MotorCommand { force, position, velocity, stiffness, damping, max_force })
}

/// Returns those of stiffness, damping and rest length that are given.
///
/// # Errors
/// `UsageError` for a number that is negative or not finite.
pub fn spring(py: Python<'_>, numbers: [Option<f64>; 3]) -> PyResult<[Option<f64>; 3]> {
    if numbers.iter().flatten().any(|x| !x.is_finite() || *x < 0.0) {
        return Err(usage(py, "this is no parameter of a spring", "finite numbers, 0 or more"));
    }
    Ok(numbers)
}
