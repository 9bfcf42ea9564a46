//! Animations: PNG and GIF by ourselves, MP4 and WebM by the user's own ffmpeg.

use crate::files::{self, Kind};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use stickslip::image::{Image, write_animation};

/// What films say in a comment.
const MARK: &str = "Stickslip";
const GIF: Kind<'static> = Kind { name: "GIF", start: b"GIF8", mark: MARK.as_bytes() };
const WEBM: Kind<'static> = Kind { name: "WebM", start: b"\x1aE\xdf\xa3", mark: MARK.as_bytes() };
const MP4: Kind<'static> = Kind { name: "MP4", start: b"\0\0\0", mark: MARK.as_bytes() };

/// Kinds of animations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmKind {
    Png,
    Gif,
    Mp4,
    Webm,
}

impl FilmKind {
    /// What a file of this name holds; `None` of a name that none has.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        let kinds = [Self::Png, Self::Gif, Self::Mp4, Self::Webm];
        ["png", "gif", "mp4", "webm"]
            .iter()
            .zip(kinds)
            .find(|(name, _)| **name == extension)
            .map(|(_, kind)| kind)
    }
}

/// Writes images as an animation of so many a second, that plays for ever where its kind can.
///
/// # Errors
/// What the system says, a file of another kind in the place, images of different sizes, and an ffmpeg that is not
/// there or refuses.
pub fn write(
    path: &Path,
    kind: FilmKind,
    images: impl ExactSizeIterator<Item = io::Result<Image>>,
    rate: f64,
) -> io::Result<()> {
    match kind {
        FilmKind::Png => files::write(path, files::PNG, |file| write_animation(images, rate, file)),
        FilmKind::Gif => files::write(path, GIF, |file| write_gif(images, rate, file)),
        FilmKind::Mp4 => by_ffmpeg((path, MP4), &["-c:v", "libx264", "-pix_fmt", "yuv420p"], images, rate),
        FilmKind::Webm => {
            by_ffmpeg((path, WEBM), &["-c:v", "libvpx-vp9", "-pix_fmt", "yuv420p"], images, rate)
        }
    }
}

fn write_gif(
    images: impl Iterator<Item = io::Result<Image>>,
    rate: f64,
    to: &mut dyn Write,
) -> io::Result<()> {
    let mut encoder = None;
    let mut to = Some(to);
    for image in images {
        let image = image?;
        let [width, height] = image.size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
        if let Some(to) = to.take() {
            let mut begun = gif::Encoder::new(to, width, height, &[]).map_err(io::Error::other)?;
            begun.set_repeat(gif::Repeat::Infinite).map_err(io::Error::other)?;
            let comment = gif::AnyExtension::from(gif::Extension::Comment);
            begun.write_raw_extension(comment, &[MARK.as_bytes()]).map_err(io::Error::other)?;
            encoder = Some(begun);
        }
        let mut frame = if image.opacity.is_empty() {
            gif::Frame::from_rgb_speed(width, height, &image.pixels, 10)
        } else {
            let mut frame = gif::Frame::from_rgba_speed(width, height, &mut image.with_opacity(), 10);
            // The next image is not to be drawn over this one.
            frame.dispose = gif::DisposalMethod::Background;
            frame
        };
        // Hundredths of a second.
        frame.delay = (100.0 / rate).round().clamp(1.0, 60_000.0) as u16;
        let encoder = encoder.as_mut().expect("it has begun with the first image");
        encoder.write_frame(&frame).map_err(io::Error::other)?;
    }
    Ok(())
}

/// Has the user's ffmpeg make a film of the images.
fn by_ffmpeg(
    (path, kind): (&Path, Kind),
    codec: &[&str],
    images: impl Iterator<Item = io::Result<Image>>,
    rate: f64,
) -> io::Result<()> {
    files::write_by(path, kind, |part| fill_by_ffmpeg((path, part), codec, images, rate))
}

/// The same into a file that is there under a name of its own.
fn fill_by_ffmpeg(
    (path, part): (&Path, &Path),
    codec: &[&str],
    images: impl Iterator<Item = io::Result<Image>>,
    rate: f64,
) -> io::Result<()> {
    let container = if FilmKind::of(path) == Some(FilmKind::Webm) { "webm" } else { "mp4" };
    let codec = [codec, &["-f", container]].concat();
    let mut running: Option<(Child, [usize; 2])> = None;
    let mut written = Ok(());
    for image in images {
        let image = image?;
        let (child, size) = match &mut running {
            Some(running) => running,
            None => running.insert((ffmpeg(part, &codec, (&image, rate))?, image.size)),
        };
        if image.size != *size {
            return Err(io::Error::new(ErrorKind::InvalidInput, "an animation of images of different sizes"));
        }
        let pipe = child.stdin.as_mut().expect("it was asked for");
        written = pipe.write_all(&image.pixels);
        if written.is_err() {
            break;
        }
    }
    let Some((child, _)) = running else { return Ok(()) };
    let done = child.wait_with_output()?;
    if done.status.success() {
        return written;
    }
    let said = String::from_utf8_lossy(&done.stderr);
    Err(io::Error::other(format!("ffmpeg says: {}", said.lines().last().unwrap_or("nothing"))))
}

/// Codecs want even sides: a line or a column more, of the colour that the image stands on.
fn padding(first: &Image) -> String {
    let [red, green, blue] = first.color(0, 0);
    format!("pad=ceil(iw/2)*2:ceil(ih/2)*2:color=0x{red:02x}{green:02x}{blue:02x}")
}

fn ffmpeg(path: &Path, codec: &[&str], (first, rate): (&Image, f64)) -> io::Result<Child> {
    let [width, height] = first.size;
    // An option's name may not stand where a file's should.
    let out = if path.is_absolute() { path.to_path_buf() } else { PathBuf::from(".").join(path) };
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
    command.args(["-s", &format!("{width}x{height}"), "-r", &rate.to_string(), "-i", "-"]);
    command.args(["-vf", &padding(first), "-metadata", &format!("comment={MARK}")]).args(codec).arg(out);
    let child = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    child.map_err(|error| match error.kind() {
        ErrorKind::NotFound => io::Error::new(
            error.kind(),
            "films of this kind are made by ffmpeg, which is not on the path; a name \
                                          that ends in .png or .gif needs none",
        ),
        _ => error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn images() -> impl ExactSizeIterator<Item = io::Result<Image>> {
        (0..3u8).map(|shade| Ok(Image::new([9, 5], [80 * shade, 0, 200])))
    }

    #[test]
    fn a_gif_has_every_image_and_its_delay() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film.GIF");
        assert_eq!(FilmKind::of(&path), Some(FilmKind::Gif));
        write(&path, FilmKind::Gif, images(), 20.0).expect("written");
        let mut decoder = gif::Decoder::new(std::fs::File::open(&path).expect("there")).expect("a GIF");
        assert_eq!((decoder.width(), decoder.height()), (9, 5));
        let mut delays = Vec::new();
        while let Some(frame) = decoder.read_next_frame().expect("sound") {
            delays.push(frame.delay);
        }
        assert_eq!(delays, [5, 5, 5]);
        write(&path, FilmKind::Gif, images(), 20.0).expect("its own it replaces");
        std::fs::write(&path, "precious").expect("written");
        assert!(write(&path, FilmKind::Gif, images(), 20.0).is_err(), "what is no GIF stays");
    }

    #[test]
    fn even_sides_are_filled_with_the_background() {
        let mut image = Image::new([9, 5], [0x10, 0x20, 0x03]);
        image.pixels[3 * 8..3 * 9].fill(255);
        assert_eq!(padding(&image), "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=0x102003");
    }

    #[test]
    fn kinds_are_known_by_their_names() {
        let kind = |name: &str| FilmKind::of(Path::new(name));
        assert_eq!([kind("a.mp4"), kind("a.webm"), kind("a.png")].map(|kind| kind.is_some()), [true; 3]);
        assert_eq!((kind("a.avi"), kind("mp4")), (None, None));
    }
}
