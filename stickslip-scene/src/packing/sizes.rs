//! How the sizes of grains vary.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Sizes of grains over that of the grain that is given [-].
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// All of this size.
    One(f64),
    /// Each size between two as likely.
    Uniform(f64, f64),
    /// Normal, by mean and standard deviation; drawn again beyond three of those.
    Normal(f64, f64),
    /// The logarithm normal, by the median size and the standard deviation of the logarithm; drawn again beyond three
    /// of those.
    LogNormal(f64, f64),
    /// Some sizes, each with its share in the number of grains.
    Numbers(Vec<[f64; 2]>),
    /// Some sizes, each with its share in the volume of all grains, as sieves have it.
    Volumes(Vec<[f64; 2]>),
}

/// Deviations beyond which a size is drawn again.
const TAIL: f64 = 3.0;

impl Sizes {
    /// A size.
    pub fn draw(&self, dimension: usize, random: &mut ChaCha8Rng) -> f64 {
        match self {
            Sizes::One(size) => *size,
            Sizes::Uniform(low, high) => low + (high - low) * random.random::<f64>(),
            Sizes::Normal(mean, deviation) => mean + deviation * within_tail(random),
            Sizes::LogNormal(median, deviation) => median * libm::exp(deviation * within_tail(random)),
            Sizes::Numbers(shares) => pick(shares, |share| share[1], random),
            Sizes::Volumes(shares) => {
                pick(shares, |share| share[1] / share[0].powi(dimension as i32), random)
            }
        }
    }

    /// Smallest and largest size.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Sizes::One(size) => [*size; 2],
            Sizes::Uniform(low, high) => [*low, *high],
            Sizes::Normal(mean, deviation) => [mean - TAIL * deviation, mean + TAIL * deviation],
            Sizes::LogNormal(median, deviation) => [-TAIL, TAIL].map(|by| median * libm::exp(by * deviation)),
            Sizes::Numbers(shares) | Sizes::Volumes(shares) => shares
                .iter()
                .fold([f64::INFINITY, 0.0], |[low, high], [size, _]| [low.min(*size), high.max(*size)]),
        }
    }
}

/// A number of the standard normal distribution, drawn again in its tails.
fn within_tail(random: &mut ChaCha8Rng) -> f64 {
    loop {
        let drawn: f64 = random.sample(StandardNormal);
        if drawn.abs() <= TAIL {
            return drawn;
        }
    }
}

/// One of some sizes, as likely as its weight.
fn pick(shares: &[[f64; 2]], weight: impl Fn(&[f64; 2]) -> f64, random: &mut ChaCha8Rng) -> f64 {
    let mut left = shares.iter().map(&weight).sum::<f64>() * random.random::<f64>();
    let chosen = shares.iter().find(|share| {
        left -= weight(share);
        left <= 0.0
    });
    chosen.or(shares.last()).map_or(1.0, |share| share[0])
}
