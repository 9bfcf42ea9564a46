//! Particles as a picture shows them: place, size, shape and colour, with mirror images where the user wants them.

use super::Rgb;
use super::quantity::determinant;
use super::setting::{Setting, SymmetryPlane};
use crate::drawing::{body_color, shaded};
use std::collections::HashMap;
use stickslip::door::ParticleSnapshot;

/// One particle of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Index of the body.
    pub body: u32,
    /// Centre [m].
    pub position: [f64; 3],
    /// Side of the undeformed square or cube [m].
    pub side: f64,
    /// Deformation gradient, row by row [-].
    pub deformation: [f64; 9],
    /// Its colour before light falls on it.
    pub color: Rgb,
}

impl Grain {
    /// Side of the cube of its present volume [m].
    pub fn size(&self) -> f64 {
        self.side * determinant(&self.deformation).max(1e-6).cbrt()
    }
}

/// Paler quarters of round bodies, told by where each particle was at the start.
pub type Quarters = HashMap<(u32, u32), bool>;

/// The particles of a snapshot, each in its colour.
pub fn grains(particles: &ParticleSnapshot, colors: &[Rgb]) -> Vec<Grain> {
    let count = particles.body.len();
    (0..count)
        .map(|i| {
            let deformation = particles.deformation[i];
            let undeformed = particles.volume[i] / determinant(&deformation).max(1e-6);
            let side = if particles.dimension == 2 { undeformed.sqrt() } else { undeformed.cbrt() };
            Grain {
                body: particles.body[i],
                position: particles.position[i],
                side,
                deformation,
                color: colors[i],
            }
        })
        .collect()
}

/// The colour of each particle's body, paler in every other quarter of a round one.
pub fn quartered(particles: &ParticleSnapshot, quarters: &Quarters) -> Vec<Rgb> {
    let color = |(&body, &number): (&u32, &u32)| {
        let color = body_color(body as usize);
        if quarters.get(&(body, number)) == Some(&true) { shaded(color, 1.6) } else { color }
    };
    particles.body.iter().zip(&particles.number).map(color).collect()
}

/// Divides round bodies into quarters (eighths in space) by the positions in the first snapshot of a run.
pub fn quarters(first: &ParticleSnapshot, setting: &Setting) -> Quarters {
    let dark = |i: usize| {
        let center = (*setting.round.get(first.body[i] as usize)?)?;
        let x = first.position[i];
        let negative = (0..first.dimension).filter(|&axis| x[axis] < center[axis]).count();
        Some(((first.body[i], first.number[i]), negative % 2 == 1))
    };
    (0..first.body.len()).filter_map(dark).collect()
}

/// Adds the mirror image of every grain.
pub fn mirrored(mut grains: Vec<Grain>, mirror: SymmetryPlane) -> Vec<Grain> {
    let SymmetryPlane { axis, position } = mirror;
    let image = |grain: &Grain| {
        let mut image = *grain;
        image.position[axis] = 2.0 * position - grain.position[axis];
        for i in (0..3).filter(|&i| i != axis) {
            image.deformation[3 * i + axis] = -grain.deformation[3 * i + axis];
            image.deformation[3 * axis + i] = -grain.deformation[3 * axis + i];
        }
        image
    };
    let images: Vec<Grain> = grains.iter().map(image).collect();
    grains.extend(images);
    grains
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_image_of_shear_shears_the_other_way() {
        let grain = Grain {
            body: 0,
            position: [1.0, 2.0, 3.0],
            side: 0.1,
            deformation: [1.0, 0.3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            color: [0.0; 3],
        };
        let both = mirrored(vec![grain], SymmetryPlane { axis: 1, position: 0.5 });
        assert_eq!(both[1].position, [1.0, -1.0, 3.0]);
        assert_eq!(both[1].deformation[1], -0.3);
        assert_eq!(both[1].deformation[0], 1.0);
    }
}
