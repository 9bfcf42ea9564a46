//! Pairs of boxes that meet.

use crate::geometry::Bounds;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Pairs `[i, j]`, i < j, of boxes at most `margin` [m] apart along every axis, in order.
///
/// By an R-tree: n log n in the number of boxes, however they lie and however their sizes differ. Those that are
/// endless are near to all others, and not to each other.
pub(super) fn pairs_within(boxes: &[Bounds], margin: f64) -> Vec<[usize; 2]> {
    let (finite, endless): (Vec<usize>, Vec<usize>) = (0..boxes.len()).partition(|&i| boxes[i].is_finite());
    let leaf =
        |(i, bounds): (usize, &Bounds)| GeomWithData::new(Rectangle::from_corners(bounds.min, bounds.max), i);
    let tree = RTree::bulk_load(finite.iter().map(|&i| (i, &boxes[i])).map(leaf).collect());
    let mut pairs = Vec::new();
    for &i in &finite {
        pairs.extend(endless.iter().map(|&j| [i.min(j), i.max(j)]));
        let bounds = &boxes[i];
        let around = bounds.grown(margin);
        let near = tree.locate_in_envelope_intersecting(AABB::from_corners(around.min, around.max));
        pairs.extend(near.map(|leaf| leaf.data).filter(|&j| i < j).map(|j| [i, j]));
    }
    pairs.sort_unstable();
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_endless_is_near_to_all_but_the_endless() {
        let at = |x: f64| Bounds { min: [x; 3], max: [x + 1.0; 3] };
        let boxes = [Bounds::EVERYTHING, at(0.0), at(5.0), Bounds::EVERYTHING];
        assert_eq!(pairs_within(&boxes, 0.1), [[0, 1], [0, 2], [1, 3], [2, 3]]);
    }

    proptest! {
        #[test]
        fn finds_what_the_naive_loop_finds(
            boxes in prop::collection::vec((prop::array::uniform3(-5.0..5.0f64), prop::array::uniform3(0.0..3.0f64)), 1..40),
            margin in 0.0..1.0f64,
        ) {
            let boxes: Vec<_> = boxes
                .into_iter()
                .map(|(min, size)| Bounds { min, max: std::array::from_fn(|k| min[k] + size[k]) })
                .collect();
            let mut naive = vec![];
            for i in 0..boxes.len() {
                for j in i + 1..boxes.len() {
                    if !boxes[i].grown(margin).intersected(&boxes[j]).is_empty() {
                        naive.push([i, j]);
                    }
                }
            }
            prop_assert_eq!(pairs_within(&boxes, margin), naive);
        }
    }
}
