//! What light needs of bodies, wherever their particles are.

use crate::door::{ParticleSnapshot, ParticleView};
use serde::{Deserialize, Serialize};

/// What light needs of a particle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeenParticle {
    /// Place in the plane [m].
    pub place: [f64; 2],
    /// Cauchy stress xx, yy, xy [Pa].
    pub stress: [f64; 3],
    /// [m^3]
    pub volume: f64,
    /// [kg]
    pub mass: f64,
}

impl From<&ParticleView> for SeenParticle {
    fn from(particle: &ParticleView) -> Self {
        let &ParticleView { mass, volume, position: [x, y, _], stress: [xx, yy, _, xy, ..], .. } = particle;
        SeenParticle { place: [x, y], stress: [xx, yy, xy], volume, mass }
    }
}

/// A body as light sees it; it has particles.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenBody {
    /// Index of the body.
    pub body: usize,
    /// Of space, 2 or 3.
    pub dimension: usize,
    /// All its particles, by number.
    pub particles: Vec<SeenParticle>,
}

impl SeenBody {
    /// Those bodies of a snapshot that are wanted and have particles, one after the other.
    pub fn each(
        snapshot: &ParticleSnapshot,
        wanted: impl Fn(usize) -> bool,
    ) -> impl Iterator<Item = SeenBody> {
        let mut start = 0;
        let groups = snapshot.body.chunk_by(|a, b| a == b).map(move |group| {
            let range = start..start + group.len();
            start = range.end;
            (group[0] as usize, range)
        });
        groups.filter(move |(body, _)| wanted(*body)).map(|(body, range)| {
            let particle = |i: usize| {
                let ([x, y, _], [xx, yy, _, xy, ..]) = (snapshot.position[i], snapshot.stress[i]);
                SeenParticle {
                    place: [x, y],
                    stress: [xx, yy, xy],
                    volume: snapshot.volume[i],
                    mass: snapshot.mass[i],
                }
            };
            SeenBody { body, dimension: snapshot.dimension, particles: range.map(particle).collect() }
        })
    }
}
