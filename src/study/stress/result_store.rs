//! Runs a list of cases, several at a time. One file stores the results, so that the same command resumes the list.

use std::{
    collections::BTreeMap,
    fs,
    path::PathBuf,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
};

use serde::{Deserialize, Serialize};

use super::{CaseRun, StressCase, StressMap, criteria::CaseOutcome, map_chart};
use crate::{
    error::{Error, Result},
    output::write_atomically,
};

/// A case and its result, if the case has run.
#[derive(Clone, Debug)]
pub struct CaseResult {
    /// The case.
    pub case: StressCase,
    /// The run of the case.
    pub run: Option<CaseRun>,
}

/// The cases of several maps and their results.
pub struct StressResults {
    out: PathBuf,
    maps: Vec<StressMap>,
    /// All cases, map by map.
    pub entries: Vec<CaseResult>,
    /// The runs of cases outside the current list; the file retains these runs.
    unlisted: Vec<CaseRun>,
}

#[derive(Serialize, Deserialize)]
struct StoredResults {
    version: String,
    counts: BTreeMap<String, usize>,
    trials: Vec<StoredRow>,
}

#[derive(Serialize, Deserialize)]
struct StoredRow {
    outcome: CaseOutcome,
    missed: Vec<String>,
    #[serde(flatten)]
    trial: CaseRun,
}

impl CaseResult {
    /// Returns the outcome of the run and the bounds that the run exceeds, or `None` if the case has not run.
    pub fn verdict(&self) -> Option<(CaseOutcome, Vec<String>)> {
        let trial = self.run.as_ref()?;
        let missed = self.case.criteria.missed_bounds(&trial.figures);
        Some((trial.outcome(&missed), missed))
    }
}

impl StressResults {
    /// Returns the cases of `maps`, with the runs already stored in the folder `out`.
    ///
    /// # Errors
    /// The errors of the maps; `File` if the stored results cannot be read.
    pub fn open(maps: Vec<StressMap>, quick: bool, out: PathBuf) -> Result<Self> {
        let cases = maps.iter().map(|map| map.cases(quick)).collect::<Result<Vec<_>>>()?.concat();
        let entries = cases.into_iter().map(|case| CaseResult { case, run: None }).collect();
        let mut ledger = Self { out, maps, entries, unlisted: Vec::new() };
        let file = ledger.file();
        let Ok(text) = fs::read_to_string(&file) else { return Ok(ledger) };
        let StoredResults { trials, .. } = serde_json::from_str(&text).map_err(|why| {
            Error::file(&file, format!("is no list of results: {why}")).help("remove it, or choose another --out")
        })?;
        for StoredRow { trial, .. } in trials {
            match ledger.entries.iter_mut().find(|entry| entry.case.key == trial.key) {
                Some(entry) => entry.run = Some(trial),
                None => ledger.unlisted.push(trial),
            }
        }
        Ok(ledger)
    }

    /// Returns the path of the file of all results.
    pub fn file(&self) -> PathBuf {
        self.out.join("stress.json")
    }

    /// Runs the cases without a result, with `workers` cases in parallel and one thread for each case. Calls `told`
    /// after each case, in the order of completion. If `stop` becomes true, running cases finish and no further case
    /// starts.
    ///
    /// # Errors
    /// `File` if the results cannot be written; `Usage` if threads cannot be started.
    pub fn run_missing(
        &mut self,
        workers: usize,
        stop: &AtomicBool,
        told: impl FnMut(&CaseResult) + Send,
    ) -> Result<()> {
        fs::create_dir_all(&self.out).map_err(|why| Error::write(&self.out, "made", &why))?;
        let due: Vec<usize> = (0..self.entries.len()).filter(|&i| self.entries[i].run.is_none()).collect();
        let cases: Vec<StressCase> = due.iter().map(|&i| self.entries[i].case.clone()).collect();
        let next = AtomicUsize::new(0);
        let shared = Mutex::new((self, told, Ok(())));
        let work = || {
            while !stop.load(Ordering::Relaxed) {
                let k = next.fetch_add(1, Ordering::Relaxed);
                let Some(case) = cases.get(k) else { return };
                let outcome = CaseRun::execute(case);
                let mut held = shared.lock().unwrap_or_else(PoisonError::into_inner);
                let (ledger, told, failed) = &mut *held;
                let kept = outcome.and_then(|trial| {
                    ledger.entries[due[k]].run = Some(trial);
                    told(&ledger.entries[due[k]]);
                    ledger.write_results()
                });
                if let Err(error) = kept {
                    *failed = Err(error);
                    return;
                }
            }
        };
        std::thread::scope(|scope| (0..workers).for_each(|_| _ = scope.spawn(work)));
        shared.into_inner().unwrap_or_else(PoisonError::into_inner).2
    }

    /// Returns the number of cases with each outcome, without the cases that have not run.
    pub(crate) fn counts(&self, map: Option<&str>) -> BTreeMap<CaseOutcome, usize> {
        let mut counts = BTreeMap::new();
        for entry in self.entries.iter().filter(|entry| map.is_none_or(|map| entry.case.map == map)) {
            if let Some((outcome, _)) = entry.verdict() {
                *counts.entry(outcome).or_insert(0) += 1;
            }
        }
        counts
    }

    /// Returns the processor time of all cases, s.
    pub fn cpu_seconds(&self) -> f64 {
        self.entries.iter().filter_map(|entry| Some(entry.run.as_ref()?.cpu_s)).sum()
    }

    /// Writes the results to the file.
    fn write_results(&self) -> Result<()> {
        let row = |entry: &CaseResult| {
            let (outcome, missed) = entry.verdict()?;
            Some(StoredRow { outcome, missed, trial: entry.run.clone()? })
        };
        // The bounds of a case outside the current list are unknown. The program evaluates the case again when the list
        // contains it.
        let other = |trial: &CaseRun| StoredRow { outcome: trial.outcome(&[]), missed: vec![], trial: trial.clone() };
        let trials = self.entries.iter().filter_map(row).chain(self.unlisted.iter().map(other)).collect();
        let name = |outcome: CaseOutcome| map_chart::outcome_name(outcome).to_string();
        let counts = self.counts(None).into_iter().map(|(outcome, n)| (name(outcome), n)).collect();
        let whole = StoredResults { version: env!("CARGO_PKG_VERSION").into(), counts, trials };
        let text = serde_json::to_string_pretty(&whole).map_err(|why| Error::file(&self.file(), why))?;
        write_atomically(&self.file(), (text + "\n").as_bytes())
    }

    /// Writes the results and a chart of each map; returns the paths of the charts.
    ///
    /// # Errors
    /// `File` if a file cannot be written.
    pub fn write(&self) -> Result<Vec<PathBuf>> {
        fs::create_dir_all(&self.out).map_err(|why| Error::write(&self.out, "made", &why))?;
        self.write_results()?;
        let mut files = Vec::new();
        for map in &self.maps {
            let own: Vec<&CaseResult> = self.entries.iter().filter(|entry| entry.case.map == map.name).collect();
            let file = self.out.join(format!("{}.svg", map.name));
            write_atomically(&file, map_chart::map_svg(map, &own).as_bytes())?;
            files.push(file);
        }
        Ok(files)
    }

    /// Returns a table of the number of cases with each outcome: a header row, a row for each map, and the sum in the
    /// last row.
    pub fn table(&self) -> Vec<Vec<String>> {
        let all = [CaseOutcome::Right, CaseOutcome::Stopped, CaseOutcome::Wrong, CaseOutcome::Unfinished];
        let row = |name: &str, map: Option<&str>| {
            let counts = self.counts(map);
            let mut cells = vec![name.to_string()];
            let number = |outcome: &CaseOutcome| counts.get(outcome).map_or("–".into(), |n| n.to_string());
            cells.extend(all.iter().map(number));
            cells
        };
        let head = ["map", "right", "stopped", "wrong", "unfinished"].map(String::from).to_vec();
        let maps = self.maps.iter().map(|map| row(&map.name, Some(&map.name)));
        std::iter::once(head).chain(maps).chain([row("all", None)]).collect()
    }
}
