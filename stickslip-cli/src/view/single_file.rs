//! The page with all that it shows as one file, to be opened without a server or sent by mail.

use super::library::{Library, Refusal};
use super::page;
use super::route::Route;
use crate::files;
use bytesize::ByteSize;
use std::fmt;
use std::io;
use std::path::Path;
use stickslip::observe::{ParticleFile, ReadError};

/// Bodies whose way through time a file holds.
const MOST_BODIES: usize = 500;
/// Bytes of a particle's place, of that of a surface's corner, of a value of a quantity at either, and of a triangle.
const PLACE: u64 = 8;
const CORNER: u64 = 12;
const VALUE: u64 = 4;
const TRIANGLE: u64 = 12;

/// What a file will hold, and how large it can get.
#[derive(Clone, Debug)]
pub struct Estimate {
    frames: usize,
    particles: u64,
    quantities: usize,
    surfaces: bool,
    bytes: u64,
}

impl Estimate {
    /// Of a library with so many quantities, from what its files say of themselves.
    ///
    /// # Errors
    /// A frame cannot be read.
    pub fn of(library: &Library, quantities: usize) -> Result<Self, ReadError> {
        let frames = library.frames();
        let [head, foot] = page::halves();
        let skins = library.size_of_skins()?;
        let [corners, triangles] = skins.unwrap_or_default().map(|count| count as u64);
        let mut particles = 0;
        let mut data = triangles * TRIANGLE + corners;
        for frame in &frames {
            let count = ParticleFile::open(&frame.path)?.particles() as u64;
            particles = count.max(particles);
            data += count * PLACE + corners * CORNER + (count + corners) * VALUE * quantities as u64;
        }
        // Base64 has four letters for three bytes; packing makes them fewer.
        let bytes = (head.len() + foot.len()) as u64 + data * 4 / 3;
        Ok(Estimate { frames: frames.len(), particles, quantities, surfaces: skins.is_some(), bytes })
    }

    /// The most that it can take, tables apart [bytes].
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Estimate { frames, particles, quantities, surfaces, bytes } = self;
        let surfaces = if *surfaces { " and surfaces" } else { "" };
        let size = ByteSize(*bytes).display().si();
        write!(
            f,
            "{frames} frames of {particles} particles{surfaces} with {quantities} quantities: at most {size}"
        )
    }
}

/// Writes the page with the frames of a library and some of their quantities, and gives its length [bytes].
///
/// # Errors
/// Something cannot be read, or the file cannot be written.
pub fn write(library: &Library, quantities: &[String], out: &Path) -> io::Result<u64> {
    let frames = library.frames().len();
    let bodies = library.results().body_names().len().min(MOST_BODIES);
    let of_frame = |frame: usize| {
        let columns = quantities
            .iter()
            .flat_map(move |id| [Route::Column(frame, id.clone()), Route::SkinColumn(frame, id.clone())]);
        [Route::Frame(frame), Route::Contacts(frame), Route::SkinsIn(frame)].into_iter().chain(columns)
    };
    let routes = [Route::Index, Route::Energy, Route::Skins].into_iter();
    let routes = routes.chain((0..bodies).map(Route::Body)).chain((0..frames).flat_map(of_frame));
    let [head, foot] = page::halves();
    files::write(out, files::PAGE, |file| {
        file.write_all(head.as_bytes())?;
        for route in routes {
            match library.answer(&route) {
                Ok(content) => page::embed(&route, &content, file)?,
                Err(Refusal::Missing(_)) => {}
                Err(Refusal::Broken(what)) => return Err(io::Error::other(what)),
            }
        }
        file.write_all(foot.as_bytes())
    })?;
    Ok(std::fs::metadata(out)?.len())
}
