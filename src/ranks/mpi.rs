//! Ranks that are processes, by MPI.

use std::{
    thread,
    time::{Duration, Instant},
};

use ::mpi::{
    Count, Threading,
    datatype::PartitionMut,
    environment::{Universe, processor_name},
    request::{Request, Scope, scope},
    topology::SimpleCommunicator,
    traits::{Communicator as _, CommunicatorCollectives as _, Destination as _, Source as _},
};

use super::{Exchange, Ranks};
use crate::error::{Error, ErrorKind, Result};

/// Time for which a rank polls for the end of an exchange before it sleeps between two looks.
const POLLED: Duration = Duration::from_micros(50);

/// Longest sleep between two looks.
const LONGEST_SLEEP: Duration = Duration::from_millis(1);

/// MPI, from its start to its end. Keep it for as long as ranks exchange.
#[expect(missing_debug_implementations, reason = "`Universe` has none")]
pub struct World(#[allow(dead_code, reason = "its end is that of MPI")] Universe);

impl World {
    /// Starts MPI.
    ///
    /// # Errors
    /// `Usage` if it runs already, or allows no calls from a thread pool.
    pub fn start() -> Result<Self> {
        let refused = |what: &str| Error::new(ErrorKind::Usage, format!("MPI cannot be started: {what}"));
        match ::mpi::initialize_with_threading(Threading::Serialized) {
            Some((world, Threading::Serialized | Threading::Multiple)) => Ok(Self(world)),
            Some(_) => Err(refused("it allows calls from one thread alone")
                .help("use an MPI library with MPI_THREAD_SERIALIZED, as MPICH and Open MPI have it")),
            None => Err(refused("it has been started before")),
        }
    }

    /// All processes that were started together.
    pub fn ranks(&self) -> Ranks {
        Ranks::new(Processes)
    }
}

/// The processes of the world.
#[derive(Debug)]
struct Processes;

impl Exchange for Processes {
    fn rank(&self) -> usize {
        SimpleCommunicator::world().rank() as usize
    }

    fn count(&self) -> usize {
        SimpleCommunicator::world().size() as usize
    }

    fn place(&self) -> String {
        // Processes that are bound to processors of their own share none.
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let bound = status.lines().find(|line| line.starts_with("Cpus_allowed:")).unwrap_or_default();
        format!("{} {bound}", processor_name().unwrap_or_default())
    }

    fn gather(&self, own: &[u32], counts: &[usize], all: &mut [u32]) {
        let counts: Vec<Count> = counts.iter().map(|&n| n as Count).collect();
        let first = |end: &mut Count, n: &Count| {
            *end += n;
            Some(*end - n)
        };
        let starts: Vec<Count> = counts.iter().scan(0, first).collect();
        let mut all = PartitionMut::new(all, counts, starts);
        scope(|scope| complete(SimpleCommunicator::world().immediate_all_gather_varcount_into(scope, own, &mut all)));
    }

    fn pass(&self, (to, out): (Option<usize>, &[u32]), (from, into): (Option<usize>, &mut [u32])) {
        let world = SimpleCommunicator::world();
        scope(|scope| {
            let sent = to.map(|rank| world.process_at_rank(rank as i32).immediate_send(scope, out));
            if let Some(rank) = from {
                complete(world.process_at_rank(rank as i32).immediate_receive_into(scope, into));
            }
            sent.into_iter().for_each(complete);
        });
    }

    fn abort(&self, code: i32) -> ! {
        SimpleCommunicator::world().abort(code)
    }
}

/// Waits for the end of an exchange. MPI libraries poll while they wait; a rank that waits for a slower one sleeps instead.
fn complete<'a, D: ?Sized, S: Scope<'a>>(mut request: Request<'a, D, S>) {
    let start = Instant::now();
    while let Err(pending) = request.test() {
        request = pending;
        let waited = start.elapsed();
        if waited > POLLED {
            thread::sleep((waited / 8).min(LONGEST_SLEEP));
        }
    }
}
