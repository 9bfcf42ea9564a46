//! Sections of checkpoints: some particles each.

use super::{CheckpointForm, MOST_COMPRESSED, START, Summed, damage, damaged};
use crate::door::{SavedShare, SavedState};
use crate::observe::file::ReadProblem;
use crate::observe::work::work;
use flate2::Compression;
use flate2::bufread::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

/// Where a section lies, and what it is made of.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::observe) struct Section {
    place: u64,
    bytes: u64,
    /// Whether they are packed by zlib.
    packed: bool,
    /// Their SHA-256.
    #[serde(with = "serde_bytes")]
    sum: Vec<u8>,
}

/// Particles of a section, at most.
pub(in crate::observe) const MOST_PARTICLES: usize = 1 << 15;

/// Sections that are made one after the other.
pub(in crate::observe) struct Sections {
    form: CheckpointForm,
    pub list: Vec<Section>,
}

impl Sections {
    /// None so far.
    pub(in crate::observe) fn new(form: CheckpointForm) -> Self {
        Sections { form, list: Vec::new() }
    }

    /// Shows the particles of a state, those of a section at a time.
    pub(in crate::observe) fn of_state(
        state: &SavedState,
        take: &mut dyn FnMut(Vec<SavedShare>) -> io::Result<()>,
    ) -> io::Result<()> {
        let counts = state.bodies.iter().map(|body| body.numbers.len());
        let share = |body: usize, some| state.bodies[body].share(body, some);
        SavedShare::deal(counts, MOST_PARTICLES, share, take)
    }

    /// The bytes of the next one.
    pub(in crate::observe) fn add(&mut self, shares: Vec<SavedShare>) -> Vec<u8> {
        let place = self.list.last().map_or(START as u64, Section::end);
        let (section, bytes) = Section::of(&shares, self.form);
        self.list.push(section.at(place));
        bytes
    }
}

impl Section {
    /// That of some particles, and its bytes.
    pub(in crate::observe) fn of(shares: &[SavedShare], form: CheckpointForm) -> (Self, Vec<u8>) {
        let (is_packed, bytes, sum) = work(|| {
            let plain = rmp_serde::to_vec(shares).expect("memory takes what is written");
            let (is_packed, bytes) = packed(plain, form);
            let sum = Sha256::digest(&bytes).to_vec();
            (is_packed, bytes, sum)
        });
        (Section { place: 0, bytes: bytes.len() as u64, packed: is_packed, sum }, bytes)
    }

    /// That of any bytes that are not packed.
    pub(super) fn sealed(bytes: &[u8]) -> Self {
        Section { place: 0, bytes: bytes.len() as u64, packed: false, sum: Sha256::digest(bytes).to_vec() }
    }

    /// The same there.
    pub(in crate::observe) fn at(self, place: u64) -> Self {
        Section { place, ..self }
    }

    pub(in crate::observe) fn place(&self) -> u64 {
        self.place
    }

    /// Where the next one begins.
    pub(in crate::observe) fn end(&self) -> u64 {
        self.place.saturating_add(self.bytes)
    }

    /// Looks whether it is in a file as it was written, of which little is in memory at a time.
    pub(super) fn check(&self, file: &mut File) -> Result<(), ReadProblem> {
        file.seek(SeekFrom::Start(self.place))?;
        let mut summed = Summed { file: io::sink(), sum: Sha256::new() };
        let read = io::copy(&mut file.take(self.bytes), &mut summed)?;
        if read == self.bytes && summed.sum.finalize()[..] == self.sum[..] { Ok(()) } else { Err(damaged()) }
    }

    /// Its bytes in a file.
    pub(in crate::observe) fn bytes(&self, file: &mut File) -> io::Result<Vec<u8>> {
        file.seek(SeekFrom::Start(self.place))?;
        let mut bytes = Vec::new();
        file.take(self.bytes).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Its particles in a file.
    pub(super) fn read(&self, file: &mut File) -> Result<Vec<SavedShare>, ReadProblem> {
        self.shares(&self.bytes(file)?)
    }

    /// The particles in its bytes.
    pub(in crate::observe) fn shares(&self, bytes: &[u8]) -> Result<Vec<SavedShare>, ReadProblem> {
        if Sha256::digest(bytes)[..] != self.sum[..] {
            return Err(damaged());
        }
        unpacked((self.packed, bytes))
    }
}

/// Bytes in a form, and whether they are packed: those of which one would stand for too many are not.
pub(super) fn packed(plain: Vec<u8>, form: CheckpointForm) -> (bool, Vec<u8>) {
    if form == CheckpointForm::Plain {
        return (false, plain);
    }
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
    let packed = packed.write_all(&plain).and_then(|()| packed.finish()).expect("memory takes all bytes");
    let few = plain.len() as u64 <= MOST_COMPRESSED * packed.len() as u64;
    if few { (true, packed) } else { (false, plain) }
}

/// What such bytes say.
pub(super) fn unpacked<X: DeserializeOwned>((is_packed, bytes): (bool, &[u8])) -> Result<X, ReadProblem> {
    let mut plain = Vec::new();
    if is_packed {
        let most = MOST_COMPRESSED * bytes.len() as u64;
        let unpacked = ZlibDecoder::new(bytes).take(most).read_to_end(&mut plain);
        unpacked.map_err(|error| damage(&error))?;
    }
    // One reader for both: the compiler makes one copy of all that it reads.
    rmp_serde::from_slice(if is_packed { &plain } else { bytes }).map_err(|error| damage(&error))
}
