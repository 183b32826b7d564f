//! The processes that `mpiexec` or `srun` started together, as ranks of one run.

use std::env;

use crate::{
    error::{Error, ErrorKind, Result},
    ranks::Ranks,
};

/// The ranks, and MPI for as long as they are needed.
pub struct Processes {
    pub ranks: Ranks,
    #[cfg(feature = "mpi")]
    _world: Option<crate::ranks::World>,
}

/// Joins the processes that were started together. A process that was started alone does without MPI.
///
/// # Errors
/// `Usage` if there are several, and this program was built without MPI.
pub fn join() -> Result<Processes> {
    let count = started_together();
    #[cfg(feature = "mpi")]
    {
        let world = if count > 1 { Some(crate::ranks::World::start()?) } else { None };
        let ranks = world.as_ref().map(crate::ranks::World::ranks).unwrap_or_default();
        abort_on_panic(&ranks);
        Ok(Processes { ranks, _world: world })
    }
    #[cfg(not(feature = "mpi"))]
    if count > 1 {
        let what = format!("{count} processes were started, and this program was built without MPI");
        let help = "build it with the feature mpi:  cargo build --release --features mpi;  or start one process";
        Err(Error::new(ErrorKind::Usage, what).help(help))
    } else {
        Ok(Processes { ranks: Ranks::default() })
    }
}

/// Refuses several processes, of which each would do the same.
///
/// # Errors
/// `Usage` if there are several.
pub fn require_one_process() -> Result<()> {
    match started_together() {
        1 => Ok(()),
        count => {
            let what = format!("{count} processes were started, and `run` and `resume` alone use several");
            Err(Error::new(ErrorKind::Usage, what).help("start this command without mpiexec or srun"))
        }
    }
}

/// Whether this process is another than the first that were started together: it leaves messages to that.
pub fn is_silent() -> bool {
    ["PMI_RANK", "OMPI_COMM_WORLD_RANK", "PMIX_RANK"]
        .iter()
        .find_map(|name| env::var(name).ok())
        .is_some_and(|rank| rank != "0")
}

/// Threads of each rank, if the user names no number: ranks that share processors share them out.
pub fn default_threads(ranks: &Ranks) -> Option<usize> {
    let processors = std::thread::available_parallelism().map_or(1, |n| n.get());
    (ranks.count() > 1).then(|| (processors / ranks.sharing_processors()).max(1))
}

/// How many processes were started together, as MPICH, Open MPI and Slurm tell.
fn started_together() -> usize {
    let number = |name: &str| env::var(name).ok()?.parse().ok();
    let slurm = || if env::var_os("PMIX_RANK").is_some() { number("SLURM_STEP_NUM_TASKS") } else { None };
    number("PMI_SIZE").or_else(|| number("OMPI_COMM_WORLD_SIZE")).or_else(slurm).unwrap_or(1).max(1)
}

/// A rank that panics ends the others, which would wait for it.
#[cfg(feature = "mpi")]
fn abort_on_panic(ranks: &Ranks) {
    let (ranks, report) = (ranks.clone(), std::panic::take_hook());
    std::panic::set_hook(Box::new(move |panic| {
        report(panic);
        ranks.abort(101);
    }));
}
