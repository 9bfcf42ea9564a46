//! Bodies as smooth surfaces: the triangles of their shapes, carried along by their particles.

use super::open_frame::{OpenFrame, Run};
use super::quantity::Quantity;
use super::quarters::Quarters;
use rayon::prelude::*;
use stickslip::geometry::Bounds;
use stickslip::observe::{Manifest, ReadError, Results, SceneSource};
use stickslip::run::same_physics;
use stickslip::scene::Scene;
use stickslip::surface::{CarriedSkin, Skin};

/// First bytes of the triangles.
const MAGIC: [u8; 4] = *b"SSK1";

/// The skins of all bodies that have one.
pub struct Skins(Vec<BodySkin>);

struct BodySkin {
    /// The body's particles in the first frame.
    run: Run,
    carried: CarriedSkin,
}

/// Why there are no skins, or what cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum NoSkins {
    /// The scene is not known any more, or its particles cannot carry anything.
    #[error("no surfaces: {0}")]
    Unknown(String),
    /// A frame cannot be read.
    #[error(transparent)]
    Unread(#[from] ReadError),
}

impl Skins {
    /// The skins of a run's bodies, tied to the particles of its first frame, at this time [s].
    ///
    /// # Errors
    /// The scene file is gone or another one, the run began from another, or snapshots lack what is needed.
    pub fn of(results: &Results, (first, time): (&OpenFrame, f64)) -> Result<Self, NoSkins> {
        let scene = scene(results).map_err(NoSkins::Unknown)?;
        if time != 0.0 || scene.start.is_some() {
            return Err(NoSkins::Unknown("the first frame is not that of undeformed bodies".to_owned()));
        }
        let volume = first.quantities.iter().find(|quantity| quantity.id == "volume");
        let volume = volume.ok_or_else(|| lacks("volume"))?;
        let volumes = first.ordered(&volume.values(&first.file)?);
        let positions = first.ordered(&first.file.positions()?);
        let dimension = results.manifest().dimension;
        let within = scene.domain.as_ref().map(|domain| Bounds { min: domain.min, max: domain.max });
        let mut starts = Vec::new();
        let mut start = 0;
        for run in &first.runs {
            starts.push((*run, start));
            start += run.count as usize;
        }
        let skin = |(run, start): (Run, usize)| {
            let range = start..start + run.count as usize;
            let body = scene.bodies.get(run.body as usize)?;
            let mean = volumes[range.clone()].iter().sum::<f32>() / run.count as f32;
            let particle = f64::from(mean) * scene.outputs.snapshots.every as f64;
            let spacing = if dimension == 2 { particle.sqrt() } else { particle.cbrt() };
            let skin = Skin::of(&body.shape, spacing, dimension, within)?;
            let carried = CarriedSkin::new(skin, positions[range].to_vec(), spacing);
            Some(BodySkin { run, carried })
        };
        Ok(Skins(starts.into_par_iter().filter_map(skin).collect()))
    }

    /// How many corners and triangles there are.
    pub fn size(&self) -> [usize; 2] {
        let count = |of: fn(&Skin) -> usize| self.0.iter().map(|skin| of(skin.carried.skin())).sum();
        [count(|skin| skin.corners.len()), count(|skin| skin.triangles.len())]
    }

    /// The triangles as bytes, little-endian:
    ///
    /// ```text
    /// magic; u32 corners N, triangles M, bodies B; B times u32 body, corners, triangles
    /// M times u32 three corners, counted over all bodies; N times u8 1 if the corner is paler
    /// ```
    pub fn triangles(&self, quarters: &Quarters) -> Vec<u8> {
        let [corners, triangles] = self.size().map(|count| count as u32);
        let words = [corners, triangles, self.0.len() as u32];
        let bodies = self.0.iter().flat_map(|BodySkin { run, carried }| {
            [run.body, carried.skin().corners.len() as u32, carried.skin().triangles.len() as u32]
        });
        let mut bytes: Vec<u8> = MAGIC.into_iter().collect();
        bytes.extend(words.into_iter().chain(bodies).flat_map(u32::to_le_bytes));
        let mut first = 0;
        for BodySkin { carried, .. } in &self.0 {
            let corners = carried.skin().triangles.iter().flatten();
            bytes.extend(corners.flat_map(|corner| (first + corner).to_le_bytes()));
            first += carried.skin().corners.len() as u32;
        }
        for BodySkin { run, carried } in &self.0 {
            let number = |corner| run.first + carried.nearest(corner) as u32 * run.step;
            let pale = |corner| u8::from(quarters.is_pale(run.body, number(corner)));
            bytes.extend((0..carried.skin().corners.len()).map(pale));
        }
        bytes
    }

    /// The corners in a frame, as f32; not a number for a body whose particles are not all there.
    ///
    /// # Errors
    /// The frame has no deformations, or is cut short.
    pub fn corners(&self, frame: &OpenFrame) -> Result<Vec<u8>, NoSkins> {
        let column = frame.file.columns().find(|column| column.name == "deformation");
        let held = frame.file.column(column.ok_or_else(|| lacks("deformation"))?)?;
        let deformations = frame.ordered(held.values.as_chunks::<9>().0);
        let positions = frame.ordered(&frame.file.positions()?);
        let corners = |skin: &BodySkin| match skin.place(frame) {
            Some(range) => skin.carried.corners(&positions[range.clone()], &deformations[range]),
            None => vec![[f64::NAN; 3]; skin.carried.skin().corners.len()],
        };
        let found: Vec<Vec<[f64; 3]>> = self.0.par_iter().map(corners).collect();
        Ok(found.iter().flatten().flatten().flat_map(|x| (*x as f32).to_le_bytes()).collect())
    }

    /// A quantity at the corners in a frame.
    ///
    /// # Errors
    /// The frame is cut short.
    pub fn column(&self, frame: &OpenFrame, quantity: &Quantity) -> Result<Vec<f32>, NoSkins> {
        let values = frame.ordered(&quantity.values(&frame.file)?);
        let at_corners = |skin: &BodySkin| match skin.place(frame) {
            Some(range) => skin.carried.at_corners(&values[range]),
            None => vec![f32::NAN; skin.carried.skin().corners.len()],
        };
        Ok(self.0.par_iter().flat_map_iter(at_corners).collect())
    }
}

impl BodySkin {
    /// Where the particles that carry it stand in a frame, if they are the same as in the first.
    fn place(&self, frame: &OpenFrame) -> Option<std::ops::Range<usize>> {
        let mut start = 0;
        for run in &frame.runs {
            let end = start + run.count as usize;
            if *run == self.run && run.step > 0 {
                return Some(start..end);
            }
            start = end;
        }
        None
    }
}

fn lacks(column: &str) -> NoSkins {
    NoSkins::Unknown(format!("the snapshots lack the column {column}"))
}

/// The scene that was run, read again from its recorded text, else from its file: the record does not hold shapes that
/// can be read.
///
/// # Errors
/// A file is gone, or says another thing than when it was run.
pub fn scene(results: &Results) -> Result<Scene, String> {
    let manifest = results.manifest();
    let source: &SceneSource = manifest.source.as_ref().ok_or("the run did not come from a scene file")?;
    let read = source.recorded().unwrap_or_else(|| source.load());
    let loaded = read.map_err(|error| format!("the scene cannot be read again: {error}"))?;
    let now = Manifest::record(&loaded.scene);
    same_physics(&source.path, &manifest.scene.value(), &now).map_err(|error| error.to_string())?;
    Ok(loaded.scene)
}
