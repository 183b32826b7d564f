//! Any bytes as a checkpoint: as they are, behind a header with a true hash, and as the state of a simulation.
#![no_main]

use std::cell::RefCell;

use libfuzzer_sys::fuzz_target;
use pontoon::{
    record::{Checkpoint, restart},
    scene::{AtWords, ProbeEntry, Scene, ShapeWords, SolidWords},
    simulation::Simulation,
};

thread_local! {
    static SIMULATION: RefCell<Simulation<2>> = RefCell::new(simulation());
}

/// A few particles and a body afloat.
fn simulation() -> Simulation<2> {
    let scene = Scene::new(2, 0.25, 1.0)
        .water_box([0.0, 0.0], [1.0, 0.75])
        .solid(SolidWords::fixed("tank", ShapeWords::tank([1.0, 1.25])))
        .solid(SolidWords::free("box", ShapeWords::cuboid([0.3, 0.3]), 500.0).at(AtWords::afloat(&[0.5])))
        .probe(ProbeEntry::motion("box"));
    Simulation::new(scene.build::<2>().expect("a sound scene").setup).expect("a sound setup")
}

/// A file whose header is true of `packed`, and that promises to unfold to `unfolded` bytes.
fn forged(unfolded: u64, packed: &[u8]) -> Vec<u8> {
    let lengths = [unfolded, packed.len() as u64].map(u64::to_le_bytes).concat();
    let sum = restart::hash(&[&lengths, packed].concat()).to_le_bytes();
    [b"PONTOON\n", &3u32.to_le_bytes()[..], &lengths, &sum, packed].concat()
}

/// Sound inputs of each sort, to begin with.
fn seeds() {
    let state = SIMULATION.with_borrow(|sim| sim.save().expect("a state"));
    let checkpoint = Checkpoint {
        version: env!("CARGO_PKG_VERSION").into(),
        scene: 1,
        sets: vec![("dp".into(), "0.02".into())],
        time: 0.5,
        tables: vec![100, 200],
        frames: vec![0.0, 0.1],
        due: vec![1, 2, 3],
        wall: 1.0,
        cpu: 2.0,
        particle_steps: 3,
        stepping: 0.5,
        state: vec![7; 100],
    };
    let file = checkpoint.to_bytes().expect("packing");
    // Behind magic word, format, lengths and sum.
    let packed = &file[8 + 4 + 16 + 8..];
    let unfolded = zstd::decode_all(packed).expect("a frame");
    let framed = [&(unfolded.len() as u64).to_le_bytes(), packed].concat();
    for (how, bytes) in [file, framed, unfolded, state].iter().enumerate() {
        // Without the folder there is nobody to read them.
        let _ = std::fs::write(format!("seeds/checkpoint/{how}"), [&[how as u8], &bytes[..]].concat());
    }
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
            if let Ok(found) = Checkpoint::from_bytes(&forged(rest.len() as u64, &packed)) {
                let again = Checkpoint::from_bytes(&found.to_bytes().expect("packing")).expect("it was sound");
                assert_eq!(found.state, again.state);
            }
        }
        _ => SIMULATION.with_borrow_mut(|sim| {
            let _ = sim.restore(rest);
        }),
    }
});
