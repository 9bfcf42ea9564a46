//! Pictures and a chart of a folder of results.

use crate::chart::{ChartChoice, chart};
use crate::drawing::{Background, ColorMap, DrawError, Scale, save};
use crate::failure::Failure;
use crate::picture::{
    self, BoxCorners, ColorQuantity, Outlines, PicturePart, PictureStyle, Quarters, Setting, Skins, Subject,
    SymmetryPlane, ViewPath, Viewpoint,
};
use crate::view;
use miette::miette;
use std::path::Path;
use std::sync::Arc;
use stickslip::door::ParticleSnapshot;
use stickslip::image::Image;
use stickslip::observe::{CHART, Frame, PICTURE, ParticleFile, Performance, Results};
use stickslip::scene::NamePattern;
use stickslip::surface::model::Model;

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
    /// Whether values are averaged over neighbours; without it, those are that come of the stress.
    pub smooth: Option<bool>,
    /// How many lines are drawn along which the values are the same.
    pub contours: usize,
    /// Whether velocities are drawn as arrows.
    pub arrows: bool,
    /// Whether bodies in space are drawn as particles, and not by their surfaces.
    pub balls: bool,
    /// Where the camera stands, or goes from the first snapshot to the last.
    pub view: ViewPath,
    /// `x`, `y`, `z` or `none`. Without it, pictures of bodies are mirrored where the scene has just one plane of
    /// symmetry; pictures of values are not, as the cut shows the inside.
    pub mirror: Option<String>,
    /// Width and height in pixels.
    pub size: Option<[usize; 2]>,
    /// Lower and upper corner of what is shown [m]: two numbers each in the plane, three in space.
    pub window: Option<Vec<f64>>,
    /// What the picture stands on.
    pub background: Background,
    /// What is left out.
    pub hidden: Vec<PicturePart>,
}

impl Default for PictureChoice {
    fn default() -> Self {
        PictureChoice {
            bodies: Vec::new(),
            quantity: ColorQuantity::Body,
            range: None,
            colors: None,
            smooth: None,
            contours: 0,
            arrows: false,
            balls: false,
            view: ViewPath(vec![Viewpoint::Auto]),
            mirror: None,
            size: None,
            window: None,
            background: Background::Color([255; 3]),
            hidden: Vec::new(),
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
    window: Option<BoxCorners>,
    /// The largest speed of all snapshots [m/s].
    fastest: Option<f64>,
    skins: Option<Arc<Skins>>,
    outlines: Option<Arc<Outlines>>,
}

impl<'a> Album<'a> {
    /// Opens the snapshots of a run.
    ///
    /// # Errors
    /// There are none, no law remembers what colour is to stand for, the scene has no plane of symmetry where the user
    /// wants a mirror, or has another dimension than what the user wants to see.
    pub fn open(results: &'a Results, choice: PictureChoice) -> Result<Self, Failure> {
        let start = snapshots(results)?.first().expect("there is at least one");
        needs_whole_snapshots(results)?;
        let setting = Setting::of(&results.scene().map_err(Failure::input)?);
        let setting = setting.with_floors(&results.manifest().scene.value());
        let mirror = mirror(&setting, &choice)?;
        let window = fits(results.manifest().dimension, &choice)?;
        let shown = shown(results, &choice);
        let setting = setting.with_bodies(&shown);
        let first = particles(results, &shown, start)?;
        choice.quantity.is_in(&first).map_err(|what| Failure::Input(miette!("--color: {what}")))?;
        let quarters = picture::quarters(&first, &setting);
        let skins = if choice.balls { None } else { skins(results, (&first, start.time)) };
        let outlines = outlines(results, (&first, start.time));
        Ok(Album {
            results,
            setting,
            quarters,
            mirror,
            choice,
            shown,
            bounds: None,
            window,
            fastest: None,
            skins,
            outlines,
        })
    }

    /// The same album with one camera and one range of colours for all pictures.
    pub fn steadied(&self) -> Result<Self, Failure> {
        let mut album = self.clone();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut fastest = 0.0f64;
        for frame in self.results.frames() {
            let particles = particles(self.results, &self.shown, frame)?;
            let here = picture::bounds(&particles);
            let all = album.bounds.get_or_insert(here);
            for axis in 0..3 {
                all[0][axis] = all[0][axis].min(here[0][axis]);
                all[1][axis] = all[1][axis].max(here[1][axis]);
            }
            let [low, high] = self.scale(&self.subject(&particles)).range;
            range = [range[0].min(low), range[1].max(high)];
            fastest = fastest.max(self.fastest(&particles));
        }
        album.choice.range = Some(range);
        album.fastest = Some(fastest);
        Ok(album)
    }

    fn subject<'p>(&'p self, particles: &'p ParticleSnapshot) -> Subject<'p> {
        let quantity = &self.choice.quantity;
        Subject::new(particles, quantity, self.choice.smooth.unwrap_or(quantity.is_stress()))
    }

    fn scale(&self, subject: &Subject) -> Scale {
        let scale = match self.choice.range {
            Some(range) => subject.quantity.scale_between(range),
            None => subject.quantity.scale(&subject.values),
        };
        Scale { map: self.choice.colors, ..scale }
    }

    /// The largest speed of all particles [m/s].
    fn fastest(&self, particles: &ParticleSnapshot) -> f64 {
        let speeds = particles.velocity.iter().map(|v| v.iter().map(|c| c * c).sum::<f64>());
        speeds.fold(0.0, f64::max).sqrt()
    }

    /// The surfaces of the bodies in a snapshot.
    ///
    /// # Errors
    /// There are none: the scene is one of the plane, its file or the snapshot of its start is not there, or all bodies
    /// lost particles.
    pub fn model(&self, frame: &Frame) -> Result<Model, Failure> {
        let missing = |why: &str| {
            let allowed = "runs in space whose scene is there, with a snapshot of the start; outputs.surfaces has others";
            Failure::Input(miette!("--out: found {why}; allowed for a model: {allowed}"))
        };
        if self.results.manifest().dimension == 2 {
            return Err(missing("a plane scene"));
        }
        let particles = particles(self.results, &self.shown, frame)?;
        let subject = self.subject(&particles);
        let model = picture::model(&subject, &self.setting, (frame.time, &self.style(&subject, frame)));
        if model.parts().is_empty() {
            return Err(missing("no surface of any body"));
        }
        Ok(model)
    }

    /// How the picture of a snapshot is to look.
    fn style(&self, subject: &Subject, frame: &Frame) -> PictureStyle {
        let number = self.results.frames().iter().position(|other| other.path == frame.path);
        let choice = &self.choice;
        PictureStyle {
            scale: self.scale(subject),
            view: self.views().nth(number.unwrap_or_default()).unwrap_or(Viewpoint::Auto),
            mirror: self.mirror,
            size: choice.size,
            bounds: self.bounds,
            window: self.window,
            path: if choice.view.is_path() { self.views().collect() } else { Vec::new() },
            background: choice.background,
            contours: choice.contours,
            fastest: choice.arrows.then(|| self.fastest.unwrap_or_else(|| self.fastest(subject.particles))),
            hidden: choice.hidden.clone(),
            skins: self.skins.clone(),
            outlines: self.outlines.clone(),
        }
    }

    /// Where the camera stands in each of the run's snapshots.
    fn views(&self) -> impl Iterator<Item = Viewpoint> {
        let count = self.results.frames().len();
        let share = move |i: usize| i as f64 / count.saturating_sub(1).max(1) as f64;
        (0..count).map(move |i| self.choice.view.at(share(i)))
    }
}

impl Pictures for Album<'_> {
    fn picture(&self, frame: &Frame) -> Result<Image, Failure> {
        let particles = particles(self.results, &self.shown, frame)?;
        let subject = self.subject(&particles);
        let look = self.style(&subject, frame);
        Ok(picture::draw(&subject, &self.setting, &self.quarters, (frame.time, &look))?)
    }
}

/// The surfaces of the bodies in space, tied to their particles in the first snapshot; none if that is not of the
/// start, or if the scene's file is gone or another one.
fn skins(results: &Results, (first, time): (&ParticleSnapshot, f64)) -> Option<Arc<Skins>> {
    if first.dimension == 2 || time != 0.0 {
        return None;
    }
    let scene = view::scene(results).ok().filter(|scene| scene.start.is_none())?;
    Some(Arc::new(Skins::new(&scene, first)))
}

/// The same of rigid bodies in the plane: their shapes.
fn outlines(results: &Results, (first, time): (&ParticleSnapshot, f64)) -> Option<Arc<Outlines>> {
    if first.dimension != 2 || time != 0.0 {
        return None;
    }
    let scene = view::scene(results).ok().filter(|scene| scene.start.is_none())?;
    Some(Arc::new(Outlines::new(&scene, first)))
}

/// The part of space that the user wants to see.
///
/// # Errors
/// That, or what is to be drawn there, does not suit the dimension of the scene.
fn fits(dimension: usize, choice: &PictureChoice) -> Result<Option<BoxCorners>, Failure> {
    let wrong = |what: String| Err(Failure::Input(miette!("{what}")));
    let first =
        |options: &[(&'static str, bool)]| options.iter().find(|(_, is_set)| *is_set).map(|(name, _)| *name);
    let of_values = [
        ("--contours", choice.contours > 0),
        ("--smooth", choice.smooth == Some(true)),
        ("--range", choice.range.is_some()),
        ("--colors", choice.colors.is_some()),
    ];
    if let Some(option) = first(&of_values).filter(|_| choice.quantity == ColorQuantity::Body) {
        return wrong(format!("{option}: found no column of numbers; allowed: with --color and one of them"));
    }
    let of_space = [("--balls", choice.balls), ("--view", choice.view.0 != [Viewpoint::Auto])];
    if let Some(option) = first(&of_space).filter(|_| dimension == 2) {
        return wrong(format!("{option}: found a plane scene; allowed: scenes in space"));
    }
    let Some(numbers) = &choice.window else { return Ok(None) };
    if numbers.len() != 2 * dimension {
        let allowed = match dimension {
            2 => "four lengths in a plane scene, LEFT,BOTTOM,RIGHT,TOP",
            _ => "six lengths in space, the lower corner x,y,z and the upper",
        };
        return wrong(format!("--window: found {} lengths; allowed: {allowed}", numbers.len()));
    }
    let corner = |of: &[f64]| [0, 1, 2].map(|axis| of.get(axis).copied().unwrap_or(0.0));
    let (low, high) = numbers.split_at(dimension);
    if (0..dimension).any(|axis| low[axis] >= high[axis]) {
        return wrong(
            "--window: found a corner that is not above the first; allowed: lower corner, upper corner"
                .to_owned(),
        );
    }
    Ok(Some([corner(low), corner(high)]))
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
        "fabric.csv",
        "tractions.csv",
        "probes.csv",
        "arrivals.csv",
        "fronts.csv",
        "front_speeds.csv",
    ];
    drawn.extend(measured.into_iter().filter(|name| folder.join(name).exists()));
    let Performance { ranks, particles, .. } = &results.manifest().performance;
    let are_many = *particles > MOST_PARTICLES_DRAWN || results.body_names().len() > MOST_BODIES_DRAWN;
    let too_many = ranks.len() > 1 && are_many;
    // The user waits for them.
    let (charted, pictured) = rayon::join(
        || draw_chart(&results, folder),
        || if too_many { Ok(false) } else { draw_last(&results, folder) },
    );
    if charted? {
        drawn.push(CHART);
    }
    if !results.frames().is_empty() {
        drawn.push("particles.pvd");
    }
    if pictured? {
        drawn.push(PICTURE);
    }
    if folder.join("fringes.png").exists() {
        drawn.push("fringes.png");
    }
    let mut told = drawn.join(", ");
    if too_many && !results.frames().is_empty() {
        // One of an earlier end would pass for that of this one.
        let _ = std::fs::remove_file(folder.join(PICTURE));
        told += &format!(
            "\n  no picture: it takes all particles and surfaces in one process; `stickslip render {}` draws it",
            folder.display()
        );
    }
    Ok(told)
}

/// Of results of several processes, so many particles and bodies are drawn unasked: a picture takes all of them in one.
const MOST_PARTICLES_DRAWN: usize = 1 << 18;
const MOST_BODIES_DRAWN: usize = 1 << 12;

/// Draws what the scene is about into `plot.png`; false if there is nothing to draw.
fn draw_chart(results: &Results, folder: &Path) -> Result<bool, Failure> {
    let chart = chart(results, &ChartChoice::default()).map_err(Failure::input)?;
    match crate::chart::draw(&chart, &folder.join(CHART), chart.size()) {
        Ok(()) => Ok(true),
        Err(DrawError::Empty(_)) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

/// Draws the last snapshot into `picture.png`; false if there is none, or not all of one, or nothing is left in it.
fn draw_last(results: &Results, folder: &Path) -> Result<bool, Failure> {
    let last = results.frames().last().filter(|_| results.has_whole_snapshots());
    let Some(last) = last else { return Ok(false) };
    if ParticleFile::open(&last.path).map_err(Failure::input)?.particles() == 0 {
        return Ok(false);
    }
    let picture = Album::open(results, PictureChoice::default())?.picture(last)?;
    save(&picture, &folder.join(PICTURE))?;
    Ok(true)
}
