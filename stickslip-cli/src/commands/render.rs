//! `stickslip render DIR`: pictures of snapshots.

use super::{open, say};
use crate::failure::Failure;
use crate::illustration::{Album, PictureChoice};
use crate::picture::{Quantity, View};
use clap::Args;
use miette::miette;
use std::path::PathBuf;
use stickslip::observe::Frame;

/// Draw pictures of a run's snapshots.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results.
    folder: PathBuf,

    /// Which snapshot, counted from 0; the last without this.
    #[arg(long, conflicts_with_all = ["time", "all"])]
    frame: Option<usize>,

    /// The snapshot nearest to this time [s].
    #[arg(long, conflicts_with = "all", allow_negative_numbers = true)]
    time: Option<f64>,

    /// Every snapshot, from one place and with one range of colours.
    #[arg(long)]
    all: bool,

    /// What colour stands for.
    #[arg(long, value_enum, default_value = "body")]
    color: Quantity,

    /// Values at the ends of the colours, in SI units: LOW,HIGH.
    #[arg(long, value_name = "LOW,HIGH", value_parser = pair, allow_hyphen_values = true)]
    range: Option<[f64; 2]>,

    /// Where the camera stands: auto, an axis (x, -x, ...), or AZIMUTH,ELEVATION in degrees from the front.
    #[arg(long, default_value = "auto", allow_hyphen_values = true)]
    view: View,

    /// Draw the other half across a plane of symmetry; without this, pictures of bodies do where the scene has just one.
    #[arg(long, value_parser = ["x", "y", "z", "none"])]
    mirror: Option<String>,

    /// Pixels; without this, the height follows the scene.
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size)]
    size: Option<[usize; 2]>,

    /// The picture, .png, or the folder for `--all`; DIR/picture.png or DIR/pictures without this.
    #[arg(long)]
    out: Option<PathBuf>,
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

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let results = open(&self.folder)?;
        let choice = PictureChoice {
            quantity: self.color,
            range: self.range,
            view: self.view,
            mirror: self.mirror.clone(),
            size: self.size,
        };
        let album = Album::open(&results, choice)?;
        if self.all {
            return self.draw_all(&album);
        }
        let frame = self.chosen(album.frames())?;
        let out = self.out.clone().unwrap_or_else(|| self.folder.join("picture.png"));
        if !out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            let allowed = "a file name that ends in .png, or a folder with --all";
            return Err(Failure::Input(miette!("--out: found `{}`; allowed: {allowed}", out.display())));
        }
        album.draw(frame, &out)?;
        say(&format!("{} shows t = {:.6} s", out.display(), frame.time))
    }

    /// The snapshot that `--frame` or `--time` asks for; the last without them.
    fn chosen<'a>(&self, frames: &'a [Frame]) -> Result<&'a Frame, Failure> {
        let last = frames.len() - 1;
        if let Some(number) = self.frame {
            let missing = || Failure::Input(miette!("--frame: found {number}; allowed: 0 to {last}"));
            return frames.get(number).ok_or_else(missing);
        }
        let time = self.time.unwrap_or(f64::INFINITY);
        let nearer = |a: &&Frame, b: &&Frame| (a.time - time).abs().total_cmp(&(b.time - time).abs());
        let nearest = if time.is_finite() { frames.iter().min_by(nearer) } else { frames.last() };
        Ok(nearest.expect("an album has at least one frame"))
    }

    fn draw_all(&self, album: &Album) -> Result<(), Failure> {
        let out = self.out.clone().unwrap_or_else(|| self.folder.join("pictures"));
        std::fs::create_dir_all(&out)
            .map_err(|error| Failure::Input(miette!("cannot make {}: {error}", out.display())))?;
        let album = album.steadied()?;
        for (number, frame) in album.frames().iter().enumerate() {
            album.draw(frame, &out.join(format!("picture_{number:05}.png")))?;
        }
        say(&format!("{} holds {} pictures", out.display(), album.frames().len()))
    }
}
