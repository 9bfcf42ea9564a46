//! Files beside the results of a run: whole or not there, and never in the place of what is somebody else's.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;
use stickslip::observe::replace;

/// How files of a kind begin.
#[derive(Clone, Copy, Debug)]
pub struct Kind<'a> {
    /// What they are called.
    pub name: &'a str,
    /// Their first bytes, one of these.
    pub starts: &'a [&'a [u8]],
}

pub const PNG: Kind<'static> = Kind { name: "PNG", starts: &[b"\x89PNG"] };
pub const SVG: Kind<'static> = Kind { name: "SVG", starts: &[b"<svg"] };
pub const PDF: Kind<'static> = Kind { name: "PDF", starts: &[b"%PDF"] };
pub const XML: Kind<'static> = Kind { name: "XML", starts: &[b"<?xml"] };
/// How pages began before they named the program.
const OLD_PAGE: &[u8] =
    b"<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\"";
/// As [`crate::page`] writes them.
pub const PAGE: Kind<'static> =
    Kind { name: "page of Stickslip", starts: &[b"<!DOCTYPE html><!-- Stickslip -->", OLD_PAGE] };
/// As the program writes them: the title comes first.
pub const SCENE: Kind<'static> = Kind { name: "scene of ours", starts: &[b"title = "] };
pub const JSON: Kind<'static> = Kind { name: "JSON", starts: &[b"{"] };

/// Writes a file under another name (`.part` appended) and renames it when it is complete. One that is there already is
/// replaced if it is empty or of the same kind.
///
/// # Errors
/// What the system says, and a file of another kind; nothing is changed then.
pub fn write(
    path: &Path,
    kind: Kind,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    replaceable(path, kind)?;
    replace(path, write).map_err(|error| error.source)
}

/// Writes a scene; one that is there already is replaced.
///
/// # Errors
/// As [`write`].
pub fn write_scene(path: &Path, text: &str) -> io::Result<()> {
    write(path, SCENE, |file| file.write_all(text.as_bytes()))
}

/// Whether there is nothing at a path, or a file that may be replaced by one of this kind.
///
/// # Errors
/// There is something else.
pub fn replaceable(path: &Path, kind: Kind) -> io::Result<()> {
    let about = match fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        other => other?,
    };
    let other = |what: &str| {
        let told = format!("it is there already, and is {what}; remove it, or give another name");
        Err(io::Error::new(io::ErrorKind::AlreadyExists, told))
    };
    if !about.is_file() {
        return other("no file");
    }
    let mut found = Vec::new();
    File::open(path)?.take(1024).read_to_end(&mut found)?;
    let same = found.is_empty() || kind.starts.iter().any(|start| found.starts_with(start));
    if same { Ok(()) } else { other(&format!("no {}", kind.name)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_another_kind_is_not_replaced_and_a_failure_leaves_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let put = |bytes: &'static [u8]| write(&path, PNG, |file| file.write_all(bytes));
        put(b"\x89PNG old").unwrap();
        put(b"\x89PNG new").unwrap();
        let failed = write(&path, PNG, |file| {
            file.write_all(b"\x89PNG half")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(failed.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).unwrap(), b"\x89PNG new");
        fs::write(&path, "years of work").unwrap();
        assert!(put(b"\x89PNG newer").unwrap_err().to_string().contains("no PNG"));
        assert_eq!(fs::read(&path).unwrap(), b"years of work");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
