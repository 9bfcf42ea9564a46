//! Random packings: grains of a shape in a container, as dense as asked for, without overlap.
//!
//! Grains begin at random places, and go down the energy of their overlaps,
//!
//! ```text
//! E = 1/2 sum over contacts k d^2,   d = depth of the overlap
//! ```
//!
//! until none is left (O'Hern, Silbert, Liu and Nagel 2003, Phys. Rev. E 68, 011306). Below random close packing, 0.64
//! of balls and 0.84 of disks of about two sizes, they find room; above it they jam, and that is an error. On the way
//! each grain is a thousandth of its size larger than it is to be, so that nothing overlaps in the end, by no digit.
//!
//! Grains that are to settle then fall, down the same energy and that of their weight,
//!
//! ```text
//! E = 1/2 sum over contacts k d^2 - sum over grains w a . x,    w ~ volume, a = the direction of falling
//! ```
//! without friction, to rest: with less and less weight, until what they press into each other is less than what they
//! are larger, then three thousandths. Stiffness k and mass grow with the depth below the open surface.

pub mod array;
mod descent;
mod grain;
mod kept;
mod neighbours;
mod sizes;
mod walls;

pub(crate) use neighbours::near;
pub use sizes::Sizes;

use crate::geometry::{Bounds, Shape};
use crate::tensor::Matrix;
use descent::Descent;
use grain::{Grain, GrainShape};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// What is to be packed.
#[derive(Clone, Debug)]
pub struct Packing<'a> {
    /// What holds the grains.
    pub container: &'a Shape,
    /// A grain; where it is does not count.
    pub grain: &'a Shape,
    /// How its size varies.
    pub sizes: Sizes,
    /// How many.
    pub amount: Amount,
    /// Whether each is turned at random.
    pub turned: bool,
    /// Distance that surfaces keep at least [m].
    pub gap: f64,
    /// Unit vector along which the grains fall and come to rest; `None` where they stay wherever they are [-].
    pub settle: Option<[f64; 3]>,
    /// Another number, another packing.
    pub seed: u64,
    /// 2 or 3.
    pub dimension: usize,
    /// Along each axis the two ends of the container [m] at which it has no walls, as everything is there again beyond
    /// them.
    pub repeats: [Option<[f64; 2]>; 3],
}

/// How many grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// So many.
    Count(usize),
    /// As many as make up this part of the container's volume: to that end all are made larger or smaller, by at most
    /// half of the last one's share [-].
    Fraction(f64),
}

/// A grain in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Its size over that of the grain that was given [-].
    pub scale: f64,
    /// Where the middle of its box is [m].
    pub position: [f64; 3],
    /// The axis about which it is turned there, and the angle [rad].
    pub turn: ([f64; 3], f64),
}

impl Placement {
    /// The grain in its place.
    pub fn shape(&self, grain: &Shape, dimension: usize) -> Shape {
        let bounds = grain.bounds(dimension).unwrap_or(Bounds { min: [0.0; 3], max: [0.0; 3] });
        let shape = grain.copied(self.scale, bounds.middle(), self.position);
        match self.turn {
            (_, 0.0) => shape,
            (axis, angle) => shape.rotated(self.position, axis, angle),
        }
    }
}

/// Why there is no packing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoPacking {
    /// The grain has no bounds, or nothing is inside.
    Grain,
    /// The container has no bounds, or nothing is inside.
    Container,
    /// The container lies so far from the origin that places there have no digits left for a grain.
    Far,
    /// A period along this axis, shorter than two of the largest grains [m].
    Short {
        /// The axis.
        axis: usize,
        /// Two of the largest grains [m].
        least: f64,
    },
    /// More grains than [`MOST_GRAINS`].
    TooMany(f64),
    /// Their volume over that of the container, with half of the gap around each, is at least 1 [-].
    Overfull(f64),
    /// They jam: part of the container that was asked for, and about as much as has room [-].
    Jammed {
        /// Asked for.
        asked: f64,
        /// Has room.
        room: f64,
    },
    /// They do not come to rest: the largest force that is left on one, over its weight [-].
    Restless(f64),
}

/// Distance from the origin over the radius of the smallest grain.
const MOST_RADII: f64 = 1e8;

/// How far grains that are not balls keep apart on the way, at most, over their radius.
const APART: f64 = 0.2;

/// Grains of a packing.
pub const MOST_GRAINS: usize = 1_000_000;

impl Packing<'_> {
    /// A grain of each size in its place, the same for the same seed on every machine.
    ///
    /// # Errors
    /// See [`NoPacking`].
    pub fn place(&self) -> Result<Vec<Placement>, NoPacking> {
        let bounds = self.container.bounds(self.dimension).filter(|bounds| !bounds.is_empty());
        let bounds = bounds.ok_or(NoPacking::Container)?;
        let room = measure(self.container, self.dimension).ok_or(NoPacking::Container)?;
        let volume = measure(self.grain, self.dimension).ok_or(NoPacking::Grain)?;
        let shape = GrainShape::new(self.grain, self.dimension).ok_or(NoPacking::Grain)?;
        let far = bounds.corners().flatten().fold(0.0, |far: f64, x| far.max(x.abs()));
        if far > MOST_RADII * shape.radius * self.sizes.range()[0] {
            return Err(NoPacking::Far);
        }
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let scales = self.scales(room / volume, &mut random)?;
        let power = self.dimension as i32;
        let asked = scales.iter().map(|scale| scale.powi(power)).sum::<f64>() * volume / room;
        // Half of the gap belongs to each grain.
        let with_gap = |scale: &f64| (scale + 0.5 * self.gap / shape.radius).powi(power);
        let filled = scales.iter().map(with_gap).sum::<f64>() * volume / room;
        if !(asked < 1.0 && filled < 1.0 && asked.is_finite()) {
            return Err(NoPacking::Overfull(filled));
        }
        let largest = scales.iter().fold(0.0_f64, |largest, &scale| largest.max(scale)) * shape.radius;
        // Of two grains only the nearest images may touch.
        let least = 4.0 * (1.0 + APART) * largest + 2.0 * self.gap;
        let short = |axis: &usize| self.repeats[*axis].is_some_and(|[first, last]| last - first < least);
        if let Some(axis) = (0..self.dimension).find(short) {
            return Err(NoPacking::Short { axis, least });
        }
        let mut grains = Vec::with_capacity(scales.len());
        for scale in scales {
            let orientation =
                if self.turned { any_turn(self.dimension, &mut random) } else { Matrix::IDENTITY };
            let position = self.any_place(&bounds, &mut random).ok_or(NoPacking::Container)?;
            grains.push(Grain { scale, position, orientation });
        }
        let mut descent = Descent::new(self, &shape, grains, random);
        if !descent.separate(room) {
            return Err(NoPacking::Jammed { asked, room: asked * descent.shrunk().powi(power) });
        }
        if let Some(along) = self.settle {
            descent.settle(along)?;
        }
        let inside = |grain: &Grain| Grain { position: self.inside(grain.position), ..*grain };
        Ok(descent.grains.iter().map(|grain| inside(grain).placement()).collect())
    }

    /// The image of a place between the ends of the container.
    fn inside(&self, place: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| match self.repeats[k] {
            Some([first, last]) => first + (place[k] - first).rem_euclid(last - first),
            None => place[k],
        })
    }

    /// The image of a place that is nearest to another one.
    fn image_near(&self, place: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| match self.repeats[k] {
            Some([first, last]) => place[k] - (last - first) * ((place[k] - to[k]) / (last - first)).round(),
            None => place[k],
        })
    }

    /// Sizes of the grains; `ratio` of the volumes of container and grain.
    fn scales(&self, ratio: f64, random: &mut ChaCha8Rng) -> Result<Vec<f64>, NoPacking> {
        let power = self.dimension as i32;
        match self.amount {
            Amount::Count(count) if count > MOST_GRAINS => Err(NoPacking::TooMany(count as f64)),
            Amount::Count(count) => Ok((0..count).map(|_| self.sizes.draw(self.dimension, random)).collect()),
            Amount::Fraction(fraction) => {
                let (wanted, mut sum, mut scales) = (fraction * ratio, 0.0, Vec::new());
                while sum < wanted {
                    if scales.len() == MOST_GRAINS {
                        return Err(NoPacking::TooMany(wanted / sum * MOST_GRAINS as f64));
                    }
                    scales.push(self.sizes.draw(self.dimension, random));
                    sum += scales[scales.len() - 1].powi(power);
                }
                // With or without the last one, whichever is nearer.
                let last = scales.last().map_or(0.0, |scale| scale.powi(power));
                if scales.len() > 1 && sum - wanted > 0.5 * last {
                    scales.pop();
                    sum -= last;
                }
                let factor = libm::pow(wanted / sum, 1.0 / self.dimension as f64);
                Ok(scales.into_iter().map(|scale| scale * factor).collect())
            }
        }
    }

    /// A place in the container; none where a thousand points of its box lie outside.
    fn any_place(&self, bounds: &Bounds, random: &mut ChaCha8Rng) -> Option<[f64; 3]> {
        let size = bounds.size();
        let mut point = || {
            let mut part = |k: usize| bounds.min[k] + size[k] * random.random::<f64>();
            [part(0), part(1), if self.dimension == 3 { part(2) } else { 0.0 }]
        };
        (0..1000).map(|_| point()).find(|&point| self.container.contains(point, self.dimension))
    }
}

/// A rotation, each as likely as any other.
fn any_turn(dimension: usize, random: &mut ChaCha8Rng) -> Matrix<f64> {
    let mut normal = || random.sample::<f64, _>(StandardNormal);
    let mut q = [normal(), 0.0, 0.0, normal()];
    if dimension == 3 {
        (q[1], q[2]) = (normal(), normal());
    }
    let length = q.iter().map(|q| q * q).sum::<f64>().sqrt();
    turn_of(if length > 0.0 { q.map(|q| q / length) } else { [1.0, 0.0, 0.0, 0.0] })
}

/// The rotation of a unit quaternion.
fn turn_of([w, x, y, z]: [f64; 4]) -> Matrix<f64> {
    Matrix([
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ])
}

/// Volume of a shape with bounds [m^3], in the plane its area; of one without closed form by points of a lattice, to
/// about one part in a thousand. `None` where nothing is inside.
fn measure(shape: &Shape, dimension: usize) -> Option<f64> {
    /// Points along the longest side of the box.
    const POINTS: [f64; 2] = [1000.0, 128.0];
    let exact = shape.volume(dimension);
    let counted = || {
        let bounds = shape.bounds(dimension)?;
        let size = bounds.size();
        let spacing = size.iter().fold(0.0, |a: f64, &b| a.max(b)) / POINTS[dimension - 2];
        let count = |k: usize| if k < dimension { (size[k] / spacing).ceil().max(1.0) as usize } else { 1 };
        let step: [f64; 3] = std::array::from_fn(|k| size[k] / count(k) as f64);
        let middle = |k: usize, i: usize| bounds.min[k] + (i as f64 + 0.5) * step[k];
        let mut inside = 0_usize;
        for i in 0..count(0) {
            for j in 0..count(1) {
                let column = (0..count(2)).map(|l| [middle(0, i), middle(1, j), middle(2, l)]);
                inside += column.filter(|&point| shape.contains(point, dimension)).count();
            }
        }
        Some(inside as f64 * (0..dimension).map(|k| step[k]).product::<f64>())
    };
    exact.or_else(counted).filter(|volume| *volume > 0.0 && volume.is_finite())
}

#[cfg(test)]
mod tests;
