//! Which rank owns which block.

/// Bits of a block's place along each axis that the curve follows.
const BITS: u32 = 21;

/// Half of the places along an axis.
const REACH: i32 = 1 << (BITS - 1);

/// Stretches of a space-filling curve through the blocks, one a rank.
///
/// The curve is Morton's: bits of the places along the axes by turns. Blocks that are near on it are near in space, and
/// a stretch of it is a part of space with a small surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Partition {
    /// Where the stretches of all ranks but the first begin, ascending.
    starts: Vec<u64>,
}

impl Partition {
    /// Stretches with about the same load each, of blocks that have a load, in any order.
    pub fn balanced<const D: usize>(ranks: usize, loads: impl IntoIterator<Item = ([i32; D], u64)>) -> Self {
        let mut along: Vec<(u64, u64)> =
            loads.into_iter().map(|(block, load)| (place_on_curve(block), load)).collect();
        along.sort_unstable();
        let whole: u64 = along.iter().map(|(_, load)| load).sum();
        let (mut starts, mut before) = (Vec::new(), 0);
        for (place, load) in along {
            // A block belongs to the stretch in which its middle lies.
            let stretch = ((2 * before + load) * ranks as u64 / (2 * whole).max(1)).min(ranks as u64 - 1);
            while (starts.len() as u64) < stretch {
                starts.push(place);
            }
            before += load;
        }
        starts.resize(ranks - 1, u64::MAX);
        Partition { starts }
    }

    /// The rank that owns a block.
    pub fn owner<const D: usize>(&self, block: [i32; D]) -> usize {
        let place = place_on_curve(block);
        self.starts.partition_point(|&start| start <= place)
    }
}

/// A block's place on the curve.
fn place_on_curve<const D: usize>(block: [i32; D]) -> u64 {
    let mut place = 0;
    for bit in (0..BITS).rev() {
        for along in block {
            let along = along.clamp(-REACH, REACH - 1) + REACH;
            place = place << 1 | u64::from(along as u32 >> bit & 1);
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 16 x 16 blocks: ranks have a quarter each, and a square of them.
    #[test]
    fn loads_are_balanced() {
        let blocks = (0..16).flat_map(|x| (0..16).map(move |y| ([x, y], 3_u64)));
        let partition = Partition::balanced(4, blocks.clone());
        for x in 0..16 {
            for y in 0..16 {
                assert_eq!(partition.owner([x, y]), (x / 8 * 2 + y / 8) as usize, "{x} {y}");
            }
        }
        let three = Partition::balanced(3, blocks.clone());
        let counts: Vec<usize> = (0..3)
            .map(|rank| blocks.clone().filter(|(block, _)| three.owner(*block) == rank).count())
            .collect();
        assert!(counts.iter().all(|count| count.abs_diff(85) <= 1), "{counts:?}");
    }

    /// Where there are fewer blocks than ranks, some have nothing; every block has an owner.
    #[test]
    fn more_ranks_than_blocks() {
        let partition = Partition::balanced(5, [([0, 0, 0], 1), ([0, 0, 9], 1)]);
        assert!(partition.owner([0, 0, 0]) < partition.owner([0, 0, 9]));
        assert!(partition.owner([0, 0, 9]) < 5 && partition.owner([-9, 3, 7]) < 5);
        assert_eq!(Partition::balanced::<3>(1, []).owner([4, 5, 6]), 0);
    }
}
