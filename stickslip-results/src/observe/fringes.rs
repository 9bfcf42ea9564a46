//! `fringes/` and `fringes.png`: photoelastic fringes as a camera behind a polariscope sees them,
//! frame by frame and as an animation.

use super::file::{FileSum, OutputError, is_there, remove_from, replace, replace_summed, secure};
use super::folder::OutputFolder;
use super::memory::Memory;
use super::shared::{Look, bounds_on_ranks, light_on_ranks};
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::work::work;
use super::writer::Writer;
use super::{FRINGES, FRINGES_ANIMATION, FRINGES_TABLE, Observer};
use crate::door::{ContactCursor, ContactState, ParticleSnapshot, View};
use crate::image::{Image, write_animation};
use crate::polariscope::{
    Film, ImageWindow, LinearRgb, Link, OpticalBench, Push, Stage, bounds, draw_links, links,
};
use crate::scene::{self, Overlay, Scene};
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::{Deserialize, Serialize};
use std::fs;
use std::num::NonZero;
use std::path::PathBuf;

/// Frames of an animation that a viewer sees in a second.
pub const FRAMES_PER_SECOND: f64 = 10.0;

/// One frame; the columns of `fringes.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FringeRow {
    /// Number of the frame, which is the name of its file.
    pub frame: usize,
    /// Mean of the simulated times whose light it has [s].
    pub time: f64,
    /// First of these times [s].
    pub from: f64,
    /// Last of these times [s].
    pub to: f64,
    /// How many they are.
    pub samples: usize,
}

impl TableRow for FringeRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { frame, time, from, to, samples } = self;
        columns![frame, time, from, to, samples]
    }
}

/// Writes `fringes.csv`, the frames in `fringes/`, and at the end `fringes.png`, all by a thread of its own.
pub(super) struct FringesObserver {
    shutter: Shutter,
    overlay: Overlay,
    /// Whether there was a first look.
    looked: bool,
    contacts: ContactCursor,
    /// What ranks that share the simulation need to know.
    look: Look,
    /// What is in the picture, once that is known and ranks need it.
    window: Option<ImageWindow>,
    writer: Writer<FringeWriter>,
}

/// Where light falls on film and becomes pictures.
struct FringeWriter {
    camera: scene::Fringes,
    specimens: Vec<usize>,
    folder: OutputFolder,
    table: CsvTable<FringeRow>,
    frames: Vec<PathBuf>,
    /// Of each, what is in its file.
    sums: Vec<FileSum>,
    /// How many of them are known to be on the disk.
    secured: usize,
    /// From the first look on.
    view: Option<Photograph>,
    /// Largest force between two bodies so far [N].
    largest: f64,
    /// Processors that the run leaves free, if any; else pictures share those of the run.
    hands: Option<ThreadPool>,
}

/// The bench, and what has fallen on the film since the shutter opened.
struct Photograph {
    bench: OpticalBench,
    film: Film,
    times: Vec<f64>,
    links: Vec<Link>,
}

/// What an instant leaves on the film.
struct Exposure {
    /// [s]
    time: f64,
    /// What bodies push on each other, where that is drawn.
    pushes: Option<Vec<Push>>,
    /// Whether it is the last of its frame.
    last: bool,
}

/// When light falls on film: at instants spread evenly over each open time, the middles of equal parts.
struct Shutter {
    first: f64,
    interval: f64,
    exposure: f64,
    samples: usize,
    frame: u64,
    sample: usize,
}

/// Part of the interval by which an instant may come early, so that the rounding of summed steps does not delay it by a
/// whole step.
const EARLY: f64 = 1e-6;

impl Shutter {
    fn new(camera: &scene::Fringes) -> Self {
        let scene::Fringes { first, interval, exposure, samples, .. } = *camera;
        Shutter { first, interval, exposure, samples, frame: 0, sample: 0 }
    }

    /// The next instant [s].
    fn next(&self) -> f64 {
        self.instant(self.sample) - EARLY * self.interval
    }

    fn instant(&self, sample: usize) -> f64 {
        let share = (sample as f64 + 0.5) / self.samples as f64;
        self.first + self.frame as f64 * self.interval + share * self.exposure
    }

    /// Goes past the instants up to a time [s]; true if that ends the frame.
    fn pass(&mut self, time: f64) -> bool {
        while self.sample < self.samples && self.next() <= time {
            self.sample += 1;
        }
        if self.sample < self.samples {
            return false;
        }
        // Frames that a step jumps over are skipped.
        while self.sample == self.samples {
            (self.frame, self.sample) = (self.frame + 1, 0);
            while self.sample < self.samples && self.next() <= time {
                self.sample += 1;
            }
        }
        true
    }
}

impl FringesObserver {
    pub(super) fn create(
        (scene, camera): (&Scene, &scene::Fringes),
        folder: &OutputFolder,
    ) -> Result<Self, OutputError> {
        let path = folder.join(FRINGES);
        fs::create_dir_all(&path).map_err(OutputError::at(&path))?;
        let birefringent = |body: &scene::Body| camera.bodies.contains(&body.name);
        let look = Look {
            dimension: scene.dimension.axes(),
            bodies: scene.bodies.len(),
            specimens: (0..scene.bodies.len()).filter(|&i| birefringent(&scene.bodies[i])).collect(),
            polariscope: camera.polariscope,
        };
        let writer = FringeWriter {
            specimens: look.specimens.clone(),
            folder: folder.clone(),
            table: CsvTable::create(folder, FRINGES_TABLE, scene.outputs.measurements.unit())?,
            frames: Vec::new(),
            sums: Vec::new(),
            secured: 0,
            view: None,
            largest: 0.0,
            hands: idle_processors(),
            camera: camera.clone(),
        };
        Ok(FringesObserver {
            shutter: Shutter::new(camera),
            overlay: camera.overlay,
            looked: false,
            contacts: ContactCursor::default(),
            look,
            window: None,
            writer: Writer::start(writer, &path, folder.waiting())?,
        })
    }
}

impl FringesObserver {
    /// The same where ranks share the particles: they make the light.
    fn look_on_ranks(&mut self, view: &dyn View, exposure: Option<Exposure>) -> Result<(), OutputError> {
        let window = match self.window {
            Some(window) => window,
            None => {
                let known =
                    |writer: &mut FringeWriter| Ok(writer.camera.view.is_some() || writer.view.is_some());
                let found = if self.writer.ask(known)? { None } else { bounds_on_ranks(view, &self.look) };
                self.writer.ask(move |writer| Ok(writer.window(|_| found)))?
            }
        };
        self.window = Some(window);
        let Some(exposure) = exposure else { return Ok(()) };
        let pushes = exposure.pushes.clone().unwrap_or_default();
        let Some((light, links)) = light_on_ranks(view, (&self.look, window), pushes) else { return Ok(()) };
        let bytes = size_of_val(&light[..]);
        self.writer.hand_over(bytes, move |writer| writer.expose((&light, links), exposure));
        Ok(())
    }
}

/// Threads for the processors that the simulation does not use.
fn idle_processors() -> Option<ThreadPool> {
    let all = std::thread::available_parallelism().map_or(1, NonZero::get);
    let idle = all.saturating_sub(rayon::current_num_threads());
    if idle == 0 {
        return None;
    }
    // Without threads of their own, pictures are made by those of the view.
    ThreadPoolBuilder::new().num_threads(idle).thread_name(|i| format!("pictures {i}")).build().ok()
}

impl FringeWriter {
    /// What is in the picture: from the first look on what the camera says, or where `find` finds specimens then.
    fn window(&mut self, find: impl FnOnce(&[usize]) -> Option<[[f64; 2]; 2]>) -> ImageWindow {
        let FringeWriter { camera, specimens, view, .. } = self;
        let view = view.get_or_insert_with(|| {
            // Bodies without particles leave nothing to frame.
            let shown = camera.view.or_else(|| find(specimens)).unwrap_or([[0.0; 2], [1.0; 2]]);
            let stage =
                Stage { window: ImageWindow::around(shown, camera.width), specimens: specimens.clone() };
            let bench = OpticalBench::new(&camera.polariscope, stage);
            Photograph { film: bench.film(), bench, times: Vec::new(), links: Vec::new() }
        });
        view.bench.stage().window
    }

    /// Looks at particles, and lets their light fall on the film if it is time.
    fn look(&mut self, particles: &ParticleSnapshot, exposure: Option<Exposure>) -> Result<(), OutputError> {
        self.window(|specimens| bounds(particles, specimens));
        let (Some(Photograph { bench, .. }), Some(exposure)) = (&self.view, exposure) else { return Ok(()) };
        let light = work(|| match &self.hands {
            Some(hands) => hands.install(|| bench.light(particles)),
            None => bench.light(particles),
        });
        let links = links(particles, exposure.pushes.as_deref().unwrap_or_default(), &self.specimens);
        self.expose((&light, links), exposure)
    }

    /// Lets light fall on the film, of bodies with these links.
    fn expose(
        &mut self,
        (light, links): (&[LinearRgb], Vec<Link>),
        Exposure { time, pushes, last }: Exposure,
    ) -> Result<(), OutputError> {
        let Some(view) = &mut self.view else { return Ok(()) };
        view.film.expose(light);
        view.times.push(time);
        if let Some(pushes) = pushes {
            self.largest = pushes.iter().fold(self.largest, |largest, push| largest.max(push.force));
            view.links = links;
        }
        if last { self.develop() } else { Ok(()) }
    }

    /// Writes what is on the film, and puts in new film.
    fn develop(&mut self) -> Result<(), OutputError> {
        let Some(view) = self.view.as_mut().filter(|view| !view.times.is_empty()) else { return Ok(()) };
        let mut image = view.film.develop();
        draw_links(&mut image, &view.bench.stage().window, (&view.links, self.largest));
        let times = std::mem::take(&mut view.times);
        view.film = view.bench.film();
        let path = self.frame(self.frames.len());
        let sum = replace_summed(&path, |file| image.write_png(file))?;
        self.table.append([FringeRow {
            frame: self.frames.len(),
            time: times.iter().sum::<f64>() / times.len() as f64,
            from: times[0],
            to: times[times.len() - 1],
            samples: times.len(),
        }])?;
        self.frames.push(path);
        self.sums.push(sum);
        Ok(())
    }

    /// Writes all frames as an animation; the run may have ended while the shutter was open.
    fn conclude(&mut self) -> Result<(), OutputError> {
        self.develop()?;
        self.table.finish()?;
        if self.frames.is_empty() {
            return Ok(());
        }
        let frames = self.frames.iter().map(|path| Image::read_png(path));
        replace(&self.folder.join(FRINGES_ANIMATION), |file| write_animation(frames, FRAMES_PER_SECOND, file))
    }
}

/// What a resumed run needs of pictures: what is in their table, and what has fallen on the film of the next.
#[derive(Serialize, Deserialize)]
struct SavedFringes {
    table: FileSum,
    largest: f64,
    view: Option<(ImageWindow, Film, Vec<f64>, Vec<Link>)>,
}

impl FringeWriter {
    fn save(&mut self) -> Result<(SavedFringes, Vec<FileSum>), OutputError> {
        self.frames[self.secured..].iter().try_for_each(|path| secure(path))?;
        self.secured = self.frames.len();
        secure(&self.folder.join(FRINGES))?;
        let view = self.view.as_ref().map(|view| {
            let Photograph { bench, film, times, links } = view;
            (bench.stage().window, film.clone(), times.clone(), links.clone())
        });
        let table = self.table.secured()?;
        Ok((SavedFringes { table, largest: self.largest, view }, self.sums.clone()))
    }

    /// No pictures yet.
    fn nothing(&self) -> SavedFringes {
        SavedFringes { table: self.table.header(), largest: 0.0, view: None }
    }

    /// Goes on from there, or only looks whether it could, if not in earnest; false if the film is another camera's.
    fn take_up(
        &mut self,
        (saved, sums): (SavedFringes, Vec<FileSum>),
        in_earnest: bool,
    ) -> Result<bool, OutputError> {
        let of_camera = |(window, film, ..): &(ImageWindow, Film, Vec<f64>, Vec<Link>)| {
            let [width, height] = window.size;
            width == self.camera.width && height <= 8 * width && film.fits(window.size)
        };
        if !saved.view.iter().all(of_camera) {
            return Ok(false);
        }
        (sums.iter().enumerate()).try_for_each(|(number, sum)| is_there(&self.frame(number), Some(sum)))?;
        self.table.cut(saved.table, in_earnest)?;
        if !in_earnest {
            return Ok(true);
        }
        self.frames = (0..sums.len()).map(|number| self.frame(number)).collect();
        remove_from((sums.len()..).map(|number| self.frame(number)))?;
        (self.secured, self.sums) = (self.secured.min(sums.len()), sums);
        self.largest = saved.largest;
        self.view = saved.view.map(|(window, film, times, links)| {
            let stage = Stage { window, specimens: self.specimens.clone() };
            Photograph { bench: OpticalBench::new(&self.camera.polariscope, stage), film, times, links }
        });
        Ok(true)
    }

    fn frame(&self, number: usize) -> PathBuf {
        self.folder.join(&format!("{FRINGES}/{}", frame_file(number)))
    }
}

/// Name of the file of a frame.
pub(super) fn frame_file(number: usize) -> String {
    format!("{number:05}.png")
}

impl Observer for FringesObserver {
    fn next(&self) -> f64 {
        // The first look, at the start, says where the bodies are.
        if self.looked { self.shutter.next() } else { f64::NEG_INFINITY }
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let (time, due) = (view.time(), view.time() >= self.shutter.next());
        if !due && self.looked {
            return Ok(());
        }
        self.writer.make_room()?;
        let pushes = (due && self.overlay == Overlay::ForceChains).then(|| {
            let push = |contact: ContactState| Push {
                bodies: [contact.body_a, contact.body_b],
                force: contact.mean.normal,
            };
            self.contacts.read(view).into_iter().map(push).collect()
        });
        let exposure = due.then(|| Exposure { time, pushes, last: self.shutter.pass(time) });
        self.looked = true;
        if !view.shares().is_empty() {
            return self.look_on_ranks(view, exposure);
        }
        let particles = view.snapshot();
        self.writer.hand_over(particles.bytes(), move |writer| writer.look(&particles, exposure));
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.writer.hand_over(0, FringeWriter::conclude);
        self.writer.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        let Shutter { frame, sample, .. } = &mut self.shutter;
        memory.keep("frame", frame)?;
        memory.keep("sample", sample)?;
        memory.keep("looked", &mut self.looked)?;
        memory.keep("contacts", &mut self.contacts)?;
        // What the checkpoint does not know was not there.
        let (mut saved, mut sums) = match memory.is_taking_up() {
            true => self.writer.ask(|writer| Ok((writer.nothing(), Vec::new())))?,
            false => self.writer.ask(FringeWriter::save)?,
        };
        memory.keep("film", &mut saved)?;
        memory.keep("sums", &mut sums)?;
        if !memory.is_taking_up() {
            return Ok(());
        }
        let in_earnest = memory.is_in_earnest();
        let fits = self.writer.ask(move |writer| writer.take_up((saved, sums), in_earnest))?;
        if fits { Ok(()) } else { Err(memory.wrong("film", "it does not fit the camera of the scene")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The instants at which light falls on film for steps of a length, a list for each frame.
    fn frames(mut shutter: Shutter, step: f64, steps: usize) -> Vec<Vec<f64>> {
        let (mut frames, mut open) = (Vec::new(), Vec::new());
        for time in (0..=steps).map(|i| step * i as f64) {
            if time >= shutter.next() {
                open.push(time);
                if shutter.pass(time) {
                    frames.push(std::mem::take(&mut open));
                }
            }
        }
        frames
    }

    fn shutter(first: f64, exposure: f64, samples: usize) -> Shutter {
        Shutter { first, interval: 1.0, exposure, samples, frame: 0, sample: 0 }
    }

    #[test]
    fn an_instant_without_exposure_is_at_the_opening() {
        assert_eq!(frames(shutter(0.5, 0.0, 1), 0.25, 11), [[0.5], [1.5], [2.5]]);
        assert_eq!(frames(shutter(0.0, 0.0, 1), 0.375, 6), [[0.0], [1.125], [2.25]]);
    }

    #[test]
    fn instants_are_spread_over_the_open_time() {
        let all = frames(shutter(0.0, 0.5, 2), 0.125, 16);
        assert_eq!(all, [[0.125, 0.375], [1.125, 1.375]]);
    }

    #[test]
    fn steps_longer_than_the_interval_skip_frames() {
        assert_eq!(frames(shutter(0.0, 0.5, 4), 2.5, 3), [[2.5], [5.0], [7.5]]);
    }
}
