//! `stickslip render DIR`: pictures of snapshots.

use super::fringes::FringeArguments;
use super::{are_names, open, recorded, say};
use crate::drawing::{Background, ColorMap, DrawError, save};
use crate::failure::Failure;
use crate::files;
use crate::film::{self, FilmKind};
use crate::frame_pictures::FramePictures;
use crate::illustration::{Album, PictureChoice, Pictures, snapshots};
use crate::picture::{ColorQuantity, PicturePart, QuantityParser, ViewPath, Viewpoint};
use clap::{Args, Parser, ValueEnum};
use miette::miette;
use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use stickslip::image::Image;
use stickslip::observe::{FRAMES_PER_SECOND, Frame, PICTURE, Results};

/// Draw pictures of a run's snapshots.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results.
    folder: PathBuf,

    /// Which snapshot, counted from 0, or several side by side, separated by commas; the last without this.
    #[arg(long, value_delimiter = ',', value_name = "NUMBER", conflicts_with_all = ["time", "all", "animate"])]
    frame: Vec<usize>,

    /// The snapshot nearest to this time [s].
    #[arg(long, conflicts_with_all = ["all", "animate"], allow_negative_numbers = true)]
    time: Option<f64>,

    /// Every snapshot, from one place and with one range of colours.
    #[arg(long)]
    all: bool,

    /// Every snapshot as `--all` draws them, in one animation: PNG, which browsers play, GIF, or MP4 and WebM where
    /// ffmpeg is on the path.
    #[arg(long, conflicts_with = "all")]
    animate: bool,

    /// Snapshots that the animation shows in a second of the viewer's time; 10 without this.
    #[arg(long, value_name = "RATE", value_parser = rate, requires = "animate")]
    rate: Option<f64>,

    /// What colour stands for.
    #[arg(long, value_parser = QuantityParser, default_value = "body")]
    color: ColorQuantity,

    /// Only this body; may be repeated, and in a pattern `*` is any letters.
    #[arg(long = "body", value_name = "NAME", conflicts_with = "fringes")]
    only: Vec<String>,

    /// Values at the ends of the colours, in SI units, with --color: LOW,HIGH.
    #[arg(long, value_name = "LOW,HIGH", value_parser = pair, allow_hyphen_values = true)]
    range: Option<[f64; 2]>,

    /// The colours that values run through, with --color; those that suit without this.
    #[arg(long, value_enum)]
    colors: Option<ColorMap>,

    /// Average values over the neighbours of each particle within its body, as fringes do; without this, those that
    /// come of the stress are, which differs between neighbours by more than it means, and others are not.
    #[arg(long, value_name = "yes|no", conflicts_with = "fringes")]
    smooth: Option<Answer>,

    /// Lines along which the values are the same, so many at equal steps between the ends of the colours; in space on the
    /// surfaces that the camera sees.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u16).range(1..=100), conflicts_with = "fringes")]
    contours: Option<u16>,

    /// Arrows on a regular raster, averaged over neighbours; in space from the surfaces that the camera sees.
    #[arg(long, value_enum, value_name = "COLUMN", conflicts_with = "fringes")]
    vectors: Option<VectorColumn>,

    /// Draw the particles of bodies in space as balls, and not the surfaces that they carry.
    #[arg(long, conflicts_with = "fringes")]
    balls: bool,

    /// Where the camera stands in space: auto, an axis (x, -x, ...), or AZIMUTH,ELEVATION in degrees from the front.
    /// Several of these, as 0,20:90,20, are passed at even pace from the first snapshot to the last with `--all` and
    /// `--animate`.
    #[arg(long, default_value = "auto", allow_hyphen_values = true)]
    view: ViewPath,

    /// The part of the scene to show, by lengths in metres or with a unit: LEFT,BOTTOM,RIGHT,TOP, nothing beside which
    /// is shown; in space the two corners of a box that is to fill the picture, X,Y,Z,X,Y,Z.
    #[arg(long, value_name = "CORNERS", value_parser = window, allow_hyphen_values = true, conflicts_with = "fringes")]
    window: Option<Window>,

    /// Draw the other half across a plane of symmetry; without this, pictures of bodies do where the scene has just
    /// one.
    #[arg(long, value_parser = ["x", "y", "z", "none"])]
    mirror: Option<String>,

    /// Pixels; without this, the height follows the scene.
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size)]
    size: Option<[usize; 2]>,

    /// What the picture stands on: white, black, a colour as #RRGGBB, or transparent.
    #[arg(long, value_name = "COLOR", default_value = "white", conflicts_with = "fringes")]
    background: Background,

    /// What to leave out; may be several, separated by commas.
    #[arg(long, value_enum, value_name = "PART", value_delimiter = ',', conflicts_with = "fringes")]
    hide: Vec<PicturePart>,

    /// The picture, .png, the animation, .png, .gif, .mp4 or .webm, or the folder for `--all`; DIR/picture.png,
    /// DIR/animation.png or DIR/pictures without this, and fringes in the place of picture. With .glb the surfaces of
    /// bodies in space are written as a model in glTF, with their colours.
    #[arg(long)]
    out: Option<PathBuf>,

    #[command(flatten)]
    fringes: FringeArguments,
}

/// Yes or no.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Answer {
    Yes,
    No,
}

/// Columns that can be drawn as arrows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum VectorColumn {
    Velocity,
}

/// Corners of what is shown [m].
#[derive(Clone, Debug, PartialEq)]
struct Window(Vec<f64>);

fn window(text: &str) -> Result<Window, String> {
    let lengths: Option<Vec<f64>> = text.split(',').map(length).collect();
    let allowed = || "allowed: four lengths, or six in space, such as \"-2 mm,0,5 mm,1 cm\"".to_owned();
    lengths.filter(|lengths| [4, 6].contains(&lengths.len())).map(Window).ok_or_else(allowed)
}

/// A length in metres, which may have another unit.
fn length(text: &str) -> Option<f64> {
    const UNITS: [(&str, f64); 8] = [
        ("nm", 1e9),
        ("um", 1e6),
        ("\u{b5}m", 1e6),
        ("\u{3bc}m", 1e6),
        ("mm", 1e3),
        ("cm", 1e2),
        ("km", 1e-3),
        ("m", 1.0),
    ];
    let text = text.trim();
    let of_unit = |(unit, parts): &(&str, f64)| Some((text.strip_suffix(unit)?, *parts));
    let (number, parts) = UNITS.iter().find_map(of_unit).unwrap_or((text, 1.0));
    number.trim().parse::<f64>().ok().filter(|number| number.is_finite()).map(|number| number / parts)
}

#[test]
fn a_window_has_lengths_with_units() {
    assert_eq!(window("-2 mm,0, 5um,1e-2").unwrap(), Window(vec![-2e-3, 0.0, 5e-6, 1e-2]));
    assert_eq!(window("0,0,0,1cm,1 m,2").unwrap(), Window(vec![0.0, 0.0, 0.0, 1e-2, 1.0, 2.0]));
    for wrong in ["1,2,3", "0,0,1,1 s", "0,0,1,inf", "0,0,1,mm"] {
        assert!(window(wrong).unwrap_err().contains("four lengths"), "{wrong}");
    }
}

/// A number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    let positive = |value: &f64| value.is_finite() && *value > 0.0;
    text.parse().ok().filter(positive).ok_or_else(|| "allowed: a number above 0, in SI units".to_owned())
}

#[test]
fn a_positive_number_is_finite() {
    assert_eq!(positive("4e-12").unwrap(), 4e-12);
    assert!(positive("0").is_err() && positive("inf").is_err() && positive("4 MPa").is_err());
}

fn rate(text: &str) -> Result<f64, String> {
    let allowed = |rate: &f64| (0.1..=100.0).contains(rate);
    text.parse().ok().filter(allowed).ok_or_else(|| "allowed: 0.1 to 100".to_owned())
}

#[test]
fn a_rate_can_be_seen() {
    assert_eq!(rate("25").unwrap(), 25.0);
    assert!(rate("0").is_err() && rate("1000").is_err());
}

fn pair(text: &str) -> Result<[f64; 2], String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    let ends = text.split_once(',').and_then(|(low, high)| Some([number(low)?, number(high)?]));
    ends.filter(|[low, high]| low < high).ok_or_else(|| "allowed: two numbers, the smaller first".to_owned())
}

#[test]
fn a_range_is_two_numbers_in_order() {
    assert_eq!(pair("-1e3, 5").unwrap(), [-1e3, 5.0]);
    assert!(pair("3,2").is_err() && pair("3").is_err() && pair("0,inf").is_err());
}

fn size(text: &str) -> Result<[usize; 2], String> {
    let side = |text: &str| text.parse::<usize>().ok().filter(|side| (200..=8000).contains(side));
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "allowed: WIDTHxHEIGHT, each from 200 to 8000, such as 1280x720".to_owned())
}

#[test]
fn a_size_is_two_sides() {
    assert_eq!(size("1280x720").unwrap(), [1280, 720]);
    assert!(size("1280").is_err() && size("0x720").is_err() && size("10x99999").is_err());
}

/// The arguments alone, as a program.
#[derive(Parser)]
struct Alone {
    #[command(flatten)]
    arguments: Arguments,
}

impl Arguments {
    /// Those of a folder, of words that the program itself says, and of the file to be drawn.
    pub(super) fn of(folder: &Path, words: &[&str], out: &Path) -> Self {
        let paths = ["render".as_ref(), folder.as_os_str(), "--out".as_ref(), out.as_os_str()];
        Alone::parse_from(paths.into_iter().chain(words.iter().map(OsStr::new))).arguments
    }

    pub fn execute(self) -> Result<(), Failure> {
        let results = open(&self.folder)?;
        let frames = snapshots(&results)?;
        if self.all || self.animate {
            let pictures = self.pictures(&results, frames)?;
            return if self.all {
                self.draw_all(&*pictures, frames)
            } else {
                self.draw_film(&*pictures, frames)
            };
        }
        if self.view.is_path() {
            let allowed = "one place of the camera, or --all or --animate with it";
            return Err(Failure::Input(miette!(
                "--view: found a path for a single picture; allowed: {allowed}"
            )));
        }
        let chosen = self.chosen(frames)?;
        if let (Some(out), [frame]) = (self.out.as_ref().filter(|out| is_model(out)), &chosen[..]) {
            return self.write_model(out, &results, frame);
        }
        let out = self.file(PICTURE)?;
        let pictures = self.pictures(&results, &chosen)?;
        let drawn: Result<Vec<Image>, Failure> = chosen.iter().map(|frame| pictures.picture(frame)).collect();
        save(&side_by_side(&drawn?), &out)?;
        let times: Vec<String> = chosen.iter().map(|frame| significant(frame.time)).collect();
        say(&format!("{} shows t = {} s", out.display(), times.join(", ")))
    }

    /// What draws the snapshots `frames`, all from one place and with one range of colours.
    fn pictures<'a>(
        &self,
        results: &'a Results,
        frames: &[Frame],
    ) -> Result<Box<dyn Pictures + 'a>, Failure> {
        if self.fringes.fringes {
            let choice = self.fringes.choice(results.manifest().dimension, self.size)?;
            let pictures = FramePictures::open(results, frames, &choice)?;
            say(&pictures.scale())?;
            return Ok(Box::new(pictures));
        }
        let album = self.album(results)?;
        Ok(Box::new(if frames.len() > 1 { album.steadied()? } else { album }))
    }

    /// The snapshots as the user wants to see them.
    fn album<'a>(&self, results: &'a Results) -> Result<Album<'a>, Failure> {
        are_names(&self.only, results.body_names())?;
        let choice = PictureChoice {
            bodies: self.only.clone(),
            quantity: self.color.clone(),
            range: self.range,
            colors: self.colors,
            smooth: self.smooth.map(|answer| answer == Answer::Yes),
            contours: self.contours.unwrap_or_default().into(),
            arrows: self.vectors.is_some(),
            balls: self.balls,
            view: self.view.clone(),
            mirror: self.mirror.clone(),
            size: self.size,
            window: self.window.clone().map(|Window(lengths)| lengths),
            background: self.background,
            hidden: self.hide.clone(),
        };
        Album::open(results, choice)
    }

    /// Writes the surfaces of the bodies, which are no picture: nobody looks at them from somewhere.
    fn write_model(&self, out: &Path, results: &Results, frame: &Frame) -> Result<(), Failure> {
        let of_pictures = [
            ("--fringes", self.fringes.fringes),
            ("--balls", self.balls),
            ("--contours", self.contours.is_some()),
            ("--vectors", self.vectors.is_some()),
            ("--view", self.view != ViewPath(vec![Viewpoint::Auto])),
            ("--window", self.window.is_some()),
            ("--size", self.size.is_some()),
            ("--background", self.background != Background::Color([255; 3])),
            ("--hide", !self.hide.is_empty()),
        ];
        if let Some((option, _)) = of_pictures.iter().find(|(_, is_set)| *is_set) {
            let found = out.display();
            return Err(Failure::Input(miette!(
                "{option}: found a model, `{found}`; allowed: --frame, --time, --color, --range, --colors, --smooth, \
                 --body and --mirror, or a picture"
            )));
        }
        let model = self.album(results)?.model(frame)?;
        let written =
            model.encode().and_then(|bytes| files::write(out, files::GLB, |file| file.write_all(&bytes)));
        written.map_err(|source| DrawError::Write { path: out.to_path_buf(), source })?;
        let bodies = match model.parts().len() {
            1 => "surface of one body".to_owned(),
            several => format!("surfaces of {several} bodies"),
        };
        say(&format!("{} holds the {bodies} at t = {} s", out.display(), significant(frame.time)))
    }

    /// Where a picture goes: where the user says, or to a file of this name in the folder of results.
    fn file(&self, name: &str) -> Result<PathBuf, Failure> {
        let out = self.out.clone().unwrap_or_else(|| self.usual(name));
        if out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            return Ok(out);
        }
        let allowed = "a file name that ends in .png, or for one snapshot in .glb, or a folder with --all";
        Err(Failure::Input(miette!("--out: found `{}`; allowed: {allowed}", out.display())))
    }

    fn usual(&self, name: &str) -> PathBuf {
        let kind = if self.fringes.fringes { "fringes_" } else { "" };
        self.folder.join(format!("{kind}{name}"))
    }

    /// The snapshots that `--frame` or `--time` asks for; the last without them.
    fn chosen(&self, frames: &[Frame]) -> Result<Vec<Frame>, Failure> {
        let last = frames.len() - 1;
        let numbered = |&number: &usize| {
            let missing = || Failure::Input(miette!("--frame: found {number}; allowed: 0 to {last}"));
            frames.get(number).cloned().ok_or_else(missing)
        };
        if !self.frame.is_empty() {
            return self.frame.iter().map(numbered).collect();
        }
        let Some(time) = self.time else { return Ok(vec![frames[last].clone()]) };
        recorded(time, frames.iter().map(|frame| frame.time))?;
        let nearer = |a: &&Frame, b: &&Frame| (a.time - time).abs().total_cmp(&(b.time - time).abs());
        Ok(vec![frames.iter().min_by(nearer).expect("there is at least one snapshot").clone()])
    }

    fn draw_all(&self, pictures: &dyn Pictures, frames: &[Frame]) -> Result<(), Failure> {
        let out = self.out.clone().unwrap_or_else(|| self.usual("pictures"));
        std::fs::create_dir_all(&out)
            .map_err(|error| Failure::Input(miette!("cannot make {}: {error}", out.display())))?;
        for (number, frame) in frames.iter().enumerate() {
            save(&pictures.picture(frame)?, &out.join(format!("picture_{number:05}.png")))?;
        }
        say(&format!("{} holds {} pictures", out.display(), frames.len()))
    }

    fn draw_film(&self, pictures: &dyn Pictures, frames: &[Frame]) -> Result<(), Failure> {
        let out = self.out.clone().unwrap_or_else(|| self.usual("animation.png"));
        let kind = FilmKind::of(&out).ok_or_else(|| {
            let allowed = "a file name that ends in .png, .gif, .mp4 or .webm";
            Failure::Input(miette!("--out: found `{}`; allowed: {allowed}", out.display()))
        })?;
        if self.background == Background::Transparent && matches!(kind, FilmKind::Mp4 | FilmKind::Webm) {
            let allowed = "a colour, or a file name that ends in .png or .gif";
            return Err(Failure::Input(miette!(
                "--background: found `transparent` for a film; allowed: {allowed}"
            )));
        }
        // A picture that cannot be drawn has a better error than the file that lacks it.
        let mut failure = None;
        let images = frames.iter().map(|frame| {
            pictures.picture(frame).map_err(|error| {
                failure = Some(error);
                io::Error::other("a picture is missing")
            })
        });
        let rate = self.rate.unwrap_or(FRAMES_PER_SECOND);
        let written = film::write(&out, kind, images, rate);
        match (written, failure) {
            (_, Some(failure)) => Err(failure),
            (Err(source), None) => Err(DrawError::Write { path: out, source }.into()),
            (Ok(()), None) => say(&format!("{} plays {} pictures", out.display(), frames.len())),
        }
    }
}

/// Whether a name is that of a model.
fn is_model(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"))
}

/// Pictures of one size in rows, two or three in each; as the corner of the first where a row has none.
fn side_by_side(images: &[Image]) -> Image {
    let [width, height] = images[0].size;
    let columns = if images.len() < 5 { images.len().min(2) } else { 3 };
    let rows = images.len().div_ceil(columns);
    let mut whole = Image::new([columns * width, rows * height], images[0].color(0, 0));
    if let Some(&corner) = images[0].opacity.first() {
        whole.opacity = vec![corner; columns * width * rows * height];
    }
    for (place, image) in images.iter().enumerate() {
        let (column, row) = (place % columns, place / columns);
        for (y, line) in image.pixels.chunks_exact(3 * width).enumerate().take(height) {
            let first = 3 * (((row * height) + y) * columns * width + column * width);
            whole.pixels[first..first + 3 * width].copy_from_slice(line);
            if let Some(line) = image.opacity.chunks_exact(width).nth(y) {
                whole.opacity[first / 3..first / 3 + width].copy_from_slice(line);
            }
        }
    }
    whole
}

#[test]
fn pictures_stand_in_rows() {
    let mut shades = [255, 20, 30].map(|shade| Image::new([3, 2], [shade; 3]));
    let whole = side_by_side(&shades);
    assert_eq!(whole.size, [6, 4]);
    let at = |x: usize, y: usize| whole.pixels[3 * (6 * y + x)];
    assert_eq!([at(0, 0), at(5, 1), at(2, 3), at(3, 2)], [255, 20, 30, 255]);
    assert_eq!(side_by_side(&shades[..1]), shades[0]);
    for (image, opacity) in shades.iter_mut().zip([0, 90, 200]) {
        image.opacity = vec![opacity; 6];
    }
    let whole = side_by_side(&shades);
    let at = |x: usize, y: usize| whole.opacity[6 * y + x];
    assert_eq!([at(0, 0), at(5, 1), at(2, 3), at(3, 2)], [0, 90, 200, 0]);
}

/// A time as one reads it: six digits.
fn significant(time: f64) -> String {
    if time == 0.0 || (1e-3..1e6).contains(&time.abs()) {
        format!("{time:.6}")
    } else {
        format!("{time:.5e}")
    }
}

#[test]
fn short_times_keep_their_digits() {
    assert_eq!([0.0, 0.5, 2.2e-6].map(significant), ["0.000000", "0.500000", "2.20000e-6"]);
}
