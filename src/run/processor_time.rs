//! Processor time of the program, which the feature `cli` reads.

/// The processor time at an instant; `None` where it cannot be read, or without the feature `cli`.
pub(crate) struct ProcessorTime {
    #[cfg(feature = "cli")]
    start: Option<cpu_time::ProcessTime>,
}

impl ProcessorTime {
    /// Now.
    pub(crate) fn now() -> Self {
        Self {
            #[cfg(feature = "cli")]
            start: cpu_time::ProcessTime::try_now().ok(),
        }
    }

    /// Processor time since then, s.
    pub(crate) fn elapsed(&self) -> Option<f64> {
        #[cfg(feature = "cli")]
        return self.start.and_then(|start| start.try_elapsed().ok()).map(|spent| spent.as_secs_f64());
        #[cfg(not(feature = "cli"))]
        None
    }
}
