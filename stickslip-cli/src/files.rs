//! Files beside the results of a run: whole or not there, and never in the place of what is somebody else's.

use flate2::Crc;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use stickslip::observe::{replace, replace_by};

/// How files of a kind are known, and those of the program among them.
#[derive(Clone, Copy, Debug)]
pub struct Kind<'a> {
    /// What they are called.
    pub name: &'a str,
    /// Their first bytes.
    pub start: &'a [u8],
    /// What the program's own say near their beginning or their end.
    pub mark: &'a [u8],
}

/// The mark of text with tags.
pub const COMMENT: &str = "<!-- Stickslip -->";

pub const PNG: Kind<'static> = Kind { name: "PNG", start: b"\x89PNG", mark: b"Software\0Stickslip" };
pub const SVG: Kind<'static> = Kind { name: "SVG", start: b"<svg", mark: COMMENT.as_bytes() };
pub const GLB: Kind<'static> =
    Kind { name: "model in glTF", start: b"glTF", mark: stickslip::surface::model::GENERATOR.as_bytes() };
/// As [`crate::page`] writes them.
pub const PAGE: Kind<'static> =
    Kind { name: "page in HTML", start: b"<!DOCTYPE html>", mark: COMMENT.as_bytes() };
/// As `stickslip manual` writes them.
pub const MAN_PAGE: Kind<'static> =
    Kind { name: "page for man", start: b".ie \\n(.g .ds Aq", mark: b"\n.TH stickslip" };
/// What `stickslip bench` measured.
pub const MEASUREMENTS: Kind<'static> = Kind {
    name: "record of measurements",
    start: b"{\n  \"program\": \"stickslip\",",
    mark: b"\n  \"unix_time\": ",
};

/// Before the CRC-32 of all bytes of a scene before this, its last line.
const SIGNATURE: &str = "# Made by Stickslip, and made anew as long as nobody changes it: ";

/// Bytes at either end of a file in which its mark lies.
const NEAR: u64 = 4096;

/// Writes a file under a name of its own and renames it when it is complete. One that is there already is replaced if
/// it is empty, or of the same kind and made by the program.
///
/// # Errors
/// What the system says, and another file in the place; nothing is changed then.
pub fn write(
    path: &Path,
    kind: Kind,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    replaceable(path, kind)?;
    replace(path, write).map_err(|error| error.source)
}

/// The same of a file that another program fills, under the name that it is given.
///
/// # Errors
/// As [`write`].
pub fn write_by(path: &Path, kind: Kind, write: impl FnOnce(&Path) -> io::Result<()>) -> io::Result<()> {
    replaceable(path, kind)?;
    replace_by(path, write).map_err(|error| error.source)
}

/// Writes a scene, and its sum behind it. One that is there already is replaced if it is empty, or was written so and
/// not changed since.
///
/// # Errors
/// As [`write`].
pub fn write_scene(path: &Path, text: &str) -> io::Result<()> {
    if let Some(mut file) = open(path)? {
        let mut found = Vec::new();
        file.read_to_end(&mut found)?;
        let is_ours = str::from_utf8(&found)
            .is_ok_and(|text| text.rfind(SIGNATURE).is_some_and(|end| text == signed(&text[..end])));
        if !is_ours && !found.is_empty() {
            return Err(taken("is no scene that Stickslip made and nobody changed"));
        }
    }
    let text = if text.ends_with('\n') { text.to_owned() } else { format!("{text}\n") };
    replace(path, |file| file.write_all(signed(&text).as_bytes())).map_err(|error| error.source)
}

/// A scene with its sum behind it.
fn signed(text: &str) -> String {
    let mut sum = Crc::new();
    sum.update(text.as_bytes());
    format!("{text}{SIGNATURE}{:08x}\n", sum.sum())
}

/// Whether there is nothing at a path, or a file that may be replaced by one of this kind.
///
/// # Errors
/// There is something else.
pub fn replaceable(path: &Path, kind: Kind) -> io::Result<()> {
    let Some(mut file) = open(path)? else { return Ok(()) };
    let mut found = Vec::new();
    (&mut file).take(NEAR).read_to_end(&mut found)?;
    if found.is_empty() {
        return Ok(());
    }
    if !found.starts_with(kind.start) {
        return Err(taken(&format!("is no {}", kind.name)));
    }
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(NEAR).max(found.len() as u64)))?;
    file.read_to_end(&mut found)?;
    let is_ours = found.windows(kind.mark.len()).any(|bytes| bytes == kind.mark);
    if is_ours { Ok(()) } else { Err(taken("does not say that Stickslip made it")) }
}

/// The file at a path; none where there is nothing.
///
/// # Errors
/// There is no file, but something else.
fn open(path: &Path) -> io::Result<Option<File>> {
    match fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Ok(about) if !about.is_file() => Err(taken("is no file")),
        other => other.and_then(|_| File::open(path)).map(Some),
    }
}

fn taken(what: &str) -> io::Error {
    let told = format!("it is there already, and {what}; remove it, or give another name");
    io::Error::new(io::ErrorKind::AlreadyExists, told)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_another_kind_is_not_replaced_and_a_failure_leaves_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let put = |bytes: &'static [u8]| write(&path, PNG, |file| file.write_all(bytes));
        put(b"\x89PNG Software\0Stickslip old").unwrap();
        put(b"\x89PNG Software\0Stickslip new").unwrap();
        let failed = write(&path, PNG, |file| {
            file.write_all(b"\x89PNG half")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(failed.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).unwrap(), b"\x89PNG Software\0Stickslip new");
        for (other, why) in [("years of work", "is no PNG"), ("\u{89}PNG of a camera", "is no PNG"), ("", "")]
        {
            fs::write(&path, other).unwrap();
            let outcome = put(b"\x89PNG Software\0Stickslip newer");
            assert_eq!(outcome.is_ok(), why.is_empty(), "{other}");
            assert!(outcome.err().is_none_or(|error| error.to_string().contains(why)), "{other}");
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// The mark may lie at either end: films have it where their makers put it.
    #[test]
    fn a_file_of_the_same_kind_is_replaced_only_if_the_program_made_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let pixels = vec![7; 3 * NEAR as usize];
        for (mark, place) in [(PNG.mark, 0), (PNG.mark, pixels.len()), (b"Software\0Camera 1.0", 0)] {
            let [before, after] = [&pixels[..place], &pixels[place..]];
            let bytes = [PNG.start, before, mark, after].concat();
            fs::write(&path, &bytes).unwrap();
            let outcome = write(&path, PNG, |file| file.write_all(b"another"));
            assert_eq!(outcome.is_ok(), mark == PNG.mark, "{place}");
            if let Err(error) = outcome {
                assert!(error.to_string().contains("does not say that Stickslip made it"), "{error}");
                assert_eq!(fs::read(&path).unwrap(), bytes);
            }
        }
    }

    #[test]
    fn a_scene_is_made_anew_until_somebody_changes_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cube.toml");
        let read = || fs::read_to_string(&path).unwrap();
        for text in ["title = \"a\"", "title = \"b\"\n"] {
            write_scene(&path, text).unwrap();
            assert!(read().starts_with(text) && read().lines().count() == 2, "{}", read());
        }
        let changed = read().replace("\"b\"", "\"mine\"");
        fs::write(&path, &changed).unwrap();
        let refused = write_scene(&path, "title = \"c\"").unwrap_err().to_string();
        assert!(refused.contains("nobody changed"), "{refused}");
        assert_eq!(read(), changed);
        // Anything of that name, too.
        for other in [&b"years of work"[..], b"\xff\xfe"] {
            fs::write(&path, other).unwrap();
            assert!(write_scene(&path, "title = \"c\"").is_err());
        }
        fs::write(&path, "").unwrap();
        write_scene(&path, "title = \"c\"").unwrap();
    }
}
