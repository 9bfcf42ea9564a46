//! Checkpoints: read, taken up by a simulation of their scene, and gone on from; and as the beginning of another scene.

use crate::is_one_in;
use crate::template::Template;
use flate2::Compression;
use flate2::bufread::ZlibDecoder;
use flate2::write::ZlibEncoder;
use sha2::{Digest, Sha256};
use std::io::{Read, Write};
use std::path::Path;
use stickslip::door::View;
use stickslip::march::March;
use stickslip::observe::{Checkpoint, Memory, OutputFolder, Recorder, state_sum};
use stickslip::scene::StartVelocities;
use stickslip::step::build;

/// Bytes before the content, and behind it.
const HEAD: usize = 25;
const SUM: usize = 32;

/// With one of so many outputs look whether they fit, which opens all files.
const REMEMBERED: u64 = 20;

/// Reads a checkpoint: the first byte says whether the bytes behind it are all of it; or its content, to which the head
/// of version 1, which has it uncompressed, and the sum are added; or the same of version 2, compressed already or by
/// us.
pub fn run(bytes: &[u8]) {
    let Some((&way, content)) = bytes.split_first() else { return };
    let template = Template::get();
    let whole = match way {
        0 => content.to_vec(),
        _ => {
            let mut whole = b"stickslip checkpoint\0".to_vec();
            whole.extend(u32::from(way.clamp(1, 2)).to_le_bytes());
            if way == 3 {
                let mut compressed = ZlibEncoder::new(&mut whole, Compression::fast());
                compressed.write_all(content).expect("it is memory");
                compressed.finish().expect("it is memory");
            } else {
                whole.extend(content);
            }
            let sum = Sha256::digest(&whole);
            whole.extend(sum);
            whole
        }
    };
    template.with("checkpoints/0000000000.checkpoint", &whole, |folder| {
        let path = folder.join("checkpoints/0000000000.checkpoint");
        if let Ok(checkpoint) = Checkpoint::read(&path) {
            take_up(checkpoint, (&path, is_one_in(REMEMBERED, bytes)));
        }
    });
}

fn take_up(mut checkpoint: Checkpoint, (path, remember): (&Path, bool)) {
    let scene = &Template::get().loaded.scene;
    std::hint::black_box((checkpoint.scene(), state_sum(&checkpoint.state)));
    let mut simulation = build(scene).expect("the template is sound");
    let _ = simulation.begin_from(&checkpoint.state, StartVelocities::Zero);
    let memory = checkpoint.memory(path);
    if simulation.restore(checkpoint.state).is_err() {
        return;
    }
    if remember {
        rehearse(simulation.as_ref(), memory);
    }
    let mut march = March::to(scene.time.end);
    for _ in 0..2 {
        if !matches!(march.step(simulation.as_mut()), Ok(Some(_))) {
            break;
        }
    }
    std::hint::black_box((simulation.ledger(), simulation.save(), simulation.snapshot()));
}

/// Lets outputs look whether they could take up what they kept.
fn rehearse(view: &dyn View, mut memory: Memory) {
    let template = Template::get();
    let Ok(folder) = OutputFolder::reopen(&template.path()) else { return };
    if Recorder::find(&folder, &memory).is_ok() {
        let mut recorder = Recorder::new(&template.loaded.scene, &folder).expect("the folder takes all");
        let _ = recorder.remember(view, &mut memory);
    }
}

/// Checkpoints of the run, and their contents.
pub fn seeds() -> Vec<Vec<u8>> {
    let template = Template::get();
    let newest = Checkpoint::list(&template.path()).unwrap_or_else(|error| panic!("{error}")).swap_remove(0);
    let bytes = std::fs::read(newest).expect("it is there");
    let compressed = &bytes[HEAD..bytes.len() - SUM];
    let mut content = Vec::new();
    ZlibDecoder::new(compressed).read_to_end(&mut content).expect("it was compressed");
    let ways: [(u8, &[u8]); 4] = [(0, &bytes), (1, &content), (2, compressed), (3, &content)];
    ways.map(|(way, bytes)| [&[way], bytes].concat()).into()
}
