//! All answers that the page can get, from a folder of results that may still grow.

use super::index::{index, pulse};
use super::open_frame::OpenFrame;
use super::page;
use super::places::places;
use super::quantity::Quantity;
use super::quarters::Quarters;
use super::route::Route;
use super::skins::{NoSkins, Skins};
use super::tables::{Stamp, Tables, stamp};
use crate::frame_pictures::{FramePictures, FringeChoice};
use crate::illustration::Pictures;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, RwLock};
use stickslip::observe::{Frame, ReadError, Results};

/// The answers from one folder.
pub struct Library {
    folder: PathBuf,
    /// As they were when the page asked last how far the run is.
    results: RwLock<Arc<Results>>,
    /// Frames that are shown, counted from 0; all of them without it.
    excerpt: Option<Vec<usize>>,
    tables: Tables,
    /// Frames that were asked for last.
    open: Mutex<VecDeque<(PathBuf, Stamp, Arc<OpenFrame>)>>,
    quarters: OnceLock<Quarters>,
    skins: OnceLock<Skins>,
    /// What draws fringes, and for how many frames it was made.
    fringes: Mutex<Option<(usize, Arc<FramePictures>)>>,
}

/// What the page gets.
#[derive(Debug)]
pub struct Content {
    /// Its media type.
    pub kind: &'static str,
    /// Itself.
    pub bytes: Vec<u8>,
}

/// Why the page does not get something.
#[derive(Debug)]
pub enum Refusal {
    /// There is no such thing.
    Missing(String),
    /// It cannot be read or made.
    Broken(String),
}

/// Frames that are kept open: the one that is looked at, and those that the page fetches ahead.
const OPEN: usize = 3;
/// Between values that are shown as the ends of a range, so many of a thousand lie; outliers do not stretch it.
const INNER: [f64; 2] = [0.001, 0.999];

impl From<ReadError> for Refusal {
    fn from(error: ReadError) -> Self {
        Refusal::Broken(error.to_string())
    }
}

impl From<NoSkins> for Refusal {
    fn from(error: NoSkins) -> Self {
        match error {
            NoSkins::Unknown(_) => Refusal::Missing(error.to_string()),
            NoSkins::Unread(error) => error.into(),
        }
    }
}

impl Library {
    /// The answers from a folder of results; of its frames only an excerpt, if there is one.
    ///
    /// # Errors
    /// The folder holds no results.
    pub fn open(folder: &Path, excerpt: Option<Vec<usize>>) -> Result<Self, ReadError> {
        Ok(Library {
            folder: folder.to_path_buf(),
            results: RwLock::new(Arc::new(Results::open(folder)?)),
            excerpt,
            tables: Tables::of(folder),
            open: Mutex::default(),
            quarters: OnceLock::new(),
            skins: OnceLock::new(),
            fringes: Mutex::default(),
        })
    }

    /// The results as they were when they were read last.
    pub fn results(&self) -> Arc<Results> {
        self.results.read().expect("no thread panics while it holds them").clone()
    }

    /// The frames that are shown.
    pub fn frames(&self) -> Vec<Frame> {
        let results = self.results();
        let all = results.frames();
        match &self.excerpt {
            Some(chosen) => chosen.iter().filter_map(|&frame| all.get(frame)).cloned().collect(),
            None => all.to_vec(),
        }
    }

    /// What colour can stand for in the first frame; nothing if there is none.
    ///
    /// # Errors
    /// The frame cannot be read.
    pub fn quantities(&self) -> Result<Vec<Quantity>, ReadError> {
        let first = self.frames().first().map(|frame| self.opened(frame)).transpose()?;
        Ok(first.map(|first| first.quantities.clone()).unwrap_or_default())
    }

    /// Corners and triangles of all surfaces; nothing if there are none.
    ///
    /// # Errors
    /// The first frame cannot be read.
    pub fn size_of_skins(&self) -> Result<Option<[usize; 2]>, ReadError> {
        match self.skins(&self.results()) {
            Ok(skins) => Ok(Some(skins.size()).filter(|[corners, _]| *corners > 0)),
            Err(NoSkins::Unknown(_)) => Ok(None),
            Err(NoSkins::Unread(error)) => Err(error),
        }
    }

    /// The answer to what the page asks for.
    ///
    /// # Errors
    /// There is no such thing, or it cannot be read.
    pub fn answer(&self, route: &Route) -> Result<Content, Refusal> {
        let results = self.results();
        match route {
            Route::Page => {
                Ok(Content { kind: "text/html; charset=utf-8", bytes: page::served().into_bytes() })
            }
            Route::Index => {
                let frames = self.frames();
                let first = frames.first().map(|frame| self.opened(frame)).transpose()?;
                Ok(Content::json(&index(&results, &frames, first.as_deref())?))
            }
            Route::Pulse => {
                let results = Arc::new(Results::open(&self.folder)?);
                *self.results.write().expect("no thread panics while it holds them") = results.clone();
                let (energy, _) = stamp(&self.folder.join("energy.csv"));
                Ok(Content::json(&pulse(&results, self.frames().len(), energy)))
            }
            Route::Energy => Ok(Content::json(&self.tables.energy(&results)?)),
            Route::Contacts(frame) => {
                Ok(Content::json(&self.tables.contacts(&results, self.frame(*frame)?.time)?))
            }
            Route::Body(body) => {
                let name = results.body_names().get(*body);
                let name = name.ok_or_else(|| Refusal::Missing(format!("there is no body {body}")))?;
                Ok(Content::json(&self.tables.body(&results, name)?))
            }
            Route::Frame(frame) => {
                let frame = self.opened(&self.frame(*frame)?)?;
                let manifest = results.manifest();
                let bytes = places(&frame, self.quarters(&results)?, (manifest.dimension, manifest.cell))?;
                Ok(Content::binary(bytes))
            }
            Route::Column(frame, quantity) => {
                let frame = self.opened(&self.frame(*frame)?)?;
                let values = frame.ordered(&quantity_of(&frame, quantity)?.values(&frame.file)?);
                Ok(Content::binary(column(&values)))
            }
            Route::Skins => {
                let skins = self.skins(&results)?;
                Ok(Content::binary(skins.triangles(self.quarters(&results)?)))
            }
            Route::SkinsIn(frame) => {
                let skins = self.skins(&results)?;
                Ok(Content::binary(skins.corners(&*self.opened(&self.frame(*frame)?)?)?))
            }
            Route::SkinColumn(frame, quantity) => {
                let skins = self.skins(&results)?;
                let frame = self.opened(&self.frame(*frame)?)?;
                Ok(Content::binary(column(&skins.column(&frame, quantity_of(&frame, quantity)?)?)))
            }
            Route::Particle(body, number, quantity) => self.history(*body, *number, quantity),
            Route::Fringes(frame) => self.fringes(&results, *frame),
        }
    }

    fn frame(&self, number: usize) -> Result<Frame, Refusal> {
        let frames = self.frames();
        let missing = || Refusal::Missing(format!("there is no frame {number}, of {}", frames.len()));
        frames.get(number).cloned().ok_or_else(missing)
    }

    /// A frame, as it was opened before if its file has not changed.
    fn opened(&self, frame: &Frame) -> Result<Arc<OpenFrame>, ReadError> {
        let stamp = stamp(&frame.path);
        let held = || self.open.lock().expect("no thread panics while it looks for a frame");
        let known = held().iter().find(|(path, known, _)| *path == frame.path && *known == stamp).cloned();
        if let Some((_, _, opened)) = known {
            return Ok(opened);
        }
        let opened = Arc::new(OpenFrame::open(&frame.path)?);
        let mut open = held();
        open.retain(|(path, ..)| *path != frame.path);
        open.truncate(OPEN - 1);
        open.push_front((frame.path.clone(), stamp, opened.clone()));
        Ok(opened)
    }

    fn quarters(&self, results: &Results) -> Result<&Quarters, ReadError> {
        if let Some(quarters) = self.quarters.get() {
            return Ok(quarters);
        }
        let Some(first) = results.frames().first() else {
            return Ok(self.quarters.get_or_init(Quarters::default));
        };
        let first = self.opened(first)?;
        let quarters = Quarters::of(&first, &results.scene()?, results.manifest().dimension)?;
        Ok(self.quarters.get_or_init(|| quarters))
    }

    fn skins(&self, results: &Results) -> Result<&Skins, NoSkins> {
        if let Some(skins) = self.skins.get() {
            return Ok(skins);
        }
        let first = results.frames().first();
        let first = first.ok_or_else(|| NoSkins::Unknown("there is no frame yet".to_owned()))?;
        let skins = Skins::of(results, (&*self.opened(first)?, first.time))?;
        Ok(self.skins.get_or_init(|| skins))
    }

    /// A quantity at a particle through the frames that have it.
    fn history(&self, body: usize, number: u32, quantity: &str) -> Result<Content, Refusal> {
        let at = |frame: &Frame| -> Result<Option<(f64, f32)>, Refusal> {
            let opened = OpenFrame::open(&frame.path)?;
            let Some(place) = opened.place(body, number) else { return Ok(None) };
            Ok(Some((frame.time, opened.value(quantity_of(&opened, quantity)?, place)?)))
        };
        let found: Result<Vec<_>, Refusal> = self.frames().par_iter().map(at).collect();
        let (times, values): (Vec<f64>, Vec<f32>) = found?.into_iter().flatten().unzip();
        Ok(Content::json(&json!({ "time": times, "value": values })))
    }

    fn fringes(&self, results: &Results, number: usize) -> Result<Content, Refusal> {
        let frames = self.frames();
        let frame = self.frame(number)?;
        let mut held = self.fringes.lock().expect("no thread panics while it holds the pictures");
        let pictures = match &*held {
            Some((count, pictures)) if *count == frames.len() => pictures.clone(),
            _ => {
                let pictures = FramePictures::open(results, &frames, &FringeChoice::default());
                let pictures = Arc::new(pictures.map_err(|failure| Refusal::Broken(failure.to_string()))?);
                *held = Some((frames.len(), pictures.clone()));
                pictures
            }
        };
        drop(held);
        let picture = pictures.picture(&frame).map_err(|failure| Refusal::Broken(failure.to_string()))?;
        let mut bytes = Vec::new();
        picture.write_png(&mut bytes).map_err(|error| Refusal::Broken(error.to_string()))?;
        Ok(Content { kind: "image/png", bytes })
    }
}

impl Content {
    fn json(value: &Value) -> Self {
        Content { kind: "application/json", bytes: value.to_string().into_bytes() }
    }

    fn binary(bytes: Vec<u8>) -> Self {
        Content { kind: "application/octet-stream", bytes }
    }
}

fn quantity_of<'a>(frame: &'a OpenFrame, id: &str) -> Result<&'a Quantity, Refusal> {
    let found = frame.quantities.iter().find(|quantity| quantity.id == id);
    let allowed =
        || frame.quantities.iter().map(|quantity| quantity.id.as_str()).collect::<Vec<_>>().join(", ");
    found.ok_or_else(|| Refusal::Missing(format!("found `{id}`; allowed: {}", allowed())))
}

/// Values as bytes, little-endian f32: least, largest, the ends of [`INNER`], then all of them.
fn column(values: &[f32]) -> Vec<u8> {
    let mut sorted: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.par_sort_unstable_by(f32::total_cmp);
    let at = |share: f64| {
        sorted.get((share * sorted.len().saturating_sub(1) as f64) as usize).copied().unwrap_or(0.0)
    };
    let ends = [0.0, 1.0, INNER[0], INNER[1]].map(at);
    ends.iter().chain(values).flat_map(|value| value.to_le_bytes()).collect()
}
