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

/// Memory of the program itself in the estimate, B: the allocator counts none of it.
const PROGRAM: f64 = 14e6;

/// What a run of `scene` with these keys allocates at most, from its first report of progress on, beyond what is in use before it, B. The
/// packing of the water, before that, takes more for a while.
fn peak(scene: &str, sets: &[(String, String)]) -> f64 {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let out = std::env::temp_dir().join(format!("pontoon-memory-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&out);
    let options = RunOptions { out: Some(out.clone()), overrides: sets.to_vec(), threads: Some(1) };
    let (before, mut begun) = (NOW.load(Relaxed), false);
    let mut report = |_: &Progress| {
        if !begun {
            begun = true;
            PEAK.store(NOW.load(Relaxed), Relaxed);
        }
        true
    };
    run::run(&path, &options, &mut report).unwrap();
    let used = PEAK.load(Relaxed) - before;
    std::fs::remove_dir_all(&out).unwrap();
    used as f64
}

fn owned(sets: &[(&str, &str)]) -> Vec<(String, String)> {
    sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect()
}

/// One test, so that no other thread allocates.
#[test]
fn a_run_allocates_the_estimated_memory_and_few_bytes_a_particle() {
    let cases = [
        ("lobovsky", "0.004", vec![("dp", "0.003")]),
        ("lobovsky", "0.004", vec![("dp", "0.003"), ("frames", "off")]),
        ("lobovsky", "0.004", vec![("dp", "0.006"), ("model.sweep", "reference")]),
        ("added-mass-3d", "0.003", vec![("dp", "0.04"), ("frames", "off")]),
        ("buoyancy-3d", "0.003", vec![("model.viscosity", "sps"), ("frames", "off")]),
        ("column", "0.003", vec![("dp", "0.02"), ("frames", "off")]),
    ];
    let mut wrong = String::new();
    for (scene, until, mut more) in cases {
        more.push(("until", until));
        let sets = owned(&more);
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
        let asked = InspectOptions { overrides: sets.clone(), ..InspectOptions::default() };
        let estimate = run::inspect(&path, &asked).unwrap().report().unwrap().preflight.size.memory_bytes - PROGRAM;
        let ratio = peak(scene, &sets) / estimate;
        println!("{scene} {more:?}: peak over estimate {ratio:.3}, estimate {estimate} B");
        if !(0.9..1.1).contains(&ratio) {
            wrong += &format!("{scene} {more:?}: peak over estimate {ratio:.3}\n");
        }
    }
    let sizes = ["0.025", "0.0177"].map(|dp| {
        let sets = owned(&[("dp", dp), ("frames", "off"), ("until", "0.005")]);
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/column");
        let asked = InspectOptions { overrides: sets.clone(), ..InspectOptions::default() };
        let size = run::inspect(&path, &asked).unwrap().report().unwrap().preflight.size;
        ((size.fluid + size.boundary) as f64, peak("column", &sets))
    });
    let [(few, less), (many, more)] = sizes;
    let slope = (more - less) / (many - few);
    println!("{slope:.1} B a particle");
    assert!(wrong.is_empty(), "{wrong}");
    assert!(slope < 260.0, "{slope} B a particle");
}
