//! The outputs that a run writes while it proceeds, and their times: tables of the probes, frames, checkpoints.
//!
//! An output is due at multiples of its interval. The run writes it after the first step that reaches its due time, so that no
//! output changes a time step. A table records the time after that step.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{
    orders::{Leader, Order},
    probe_factory,
};
#[cfg(feature = "gpu")]
use crate::probe::ProbeReads;
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result},
    math::Bounds,
    output::{CsvTable, FrameWriter, IntervalMean, OutputPositions, manifest::FrameTotals},
    probe::{self, Probe},
    scene::Plan,
    simulation::Simulation,
    system::System,
};

/// The multiples of an interval; an interval of zero means every step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct OutputSchedule {
    every: f64,
    next: u64,
}

impl OutputSchedule {
    /// Returns the multiple that time `t` (s) reaches: round-off may leave a time slightly below one that it should equal.
    fn reached(t: f64) -> f64 {
        t * (1.0 + 1e-12)
    }

    /// Returns whether time `t` (s) reaches the next multiple.
    fn is_due(&self, t: f64) -> bool {
        Self::reached(t) >= self.next as f64 * self.every
    }

    /// Returns whether time `t` (s) reaches the next multiple; if so, advances past this and all missed multiples.
    fn advance_if_due(&mut self, t: f64) -> bool {
        if !self.is_due(t) {
            return false;
        }
        let reached = Self::reached(t);
        self.next = if self.every > 0.0 { ((reached / self.every) as u64).saturating_add(1) } else { 0 };
        true
    }
}

/// A probe, its table and its reading times.
struct ProbeOutput<const D: usize> {
    probe: Box<dyn Probe<D>>,
    table: CsvTable,
    due: OutputSchedule,
    /// The readings of every step since the last row, if the probe takes means or follows angles.
    mean: Option<IntervalMean>,
    /// Whether the probe takes means in each column.
    are_means: Vec<bool>,
}

impl<const D: usize> ProbeOutput<D> {
    /// Returns whether rows have means. A probe that follows angles reads solids alone, so that it needs nothing in other steps.
    fn takes_means(&self) -> bool {
        self.are_means.contains(&true)
    }

    /// Reads the probe if necessary, and writes a row if `due`.
    fn sample(&mut self, sim: &Simulation<D>, due: bool) -> Result<()> {
        let t = sim.time();
        // A row may already be written at the end time.
        let due = due && self.table.last_row().is_none_or(|(last, _)| last < t);
        let before = self.mean.as_ref().and_then(IntervalMean::last).or_else(|| self.table.last_row());
        let fresh = before.is_none_or(|(last, _)| last < t);
        if !due && (self.mean.is_none() || !fresh) {
            return Ok(());
        }
        let read = || {
            let mut row = self.probe.sample(sim);
            if let Some((last, before)) = before {
                self.probe.continue_from(before, &mut row, t - last);
            }
            row
        };
        let row = fresh.then(read);
        let row = match (&mut self.mean, row) {
            (Some(mean), row) => {
                row.into_iter().for_each(|row| mean.add(t, row));
                due.then(|| mean.take(&self.are_means))
            }
            (None, row) => row,
        };
        row.map_or(Ok(()), |row| self.table.append_row(t, &row))
    }
}

/// A list of all contacts and its writing times.
struct ContactListOutput {
    table: CsvTable,
    due: OutputSchedule,
}

impl ContactListOutput {
    /// Writes a row for each pair in contact, unless the list already has rows of this instant.
    fn sample<const D: usize>(&mut self, sim: &Simulation<D>) -> Result<()> {
        let t = sim.time();
        match self.table.last_row() {
            Some((last, _)) if last >= t => Ok(()),
            _ => self.table.append_rows(t, &probe::ContactList::sample(sim)),
        }
    }
}

/// The results of writing the outputs of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct StepOutput {
    /// A frame was written.
    pub frame: bool,
    /// A checkpoint is due.
    pub checkpoint: bool,
}

/// All outputs of a run.
pub(crate) struct Outputs<const D: usize> {
    probes: Vec<ProbeOutput<D>>,
    contact_lists: Vec<ContactListOutput>,
    frames: Option<(FrameWriter, OutputSchedule)>,
    checkpoint: Option<OutputSchedule>,
}

impl<const D: usize> Outputs<D> {
    /// Opens the outputs of `plan` in the run's `folder`. If `from` is present, the outputs continue from these positions of a
    /// checkpoint. `probes` are the result of `probe_factory::probes_from_plan`, in the plan's order.
    ///
    /// # Errors
    /// `File` if a file cannot be written; `Restart` if the existing files do not match the checkpoint.
    pub(crate) fn new(
        plan: &Plan,
        probes: Vec<Box<dyn Probe<D>>>,
        folder: &Path,
        from: Option<&OutputPositions>,
    ) -> Result<Self> {
        let lists = plan.contacts.len();
        let all = probes.len() + lists;
        if from.is_some_and(|c| c.table_bytes.len() != all || c.next_due.len() != all + 2) {
            return Err(Error::new(ErrorKind::Restart, "the checkpoint was made with other probes")
                .with_code(ErrorCode::OtherSetup));
        }
        let series = series_folder(folder);
        let lists = (lists > 0).then(|| folder.join(LISTS));
        for folder in [&series].into_iter().chain(&lists) {
            fs::create_dir_all(folder).map_err(|why| Error::write(folder, "made", &why))?;
        }
        let next = |i: usize, start: u64| from.map_or(start, |c| c.next_due[i]);
        let mut watched = Vec::new();
        for (i, (probe, words)) in probes.into_iter().zip(&plan.probes).enumerate() {
            let path = series.join(format!("{}.csv", words.name));
            let table = match from {
                Some(extent) => CsvTable::resume(&path, &probe.columns(), extent.table_bytes[i])?,
                None => CsvTable::create(&path, &probe.columns())?,
            };
            let due = OutputSchedule { every: words.every, next: next(i, 0) };
            let kept = from.and_then(|extent| extent.means.get(i).cloned().flatten());
            let are_means = probe.columns().iter().map(|column| words.is_mean(column)).collect();
            let mean = (words.average || probe.follows_angles()).then(|| kept.unwrap_or_default());
            watched.push(ProbeOutput { probe, table, due, mean, are_means });
        }
        let count = watched.len();
        let mut contacts = Vec::new();
        for (i, words) in plan.contacts.iter().enumerate() {
            let (path, columns) = (contact_list_path(folder, &words.name), probe::ContactList::columns::<D>());
            let table = match from {
                Some(extent) => CsvTable::resume(&path, &columns, extent.table_bytes[count + i])?,
                None => CsvTable::create(&path, &columns)?,
            };
            contacts.push(ContactListOutput {
                table,
                due: OutputSchedule { every: words.every, next: next(count + 2 + i, 0) },
            });
        }
        let frames = match &plan.frames {
            Some(words) => {
                let times = from.map_or_else(Vec::new, |c| c.frame_times.clone());
                let due = OutputSchedule { every: words.every, next: next(count, 0) };
                Some((FrameWriter::new(folder, words, times)?, due))
            }
            None => None,
        };
        let checkpoint = plan.checkpoint_every.map(|every| OutputSchedule { every, next: next(count + 1, 1) });
        Ok(Self { probes: watched, contact_lists: contacts, frames, checkpoint })
    }

    /// Returns the earliest time (s) at which an output is due; a past time if an output reads every step.
    #[cfg(feature = "gpu")]
    pub(crate) fn next_due(&self) -> f64 {
        let at = |due: &OutputSchedule| due.next as f64 * due.every;
        let probes = self.probes.iter().map(|own| if own.takes_means() { 0.0 } else { at(&own.due) });
        let lists = self.contact_lists.iter().map(|list| at(&list.due));
        let rest = self.frames.iter().map(|(_, due)| at(due)).chain(self.checkpoint.iter().map(at));
        probes.chain(lists).chain(rest).fold(f64::INFINITY, f64::min)
    }

    /// Returns the parts of the simulation that are read by the outputs due at time `t` (s).
    #[cfg(feature = "gpu")]
    pub(crate) fn reads_at(&self, t: f64) -> Vec<ProbeReads> {
        let rest = self.frames.iter().map(|(_, due)| due).chain(&self.checkpoint).filter(|due| due.is_due(t));
        self.due_probes(t).map(|own| own.probe.reads()).chain(rest.map(|_| ProbeReads::Water)).collect()
    }

    /// Returns the boxes (m) in which the probes that are due at time `t` (s) read the water, or `None` if they may read all water.
    pub(crate) fn water_ranges(&self, system: &System<D>, t: f64) -> Option<Vec<Bounds<D>>> {
        probe_factory::water_ranges(self.due_probes(t).map(|own| &*own.probe), system)
    }

    /// Returns the probes that are due at time `t` (s).
    fn due_probes(&self, t: f64) -> impl Iterator<Item = &ProbeOutput<D>> {
        self.probes.iter().filter(move |own| own.takes_means() || own.due.is_due(t))
    }

    /// Writes the outputs that are due now, except for the checkpoint, and returns which events occurred.
    ///
    /// # Errors
    /// `File` if something cannot be written.
    pub(crate) fn write_due(&mut self, sim: &Simulation<D>, leader: &Leader) -> Result<StepOutput> {
        let t = sim.time();
        let mut written = StepOutput::default();
        for watched in &mut self.probes {
            let due = watched.due.advance_if_due(t);
            watched.sample(sim, due)?;
        }
        for list in &mut self.contact_lists {
            if list.due.advance_if_due(t) {
                list.sample(sim)?;
            }
        }
        if let Some((frames, due)) = &mut self.frames
            && due.advance_if_due(t)
            && frames.times().last().is_none_or(|&last| last < t)
        {
            leader.order(Order::Frame, t)?;
            frames.write(sim.system(), &sim.mooring_readings(), t)?;
            written.frame = true;
        }
        written.checkpoint = self.checkpoint.as_mut().is_some_and(|due| due.advance_if_due(t));
        Ok(written)
    }

    /// Writes the last row of every table and the last frame, unless they are already written.
    ///
    /// # Errors
    /// `File` if something cannot be written.
    pub(crate) fn finish(&mut self, sim: &Simulation<D>, leader: &Leader) -> Result<()> {
        for watched in &mut self.probes {
            watched.sample(sim, true)?;
            watched.table.sync()?;
        }
        for list in &mut self.contact_lists {
            list.sample(sim)?;
            list.table.sync()?;
        }
        self.write_last_frame(sim, leader)
    }

    /// Writes a frame of this instant, unless one is already written.
    ///
    /// # Errors
    /// `File` if it cannot be written.
    pub(crate) fn write_last_frame(&mut self, sim: &Simulation<D>, leader: &Leader) -> Result<()> {
        match &mut self.frames {
            Some((frames, _)) if frames.times().last().is_none_or(|&t| t < sim.time()) => {
                leader.order(Order::Frame, sim.time())?;
                frames.write(sim.system(), &sim.mooring_readings(), sim.time())
            }
            _ => Ok(()),
        }
    }

    /// Returns the totals of the frames written so far.
    pub(crate) fn frame_totals(&self) -> FrameTotals {
        let kept = |(frames, _): &(FrameWriter, OutputSchedule)| FrameTotals {
            count: frames.times().len(),
            bytes: frames.bytes(),
        };
        self.frames.as_ref().map_or_else(FrameTotals::default, kept)
    }

    /// Returns the table of the probe with number `probe` in the plan.
    pub(crate) fn table(&self, probe: usize) -> &CsvTable {
        &self.probes[probe].table
    }

    /// Returns the paths of the tables, relative to the run's folder.
    pub(crate) fn table_paths(&self) -> impl Iterator<Item = String> + '_ {
        let series = self.probes.iter().map(|watched| ("series", &watched.table));
        let lists = self.contact_lists.iter().map(|list| (LISTS, &list.table));
        let name = |(folder, table): (&str, &CsvTable)| {
            Some(format!("{folder}/{}", table.path().file_name()?.to_string_lossy()))
        };
        series.chain(lists).filter_map(name)
    }

    /// Returns the present positions of the outputs.
    pub(crate) fn positions(&self) -> OutputPositions {
        let mut due: Vec<u64> = self.probes.iter().map(|w| w.due.next).collect();
        due.push(self.frames.as_ref().map_or(0, |(_, due)| due.next));
        due.push(self.checkpoint.map_or(0, |due| due.next));
        due.extend(self.contact_lists.iter().map(|list| list.due.next));
        OutputPositions {
            table_bytes: self.tables().map(CsvTable::bytes).collect(),
            means: self.probes.iter().map(|w| w.mean.clone()).collect(),
            frame_times: self.frames.as_ref().map_or_else(Vec::new, |(frames, _)| frames.times().to_vec()),
            next_due: due,
        }
    }

    /// Removes all rows and frames after the positions `extent`. Does not reset the due time of the next checkpoint: none is
    /// due until the run has passed the alarm that caused the rollback.
    ///
    /// # Errors
    /// `File` if the disk reports an error.
    pub(crate) fn roll_back_to(&mut self, extent: &OutputPositions) -> Result<()> {
        let count = self.probes.len();
        for (i, watched) in self.probes.iter_mut().enumerate() {
            watched.table.truncate(extent.table_bytes[i])?;
            watched.mean.clone_from(&extent.means[i]);
            watched.due.next = extent.next_due[i];
        }
        if let Some((frames, due)) = &mut self.frames {
            frames.truncate(extent.frame_times.len())?;
            due.next = extent.next_due[count];
        }
        for (i, list) in self.contact_lists.iter_mut().enumerate() {
            list.table.truncate(extent.table_bytes[count + i])?;
            list.due.next = extent.next_due[count + 2 + i];
        }
        Ok(())
    }

    /// Waits until all written data are stored on the disk.
    ///
    /// # Errors
    /// `File` if the disk reports an error.
    pub(crate) fn sync(&mut self) -> Result<()> {
        self.tables().try_for_each(CsvTable::sync)?;
        self.frames.as_mut().map_or(Ok(()), |(frames, _)| frames.sync())
    }

    /// Returns the tables of the probes, then the tables of the contact lists.
    fn tables(&self) -> impl Iterator<Item = &CsvTable> {
        self.probes.iter().map(|w| &w.table).chain(self.contact_lists.iter().map(|list| &list.table))
    }
}

/// Returns the folder of the tables in the run's `folder`.
pub(crate) fn series_folder(folder: &Path) -> PathBuf {
    folder.join("series")
}

/// Folder of the contact lists in the run's folder. They have many rows at one time and are therefore not series.
const LISTS: &str = "lists";

/// Returns the path of the list called `name` in the run's `folder`.
pub(crate) fn contact_list_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(LISTS).join(format!("{name}.csv"))
}

#[cfg(test)]
#[path = "../../tests/unit/run/outputs.rs"]
mod tests;
