//! Bodies made of grains for tests of the pictures.

use super::Grain;
use super::grains::grains;
use crate::drawing::body_color;
use stickslip::door::ParticleSnapshot;
use stickslip::scene::Scene;

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A ball on a cubic lattice that has a point at the centre plus half a side.
pub fn ball(center: [f64; 3], radius: f64, side: f64) -> Vec<Grain> {
    let inside = |x: &[f64; 3]| (0..3).map(|i| (x[i] - center[i]).powi(2)).sum::<f64>() < radius * radius;
    let points = lattice(center.map(|c| [c - radius, c + radius]), side).into_iter().filter(inside);
    points.map(|position| grain(0, position, side)).collect()
}

fn grain(body: u32, position: [f64; 3], side: f64) -> Grain {
    Grain { body, position, side, deformation: IDENTITY, color: body_color(body as usize) }
}

fn lattice(ranges: [[f64; 2]; 3], side: f64) -> Vec<[f64; 3]> {
    let along = |[low, high]: [f64; 2]| {
        let count = ((high - low) / side).round().max(1.0) as usize;
        (0..count).map(move |i| low + (i as f64 + 0.5) * side)
    };
    let mut points = Vec::new();
    for x in along(ranges[0]) {
        for y in along(ranges[1]) {
            points.extend(along(ranges[2]).map(|z| [x, y, z]));
        }
    }
    points
}

/// A ball (or disk) of radius 1 on a slab, moving along x, with a stress that fades from where they touch.
pub fn ball_on_slab(dimension: usize, side: f64) -> ParticleSnapshot {
    let up = dimension - 1;
    let mut center = [-1.0, 0.0, 0.0];
    center[up] = 1.0;
    let mut slab = [[-3.0, 3.0], [-2.0, 2.0], [-0.5 * side, 0.5 * side]];
    slab[up] = [-0.5, 0.0];
    let flat = |x: &[f64; 3]| dimension == 3 || x[2].abs() < 0.6 * side;
    let ball = ball(center, 1.0, side).into_iter().filter(|grain| flat(&grain.position) || dimension == 3);
    let mut disk: Vec<Grain> = ball.collect();
    if dimension == 2 {
        disk.retain(|grain| grain.position[2] > 0.0);
    }
    let slab = lattice(slab, side).into_iter().map(|position| grain(1, position, side));
    let mut snapshot = ParticleSnapshot { dimension, ..ParticleSnapshot::default() };
    for (number, grain) in disk.into_iter().chain(slab).enumerate() {
        let mut position = grain.position;
        if dimension == 2 {
            position[2] = 0.0;
        }
        let height = position[up] - center[up];
        let distance = (0..3).map(|i| position[i] - if i == up { 0.0 } else { center[i] });
        let fade = (-4.0 * distance.map(|d| d * d).sum::<f64>()).exp();
        let first = f64::from(u8::from(grain.body == 0));
        let mut velocity = [first * (2.0 + 2.0 * height), 0.0, 0.0];
        velocity[up] = first * -2.0 * (position[0] - center[0]);
        snapshot.body.push(grain.body);
        snapshot.number.push(number as u32);
        snapshot.position.push(position);
        snapshot.velocity.push(velocity);
        snapshot.mass.push(1.0);
        snapshot.volume.push(side.powi(dimension as i32));
        snapshot.stress.push([-2e4 * fade, -2e4 * fade, -6e4 * fade, 1e4 * fade, 0.0, 0.0]);
        snapshot.deformation.push(IDENTITY);
    }
    snapshot
}

/// Bodies of one rubber in the plane, of cells of 0.1 m and with other keys of `space`: the scene, and its particles at
/// the start.
pub fn rubber(space: &str, bodies: &str) -> (Scene, ParticleSnapshot) {
    let text = format!(
        "space = {{ dimension = 'plane-strain', cell = 0.1, {space} }}\n\
         time.end = 1\n\
         materials.rubber = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}\n\
         {bodies}"
    );
    let scene = stickslip::scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let simulation = stickslip::step::build(&scene).unwrap_or_else(|problem| panic!("{problem:?}"));
    let first = simulation.snapshot();
    (scene, first)
}

/// The particles as they are after a deformation gradient in the plane, row by row, about the origin.
pub fn deformed(particles: &ParticleSnapshot, [a, b, c, d]: [f64; 4]) -> ParticleSnapshot {
    let mut deformed = particles.clone();
    for x in &mut deformed.position {
        *x = [a * x[0] + b * x[1], c * x[0] + d * x[1], 0.0];
    }
    deformed.deformation.fill([a, b, 0.0, c, d, 0.0, 0.0, 0.0, 1.0]);
    deformed.volume.iter_mut().for_each(|volume| *volume *= a * d - b * c);
    deformed
}

/// The particles in the colours of their bodies.
pub fn colored(particles: &ParticleSnapshot) -> Vec<Grain> {
    let colors: Vec<_> = particles.body.iter().map(|body| body_color(*body as usize)).collect();
    grains(particles, &colors)
}
