//! What points that touch do to the nodes: the pressure and the shear of the layer.

use super::{Deforming, Friction, LANDED, Memory, Met, Obstacle, PATIENCE, Touch};
use stickslip_mechanics::geometry::form::Weights;
use stickslip_mechanics::tensor::Vector;

/// Lets the layers of points that come to touch feel no more of their depth than these come deeper in a step of `dt`
/// [s], or they would store energy that nobody gave: where steps become shorter as bodies touch, where a point slides
/// in under an edge, and where bodies overlap at the start.
pub fn begin<const D: usize>(
    bodies: &[Deforming<'_, D>],
    obstacles: &[&dyn Obstacle],
    touches: &mut [Touch<D>],
    dt: f64,
) {
    for touch in touches.iter_mut().filter(|touch| touch.memory.age == 0.0 && touch.gap < 0.0) {
        let felt = (approach(bodies, obstacles, touch) * dt).min(-touch.gap);
        touch.memory.unfelt += -touch.gap - felt;
        touch.memory.patience = if -touch.gap <= LANDED * felt { PATIENCE } else { 1.0 };
        touch.gap = -felt;
    }
}

/// Lets the layers of points on bodies whose surface is found by what is around them feel a jump of it no sooner than
/// other depths: particles come and go there, and no work made the gap jump.
pub fn follow<const D: usize>(
    bodies: &[Deforming<'_, D>],
    obstacles: &[&dyn Obstacle],
    touches: &mut [Touch<D>],
    dt: f64,
) {
    let jumps = |touch: &Touch<D>| match touch.met {
        Met::Obstacle(r) => touch.memory.age > 0.0 && !obstacles[r].is_tracked(),
        Met::Deforming(..) => false,
    };
    for touch in touches.iter_mut().filter(|touch| jumps(touch)) {
        let [before, deeper] = touch.memory.felt;
        let jitter = JITTER * bodies[touch.side].interior.form.cell;
        let explained = before + deeper + approach(bodies, obstacles, touch) * dt + jitter;
        let unexplained = -touch.gap - explained;
        if unexplained > 0.0 {
            touch.memory.unfelt += unexplained;
            touch.memory.patience = 1.0;
            touch.gap += unexplained;
        }
    }
}

/// What of a cell the surface of a body may come nearer in a step by the particles that say where it is.
const JITTER: f64 = 0.005;

/// Adds the pressure and the friction of all points that touch to the forces on the nodes of a step of `dt` [s]:
/// f_I += N_I A (p n + tau), of the partner the opposite. Bonds that are pulled too strongly give way. What of the
/// stored slip friction does not bear, slips, and takes work.
pub fn press<const D: usize>(
    bodies: &mut [Deforming<'_, D>],
    (touches, dt): (&mut [Touch<D>], f64),
    rule: &dyn Fn(&Touch<D>) -> Friction,
) {
    for touch in touches {
        let friction = rule(touch);
        hold(touch, friction.adhesion);
        bear(touch, &friction, dt);
        let force = touch.force();
        let body = &mut bodies[touch.side];
        body.interior.push(&body.surface[touch.memory.point as usize].weights, force);
        if let Met::Deforming(b, weights) = &touch.met {
            bodies[*b].interior.push(weights, -force);
        }
    }
    for body in bodies {
        body.interior.gather_forces();
    }
}

/// Bonds a point that presses, and parts a bond that is pulled by more than `adhesion` bears [Pa]. That takes what the
/// bond stored and what the bodies did on it in the step: of the layer's forces at both ends of it the last is none,
///
/// ```text
/// k A g_0^2 / 2 + k A g_0 (g_1 - g_0) / 2 = k A g_0 g_1 / 2
/// ```
fn hold<const D: usize>(touch: &mut Touch<D>, adhesion: f64) {
    let (depth, stiffness) = (-touch.gap, touch.stiffness[0]);
    let energy = |before: f64| 0.5 * touch.area * stiffness * before.min(0.0) * depth.min(0.0);
    let was_bonded = touch.memory.bond.is_some();
    let bears = depth >= 0.0 || was_bonded && stiffness * -depth <= adhesion;
    let is_bonded = adhesion > 0.0 && bears;
    let torn = if was_bonded && !is_bonded { energy(touch.memory.felt[0]) } else { 0.0 };
    touch.memory.bond = is_bonded.then(|| energy(depth));
    touch.torn = torn;
}

/// What of the stored slip s friction bears in a step of `dt` [s], and its traction. Slip that viscosity opposes is
/// found at the end of the step, which is stable for any viscosity:
///
/// ```text
/// k_t s_1 = b + eta |s - s_1| / dt,   b = mu max(p, 0) + c,   k_t |s| > b
/// ```
fn bear<const D: usize>(touch: &mut Touch<D>, friction: &Friction, dt: f64) {
    let stored = Vector::<f64, D>::of(touch.memory.stored);
    let tangential = stored - touch.normal * stored.dot(touch.normal);
    // The layer turns with the surface: what it stored stays as long as it was.
    let (length, along) = (stored.norm(), tangential.norm());
    let tangential = if along > 0.0 { tangential * (length / along) } else { Vector::ZERO };
    let pressure = touch.push();
    let strength = match friction.memory {
        Some(_) if touch.memory.remembered >= 0.0 && touch.memory.speed > 0.0 => touch.memory.remembered,
        _ => pressure,
    };
    let bound = |coefficient: f64| {
        // An infinite coefficient sticks even without any push.
        let shear = coefficient * strength + friction.cohesion;
        if coefficient.is_finite() { shear / touch.stiffness[1] } else { f64::INFINITY }
    };
    let most = if length > bound(friction.at_rest) || touch.memory.speed > 0.0 {
        bound(friction.coefficient(touch.memory.speed))
    } else {
        f64::INFINITY
    };
    let (kept, slipped) = if length > most {
        let excess = length - most;
        let viscous = friction.viscosity / (friction.viscosity + touch.stiffness[1] * dt);
        (tangential * ((most + viscous * excess) / length), (1.0 - viscous) * excess)
    } else {
        (tangential, 0.0)
    };
    touch.traction = kept * -touch.stiffness[1];
    // The layer's forces at both ends of the step, on what slips, less what it stores: k/2 (s_0 + s_1) . (s* - s_1).
    let mean = (Vector::<f64, D>::of(touch.memory.borne) + kept) * 0.5;
    touch.friction = touch.area * touch.stiffness[1] * mean.dot(tangential - kept);
    (touch.memory.stored, touch.memory.borne) = (kept.space(), kept.space());
    touch.memory.energy = 0.5 * touch.area * touch.stiffness[1] * kept.dot(kept);
    touch.memory.speed = slipped;
    if friction.memory.is_some() {
        touch.memory.remembered = strength;
    }
}

/// Lets the layer store the slip of the step, by the velocities that move the bodies, and friction remember pressure:
/// what is known of each point in the next step.
pub fn slip<const D: usize>(
    bodies: &[Deforming<'_, D>],
    obstacles: &[&dyn Obstacle],
    (touches, dt): (&mut [Touch<D>], f64),
    rule: &dyn Fn(&Touch<D>) -> Friction,
) -> Vec<Memory> {
    let after = |touch: &mut Touch<D>| {
        let velocity = relative_velocity(bodies, obstacles, touch);
        touch.slip = velocity - touch.normal * velocity.dot(touch.normal);
        let slip = touch.slip;
        let mut memory = touch.memory;
        memory.stored = (Vector(memory.stored) + Vector((slip * dt).space())).0;
        memory.age += dt;
        let deeper = memory.unfelt.max(0.0) * (dt / (memory.patience * settling(bodies, touch))).min(1.0);
        memory.unfelt -= deeper;
        memory.felt = [touch.depth(), deeper];
        // It goes on slipping only as long as its surfaces move that way.
        memory.speed = if memory.speed > 0.0 && slip.dot(touch.traction) < 0.0 { slip.norm() } else { 0.0 };
        if let Some(law) = rule(touch).memory {
            // What sticks has the strength of its pressure: only what slips lags behind.
            memory.remembered = match memory.speed > 0.0 {
                true => law.after(memory.remembered, (touch.push(), slip.norm(), dt), memory.age),
                false => touch.push(),
            };
        }
        memory
    };
    touches.iter_mut().map(after).collect()
}

/// How fast a point comes deeper into its partner; zero where it moves out [m/s].
pub fn approach<const D: usize>(
    bodies: &[Deforming<'_, D>],
    obstacles: &[&dyn Obstacle],
    touch: &Touch<D>,
) -> f64 {
    (-touch.normal.dot(relative_velocity(bodies, obstacles, touch))).max(0.0)
}

/// How long a layer takes to feel the depth at which it began [s]: as long as the body that settles sooner.
fn settling<const D: usize>(bodies: &[Deforming<'_, D>], touch: &Touch<D>) -> f64 {
    touch.sides().iter().map(|&side| bodies[side].settling).fold(f64::INFINITY, f64::min)
}

/// Velocity of a body at a point that touches, against its partner's [m/s].
pub(super) fn relative_velocity<const D: usize>(
    bodies: &[Deforming<'_, D>],
    obstacles: &[&dyn Obstacle],
    touch: &Touch<D>,
) -> Vector<f64, D> {
    let of =
        |body: &Deforming<'_, D>, weights: &Weights<D>| body.interior.at(weights, &body.interior.velocities);
    let body = &bodies[touch.side];
    let own = of(body, &body.surface[touch.memory.point as usize].weights);
    own - match &touch.met {
        Met::Deforming(b, weights) => of(&bodies[*b], weights),
        Met::Obstacle(r) => Vector::of(obstacles[*r].velocity((touch.at - touch.away).space())),
    }
}
