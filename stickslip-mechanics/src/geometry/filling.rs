//! Filling a shape with particles.

use super::fitted::fit;
use super::form::{Form, HeldFaces, PER_SIDE};
use super::inside::NudgedPoint;
use super::{Bounds, Curved, Shape};
use serde::Serialize;

/// Ties nearer to a border than this share of the spacing are round-off.
const ROUND_OFF: f64 = 1e-7;

/// A regular lattice of particle sites: the centres of cubes (in the plane, squares) that tile space from `origin`.
///
/// With the spacing a whole fraction of a grid cell and the origin on a node,
/// every cell holds the same number of sites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteLattice {
    /// A corner of a cube [m].
    pub origin: [f64; 3],
    /// Side of a cube [m].
    pub spacing: f64,
    /// 2 or 3.
    pub dimension: usize,
}

/// How particles are laid out in a shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arrangement {
    /// On the lattice of space; curved surfaces become stairs.
    #[default]
    Lattice,
    /// In rings, shells or boxes that follow the shape's own surface; the volume is exact.
    Fitted,
    /// Parts of the cells of a grid over the shape, which these faces hold, see [`super::form`]; the volume is exact.
    Parts(HeldFaces),
}

/// Where a particle starts, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleSite {
    /// Centre [m]; in the plane z is zero.
    pub position: [f64; 3],
    /// Volume [m^3], in the plane area [m^2].
    pub volume: f64,
    /// Half the side of the cube, in the plane the square, of that volume [m].
    pub half_width: f64,
}

/// The particles of one shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Filling {
    /// In an order of space: on the lattice by x, then y, then z.
    pub sites: Vec<ParticleSite>,
}

impl ParticleSite {
    /// A site with the half-width of its volume.
    pub fn of_volume(position: [f64; 3], volume: f64, dimension: usize) -> Self {
        let side = if dimension == 2 { volume.sqrt() } else { libm::cbrt(volume) };
        ParticleSite { position, volume, half_width: 0.5 * side }
    }
}

impl Filling {
    /// Volume of all particles [m^3], in the plane area [m^2].
    pub fn volume(&self) -> f64 {
        self.sites.iter().map(|site| site.volume).sum()
    }

    /// Centre of volume [m].
    pub fn center(&self) -> [f64; 3] {
        let volume = self.volume();
        let add = |sum: [f64; 3], site: &ParticleSite| {
            std::array::from_fn(|k| sum[k] + site.position[k] * (site.volume / volume))
        };
        self.sites.iter().fold([0.0; 3], add)
    }
}

/// The least number of equal parts of a length, area or volume of which none is larger than `most`, but for round-off.
pub(super) fn parts(whole: f64, most: f64) -> usize {
    (whole / most - ROUND_OFF).ceil().max(1.0) as usize
}

impl SiteLattice {
    /// Number of sites in the lattice's cubes that meet a box: what filling anything within it costs.
    pub fn sites(&self, bounds: &Bounds) -> f64 {
        if bounds.is_empty() {
            return 0.0;
        }
        let size = bounds.size();
        (0..self.dimension).map(|k| (size[k] / self.spacing).ceil() + 1.0).product()
    }

    /// Volume of a cube [m^3], in the plane area of a square [m^2].
    pub fn volume(&self) -> f64 {
        self.spacing.powi(self.dimension as i32)
    }

    /// The sites inside a shape, one after the other [m]; `None` for a shape without bounds.
    pub fn sites_inside<'a>(&self, shape: &'a Shape) -> Option<impl Iterator<Item = [f64; 3]> + use<'a>> {
        let (bounds, lattice) = (shape.bounds(self.dimension)?, *self);
        Some(self.sites_around(&bounds).filter(move |&site| lattice.contains_site(shape, site)))
    }

    /// Whether a site is inside a shape; on the border but for round-off it is where [`Shape::contains`] says.
    pub fn contains_site(&self, shape: &Shape, site: [f64; 3]) -> bool {
        shape.contains_point(NudgedPoint::new(site, ROUND_OFF * self.spacing, self.dimension))
    }

    /// Every site in a box and up to one spacing around it, ordered by x, then y, then z [m].
    pub fn sites_around(&self, bounds: &Bounds) -> impl Iterator<Item = [f64; 3]> + use<> {
        let SiteLattice { origin, spacing, dimension } = *self;
        let range = |k: usize| match (bounds.is_empty(), k < dimension) {
            (true, _) => 0..0,
            (false, false) => 0..1,
            (false, true) => {
                let index = |x: f64| ((x - origin[k]) / spacing).floor() as i64;
                index(bounds.min[k]) - 1..index(bounds.max[k]) + 2
            }
        };
        // From whole numbers each time, so that no sum of round-off grows along a row.
        let site = move |k: usize, i: i64| {
            if k < dimension { origin[k] + (i as f64 + 0.5) * spacing } else { 0.0 }
        };
        let [across_x, across_y, across_z] = [range(0), range(1), range(2)];
        across_x.flat_map(move |i| {
            let across_z = across_z.clone();
            across_y
                .clone()
                .flat_map(move |j| across_z.clone().map(move |k| [site(0, i), site(1, j), site(2, k)]))
        })
    }
}

/// The particles of a shape; `None` for a shape without bounds, and for one that cannot be fitted. A cloud has its own.
///
/// On the lattice every site inside is a particle. Each stands for a cube of the lattice, so the volume of all
/// particles differs from the shape's by the stairs along its surface, and agrees with it exactly for a box on the
/// lattice. A site on the border but for round-off counts as [`Shape::contains`] says of a point exactly on it.
///
/// Parts of cells have the volume and the centroid of what of them lies inside; their volumes add up to the shape's.
///
/// Fitted particles are at most the lattice's spacing apart, and their volumes add up to the shape's.
pub fn fill(shape: &Shape, lattice: &SiteLattice, arrangement: Arrangement) -> Option<Filling> {
    Some(Filling { sites: sites(shape, lattice, arrangement)?.collect() })
}

/// The particles that [`fill`] gives a shape, one after the other.
pub fn sites<'a>(
    shape: &'a Shape,
    lattice: &SiteLattice,
    arrangement: Arrangement,
) -> Option<Box<dyn Iterator<Item = ParticleSite> + 'a>> {
    if let Shape::Curved(Curved::PointCloud(cloud)) = shape {
        return Some(Box::new(cloud.sites()));
    }
    Some(match arrangement {
        Arrangement::Lattice => {
            let (volume, half_width) = (lattice.volume(), 0.5 * lattice.spacing);
            Box::new(lattice.sites_inside(shape)?.map(move |position| ParticleSite {
                position,
                volume,
                half_width,
            }))
        }
        Arrangement::Fitted => Box::new(fit(shape, lattice.spacing, lattice.dimension)?.into_iter()),
        Arrangement::Parts(faces) => {
            let cell = PER_SIDE as f64 * lattice.spacing;
            let parts = match lattice.dimension {
                2 => Form::<2>::new(shape, cell, faces).ok()?.parts(),
                _ => Form::<3>::new(shape, cell, faces).ok()?.parts(),
            };
            let dimension = lattice.dimension;
            let site = move |(place, volume)| ParticleSite::of_volume(place, volume, dimension);
            Box::new(parts.into_iter().map(site))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::inside::tests::any_shape;
    use proptest::prelude::*;
    use std::boxed::Box;

    const UNIT: SiteLattice = SiteLattice { origin: [0.0; 3], spacing: 1.0, dimension: 3 };

    fn on_lattice(shape: &Shape, lattice: &SiteLattice) -> Option<Filling> {
        fill(shape, lattice, Arrangement::Lattice)
    }

    fn count(shape: &Shape, lattice: &SiteLattice) -> usize {
        on_lattice(shape, lattice).expect("bounded").sites.len()
    }

    proptest! {
        #[test]
        fn a_box_on_the_lattice_holds_exactly_its_cubes(
            corner in prop::array::uniform3(-100_000i32..100_000),
            size in prop::array::uniform3(1usize..9),
            magnitude in -9..9i32,
            origin in prop::array::uniform3(-1.0..1.0f64),
            dimension in 2..=3usize,
        ) {
            // 1/3 has no finite binary expansion: every face is off by round-off.
            let spacing = 10f64.powi(magnitude) / 3.0;
            let origin = origin.map(|x| x * 1e4 * spacing);
            let lattice = SiteLattice { origin, spacing, dimension };
            let min = std::array::from_fn(|k| origin[k] + f64::from(corner[k]) * spacing);
            let max = std::array::from_fn(|k| min[k] + size[k] as f64 * spacing);
            let expected = size[..dimension].iter().product::<usize>();
            prop_assert_eq!(count(&Shape::Box { min, max }, &lattice), expected);
            // Faces through the sites: lower layers in, upper layers out.
            let half = 0.5 * spacing;
            let shifted = Shape::Box { min: min.map(|x| x + half), max: max.map(|x| x + half) };
            prop_assert_eq!(count(&shifted, &lattice), expected);
            // A quarter turn about the box's centre swaps two sides.
            let center = std::array::from_fn(|k| 0.5 * (min[k] + max[k]));
            let angle = std::f64::consts::PI;
            let shape = Box::new(Shape::Box { min, max });
            let turned = Shape::Rotated { shape, center, axis: [0.0, 0.0, 1.0], angle };
            prop_assert_eq!(count(&turned, &lattice), expected);
        }

        #[test]
        fn all_particles_are_inside_and_all_sites_inside_are_particles(
            a in any_shape(),
            b in any_shape(),
            dimension in 2..=3usize,
        ) {
            let lattice = SiteLattice { origin: [0.03, -0.07, 0.11], spacing: 0.3, dimension };
            for shape in [a.clone(), Shape::Difference(vec![a, b])] {
                let Some(filling) = on_lattice(&shape, &lattice) else { continue };
                let everywhere = crate::geometry::Bounds { min: [-6.0; 3], max: [6.0; 3] };
                let expected: Vec<_> =
                    lattice.sites_around(&everywhere).filter(|&site| shape.contains(site, dimension)).collect();
                let positions: Vec<_> = filling.sites.iter().map(|site| site.position).collect();
                prop_assert_eq!(positions, expected);
            }
        }

        #[test]
        fn a_shape_and_what_it_is_cut_from_share_no_particle(
            whole in any_shape(),
            cutter in any_shape(),
        ) {
            let lattice = SiteLattice { origin: [0.0; 3], spacing: 0.25, dimension: 3 };
            let pair = vec![whole.clone(), cutter];
            let Some(all) = on_lattice(&whole, &lattice) else { return Ok(()) };
            let parts = count(&Shape::Difference(pair.clone()), &lattice) + count(&Shape::Intersection(pair), &lattice);
            prop_assert_eq!(parts, all.sites.len());
        }
    }

    #[test]
    fn volumes_converge_to_the_exact_ones() {
        let ball = Shape::Ball { center: [0.13, 0.21, 0.08], radius: 1.0 };
        let can = Shape::Cylinder { start: [0.0; 3], end: [0.7, 1.1, 0.9], radius: 0.6 };
        let points = vec![[0.0, 0.0], [2.0, 0.3], [1.2, 1.9], [0.9, 0.8]];
        let prism = Shape::Polygon { points: points.into(), height: [0.0, 0.7] };
        for shape in [ball, can, prism] {
            let shape = Shape::Rotated {
                shape: Box::new(shape),
                center: [0.0; 3],
                axis: [1.0, 2.0, 0.5],
                angle: 0.4,
            };
            let exact = shape.volume(3).expect("closed form");
            for (spacing, tolerance) in [(0.1, 0.02), (0.05, 0.01), (0.025, 0.005)] {
                let filling = on_lattice(&shape, &SiteLattice { spacing, ..UNIT }).expect("bounded");
                let error = filling.volume() / exact - 1.0;
                assert!(error.abs() < tolerance, "{shape:?} at {spacing}: {error}");
            }
        }
    }

    #[test]
    fn a_ball_with_sites_on_its_surface_stays_symmetric() {
        // 5^2 = 3^2 + 4^2: 30 sites lie on the surface, wherever round-off puts them.
        let spacing = 0.1 / 3.0;
        let center = [0.5 * spacing; 3];
        let ball = Shape::Ball { center, radius: 5.0 * spacing };
        let filling = on_lattice(&ball, &SiteLattice { spacing, ..UNIT }).expect("bounded");
        let sum = filling
            .sites
            .iter()
            .fold([0.0; 3], |s, site| std::array::from_fn(|k| s[k] + site.position[k] - center[k]));
        assert!(sum.iter().all(|s| s.abs() < 1e-12), "{sum:?}");
        // And what is left around it takes exactly the other sites.
        let around = Shape::Box { min: [-6.0 * spacing; 3], max: [7.0 * spacing; 3] };
        let left = count(&Shape::Difference(vec![around, ball]), &SiteLattice { spacing, ..UNIT });
        assert_eq!(left + filling.sites.len(), 13 * 13 * 13);
    }

    #[test]
    fn shapes_that_share_a_slanted_face_through_sites_share_no_particle() {
        let square = || Shape::Box { min: [0.0; 3], max: [12.0, 12.0, 0.0] };
        let side = |normal| Shape::HalfSpace { point: [6.0, 6.0, 0.0], normal };
        let lattice = SiteLattice { spacing: 1.2, dimension: 2, ..UNIT };
        for normal in [[1.0, -1.0, 0.0], [1.0, 1.0, 0.0]] {
            let halves = [normal, normal.map(|n| -n)]
                .map(|n| count(&Shape::Intersection(vec![square(), side(n)]), &lattice));
            assert_eq!(halves[0] + halves[1], 100, "{halves:?}");
        }
    }

    #[test]
    fn a_half_space_cannot_be_filled() {
        assert_eq!(on_lattice(&Shape::HalfSpace { point: [0.0; 3], normal: [1.0, 0.0, 0.0] }, &UNIT), None);
    }
}
