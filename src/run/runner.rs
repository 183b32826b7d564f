//! The course of one run: from the built scene to its end, its interruption or its failure.

use std::{io, path::PathBuf, time::Instant};

use super::{
    FinalBodyState, Progress, RunObserver, RunOrigin, RunOutcome, RunRequest, RunStart,
    controls::Controls,
    device,
    energy_drift::DriftMonitor,
    lock::Lock,
    orders::{self, Leader, Order},
    outputs::{Outputs, series_folder},
    probe_factory,
    processor_time::ProcessorTime,
    resume_point, run_folder, statistics,
};
use crate::{
    analysis::{ReferenceCheck, Verdict},
    error::{Error, ErrorKind, Result},
    output::{
        Checkpoint, Manifest, OutputPositions, checkpoint,
        manifest::{ExchangeFigures, FrameTotals, Machine, ParticleCounts, RunStatus, ValueInForce},
        removed_particles, write_atomically,
    },
    preflight,
    ranks::{Ranks, WaterShare},
    scene::{BuiltScene, Plan, RenamedName, ResolvedValue, Scene},
    simulation::{Dimension, Simulation, water_of_ranks},
    solid::{Dim, HasEngine as _, Role},
};

/// A run in progress.
pub(crate) struct Runner<const D: usize> {
    sim: Simulation<D>,
    outputs: Outputs<D>,
    controls: Controls,
    drift_monitor: Option<DriftMonitor>,
    checks: Vec<ReferenceCheck>,
    plan: Plan,
    manifest: Manifest,
    folder: PathBuf,
    /// The data of the next checkpoint that do not change during the run.
    checkpoint: Checkpoint,
    /// Positions of the outputs at each time (s) to which the simulation may roll back, the oldest first.
    rollback_positions: Vec<(f64, OutputPositions)>,
    resumed: bool,
    /// Whether the last checkpoint in the folder, if there is one, is valid and may become the previous one.
    last_checkpoint_valid: bool,
    /// Number of removed particles in the list; `usize::MAX` if the list may contain other particles than those.
    removed_written: usize,
    /// When the last checkpoint was written, and how long after it the next is due (s).
    last_checkpoint: (Instant, f64),
    started_at: Instant,
    /// Processor time of the program when the run began, where the system tells.
    cpu_at_start: ProcessorTime,
    leader: Leader,
    ranks: Ranks,
    _lock: Option<Lock>,
}

impl<const D: usize> Runner<D>
where
    Dim<D>: Dimension<D>,
{
    /// Builds the scene and, if everything is valid, creates the run's folder or reopens it.
    pub(crate) fn new(scene: &Scene, origin: RunOrigin, ranks: &Ranks) -> Result<Self> {
        let (begun, begun_cpu) = (Instant::now(), ProcessorTime::now());
        let built = scene.build_on::<D>(ranks).and_then(|built| device::check_ranks(scene, ranks).map(|()| built));
        let BuiltScene { setup, part, plan, initial_water, file_notes } = ranks.agree(built, orders::setup_digest)?;
        let leader = Leader::new(ranks.clone());
        let mut sim = Simulation::set_up(setup, WaterShare { ranks, part }).map_err(|e| scene.with_location(e))?;
        let probes = probe_factory::probes_from_plan(&plan, &mut sim).map_err(|e| scene.with_location(e))?;
        water_of_ranks::gather_for_checks(&mut sim);
        let checks = probe_factory::checks_from_plan(&plan, &probes).map_err(|e| scene.with_location(e))?;
        let columns: Vec<usize> = probes.iter().map(|p| p.columns().len()).collect();
        let preflight = preflight::preflight(&sim, &plan, initial_water, &columns);
        water_of_ranks::forget_places(&mut sim);
        let mut warnings = preflight.with_file_notes(&file_notes).warnings();
        let notes = file_notes.iter().filter(|note| !note.is_warning);
        let mut notes: Vec<String> = notes.map(|note| format!("{}: {}", note.what, note.remedy)).collect();
        let in_force = scene.to_toml()?;
        let values = scene.resolve()?.into_iter().map(ValueInForce::from).collect();
        // An unusable device leaves no folder, and all files of a resumed run as they are.
        if let RunOrigin::Fresh { .. } = origin {
            sim = device::place_on_device(scene, sim)?;
        }
        let (folder, mut checkpoint, resumed, warning, lock) = match origin {
            RunOrigin::Fresh { file, text, out, overrides } => {
                let folder = run_folder::create_run_folder(file, out)?;
                let lock = Lock::acquire(&folder)?;
                run_folder::copy_scene(file, text, &in_force, &folder)?;
                let files = run_folder::file_hashes(scene, &folder.join("scene"))?;
                (folder, Checkpoint::initial(&in_force, overrides, files), false, None, Some(lock))
            }
            RunOrigin::Resumed { folder, checkpoint, warning, lock } => {
                (folder.to_owned(), *checkpoint, true, warning, lock)
            }
        };
        if resumed {
            // This precedes the truncation of tables, so that an unusable state leaves all files unchanged.
            sim.restore(&std::mem::take(&mut checkpoint.state))?;
            sim = device::place_on_device(scene, sim)?;
        }
        sim.store_rollback_states_in(&folder);
        let outputs = Outputs::new(&plan, probes, &folder, resumed.then_some(&checkpoint.outputs))?;
        let controls = Controls::new(&plan.controls, &sim)?;
        if resumed {
            run_folder::remove_end_files(&folder)?;
        }
        let good = warning.is_none();
        // The list of a killed run may be ahead of its checkpoint.
        let listed = if resumed && folder.join(removed_particles::REMOVED).exists() { usize::MAX } else { 0 };
        warnings.extend(warning);
        notes.extend(checkpoint.changes.iter().map(ToString::to_string));
        warnings.extend(sim.rollbacks().iter().map(ToString::to_string));
        let (name, version) = Dim::<D>::VERSION;
        let engine = format!("{name} {version}");
        let manifest =
            Manifest { engine, warnings, notes, values, scene: in_force, ..initial_manifest(&sim, &plan, &checkpoint) };
        let saved = (Instant::now(), plan.checkpoint_wall);
        Ok(Self {
            sim,
            outputs,
            controls,
            drift_monitor: DriftMonitor::from_plan(&plan, D),
            checks,
            plan,
            manifest,
            folder,
            checkpoint,
            rollback_positions: Vec::new(),
            resumed,
            last_checkpoint_valid: good,
            removed_written: listed,
            last_checkpoint: saved,
            started_at: begun,
            cpu_at_start: begun_cpu,
            leader,
            ranks: ranks.clone(),
            _lock: lock,
        })
    }
}

impl<const D: usize> Runner<D> {
    /// Steps to the end, or until `watch` requests a stop, and returns the outcome. `renamed` lists the former names that the
    /// scene uses.
    pub(crate) fn run(mut self, renamed: &[RenamedName], watch: &mut dyn RunObserver) -> Result<RunOutcome> {
        self.update_manifest();
        self.manifest.write(&self.folder)?;
        let controls = self.controls.readings(&self.sim);
        watch.start(&RunStart { folder: &self.folder, manifest: &self.manifest, renamed, controls: &controls });
        match self.advance(watch) {
            Ok(status) => {
                self.manifest.status = status;
                let mut late = Vec::new();
                self.evaluate_checks();
                if status == RunStatus::Finished {
                    late = statistics::write(&self.folder, &self.plan)?;
                    late.extend(self.sim.violated_joints());
                    self.manifest.warnings.extend(late.iter().cloned());
                }
                self.update_manifest();
                self.manifest.write(&self.folder)?;
                Ok(RunOutcome {
                    bodies: final_body_states(&self.sim),
                    folder: self.folder,
                    manifest: self.manifest,
                    end_warnings: late,
                })
            }
            Err(error) => Err(self.record_failure(error)),
        }
    }

    /// Steps and writes the outputs, and returns the resulting status.
    fn advance(&mut self, watch: &mut dyn RunObserver) -> Result<RunStatus> {
        if !self.resumed {
            let ranges = self.outputs.water_ranges(self.sim.system(), self.sim.time());
            device::fetch(&mut self.sim, &self.leader, ranges)?;
            self.outputs.write_due(&self.sim, &self.leader)?;
        }
        let until = self.manifest.until_s;
        let mut going = self.report_step(watch)?;
        while going && self.sim.time() < until {
            if self.sim.needs_rollback_state() {
                self.rollback_positions.retain(|(time, _)| self.sim.has_rollback_state(*time));
                self.rollback_positions.push((self.sim.time(), self.outputs.positions()));
            }
            let (clock, passes, rescued) = (Instant::now(), self.sim.force_passes(), self.sim.rollbacks().len());
            let known_events = self.sim.events().len();
            let stepped = device::step(&mut self.sim, &self.outputs, &self.leader, until);
            self.checkpoint.stepping_seconds += clock.elapsed().as_secs_f64();
            // Dry boundary particles are not updated and are not counted.
            let moved = self.sim.system().fluid().len() + self.sim.system().boundary_near_fluid_count();
            // A run that went back has made fewer passes than before.
            self.checkpoint.particle_steps += moved as u64 * self.sim.force_passes().saturating_sub(passes);
            stepped?;
            self.follow_rollback(rescued, watch)?;
            self.sim.events().iter().skip(known_events).for_each(|event| watch.event(event));
            let mut written = self.outputs.write_due(&self.sim, &self.leader)?;
            // The wall time decides when a checkpoint is written, never its content.
            written.checkpoint |= self.last_checkpoint.0.elapsed().as_secs_f64() >= self.last_checkpoint.1;
            if written.checkpoint {
                self.save_checkpoint()?;
            }
            if written.checkpoint || written.frame {
                self.write_removed()?;
                self.update_manifest();
                self.manifest.write(&self.folder)?;
            }
            going = self.report_step(watch)?;
        }
        if self.sim.time() < until {
            self.save_checkpoint()?;
            self.write_removed()?;
            return Ok(RunStatus::Interrupted);
        }
        device::fetch_for_last_readings(&mut self.sim, &self.outputs, &self.leader)?;
        self.outputs.finish(&self.sim, &self.leader)?;
        self.write_removed()?;
        Ok(RunStatus::Finished)
    }

    /// Reports the progress to `watch` and fulfils its requests. Returns whether the run goes on.
    fn report_step(&mut self, watch: &mut dyn RunObserver) -> Result<bool> {
        let mut going = watch.step(&self.progress());
        while going && let Some(request) = watch.request() {
            match request {
                RunRequest::Checkpoint => {
                    self.save_checkpoint()?;
                    self.write_removed()?;
                    self.update_manifest();
                    self.manifest.write(&self.folder)?;
                }
                RunRequest::Stop => going = false,
                RunRequest::Set { control, value } => {
                    self.leader.order(Order::Set { control, value }, self.sim.time())?;
                    if let Some(change) = self.controls.set(&mut self.sim, control, value) {
                        self.manifest.notes.push(change.to_string());
                        watch.control_changed(&change);
                        self.checkpoint.changes.push(change);
                    }
                }
            }
        }
        Ok(going)
    }

    /// Handles a rollback of the simulation beyond the `known` ones. Reports it to the observer and in the manifest. Removes the
    /// outputs that were written after the time to which the simulation returned.
    fn follow_rollback(&mut self, known: usize, watch: &mut dyn RunObserver) -> Result<()> {
        let Some(how) = self.sim.rollbacks().get(known).cloned() else {
            return Ok(());
        };
        watch.rolled_back(&how);
        self.controls.repeat(&mut self.sim, &self.checkpoint.changes);
        self.manifest.warnings.push(how.to_string());
        // The same number of particles may leave again, but other ones.
        self.removed_written = if self.removed_written > 0 { usize::MAX } else { 0 };
        let Some((_, extent)) = self.rollback_positions.iter().rfind(|(time, _)| *time == how.back_to).cloned() else {
            return Ok(());
        };
        // Both checkpoints are replaced first: the existing ones may be later than this state and need rows that are removed
        // next. The state precedes the alarm: a resumed run meets the alarm again, unless its guard has changed.
        self.last_checkpoint_valid = false;
        self.outputs.sync()?;
        self.write_checkpoint(known, extent.clone())?;
        self.write_checkpoint(known, extent.clone())?;
        self.outputs.roll_back_to(&extent)
    }

    /// Writes the list of removed particles, if it has changed.
    fn write_removed(&mut self) -> Result<()> {
        let lost = self.sim.removed_particles();
        if lost.len() != self.removed_written {
            removed_particles::write(&self.folder, lost)?;
            self.removed_written = lost.len();
        }
        Ok(())
    }

    /// Writes the checkpoint after all outputs are on the disk.
    fn save_checkpoint(&mut self) -> Result<()> {
        device::fetch(&mut self.sim, &self.leader, Some(Vec::new()))?;
        self.outputs.sync()?;
        self.write_checkpoint(self.sim.rollbacks().len(), self.outputs.positions())
    }

    /// Writes a checkpoint with the present state of the simulation, only the first `rollbacks` of its rollbacks, and the
    /// positions `outputs`.
    fn write_checkpoint(&mut self, rollbacks: usize, outputs: OutputPositions) -> Result<()> {
        let (time, wall, cpu) = (self.sim.time(), self.wall_seconds(), self.cpu_seconds());
        let now = Checkpoint { time, wall_seconds: wall, cpu_seconds: cpu, outputs, ..self.checkpoint.clone() };
        self.leader.order(Order::Save { rollbacks }, time)?;
        let mut is_given = false;
        let written = now.write(&self.folder, self.last_checkpoint_valid, |out| {
            is_given = true;
            self.sim.write_state(rollbacks, out)
        });
        if !is_given {
            // The other ranks send their data even if the file cannot be written.
            let _ = self.sim.write_state(rollbacks, &mut io::sink());
        }
        written?;
        (self.last_checkpoint_valid, self.last_checkpoint.0) = (true, Instant::now());
        Ok(())
    }

    /// Saves the remaining data of a run that cannot continue. Returns the error with the folder of these data.
    fn record_failure(mut self, mut error: Error) -> Error {
        let mut reports = Vec::new();
        if let Some(fault) = &error.fault {
            // Even if one of these files cannot be written, the error reports the fault itself.
            reports.push(self.outputs.write_last_frame(&self.sim, &self.leader));
            reports.push(self.write_removed());
            let text = serde_json::to_vec_pretty(fault).unwrap_or_default();
            reports.push(write_atomically(&self.folder.join(run_folder::FAILURE), &text));
        }
        self.update_manifest();
        self.manifest.record_failure(&error);
        self.evaluate_checks();
        reports.push(self.manifest.write(&self.folder));
        let kept =
            if reports.iter().all(Result::is_ok) { "everything recorded so far is" } else { "what could be kept is" };
        let mut help = error.help.take().map_or_else(String::new, |help| help + "\n");
        if self.folder.exists() {
            help += &format!("{kept} in {}", self.folder.display());
        }
        if error.kind == ErrorKind::File && resume_point::has_checkpoint(&self.folder) {
            help += &format!("\nonce that is mended, go on with `pontoon resume {}`", self.folder.display());
        }
        error.help(help)
    }

    /// Compares the series with their references. An unfinished run neither meets nor misses a bound.
    fn evaluate_checks(&mut self) {
        let series = series_folder(&self.folder);
        let whole = self.manifest.status == RunStatus::Finished;
        let judge = |check: &ReferenceCheck| match check.verdict(&series) {
            verdict if whole || verdict.passed.is_none() => verdict,
            part => Verdict { passed: None, note: Some("the run has not finished: not judged".into()), ..part },
        };
        self.manifest.checks = self.checks.iter().map(judge).collect();
    }

    /// Brings the manifest's figures up to date.
    fn update_manifest(&mut self) {
        let now = self.progress();
        self.manifest.removed = self.sim.removed_particles().len();
        self.manifest.events = self.sim.events().iter().map(ToString::to_string).collect();
        self.manifest.steps = now.steps;
        self.manifest.simulated_s = now.time;
        self.manifest.wall_s = now.wall;
        self.manifest.cpu_s = self.cpu_seconds();
        self.manifest.ranks = self.exchange_figures();
        self.manifest.particle_steps = self.checkpoint.particle_steps;
        self.manifest.particle_steps_per_second = now.rate;
        self.manifest.frames = self.outputs.frame_totals();
        let there = |name: &&str| self.folder.join(name).exists();
        let fixed = [
            statistics::STATISTICS_FILE,
            statistics::SPECTRA_FILE,
            statistics::RAO_FILE,
            "frames.pvd",
            checkpoint::LAST,
            checkpoint::PREVIOUS,
            removed_particles::REMOVED,
            run_folder::FAILURE,
            run_folder::SCENE,
        ];
        let mut files: Vec<String> = self.outputs.table_paths().collect();
        files.extend(fixed.iter().filter(|name| there(name)).map(|name| name.to_string()));
        files.push("manifest.json".into());
        self.manifest.files = files;
    }

    /// Returns what the ranks have exchanged, if there are several.
    fn exchange_figures(&self) -> Option<ExchangeFigures> {
        let (count, traffic) = (self.ranks.count(), self.ranks.traffic());
        let time_share = traffic.time.as_secs_f64() / self.started_at.elapsed().as_secs_f64();
        (count > 1).then_some(ExchangeFigures { count, received_bytes: traffic.bytes, time_share })
    }

    /// Returns the wall time so far, s.
    fn wall_seconds(&self) -> f64 {
        self.checkpoint.wall_seconds + self.started_at.elapsed().as_secs_f64()
    }

    /// Returns the processor time so far, s; if it cannot be read, the processor time available to all threads.
    fn cpu_seconds(&self) -> f64 {
        let threads = rayon::current_num_threads() as f64;
        let available = || threads * self.started_at.elapsed().as_secs_f64();
        self.checkpoint.cpu_seconds + self.cpu_at_start.elapsed().unwrap_or_else(available)
    }

    fn progress(&self) -> Progress {
        let work = self.checkpoint.particle_steps as f64;
        let stepping = self.checkpoint.stepping_seconds;
        Progress {
            time: self.sim.time(),
            until: self.manifest.until_s,
            dt: self.sim.dt(),
            steps: self.sim.steps(),
            wall: self.wall_seconds(),
            rate: if stepping > 0.0 { work / stepping } else { 0.0 },
            energy: self.drift_monitor.and_then(|teller| teller.drift(self.outputs.table(teller.probe))),
        }
    }
}

/// Returns the manifest before the first step.
fn initial_manifest<const D: usize>(sim: &Simulation<D>, plan: &Plan, checkpoint: &Checkpoint) -> Manifest {
    Manifest {
        status: RunStatus::Running,
        title: plan.title.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        commit: option_env!("PONTOON_COMMIT").map(String::from),
        engine: String::new(),
        threads: rayon::current_num_threads(),
        ranks: None,
        particles: ParticleCounts { fluid: sim.system().fluid().len(), boundary: sim.system().boundary().len() },
        removed: 0,
        steps: 0,
        simulated_s: 0.0,
        until_s: plan.until,
        wall_s: 0.0,
        cpu_s: 0.0,
        particle_steps: 0,
        particle_steps_per_second: 0.0,
        checks: vec![],
        files: vec![],
        frames: FrameTotals::default(),
        error: None,
        error_code: None,
        fault: None,
        warnings: vec![],
        notes: vec![],
        events: vec![],
        machine: Machine::current(),
        set: checkpoint.overrides.iter().cloned().collect(),
        values: vec![],
        scene: String::new(),
    }
}

impl From<ResolvedValue> for ValueInForce {
    fn from(of: ResolvedValue) -> Self {
        Self { key: of.key, value: of.value, source: of.source.to_string() }
    }
}

/// Returns the present states of the free bodies.
fn final_body_states<const D: usize>(sim: &Simulation<D>) -> Vec<FinalBodyState> {
    let free = sim.system().solids().iter().filter(|s| matches!(s.spec.role, Role::Free(_)));
    free.map(|s| FinalBodyState {
        name: s.spec.name.clone(),
        position: s.kinematics.centre.iter().copied().collect(),
        speed: s.kinematics.velocity.norm(),
        rotation_deg: s.kinematics.pose.rotation_vector().into_iter().map(f64::to_degrees).collect(),
    })
    .collect()
}

#[cfg(test)]
mod tests;
