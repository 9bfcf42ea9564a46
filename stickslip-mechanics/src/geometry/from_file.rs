//! What the record of a run says of a shape that was read from a file.

use serde::Serialize;
use sha2::{Digest, Sha256};

/// The file, and a hash of the shape that it gave, so that a run is not taken up with another surface of that name.
#[derive(Serialize)]
pub(super) struct FromFile<'a> {
    /// As the scene names it.
    file: &'a str,
    /// SHA-256 of the shape's numbers.
    sha256: String,
}

impl<'a> FromFile<'a> {
    pub(super) fn new(file: &'a str, numbers: impl IntoIterator<Item = f64>) -> Self {
        let mut hash = Sha256::new();
        for number in numbers {
            hash.update(number.to_bits().to_le_bytes());
        }
        FromFile { file, sha256: hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect() }
    }
}
