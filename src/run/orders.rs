//! A run on several ranks. The first rank writes the files and tells the other ranks what to do next. The other ranks have the
//! same simulation and take the same steps.

use std::{fs, io, path::Path};

use super::{controls::Controls, probe_factory, run_folder};
use crate::{
    error::{Error, ErrorKind, Result},
    output::{Checkpoint, checkpoint, frame},
    plan::{ControlChange, FramesPlan, Plan},
    ranks::{Ranks, WaterShare, from_words, words_of},
    scene::{BuiltScene, Scene},
    simulation::{Dimension, Setup, Simulation, water_of_ranks},
    solid::Dim,
};

/// An order of the first rank to the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Order {
    /// Take a step.
    Step,
    /// Complete the water on the first rank.
    Gather,
    /// Exchange the water within boxes that the first rank names.
    GatherNear,
    /// Send the first rank the data of the water for a frame, also after a fault that occurred on all ranks.
    Frame,
    /// Send the first rank the data of the water for a checkpoint with the first `rollbacks` rollbacks.
    Save { rollbacks: usize },
    /// Set a control to a value.
    Set { control: usize, value: f64 },
    /// The run is over.
    End,
}

/// The message of a rank in the exchange of an order.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Message {
    /// The order, in the message of the first rank.
    order: Option<Order>,
    /// Whether this rank could not follow the last order.
    failed: bool,
    /// Simulated time, s.
    time: f64,
}

impl Message {
    fn words(&self) -> [u32; 7] {
        let (kind, control, value) = match self.order {
            None => (0, 0, 0.0),
            Some(Order::Step) => (1, 0, 0.0),
            Some(Order::Set { control, value }) => (2, control as u32, value),
            Some(Order::End) => (3, 0, 0.0),
            Some(Order::Gather) => (4, 0, 0.0),
            Some(Order::Save { rollbacks }) => (5, rollbacks as u32, 0.0),
            Some(Order::Frame) => (6, 0, 0.0),
            Some(Order::GatherNear) => (7, 0, 0.0),
        };
        let ([t0, t1], [v0, v1]) = (words_of(self.time), words_of(value));
        [kind, control, v0, v1, t0, t1, u32::from(self.failed)]
    }

    fn from_words([kind, control, v0, v1, t0, t1, failed]: [u32; 7]) -> Self {
        let order = match kind {
            1 => Some(Order::Step),
            2 => Some(Order::Set { control: control as usize, value: from_words(v0, v1) }),
            3 => Some(Order::End),
            4 => Some(Order::Gather),
            5 => Some(Order::Save { rollbacks: control as usize }),
            6 => Some(Order::Frame),
            7 => Some(Order::GatherNear),
            _ => None,
        };
        Self { order, failed: failed != 0, time: from_words(t0, t1) }
    }
}

/// Exchanges the ranks' messages; returns the order.
///
/// # Errors
/// `Fault` on all ranks if a rank failed, or is at another time than the first.
fn exchange(ranks: &Ranks, own: &Message) -> Result<Order> {
    let all: Vec<Message> = ranks.gather_words(own.words()).into_iter().map(Message::from_words).collect();
    let first = all[0];
    let order = first.order.unwrap_or(Order::End);
    if order == Order::End {
        return Ok(order);
    }
    for (rank, other) in all.iter().enumerate() {
        if other.failed && order != Order::Frame {
            let what = format!("rank {rank} cannot go on at t = {:.6} s: its own message says why", first.time);
            return Err(Error::new(ErrorKind::Fault, what));
        }
        if other.time.to_bits() != first.time.to_bits() {
            let times = format!("rank {rank} is at t = {} s and rank 0 at t = {} s", other.time, first.time);
            return Err(Error::new(ErrorKind::Fault, format!("{times}: they computed different steps"))
                .help("check the memory and the processors of the machine of that rank"));
        }
    }
    Ok(order)
}

/// The first rank's control of the others. When it is dropped, it tells them that the run is over.
pub(crate) struct Leader(Ranks);

impl Leader {
    /// Leads `ranks`; all others call [`follow`].
    pub(crate) fn new(ranks: Ranks) -> Self {
        Self(ranks)
    }

    /// Tells the others at time `time` (s) what to do.
    ///
    /// # Errors
    /// `Fault` if another rank failed or computed something else.
    pub(super) fn order(&self, order: Order, time: f64) -> Result<()> {
        if self.0.count() > 1 {
            exchange(&self.0, &Message { order: Some(order), failed: false, time })?;
        }
        Ok(())
    }
}

impl Drop for Leader {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.abort(101);
        } else {
            let _ = self.order(Order::End, 0.0);
        }
    }
}

/// A text that differs if the program, the scene, or a file in `folder` that the scene names differs.
pub(super) fn scene_digest(scene: &Scene, folder: &Path) -> String {
    let words = scene.to_toml().unwrap_or_default();
    let of_file = |hash: u64, name: String| match fs::read(folder.join(name)) {
        Ok(bytes) => checkpoint::fnv1a_continue(hash, &bytes),
        Err(_) => hash,
    };
    let files = run_folder::strings(&words).into_iter().filter(|name| !name.is_empty()).fold(0, of_file);
    let (version, commit) = (env!("CARGO_PKG_VERSION"), option_env!("PONTOON_COMMIT").unwrap_or_default());
    format!("{version} {commit} {:x} {files:x}", checkpoint::fnv1a(words.as_bytes()))
}

/// A text that differs if two ranks have set up different things.
pub(super) fn setup_digest<const D: usize>(BuiltScene { setup, part, .. }: &BuiltScene<D>) -> String {
    let hash = |numbers: &mut dyn Iterator<Item = &f64>| {
        numbers.fold(0, |hash, x| checkpoint::fnv1a_continue(hash, &x.to_bits().to_le_bytes()))
    };
    let water = match part {
        // Each rank has other water.
        Some(part) => part.count as u64,
        None => hash(&mut setup.water.iter().chain(&setup.velocity).flat_map(|x| x.iter())),
    };
    let solids = hash(&mut setup.solids.iter().flat_map(|solid| solid.pose.position.iter()));
    format!("{} solids, {solids:x}, {water:x}", setup.solids.len())
}

/// Follows the first of the `ranks` through a run, from the start of `scene` or from `checkpoint`, until that rank ends the run.
///
/// # Errors
/// The error of a step that failed on this rank only.
pub(super) fn follow<const D: usize>(scene: &Scene, checkpoint: Option<Checkpoint>, ranks: &Ranks) -> Result<()>
where
    Dim<D>: Dimension<D>,
{
    let built = ranks.agree(scene.build_on::<D>(ranks), setup_digest);
    // The first rank reports an error that all ranks have.
    let Ok(BuiltScene { setup, part, plan, .. }) = built else { return Ok(()) };
    let mut failure = None;
    let prepared = Follower::new(setup, WaterShare { ranks, part }, plan, checkpoint);
    let mut follower = prepared.map_err(|error| failure = Some(error)).ok();
    loop {
        let time = follower.as_ref().map_or(0.0, |follower| follower.sim.time());
        match exchange(ranks, &Message { order: None, failed: failure.is_some(), time }) {
            Ok(Order::End) => return Ok(()),
            Ok(order) => {
                let failed = follower.as_mut().and_then(|follower| follower.follow(order).err());
                failure = failed.or(failure.filter(|_| order == Order::Frame));
            }
            Err(_) => {
                let _ = exchange(ranks, &Message { order: None, failed: true, time });
                return failure.map_or(Ok(()), Err);
            }
        }
    }
}

/// The simulation of a rank that follows.
struct Follower<const D: usize> {
    sim: Simulation<D>,
    plan: Plan,
    controls: Controls,
    /// The changes of controls so far.
    changes: Vec<ControlChange>,
}

impl<const D: usize> Follower<D>
where
    Dim<D>: Dimension<D>,
{
    fn new(setup: Setup<D>, share: WaterShare<'_>, plan: Plan, checkpoint: Option<Checkpoint>) -> Result<Self> {
        let mut sim = Simulation::set_up(setup, share)?;
        // This rank does not read the probes, but it has to record the data that they read.
        probe_factory::probes_from_plan(&plan, &mut sim)?;
        water_of_ranks::gather_for_checks(&mut sim);
        let mut changes = Vec::new();
        if let Some(checkpoint) = checkpoint {
            sim.restore(&checkpoint.state)?;
            changes = checkpoint.changes;
        }
        sim.store_rollback_states_in(&std::env::temp_dir());
        let controls = Controls::new(&plan.controls, &sim)?;
        Ok(Self { sim, plan, controls, changes })
    }

    fn follow(&mut self, order: Order) -> Result<()> {
        match order {
            Order::Step => {
                let known = self.sim.rollbacks().len();
                self.sim.step_with_own_water(self.plan.until)?;
                if self.sim.rollbacks().len() > known {
                    self.controls.repeat(&mut self.sim, &self.changes);
                }
            }
            Order::Set { control, value } => {
                self.changes.extend(self.controls.set(&mut self.sim, control, value));
            }
            Order::Gather => self.sim.gather_water(false),
            Order::GatherNear => water_of_ranks::know_within(&mut self.sim, &[]),
            Order::Frame => {
                if let Some(FramesPlan { fields, crop, .. }) = &self.plan.frames {
                    let written = frame::write_water(&mut io::empty(), self.sim.system(), fields, crop.as_ref());
                    written.map_err(|e| Error::new(ErrorKind::File, e.to_string()))?;
                }
            }
            Order::Save { rollbacks } => {
                let nothing_is_written = self.sim.write_state(rollbacks, &mut io::sink());
                nothing_is_written.map_err(|e| Error::new(ErrorKind::File, e.to_string()))?;
            }
            Order::End => {}
        }
        Ok(())
    }
}
