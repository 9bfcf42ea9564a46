//! Plane scenes: every particle is drawn as the parallelogram that its square has become, and rigid bodies by their own
//! shapes where these are known.

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

const NOTHING: u32 = u32::MAX;
/// Rows of the image that one thread draws at a time.
const BAND: usize = 48;
/// Particles are drawn this much larger, so that rounding leaves no cracks between them.
const OVERLAP: f64 = 1.03;
/// Half the width of holes between particles that do not stand in rows along the axes, as part of their side: at most
/// 0.21 where they stand in rows along a diagonal.
const HOLE: f64 = 0.5;
/// The most that is looked at for one [pixels].
const FARTHEST: f64 = 100.0;
/// A turn in sixteen parts, as steps along either axis.
const WAYS: [[f64; 2]; 16] = {
    // Cosines of one, two and three of these parts.
    const C: [f64; 3] = [0.923_879_532_511_286_7, std::f64::consts::FRAC_1_SQRT_2, 0.382_683_432_365_089_8];
    [
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, 1.0],
        [0.0, -1.0],
        [C[1], C[1]],
        [-C[1], -C[1]],
        [C[1], -C[1]],
        [-C[1], C[1]],
        [C[0], C[2]],
        [-C[0], -C[2]],
        [C[0], -C[2]],
        [-C[0], C[2]],
        [C[2], C[0]],
        [-C[2], -C[0]],
        [C[2], -C[0]],
        [-C[2], C[0]],
    ]
};

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
    /// Draws the grains; where they overlap, the later one shows. Bodies whose shapes are given are drawn by these,
    /// above all others.
    pub fn new(grains: &'a [Grain], window: &PlaneView, shapes: &[PosedShape]) -> Self {
        let by_shape: HashSet<u32> = shapes.iter().map(|shape| shape.body).collect();
        let draw_all = |window: &PlaneView, is_meant: &(dyn Fn(&Grain) -> bool + Sync)| {
            let [width, height] = window.size;
            let mut grain = vec![NOTHING; width * height];
            grain.par_chunks_mut(BAND * width).enumerate().for_each(|(band, pixels)| {
                for (i, each) in grains.iter().enumerate().filter(|(_, each)| is_meant(each)) {
                    draw((i as u32, each), window, band * BAND, pixels);
                }
            });
            DrawnGrains { grains, size: window.size, grain }
        };
        // What is around a hole at the edge of the image lies outside it.
        let margin = farthest(grains, window.scale());
        let mut drawn = draw_all(&window.widened(margin), &|grain| !by_shape.contains(&grain.body));
        drawn.close();
        drawn.fill_holes(window.scale());
        drawn.narrow(margin);
        if !shapes.is_empty() {
            let inside = draw_all(window, &|grain| by_shape.contains(&grain.body));
            drawn.add_shapes(shapes, &inside, window);
        }
        drawn
    }

    /// Fills holes between grains of one body: places from which it is near in all directions.
    fn fill_holes(&mut self, scale: f64) {
        let [width, height] = self.size;
        let farthest = farthest(self.grains, scale);
        let around = |x: usize, y: usize, way: [f64; 2]| {
            (1..=farthest).find_map(|k| {
                let place = [x as f64 + way[0] * k as f64, y as f64 + way[1] * k as f64];
                let place = place.map(|x| if x < 0.0 { usize::MAX } else { x.round() as usize });
                let (index, grain) = self.grain(place[0], place[1])?;
                Some((index as u32, grain.body, k as f64 <= HOLE * grain.side * scale))
            })
        };
        let filled = |place: usize| {
            if self.grain[place] != NOTHING {
                return None;
            }
            let (x, y) = (place % width, place / width);
            let (index, body, is_near) = around(x, y, WAYS[0])?;
            let others = &WAYS[1..];
            let is_hole = is_near
                && others
                    .iter()
                    .all(|way| around(x, y, *way).is_some_and(|(_, other, near)| near && other == body));
            is_hole.then_some((place, index))
        };
        let filled: Vec<(usize, u32)> = (0..width * height).into_par_iter().filter_map(filled).collect();
        filled.into_iter().for_each(|(place, index)| self.grain[place] = index);
    }

    /// Takes so many pixels away on every side.
    fn narrow(&mut self, margin: usize) {
        let [width, height] = self.size.map(|count| count - 2 * margin);
        let rows = self.grain.chunks_exact(self.size[0]).skip(margin).take(height);
        self.grain = rows.flat_map(|row| &row[margin..margin + width]).copied().collect();
        self.size = [width, height];
    }

    /// Puts shapes above all; what is in them looks like the nearest grain of their bodies.
    fn add_shapes(&mut self, shapes: &[PosedShape], inside: &DrawnGrains, window: &PlaneView) {
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

/// How far from a hole what is around it may lie [pixels].
fn farthest(grains: &[Grain], scale: f64) -> usize {
    let side = grains.iter().map(|grain| grain.side).fold(0.0, f64::max);
    (HOLE * side * scale).min(FARTHEST) as usize
}

/// Marks the pixels of one grain on the rows from `top` on: those whose place in the undeformed square is inside it.
fn draw((index, grain): (u32, &Grain), window: &PlaneView, top: usize, pixels: &mut [u32]) {
    let [width, _] = window.size;
    let rows = pixels.len() / width;
    let half = 0.5 * OVERLAP * grain.side * window.scale();
    let f = &grain.deformation;
    let reach = [(f[0].abs() + f[1].abs()) * half, (f[3].abs() + f[4].abs()) * half];
    let [x, y] = window.pixel([grain.position[0], grain.position[1]]);
    let det = f[0] * f[4] - f[1] * f[3];
    let span = |center: f64, reach: f64, end: usize| {
        let low = (center - reach).floor().max(0.0) as usize;
        low..((center + reach).ceil().max(0.0) as usize).min(end)
    };
    for row in span(y - top as f64, reach[1], rows) {
        let up = y - ((top + row) as f64 + 0.5);
        for column in span(x, reach[0], width) {
            let right = column as f64 + 0.5 - x;
            let local = [(f[4] * right - f[1] * up) / det, (f[0] * up - f[3] * right) / det];
            if local[0].abs() <= half && local[1].abs() <= half {
                pixels[row * width + column] = index;
            }
        }
    }
}

#[cfg(test)]
mod tests {
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
        let drawn = DrawnGrains::new(&grains, &window, &[]);
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
            let drawn = DrawnGrains::new(&grains, &window, &[]);
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
            let drawn = DrawnGrains::new(grains, &window, &[]);
            drawn.grain.iter().filter(|index| **index == NOTHING).count()
        };
        for degrees in [0.0, 10.0, 22.5, 30.0, 45.0_f64] {
            assert_eq!(empty(&turned(degrees.to_radians(), false)), 0, "{degrees}");
            // 8 m long at least, and 0.42 m wide: 1344 pixels.
            let crack = empty(&turned(degrees.to_radians(), true));
            assert!(crack > 900, "{degrees}: {crack}");
        }
    }
}
