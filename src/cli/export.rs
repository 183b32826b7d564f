//! `pontoon export`: the series of a run in a form that other programs read.

use std::path::PathBuf;

use clap::Args;
use pontoon::{
    error::{Error, Kind, Result},
    record::{Manifest, Readings, arrays},
};

/// Which run, and where to.
#[derive(Args)]
pub struct ExportArgs {
    /// Folder of the run
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// All series as NumPy arrays in one file [default: DIR/series.npz]
    #[arg(long, value_name = "FILE", num_args = 0..=1, required = true)]
    npz: Option<Option<PathBuf>>,
}

/// Writes the file; says where.
pub fn export(args: &ExportArgs) -> Result<String> {
    let manifest = Manifest::read(&args.folder)?;
    let out = args.npz.clone().flatten().unwrap_or_else(|| args.folder.join("series.npz"));
    let names = manifest.files.iter().filter_map(|file| file.strip_prefix("series/")?.strip_suffix(".csv"));
    let read = |name| Ok((name, Readings::read(&args.folder.join(format!("series/{name}.csv")))?));
    let tables: Vec<(&str, Readings)> = names.map(read).collect::<Result<_>>()?;
    if tables.is_empty() {
        let what = format!("the run in {} has no series", args.folder.display());
        return Err(Error::new(Kind::Usage, what).help("a [[probe]] in its scene would write some"));
    }
    let all = tables.iter().flat_map(|(name, of)| {
        let columns = of.columns.iter().zip(&of.x).map(move |(column, x)| (format!("{name}.{column}"), &x[..]));
        [(format!("{name}.t_s"), &of.t[..])].into_iter().chain(columns)
    });
    arrays::write(&out, all)?;
    Ok(format!("{}: {} tables\n", out.display(), tables.len()))
}
