//! Files that a scene names.

use super::text::Text;
use crate::scene::error::Fault;
use std::path::Path;

/// The bytes of a file that a key names. Pipes and devices are refused: who reads them may wait for ever.
///
/// # Errors
/// It cannot be read, is no file, or has more than `most` bytes.
pub fn read_file(key: &Text, (name, path): (&str, &Path), most: u64) -> Result<Vec<u8>, Fault> {
    let unread = |why: String| {
        let help = format!("{}: {why}; a relative path starts at the scene's folder", path.display());
        key.refused(name, "a file that can be read").help(Some(help))
    };
    let about = std::fs::metadata(path).map_err(|reason| unread(reason.to_string()))?;
    if !about.is_file() || about.len() > most {
        return Err(unread(format!("it is no file of at most {most} bytes")));
    }
    std::fs::read(path).map_err(|reason| unread(reason.to_string()))
}
