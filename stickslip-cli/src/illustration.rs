//! Pictures and a chart of a folder of results.

use crate::chart::{ChartChoice, chart};
use crate::drawing::{ColorMap, DrawError, Scale, save};
use crate::failure::Failure;
use crate::picture::{
    self, BoxCorners, ColorQuantity, PictureStyle, Quarters, Setting, SymmetryPlane, Viewpoint,
};
use miette::miette;
use std::path::Path;
use stickslip::door::ParticleSnapshot;
use stickslip::image::Image;
use stickslip::observe::{Frame, Results};
use stickslip::scene::NamePattern;

/// A way to draw snapshots.
pub trait Pictures {
    /// The picture of a snapshot.
    fn picture(&self, frame: &Frame) -> Result<Image, Failure>;
}

/// What the user wants to see of snapshots.
#[derive(Clone, Debug)]
pub struct PictureChoice {
    /// Names of bodies, or patterns of names; none means all.
    pub bodies: Vec<String>,
    /// What colour stands for.
    pub quantity: ColorQuantity,
    /// Values at the ends of the colours; those that occur, without it.
    pub range: Option<[f64; 2]>,
    /// The colours of values; those that suit, without it.
    pub colors: Option<ColorMap>,
    /// Where the camera stands.
    pub view: Viewpoint,
    /// `x`, `y`, `z` or `none`. Without it, pictures of bodies are mirrored where the scene has just one plane of
    /// symmetry; pictures of values are not, as the cut shows the inside.
    pub mirror: Option<String>,
    /// Width and height in pixels.
    pub size: Option<[usize; 2]>,
}

impl Default for PictureChoice {
    fn default() -> Self {
        PictureChoice {
            bodies: Vec::new(),
            quantity: ColorQuantity::Body,
            range: None,
            colors: None,
            view: Viewpoint::Auto,
            mirror: None,
            size: None,
        }
    }
}

/// Refuses results whose snapshots leave out what pictures show.
pub fn needs_whole_snapshots(results: &Results) -> Result<(), Failure> {
    if results.has_whole_snapshots() {
        return Ok(());
    }
    Err(Failure::Input(miette!(
        help = "run the scene without outputs.snapshots.every and outputs.snapshots.columns",
        "the snapshots do not hold every particle with all that pictures need"
    )))
}

/// The snapshots of a run, ready to be drawn.
#[derive(Clone)]
pub struct Album<'a> {
    results: &'a Results,
    setting: Setting,
    quarters: Quarters,
    mirror: Option<SymmetryPlane>,
    choice: PictureChoice,
    /// Of each body, whether it is drawn.
    shown: Vec<bool>,
    bounds: Option<BoxCorners>,
}

impl<'a> Album<'a> {
    /// Opens the snapshots of a run.
    ///
    /// # Errors
    /// There are none, no law remembers what colour is to stand for, or the scene has no plane of symmetry where the
    /// user wants a mirror.
    pub fn open(results: &'a Results, choice: PictureChoice) -> Result<Self, Failure> {
        let first = snapshots(results)?.first().expect("there is at least one");
        needs_whole_snapshots(results)?;
        let setting = Setting::of(&results.scene().map_err(Failure::input)?);
        let setting = setting.with_floors(&results.manifest().scene);
        let mirror = mirror(&setting, &choice)?;
        let shown = shown(results, &choice);
        let first = particles(results, &shown, first)?;
        choice.quantity.is_in(&first).map_err(|what| Failure::Input(miette!("--color: {what}")))?;
        let quarters = picture::quarters(&first, &setting);
        Ok(Album { results, setting, quarters, mirror, choice, shown, bounds: None })
    }

    /// The same album with one camera and one range of colours for all pictures.
    pub fn steadied(&self) -> Result<Self, Failure> {
        let mut album = self.clone();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for frame in self.results.frames() {
            let particles = particles(self.results, &self.shown, frame)?;
            let here = picture::bounds(&particles);
            let all = album.bounds.get_or_insert(here);
            for axis in 0..3 {
                all[0][axis] = all[0][axis].min(here[0][axis]);
                all[1][axis] = all[1][axis].max(here[1][axis]);
            }
            let [low, high] = self.scale(&particles).range;
            range = [range[0].min(low), range[1].max(high)];
        }
        album.choice.range = Some(range);
        Ok(album)
    }

    fn scale(&self, particles: &ParticleSnapshot) -> Scale {
        let quantity = &self.choice.quantity;
        let scale = match self.choice.range {
            Some(range) => quantity.scale_between(range),
            None => {
                let count = particles.body.len();
                let values: Vec<f64> = (0..count).map(|i| quantity.value(particles, i)).collect();
                quantity.scale(&values)
            }
        };
        Scale { map: self.choice.colors, ..scale }
    }
}

impl Pictures for Album<'_> {
    fn picture(&self, frame: &Frame) -> Result<Image, Failure> {
        let particles = particles(self.results, &self.shown, frame)?;
        let look = PictureStyle {
            quantity: self.choice.quantity.clone(),
            scale: self.scale(&particles),
            view: self.choice.view,
            mirror: self.mirror,
            size: self.choice.size,
            bounds: self.bounds,
        };
        let canvas = picture::draw(&particles, &self.setting, &self.quarters, (frame.time, &look))?;
        Ok(canvas.image())
    }
}

/// Of each body, whether the user wants to see it.
fn shown(results: &Results, choice: &PictureChoice) -> Vec<bool> {
    let patterns: Vec<NamePattern> = choice.bodies.iter().map(|body| NamePattern::new(body)).collect();
    let is_wanted =
        |name: &String| patterns.is_empty() || patterns.iter().any(|pattern| pattern.matches(name));
    results.body_names().iter().map(is_wanted).collect()
}

/// The particles of a snapshot that are drawn.
fn particles(results: &Results, shown: &[bool], frame: &Frame) -> Result<ParticleSnapshot, Failure> {
    let all = results.particles(frame).map_err(Failure::input)?;
    if shown.iter().all(|shown| *shown) {
        return Ok(all);
    }
    let some = all.only(|body, _| shown[body as usize]);
    match some.body.is_empty() {
        false => Ok(some),
        true => Err(Failure::Input(miette!(
            "--body: found bodies without particles in the snapshot; allowed: others"
        ))),
    }
}

/// The snapshots of a run, at least one.
///
/// # Errors
/// There are none.
pub fn snapshots(results: &Results) -> Result<&[Frame], Failure> {
    let none = || {
        Failure::Input(miette!(
            help = "let the scene write particles, and run it again",
            "the run wrote no snapshots of particles"
        ))
    };
    Some(results.frames()).filter(|frames| !frames.is_empty()).ok_or_else(none)
}

fn mirror(setting: &Setting, choice: &PictureChoice) -> Result<Option<SymmetryPlane>, Failure> {
    let Some(name) = &choice.mirror else {
        let bodies = choice.quantity == ColorQuantity::Body;
        return Ok(setting.only_mirror().filter(|_| bodies));
    };
    let Some(axis) = ["x", "y", "z"].iter().position(|axis| axis == name) else { return Ok(None) };
    let mirror = setting.mirrors.iter().find(|mirror| mirror.axis == axis);
    let missing = || Failure::Input(miette!("--mirror: the scene has no plane of symmetry across {name}"));
    mirror.copied().map(Some).ok_or_else(missing)
}

/// Draws the chart and the picture that every run leaves, and names them.
pub fn illustrate(folder: &Path) -> Result<String, Failure> {
    let results = Results::open(folder).map_err(Failure::input)?;
    let mut drawn = vec!["bodies.csv", "energy.csv", "contacts.csv", "run.json"];
    let measured = [
        "loads.csv",
        "joints.csv",
        "removed.csv",
        "sections.csv",
        "reactions.csv",
        "groups.csv",
        "group_contacts.csv",
        "probes.csv",
        "arrivals.csv",
        "fronts.csv",
        "front_speeds.csv",
    ];
    drawn.extend(measured.into_iter().filter(|name| folder.join(name).exists()));
    let chart = chart(&results, &ChartChoice::default()).map_err(Failure::input)?;
    match crate::chart::draw(&chart, &folder.join("plot.png"), chart.size()) {
        Ok(()) => drawn.push("plot.png"),
        Err(DrawError::Empty(_)) => {}
        Err(error) => return Err(error.into()),
    }
    if let Some(last) = results.frames().last() {
        drawn.push("particles.pvd");
        if results.has_whole_snapshots() {
            let picture = Album::open(&results, PictureChoice::default())?.picture(last)?;
            save(&picture, &folder.join("picture.png"))?;
            drawn.push("picture.png");
        }
    }
    if folder.join("fringes.png").exists() {
        drawn.push("fringes.png");
    }
    Ok(drawn.join(", "))
}
