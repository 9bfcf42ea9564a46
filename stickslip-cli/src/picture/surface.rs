//! Which particles lie at the surface of their body, and which way it faces there.

use super::camera::Point;
use super::grains::Grain;
use rayon::prelude::*;
use std::collections::HashMap;
use stickslip::tensor::Vector;

/// A particle at the surface as a ball that reaches to the surface and hides what lies behind.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// Centre [m].
    pub center: Point,
    /// Radius [m].
    pub radius: f64,
    /// Outward unit normal of the body's surface; zero for a particle that stands alone.
    pub normal: Point,
    /// Which grain it is.
    pub grain: usize,
}

/// Reach of the sum over neighbours, in sides of a particle.
const REACH: f64 = 2.6;
/// A ball of this radius, in sides, on a cubic lattice lets no light through a face of the lattice.
pub const COVERING: f64 = 0.74;
/// Length of the mean offset to the neighbours, in sides, over which a particle counts as one of the surface;
/// at a flat face it is 0.8 in the first layer and 0.3 in the second, inside it is 0.
const EXPOSED: f64 = 0.16;

type SurfaceCell = (u32, [i32; 3]);

/// The surface of all bodies.
///
/// ```text
/// offset = sum_q w_q (x_q - x_p) / sum_q w_q,   w = (1 - |x_q - x_p|^2 / reach^2)      n = -offset / |offset|
/// ```
/// over the particles q of the same body within reach of p: the body lies where the offset points.
pub fn surface(grains: &[Grain]) -> Vec<Ball> {
    let reach = REACH * grains.iter().map(|grain| grain.size()).fold(0.0, f64::max);
    let cell = |grain: &Grain| grain.position.map(|x| (x / reach).floor() as i32);
    let mut cells: HashMap<SurfaceCell, Vec<u32>> = HashMap::new();
    for (i, grain) in grains.iter().enumerate() {
        cells.entry((grain.body, cell(grain))).or_default().push(i as u32);
    }
    let ball = |(i, grain): (usize, &Grain)| {
        let side = grain.size();
        let offset = mean_offset(grains, &cells, (i, cell(grain)));
        let exposure = offset.norm() / side;
        if exposure < EXPOSED && exposure > 0.0 {
            return None;
        }
        let normal = (-offset).direction().unwrap_or(Vector::ZERO);
        // The ball is wider than its particle; drawn back, its front stays where the surface is.
        let center = Vector(grain.position) - normal * ((COVERING - 0.5) * side);
        Some(Ball { center, radius: COVERING * side, normal, grain: i })
    };
    grains.par_iter().enumerate().filter_map(ball).collect()
}

fn mean_offset(
    grains: &[Grain],
    cells: &HashMap<SurfaceCell, Vec<u32>>,
    (i, home): (usize, [i32; 3]),
) -> Point {
    let grain = &grains[i];
    let reach = REACH * grain.size();
    let (mut sum, mut weights) = (Vector::ZERO, 0.0);
    for neighbour in 0..27 {
        let place = [0, 1, 2].map(|axis| home[axis] + neighbour / 3i32.pow(axis as u32) % 3 - 1);
        for &j in cells.get(&(grain.body, place)).into_iter().flatten() {
            let offset = Vector(grains[j as usize].position) - Vector(grain.position);
            let weight = 1.0 - offset.dot(offset) / (reach * reach);
            if weight > 0.0 {
                sum += offset * weight;
                weights += weight;
            }
        }
    }
    sum / weights
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn normals_of_a_sphere_point_outwards_and_its_inside_is_left_out() {
        let grains = sample::ball([0.0; 3], 1.0, 0.125);
        let balls = surface(&grains);
        assert!(balls.len() < grains.len() / 2 + 200, "{} of {}", balls.len(), grains.len());
        for ball in &balls {
            let outwards = ball.center.direction().unwrap();
            assert!(outwards.dot(ball.normal) > 0.8, "{:?}", ball.center);
        }
        let outermost = grains.iter().enumerate().filter(|(_, g)| Vector(g.position).norm() > 0.9);
        let drawn: std::collections::HashSet<usize> = balls.iter().map(|ball| ball.grain).collect();
        assert!(outermost.into_iter().all(|(i, _)| drawn.contains(&i)));
    }

    #[test]
    fn a_particle_alone_is_drawn() {
        let grains = sample::ball([0.0; 3], 0.1, 0.15);
        assert_eq!(surface(&grains).len(), grains.len());
    }
}
