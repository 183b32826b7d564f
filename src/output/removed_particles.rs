//! The list of the particles that left the domain and were removed: their numbers, times, last states, and likely
//! causes.

use std::path::Path;

use super::write_atomically;
use crate::{
    error::{Error, Result},
    simulation::RemovedParticle,
};

/// File name of the list in the run's folder.
pub(crate) const REMOVED: &str = "removed.csv";

/// Writes the whole list to `folder`. `lost` contains the particles in order of removal, with the times (s) at which
/// the program found them outside the domain.
///
/// # Errors
/// `File` if the list cannot be written.
pub(crate) fn write<const D: usize>(folder: &Path, lost: &[(f64, RemovedParticle<D>)]) -> Result<()> {
    let axes = &["x", "y", "z"][..D];
    let columns = |prefix: &str, unit: &str| axes.iter().map(|a| format!("{prefix}{a}_{unit}")).collect::<Vec<_>>();
    let header = [vec!["t_s".into(), "id".into()], columns("", "m"), columns("v", "mps"), vec!["rho_kgpm3".into()]];
    let mut table = csv::Writer::from_writer(Vec::new());
    let path = folder.join(REMOVED);
    let wrong = |why: csv::Error| Error::file(&path, format!("cannot be written: {why}"));
    table.write_record(header.iter().flatten().chain(&["way".to_string()])).map_err(wrong)?;
    for (t, RemovedParticle { id, r, v, rho, exit }) in lost {
        let numbers = r.iter().chain(v.iter()).chain([rho]).map(f64::to_string);
        let row: Vec<String> = [t.to_string(), id.to_string()].into_iter().chain(numbers).collect();
        table.write_record(row.iter().chain(&[exit.to_string()])).map_err(wrong)?;
    }
    let bytes = table.into_inner().map_err(|why| Error::file(&path, format!("cannot be written: {why}")))?;
    write_atomically(&path, &bytes)
}
