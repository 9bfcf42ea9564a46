//! Numbers at the pixels of a box of an image: distances from where they change sign, and smoothing.

use crate::geometry::mesh::closest;
use crate::geometry::zero_level::{Corners, Facet};
use crate::tensor::Vector;
use std::f64::consts::PI;

/// Numbers at pixels, by x, then y, then z; in the plane there is one along z. Lengths are in pixels, from the middle
/// of the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    pub counts: [usize; 3],
    pub values: Vec<f32>,
}

impl Lattice {
    pub fn dimension(&self) -> usize {
        if self.counts[2] == 1 { 2 } else { 3 }
    }

    /// What `value` says at each pixel.
    pub fn filled(counts: [usize; 3], mut value: impl FnMut([usize; 3]) -> f32) -> Self {
        let mut values = Vec::with_capacity(counts.iter().product());
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                for k in 0..counts[2] {
                    values.push(value([i, j, k]));
                }
            }
        }
        Lattice { counts, values }
    }

    /// From one pixel to the next along each axis, in `values`.
    pub fn strides(&self) -> [usize; 3] {
        [self.counts[1] * self.counts[2], self.counts[2], 1]
    }

    /// Signed distances from the surface on which the values are zero, between pixels of other signs, where they are
    /// linear along the edges of tetrahedra, in the plane of triangles.
    ///
    /// Exact beside the surface. From there each pixel learns from its neighbours which facet is nearest, in sweeps
    /// along all diagonals (Danielsson 1980, Euclidean distance mapping), which may miss by a few hundredths of a pixel
    /// where another facet is nearer by that.
    pub fn distances(&self) -> Lattice {
        let dimension = self.dimension();
        let mut facets: Vec<Facet> = Vec::new();
        let values: Vec<f64> =
            self.values.iter().map(|&x| if x == 0.0 { f64::MIN_POSITIVE } else { f64::from(x) }).collect();
        let corners = Corners { origin: [0.0; 3], spacing: 1.0, counts: self.counts, values: &values };
        corners.each_cell(dimension, |found| facets.extend(found));
        let mut field =
            Nearest { lattice: self, facets: &facets, found: vec![(f32::INFINITY, NONE); values.len()] };
        for (number, facet) in facets.iter().enumerate() {
            let middle = facet[..dimension].iter().fold(Vector([0.0; 3]), |sum, &x| sum + Vector(x));
            let cell = (middle / dimension as f64).0.map(|x| x as usize);
            for corner in 0..1_usize << dimension {
                field.try_facet(std::array::from_fn(|k| cell[k] + (corner >> k & 1)), number as u32);
            }
        }
        for diagonal in 0..1_usize << dimension {
            field.sweep(std::array::from_fn(|k| diagonal >> k & 1 == 1));
        }
        let signed = |(&(distance, _), &value): (&(f32, u32), &f64)| distance.copysign(value as f32);
        Lattice { counts: self.counts, values: field.found.iter().zip(&values).map(signed).collect() }
    }

    /// The numbers without waves that are short, some 2 pi `width` pixels and less, and others as they were up to the
    /// fourth power of the width over their length: what a Gaussian leaves, and of what it takes the same once more.
    pub fn smoothed(&self, width: f64) -> Lattice {
        let reach = (3.0 * width).ceil() as i64;
        let weight = |i: i64| (-0.5 * (i as f64 / width).powi(2)).exp() / (width * (2.0 * PI).sqrt());
        let kernel: Vec<f64> = (-reach..=reach).map(weight).collect();
        let sum: f64 = kernel.iter().sum();
        let kernel: Vec<f64> = kernel.iter().map(|weight| weight / sum).collect();
        self.twice(&kernel)
    }

    /// The coefficients of the cubic B-splines whose sum is what the numbers are, up to the fourth power of a pixel
    /// over the length of waves (de Boor's quasi-interpolant).
    pub fn spline(&self) -> Lattice {
        self.twice(&[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0])
    }

    /// f + (f - K f) for the spline, K f + K (f - K f) = K (2 f - K f) for smoothing: a kernel with what it lacks.
    fn twice(&self, kernel: &[f64]) -> Lattice {
        let once = self.convolved(kernel);
        let doubled = self.values.iter().zip(&once.values).map(|(whole, once)| 2.0 * whole - once).collect();
        let doubled = Lattice { counts: self.counts, values: doubled };
        // The three weights of the spline are those that make numbers of coefficients.
        if kernel.len() == 3 { doubled } else { doubled.convolved(kernel) }
    }

    /// Along each axis in turn; beyond the ends numbers go on by a turn of half a circle about the last one.
    pub fn convolved(&self, kernel: &[f64]) -> Lattice {
        let half = (kernel.len() / 2) as i64;
        let mut values = self.values.clone();
        let mut row = Vec::new();
        for axis in 0..self.dimension() {
            let (count, stride) = (self.counts[axis] as i64, self.strides()[axis]);
            for first in (0..values.len()).filter(|&n| n / stride % self.counts[axis] == 0) {
                row.clear();
                row.extend((0..count as usize).map(|i| f64::from(values[first + i * stride])));
                let at = |i: i64| match i {
                    _ if i < 0 => 2.0 * row[0] - row[(-i).min(count - 1) as usize],
                    _ if i >= count => {
                        let last = count - 1;
                        2.0 * row[last as usize] - row[(2 * last - i).max(0) as usize]
                    }
                    _ => row[i as usize],
                };
                for i in 0..count {
                    let sum: f64 = kernel.iter().zip(i - half..).map(|(weight, j)| weight * at(j)).sum();
                    values[first + i as usize * stride] = sum as f32;
                }
            }
        }
        Lattice { counts: self.counts, values }
    }

    /// The sum of the cubic B-splines with these coefficients at a place a pixel or more within the lattice, and its
    /// gradient.
    pub fn spline_at(&self, place: [f64; 3]) -> (f64, [f64; 3]) {
        let dimension = self.dimension();
        let mut first = [0; 3];
        let (mut weights, mut slopes) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
        for k in 0..dimension {
            let cell = place[k].floor();
            let u = place[k] - cell;
            let v = 1.0 - u;
            first[k] = cell as usize - 1;
            weights[k] = [
                v * v * v / 6.0,
                (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0,
                (4.0 - 6.0 * v * v + 3.0 * v * v * v) / 6.0,
                u * u * u / 6.0,
            ];
            slopes[k] = [-0.5 * v * v, u * (1.5 * u - 2.0), v * (2.0 - 1.5 * v), 0.5 * u * u];
        }
        let strides = self.strides();
        let along = |k: usize, i: usize| (first[k] + i) * strides[k];
        let (mut sum, mut gradient) = (0.0, [0.0; 3]);
        for i in 0..4 {
            for j in 0..4 {
                let start = along(0, i) + along(1, j);
                let plane = weights[0][i] * weights[1][j];
                if dimension == 2 {
                    let value = f64::from(self.values[start]);
                    sum += plane * value;
                    gradient[0] += slopes[0][i] * weights[1][j] * value;
                    gradient[1] += weights[0][i] * slopes[1][j] * value;
                    continue;
                }
                let (mut value, mut slope) = (0.0, 0.0);
                for k in 0..4 {
                    let here = f64::from(self.values[start + along(2, k)]);
                    value += weights[2][k] * here;
                    slope += slopes[2][k] * here;
                }
                sum += plane * value;
                gradient[0] += slopes[0][i] * weights[1][j] * value;
                gradient[1] += weights[0][i] * slopes[1][j] * value;
                gradient[2] += plane * slope;
            }
        }
        (sum, gradient)
    }
}

/// No facet.
const NONE: u32 = u32::MAX;

/// The nearest facet of each pixel that is known so far, and how far it is.
struct Nearest<'a> {
    lattice: &'a Lattice,
    facets: &'a [Facet],
    found: Vec<(f32, u32)>,
}

impl Nearest<'_> {
    fn try_facet(&mut self, pixel: [usize; 3], facet: u32) {
        let strides = self.lattice.strides();
        let number: usize = (0..3).map(|k| pixel[k] * strides[k]).sum();
        let place = pixel.map(|i| i as f64);
        // In the plane the third corner is the second.
        let (nearest, _) = closest(self.facets[facet as usize], place);
        let distance = (Vector(place) - Vector(nearest)).norm() as f32;
        if distance < self.found[number].0 {
            self.found[number] = (distance, facet);
        }
    }

    /// Each pixel from those before it along each axis, in an order that goes down along some of them.
    fn sweep(&mut self, down: [bool; 3]) {
        let (counts, strides) = (self.lattice.counts, self.lattice.strides());
        let turned = |k: usize, i: usize| if down[k] { counts[k] - 1 - i } else { i };
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                for k in 0..counts[2] {
                    let steps = [i, j, k];
                    let pixel: [usize; 3] = std::array::from_fn(|axis| turned(axis, steps[axis]));
                    let number: usize = (0..3).map(|axis| pixel[axis] * strides[axis]).sum();
                    for axis in (0..3).filter(|&axis| steps[axis] > 0) {
                        let before = if down[axis] { number + strides[axis] } else { number - strides[axis] };
                        let facet = self.found[before].1;
                        if facet != NONE && facet != self.found[number].1 {
                            self.try_facet(pixel, facet);
                        }
                    }
                }
            }
        }
    }
}
