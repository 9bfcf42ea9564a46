//! Which rank owns which block.

/// Parts of space, one a rank, by recursive bisection (Berger and Bokhari 1987): ranks are halved, and space with them
/// by a plane across its longest side, so that both halves have their share of the load; where the plane would cut
/// through a layer of blocks, the next axes decide within that. Parts are compact, and their surfaces small.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Partition {
    /// How many ranks.
    ranks: usize,
    /// Where ranks are halved: of all, then of the first half, and behind that of the second.
    cuts: Vec<Cut>,
}

/// Blocks on one side of it belong to the first half of some ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cut {
    axis: usize,
    /// The first block on the other side, seen from the axis.
    from: [i32; 3],
}

/// The longest side may be so much longer before another axis than that of an earlier partition is cut: particles would
/// have to move house for little.
const LONGER: f64 = 1.25;

impl Partition {
    /// Parts with about the same load each, of blocks that have a load, in any order; cut along the same axes as an
    /// earlier partition where these are nearly as good.
    pub fn balanced<const D: usize>(
        ranks: usize,
        before: Option<&Partition>,
        loads: impl IntoIterator<Item = ([i32; D], u64)>,
    ) -> Self {
        let mut loads: Vec<([i32; D], u64)> = loads.into_iter().collect();
        let mut partition = Partition { ranks, cuts: Vec::new() };
        partition.halve(ranks, before.filter(|before| before.ranks == ranks), &mut loads);
        partition
    }

    fn halve<const D: usize>(
        &mut self,
        ranks: usize,
        before: Option<&Partition>,
        loads: &mut [([i32; D], u64)],
    ) {
        if ranks < 2 {
            return;
        }
        let length = |axis: usize| {
            let places = loads.iter().map(|(block, _)| i64::from(block[axis]));
            let ends = places.clone().min().zip(places.max());
            ends.map_or(0.0, |(first, last)| (last - first + 1) as f64)
        };
        let lengths: [f64; D] = std::array::from_fn(length);
        let longest = (0..D).fold(0, |a, b| if lengths[b] > lengths[a] { b } else { a });
        let usual = before.map(|before| before.cuts[self.cuts.len()].axis);
        let axis = usual.filter(|&usual| LONGER * lengths[usual] >= lengths[longest]).unwrap_or(longest);
        loads.sort_unstable_by_key(|(block, _)| seen_from(axis, *block));
        let whole: u64 = loads.iter().map(|(_, load)| load).sum();
        let first = ranks / 2;
        let wanted = whole as f64 * first as f64 / ranks as f64;
        // The place between two blocks at which the load before it is nearest to that.
        let (mut best, mut off, mut sum) = (0, wanted, 0);
        for (i, (block, load)) in loads.iter().enumerate() {
            sum += load;
            let ends = loads.get(i + 1).is_none_or(|(next, _)| next != block);
            if ends && (sum as f64 - wanted).abs() < off {
                (best, off) = (i + 1, (sum as f64 - wanted).abs());
            }
        }
        let from = loads.get(best).map_or([i32::MAX; 3], |(block, _)| seen_from(axis, *block));
        self.cuts.push(Cut { axis, from });
        let (one, other) = loads.split_at_mut(best);
        self.halve(first, before, one);
        self.halve(ranks - first, before, other);
    }

    /// The rank that owns a block.
    pub fn owner<const D: usize>(&self, block: [i32; D]) -> usize {
        let (mut rank, mut count, mut cut) = (0, self.ranks, 0);
        while count > 1 {
            let first = count / 2;
            let Cut { axis, from } = self.cuts[cut];
            cut += 1;
            if seen_from(axis, block) < from {
                count = first;
            } else {
                // Behind the cuts of the first half.
                (rank, count, cut) = (rank + first, count - first, cut + first - 1);
            }
        }
        rank
    }
}

/// A block's place along an axis, and then along the others.
fn seen_from<const D: usize>(axis: usize, block: [i32; D]) -> [i32; 3] {
    std::array::from_fn(|k| if k < D { block[(axis + k) % D] } else { 0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 16 x 16 blocks: four ranks have a square of them each, and three a third.
    #[test]
    fn loads_are_balanced() {
        let blocks = (0..16).flat_map(|x| (0..16).map(move |y| ([x, y], 3_u64)));
        let partition = Partition::balanced(4, None, blocks.clone());
        for x in 0..16 {
            for y in 0..16 {
                assert_eq!(partition.owner([x, y]), (x / 8 * 2 + y / 8) as usize, "{x} {y}");
            }
        }
        let three = Partition::balanced(3, None, blocks.clone());
        let counts: Vec<usize> = (0..3)
            .map(|rank| blocks.clone().filter(|(block, _)| three.owner(*block) == rank).count())
            .collect();
        assert!(counts.iter().all(|count| count.abs_diff(85) <= 1), "{counts:?}");
    }

    /// Several bodies have a load at the same block, which one rank owns.
    #[test]
    fn a_block_is_not_cut() {
        let twice = (0..7).flat_map(|z| [([0, 0, z], 1), ([0, 0, z], 2)]);
        let partition = Partition::balanced(2, None, twice);
        let owners: Vec<usize> = (0..7).map(|z| partition.owner([0, 0, z])).collect();
        assert!(owners.is_sorted() && owners[2] == 0 && owners[4] == 1, "{owners:?}");
    }

    /// A part that becomes a little longer along another axis is cut as before, and along that once it is much longer.
    #[test]
    fn axes_stay() {
        let blocks = |x: i32, y: i32| (0..x).flat_map(move |x| (0..y).map(move |y| ([x, y], 1)));
        let first = Partition::balanced(2, None, blocks(11, 10));
        assert_eq!(first.cuts[0].axis, 0);
        let next = |x, y| Partition::balanced(2, Some(&first), blocks(x, y)).cuts[0].axis;
        assert_eq!([next(10, 12), next(10, 13)], [0, 1]);
    }

    /// Where there are fewer blocks than ranks, some have nothing; every block has an owner.
    #[test]
    fn more_ranks_than_blocks() {
        let partition = Partition::balanced(5, None, [([0, 0, 0], 1), ([0, 0, 9], 1)]);
        assert!(partition.owner([0, 0, 0]) < partition.owner([0, 0, 9]));
        assert!(partition.owner([0, 0, 9]) < 5 && partition.owner([-9, 3, 7]) < 5);
        assert_eq!(Partition::balanced::<3>(1, None, []).owner([4, 5, 6]), 0);
        assert!(Partition::balanced::<3>(4, None, []).owner([4, 5, 6]) < 4);
    }
}
