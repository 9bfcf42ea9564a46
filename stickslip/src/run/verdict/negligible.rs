//! What is too little to be judged: round-off of bodies at rest, and motion that no result shows.

use crate::door::{BodyState, Ledger, View};
use crate::scene::{Body, Scene};

/// Least energy, momentum and speed that a check holds something against:
///
/// ```text
/// v_0 = 1e-8 c                                        c: speed of waves in the body's material
/// p_0 = sum m v_0
/// E_0 = sum m (1e-14 c^2 + g d) + F d + 1e-14 |E|     d: 1e-6 cells, F: forces of loads and joints, E: of the ledger
/// ```
/// A body that rests on another has next to no energy of its own, and what it has is round-off.
#[derive(Clone, Debug, Default)]
pub(super) struct Negligible {
    /// v_0 of each body that forces move, 0 of the others [m/s].
    speeds: Vec<f64>,
    /// The largest g that is the same everywhere [m/s^2].
    gravity: f64,
    /// d [m].
    length: f64,
}

const OF_WAVE_SPEED: f64 = 1e-8;
const CELLS: f64 = 1e-6;
const ROUND_OFF: f64 = 1e-14;

impl Negligible {
    pub(super) fn of(scene: &Scene) -> Self {
        let speed = |body: &Body| match body.is_prescribed() {
            true => 0.0,
            false => {
                let material = &scene.materials[body.material];
                OF_WAVE_SPEED * material.wave_speed(scene.dimension.thickness())
            }
        };
        Negligible {
            speeds: scene.bodies.iter().map(speed).collect(),
            gravity: super::norm(scene.gravity.strongest(scene.time.end)),
            length: CELLS * scene.discretization.cell,
        }
    }

    /// v_0 of a body [m/s].
    pub(super) fn speed(&self, body: usize) -> f64 {
        self.speeds[body]
    }

    /// p_0 of a body [kg m/s].
    pub(super) fn momentum(&self, body: usize, state: &BodyState) -> f64 {
        state.mass * self.speeds[body]
    }

    /// E_0 of all bodies [J].
    pub(super) fn energy(&self, view: &dyn View, ledger: &Ledger) -> f64 {
        let of_body = |(state, speed): (&BodyState, &f64)| match *speed > 0.0 {
            true => state.mass * (ROUND_OFF * (speed / OF_WAVE_SPEED).powi(2) + self.gravity * self.length),
            false => 0.0,
        };
        let bodies: f64 = view.bodies().iter().zip(&self.speeds).map(of_body).sum();
        let loads = view.loads().into_iter().map(|load| load.impulse);
        let impulses = loads.chain(view.joints().into_iter().map(|joint| joint.impulse));
        let impulse: f64 = impulses.map(super::norm).sum();
        let force = if view.time() > 0.0 { impulse / view.time() } else { 0.0 };
        let Ledger { kinetic, strain, potential, external_work, friction, damping, .. } = ledger;
        let all = [kinetic, strain, potential, external_work, friction, damping];
        let of_ledger: f64 = all.into_iter().map(|energy| energy.abs()).sum();
        bodies + force * self.length + ROUND_OFF * of_ledger
    }
}
