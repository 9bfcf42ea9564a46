//! Bodies of given particles, whose surfaces follow from these.

use super::ImagePart;
use super::lattice::Lattice;
use super::parts::{MARGIN, MOST, part_them, unstepped};
use crate::geometry::curved::{Curved, Solid};
use crate::geometry::distance::SignedDistance;
use crate::geometry::{Bounds, ParticleSite};
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// What given particles fill: the particles, and a smooth surface around them.
///
/// On a lattice of their mean spacing each particle fills what its cube, in the plane its square, covers; the surface
/// is at first where half is filled, and then smoothed as that of an image's part. It is known to half a spacing. A
/// copy shares what it is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct PointCloud {
    surface: ImagePart,
    points: Arc<CloudPoints>,
    /// Where the origin of the points lies [m].
    origin: [f64; 3],
    /// What a length of theirs is [m].
    unit: f64,
}

/// The particles of a cloud.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CloudPoints {
    /// Where they are, and how large [m].
    pub sites: Vec<ParticleSite>,
    /// Their velocities [m/s]; none, or one each.
    pub velocities: Vec<[f64; 3]>,
}

/// Why there are no surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoCloud {
    /// More clouds, or more room for their surfaces, than there may be.
    Spread {
        /// How many clouds.
        parts: usize,
        /// Points of the lattices around them.
        pixels: usize,
    },
    /// Cloud of this number: its volumes do not fill the space between its particles, at which the mean of what is
    /// filled is so much [-].
    Sparse(usize, f64),
    /// The same: its volumes fill space several times.
    Dense(usize, f64),
}

/// What is filled at the particles of a cloud, on average: less is sparse, more is dense.
const FILLED: [f64; 2] = [0.4, 1.5];

/// Part of its particles that may lie outside of the smooth surface: at the corners of a square of 6 x 6 a ninth.
const OUTSIDE: f64 = 0.12;

/// Points of the lattices around clouds: so many, and so many more for each particle.
const ROOM: [f64; 2] = [1e6, 200.0];

/// How far from the origin particles may be, in their spacing: beyond, places have no digits left for it.
const FARTHEST: f64 = 1e12;

/// Width of the Gaussian that smooths the surface [spacings].
const SMOOTH: f64 = 1.5;

/// The mean spacing of particles [m].
pub fn mean_spacing(clouds: &[CloudPoints], dimension: usize) -> f64 {
    let (count, volume) = clouds
        .iter()
        .flat_map(|cloud| &cloud.sites)
        .fold((0, 0.0), |(count, volume), site| (count + 1, volume + site.volume));
    let mean = volume / f64::from(count.max(1));
    if dimension == 2 { mean.sqrt() } else { libm::cbrt(mean) }
}

/// Clouds with their surfaces, which keep apart from each other; `name` stands for them in records.
///
/// # Errors
/// See [`NoCloud`].
pub fn point_clouds(
    clouds: Vec<CloudPoints>,
    dimension: usize,
    name: &str,
) -> Result<Vec<PointCloud>, NoCloud> {
    let spacing = mean_spacing(&clouds, dimension);
    let boxes: Vec<_> = clouds.iter().map(|cloud| extent(&cloud.sites, (spacing, dimension))).collect();
    let pixels =
        boxes.iter().map(|(_, counts)| counts.iter().map(|&n| n as f64).product::<f64>()).sum::<f64>();
    let particles = clouds.iter().map(|cloud| cloud.sites.len()).sum::<usize>();
    let room = (ROOM[0] + ROOM[1] * particles as f64).min(MOST.pixels as f64);
    let far = |site: &ParticleSite| site.position.iter().any(|x| x.abs() > FARTHEST * spacing);
    if clouds.len() > MOST.parts || pixels > room || clouds.iter().flat_map(|cloud| &cloud.sites).any(far) {
        return Err(NoCloud::Spread { parts: clouds.len(), pixels: pixels as usize });
    }
    let mut fields = Vec::with_capacity(clouds.len());
    for (number, (cloud, (lower, counts))) in clouds.iter().zip(boxes).enumerate() {
        let filled = filled(&cloud.sites, (lower, counts), (spacing, dimension));
        let at = |site: &ParticleSite| filled.values[pixel_of(site, (lower, &filled), (spacing, dimension))];
        let mean = cloud.sites.iter().map(|site| f64::from(at(site))).sum::<f64>() / cloud.sites.len() as f64;
        if !(FILLED[0]..=FILLED[1]).contains(&mean) {
            let of = if mean > FILLED[1] { NoCloud::Dense } else { NoCloud::Sparse };
            return Err(of(number, mean));
        }
        let empty = Lattice { counts, values: filled.values.iter().map(|filled| 0.5 - filled).collect() };
        fields.push((number as u32, lower, unstepped(empty, SMOOTH).spline()));
    }
    part_them(&mut fields);
    let cloud = |((number, lower, coefficients), points): ((u32, [i64; 3], Lattice), CloudPoints)| {
        let number = number as usize;
        let first =
            std::array::from_fn(|k| if k < dimension { spacing * (lower[k] as f64 + 0.5) } else { 0.0 });
        let held = coefficients.inside().ok_or(NoCloud::Sparse(number, 0.0))?;
        let surface = ImagePart::new(name, (coefficients, held), first, spacing);
        let beyond = |site: &&ParticleSite| surface.level(site.position, dimension).distance > 0.0;
        let outside = points.sites.iter().filter(beyond).count() as f64 / points.sites.len() as f64;
        if outside > OUTSIDE {
            return Err(NoCloud::Sparse(number, 1.0 - outside));
        }
        Ok(PointCloud { surface, points: Arc::new(points), origin: [0.0; 3], unit: 1.0 })
    };
    fields.into_iter().zip(clouds).map(cloud).collect()
}

/// First pixel and numbers of pixels of a lattice around particles.
fn extent(sites: &[ParticleSite], (spacing, dimension): (f64, usize)) -> ([i64; 3], [usize; 3]) {
    let range = |k: usize| {
        let ends = sites.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], site| {
            let [x, w] = [site.position[k], site.half_width];
            [low.min(x - w), high.max(x + w)]
        });
        ends.map(|x| (x / spacing).floor() as i64)
    };
    let margin = MARGIN as i64;
    let lower = |k: usize| if k < dimension { range(k)[0].saturating_sub(margin) } else { 0 };
    let count = |k: usize| {
        let [low, high] = range(k);
        if k < dimension {
            high.saturating_sub(low).saturating_add(1 + 2 * margin).max(1) as usize
        } else {
            1
        }
    };
    (std::array::from_fn(lower), std::array::from_fn(count))
}

/// Which part of each pixel particles fill, a little smoothed.
fn filled(
    sites: &[ParticleSite],
    (lower, counts): ([i64; 3], [usize; 3]),
    (spacing, dimension): (f64, usize),
) -> Lattice {
    let mut filled = Lattice::filled(counts, |_| 0.0);
    let strides = filled.strides();
    for site in sites {
        // Pixels that its cube meets along each axis, and by what length.
        let met = |k: usize| -> Vec<(usize, f64)> {
            if k >= dimension {
                return vec![(0, 1.0)];
            }
            let ends = [-1.0, 1.0]
                .map(|side| (site.position[k] + side * site.half_width) / spacing - lower[k] as f64);
            let pixels = ends[0].floor() as usize..=ends[1].floor() as usize;
            pixels.map(|i| (i, ends[1].min((i + 1) as f64) - ends[0].max(i as f64))).collect()
        };
        let [x, y, z] = [met(0), met(1), met(2)];
        for (i, along_x) in &x {
            for (j, along_y) in &y {
                for (k, along_z) in &z {
                    let pixel = i * strides[0] + j * strides[1] + k * strides[2];
                    filled.values[pixel] += (along_x * along_y * along_z) as f32;
                }
            }
        }
    }
    filled.convolved(&[0.25, 0.5, 0.25])
}

/// The pixel in which a particle is.
fn pixel_of(
    site: &ParticleSite,
    (lower, lattice): ([i64; 3], &Lattice),
    (spacing, dimension): (f64, usize),
) -> usize {
    let along =
        |k: usize| ((site.position[k] / spacing).floor() as i64 - lower[k]) as usize * lattice.strides()[k];
    (0..dimension).map(along).sum()
}

impl PointCloud {
    /// Its particles [m].
    pub fn sites(&self) -> impl Iterator<Item = ParticleSite> + '_ {
        let PointCloud { origin, unit, .. } = *self;
        self.points.sites.iter().map(move |site| ParticleSite {
            position: std::array::from_fn(|k| origin[k] + unit * site.position[k]),
            // In the plane the volume is an area.
            volume: site.volume * if self.surface.is_plane() { unit * unit } else { unit.powi(3) },
            half_width: unit * site.half_width,
        })
    }

    /// Velocities of its particles, if they have their own [m/s].
    pub fn velocities(&self) -> Option<&[[f64; 3]]> {
        Some(&self.points.velocities[..]).filter(|velocities| !velocities.is_empty())
    }
}

impl Solid for PointCloud {
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        self.surface.level(point, dimension)
    }

    fn bounds(&self, dimension: usize) -> Bounds {
        self.surface.bounds(dimension)
    }

    fn volume(&self, _: usize) -> Option<f64> {
        Some(self.sites().map(|site| site.volume).sum())
    }

    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved {
        let Curved::Image(surface) = self.surface.copied(factor, place) else {
            unreachable!("the copy of a part of an image is one")
        };
        let (origin, unit) = (place(self.origin), factor * self.unit);
        Curved::PointCloud(PointCloud { surface, points: self.points.clone(), origin, unit })
    }

    fn fault(&self, _: usize) -> Option<(&'static str, String, &'static str)> {
        None
    }
}

impl Serialize for PointCloud {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.surface.serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Arrangement, Shape, SiteLattice, fill};
    use crate::tensor::Vector;

    fn points_of(shape: &Shape, spacing: f64, dimension: usize) -> CloudPoints {
        let lattice = SiteLattice { origin: [0.3 * spacing; 3], spacing, dimension };
        let sites = fill(shape, &lattice, Arrangement::Lattice).expect("bounded").sites;
        CloudPoints { sites, velocities: Vec::new() }
    }

    /// The surface of a ball's particles is that of the ball to half a spacing, and mostly to a quarter.
    #[test]
    fn the_surface_is_known_to_half_a_spacing() {
        for dimension in [2, 3] {
            let (center, radius, spacing) = ([3.0, -2.0, if dimension == 3 { 1.0 } else { 0.0 }], 1.0, 0.1);
            let points = points_of(&Shape::ball(center, radius), spacing, dimension);
            let [cloud] = &point_clouds(vec![points.clone()], dimension, "a.csv").unwrap()[..] else {
                panic!("one cloud")
            };
            let bounds = cloud.bounds(dimension);
            let shape = Shape::from(Curved::PointCloud(cloud.clone()));
            let surface = shape.surface(spacing, dimension, &bounds);
            let off = surface.iter().map(|point| {
                let arm = Vector(std::array::from_fn(|k| point.position[k] - center[k]));
                ((arm.norm() - radius) / spacing, arm.dot(Vector(point.normal)) / arm.norm())
            });
            let (mut worst, mut sum, mut tilt) = (0.0_f64, 0.0, 1.0_f64);
            for (off, cosine) in off {
                (worst, sum, tilt) = (worst.max(off.abs()), sum + off * off, tilt.min(cosine));
            }
            let typical = (sum / surface.len() as f64).sqrt();
            println!(
                "{dimension} dimensions: {worst:.3} spacings at most, {typical:.3} typically, {tilt:.4}"
            );
            assert!(worst < 0.5 && typical < 0.25 && tilt > 0.97, "{worst} {typical} {tilt}");
            assert_eq!(cloud.sites().collect::<Vec<_>>(), points.sites);
            let large = cloud.copied(2.0, &|x| x.map(|x| 2.0 * x - 1.0));
            let Curved::PointCloud(large) = large else { panic!("a cloud") };
            let (one, other) = (large.sites().nth(7).unwrap(), points.sites[7]);
            assert_eq!(one.position[0], 2.0 * other.position[0] - 1.0);
            assert!((one.volume / other.volume - 2.0_f64.powi(dimension as i32)).abs() < 1e-12);
        }
    }

    #[test]
    fn clouds_that_touch_share_no_point() {
        let [left, right] = [[0.0, 0.0], [1.0, 0.0]]
            .map(|[x, y]| points_of(&Shape::rectangle([x, y], [x + 1.0, y + 1.0]), 0.05, 2));
        let clouds = point_clouds(vec![left, right], 2, "a.csv").unwrap();
        for i in 0..40_000 {
            let point = [0.01 * (i % 200) as f64 + 0.0003, 0.01 * (i / 200) as f64 - 0.4997, 0.0];
            let inside = clouds.iter().filter(|cloud| cloud.level(point, 2).distance < 0.0).count();
            assert!(inside < 2, "{point:?}");
        }
    }

    #[test]
    fn volumes_that_do_not_fit_the_places_are_told() {
        let points = points_of(&Shape::rectangle([0.0; 2], [1.0, 1.0]), 0.05, 2);
        let scaled = |factor: f64| {
            let site = |site: &ParticleSite| ParticleSite::of_volume(site.position, factor * site.volume, 2);
            CloudPoints { sites: points.sites.iter().map(site).collect(), velocities: Vec::new() }
        };
        assert!(matches!(point_clouds(vec![scaled(0.1)], 2, ""), Err(NoCloud::Sparse(0, _))));
        assert!(matches!(point_clouds(vec![scaled(8.0)], 2, ""), Err(NoCloud::Dense(0, _))));
        let mut far = points.clone();
        far.sites[0].position = [1e9, 1e9, 0.0];
        assert!(matches!(point_clouds(vec![far], 2, ""), Err(NoCloud::Spread { .. })));
    }
}
