//! A grid that repeats: blocks a period apart are one.

/// After how many blocks the grid repeats along each axis; 0 where it does not.
///
/// Particles have places without end, and so have their home blocks; the nodes of a block are those of its image in the
/// first period. A tile sees its nodes where it is itself, so no distance between a particle and a node knows of
/// periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Periods<const D: usize>(pub [i32; D]);

impl<const D: usize> Default for Periods<D> {
    fn default() -> Self {
        Periods([0; D])
    }
}

impl<const D: usize> Periods<D> {
    /// Whether the grid repeats at all.
    pub fn any(&self) -> bool {
        self.0 != [0; D]
    }

    /// The image of a block in the first period.
    #[inline]
    pub fn wrapped(&self, block: [i32; D]) -> [i32; D] {
        std::array::from_fn(|i| if self.0[i] == 0 { block[i] } else { block[i].rem_euclid(self.0[i]) })
    }

    /// Colour of a block of the first period: blocks of one colour are not neighbours, around the faces neither.
    pub fn color(&self, block: [i32; D]) -> usize {
        (0..D).fold(0, |color, i| {
            let last_of_odd = self.0[i] % 2 == 1 && block[i] == self.0[i] - 1;
            3 * color + if last_of_odd { 2 } else { (block[i] & 1) as usize }
        })
    }
}
