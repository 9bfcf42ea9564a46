//! From the pixels of an image to the surfaces of its parts.

use super::ImagePart;
use super::lattice::Lattice;
use rayon::prelude::*;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::{BTreeMap, HashSet};

/// The pixels of an image, in space of a stack of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// Along each axis; in the plane one along z.
    pub counts: [usize; 3],
    /// Labels or greys, by x, then y upwards, then z.
    pub values: Vec<f32>,
}

/// What makes pixels a part.
#[derive(Clone, Debug, PartialEq)]
pub enum Solids {
    /// Pixels of one number, which is not that of the background.
    Labels {
        /// The number of what is no part.
        background: f32,
        /// Those that are wanted; `None` is all.
        wanted: Option<Vec<f32>>,
    },
    /// Pixels brighter than a grey, or darker, that touch by sides, edges or corners.
    Brighter {
        /// The grey.
        than: f32,
        /// Darker pixels instead.
        inverted: bool,
    },
}

/// Pixels around a part that its field has.
pub(super) const MARGIN: usize = 5;

/// Widths of the Gaussian that takes the stairs out of labels, and out of greys what pixels of a sharp edge lack
/// [pixels].
const STAIRS: [f64; 2] = [3.0, 1.5];

/// The same over the depth of a part, where that is less: small parts stay as they are.
const OF_DEPTH: f64 = 0.25;

/// A box of pixels.
#[derive(Clone, Copy, Debug)]
struct Extent {
    min: [usize; 3],
    max: [usize; 3],
    pixels: usize,
}

/// Parts in boxes of more pixels in all than there is room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spread {
    /// How many parts.
    pub parts: usize,
    /// Pixels of their boxes.
    pub pixels: usize,
}

/// Pixels of all fields, and how many parts there may be.
pub(super) const MOST: Spread = Spread { parts: 100_000, pixels: 1 << 31 };

/// Each part of at least so many pixels with its number: its label, or its place in the order of the pixels from 1 on.
///
/// A part of labels has its surface at first half-way between its pixels and others, a part of greys where they are the
/// threshold, linear between pixels. Stairs there are smoothed: of labels, what is shorter than some ten pixels, of
/// greys than some five; round parts keep their size. Then parts are moved back from each other wherever two would hold
/// one point. `first` is the middle of the first pixel and `pixel` the side of one [m].
///
/// # Errors
/// More parts than can be bodies, or parts that are all over the image.
pub fn image_parts(
    pixels: &Pixels,
    solids: &Solids,
    (least, name): (usize, &str),
    (first, pixel): ([f64; 3], f64),
) -> Result<Vec<(u64, ImagePart)>, Spread> {
    let (numbers, extents) = match solids {
        Solids::Labels { background, .. } => labelled(pixels, *background),
        Solids::Brighter { than, inverted } => connected(pixels, *than, *inverted),
    };
    let labels: HashSet<u32> = match solids {
        Solids::Labels { wanted: Some(wanted), .. } => wanted.iter().map(|&label| label as u32).collect(),
        _ => HashSet::new(),
    };
    let is_wanted = |number: u32| match solids {
        Solids::Labels { wanted: Some(_), .. } => labels.contains(&number),
        _ => true,
    };
    let (wanted, beside): (Vec<_>, Vec<_>) =
        extents.into_iter().filter(|(_, extent)| extent.pixels >= least).partition(|(of, _)| is_wanted(*of));
    // Those beside them are other bodies, of which another table may ask, and their surfaces are the same then.
    let boxes = wanted.iter().map(|(_, extent)| Rectangle::from_aabb(extent.around(0)));
    let tree = RTree::bulk_load(boxes.collect::<Vec<_>>());
    // Whether their fields may share a pixel.
    let near = |(_, extent): &(u32, Extent)| {
        tree.locate_in_envelope_intersecting(extent.around(2 * MARGIN)).next().is_some()
    };
    let beside: Vec<_> = beside.into_iter().filter(near).collect();
    let mut kept = [wanted, beside].concat();
    kept.sort_by_key(|(number, _)| *number);
    let room = |(_, extent): &(u32, Extent)| extent.field(pixels.counts).1.iter().product::<usize>();
    let spread = Spread { parts: kept.len(), pixels: kept.iter().map(room).sum() };
    if spread.parts > MOST.parts || spread.pixels > MOST.pixels {
        return Err(spread);
    }
    let field = |&(number, extent): &(u32, Extent)| {
        let (lower, counts) = extent.field(pixels.counts);
        let place = |at: [usize; 3]| -> Option<usize> {
            let at: [i64; 3] = std::array::from_fn(|k| at[k] as i64 + lower[k]);
            let known = (0..3).all(|k| (0..pixels.counts[k] as i64).contains(&at[k]));
            known.then(|| pixels.number(at.map(|x| x as usize)))
        };
        let distances = match solids {
            Solids::Labels { .. } => {
                let stairs = Lattice::filled(counts, |at| {
                    if place(at).is_some_and(|at| numbers[at] == number) { -0.5 } else { 0.5 }
                });
                unstepped(stairs, STAIRS[0])
            }
            Solids::Brighter { than, inverted } => {
                let greys = Lattice::filled(counts, |at| {
                    let Some(at) = place(at) else { return f32::MAX };
                    let below = if *inverted { pixels.values[at] - than } else { than - pixels.values[at] };
                    // Of other parts: as far outside as they are inside.
                    if below < 0.0 && numbers[at] != number { -below } else { below }
                });
                unstepped(greys.closed(), STAIRS[1])
            }
        };
        (number, lower, distances.spline())
    };
    let mut fields: Vec<_> = kept.par_iter().map(field).collect();
    part_them(&mut fields);
    let part = |(number, lower, coefficients): (u32, [i64; 3], Lattice)| {
        let start = std::array::from_fn(|k| first[k] + pixel * lower[k] as f64);
        let extent = coefficients.inside()?;
        Some((u64::from(number), ImagePart::new(name, (coefficients, extent), start, pixel)))
    };
    fields.retain(|(number, ..)| is_wanted(*number));
    Ok(fields.into_iter().filter_map(part).collect())
}

/// Distances from where numbers are zero, without stairs.
pub(super) fn unstepped(numbers: Lattice, width: f64) -> Lattice {
    let distances = numbers.distances();
    let depth = -distances.values.iter().fold(0.0_f32, |least, &distance| least.min(distance));
    distances.smoothed(width.min(OF_DEPTH * f64::from(depth))).distances()
}

impl Pixels {
    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        (i * self.counts[1] + j) * self.counts[2] + k
    }

    fn place(&self, number: usize) -> [usize; 3] {
        let [_, rows, layers] = self.counts;
        [number / layers / rows, number / layers % rows, number % layers]
    }
}

impl Extent {
    fn of(pixel: [usize; 3]) -> Self {
        Extent { min: pixel, max: pixel, pixels: 0 }
    }

    fn take(&mut self, pixel: [usize; 3]) {
        self.min = std::array::from_fn(|k| self.min[k].min(pixel[k]));
        self.max = std::array::from_fn(|k| self.max[k].max(pixel[k]));
        self.pixels += 1;
    }

    /// The box with so many pixels more on each side.
    fn around(&self, more: usize) -> AABB<[i64; 3]> {
        let [min, max] = [self.min, self.max].map(|corner| corner.map(|x| x as i64));
        let more = more as i64;
        AABB::from_corners(min.map(|x| x - more), max.map(|x| x + more))
    }

    /// First pixel and numbers of pixels of the field.
    fn field(&self, counts: [usize; 3]) -> ([i64; 3], [usize; 3]) {
        let margin = |k: usize| if counts[k] == 1 && k == 2 { 0 } else { MARGIN };
        (
            std::array::from_fn(|k| self.min[k] as i64 - margin(k) as i64),
            std::array::from_fn(|k| self.max[k] - self.min[k] + 1 + 2 * margin(k)),
        )
    }
}

impl Lattice {
    /// What lies beyond the image is outside: as far from zero as its neighbours, so that the edge is half a pixel from
    /// them.
    fn closed(mut self) -> Self {
        let strides = self.strides();
        for (axis, stride) in strides.into_iter().enumerate().take(self.dimension()) {
            for number in 0..self.values.len() {
                let at = number / stride % self.counts[axis];
                let known = |other: usize| Some(self.values[other]).filter(|&value| value != f32::MAX);
                if self.values[number] == f32::MAX {
                    let before = if at > 0 { known(number - stride) } else { None };
                    let after = if at + 1 < self.counts[axis] { known(number + stride) } else { None };
                    if let Some(value) = before.or(after) {
                        self.values[number] = value.abs().max(f32::MIN_POSITIVE);
                    }
                }
            }
        }
        self
    }

    /// A box around all of the splines that may be below zero; `None` where none is.
    pub(super) fn inside(&self) -> Option<[[f64; 3]; 2]> {
        let strides = self.strides();
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for number in (0..self.values.len()).filter(|&number| self.values[number] < 0.0) {
            for k in 0..self.dimension() {
                let at = (number / strides[k] % self.counts[k]) as f64;
                // A spline reaches two pixels far.
                (min[k], max[k]) = (min[k].min(at - 2.0), max[k].max(at + 2.0));
            }
        }
        if self.dimension() == 2 {
            (min[2], max[2]) = (0.0, 0.0);
        }
        (min[0] <= max[0]).then_some([min, max])
    }
}

/// The number of each pixel's part, 0 of none, and the parts.
fn labelled(pixels: &Pixels, background: f32) -> (Vec<u32>, Vec<(u32, Extent)>) {
    let mut found: BTreeMap<u32, Extent> = BTreeMap::new();
    let mut numbers = vec![u32::MAX; pixels.values.len()];
    for (number, &label) in pixels.values.iter().enumerate() {
        if label != background {
            numbers[number] = label as u32;
            let place = pixels.place(number);
            found.entry(label as u32).or_insert(Extent::of(place)).take(place);
        }
    }
    (numbers, found.into_iter().collect())
}

/// The same of parts that hold together.
fn connected(pixels: &Pixels, than: f32, inverted: bool) -> (Vec<u32>, Vec<(u32, Extent)>) {
    let is_solid = |number: usize| (pixels.values[number] > than) != inverted;
    let mut numbers = vec![0; pixels.values.len()];
    let (mut found, mut open) = (Vec::new(), Vec::new());
    for start in 0..pixels.values.len() {
        if numbers[start] != 0 || !is_solid(start) {
            continue;
        }
        let name = found.len() as u32 + 1;
        let mut extent = Extent::of(pixels.place(start));
        numbers[start] = name;
        open.push(start);
        while let Some(number) = open.pop() {
            let place = pixels.place(number);
            extent.take(place);
            for way in 0..27_usize {
                let step = [way / 9, way / 3 % 3, way % 3];
                let beside: [usize; 3] = std::array::from_fn(|k| (place[k] + step[k]).wrapping_sub(1));
                if (0..3).all(|k| beside[k] < pixels.counts[k]) {
                    let beside = pixels.number(beside);
                    if numbers[beside] == 0 && is_solid(beside) {
                        numbers[beside] = name;
                        open.push(beside);
                    }
                }
            }
        }
        found.push((name, extent));
    }
    (numbers, found)
}

/// Raises coefficients of two fields alike wherever their sum is negative. B-splines are nowhere negative, so the sum
/// of both fields is not either, and no point is in two parts.
pub(super) fn part_them(fields: &mut [(u32, [i64; 3], Lattice)]) {
    let upper = |lower: &[i64; 3], field: &Lattice| -> [i64; 3] {
        std::array::from_fn(|k| lower[k] + field.counts[k] as i64)
    };
    let boxes = fields.iter().enumerate().map(|(number, (_, lower, field))| {
        GeomWithData::new(Rectangle::from_corners(*lower, upper(lower, field).map(|end| end - 1)), number)
    });
    let tree = RTree::bulk_load(boxes.collect::<Vec<_>>());
    for b in 1..fields.len() {
        let (earlier, rest) = fields.split_at_mut(b);
        let (_, lower_b, of_b) = &mut rest[0];
        let around = AABB::from_corners(*lower_b, upper(lower_b, of_b).map(|end| end - 1));
        let near = tree.locate_in_envelope_intersecting(around).map(|found| found.data);
        // One after the other, as they come.
        let mut near: Vec<usize> = near.filter(|&a| a < b).collect();
        near.sort_unstable();
        for a in near {
            let (_, lower_a, of_a) = &mut earlier[a];
            let (upper_a, upper_b) = (upper(lower_a, of_a), upper(lower_b, of_b));
            let min: [i64; 3] = std::array::from_fn(|k| lower_a[k].max(lower_b[k]));
            let max: [i64; 3] = std::array::from_fn(|k| upper_a[k].min(upper_b[k]));
            if (0..3).any(|k| min[k] >= max[k]) {
                continue;
            }
            let number = |field: &Lattice, lower: &[i64; 3], at: [i64; 3]| -> usize {
                let strides = field.strides();
                (0..3).map(|k| (at[k] - lower[k]) as usize * strides[k]).sum()
            };
            for i in min[0]..max[0] {
                for j in min[1]..max[1] {
                    for k in min[2]..max[2] {
                        let at = [i, j, k];
                        let (a, b) = (number(of_a, lower_a, at), number(of_b, lower_b, at));
                        let lack = -(of_a.values[a] + of_b.values[b]);
                        if lack > 0.0 {
                            of_a.values[a] += 0.5 * lack;
                            of_b.values[b] += 0.5 * lack;
                        }
                    }
                }
            }
        }
    }
}
