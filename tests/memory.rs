//! The memory estimate of `inspect` against the memory that a run allocates, and what a run keeps of each frame. The tests are alone in
//! their program, one after the other, so that the allocator counts nothing else.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]
#![allow(unsafe_code, reason = "it counts allocations")]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    path::Path,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering::Relaxed},
    },
};

use pontoon::{
    output::FrameSequence,
    run::{self, InspectOptions, Progress, RunOptions},
};

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

/// Held by the test that runs.
static ALONE: Mutex<()> = Mutex::new(());

/// Memory of the program itself in the estimate, B: the allocator counts none of it.
const PROGRAM: f64 = 14e6;

/// What a run of `scene` with these keys allocates at most, from its first report of progress on, beyond what is in use before it, B. The
/// packing of the water, before that, takes more for a while.
fn peak(scene: &str, sets: &[(String, String)]) -> f64 {
    let out = std::env::temp_dir().join(format!("pontoon-memory-{}", std::process::id()));
    let used = peak_in(&out, &Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene), sets);
    std::fs::remove_dir_all(&out).unwrap();
    used
}

/// The same of the scene at `path`, whose run stays in the folder `out`.
fn peak_in(out: &Path, path: &Path, sets: &[(String, String)]) -> f64 {
    let _ = std::fs::remove_dir_all(out);
    let options = RunOptions { out: Some(out.to_owned()), overrides: sets.to_vec(), threads: Some(1) };
    let (before, mut begun) = (NOW.load(Relaxed), false);
    let mut report = |_: &Progress| {
        if !begun {
            begun = true;
            PEAK.store(NOW.load(Relaxed), Relaxed);
        }
        true
    };
    run::run(path, &options, &mut report).unwrap();
    (PEAK.load(Relaxed) - before) as f64
}

fn owned(sets: &[(&str, &str)]) -> Vec<(String, String)> {
    sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect()
}

#[test]
fn a_run_allocates_the_estimated_memory_and_few_bytes_a_particle() {
    let _alone = ALONE.lock().unwrap();
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

/// A little water at rest, of which each step has a frame.
const PUDDLE: &str = r#"
dimension = 2
dp        = 0.02
[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.2, 0.1] } }
[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [0.2, 0.2] } }
[frames]
every = 1e-9
"#;

#[test]
fn a_run_and_a_reader_of_its_frames_keep_the_time_of_each_frame_alone() {
    let _alone = ALONE.lock().unwrap();
    let folder = std::env::temp_dir().join(format!("pontoon-memory-frames-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (scene, out) = (folder.join("puddle.toml"), folder.join("run"));
    std::fs::write(&scene, PUDDLE).unwrap();
    let figures = ["0.3", "1.2"].map(|until| {
        let run = peak_in(&out, &scene, &owned(&[("until", until)]));
        // The least of several readings: at times something else allocates some kB meanwhile.
        let readings = (0..5).map(|_| {
            let before = NOW.load(Relaxed);
            PEAK.store(before, Relaxed);
            let frames = FrameSequence::open(&out).unwrap().unwrap().times().len() as f64;
            (frames, (PEAK.load(Relaxed) - before) as f64)
        });
        let (frames, read) = readings.min_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap();
        [frames, run, read]
    });
    std::fs::remove_dir_all(&folder).unwrap();
    let [[few, run, read], [many, run_more, read_more]] = figures;
    assert!(many > few + 500.0, "{few} and {many} frames");
    let [run, read] = [(run_more - run) / (many - few), (read_more - read) / (many - few)];
    println!("{run:.1} B a frame in a run of {many} frames, {read:.1} B in a reader");
    // A time has 8 B, of which the run keeps three lists: its own and those of two states for a rollback. A list that grows has twice
    // its size, and half as much again while it is copied. An entry of the list of frames has 170 B.
    assert!(run < 72.0 && read < 24.0, "{run} B a frame in the run, {read} B in the reader");
}
