//! A running simulation: stepped without the interpreter's lock, read, changed, saved.

use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    time::Duration,
};

use numpy::{PyArray1, PyArrayMethods};
use pontoon::{
    Result,
    error::{Error, ErrorCode, ErrorKind},
    scene::Scene,
};
use pyo3::{
    exceptions::PyRuntimeError,
    prelude::*,
    types::{PyBytes, PyDict, PyTuple},
};

use crate::{
    bodies::{BodyState, BodyStep, find, motor, spring, three, three_axial, unknown},
    error::{OrRaise, usage},
    run::LOOK,
    scene::NativeScene,
    threads::{OwnThreads, is_forked},
    water::{Field, Lease},
    world::{Commands, Control, Names, ProbeReading, StepData, World},
};

/// Contact of two solids by name: names, normal force, point of action.
type NamedContact = (String, String, f64, Vec<f64>);

/// A simulation. While one thread steps it, no other can use it.
#[pyclass(frozen, module = "pontoon._pontoon")]
pub struct NativeSimulation {
    /// Absent while it is stepped, and after an internal error.
    world: Mutex<Option<Box<dyn World>>>,
    names: Mutex<Arc<Names>>,
    threads: OwnThreads,
    /// Number of views of its memory.
    leases: Arc<AtomicUsize>,
    /// The mark that its saved states carry: [`NativeScene::mark`].
    mark: u64,
}

/// A world taken out of its simulation; it goes back when this is dropped.
struct Taken<'a> {
    home: &'a NativeSimulation,
    world: Option<Box<dyn World>>,
}

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        *self.home.lock() = self.world.take();
    }
}

impl NativeSimulation {
    /// Creates the simulation of the world that `build` makes, with `threads` threads, by default one for each processor. Its
    /// states carry `mark`.
    ///
    /// # Errors
    /// Those of `build`, and `Usage` if the threads cannot be started.
    pub fn new(
        build: impl FnOnce() -> Result<Box<dyn World>> + Send,
        threads: Option<usize>,
        mark: u64,
    ) -> Result<Self> {
        let threads = OwnThreads::new(threads)?;
        let world = threads.pool()?.install(build)?;
        let names = Mutex::new(Arc::new(world.names()));
        Ok(Self { world: Mutex::new(Some(world)), names, threads, leases: Arc::default(), mark })
    }

    /// Locks the world. No call of Python may happen under this lock: it could let another thread run that waits for the
    /// lock and holds the interpreter.
    fn lock(&self) -> MutexGuard<'_, Option<Box<dyn World>>> {
        self.world.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn names(&self) -> Arc<Names> {
        self.names.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Calls `read` with the world.
    ///
    /// # Errors
    /// `UsageError` while it is stepped.
    fn read<T>(&self, py: Python<'_>, read: impl FnOnce(&dyn World) -> T) -> PyResult<T> {
        let outcome = self.lock().as_ref().map(|world| read(&**world));
        outcome.ok_or_else(|| busy(py))
    }

    /// Calls `compute` with the world, as [`NativeSimulation::read`] does, with threads that a forked process has too.
    ///
    /// # Errors
    /// `UsageError` while it is stepped.
    fn compute<T: Send>(&self, py: Python<'_>, compute: impl FnOnce(&dyn World) -> T + Send) -> PyResult<T> {
        if !is_forked() {
            return self.read(py, compute);
        }
        let pool = self.threads.pool().or_raise(py)?;
        let outcome = self.lock().as_mut().map(|world| {
            let world = &mut **world;
            pool.install(move || compute(world))
        });
        outcome.ok_or_else(|| busy(py))
    }

    /// Takes the world out for a change.
    ///
    /// # Errors
    /// `UsageError` while it is stepped or an array of its memory is in use.
    fn take(&self, py: Python<'_>) -> PyResult<Taken<'_>> {
        let (world, leased) = {
            let mut there = self.lock();
            let leased = self.leases.load(Ordering::Acquire) > 0;
            (if leased { None } else { there.take() }, leased && there.is_some())
        };
        if leased {
            let help = "close it, and `del` its arrays or copy them with numpy.array";
            return Err(usage(py, "a view of the water is open: its arrays would move", help));
        }
        match world {
            None => Err(busy(py)),
            world => Ok(Taken { home: self, world }),
        }
    }

    /// Calls `change` with the world in the pool, without the interpreter's lock.
    ///
    /// # Errors
    /// As [`NativeSimulation::take`].
    fn change<T: Send>(&self, py: Python<'_>, change: impl FnOnce(&mut dyn World) -> T + Send) -> PyResult<T> {
        let pool = self.threads.pool().or_raise(py)?;
        let mut taken = self.take(py)?;
        let world = taken.world.as_mut().ok_or_else(|| busy(py))?;
        Ok(py.detach(|| pool.install(|| change(&mut **world))))
    }

    /// Returns the content of the state `saved`, without its mark and its checksum.
    ///
    /// # Errors
    /// `Restart` if it is damaged or belongs to another scene.
    fn opened<'a>(&self, saved: &'a [u8]) -> Result<&'a [u8]> {
        let damaged =
            || Error::new(ErrorKind::Restart, "the state is damaged").help("restore the bytes that save returned");
        let ([mark, sum], state) =
            saved.as_chunks::<8>().0.first_chunk::<2>().map(|head| (head, &saved[16..])).ok_or_else(damaged)?;
        if u64::from_le_bytes(*sum) != hash(&[mark, state]) {
            return Err(damaged());
        }
        if u64::from_le_bytes(*mark) != self.mark {
            return Err(Error::new(ErrorKind::Restart, "the state belongs to another scene")
                .with_code(ErrorCode::OtherSetup)
                .help("restore it in a simulation of its own scene: outputs, until and guard may differ"));
        }
        Ok(state)
    }

    /// Reads the names anew, after solids were added or removed.
    fn update_names(&self, py: Python<'_>) -> PyResult<()> {
        let names = self.read(py, |world| world.names())?;
        *self.names.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(names);
        Ok(())
    }

    fn solid(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        let names = self.names();
        let known = names.solids.iter().map(|(name, _)| name.as_str());
        known.clone().position(|known| known == name).ok_or_else(|| unknown(py, "solid", name, known))
    }

    fn free(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        let (solid, names) = (self.solid(py, name)?, self.names());
        match names.solids[solid].1 {
            _ if names.hosted => {
                let help = "apply forces in the program that moves the bodies";
                Err(usage(py, "another program moves the bodies of this simulation", help))
            }
            "free" => Ok(solid),
            role => Err(usage(py, &format!("solid {name:?} is {role}, not free"), "name a free solid")),
        }
    }
}

/// Returns a hash of the bytes of `parts`, which a change of any of them changes.
pub fn hash(parts: &[&[u8]]) -> u64 {
    let mix = |hash: u64, word: u64| (hash.rotate_left(23) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let of = |hash: u64, part: &&[u8]| {
        let (words, rest) = part.as_chunks::<8>();
        let hash = words.iter().fold(hash, |hash, word| mix(hash, u64::from_le_bytes(*word)));
        rest.iter().fold(mix(hash, part.len() as u64), |hash, byte| mix(hash, u64::from(*byte)))
    };
    parts.iter().fold(0xcbf2_9ce4_8422_2325, of)
}

/// How many references to `object` there are.
#[expect(unsafe_code, reason = "the count of references of the interpreter")]
fn references<T>(_py: Python<'_>, object: &Py<T>) -> isize {
    // SAFETY: the object is alive while `object` refers to it, and the interpreter's lock is held.
    unsafe { pyo3::ffi::Py_REFCNT(object.as_ptr()) }
}

fn busy(py: Python<'_>) -> PyErr {
    let help = "in a callback read the object that it gets; one simulation is stepped by one thread at a time";
    usage(py, "the simulation is being stepped", help)
}

/// A function of Python that is called in the steps of an advance.
struct CallBack {
    call: Py<PyAny>,
    names: Arc<Names>,
    /// The arguments of the last call and the object in them. The next call gets both too, unless the function has kept one.
    last: Option<(Py<PyTuple>, Py<BodyStep>)>,
    /// The exception of the function.
    raised: Option<PyErr>,
}

impl CallBack {
    fn new(call: Py<PyAny>, names: Arc<Names>) -> Self {
        Self { call, names, last: None, raised: None }
    }

    /// Calls the function with `step`, writes its `commands`, and keeps its exception.
    fn run(&mut self, step: &mut StepData, commands: &mut Commands) {
        if let Err(why) = Python::attach(|py| self.call(py, step, commands)) {
            self.raised = Some(why);
            *commands = Commands { failed: true, ..Commands::default() };
        }
    }

    fn call(&mut self, py: Python<'_>, step: &mut StepData, commands: &mut Commands) -> PyResult<()> {
        // The arguments refer to the object, too.
        let unused = |(arguments, object): &(Py<PyTuple>, Py<BodyStep>)| {
            references(py, arguments) == 1 && references(py, object) == 2
        };
        let (arguments, object) = match self.last.take().filter(unused) {
            Some(last) => {
                last.1.borrow_mut(py).renew(step);
                last
            }
            None => {
                let object = Py::new(py, BodyStep::new(self.names.clone(), std::mem::take(step)))?;
                (PyTuple::new(py, [&object])?.unbind(), object)
            }
        };
        let answer = self.call.bind(py).call1(arguments.bind(py));
        // Another thread may hold it.
        object.try_borrow_mut(py)?.finish(commands);
        answer?;
        self.last = Some((arguments, object));
        Ok(())
    }
}

/// Columns and readings of probes by name.
fn readings<'py>(py: Python<'py>, all: Vec<ProbeReading>) -> PyResult<Bound<'py, PyDict>> {
    let readings = PyDict::new(py);
    for (name, columns, values) in all {
        let table = PyDict::new(py);
        for (column, value) in columns.iter().zip(values) {
            table.set_item(column, value)?;
        }
        readings.set_item(name, table)?;
    }
    Ok(readings)
}

#[pymethods]
impl NativeSimulation {
    /// Time (s), length of the last step (s), number of steps, and longest next step (s).
    fn clock(&self, py: Python<'_>) -> PyResult<(f64, f64, u64, f64)> {
        self.read(py, |world| world.clock())
    }

    /// Dimension, 2 or 3.
    #[getter]
    fn dimension(&self) -> usize {
        self.names().dimension
    }

    /// Whether another program moves the free solids.
    #[getter]
    fn hosted(&self) -> bool {
        self.names().hosted
    }

    /// Number of threads.
    #[getter]
    fn threads(&self) -> usize {
        self.threads.count()
    }

    /// Names of the solids, of the joints, of the springs.
    fn all_names(&self) -> (Vec<String>, Vec<String>, Vec<String>) {
        let names = self.names();
        (names.solids.iter().map(|(name, _)| name.clone()).collect(), names.joints.clone(), names.springs.clone())
    }

    /// Goes on to time `end` (s), by one step if `single`, and calls `control` with a `BodyStep` every `every` (s).
    #[pyo3(signature = (end, single, control=None, every=0.0))]
    fn advance(&self, py: Python<'_>, end: f64, single: bool, control: Option<Py<PyAny>>, every: f64) -> PyResult<()> {
        py.check_signals()?;
        let pool = self.threads.pool().or_raise(py)?;
        let mut taken = self.take(py)?;
        let world = taken.world.as_mut().ok_or_else(|| busy(py))?;
        let (stop, signal) = (AtomicBool::new(false), Mutex::new(None));
        let calls = control.is_some();
        let mut callback = control.map(|call| CallBack::new(call, self.names()));
        let mut advance = || -> Result<()> {
            match &mut callback {
                None => world.advance(end, single, &stop, None),
                Some(callback) => {
                    let mut call = |step: &mut StepData, commands: &mut Commands| callback.run(step, commands);
                    world.advance(end, single, &stop, Some(Control { call: &mut call, every }))
                }
            }
        };
        let outcome = py.detach(|| {
            if single {
                return Some(pool.install(advance));
            }
            pool.in_place_scope(|scope| {
                let (done, finished) = mpsc::channel();
                scope.spawn(move |_| {
                    // One thread state for all callbacks; the receiver waits for the outcome.
                    let outcome = if calls { Python::attach(|py| py.detach(advance)) } else { advance() };
                    let _ = done.send(outcome);
                });
                watch_signals(&finished, LOOK, &stop, &signal)
            })
        });
        drop(taken);
        let why = signal.into_inner().unwrap_or_else(PoisonError::into_inner);
        match (why.or(callback.and_then(|callback| callback.raised)), outcome) {
            (Some(why), _) => Err(why),
            (None, Some(outcome)) => outcome.or_raise(py),
            (None, None) => Err(PyRuntimeError::new_err("the step ended with an internal error")),
        }
    }

    /// State of the solid called `name`.
    fn body(&self, py: Python<'_>, name: &str) -> PyResult<BodyState> {
        let (solid, names) = (self.solid(py, name)?, self.names());
        let (data, mass) = self.read(py, |world| (world.bodies()[solid], world.mass(solid)))?;
        Ok(BodyState::new(names, solid, mass, data))
    }

    /// Number of water particles.
    fn particles(&self, py: Python<'_>) -> PyResult<usize> {
        self.read(py, |world| world.water().count)
    }

    /// A copy of the field `name` of the water.
    fn water<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (py, own) = (slf.py(), slf.get());
        let dimension = own.names().dimension;
        let computed = own.compute(py, |world| match name {
            "pressure" => Some((world.pressures(), 1)),
            "acceleration" => Some((world.accelerations(), dimension)),
            _ => None,
        })?;
        match computed {
            Some((numbers, 1)) => Ok(PyArray1::from_vec(py, numbers).into_any()),
            Some((numbers, width)) => {
                let count = numbers.len() / width;
                Ok(PyArray1::from_vec(py, numbers).reshape([count, width])?.into_any())
            }
            None => {
                let field = Field::named(py, name)?;
                let _lease = Self::lease(slf)?;
                let water = own.read(py, |world| world.water())?;
                crate::water::copy(py, &water, field, dimension)
            }
        }
    }

    /// Holds the memory of the water still until the returned object is gone.
    fn lease(slf: &Bound<'_, Self>) -> PyResult<Lease> {
        let own = slf.get();
        // Under the lock, so that no step begins meanwhile.
        let lease = own.lock().as_ref().map(|_| Lease::new(own.leases.clone(), slf.clone().unbind()));
        lease.ok_or_else(|| busy(slf.py()))
    }

    /// A read-only array on the memory of the field `name`. It holds the memory still while it lives.
    fn water_view<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (py, own) = (slf.py(), slf.get());
        let field = Field::named(py, name)?;
        let lease = Self::lease(slf)?;
        let water = own.read(py, |world| world.water())?;
        crate::water::view(py, &water, field, own.names().dimension, lease)
    }

    /// Readings of the probes of `scene`, or of the scene's own, by probe and column.
    #[pyo3(signature = (scene=None))]
    fn read_probes<'py>(&self, py: Python<'py>, scene: Option<&NativeScene>) -> PyResult<Bound<'py, PyDict>> {
        let all = match scene {
            None => self.compute(py, |world| world.read_own())?,
            Some(scene) => {
                let plan = scene.plan().or_raise(py)?;
                self.compute(py, |world| world.read(&plan))?.or_raise(py)?
            }
        };
        readings(py, all)
    }

    /// Contacts of the last step: names of both solids, normal force (N; N/m in 2-D), point of action (m).
    fn contacts(&self, py: Python<'_>) -> PyResult<Vec<NamedContact>> {
        let names = self.names();
        let contacts = self.read(py, |world| world.contacts())?;
        let name = |solid: usize| names.solids[solid].0.clone();
        let named =
            contacts.into_iter().map(|([a, b], force, at)| (name(a), name(b), force, at[..names.dimension].to_vec()));
        Ok(named.collect())
    }

    /// Descriptions of beginnings and ends of joints, springs, ropes and solids, and of rollbacks.
    fn events(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.read(py, |world| world.events())
    }

    /// Wall time (s) of steps, neighbour lists, pairs, bodies and callbacks.
    fn time_spent(&self, py: Python<'_>) -> PyResult<[f64; 5]> {
        self.read(py, |world| world.time_spent())
    }

    /// The state, as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let state = self.compute(py, |world| world.save())?.or_raise(py)?;
        let head = [self.mark, hash(&[&self.mark.to_le_bytes(), &state])].map(u64::to_le_bytes);
        Ok(PyBytes::new(py, &[head.as_flattened(), &state].concat()))
    }

    /// Returns to a state.
    fn restore(&self, py: Python<'_>, state: &[u8]) -> PyResult<()> {
        self.change(py, |world| world.restore(self.opened(state)?))?.or_raise(py)
    }

    /// Adds a solid, written as the keys of a `[[solid]]` section, to a simulation of `scene`; returns the number of
    /// particles that it displaced.
    fn add_solid(&self, py: Python<'_>, scene: &NativeScene, solid: &str) -> PyResult<usize> {
        let scene = scene.with_solid(solid).or_raise(py)?;
        let displaced = self.change(py, |world| world.add_solid(&scene))?.or_raise(py)?;
        self.update_names(py)?;
        Ok(displaced)
    }

    /// Restores a state to whose simulation the solids `added` had been added.
    fn restore_with_added(
        &self,
        py: Python<'_>,
        state: &[u8],
        scene: &NativeScene,
        added: Vec<String>,
    ) -> PyResult<()> {
        let scenes = added.iter().map(|solid| scene.with_solid(solid)).collect::<Result<Vec<Scene>>>().or_raise(py)?;
        self.change(py, |world| world.restore_with_added(self.opened(state)?, &scenes))?.or_raise(py)?;
        self.update_names(py)
    }

    /// Removes a solid.
    fn remove_solid(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        let solid = self.solid(py, name)?;
        self.change(py, |world| world.remove_solid(solid))?.or_raise(py)
    }

    /// Pushes a free solid during the next step.
    #[pyo3(signature = (name, force, at=None))]
    fn push(
        &self,
        py: Python<'_>,
        name: &str,
        force: &Bound<'_, PyAny>,
        at: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (solid, dimension) = (self.free(py, name)?, self.names().dimension);
        let force = three(py, force, dimension, "force")?;
        let at = at.map(|at| three(py, at, dimension, "at")).transpose()?;
        self.change(py, |world| world.push(solid, force, at))
    }

    /// Sets velocity and spin of a free solid.
    fn set_velocity(
        &self,
        py: Python<'_>,
        name: &str,
        velocity: &Bound<'_, PyAny>,
        spin: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (solid, dimension) = (self.free(py, name)?, self.names().dimension);
        let velocity = three(py, velocity, dimension, "velocity")?;
        let spin = three_axial(py, spin, dimension, "spin")?;
        self.change(py, |world| world.set_velocity(solid, velocity, spin))
    }

    /// Coordinate, rate, motor force and energy that the motor took of joint `name`.
    fn joint(&self, py: Python<'_>, name: &str) -> PyResult<[f64; 4]> {
        let joint = find(py, "joint", name, &self.names().joints)?;
        self.read(py, |world| world.joint(joint))
    }

    /// Drives joint `name` from now on with force or torque (N or N m), and position, velocity, stiffness, damping and largest
    /// force.
    fn drive(&self, py: Python<'_>, name: &str, load: [Option<f64>; 2], rest: [f64; 5]) -> PyResult<()> {
        let joint = find(py, "joint", name, &self.names().joints)?;
        let command = motor(py, load, rest)?;
        self.change(py, |world| world.set_motor(joint, Some(command)))
    }

    /// Gives joint `name` back to its own motor.
    fn release(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        let joint = find(py, "joint", name, &self.names().joints)?;
        self.change(py, |world| world.set_motor(joint, None))
    }

    /// Length (m) and tension (N; N/m in 2-D) of spring `name`.
    fn spring(&self, py: Python<'_>, name: &str) -> PyResult<[f64; 2]> {
        let spring = find(py, "spring", name, &self.names().springs)?;
        self.read(py, |world| world.spring(spring))
    }

    /// Changes those of stiffness (N/m), damping (N s/m) and rest length (m) of spring `name` that are given; returns all.
    fn set_spring(&self, py: Python<'_>, name: &str, changes: [Option<f64>; 3]) -> PyResult<[f64; 3]> {
        let number = find(py, "spring", name, &self.names().springs)?;
        let changes = spring(py, changes)?;
        self.change(py, |world| world.set_spring(number, changes))
    }
}

/// Waits until the job is done, and looks at signals meanwhile. A signal sets `stop`; its exception goes into `signal`.
/// Returns `None` if the job ended without an outcome.
fn watch_signals(
    finished: &mpsc::Receiver<Result<()>>,
    interval: Duration,
    stop: &AtomicBool,
    signal: &Mutex<Option<PyErr>>,
) -> Option<Result<()>> {
    loop {
        match finished.recv_timeout(interval) {
            Ok(outcome) => return Some(outcome),
            Err(RecvTimeoutError::Disconnected) => return None,
            Err(RecvTimeoutError::Timeout) if stop.load(Ordering::Relaxed) => {}
            Err(RecvTimeoutError::Timeout) => {
                if let Err(why) = Python::attach(|py| py.check_signals()) {
                    stop.store(true, Ordering::Relaxed);
                    *signal.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
                }
            }
        }
    }
}
