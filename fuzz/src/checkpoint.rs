//! Checkpoints: read, taken up by a simulation of their scene, and gone on from; and as the beginning of another scene.

use crate::is_one_in;
use crate::template::Template;
use flate2::bufread::ZlibDecoder;
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::Path;
use stickslip::door::View;
use stickslip::march::March;
use stickslip::observe::{Checkpoint, Memory, OutputFolder, Recorder, state_sum};
use stickslip::scene::StartVelocities;
use stickslip::step::build;

/// Version of the format.
const VERSION: u32 = 4;
/// Bytes before the content, and behind it; of a place.
const HEAD: usize = 25;
const SUM: usize = 32;
const PLACE: usize = 8;
const IS_PACKED: usize = 1;

/// With one of so many outputs look whether they fit, which opens all files.
const REMEMBERED: u64 = 20;

/// Reads a checkpoint: the first byte says whether the bytes behind it are all of it; or, where four bytes before say
/// how long sections are, a section and a plain head, with all sums, or sections and a head with the byte that says
/// whether it is packed, as they are but for the head's sum.
pub fn run(bytes: &[u8]) {
    let Some((&way, content)) = bytes.split_first() else { return };
    let template = Template::get();
    let whole = match way {
        0 => content.to_vec(),
        1 => {
            let Some((length, content)) = content.split_first_chunk() else { return };
            let section = content.len().min(u32::from_le_bytes(*length) as usize);
            let (section, head) = content.split_at(section);
            let Some(whole) = Checkpoint::sealed(section, head) else { return };
            whole
        }
        _ => {
            let Some((length, content)) = content.split_first_chunk() else { return };
            let sections = content.len().min(u32::from_le_bytes(*length) as usize);
            let line = [&b"stickslip checkpoint\0"[..], &VERSION.to_le_bytes()].concat();
            let place = ((HEAD + sections) as u64).to_le_bytes();
            let sum = Sha256::digest([&line, &content[sections..], &place].concat());
            [&line, content, &place, &sum[..]].concat()
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
    let bytes = std::fs::read(&newest).expect("it is there");
    let (content, end) = bytes.split_at(bytes.len() - SUM - PLACE - IS_PACKED);
    let place = u64::from_le_bytes(*end[1..].first_chunk().expect("a place has eight bytes")) as usize;
    // As they were before they were packed.
    let [section, head] = [&content[HEAD..place], &content[place..]].map(|packed| {
        let mut plain = Vec::new();
        ZlibDecoder::new(packed).read_to_end(&mut plain).expect("it was packed");
        plain
    });
    let sectioned = [&(section.len() as u32).to_le_bytes(), &section[..], &head].concat();
    // With the head as it is, packed, and the byte that says so.
    let raw = [&((place - HEAD) as u32).to_le_bytes(), &content[HEAD..], &[1]].concat();
    let ways: [(u8, &[u8]); 3] = [(0, &bytes), (1, &sectioned), (2, &raw)];
    ways.map(|(way, bytes)| [&[way], bytes].concat()).into()
}
