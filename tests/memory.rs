//! The memory estimate of `inspect` against the memory that a run allocates. The test is alone in its program, so that the allocator
//! counts nothing else.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]
#![allow(unsafe_code, reason = "it counts allocations")]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    path::Path,
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

use pontoon::run::{self, InspectOptions, Progress, RunOptions};

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// The system allocator with a count of the bytes in use.
struct Counting;

// SAFETY: every call is forwarded unchanged to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(now, Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn a_run_allocates_about_the_estimated_memory() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let cases = [
        ("lobovsky", "0.004", vec![("dp", "0.003")]),
        ("lobovsky", "0.004", vec![("dp", "0.003"), ("frames", "off")]),
        ("lobovsky", "0.004", vec![("dp", "0.006"), ("model.sweep", "reference")]),
        ("added-mass-3d", "0.003", vec![("dp", "0.04"), ("frames", "off")]),
        ("buoyancy-3d", "0.003", vec![("model.viscosity", "sps"), ("frames", "off")]),
    ];
    for (i, (scene, until, more)) in cases.into_iter().enumerate() {
        let mut sets: Vec<(String, String)> = more.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
        sets.push(("until".into(), until.into()));
        let path = home.join(scene);
        let asked = InspectOptions { overrides: sets.clone(), ..InspectOptions::default() };
        let estimate = run::inspect(&path, &asked).unwrap().report().unwrap().preflight.size.memory_bytes;
        let out = std::env::temp_dir().join(format!("pontoon-memory-{}-{i}", std::process::id()));
        let _ = std::fs::remove_dir_all(&out);
        let options = RunOptions { out: Some(out.clone()), overrides: sets, threads: Some(1) };
        let before = NOW.load(Relaxed);
        PEAK.store(before, Relaxed);
        run::run(&path, &options, &mut |_: &Progress| true).unwrap();
        let used = (PEAK.load(Relaxed) - before) as f64;
        std::fs::remove_dir_all(&out).unwrap();
        // Lists grow by doubling and steps hold temporary copies: a factor of 1.6 either way.
        assert!((1.0 / 1.6..1.6).contains(&(used / estimate)), "{scene} {more:?}: {used} B, estimate {estimate} B");
    }
}
