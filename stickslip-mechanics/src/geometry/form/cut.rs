//! The part of a box that lies in a shape.

use crate::geometry::Shape;

/// A part of a body: how much there is, and where its centroid is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// Volume [m^3], in the plane area [m^2].
    pub volume: f64,
    /// Volume times the place of the centroid [m^4, in the plane m^3].
    pub first: [f64; 3],
}

impl Part {
    fn add(&mut self, volume: f64, at: [f64; 3]) {
        self.volume += volume;
        self.first.iter_mut().zip(at).for_each(|(moment, x)| *moment += volume * x);
    }

    /// The centroid [m].
    pub fn centroid(&self) -> [f64; 3] {
        self.first.map(|moment| moment / self.volume)
    }
}

/// How often a box is halved before what of it lies inside is told by a plane.
const HALVINGS: [u32; 2] = [5, 3];

/// What of a box lies in a shape; `place` takes a place from the box' own frame, in which `low` is its lower corner and
/// `side` its side [m], to where the shape is.
pub fn part(
    shape: &Shape,
    place: &dyn Fn([f64; 3]) -> [f64; 3],
    (low, side): ([f64; 3], f64),
    dimension: usize,
) -> Part {
    let mut sum = Part::default();
    halve(shape, place, (low, side, HALVINGS[dimension - 2]), (dimension, &mut sum));
    sum
}

fn halve(
    shape: &Shape,
    place: &dyn Fn([f64; 3]) -> [f64; 3],
    (low, side, halvings): ([f64; 3], f64, u32),
    (dimension, sum): (usize, &mut Part),
) {
    let middle = std::array::from_fn(|k| if k < dimension { low[k] + 0.5 * side } else { 0.0 });
    let at = place(middle);
    let (distance, volume) = (shape.distance(at, dimension), side.powi(dimension as i32));
    let corner = 0.5 * side * (dimension as f64).sqrt();
    if distance >= corner {
        return;
    }
    if distance <= -corner {
        return sum.add(volume, at);
    }
    if halvings > 0 {
        for half in 0..1 << dimension {
            let low = std::array::from_fn(|k| if half >> k & 1 == 1 { low[k] + 0.5 * side } else { low[k] });
            halve(shape, place, (low, 0.5 * side, halvings - 1), (dimension, sum));
        }
        return;
    }
    let inside = (0.5 - distance / side).clamp(0.0, 1.0);
    if inside > 0.0 {
        sum.add(volume * inside, at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_of_a_disk_has_its_area_and_centroid() {
        let quarter = part(&Shape::disk([0.0; 2], 1.0), &|x| x, ([0.0; 3], 1.0), 2);
        assert!((quarter.volume - std::f64::consts::FRAC_PI_4).abs() < 3e-4, "{quarter:?}");
        let exact = 4.0 / (3.0 * std::f64::consts::PI);
        assert!(quarter.centroid()[..2].iter().all(|x| (x - exact).abs() < 3e-4), "{quarter:?}");
    }

    #[test]
    fn a_face_that_cuts_boxes_is_exact() {
        let below = part(&Shape::half_space([0.0, 0.3, 0.0], [0.0, 1.0, 0.0]), &|x| x, ([0.0; 3], 1.0), 3);
        assert!((below.volume - 0.3).abs() < 1e-12, "{below:?}");
    }
}
