//! Plane scenes: every particle is drawn as the parallelogram that its square has become, and what lies between
//! particles of one body as the nearest of them. Bodies whose shapes are known end where these do.

use super::band::{BAND, Band};
use super::between::triangles;
use super::carried::{CarriedShape, Workspace};
use super::grains::Grain;
use super::outlines::PosedShape;
use crate::drawing::{Rgb, SAMPLES, shaded};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// A window on the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneView {
    /// Lower left corner [m].
    pub low: [f64; 2],
    /// Upper right corner [m].
    pub high: [f64; 2],
    /// Width and height in pixels.
    pub size: [usize; 2],
}

/// What is known of bodies beside their particles.
#[derive(Default)]
pub struct KnownShapes<'a> {
    /// Shapes of rigid bodies, which are drawn by these, above all others.
    pub posed: Vec<PosedShape<'a>>,
    /// Shapes of bodies on grids of their own, above what is left.
    pub carried: Vec<CarriedShape<'a>>,
    /// Bodies that are not drawn.
    pub hidden: HashSet<u32>,
}

/// No grain.
pub const NOTHING: u32 = u32::MAX;
/// Particles are drawn this much larger, so that rounding leaves no cracks between them.
const OVERLAP: f64 = 1.03;
/// Between particles that are smaller, no hole is wider than the cracks that are closed anyway [pixels].
const SMALL: f64 = 4.0;

impl PlaneView {
    /// Pixel of a position, from the left and from the top.
    pub fn pixel(&self, x: [f64; 2]) -> [f64; 2] {
        let scale = self.scale();
        [(x[0] - self.low[0]) * scale, (self.high[1] - x[1]) * scale]
    }

    /// Position of a pixel.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.low[0] + x / self.scale(), self.high[1] - y / self.scale()]
    }

    /// Pixels per metre.
    pub fn scale(&self) -> f64 {
        self.size[0] as f64 / (self.high[0] - self.low[0])
    }

    /// Whether a grain, or what lies between it and its neighbours, may be in the window.
    fn sees(&self, grain: &Grain) -> bool {
        let f = &grain.deformation;
        (0..2).all(|axis| {
            let reach = 2.0 * grain.side * (f[3 * axis].abs() + f[3 * axis + 1].abs());
            (self.low[axis] - reach..=self.high[axis] + reach).contains(&grain.position[axis])
        })
    }

    /// The same window with so many pixels more on every side.
    fn widened(&self, margin: usize) -> PlaneView {
        let more = margin as f64 / self.scale();
        PlaneView {
            low: self.low.map(|x| x - more),
            high: self.high.map(|x| x + more),
            size: self.size.map(|count| count + 2 * margin),
        }
    }
}

/// The grains in a window.
pub struct DrawnGrains<'a> {
    grains: &'a [Grain],
    size: [usize; 2],
    /// Index of the grain at each pixel.
    grain: Vec<u32>,
}

impl<'a> DrawnGrains<'a> {
    /// Draws the grains; where they overlap, the later one shows.
    pub fn new(grains: &'a [Grain], window: &PlaneView, known: &KnownShapes) -> Self {
        let KnownShapes { posed, carried, hidden } = known;
        let by_shape: HashSet<u32> = posed.iter().map(|shape| shape.body).collect();
        let carried_bodies = carried.iter().map(|shape| shape.body);
        let others: HashSet<u32> = by_shape.iter().copied().chain(carried_bodies).collect();
        let is_other = |body: u32| others.contains(&body) || hidden.contains(&body);
        // Across a crack at the edge of the image lies what is outside it.
        let mut drawn = Self::of_particles(grains, &window.widened(SAMPLES), |body| !is_other(body));
        drawn.add_carried(carried, &window.widened(SAMPLES));
        drawn.close();
        drawn.narrow(SAMPLES);
        if !posed.is_empty() {
            let inside = Self::of_particles(grains, window, |body| by_shape.contains(&body));
            drawn.add_posed(posed, &inside, window);
        }
        drawn
    }

    /// The grains of those bodies that are meant, and what lies between them.
    fn of_particles(grains: &'a [Grain], window: &PlaneView, is_meant: impl Fn(u32) -> bool) -> Self {
        let [width, height] = window.size;
        let is_seen = |&i: &u32| {
            let grain = &grains[i as usize];
            is_meant(grain.body) && window.sees(grain)
        };
        let seen: Vec<u32> = (0..grains.len() as u32).filter(is_seen).collect();
        let large = seen.iter().filter(|&&i| grains[i as usize].side * window.scale() > SMALL);
        let between = triangles(grains, &large.copied().collect::<Vec<_>>());
        let mut grain = vec![NOTHING; width * height];
        grain.par_chunks_mut(BAND * width).enumerate().for_each(|(number, pixels)| {
            let band = Band::new(number, window);
            for &i in &seen {
                let grain = &grains[i as usize];
                band.visit(grain, 0.5 * OVERLAP * grain.side, |pixel, _| pixels[pixel] = i);
            }
            between.iter().for_each(|three| band.join(grains, *three, pixels));
        });
        DrawnGrains { grains, size: window.size, grain }
    }

    /// Puts the shapes of bodies on grids of their own above what there is.
    fn add_carried(&mut self, shapes: &[CarriedShape], window: &PlaneView) {
        if shapes.is_empty() {
            return;
        }
        let (grains, width) = (self.grains, window.size[0]);
        self.grain.par_chunks_mut(BAND * width).enumerate().for_each(|(number, pixels)| {
            let (band, mut work) = (Band::new(number, window), Workspace::new(pixels.len()));
            shapes.iter().for_each(|shape| shape.draw(grains, &band, pixels, &mut work));
        });
    }

    /// Takes so many pixels away on every side.
    fn narrow(&mut self, margin: usize) {
        let [width, height] = self.size.map(|count| count - 2 * margin);
        let rows = self.grain.chunks_exact(self.size[0]).skip(margin).take(height);
        self.grain = rows.flat_map(|row| &row[margin..margin + width]).copied().collect();
        self.size = [width, height];
    }

    /// Puts shapes above all; what is in them looks like the nearest grain of their bodies.
    fn add_posed(&mut self, shapes: &[PosedShape], inside: &DrawnGrains, window: &PlaneView) {
        let [width, height] = self.size;
        let first: HashMap<u32, usize> =
            inside.grains.iter().enumerate().rev().map(|(i, grain)| (grain.body, i)).collect();
        for shape in shapes {
            let [low, high] = shape.reach();
            let ([left, top], [right, bottom]) =
                (window.pixel([low[0], high[1]]), window.pixel([high[0], low[1]]));
            let range = |low: f64, high: f64, end: usize| {
                (low.floor().max(0.0) as usize).min(end)..(high.ceil().max(0.0) as usize).min(end)
            };
            let columns = range(left, right, width);
            let index = |x: usize, y: usize| {
                if !shape.holds(window.place([x as f64 + 0.5, y as f64 + 0.5])) {
                    return None;
                }
                inside.nearest([x, y], shape.body).or_else(|| first.get(&shape.body).copied())
            };
            let rows: Vec<usize> = range(top, bottom, height).collect();
            let found: Vec<(usize, usize)> = rows
                .into_par_iter()
                .flat_map_iter(|y| columns.clone().filter_map(move |x| Some((y * width + x, index(x, y)?))))
                .collect();
            found.into_iter().for_each(|(place, index)| self.grain[place] = index as u32);
        }
    }

    /// The grain of a body at a pixel, or in the nearest of some pixels around it.
    fn nearest(&self, [x, y]: [usize; 2], body: u32) -> Option<usize> {
        const FARTHEST: i64 = 12;
        let of_body = |x: i64, y: i64| {
            let (index, grain) = self.grain(usize::try_from(x).ok()?, usize::try_from(y).ok()?)?;
            (grain.body == body).then_some(index)
        };
        let (x, y) = (x as i64, y as i64);
        of_body(x, y).or_else(|| {
            let ways = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)];
            (1..=FARTHEST).find_map(|k| ways.iter().find_map(|(dx, dy)| of_body(x + k * dx, y + k * dy)))
        })
    }

    /// Fills cracks between grains of one body, a pixel of the file wide at most, which are no edges of it.
    fn close(&mut self) {
        let [width, height] = self.size;
        let body = |x: i64, y: i64| {
            let place = [x, y].map(usize::try_from);
            let [Ok(x), Ok(y)] = place else { return None };
            self.grain(x, y).map(|(index, grain)| (index as u32, grain.body))
        };
        let filled = |place: usize| {
            if self.grain[place] != NOTHING {
                return None;
            }
            let (x, y) = ((place % width) as i64, (place / width) as i64);
            let first = |dx: i64, dy: i64| (1..=SAMPLES as i64).find_map(|k| body(x + k * dx, y + k * dy));
            [(1, 0), (0, 1), (1, 1), (1, -1)].iter().find_map(|&(dx, dy)| {
                let (index, one) = first(dx, dy)?;
                (first(-dx, -dy)?.1 == one).then_some((place, index))
            })
        };
        let filled: Vec<(usize, u32)> = (0..width * height).into_par_iter().filter_map(filled).collect();
        filled.into_iter().for_each(|(place, index)| self.grain[place] = index);
    }

    /// The colour of a pixel, which `color` says of a grain; `None` where there is nothing.
    pub fn color(&self, x: usize, y: usize, color: impl Fn(&Grain) -> Rgb) -> Option<Rgb> {
        let (_, grain) = self.grain(x, y)?;
        let reach = SAMPLES as i64;
        let rim = [(-reach, 0), (reach, 0), (0, -reach), (0, reach)].iter().any(|(dx, dy)| {
            let place = [x as i64 + dx, y as i64 + dy].map(usize::try_from);
            let [Ok(x), Ok(y)] = place else { return true };
            self.grain(x, y).is_none_or(|(_, neighbour)| neighbour.body != grain.body)
        });
        let color = color(grain);
        Some(if rim { shaded(color, 0.45) } else { color })
    }

    /// How many grains are particles rather than mirror images, which come last.
    pub fn count(&self, mirrored: bool) -> usize {
        if mirrored { self.grains.len() / 2 } else { self.grains.len() }
    }

    /// The grain at a pixel, with its index.
    pub fn grain(&self, x: usize, y: usize) -> Option<(usize, &Grain)> {
        let [width, height] = self.size;
        let index = *self.grain.get(y * width + x).filter(|_| x < width && y < height)? as usize;
        Some((index, self.grains.get(index)?))
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn a_sheared_square_is_drawn_as_a_parallelogram() {
        let grain = Grain {
            body: 0,
            position: [0.0; 3],
            side: 1.0,
            deformation: [1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            color: [0.5; 3],
        };
        let grains = [grain];
        let window = PlaneView { low: [-2.0, -2.0], high: [2.0, 2.0], size: [80, 80] };
        let drawn = DrawnGrains::new(&grains, &window, &KnownShapes::default());
        let hit = |x: f64, y: f64| {
            let [column, row] = window.pixel([x, y]);
            drawn.grain(column as usize, row as usize).is_some()
        };
        assert!(hit(0.8, 0.45) && hit(-0.8, -0.45));
        assert!(!hit(-0.3, 0.45) && !hit(0.3, -0.45));
    }

    #[test]
    fn a_crack_is_closed_and_a_gap_is_not() {
        let grain = |body: u32, x: f64| Grain {
            body,
            position: [x, 0.0, 0.0],
            side: 1.0,
            deformation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            color: [0.5; 3],
        };
        // A pixel is 0.05 m.
        let window = PlaneView { low: [-2.0, -2.0], high: [2.0, 2.0], size: [80, 80] };
        for (body, apart, closed) in [(0, 1.1, true), (0, 1.4, false), (1, 1.1, false)] {
            let grains = [grain(0, -0.5 * apart), grain(body, 0.5 * apart)];
            let drawn = DrawnGrains::new(&grains, &window, &KnownShapes::default());
            assert_eq!(drawn.grain(40, 40).is_some(), closed, "{body} {apart}");
        }
    }

    /// A disk of squares in rows along the diagonals: holes of 0.41 of their side, which are filled. A crack as wide,
    /// along an axis or not, stays.
    #[test]
    fn holes_between_particles_of_a_body_are_filled_and_cracks_are_not() {
        let turned = |angle: f64, skip: bool| -> Vec<Grain> {
            let (sin, cos) = angle.sin_cos();
            let grain = |i: i32, j: i32| {
                // The upper half stands off.
                let [x, y] = [f64::from(i), f64::from(j) + if skip && j > 0 { 0.45 } else { 0.0 }];
                let position = [cos * x - sin * y, sin * x + cos * y, 0.0];
                let deformation = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
                // Those of a crack are turned with the lattice, so that it is all that is open.
                let turned = [cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0];
                let deformation = if skip { turned } else { deformation };
                Grain { body: 0, position, side: 1.0, deformation, color: [0.5; 3] }
            };
            (-8..=8).flat_map(|i| (-8..=8).map(move |j| grain(i, j))).collect()
        };
        // A pixel is 0.05 m.
        let window = PlaneView { low: [-4.0, -4.0], high: [4.0, 4.0], size: [160, 160] };
        let empty = |grains: &[Grain]| {
            let drawn = DrawnGrains::new(grains, &window, &KnownShapes::default());
            drawn.grain.iter().filter(|index| **index == NOTHING).count()
        };
        for degrees in [0.0, 10.0, 22.5, 30.0, 45.0_f64] {
            assert_eq!(empty(&turned(degrees.to_radians(), false)), 0, "{degrees}");
            // 8 m long at least, and 0.42 m wide: 1344 pixels.
            let crack = empty(&turned(degrees.to_radians(), true));
            assert!(crack > 900, "{degrees}: {crack}");
        }
    }

    /// A fitted disk of 1 m, of squares of up to 50 mm, whole and deformed: a place in it is drawn. Another disk a
    /// twentieth of a square beside it stays beside it.
    #[test]
    fn a_fitted_disk_has_no_holes_and_keeps_off_its_neighbour() {
        let disk = |name: &str, x: f64| {
            format!(
                "[[bodies]]\nname = '{name}'\nmaterial = 'rubber'\nparticles = 'fitted'\n\
                 shape.ball = {{ center = [{x}, 0], radius = 1 }}\n"
            )
        };
        let (_, first) = sample::rubber("interior = 'grid'", &(disk("a", 0.0) + &disk("b", 2.0025)));
        for f in [[1.0, 0.0, 0.0, 1.0], [1.8, 0.0, 0.0, 0.7], [1.0, 0.8, 0.0, 1.0], [0.8, -0.6, 0.6, 0.8]] {
            let grains = sample::colored(&sample::deformed(&first, f));
            // The corners of the box around the first disk.
            let half = [f[0].hypot(f[1]) + 0.05, f[2].hypot(f[3]) + 0.05];
            // From small squares, between which cracks are closed, to large ones.
            for scale in [60.0, 150.0, 700.0] {
                let size = half.map(|half| (2.0 * half * scale) as usize);
                let low = size.map(|count| -0.5 * count as f64 / scale);
                let window = PlaneView { low, high: low.map(|x| -x), size };
                let drawn = DrawnGrains::new(&grains, &window, &KnownShapes::default());
                let det = f[0] * f[3] - f[1] * f[2];
                for [x, y] in (0..size[0] * size[1]).map(|pixel| [pixel % size[0], pixel / size[0]]) {
                    let place = window.place([x as f64 + 0.5, y as f64 + 0.5]);
                    let start = [f[3] * place[0] - f[1] * place[1], f[0] * place[1] - f[2] * place[0]];
                    let radius = start[0].hypot(start[1]) / det;
                    let body = drawn.grain(x, y).map(|(_, grain)| grain.body);
                    // Corners of squares stand out by less than 0.03 m, and edges stand back by as much.
                    assert!(radius > 0.96 || body == Some(0), "{f:?} {scale} {place:?}: {body:?}");
                    assert!(radius < 1.04 || body != Some(0), "{f:?} {scale} {place:?}");
                }
            }
        }
        // Between the disks, where they are nearest.
        let grains = sample::colored(&first);
        let window = PlaneView { low: [0.9, -0.1], high: [1.1, 0.1], size: [2000, 2000] };
        let drawn = DrawnGrains::new(&grains, &window, &KnownShapes::default());
        let column = |x: f64| window.pixel([x, 0.0])[0] as usize;
        let between = (column(1.0)..column(1.0025)).filter(|x| drawn.grain(*x, 1000).is_none());
        assert!(between.count() > 0, "the gap is 25 pixels wide, less what squares are drawn larger");
    }
}
