//! What a run writes while it goes on, and when: tables of the probes, frames, checkpoints.
//!
//! An output is due at the multiples of its interval, and is written at the first step at or past them, so
//! that it never bends a time step; a table records the true time.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{
    error::{Error, Kind, Result},
    output::{Extent, Frames, Mean, Table, manifest::Pictures},
    probe::{self, Probe},
    scene::Plan,
    simulation::Simulation,
};

/// The multiples of an interval; an interval of zero means every step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Due {
    every: f64,
    next: u64,
}

impl Due {
    /// Whether the next one is reached at time `t` (s); if so, moves past it and all that are missed.
    fn take(&mut self, t: f64) -> bool {
        // A time that should be a multiple may lie a few last bits below it.
        let reached = t * (1.0 + 1e-12);
        if reached < self.next as f64 * self.every {
            return false;
        }
        self.next = if self.every > 0.0 { ((reached / self.every) as u64).saturating_add(1) } else { 0 };
        true
    }
}

/// A probe, its table, and when it is read.
struct Watched<const D: usize> {
    probe: Box<dyn Probe<D>>,
    table: Table,
    due: Due,
    /// What it has read since the last row, at every step, if it takes means.
    mean: Option<Mean>,
}

impl<const D: usize> Watched<D> {
    /// Reads if it must, and writes a row if one is `due`.
    fn look(&mut self, sim: &Simulation<D>, due: bool) -> Result<()> {
        let t = sim.time();
        // The end may be an instant at which a row was due.
        let due = due && self.table.last().is_none_or(|(last, _)| last < t);
        let before = match &self.mean {
            Some(mean) => mean.last(),
            None => self.table.last(),
        };
        let fresh = before.is_none_or(|(last, _)| last < t);
        if !due && (self.mean.is_none() || !fresh) {
            return Ok(());
        }
        let read = || {
            let mut row = self.probe.look(sim);
            if let Some((last, before)) = before {
                self.probe.follow(before, &mut row, t - last);
            }
            row
        };
        let row = fresh.then(read);
        let row = match (&mut self.mean, row) {
            (Some(mean), row) => {
                row.into_iter().for_each(|row| mean.add(t, row));
                due.then(|| mean.take(self.probe.totals()))
            }
            (None, row) => row,
        };
        row.map_or(Ok(()), |row| self.table.row(t, &row))
    }
}

/// A list of all contacts, and when it grows.
struct Listed {
    table: Table,
    due: Due,
}

impl Listed {
    /// Writes a row for each pair that touches now, unless there are some of this instant.
    fn look<const D: usize>(&mut self, sim: &Simulation<D>) -> Result<()> {
        let t = sim.time();
        match self.table.last() {
            Some((last, _)) if last >= t => Ok(()),
            _ => self.table.rows(t, &probe::Contacts::look(sim)),
        }
    }
}

/// What a look wrote besides rows, or asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// A frame was written.
    pub frame: bool,
    /// A checkpoint is due.
    pub checkpoint: bool,
}

/// All outputs of a run.
pub struct Outputs<const D: usize> {
    watched: Vec<Watched<D>>,
    contacts: Vec<Listed>,
    frames: Option<(Frames, Due)>,
    checkpoint: Option<Due>,
}

impl<const D: usize> Outputs<D> {
    /// The outputs that `plan` asks for, in the run's `folder`; `from` where they were at the checkpoint, if there is one.
    /// `probes` are those of [`looks::probes`](super::looks::probes), in the plan's order.
    ///
    /// # Errors
    /// `File` if a file cannot be written; `Restart` if what is there does not fit the checkpoint.
    pub fn new(plan: &Plan, probes: Vec<Box<dyn Probe<D>>>, folder: &Path, from: Option<&Extent>) -> Result<Self> {
        let lists = plan.contacts.len();
        let all = probes.len() + lists;
        if from.is_some_and(|c| c.tables.len() != all || c.due.len() != all + 2) {
            return Err(Error::new(Kind::Restart, "the checkpoint was made with other probes"));
        }
        let series = series_folder(folder);
        let lists = (lists > 0).then(|| folder.join(LISTS));
        for folder in [&series].into_iter().chain(&lists) {
            fs::create_dir_all(folder).map_err(|why| Error::file(folder, format!("cannot be made: {why}")))?;
        }
        let next = |i: usize, start: u64| from.map_or(start, |c| c.due[i]);
        let mut watched = Vec::new();
        for (i, (probe, words)) in probes.into_iter().zip(&plan.probes).enumerate() {
            let path = series.join(format!("{}.csv", words.name));
            let table = match from {
                Some(extent) => Table::resume(&path, &probe.columns(), extent.tables[i])?,
                None => Table::create(&path, &probe.columns())?,
            };
            let due = Due { every: words.every, next: next(i, 0) };
            let kept = from.and_then(|extent| extent.means.get(i).cloned().flatten());
            watched.push(Watched { probe, table, due, mean: words.average.then(|| kept.unwrap_or_default()) });
        }
        let count = watched.len();
        let mut contacts = Vec::new();
        for (i, words) in plan.contacts.iter().enumerate() {
            let (path, columns) = (list_of(folder, &words.name), probe::Contacts::columns::<D>());
            let table = match from {
                Some(extent) => Table::resume(&path, &columns, extent.tables[count + i])?,
                None => Table::create(&path, &columns)?,
            };
            contacts.push(Listed { table, due: Due { every: words.every, next: next(count + 2 + i, 0) } });
        }
        let frames = match &plan.frames {
            Some(words) => {
                let times = from.map_or_else(Vec::new, |c| c.frames.clone());
                let due = Due { every: words.every, next: next(count, 0) };
                Some((Frames::new(folder, words, times)?, due))
            }
            None => None,
        };
        let checkpoint = plan.checkpoint_every.map(|every| Due { every, next: next(count + 1, 1) });
        Ok(Self { watched, contacts, frames, checkpoint })
    }

    /// Writes what is due now, but for the checkpoint.
    ///
    /// # Errors
    /// `File` if something cannot be written.
    pub fn look(&mut self, sim: &Simulation<D>) -> Result<Written> {
        let t = sim.time();
        let mut written = Written::default();
        for watched in &mut self.watched {
            let due = watched.due.take(t);
            watched.look(sim, due)?;
        }
        for list in &mut self.contacts {
            if list.due.take(t) {
                list.look(sim)?;
            }
        }
        if let Some((frames, due)) = &mut self.frames
            && due.take(t)
            && frames.times().last().is_none_or(|&last| last < t)
        {
            frames.write(sim.system(), t)?;
            written.frame = true;
        }
        written.checkpoint = self.checkpoint.as_mut().is_some_and(|due| due.take(t));
        Ok(written)
    }

    /// Writes the last row of every table and the last frame, unless they are there already.
    ///
    /// # Errors
    /// `File` if something cannot be written.
    pub fn finish(&mut self, sim: &Simulation<D>) -> Result<()> {
        for watched in &mut self.watched {
            watched.look(sim, true)?;
            watched.table.sync()?;
        }
        for list in &mut self.contacts {
            list.look(sim)?;
            list.table.sync()?;
        }
        self.last_frame(sim)
    }

    /// Writes a frame of this instant, unless there is one.
    ///
    /// # Errors
    /// `File` if it cannot be written.
    pub fn last_frame(&mut self, sim: &Simulation<D>) -> Result<()> {
        match &mut self.frames {
            Some((frames, _)) if frames.times().last().is_none_or(|&t| t < sim.time()) => {
                frames.write(sim.system(), sim.time())
            }
            _ => Ok(()),
        }
    }

    /// The frames so far.
    pub fn frames(&self) -> Pictures {
        let kept = |(frames, _): &(Frames, Due)| Pictures { count: frames.times().len(), bytes: frames.bytes() };
        self.frames.as_ref().map_or_else(Pictures::default, kept)
    }

    /// The table of the plan's probe number `probe`.
    pub fn table(&self, probe: usize) -> &Table {
        &self.watched[probe].table
    }

    /// Paths of the tables, from the run's folder.
    pub fn paths(&self) -> impl Iterator<Item = String> + '_ {
        let series = self.watched.iter().map(|watched| ("series", &watched.table));
        let lists = self.contacts.iter().map(|list| (LISTS, &list.table));
        let name =
            |(folder, table): (&str, &Table)| Some(format!("{folder}/{}", table.path().file_name()?.to_string_lossy()));
        series.chain(lists).filter_map(name)
    }

    /// How far the outputs are.
    pub fn extent(&self) -> Extent {
        let mut due: Vec<u64> = self.watched.iter().map(|w| w.due.next).collect();
        due.push(self.frames.as_ref().map_or(0, |(_, due)| due.next));
        due.push(self.checkpoint.map_or(0, |due| due.next));
        due.extend(self.contacts.iter().map(|list| list.due.next));
        Extent {
            tables: self.tables().map(Table::bytes).collect(),
            means: self.watched.iter().map(|w| w.mean.clone()).collect(),
            frames: self.frames.as_ref().map_or_else(Vec::new, |(frames, _)| frames.times().to_vec()),
            due,
        }
    }

    /// Takes back what was written since the outputs were as `extent` says. The next checkpoint is due when it was: not before
    /// what ended the course is past.
    ///
    /// # Errors
    /// `File` if the disk refuses.
    pub fn cut(&mut self, extent: &Extent) -> Result<()> {
        let count = self.watched.len();
        for (i, watched) in self.watched.iter_mut().enumerate() {
            watched.table.cut(extent.tables[i])?;
            watched.mean.clone_from(&extent.means[i]);
            watched.due.next = extent.due[i];
        }
        if let Some((frames, due)) = &mut self.frames {
            frames.cut(extent.frames.len())?;
            due.next = extent.due[count];
        }
        for (i, list) in self.contacts.iter_mut().enumerate() {
            list.table.cut(extent.tables[count + i])?;
            list.due.next = extent.due[count + 2 + i];
        }
        Ok(())
    }

    /// Waits until all that is written is on the disk itself.
    ///
    /// # Errors
    /// `File` if the disk refuses.
    pub fn sync(&mut self) -> Result<()> {
        self.tables().try_for_each(Table::sync)?;
        self.frames.as_mut().map_or(Ok(()), |(frames, _)| frames.sync())
    }

    /// The tables of the probes, then of the lists.
    fn tables(&self) -> impl Iterator<Item = &Table> {
        self.watched.iter().map(|w| &w.table).chain(self.contacts.iter().map(|list| &list.table))
    }
}

/// The folder of the tables in the run's `folder`.
pub fn series_folder(folder: &Path) -> PathBuf {
    folder.join("series")
}

/// Where the lists of contacts lie in the run's folder: with many rows at one time, they are no series.
const LISTS: &str = "lists";

/// The file of the list called `name` in the run's `folder`.
pub fn list_of(folder: &Path, name: &str) -> PathBuf {
    folder.join(LISTS).join(format!("{name}.csv"))
}

#[cfg(test)]
mod tests {
    use super::Due;

    #[test]
    fn an_output_is_due_once_at_each_multiple_and_skips_those_missed() {
        let mut due = Due { every: 0.1, next: 0 };
        let times = [0.0, 0.05, 0.1 - 1e-15, 0.15, 0.2999999999999999, 0.3, 0.31, 0.75, 0.79, 0.8];
        let taken: Vec<f64> = times.into_iter().filter(|&t| due.take(t)).collect();
        assert_eq!(taken, [0.0, 0.1 - 1e-15, 0.2999999999999999, 0.75, 0.8]);
        let mut every_step = Due { every: 0.0, next: 0 };
        assert!(every_step.take(0.0) && every_step.take(1e-6) && every_step.take(2e-6));
        // More multiples than a number holds: every step, too.
        let mut hardly = Due { every: 1e-300, next: 0 };
        assert!(hardly.take(0.0) && hardly.take(1.0) && hardly.take(2.0));
    }
}
