//! Stress with which the particles of a body begin.

use crate::geometry::sites;
use crate::scene::{Dimension, Moment, Problem, Scene};
use crate::tensor::Symmetric;
use rayon::prelude::*;

/// With what a particle begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialStress {
    /// Cauchy stress [Pa].
    pub stress: Symmetric<f64>,
    /// A, what its law sees of deformation beside F; the identity where it carries its stress.
    pub stretch: Symmetric<f64>,
}

/// Particles that are looked at together.
const AT_A_TIME: usize = 1 << 16;

/// Looks whether all particles of a body can begin with the stress that the scene gives it.
///
/// # Errors
/// A stress of a rigid body, out of a plane scene, that is no number, or that its material cannot have before anything
/// moves.
pub fn check(scene: &Scene, number: usize) -> Result<(), Problem> {
    let body = &scene.bodies[number];
    let Some(formulas) = &body.stress else { return Ok(()) };
    let all = sites(&body.shape, &scene.lattice(body), scene.arrangement(body));
    let mut places = all.into_iter().flatten().map(|site| site.position);
    let alike = formulas.iter().all(|formula| formula.constant().is_some());
    loop {
        let some: Vec<[f64; 3]> = places.by_ref().take(if alike { 1 } else { AT_A_TIME }).collect();
        let is_last = alike || some.len() < AT_A_TIME;
        at(scene, number, some)?;
        if is_last {
            return Ok(());
        }
    }
}

/// With what particles of a body begin at these places [m]; nothing where the scene gives it no stress.
///
/// # Errors
/// What [`check`] finds.
pub fn at(scene: &Scene, number: usize, places: Vec<[f64; 3]>) -> Result<Vec<InitialStress>, Problem> {
    let body = &scene.bodies[number];
    let Some(formulas) = &body.stress else { return Ok(Vec::new()) };
    if body.is_rigid() {
        return Err(Problem {
            key: format!("bodies[{number}].stress"),
            found: format!("a stress of the rigid body `{}`", body.name),
            allowed: "a body that deforms".to_string(),
            help: None,
        });
    }
    let law = scene.materials[body.material].law;
    // A law that its cells do not suit is found elsewhere.
    let law = law.on_grid(scene.discretization.cell).unwrap_or(law);
    let at = |place: [f64; 3]| {
        let moment = Moment { place, start: place, ..Moment::default() };
        Symmetric(std::array::from_fn(|k| formulas[k].at_moment(&moment)))
    };
    let of_stress = |stress: Symmetric<f64>, place: [f64; 3]| {
        // Without the round-off of a grid.
        let place = place.map(|x| format!("{x:.9e}").parse().unwrap_or(x));
        let refused = |allowed: &str| Problem {
            key: format!("bodies[{number}].stress"),
            found: format!("{:?} Pa (xx, yy, zz, xy, yz, xz) at {place:?} m in `{}`", stress.0, body.name),
            allowed: allowed.to_string(),
            help: None,
        };
        let [_, _, zz, _, yz, xz] = stress.0;
        let plane = scene.dimension.is_plane() && [yz, xz] != [0.0; 2];
        if !stress.is_finite() {
            return Err(refused("stresses that are numbers"));
        } else if plane || scene.dimension == Dimension::PlaneStress && zz != 0.0 {
            return Err(refused("none out of the plane of the scene; in plane strain along z, zz, alone"));
        }
        let stretch = law.stretch_under(&stress).map_err(|no| refused(no.reason()))?;
        Ok(InitialStress { stress, stretch })
    };
    let Some(&first) = places.first() else { return Ok(Vec::new()) };
    if formulas.iter().all(|formula| formula.constant().is_some()) {
        return Ok(vec![of_stress(at(first), first)?; places.len()]);
    }
    // Collected before the first problem is taken, so that it is the first by number and not the first in time.
    let all: Vec<_> = places.into_par_iter().map(|place| of_stress(at(place), place)).collect();
    all.into_iter().collect()
}
