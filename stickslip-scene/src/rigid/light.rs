//! Free rigid bodies that may touch what deforms on a grid of its own, and how fast the layer between them makes light
//! ones.

use super::MassProperties;
use crate::scene::{ContactLaw, Interior, RuleNames, Scene};
use std::collections::BTreeMap;
use stickslip_reference::contact::STIFFNESS;

/// A free rigid body between bodies on grids of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// Number of the body.
    pub body: usize,
    /// Mass of the body [kg].
    pub mass: f64,
    /// The stiffest of those that it may touch.
    pub partner: usize,
    /// Square of the fastest motion of the body on cells of the partner all around, about [1/s^2]:
    ///
    /// ```text
    /// w^2 = (M/h) A max(1/m, r_i^2/I_i)        A: surface of the box round the body, r_i: half its width about axis i
    /// ```
    /// M: P-wave modulus, h: cell, A at most the surfaces of the boxes round all partners.
    pub rate: f64,
    /// The same over the square of what a wave crosses of the partner's cells in time [-].
    pub ratio: f64,
}

/// The free rigid bodies of a scene that may touch bodies on grids of their own.
pub fn carried_bodies(scene: &Scene) -> Vec<Carried> {
    let free: Vec<usize> =
        (0..scene.bodies.len()).filter(|&body| scene.bodies[body].as_free_rigid().is_some()).collect();
    if free.is_empty() {
        return Vec::new();
    }
    let names = RuleNames::new(scene);
    let wave = |body: usize| {
        let material = &scene.materials[scene.bodies[body].material];
        (material.law.wave_modulus_at_rest(scene.dimension.thickness()), material.density)
    };
    let stiffness = |body: usize| wave(body).0 / scene.cell(&scene.bodies[body]);
    // Of bodies that no rule tells from each other the stiffest, and the surface of all.
    let mut classes: BTreeMap<usize, (usize, f64)> = BTreeMap::new();
    for body in (0..scene.bodies.len()).filter(|&body| scene.interior(body) == Interior::Reference) {
        let (stiffest, surface) = classes.entry(names.class(body)).or_insert((body, 0.0));
        *surface += box_surface(scene, body);
        if stiffness(body) > stiffness(*stiffest) {
            *stiffest = body;
        }
    }
    let carried = |body: usize| {
        let touches = |class: &usize| {
            let rule = names.rule(names.class(body), *class);
            rule.is_none_or(|rule| scene.contact[rule].law != ContactLaw::None)
        };
        let partners = classes.iter().filter(|(class, _)| touches(class)).map(|(_, of)| *of);
        let (partner, surface) =
            partners.reduce(|a, b| (if stiffness(b.0) > stiffness(a.0) { b.0 } else { a.0 }, a.1 + b.1))?;
        let properties = MassProperties::of(scene, &scene.bodies[body], scene.bodies[body].as_free_rigid()?)?;
        let area = box_surface(scene, body).min(surface);
        let ((modulus, density), cell) = (wave(partner), scene.cell(&scene.bodies[partner]));
        let rate = modulus / cell * area * yields(scene, body, &properties);
        let ratio = rate * cell * cell * density / modulus;
        Some(Carried { body, mass: properties.mass, partner, rate, ratio })
    };
    free.into_iter().filter_map(carried).collect()
}

/// The longest step of free rigid bodies that bodies on grids of their own touch all around [s]: dt = 1/w with the
/// stiffness of the layer, half of what is stable, so that it is stable together with that of the others. The first
/// touch has it, too.
pub(super) fn longest_carried(scene: &Scene) -> f64 {
    let rates = carried_bodies(scene).into_iter().map(|carried| carried.rate);
    1.0 / (STIFFNESS * rates.fold(0.0, f64::max)).sqrt()
}

/// Half widths of the box round a body [m].
fn half_widths(scene: &Scene, body: usize) -> [f64; 3] {
    let axes = scene.dimension.axes();
    let sides = scene.bodies[body].shape.bounds(axes).map_or([f64::INFINITY; 3], |bounds| bounds.size());
    std::array::from_fn(|k| if k < axes { 0.5 * sides[k] } else { 0.0 })
}

/// Surface of the box round a body [m^2], in the plane its length [m].
fn box_surface(scene: &Scene, body: usize) -> f64 {
    let [a, b, c] = half_widths(scene, body);
    if scene.dimension.axes() == 2 { 4.0 * (a + b) } else { 8.0 * (a * b + b * c + c * a) }
}

/// How fast a body yields to what pushes it all around: max(1/m, r_i^2/I_i) [1/kg].
fn yields(scene: &Scene, body: usize, MassProperties { mass, inertia, .. }: &MassProperties) -> f64 {
    let half = half_widths(scene, body);
    let turns = if scene.dimension.axes() == 2 { 2..3 } else { 0..3 };
    let about = |i: usize| {
        let [a, b] = [half[(i + 1) % 3], half[(i + 2) % 3]];
        (a * a + b * b) / (3.0 * inertia.0[i][i])
    };
    turns.map(about).fold(1.0 / mass, f64::max)
}
