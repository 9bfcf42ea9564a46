//! Images of bodies between periodic faces: everything is there again a period further.

use stickslip_mechanics::tensor::Vector;

/// After which length everything repeats along each axis [m]; 0 where nothing does.
///
/// Bodies have places without end: none is moved as it goes through a face. Who is whose neighbour counts modulo the
/// period, and a point looks into that image of its partner which is nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodLengths<const D: usize>(pub Vector<f64, D>);

impl<const D: usize> Default for PeriodLengths<D> {
    fn default() -> Self {
        PeriodLengths(Vector::ZERO)
    }
}

impl<const D: usize> PeriodLengths<D> {
    /// Whether anything repeats.
    pub fn any(&self) -> bool {
        self.0 != Vector::ZERO
    }

    /// From a place to that image of it which is nearest to another one along each axis [m]: whole periods.
    pub fn away(&self, place: Vector<f64, D>, to: Vector<f64, D>) -> Vector<f64, D> {
        Vector::from_fn(|k| match self.0[k] {
            0.0 => 0.0,
            period => period * ((to[k] - place[k]) / period).round(),
        })
    }

    /// The image of a place in the first period, and others of it that lie no further beyond that than `margin` [m],
    /// which is less than half a period.
    pub(super) fn images(&self, place: Vector<f64, D>, margin: f64) -> Vec<Vector<f64, D>> {
        let first = Vector::from_fn(|k| match self.0[k] {
            0.0 => place[k],
            period => place[k] - period * (place[k] / period).floor(),
        });
        let mut all = vec![first];
        for k in (0..D).filter(|&k| self.0[k] > 0.0) {
            let period = self.0[k];
            let way = if first[k] <= margin {
                period
            } else if first[k] >= period - margin {
                -period
            } else {
                continue;
            };
            for image in 0..all.len() {
                let mut next = all[image];
                next[k] += way;
                all.push(next);
            }
        }
        all
    }

    /// Whether a box and an image of another one overlap.
    pub(super) fn overlap(&self, a: &[Vector<f64, D>; 2], b: &[Vector<f64, D>; 2]) -> bool {
        (0..D).all(|k| match self.0[k] {
            0.0 => a[0][k] <= b[1][k] && b[0][k] <= a[1][k],
            // A whole number n of periods with a_0 + n L <= b_1 and b_0 <= a_1 + n L.
            period => ((b[0][k] - a[1][k]) / period).ceil() <= ((b[1][k] - a[0][k]) / period).floor(),
        })
    }

    /// Whether a box is as long as a period: what it holds may reach an image of its own.
    pub(super) fn is_long(&self, [low, high]: &[Vector<f64, D>; 2]) -> bool {
        (0..D).any(|k| self.0[k] > 0.0 && high[k] - low[k] >= self.0[k])
    }

    /// The parts of the first axis that a box takes, and an image of it, as far as these reach into the first period.
    pub(super) fn along_first(&self, [low, high]: &[Vector<f64, D>; 2]) -> Vec<[f64; 2]> {
        let (low, high, period) = (low[0], high[0], self.0[0]);
        if period == 0.0 {
            return vec![[low, high]];
        }
        let length = high - low;
        if length.is_nan() || length >= period {
            return vec![[f64::NEG_INFINITY, f64::INFINITY]];
        }
        let low = low - period * (low / period).floor();
        let mut parts = vec![[low, low + length]];
        if low + length >= period {
            parts.push([low - period, low + length - period]);
        }
        parts
    }
}

/// Pairs of boxes of which one overlaps the other or an image of it, the first by its lower number: by a sweep along
/// the first axis.
pub(super) fn pairs<const D: usize>(
    boxes: &[[Vector<f64, D>; 2]],
    lengths: PeriodLengths<D>,
) -> Vec<[usize; 2]> {
    let parts = |(a, bounds)| lengths.along_first(bounds).into_iter().map(move |part| (part, a));
    let mut order: Vec<([f64; 2], usize)> = boxes.iter().enumerate().flat_map(parts).collect();
    order.sort_by(|(one, a), (other, b)| one[0].total_cmp(&other[0]).then(a.cmp(b)));
    let mut found = Vec::new();
    for (place, &([_, end], a)) in order.iter().enumerate() {
        for &(_, b) in order[place + 1..].iter().take_while(|([begin, _], _)| *begin <= end) {
            if a != b && lengths.overlap(&boxes[a], &boxes[b]) {
                found.push([a.min(b), a.max(b)]);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_overlap_through_faces_as_all_their_images_do() {
        let lengths = PeriodLengths(Vector([4.0, 0.0]));
        let boxed = |x: f64, y: f64, side: f64| [Vector([x, y]), Vector([x + side, y + 1.0])];
        // A sequence of fractions that fills the plane evenly.
        let fraction = |n: usize, step: f64| (n as f64 * step).fract();
        let boxes: Vec<_> = (0..60)
            .map(|n| {
                boxed(24.0 * fraction(n, 0.618) - 12.0, 9.0 * fraction(n, 0.755), 0.3 + fraction(n, 0.57))
            })
            .chain([boxed(-7.0, 3.0, 4.5)])
            .collect();
        let plain = PeriodLengths::default();
        let meet = |a: usize, b: usize| {
            (-8..=8).any(|n| {
                let moved = boxes[b].map(|corner| corner + Vector([4.0 * f64::from(n), 0.0]));
                plain.overlap(&boxes[a], &moved)
            })
        };
        let all = (0..boxes.len()).flat_map(|a| (a + 1..boxes.len()).map(move |b| [a, b]));
        let naive: Vec<_> = all.filter(|&[a, b]| meet(a, b)).collect();
        assert!(naive.len() > 100 && naive.len() < 1200, "{}", naive.len());
        assert_eq!(pairs(&boxes, lengths), naive);
        assert!(pairs(&boxes, plain).len() < naive.len() / 2);
        let long: Vec<bool> = boxes.iter().map(|bounds| lengths.is_long(bounds)).collect();
        assert_eq!(long.iter().position(|&long| long), Some(60));
    }

    #[test]
    fn images_lie_about_the_first_period() {
        let lengths = PeriodLengths(Vector([4.0, 5.0]));
        let rounded = |at: Vector<f64, 2>| at.0.map(|x| (x * 1e9).round() / 1e9);
        let images = |x: f64, y: f64| lengths.images(Vector([x, y]), 0.5).into_iter().map(rounded);
        assert_eq!(images(-2.0, 12.0).collect::<Vec<_>>(), [[2.0, 2.0]]);
        assert_eq!(
            images(-0.2, 15.2).collect::<Vec<_>>(),
            [[3.8, 0.2], [-0.2, 0.2], [3.8, 5.2], [-0.2, 5.2]]
        );
        assert_eq!(lengths.away(Vector([0.2, 1.0]), Vector([15.9, -4.1])).0, [16.0, -5.0]);
    }
}
