//! `[[images]]`: bodies from the labels or the greys of an image, in space of a stack of images.

use super::Context;
use super::body::{Bodies, BodyKeys, Rigid, material_of};
use super::files::read_file;
use super::pixels::{self, Slice};
use super::quantity::{Length, QuantityInput, Ratio, Velocity};
use super::read::table;
use super::text::{Choice, Count, Text, Word};
use super::vector::{SpinInput, VectorInput};
use crate::geometry::{Curved, Pixels, Shape, Solids, image_parts};
use crate::scene::error::Fault;
use crate::scene::{self, Interior, NamedMaterial};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

table! {
    /// Bodies from an image, a body of each label, or of each bright part of a grey image.
    Image {
        /// What the bodies are called: "grain" makes "grain 7" of label 7; of greys "grain 1", "grain 2" ...
        name: Text,
        /// A PNG or TIFF file of greys; in space a TIFF file with a page for each slice along z, or PNG files with a *
        /// in their name, in the order in which people count. A relative path starts at the folder of the scene file.
        file: Text,
        /// Side of a pixel [m]; in space also the distance between slices.
        pixel: QuantityInput<Length>,
        /// Lower corner of the image [m]; by default the origin.
        origin: Option<VectorInput<Length>>,
        /// Name of the bodies' material.
        material: Text,
        /// The label of what is no body.
        #[schemars(extend("default" = 0))]
        background: Option<Count>,
        /// The labels that become bodies, such as [1, 2, 5]; by default all but the background.
        labels: Option<Vec<Count>>,
        /// Grey from which on pixels are solid; those that touch are one body. The pixels are then no labels.
        threshold: Option<QuantityInput<Ratio>>,
        /// Which side of the threshold is solid.
        #[schemars(extend("default" = "bright"))]
        solid: Option<Word<Side>>,
        /// Bodies of fewer pixels are left out.
        #[schemars(extend("default" = 1))]
        least_pixels: Option<Count>,
        /// Particles along each side of a cell, 1 to 8; by default as many as space has.
        particles_per_side: Option<Count>,
        /// Where they are computed, if they deform; by default as space says.
        interior: Option<Word<Interior>>,
        /// Side of the cells of their own grids [m], with interior = "reference"; by default that of space.
        cell: Option<QuantityInput<Length>>,
        /// Velocity of each at the start [m/s]; by default none.
        velocity: Option<VectorInput<Velocity>>,
        /// Angular velocity of each about its centre of mass at the start [rad/s]; by default none.
        spin: Option<SpinInput>,
        /// Makes the bodies rigid and prescribes their motion; excludes velocity and spin.
        rigid: Option<Rigid>,
    }
}

/// Which side of a threshold is solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Bright,
    Dark,
}

impl Choice for Side {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("bright", Side::Bright, "Pixels brighter than the threshold are solid."),
        ("dark", Side::Dark, "Pixels darker than the threshold are solid."),
    ];
}

/// Pixels that an image may have.
const MOST_PIXELS: usize = 1 << 30;

/// Bytes that a file of an image may have.
const LARGEST_FILE: u64 = 1 << 33;

/// The largest label: whole numbers up to it are exact.
const LARGEST_LABEL: usize = 1 << 24;

/// Bodies that an image may make.
const MOST_BODIES: usize = 100_000;

impl Image {
    /// Takes the bodies of the image.
    pub fn add_to(
        &self,
        bodies: &mut Bodies,
        (materials, declared): (&[NamedMaterial], &str),
        context: &Context,
    ) -> Result<(), Fault> {
        let (name, file) = (self.name.value(context)?, self.file.value(context)?);
        let material = material_of(&self.material, materials, context)?;
        let side = self.pixel.positive(context)?;
        let solids = self.solids(context)?;
        let least =
            self.least_pixels.as_ref().map_or(Ok(1), |count| count.value(context, 1..=MOST_PIXELS))?;
        let keys = BodyKeys { velocity: &self.velocity, spin: &self.spin, rigid: &self.rigid };
        let (motion, by_place) = keys.motion(context)?;
        let per_side =
            self.particles_per_side.as_ref().map(|count| count.value(context, 1..=8)).transpose()?;
        let interior = self.interior.as_ref().map(|word| word.value(context)).transpose()?;
        let cell = self.cell.as_ref().map(|cell| cell.positive(context)).transpose()?;
        let image = self.pixels(&file, context)?;
        if matches!(solids, Solids::Labels { .. }) {
            self.are_labels(&file, &image)?;
        }
        let origin = self.origin.as_ref().map_or(Ok([0.0; 3]), |origin| origin.value(context))?;
        let axes = context.dimension.axes();
        let first = std::array::from_fn(|k| if k < axes { origin[k] + 0.5 * side } else { 0.0 });
        let found = image_parts(&image, &solids, (least, &file), (first, side)).map_err(|spread| {
            let found =
                format!("{} bodies in boxes of {:.1e} pixels in all", spread.parts, spread.pixels as f64);
            let help =
                "a label should be one body; greys need a threshold, and least_pixels leaves out specks";
            self.file_fault(&file, found, &format!("at most {MOST_BODIES} bodies, each in one place"))
                .help(Some(help.to_string()))
        })?;
        self.all_are_there(&found, &solids, context)?;
        if found.is_empty() {
            let (found, allowed) = match solids {
                Solids::Labels { background, .. } => {
                    (format!("no pixels but those of the background, {background}"), "an image with labels")
                }
                Solids::Brighter { .. } => {
                    let [darkest, brightest] = range(&image);
                    (
                        format!("greys from {darkest} to {brightest}"),
                        "an image with greys on both sides of threshold",
                    )
                }
            };
            let found = if least > 1 { format!("{found}, but for less than {least} pixels") } else { found };
            return Err(self.file_fault(&file, found, allowed));
        }
        for (number, part) in found {
            let shape = Shape::from(Curved::Image(part));
            let mut body = scene::Body::new(&format!("{name} {number}"), material, shape);
            (body.particles_per_side, body.motion) = (per_side, motion.clone());
            (body.interior, body.cell, body.velocity_by_place) = (interior, cell, by_place.clone());
            bodies.add(body, &self.name, declared)?;
        }
        Ok(())
    }

    fn solids(&self, context: &Context) -> Result<Solids, Fault> {
        let label = |count: &Count| count.value(context, 0..=LARGEST_LABEL).map(|label| label as f32);
        if let Some(threshold) = &self.threshold {
            let than = threshold.checked(context, "a grey that is finite", f64::is_finite)? as f32;
            let beside = "nothing beside threshold: the pixels are no labels";
            if let Some(count) = &self.background {
                return Err(count.refused(context, beside)?);
            }
            if let Some(count) = self.labels.iter().flatten().next() {
                return Err(count.refused(context, beside)?);
            }
            let side = self.solid.as_ref().map_or(Ok(Side::Bright), |word| word.value(context))?;
            return Ok(Solids::Brighter { than, inverted: side == Side::Dark });
        }
        if let Some(word) = &self.solid {
            return Err(word.refused(context, "solid beside threshold"));
        }
        let wanted = self.labels.as_ref().map(|labels| labels.iter().map(label).collect()).transpose()?;
        Ok(Solids::Labels { background: self.background.as_ref().map_or(Ok(0.0), label)?, wanted })
    }

    /// The pixels of all slices.
    fn pixels(&self, file: &str, context: &Context) -> Result<Pixels, Fault> {
        let paths = self.paths(file, context)?;
        let (mut slices, mut left) = (Vec::new(), MOST_PIXELS);
        for path in &paths {
            let named = path.strip_prefix(context.folder).unwrap_or(path).to_string_lossy().into_owned();
            let kind = path.extension().unwrap_or_default().to_ascii_lowercase();
            let read: fn(&[u8], usize) -> Result<Vec<Slice>, String> = match kind.to_str() {
                Some("png") => pixels::png,
                Some("tif" | "tiff") => pixels::tiff,
                _ => return Err(self.file.refused(file, "an image that ends in .png, .tif or .tiff")),
            };
            let bytes = read_file(&self.file, (&named, path), (context.files, LARGEST_FILE))?;
            let read = read(&bytes, left).map_err(|found| {
                self.file_fault(&named, found, "an image of greys or labels, each a whole number")
            })?;
            for slice in read {
                left = left.saturating_sub(slice.values.len());
                let first = slices.first().map_or(slice.size, |first: &Slice| first.size);
                if slice.size != first {
                    let [[width, height], [other, another]] = [slice.size, first];
                    let found = format!("a slice of {width} x {height} pixels");
                    return Err(self.file_fault(
                        &named,
                        found,
                        &format!("{other} x {another}, as the first slice"),
                    ));
                }
                slices.push(slice);
            }
        }
        let layers = slices.len();
        if context.dimension.is_plane() && layers != 1 {
            return Err(self.file_fault(file, format!("{layers} slices"), "one, as the scene is plane"));
        }
        if !context.dimension.is_plane() && layers < 2 {
            let help = "a * in the name stands for the numbers of slices: \"scan *.png\"".to_string();
            return Err(self
                .file_fault(file, "one slice", "a stack of them, as the scene is 3d")
                .help(Some(help)));
        }
        let [width, height] = slices[0].size;
        let mut values = Vec::with_capacity(width * height * layers);
        for x in 0..width {
            for y in (0..height).rev() {
                values.extend(slices.iter().map(|slice| slice.values[y * width + x]));
            }
        }
        Ok(Pixels { counts: [width, height, layers], values })
    }

    /// The file, or all that match its pattern.
    fn paths(&self, file: &str, context: &Context) -> Result<Vec<PathBuf>, Fault> {
        let path = context.folder.join(file);
        let pattern = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !pattern.contains('*') {
            return Ok(vec![path]);
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let unread = |why: String| {
            let help = format!("{}: {why}; a relative path starts at the scene's folder", folder.display());
            self.file.refused(file, "images that can be read").help(Some(help))
        };
        let wild = wildmatch::WildMatch::new(&pattern);
        let mut names = context.files.names(folder).map_err(|reason| unread(reason.to_string()))?;
        names.retain(|name| wild.matches(name));
        if names.is_empty() {
            return Err(unread("no file of such a name".to_string()));
        }
        names.sort_by(|a, b| pixels::counted(a, b));
        Ok(names.into_iter().map(|name| folder.join(name)).collect())
    }

    fn are_labels(&self, file: &str, image: &Pixels) -> Result<(), Fault> {
        let is_label = |value: f32| value >= 0.0 && value.fract() == 0.0 && value <= LARGEST_LABEL as f32;
        match image.values.iter().find(|&&value| !is_label(value)) {
            Some(value) => {
                let allowed = format!("labels: whole numbers from 0 to {LARGEST_LABEL}");
                let help = "greys need a threshold".to_string();
                Err(self.file_fault(file, format!("a pixel of {value}"), &allowed).help(Some(help)))
            }
            None => Ok(()),
        }
    }

    /// Refuses labels that no pixel has.
    fn all_are_there(
        &self,
        found: &[(u64, crate::geometry::ImagePart)],
        solids: &Solids,
        context: &Context,
    ) -> Result<(), Fault> {
        let Solids::Labels { wanted: Some(wanted), background } = solids else { return Ok(()) };
        let found: HashSet<u64> = found.iter().map(|(number, _)| *number).collect();
        for (count, &label) in self.labels.iter().flatten().zip(wanted) {
            if label == *background {
                return Err(count.refused(context, "another label than that of the background")?);
            }
            if !found.contains(&(label as u64)) {
                return Err(
                    count.refused(context, "a label that pixels of the image have, least_pixels at least")?
                );
            }
        }
        Ok(())
    }

    fn file_fault(&self, file: &str, found: impl std::fmt::Display, allowed: &str) -> Fault {
        let mut fault = self.file.refused(file, allowed);
        fault.problem.found = format!("in {file}: {found}");
        fault
    }
}

fn range(image: &Pixels) -> [f32; 2] {
    let values = || image.values.iter().copied();
    [values().fold(f32::INFINITY, f32::min), values().fold(f32::NEG_INFINITY, f32::max)]
}
