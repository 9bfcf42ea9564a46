//! A virtual polariscope: photoelastic fringes of the stress in a snapshot.
//!
//! Light runs along the third axis through birefringent bodies between two polarisers. [`stress_maps`] interpolates the
//! stress between particles on the pixels of an [`ImageWindow`], [`Optics`] turns it into fringe orders and light, and
//! [`Film`] sums up light while a shutter is open; [`OpticalBench`] holds them together:
//!
//! ```
//! # use stickslip_engine::door::ParticleSnapshot;
//! # use stickslip_results::image::Image;
//! # use stickslip_scene::scene::Polariscope;
//! use stickslip_results::polariscope::{ImageWindow, OpticalBench, Stage, bounds};
//!
//! fn picture(particles: &ParticleSnapshot, polariscope: &Polariscope) -> Option<Image> {
//!     let specimens = vec![0, 1]; // the other bodies are opaque
//!     let window = ImageWindow::around(bounds(particles, &specimens)?, 800);
//!     Some(OpticalBench::new(polariscope, Stage { window, specimens }).photograph(particles))
//! }
//! ```

mod chains;
mod cloud;
mod color;
mod film;
mod optics;
mod seen;
mod stress_map;
#[cfg(test)]
mod tests;
mod window;

pub use chains::{Link, Push, draw_links, links};
pub(crate) use chains::{Pair, links_to, meeting_place, pairs, places_near, pressing, wide_cloud};
pub(crate) use cloud::Outline;
pub use cloud::joined;
pub use color::linear_of_srgb;
pub use film::Film;
pub use optics::{LinearRgb, Optics, Phase};
pub(crate) use seen::{SeenBody, SeenParticle};
pub use stress_map::{Ray, StressMap};
pub use window::ImageWindow;

use crate::door::ParticleSnapshot;
use crate::image::Image;
use crate::scene::{Polariscope, PolariscopeField};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What stands between the polarisers.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// The part of the plane in the picture.
    pub window: ImageWindow,
    /// Indices of the birefringent bodies; the others are opaque.
    pub specimens: Vec<usize>,
}

/// A polariscope with its stage.
#[derive(Clone, Debug)]
pub struct OpticalBench {
    stage: Stage,
    optics: Optics,
    background: LinearRgb,
}

/// Light of opaque bodies.
const OPAQUE: LinearRgb = [0.23, 0.24, 0.26];
/// Light beside the bodies, told from theirs by a trace of colour: in a dark field and in a light field.
const BACKGROUND: [LinearRgb; 2] = [[0.030, 0.036, 0.052], [0.42, 0.45, 0.52]];
/// Room around the specimens in a picture of them, over their larger extent.
const MARGIN: f64 = 0.04;

impl OpticalBench {
    /// A polariscope with its stage.
    pub fn new(polariscope: &Polariscope, stage: Stage) -> Self {
        let background = BACKGROUND[usize::from(polariscope.field == PolariscopeField::Light)];
        OpticalBench { stage, optics: Optics::new(polariscope), background }
    }

    /// What is in the picture.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// Unexposed film of the right size.
    pub fn film(&self) -> Film {
        Film::new(self.stage.window.size)
    }

    /// Lets the light of a snapshot fall on the film.
    pub fn expose(&self, particles: &ParticleSnapshot, film: &mut Film) {
        film.expose(&self.light(particles));
    }

    /// A picture of one instant.
    pub fn photograph(&self, particles: &ParticleSnapshot) -> Image {
        let mut film = self.film();
        self.expose(particles, &mut film);
        film.develop()
    }

    /// Light on each pixel, rows from the top.
    pub fn light(&self, particles: &ParticleSnapshot) -> Vec<LinearRgb> {
        let mut picture = self.picture();
        SeenBody::each(particles, |_| true)
            .filter_map(|seen| self.light_of(&seen))
            .for_each(|light| picture.add(&light));
        self.developed(picture)
    }

    /// A picture without bodies.
    pub(crate) fn picture(&self) -> Picture {
        let [width, height] = self.stage.window.size;
        Picture { covered: vec![0.0; width * height], sum: vec![[0.0; 3]; width * height] }
    }

    /// Light on each pixel of a picture with all its bodies, rows from the top.
    pub(crate) fn developed(&self, picture: Picture) -> Vec<LinearRgb> {
        let mut light = picture.sum;
        for (light, covered) in light.iter_mut().zip(picture.covered) {
            let open = (1.0 - covered).max(0.0);
            *light = [0, 1, 2].map(|i| (light[i] + open * self.background[i]) / covered.max(1.0));
        }
        light
    }

    /// The light of a body; `None` if it is not in the picture.
    pub(crate) fn light_of(&self, seen: &SeenBody) -> Option<BodyLight> {
        let map = StressMap::new(seen, &self.stage.window)?;
        let birefringent = self.stage.specimens.contains(&map.body);
        let orders: Option<Vec<f64>> =
            birefringent.then(|| map.rays.iter().map(|ray| self.optics.order(ray)).collect());
        let light = |place: [usize; 2], ray: &Ray| match &orders {
            Some(orders) => {
                let mut phase = map.phase(orders, place);
                if self.optics.sees_directions() {
                    phase.angle = ray.principal_angle();
                }
                self.optics.light(&phase)
            }
            None => OPAQUE,
        };
        let rows = map.rays.par_chunks(map.size[0]).enumerate().map(|(row, rays)| {
            let first = (map.corner[1] + row) * self.stage.window.size[0] + map.corner[0];
            let rays = rays.iter().enumerate().filter(|(_, ray)| ray.coverage > 0.0);
            let pixel =
                |(column, ray): (usize, &Ray)| (first + column, ray.coverage, light([column, row], ray));
            rays.map(pixel).collect::<Vec<_>>()
        });
        Some(BodyLight(rows.flatten_iter().collect()))
    }
}

/// The pixels of a picture that a body covers, in their order: the share of each that it covers, and its light there.
#[derive(Serialize, Deserialize)]
pub(crate) struct BodyLight(Vec<(usize, f64, LinearRgb)>);

impl BodyLight {
    /// How many they are.
    pub(crate) fn pixels(&self) -> usize {
        self.0.len()
    }
}

/// The light of an instant, while bodies are added to it in their order.
pub(crate) struct Picture {
    /// How much of each pixel bodies cover, maybe several times.
    covered: Vec<f64>,
    sum: Vec<LinearRgb>,
}

impl Picture {
    /// Adds the next body.
    pub(crate) fn add(&mut self, body: &BodyLight) {
        for &(pixel, coverage, light) in &body.0 {
            self.covered[pixel] += coverage;
            (0..3).for_each(|i| self.sum[pixel][i] += coverage * light[i]);
        }
    }
}

impl StressMap {
    /// Fringe order and its change across a pixel that the body covers, by its column and row in the map.
    fn phase(&self, orders: &[f64], place: [usize; 2]) -> Phase {
        let at = |x: usize, y: usize| {
            let i = y * self.size[0] + x;
            (self.rays[i].coverage > 0.0).then(|| orders[i])
        };
        let order = orders[place[1] * self.size[0] + place[0]];
        let change = [0, 1].map(|axis| {
            let neighbour = |step: isize| {
                let mut place = place;
                place[axis] = place[axis].checked_add_signed(step).filter(|to| *to < self.size[axis])?;
                at(place[0], place[1])
            };
            match (neighbour(-1), neighbour(1)) {
                (Some(before), Some(after)) => 0.5 * (after - before),
                (Some(before), None) => order - before,
                (None, Some(after)) => after - order,
                (None, None) => 0.0,
            }
        });
        Phase { order, change, angle: 0.0 }
    }
}

/// The stress of every body that is in the window, on its pixels, in the order of the bodies.
pub fn stress_maps(particles: &ParticleSnapshot, window: &ImageWindow) -> Vec<StressMap> {
    SeenBody::each(particles, |_| true).filter_map(|seen| StressMap::new(&seen, window)).collect()
}

/// Lower and upper corner of a rectangle around some bodies, with a little room [m]; `None` if they have no particles.
pub fn bounds(particles: &ParticleSnapshot, specimens: &[usize]) -> Option<[[f64; 2]; 2]> {
    let chosen = SeenBody::each(particles, |body| specimens.contains(&body));
    framed(chosen.map(|seen| wide_cloud(&seen).outline))
}

/// The same around the outlines of bodies, in their order.
pub(crate) fn framed(outlines: impl Iterator<Item = Outline>) -> Option<[[f64; 2]; 2]> {
    let bounds = outlines.map(|outline| outline.bounds).reduce(joined);
    bounds.map(|[low, high]| {
        let room = MARGIN * (high[0] - low[0]).max(high[1] - low[1]).max(1e-9);
        [low.map(|x| x - room), high.map(|x| x + room)]
    })
}
