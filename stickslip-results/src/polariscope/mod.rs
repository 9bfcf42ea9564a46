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
mod stress_map;
#[cfg(test)]
mod tests;
mod window;

pub use chains::{Link, Push, draw_links, links};
pub use cloud::joined;
pub use color::linear_of_srgb;
pub use film::Film;
pub use optics::{LinearRgb, Optics, Phase};
pub use stress_map::{Ray, StressMap};
pub use window::ImageWindow;

use crate::door::ParticleSnapshot;
use crate::image::Image;
use crate::scene::{Polariscope, PolariscopeField};
use rayon::prelude::*;

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
        let [width, height] = self.stage.window.size;
        let layers: Vec<BodyLayer> =
            stress_maps(particles, &self.stage.window).into_iter().map(|map| self.layer(map)).collect();
        let mut light = vec![[0.0; 3]; width * height];
        light.par_chunks_mut(width).enumerate().for_each(|(row, light)| {
            for (column, light) in light.iter_mut().enumerate() {
                let (mut covered, mut sum) = (0.0, [0.0; 3]);
                for layer in &layers {
                    let Some(ray) = layer.map.ray(column, row).filter(|ray| ray.coverage > 0.0) else {
                        continue;
                    };
                    covered += ray.coverage;
                    let own = match &layer.orders {
                        Some(orders) => {
                            let mut phase = layer.map.phase(orders, column, row);
                            if self.optics.sees_directions() {
                                phase.angle = ray.principal_angle();
                            }
                            self.optics.light(&phase)
                        }
                        None => OPAQUE,
                    };
                    (0..3).for_each(|i| sum[i] += ray.coverage * own[i]);
                }
                let open = (1.0 - covered).max(0.0);
                *light = [0, 1, 2].map(|i| (sum[i] + open * self.background[i]) / covered.max(1.0));
            }
        });
        light
    }

    fn layer(&self, map: StressMap) -> BodyLayer {
        let birefringent = self.stage.specimens.contains(&map.body);
        let orders = birefringent.then(|| map.rays.iter().map(|ray| self.optics.order(ray)).collect());
        BodyLayer { map, orders }
    }
}

/// A body in the picture, with the fringe order of each ray if it is birefringent.
struct BodyLayer {
    map: StressMap,
    orders: Option<Vec<f64>>,
}

impl StressMap {
    /// Fringe order and its change across a pixel of the window that the body covers.
    fn phase(&self, orders: &[f64], column: usize, row: usize) -> Phase {
        let place = [column - self.corner[0], row - self.corner[1]];
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
    cloud::clouds(particles, stress_map::REACH, stress_map::LEAST_PIXELS / window.scale())
        .iter()
        .filter_map(|cloud| StressMap::new(cloud, window))
        .collect()
}

/// Lower and upper corner of a rectangle around some bodies, with a little room [m]; `None` if they have no particles.
pub fn bounds(particles: &ParticleSnapshot, specimens: &[usize]) -> Option<[[f64; 2]; 2]> {
    let clouds = cloud::clouds(particles, stress_map::REACH, 0.0);
    let chosen = clouds.iter().filter(|cloud| specimens.contains(&cloud.body)).map(|cloud| cloud.bounds);
    let bounds = chosen.reduce(joined);
    bounds.map(|[low, high]| {
        let room = MARGIN * (high[0] - low[0]).max(high[1] - low[1]).max(1e-9);
        [low.map(|x| x - room), high.map(|x| x + room)]
    })
}
