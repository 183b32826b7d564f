//! Threads of rayon, also in a forked process, in which the threads of the original process do not exist.

use std::{
    mem, process,
    sync::{Arc, Mutex, OnceLock, PoisonError},
};

use pontoon::{Result, run::thread_pool};
use rayon::ThreadPool;

/// The process that has loaded this module.
static LOADED_BY: OnceLock<u32> = OnceLock::new();

/// Remembers this process.
pub fn remember_process() {
    LOADED_BY.get_or_init(process::id);
}

/// Whether this process was forked after it had loaded this module, so that the common threads of rayon may be missing.
pub fn is_forked() -> bool {
    LOADED_BY.get() != Some(&process::id())
}

/// Does `work` with the common threads of rayon, or in a forked process with new ones.
///
/// # Errors
/// That of `work`, or `Usage` if the threads cannot be started.
pub fn with_threads<T: Send>(work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    if is_forked() { thread_pool(None)?.install(work) } else { work() }
}

/// The threads of a simulation.
pub struct OwnThreads {
    count: usize,
    /// The process that has started them.
    pool: Mutex<(u32, Arc<ThreadPool>)>,
}

impl OwnThreads {
    /// Starts `count` threads, by default one for each processor.
    ///
    /// # Errors
    /// `Usage` if they cannot be started.
    pub fn new(count: Option<usize>) -> Result<Self> {
        let pool = thread_pool(count)?;
        Ok(Self { count: pool.current_num_threads(), pool: Mutex::new((process::id(), Arc::new(pool))) })
    }

    /// Number of threads.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the threads. A process that was forked meanwhile starts its own.
    ///
    /// # Errors
    /// `Usage` if they cannot be started.
    pub fn pool(&self) -> Result<Arc<ThreadPool>> {
        let mut own = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        if own.0 != process::id() {
            let renewed = (process::id(), Arc::new(thread_pool(Some(self.count))?));
            // The threads of the other process cannot be told to end.
            mem::forget(mem::replace(&mut *own, renewed));
        }
        Ok(own.1.clone())
    }
}

impl Drop for OwnThreads {
    fn drop(&mut self) {
        let own = self.pool.get_mut().unwrap_or_else(PoisonError::into_inner);
        if own.0 != process::id() {
            // As in `pool`: one more reference keeps it.
            mem::forget(own.1.clone());
        }
    }
}
