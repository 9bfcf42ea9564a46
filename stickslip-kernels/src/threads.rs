//! Loops over threads.
//!
//! Work is called through a pointer, part by part: one compiled loop serves all work, in every precision and dimension.
//! No result may depend on which thread does a part, nor on the order in which parts are done.

use crate::grid::Disjoint;
use rayon::prelude::*;
use std::ops::Range;

/// Does the parts of `0..count` side by side, each `size` long but for the last.
pub fn each_range(count: usize, size: usize, work: &(dyn Fn(Range<usize>) + Sync)) {
    if count <= size {
        if count > 0 {
            work(0..count);
        }
        return;
    }
    let part = |part: usize| work(part * size..count.min((part + 1) * size));
    (0..count.div_ceil(size)).into_par_iter().for_each(part);
}

/// Does something to every entry of a slice, `size` of them one after the other; `work` is told each entry's index.
#[inline]
pub fn each<X: Send>(entries: &mut [X], size: usize, work: impl Fn(usize, &mut X) + Sync) {
    let count = entries.len();
    let entries = Disjoint::new(entries);
    each_range(count, size, &|range| {
        for i in range {
            // SAFETY: every index lies in one range.
            work(i, unsafe { entries.get(i) });
        }
    });
}

/// The same to those entries whose places are listed, which ascend.
#[inline]
pub fn each_of<X: Send>(entries: &mut [X], places: &[u32], size: usize, work: impl Fn(usize, &mut X) + Sync) {
    assert!(places.is_sorted_by(|a, b| a < b), "every place is listed once");
    let entries = Disjoint::new(entries);
    each_range(places.len(), size, &|range| {
        for &place in &places[range] {
            // SAFETY: every place is listed once, and lies in one range.
            work(place as usize, unsafe { entries.get(place as usize) });
        }
    });
}

/// What comes of the parts of `0..count`, in their order.
pub fn by_parts<R: Default + Clone + Send>(
    count: usize,
    size: usize,
    work: impl Fn(Range<usize>) -> R + Sync,
) -> Vec<R> {
    let mut results = vec![R::default(); count.div_ceil(size)];
    each(&mut results, 1, |part, result| *result = work(part * size..count.min((part + 1) * size)));
    results
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn every_index_lies_in_one_part() {
        for (count, size) in [(0, 3), (1, 3), (3, 3), (1000, 7)] {
            let seen = Mutex::new(vec![0; count]);
            each_range(count, size, &|range| {
                assert!(range.len() <= size && !range.is_empty());
                range.for_each(|i| seen.lock().unwrap()[i] += 1);
            });
            assert_eq!(seen.into_inner().unwrap(), vec![1; count]);
            let mut entries = vec![0; count];
            each(&mut entries, size, |i, entry| *entry += i);
            assert_eq!(entries, (0..count).collect::<Vec<_>>());
            let odd: Vec<u32> = (0..count as u32).filter(|place| place % 2 == 1).collect();
            each_of(&mut entries, &odd, size, |i, entry| *entry -= i);
            assert_eq!(entries, (0..count).map(|i| if i % 2 == 1 { 0 } else { i }).collect::<Vec<_>>());
            let sums = by_parts(count, size, |range| range.sum::<usize>());
            assert_eq!(sums.iter().sum::<usize>(), (0..count).sum::<usize>());
        }
    }
}
