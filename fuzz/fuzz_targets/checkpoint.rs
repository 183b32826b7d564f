//! Any bytes as a checkpoint: as they are, behind a header with a true hash, and as the state of a simulation.
#![no_main]

use std::cell::RefCell;

use libfuzzer_sys::fuzz_target;
use pontoon::{
    output::Checkpoint,
    scene::{PlacementConfig, ProbeConfig, Scene, ShapeConfig, SolidConfig},
    simulation::Simulation,
};

/// The format of `src/output/checkpoint.rs`; with another one every input is refused at once.
const FORMAT: u32 = 10;

thread_local! {
    static SIMULATION: RefCell<Simulation<2>> = RefCell::new(simulation());
}

/// A few particles and a body afloat.
fn simulation() -> Simulation<2> {
    let scene = Scene::new(2, 0.25, 1.0)
        .water_box([0.0, 0.0], [1.0, 0.75])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([1.0, 1.25])))
        .solid(SolidConfig::free("box", ShapeConfig::cuboid([0.3, 0.3]), 500.0).at(PlacementConfig::afloat(&[0.5])))
        .probe(ProbeConfig::motion("box"));
    Simulation::new(scene.build::<2>().expect("a sound scene").setup).expect("a sound setup")
}

/// FNV-1a.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3))
}

/// A file whose header is true of `packed`, and that promises to unfold to `unfolded` bytes.
fn forged(unfolded: u64, packed: &[u8]) -> Vec<u8> {
    let lengths = [unfolded, packed.len() as u64].map(u64::to_le_bytes).concat();
    let sum = hash(&[packed, &lengths].concat()).to_le_bytes();
    [b"PONTOON\n", &FORMAT.to_le_bytes()[..], &lengths, &sum, packed].concat()
}

/// A sound state to begin with.
fn seeds() {
    let state = SIMULATION.with_borrow(|sim| sim.save().expect("a state"));
    // Without the folder there is nobody to read it.
    let _ = std::fs::write("seeds/checkpoint/state", [&[3], &state[..]].concat());
}

fuzz_target!(init: seeds(), |bytes: &[u8]| {
    let Some((how, rest)) = bytes.split_first() else { return };
    match how % 4 {
        0 => {
            let _ = Checkpoint::from_bytes(rest);
        }
        // A frame of zstd, whatever is in it.
        1 => {
            let Some((length, packed)) = rest.split_first_chunk::<8>() else { return };
            let _ = Checkpoint::from_bytes(&forged(u64::from_le_bytes(*length), packed));
        }
        // A sound frame of zstd with whatever is packed in it.
        2 => {
            let packed = zstd::encode_all(rest, 1).expect("packing");
            let _ = Checkpoint::from_bytes(&forged(rest.len() as u64, &packed));
        }
        _ => SIMULATION.with_borrow_mut(|sim| {
            let _ = sim.restore(rest);
        }),
    }
});
