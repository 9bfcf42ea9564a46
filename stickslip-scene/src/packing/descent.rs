//! Down the energy of overlaps, by the fast inertial relaxation engine (FIRE; Bitzek et al. 2006, Phys. Rev. Lett. 97,
//! 170201): grains roll down, faster the longer they go down, and stop where they go up.

use super::grain::{Grain, GrainShape, Push};
use super::neighbours::{Near, near};
use super::walls::{Wall, walls};
use super::{NoPacking, Packing};
use crate::geometry::Shape;
use crate::tensor::Vector;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

/// Grains on their way.
pub struct Descent<'a> {
    packing: &'a Packing<'a>,
    shape: &'a GrainShape<'a>,
    walls: Vec<Wall>,
    pub grains: Vec<Grain>,
    near: Near,
    /// Of each, whether no wall is within its reach until the neighbours are found anew.
    amid: Vec<bool>,
    /// Where they were when the neighbours were found.
    listed: Vec<[f64; 3]>,
    /// How far they may go until those are found anew [m].
    skin: f64,
    /// Force of an overlap over its depth, of so many points.
    stiffness: f64,
    random: ChaCha8Rng,
    /// Whether the balls that hold the grains stand for them.
    as_balls: bool,
    /// How much larger grains are on the way, over their radius.
    extra: f64,
    /// Stiffness and mass of each, over those of a grain on the open surface.
    hardness: Vec<f64>,
}

/// How much larger grains are on the way, over their radius; where they settle, more, as their weight presses them into
/// each other.
const EXTRA: f64 = 1e-3;
const SETTLING_EXTRA: f64 = 3e-3;

/// A grain resists turning as a ball does: moment of inertia over mass and radius squared.
const INERTIA: f64 = 0.4;

/// Steps without which nothing gets better that count as jammed.
const PATIENCE: usize = 2000;

/// Part of the container that the balls fill by which grains begin, in the plane and in space.
const DILUTE: [f64; 2] = [0.5, 0.3];

/// How grains grow, and the steps between.
const GROWTH: f64 = 0.03;
const GROWTH_STEPS: usize = 100;

/// Steps without which nothing gets better after which grains are shaken, and by how much of their radius and of a
/// radian.
const STALL: usize = 150;
const SHAKE: f64 = 0.1;

/// Grains times steps, those with points of their surfaces by half as many times as these are.
const MOST_WORK: usize = 400_000_000;

/// Longest time step where balls and other grains go down, and where balls settle, over the period of a grain of
/// stiffness 1 over its 2 pi.
const LONGEST: [f64; 2] = [0.35, 0.15];
const SETTLING_LONGEST: f64 = 0.5;

/// Under the first weight grains that settle press this part of a radius into each other, and fall fast; then under one
/// that is less and less, by this factor or by as much as it takes, until they keep apart; the last one.
const PRESSED: f64 = 3e-3;
const LIGHTER: f64 = 0.15;
const LEAST_PRESSED: f64 = 1e-7;

/// The overlap that the next weight is to leave, over what they may have, and the largest factor to it.
const AIM: f64 = 0.8;

/// The largest force on a grain, over its weight, that is rest, and what is rest, too, when the steps have run out.
const REST: f64 = 0.01;
const NEARLY_RESTS: f64 = 0.1;

/// Steps under each weight before the last one, and grains times steps in all.
const FALL_STEPS: usize = 3000;
const MOST_FALL: usize = 1_000_000_000;

/// Velocities or forces: of the middles, and of the surfaces by turning.
#[derive(Clone, Copy, Default)]
struct Motion([f64; 6]);

/// What acts on a grain.
struct Acting {
    force: Motion,
    /// As that of a [`Push`].
    excess: f64,
}

impl<'a> Descent<'a> {
    pub fn new(
        packing: &'a Packing<'a>,
        shape: &'a GrainShape<'a>,
        grains: Vec<Grain>,
        random: ChaCha8Rng,
    ) -> Self {
        let largest = grains.iter().map(|grain| grain.scale).fold(0.0, f64::max);
        let skin = 0.3 * shape.radius * largest;
        let stiffness = if shape.points.is_empty() { 1.0 } else { 0.25 };
        let mut walls = walls(packing.container, packing.dimension);
        for (axis, ends) in packing.repeats.iter().enumerate() {
            walls.retain(|wall| !ends.is_some_and(|ends| wall.is_end(axis, ends)));
        }
        let hardness = vec![1.0; grains.len()];
        let mut descent = Descent {
            packing,
            shape,
            walls,
            grains,
            near: Near::default(),
            amid: Vec::new(),
            listed: Vec::new(),
            skin,
            stiffness,
            random,
            as_balls: false,
            extra: EXTRA,
            hardness,
        };
        descent.list();
        descent
    }

    fn list(&mut self) {
        for grain in &mut self.grains {
            grain.position = self.packing.inside(grain.position);
        }
        self.listed = self.grains.iter().map(|grain| grain.position).collect();
        let reach = 1.0 + self.extra + self.shape.apart();
        let radii: Vec<f64> =
            self.grains.iter().map(|grain| reach * grain.scale * self.shape.radius).collect();
        let margin = 2.0 * self.skin + self.packing.gap;
        let count = self.listed.len();
        let within_reach = |(grain, radius): (&Grain, &f64)| {
            self.walls
                .iter()
                .any(|wall| wall.may_reach(grain.position, radius + margin, self.packing.dimension))
        };
        self.amid = self.grains.par_iter().zip(&radii).map(|of| !within_reach(of)).collect();
        let (places, of) = self.with_images(2.0 * radii.iter().fold(0.0_f64, |a, &b| a.max(b)) + margin);
        let radii: Vec<f64> = of.iter().map(|&grain| radii[grain as usize]).collect();
        self.near = near(&places, &radii, margin, self.packing.dimension);
        if places.len() > count {
            self.near = self.near.with_images(count, &of);
        }
    }

    /// Where grains are, and those of their images that are nearer than `reach` to the container, with the numbers of
    /// their grains.
    fn with_images(&self, reach: f64) -> (Vec<[f64; 3]>, Vec<u32>) {
        let mut places = self.listed.clone();
        let mut of: Vec<u32> = (0..places.len() as u32).collect();
        for (axis, ends) in self.packing.repeats.iter().enumerate() {
            let Some([first, last]) = *ends else { continue };
            for i in 0..places.len() {
                for away in [first - last, last - first] {
                    let mut image = places[i];
                    image[axis] += away;
                    if image[axis] > first - reach && image[axis] < last + reach {
                        places.push(image);
                        of.push(of[i]);
                    }
                }
            }
        }
        (places, of)
    }

    /// By how much jammed grains must be smaller to find room, about [-].
    pub fn shrunk(&mut self) -> f64 {
        let step = 0.98;
        let mut factor = 1.0;
        while factor > 0.5 {
            factor *= step;
            self.grains.iter_mut().for_each(|grain| grain.scale *= step);
            if self.run(self.most_steps().min(PATIENCE)) {
                break;
            }
        }
        factor
    }

    /// Steps that it may take: fewer where each has more to do.
    fn most_steps(&self) -> usize {
        let work = self.grains.len().max(1) * (1 + self.shape.points.len() / 2);
        (MOST_WORK / work).clamp(PATIENCE, 20 * PATIENCE)
    }

    /// Until nothing overlaps; whether that came to be. Grains that are not balls begin small, and as the balls that
    /// hold them: those find places apart, and then the grains grow to their size, so that no two are ever so deep in
    /// each other that no direction leads out. `room` is the volume of the container.
    pub fn separate(&mut self, room: f64) -> bool {
        let sizes: Vec<f64> = self.grains.iter().map(|grain| grain.scale).collect();
        if !self.shape.points.is_empty() {
            let dimension = self.packing.dimension;
            let ball = |size: &f64| Shape::ball([0.0; 3], size * self.shape.radius).volume(dimension);
            let balls: f64 = sizes.iter().filter_map(ball).sum();
            let mut size = libm::pow(DILUTE[dimension - 2] * room / balls, 1.0 / dimension as f64).min(1.0);
            self.as_balls = true;
            self.resize(&sizes, size);
            self.run(PATIENCE);
            self.as_balls = false;
            while size < 1.0 {
                self.run(GROWTH_STEPS);
                size = (size * (1.0 + GROWTH)).min(1.0);
                self.resize(&sizes, size);
            }
        }
        self.run(self.most_steps())
    }

    /// Lets the grains fall along a direction and come to rest, without overlap.
    ///
    /// # Errors
    /// They do not come to rest.
    pub fn settle(&mut self, along: [f64; 3]) -> Result<(), NoPacking> {
        self.extra = SETTLING_EXTRA;
        self.list();
        // In a container that they nearly fill there may be no room for that.
        if !self.run(self.most_steps()) {
            self.extra = EXTRA;
        }
        let work = self.grains.len().max(1) * (1 + self.shape.points.len() / 2);
        let mut steps = (MOST_FALL / work).max(FALL_STEPS);
        let mut pressed = PRESSED;
        loop {
            self.harden(along);
            let weight = along.map(|along| along * pressed * self.shape.radius * self.stiffness);
            let mut left = self.fall(weight, FALL_STEPS.min(steps), &mut steps);
            let mut excess = self.excess();
            if excess <= 0.0 {
                if steps > 0 {
                    left = self.fall(weight, steps, &mut steps);
                    excess = self.excess();
                }
                if excess <= 0.0 && left <= NEARLY_RESTS {
                    return Ok(());
                }
            }
            if steps == 0 || pressed < LEAST_PRESSED {
                return Err(NoPacking::Restless(left));
            }
            // Overlap is in proportion to the weight.
            let allowed = 2.0 * self.extra;
            pressed *= (AIM * allowed / (allowed + excess)).clamp(LIGHTER, AIM);
        }
    }

    /// Makes grains harder and heavier, by how many lie above each of them, about: so overlaps are alike everywhere,
    /// and those on the open surface, under their own weight alone, need no more steps than those below.
    fn harden(&mut self, along: [f64; 3]) {
        let depth = |grain: &Grain| (0..3).map(|k| grain.position[k] * along[k]).sum::<f64>();
        let top = self.grains.iter().map(depth).fold(f64::INFINITY, f64::min);
        let mean = self.grains.iter().map(|grain| grain.scale).sum::<f64>() / self.grains.len() as f64;
        let layer = 2.0 * mean * self.shape.radius;
        self.hardness = self.grains.iter().map(|grain| 1.0 + (depth(grain) - top) / layer).collect();
    }

    /// The deepest overlap beyond what grains may have on the way, over their size.
    fn excess(&self) -> f64 {
        self.acting().iter().map(|acting| acting.excess).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Takes at most so many steps under a weight, that of a grain of size 1, until all rest; the largest force that is
    /// left on a grain, over its weight. Takes the steps from those that are `left`.
    fn fall(&mut self, weight: [f64; 3], most: usize, left: &mut usize) -> f64 {
        let mut roll = Roll::new(self);
        if self.shape.points.is_empty() {
            roll.longest *= SETTLING_LONGEST / LONGEST[0];
        }
        let size = Vector(weight).norm();
        let mut largest = f64::INFINITY;
        for _ in 0..most {
            let mut acting = self.acting();
            largest = 0.0;
            for (Acting { force: Motion(force), .. }, grain) in acting.iter_mut().zip(&self.grains) {
                let heavy = grain.scale.powi(self.packing.dimension as i32);
                (0..3).for_each(|k| force[k] += heavy * weight[k]);
                // Moments, over a part of the radius, among them.
                let sum = force.iter().map(|f| f * f).sum::<f64>();
                largest = largest.max(sum.sqrt() / (heavy * size));
            }
            if largest <= REST {
                break;
            }
            *left -= 1;
            let step = roll.on(&acting, &self.hardness);
            self.advance(&roll.motions, step);
        }
        largest
    }

    fn resize(&mut self, sizes: &[f64], factor: f64) {
        self.grains.iter_mut().zip(sizes).for_each(|(grain, size)| grain.scale = factor * size);
        // Whose surfaces are near each other follows from their sizes.
        self.list();
    }

    /// Takes at most so many steps until nothing overlaps; whether that came to be.
    fn run(&mut self, most: usize) -> bool {
        let mut roll = Roll::new(self);
        let (mut best, mut since) = (f64::INFINITY, 0);
        for _ in 0..most {
            let acting = self.acting();
            let excess = acting.iter().map(|acting| acting.excess).fold(f64::NEG_INFINITY, f64::max);
            if excess <= 0.0 {
                return true;
            }
            since = if excess < 0.99 * best { 0 } else { since + 1 };
            best = best.min(excess);
            if since > PATIENCE {
                return false;
            }
            if since % STALL == STALL - 1 && !self.shape.points.is_empty() {
                self.shake(&acting);
                roll.halt();
                continue;
            }
            let step = roll.on(&acting, &self.hardness);
            self.advance(&roll.motions, step);
        }
        false
    }

    /// Moves and turns grains that overlap by chance: corners that hook into each other go down to no way out.
    fn shake(&mut self, acting: &[Acting]) {
        let flat = self.packing.dimension == 2;
        for (grain, _) in self.grains.iter_mut().zip(acting).filter(|(_, acting)| acting.excess > 0.0) {
            let mut chance = || SHAKE * self.random.sample::<f64, _>(StandardNormal);
            let by = [chance(), chance(), if flat { 0.0 } else { chance() }];
            let turn = if flat { [0.0, 0.0, chance()] } else { [chance(), chance(), chance()] };
            let radius = self.shape.radius * grain.scale;
            grain.position = std::array::from_fn(|k| grain.position[k] + radius * by[k]);
            if self.packing.turned {
                grain.turn(turn);
            }
        }
        self.list();
    }

    /// What acts on each grain; summed for each by itself, in the order of its neighbours, so that the sums are the
    /// same for any number of threads.
    fn acting(&self) -> Vec<Acting> {
        let gap = self.packing.gap;
        let ball = self.shape.ball();
        let shape = if self.as_balls { &ball } else { self.shape };
        let places: Vec<[f64; 4]> = match shape.points.is_empty() {
            true => self.grains.iter().map(Grain::ball).collect(),
            false => Vec::new(),
        };
        let hardness = |i: usize, j: usize| 0.5 * (self.hardness[i] + self.hardness[j]);
        let on = |i: usize| {
            let grain = &self.grains[i];
            let mut push = Push::NONE;
            if !self.amid[i] {
                for wall in &self.walls {
                    push.join(shape.held(grain, wall, gap, self.extra).times(self.hardness[i]));
                }
            }
            match places.get(i) {
                Some(place) => (self.near.of(i)).for_each(|j| {
                    let [x, y, z, scale] = places[j];
                    let [x, y, z] = self.packing.image_near([x, y, z], grain.position);
                    let pushed = shape.push_ball((place, &[x, y, z, scale]), gap, self.extra);
                    push.join(pushed.times(hardness(i, j)));
                }),
                None => (self.near.of(i)).for_each(|j| {
                    let other = &self.grains[j];
                    let position = self.packing.image_near(other.position, grain.position);
                    let pushed = shape.push((grain, &Grain { position, ..*other }), gap, self.extra);
                    push.join(pushed.times(hardness(i, j)));
                }),
            }
            Acting { force: self.force(&push, grain), excess: push.excess }
        };
        (0..self.grains.len()).into_par_iter().with_min_len(64).map(on).collect()
    }

    fn force(&self, push: &Push, grain: &Grain) -> Motion {
        let radius = self.shape.radius * grain.scale;
        let [fx, fy, fz] = push.force.map(|f| self.stiffness * f);
        let turns = !self.shape.points.is_empty() && self.packing.turned;
        let [mx, my, mz] =
            push.moment.map(|m| if turns { self.stiffness * m / (INERTIA * radius) } else { 0.0 });
        match self.packing.dimension {
            2 => Motion([fx, fy, 0.0, 0.0, 0.0, mz]),
            _ => Motion([fx, fy, fz, mx, my, mz]),
        }
    }

    fn advance(&mut self, motions: &[Motion], step: f64) {
        let mut far = false;
        for (i, (grain, Motion([x, y, z, turn @ ..]))) in self.grains.iter_mut().zip(motions).enumerate() {
            let radius = self.shape.radius * grain.scale;
            let most = 0.2 * radius;
            // No grain leaps over another.
            let shorten = |by: [f64; 3]| {
                let length = by.iter().map(|x| x * x).sum::<f64>().sqrt() * step;
                by.map(|x| x * step * if length > most { most / length } else { 1.0 })
            };
            let by = shorten([*x, *y, *z]);
            grain.position = std::array::from_fn(|k| grain.position[k] + by[k]);
            if turn.iter().any(|turn| *turn != 0.0) {
                grain.turn(shorten(*turn).map(|arc| arc / radius));
            }
            let gone: f64 = (0..3).map(|k| (grain.position[k] - self.listed[i][k]).powi(2)).sum();
            far |= gone > self.skin * self.skin;
        }
        if far {
            self.list();
        }
    }
}

/// The state of the engine that rolls grains down.
struct Roll {
    motions: Vec<Motion>,
    step: f64,
    longest: f64,
    shortest: f64,
    /// Of the motion, that is turned into the direction of the force.
    share: f64,
    /// Steps for which it has gone down.
    downhill: usize,
    /// Components of motion that there are: without turning, the first three.
    components: usize,
}

/// The share at first and after a halt.
const SHARE: f64 = 0.1;

impl Roll {
    fn new(descent: &Descent) -> Self {
        let turns = !descent.shape.points.is_empty();
        let longest = LONGEST[usize::from(turns)];
        // Walls have corners, at which the energy has no slope: steps that shrink there without end would stay there.
        let shortest = 0.25 * longest;
        Roll {
            motions: vec![Motion::default(); descent.grains.len()],
            step: shortest,
            longest,
            shortest,
            share: SHARE,
            downhill: 0,
            components: if turns { 6 } else { 3 },
        }
    }

    fn halt(&mut self) {
        self.motions.fill(Motion::default());
    }

    /// The motions of grains of these masses under what acts, and for how long they last.
    fn on(&mut self, acting: &[Acting], masses: &[f64]) -> f64 {
        let components = self.components;
        let (mut power, mut of_motion, mut of_force) = (0.0, 0.0, 0.0);
        let each = self.motions.iter().zip(acting).zip(masses);
        for ((Motion(motion), Acting { force: Motion(force), .. }), mass) in each {
            let (mut p, mut m, mut f) = (0.0, 0.0, 0.0);
            for (motion, force) in motion[..components].iter().zip(&force[..components]) {
                p += force * motion;
                m += motion * motion;
                f += force * force;
            }
            power += p;
            of_motion += m * mass;
            of_force += f / mass;
        }
        let mut turn = None;
        if power > 0.0 {
            self.downhill += 1;
            if self.downhill > 5 {
                self.step = self.longest.min(1.1 * self.step);
                self.share *= 0.99;
            }
            turn = Some(self.share * (of_motion / of_force.max(f64::MIN_POSITIVE)).sqrt());
        } else {
            (self.step, self.share, self.downhill) = (self.shortest.max(0.5 * self.step), SHARE, 0);
            self.halt();
        }
        let each = self.motions.iter_mut().zip(acting).zip(masses);
        for ((Motion(motion), Acting { force: Motion(force), .. }), mass) in each {
            for (motion, force) in motion[..components].iter_mut().zip(&force[..components]) {
                let acceleration = force / mass;
                if let Some(turn) = turn {
                    *motion = (1.0 - self.share) * *motion + turn * acceleration;
                }
                *motion += self.step * acceleration;
            }
        }
        self.step
    }
}
