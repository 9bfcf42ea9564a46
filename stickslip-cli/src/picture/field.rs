//! A column on the pixels of a picture, and the lines along which it is the same.

use super::light::{Lit, Sight};
use super::plane::{DrawnGrains, PlaneView};
use super::quantity::ColorQuantity;
use super::setting::SymmetryPlane;
use super::smooth::Smoother;
use crate::drawing::SAMPLES;
use rayon::prelude::*;

/// Values on the pixels of the file, each of the body that is drawn there.
pub struct PixelField {
    width: usize,
    /// Index of the body; [`NOTHING`] where there is none.
    body: Vec<u32>,
    value: Vec<f64>,
    /// Towards the eye [m]; zero in the plane.
    depth: Vec<f64>,
    /// Neighbours differ by less in depth, or one is in front of the other [m].
    step: f64,
}

/// What the particles tell of any place.
pub struct Source<'a> {
    /// Averages what the values are made of.
    pub smoother: &'a Smoother,
    /// The values.
    pub quantity: &'a ColorQuantity,
    /// How many of the grains are particles; the others are their mirror images.
    pub count: usize,
    /// Where these are mirrored.
    pub mirror: Option<SymmetryPlane>,
}

/// No body.
const NOTHING: u32 = u32::MAX;

impl Source<'_> {
    /// The place of the particle at a place where a grain is drawn: that itself, or where it is the mirror image of.
    pub fn own(&self, grain: usize, [x, y]: [f64; 2]) -> [f64; 3] {
        let mirror = self.mirror.filter(|_| grain >= self.count);
        mirror.map_or([x, y, 0.0], |mirror| mirror.image([x, y, 0.0]))
    }

    /// The same of what a pixel sees in space.
    pub fn seen(&self, sight: &Sight) -> [f64; 3] {
        let mirror = self.mirror.filter(|_| sight.is_image);
        mirror.map_or(sight.place.0, |mirror| mirror.image(sight.place.0))
    }
}

impl PixelField {
    /// The values on the surfaces of bodies in space, in a part (left, top, width, height) of the drawn pixels.
    pub fn of_surfaces(lit: &Lit, shown: [usize; 4], source: &Source) -> Self {
        let [width, height] = lit.size().map(|side| side / SAMPLES);
        let [left, top, wide, high] = shown;
        let sight = |place: usize| {
            let [x, y] = [place % width, place / width].map(|index| index * SAMPLES + SAMPLES / 2);
            let is_shown = (left..left + wide).contains(&x) && (top..top + high).contains(&y);
            let sight = lit.sight([x, y]).filter(|_| is_shown)?;
            let parts = source.smoother.at(sight.body, source.seen(&sight))?;
            Some((sight.body, source.quantity.value_of(parts), sight.depth))
        };
        let nothing = (NOTHING, 0.0, 0.0);
        let found: Vec<(u32, f64, f64)> =
            (0..width * height).into_par_iter().map(|place| sight(place).unwrap_or(nothing)).collect();
        PixelField {
            width,
            body: found.iter().map(|(body, _, _)| *body).collect(),
            value: found.iter().map(|(_, value, _)| *value).collect(),
            depth: found.iter().map(|(_, _, depth)| *depth).collect(),
            step: lit.step(),
        }
    }

    /// The values where grains are drawn.
    pub fn new(drawn: &DrawnGrains, window: &PlaneView, source: &Source) -> Self {
        let [width, height] = window.size.map(|side| side / SAMPLES);
        let (mut body, mut value) = (vec![NOTHING; width * height], vec![0.0; width * height]);
        let rows = body.par_chunks_mut(width.max(1)).zip(value.par_chunks_mut(width.max(1)));
        rows.enumerate().for_each(|(row, (body, value))| {
            for column in 0..width {
                let [x, y] = [column, row].map(|index| index * SAMPLES + SAMPLES / 2);
                let Some((index, grain)) = drawn.grain(x, y) else { continue };
                let place = source.own(index, window.place([x as f64, y as f64]));
                if let Some(parts) = source.smoother.at(grain.body, place) {
                    body[column] = grain.body;
                    value[column] = source.quantity.value_of(parts);
                }
            }
        });
        let depth = vec![0.0; width * height];
        PixelField { width, body, value, depth, step: f64::INFINITY }
    }

    /// The value of a body at a drawn pixel; `None` where another, or none, is in the middle of that pixel of the file.
    pub fn value(&self, body: u32, [x, y]: [usize; 2]) -> Option<f64> {
        let place = y / SAMPLES * self.width + (x / SAMPLES).min(self.width - 1);
        (self.body.get(place) == Some(&body)).then(|| self.value[place])
    }

    /// The lines along which the field has a value, as segments between drawn pixels, by marching squares: between the
    /// middles of four pixels of one body the field is linear along each side.
    pub fn isolines(&self, level: f64) -> Vec<[[f64; 2]; 2]> {
        let height = self.body.len() / self.width.max(1);
        let mut segments = Vec::new();
        for row in 1..height {
            for column in 1..self.width {
                // Around the square.
                let corners = [[column - 1, row - 1], [column, row - 1], [column, row], [column - 1, row]];
                let places = corners.map(|[x, y]| y * self.width + x);
                let body = self.body[places[0]];
                if body == NOTHING || places.iter().any(|&place| self.body[place] != body) {
                    continue;
                }
                let depths = places.map(|place| self.depth[place]);
                if depths.iter().any(|depth| (depth - depths[0]).abs() > self.step) {
                    continue;
                }
                let values = places.map(|place| self.value[place] - level);
                let crossing = |i: usize| {
                    let j = (i + 1) % 4;
                    let (a, b) = (values[i], values[j]);
                    ((a < 0.0) != (b < 0.0)).then(|| {
                        let share = a / (a - b);
                        let along = |axis: usize| {
                            let [from, to] =
                                [i, j].map(|k| (corners[k][axis] * SAMPLES + SAMPLES / 2) as f64);
                            from + share * (to - from)
                        };
                        [along(0), along(1)]
                    })
                };
                // In a saddle lines cross two sides each, and which does not matter on so small a square.
                let ends: Vec<[f64; 2]> = (0..4).filter_map(crossing).collect();
                segments.extend(ends.chunks_exact(2).map(|ends| [ends[0], ends[1]]));
            }
        }
        segments
    }
}

/// Values between the ends of a range at equal distances, without the ends.
pub fn levels([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    (1..=count).map(|k| low + (high - low) * k as f64 / (count + 1) as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn isolines_of_a_cone_are_circles() {
        let (width, height) = (60, 40);
        let value = |place: usize| {
            let [x, y] = [place % width, place / width].map(|index| index as f64);
            (x - 30.0).hypot(y - 20.0)
        };
        let value: Vec<f64> = (0..width * height).map(value).collect();
        let mut field = PixelField {
            width,
            body: vec![0; width * height],
            value,
            depth: vec![0.0; width * height],
            step: 1.0,
        };
        let middle = [30, 20].map(|index| (index * SAMPLES + SAMPLES / 2) as f64);
        let segments = field.isolines(12.0);
        assert!(segments.len() > 60);
        let off = |end: &[f64; 2]| (end[0] - middle[0]).hypot(end[1] - middle[1]) / SAMPLES as f64 - 12.0;
        assert!(segments.iter().flatten().all(|end| off(end).abs() < 0.02));
        // A fold of the body on the left, behind the rest: no line crosses from one to the other.
        (0..width * height).filter(|place| place % width < 30).for_each(|place| field.depth[place] = -5.0);
        let across = (30 * SAMPLES) as f64;
        let beside = |end: &[f64; 2]| end[0] >= across || end[0] < across - 0.4 * SAMPLES as f64;
        assert!(field.isolines(12.0).iter().flatten().all(beside));
        assert!(field.isolines(12.0).iter().flatten().any(|end| end[0] < across));
        // Another body on the left: no line crosses into it.
        (0..width * height).filter(|place| place % width < 30).for_each(|place| field.body[place] = 1);
        field.value.iter_mut().enumerate().filter(|(i, _)| i % width < 30).for_each(|(_, v)| *v = 0.0);
        let right = (30 * SAMPLES) as f64;
        assert!(field.isolines(12.0).iter().flatten().all(|end| end[0] >= right));
    }

    #[test]
    fn levels_lie_between_the_ends() {
        assert_eq!(levels([0.0, 4.0], 3), [1.0, 2.0, 3.0]);
        assert!(levels([0.0, 4.0], 0).is_empty());
    }
}
