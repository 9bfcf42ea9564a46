//! Where the exact surfaces of rigid bodies are near each other.

use super::super::build::whole;
use super::corners::{Plain, corners};
use super::neighbours::Neighbours;
use crate::body::Body;
use crate::contact::Rules;
use crate::geometry::{Bounds, Shape, SignedDistance};
use crate::rigid::{Pose, RigidMotion};
use crate::scene::Scene;
use crate::tensor::{Real, Vector, cross};
use crate::threads::by_parts;
use std::collections::HashSet;
use std::ops::Range;

/// Points on the surface of a body are this part of its largest extent apart at most.
const FINEST: f64 = 1.0 / 12.0;
/// A surface has so many points at most; those of a larger one are farther apart.
const MOST_POINTS: usize = 200_000;
/// How far apart two surfaces may be for the next step to matter, over what they can approach each other in a step.
const AHEAD: f64 = 1.5;
/// Points whose distances differ by less than this touch alike, over the distance between points.
const ALIKE: f64 = 1e-3;
/// Faces rest on each other that are this far apart or overlap by so much, over the distance between points. Would each
/// overlap be taken away, a wall in which round-off makes some would have to move against all that it bears.
const SLACK: f64 = 1e-5;
/// The cosine of the angle within which normals are those of one flat contact.
const FLAT: f64 = 0.9998;
/// The cosine of the angle within which normals at one place are those of one contact.
const ASIDE: f64 = 0.7;
/// Steps of the search for the nearest point at most, and where it ends, over the distance between points.
const MAX_STEPS: usize = 40;
const FOUND: f64 = 1e-9;
/// A point that is moved onto a surface is on it if it was no farther off than this, over the distance between points.
const NEARLY_ON: f64 = 1e-5;
/// Points of a surface that one thread looks at together, and pairs of surfaces.
const PART: usize = 256;
const PAIRS: usize = 8;
/// Distances are no farther off than this part of the way between two points allows.
const SURELY: f64 = 0.5;
/// Surfaces that resist by their area hold each other over a gap of this part of the distance between points.
const BOND: f64 = 0.01;
/// From this part of the way on that a point may take it would have gone on, if the slope is more than the second.
const AT_END: f64 = 0.999;
const LEVEL: f64 = 1e-6;

/// A rigid body's surface, as points on the shape at the start.
#[derive(Clone, Debug)]
struct RigidSurface {
    body: usize,
    points: Vec<[f64; 3]>,
    /// The area of the piece that each stands for [m^2], in the plane its length [m].
    areas: Vec<f64>,
    /// Points beside the corners of its faces.
    corners: Vec<[f64; 3]>,
    /// Whether it meets boxes at corners alone.
    plain: Option<Plain>,
    /// A ball around the body where it is at the start; without bounds the radius is infinite.
    center: [f64; 3],
    reach: f64,
    /// Half of the box around it where it is at the start [m]; infinite with images.
    half: [f64; 3],
    /// How far apart the points are [m].
    spacing: f64,
    /// Its radius, if it is a ball or a disk [m].
    ball: Option<f64>,
    /// Its lower and its upper corner, if it is a box in the plane whose sides are along the axes at the start [m].
    sides: Option<[[f64; 2]; 2]>,
}

impl RigidSurface {
    /// The longest way of its points in a step, where the ball around it has this centre [m].
    fn way(&self, (motion, center): (&RigidMotion, [f64; 3]), dt: f64) -> f64 {
        let speed = Vector(motion.velocity()).norm();
        let turn = Vector(motion.spin()).norm();
        let off = (Vector(center) - Vector(motion.center)).norm();
        let reach = if self.reach.is_finite() { self.reach + off } else { 0.0 };
        // What gravity and pushes add in a step is less than what a point is apart from the next.
        dt * (speed + turn * reach) + ALIKE * self.spacing
    }
}

/// The surfaces of all rigid bodies that may touch others of them.
#[derive(Clone, Debug, Default)]
pub struct RigidSurfaces {
    all: Vec<RigidSurface>,
    /// Bodies that a joint holds together do not touch each other.
    pub(super) joined: HashSet<[usize; 2]>,
    /// After which length everything repeats along each axis [m]; 0 where nothing does.
    pub(super) periods: [f64; 3],
    /// Lower corner of the domain, from which the first period begins [m].
    pub(super) corner: [f64; 3],
    dimension: usize,
}

/// A place where two rigid bodies touch, or may in this step.
#[derive(Clone, Copy, Debug)]
pub struct RigidContact {
    /// Indices of the bodies, the smaller first.
    pub bodies: [usize; 2],
    /// From the second body to that of its images in a periodic domain which touches [m].
    pub away: [f64; 3],
    /// Where, on the first body and that image [m].
    pub place: [f64; 3],
    /// Unit normal from the second body to the first.
    pub normal: [f64; 3],
    /// Distance between the surfaces, negative where they overlap [m].
    pub gap: f64,
    /// Surfaces no farther apart than this, and that overlap by no more, rest on each other [m].
    pub slack: f64,
    /// Its share of the area over which they touch, where that counts [m^2], in the plane per metre of depth [m].
    pub area: f64,
}

/// Two surfaces that may touch.
struct Near<'a, T, const D: usize> {
    pair: [&'a PlacedSurface<'a, T, D>; 2],
    /// Whether they resist by their area.
    bonds: bool,
}

impl RigidSurfaces {
    /// The surfaces of a scene; none where no rigid body is free.
    pub fn new<const D: usize>(scene: &Scene) -> Self {
        if scene.bodies.iter().all(|body| body.as_free_rigid().is_none()) {
            return RigidSurfaces::default();
        }
        let axes = scene.dimension.axes();
        let surface = |(index, body): (usize, &crate::scene::Body)| {
            let spacing = scene.lattice(body).spacing;
            let Some(bounds) = body.shape.bounds(axes).filter(Bounds::is_finite) else {
                let unbounded = RigidSurface {
                    body: index,
                    points: Vec::new(),
                    areas: Vec::new(),
                    corners: Vec::new(),
                    plain: Plain::of(&body.shape, axes),
                    center: [0.0; 3],
                    reach: f64::INFINITY,
                    half: [f64::INFINITY; 3],
                    spacing,
                    ball: None,
                    sides: None,
                };
                return unbounded;
            };
            let size = bounds.size()[..axes].iter().copied().fold(0.0, f64::max);
            let mut spacing = spacing.min(FINEST * size);
            let mut points = body.shape.surface(spacing, axes, &bounds);
            while points.len() > MOST_POINTS {
                spacing *= 2.0;
                points = body.shape.surface(spacing, axes, &bounds);
            }
            let center: [f64; 3] = std::array::from_fn(|k| 0.5 * (bounds.min[k] + bounds.max[k]));
            let (points, areas): (Vec<_>, Vec<_>) =
                points.into_iter().map(|point| (point.position, point.area)).unzip();
            let far = |point: &[f64; 3]| (Vector(*point) - Vector(center)).norm();
            let reach = points.iter().map(far).fold(0.0, f64::max) + spacing;
            let ball = match body.shape {
                Shape::Ball { radius, .. } => Some(radius),
                _ => None,
            };
            let whole = whole::<D>(scene, index).bounds();
            let sides = match &body.shape {
                Shape::Box { min, max } if axes == 2 && whole.is_some() => {
                    Some([min, max].map(|corner| [corner[0], corner[1]]))
                }
                _ => None,
            };
            let half = whole.map_or([f64::INFINITY; 3], |whole| whole.size().map(|size| 0.5 * size));
            let corners = corners(&body.shape, spacing, axes);
            RigidSurface {
                body: index,
                points,
                areas,
                corners,
                plain: Plain::of(&body.shape, axes),
                center,
                reach,
                half,
                spacing,
                ball,
                sides,
            }
        };
        let rigid = scene.bodies.iter().enumerate().filter(|(_, body)| body.is_rigid());
        let joined = (scene.joints.iter().filter(|joint| joint.holds()))
            .filter_map(|joint| Some([joint.body.min(joint.to?), joint.body.max(joint.to?)]))
            .collect();
        let corner = scene.domain.as_ref().map_or([0.0; 3], |domain| domain.min);
        let (all, periods) = (rigid.map(surface).collect(), scene.periods());
        RigidSurfaces { all, joined, periods, corner, dimension: axes }
    }

    /// Whether a rigid body is a ball or a disk, whose turn says nothing of where its surface is.
    pub fn is_ball(&self, body: usize) -> bool {
        let place = self.all.binary_search_by_key(&body, |surface| surface.body);
        place.is_ok_and(|place| self.all[place].ball.is_some())
    }

    /// Where free rigid bodies touch other rigid bodies or may within a step, ordered by pair.
    ///
    /// Each point of a body's surface that is near another body is moved along its own surface, by no more than points
    /// are apart, to where it is nearest to the other one. Of a flat contact the points at its rim stay, which carry any
    /// force and moment that all of them can. Two balls touch on the line of their centres, and no point is looked at.
    /// `neighbours` say which pairs to look at.
    pub fn contacts<T: Real, const D: usize>(
        &self,
        bodies: &[Body<T, D>],
        rules: &Rules<T>,
        dt: f64,
        neighbours: &mut Neighbours,
    ) -> Vec<RigidContact> {
        let placed: Vec<PlacedSurface<T, D>> =
            self.all.iter().map(|surface| PlacedSurface::new(surface, &bodies[surface.body], dt)).collect();
        if !neighbours.hold(&placed) {
            *neighbours = Neighbours::of(self, &placed, rules);
        }
        let near: Vec<Near<T, D>> = (neighbours.pairs.iter())
            .map(|listed| Near { pair: listed.ranks.map(|rank| &placed[rank]), bonds: listed.bonds })
            .filter(|near| may_touch(near.pair, self.nearest(near.pair)))
            .collect();
        let parts = by_parts(near.len(), PAIRS, |part| {
            let mut found = Vec::new();
            near[part].iter().for_each(|near| self.between_images(near, &mut found));
            found
        });
        parts.into_iter().flatten().collect()
    }

    /// From the second of two bodies to its image that is nearest to the first [m]. What has no bounds is everywhere.
    pub(super) fn nearest<T, const D: usize>(&self, [a, b]: [&PlacedSurface<T, D>; 2]) -> [f64; 3] {
        let bounded = a.reach.is_finite() && b.reach.is_finite();
        std::array::from_fn(|k| match self.periods[k] {
            period if period > 0.0 && bounded => -period * ((b.center[k] - a.center[k]) / period).round(),
            _ => 0.0,
        })
    }

    /// Contacts of the first body with all images of the second one that it may touch: where both end along an axis,
    /// these are on both sides, if they are long.
    fn between_images<T: Real, const D: usize>(&self, near: &Near<T, D>, found: &mut Vec<RigidContact>) {
        if self.periods == [0.0; 3] {
            return self.between(near, found);
        }
        let Near { pair: [a, b], bonds } = *near;
        let mut images = vec![self.nearest([a, b])];
        for axis in (0..D).filter(|&axis| self.periods[axis] > 0.0) {
            let ends = [a, b].iter().all(|one| one.reach.is_finite() && !one.body.whole.is_joined(axis));
            if !ends {
                continue;
            }
            for number in 0..images.len() {
                for period in [-self.periods[axis], self.periods[axis]] {
                    let mut next = images[number];
                    next[axis] += period;
                    images.push(next);
                }
            }
        }
        for away in images.into_iter().filter(|away| may_touch([a, b], *away)) {
            match away {
                [0.0, 0.0, 0.0] => self.between(near, found),
                _ => self.between(&Near { pair: [a, &b.moved(away)], bonds }, found),
            }
        }
    }

    fn between<T: Send + Sync, const D: usize>(
        &self,
        &Near { pair, bonds }: &Near<T, D>,
        found: &mut Vec<RigidContact>,
    ) {
        let [a, b] = pair;
        let bond = if bonds { BOND * a.surface.spacing.min(b.surface.spacing) } else { 0.0 };
        let margin = margin(pair).max(bond);
        // The area is that of the smaller body's surface: a face that lies in another one is found whole.
        let counts = |one: &PlacedSurface<T, D>, other: &PlacedSurface<T, D>| {
            bonds && (one.surface.reach, one.surface.body) < (other.surface.reach, other.surface.body)
        };
        if let [Some(r), Some(s)] = pair.map(PlacedSurface::ball) {
            found.extend(between_balls(pair, [r, s]).into_iter().filter(|contact| contact.gap <= margin));
            return;
        }
        // So a grain in the middle of a container looks at none of its points.
        let far = |one: &PlacedSurface<T, D>, other: &PlacedSurface<T, D>| {
            one.reach.is_finite() && other.level(one.center).distance > one.reach + margin
        };
        if far(a, b) || far(b, a) {
            return;
        }
        let bodies = pair.map(|placed| placed.surface.body);
        let slack = SLACK * a.surface.spacing.min(b.surface.spacing);
        let mut near = Vec::new();
        for (one, other, sign) in [(a, b, 1.0), (b, a, -1.0)] {
            // Where the other one is as this one sees it, so that far points need no turning.
            let seen = one.pose.start(other.center);
            let counts = counts(one, other);
            let limit = margin + one.surface.spacing;
            if one.is_beyond(other, limit) {
                continue;
            }
            let (reach, box_around) = (other.reach + limit, other.surface.half.map(|half| half + limit));
            let turn = other.pose.orientation.transpose() * one.pose.orientation;
            let outside = |off: Vector<f64, 3>| {
                let across = |k: usize| (0..3).map(|j| turn.0[k][j] * off[j]).sum::<f64>();
                off.dot(off) > reach * reach || (0..D).any(|k| across(k).abs() > box_around[k])
            };
            let RigidSurface { points, areas, corners, .. } = one.surface;
            let touches = |number: usize, last: &mut ([f64; 3], f64)| {
                let point = points.get(number).copied().unwrap_or_else(|| corners[number - points.len()]);
                let off = Vector(point) - Vector(seen);
                // What is near a point that is far away is far away.
                let way = (Vector(point) - Vector(last.0)).norm();
                if way < SURELY * last.1 || outside(off) {
                    return None;
                }
                let place = one.pose.now(point);
                let level = other.level(place);
                *last = (point, level.distance - limit);
                if level.distance > limit {
                    return None;
                }
                let faces = || Vector(one.level(place).gradient).dot(Vector(level.gradient)) < -FLAT;
                if counts && level.distance.abs() <= bond && faces() {
                    let normal = Vector(level.gradient).direction()?;
                    let middle = (Vector(place) - normal * (0.5 * level.distance)).0;
                    let (normal, area) = (normal.0.map(|n| sign * n), areas[number]);
                    let gap = level.distance;
                    return Some(RigidContact {
                        bodies,
                        away: b.away,
                        place: middle,
                        normal,
                        gap,
                        slack,
                        area,
                    });
                }
                let (place, level) = one.nearest(place, other)?;
                let normal = Vector(level.gradient).direction()?;
                // At an edge, faces that lie side by side do not face each other.
                let off = ALIKE * one.surface.spacing;
                if one.level((place + normal * off).0).distance > 0.5 * off {
                    return None;
                }
                // In the middle between the surfaces, where either body's points find the same place.
                let place = (place - normal * (0.5 * level.distance)).0;
                let normal = normal.0.map(|n| sign * n);
                let gap = level.distance;
                let contact = RigidContact { bodies, away: b.away, place, normal, gap, slack, area: 0.0 };
                (gap <= margin).then_some(contact)
            };
            // Where a box meets another one or a half-space, a corner of either is. What resists by its area has the
            // points that stand for it.
            let by_corners = one.surface.plain == Some(Plain::Box) && other.surface.plain.is_some() && !bonds;
            let first = if by_corners { points.len() } else { 0 };
            let count = points.len() + if bonds { 0 } else { corners.len() } - first;
            let look = |part: Range<usize>, found: &mut Vec<RigidContact>| {
                let mut last = ([0.0; 3], 0.0);
                found.extend(part.filter_map(|number| touches(first + number, &mut last)));
            };
            if count <= PART {
                look(0..count, &mut near);
                continue;
            }
            let parts = by_parts(count, PART, |part| {
                let mut found = Vec::new();
                look(part, &mut found);
                found
            });
            near.extend(parts.into_iter().flatten());
        }
        let alike = ALIKE * a.surface.spacing.min(b.surface.spacing);
        reduce(near, alike, self.dimension, found);
    }
}

/// How far apart two surfaces may be for the next step to matter [m].
fn margin<T, const D: usize>([a, b]: [&PlacedSurface<T, D>; 2]) -> f64 {
    a.ahead() + b.ahead()
}

/// Whether the balls around a surface and an image of another one, so far from that [m], are near enough.
fn may_touch<T, const D: usize>(pair: [&PlacedSurface<T, D>; 2], away: [f64; 3]) -> bool {
    let [a, b] = pair;
    let square: f64 = (0..D).map(|k| (a.center[k] - (b.center[k] + away[k])).powi(2)).sum();
    square <= (a.reach + b.reach + margin(pair)).powi(2)
}

/// Where two balls or disks of these radii are nearest: on the line of their centres, in the middle of the gap
/// |a - b| - r - s. `None` where the centres are the same.
fn between_balls<T, const D: usize>(
    [a, b]: [&PlacedSurface<T, D>; 2],
    [r, s]: [f64; 2],
) -> Option<RigidContact> {
    let off: [f64; 3] = std::array::from_fn(|k| if k < D { a.center[k] - b.center[k] } else { 0.0 });
    let normal = Vector(off).direction()?;
    let gap = Vector(off).norm() - r - s;
    let middle = (Vector(b.center) + normal * (s + 0.5 * gap)).0;
    // A disk is as high as its centre of mass.
    let place = std::array::from_fn(|k| if k < D { middle[k] } else { b.motion.center[k] });
    let bodies = [a, b].map(|placed| placed.surface.body);
    Some(RigidContact { bodies, away: b.away, place, normal: normal.0, gap, slack: 0.0, area: 0.0 })
}

/// A surface where its body, or an image of it in a periodic domain, is now.
pub(super) struct PlacedSurface<'a, T, const D: usize> {
    surface: &'a RigidSurface,
    pub body: &'a Body<T, D>,
    pub motion: &'a RigidMotion,
    pose: Pose,
    /// Where its centre of mass was at the start and is now [m].
    mass_center: [[f64; 3]; 2],
    /// From the body to the image [m].
    away: [f64; 3],
    /// The ball around it.
    pub center: [f64; 3],
    pub reach: f64,
    /// The longest way of its points in the step [m].
    way: f64,
}

impl<'a, T, const D: usize> PlacedSurface<'a, T, D> {
    fn new(surface: &'a RigidSurface, body: &'a Body<T, D>, dt: f64) -> Self {
        let motion = body.motion.as_deref().expect("it is rigid");
        let pose = motion.pose();
        let (center, reach) = (pose.now(surface.center), surface.reach);
        let way = surface.way((motion, center), dt);
        let mass_center = [pose.begun(), motion.center];
        PlacedSurface { surface, body, motion, pose, mass_center, away: [0.0; 3], center, reach, way }
    }

    /// An image of it.
    fn moved(&self, away: [f64; 3]) -> Self {
        let center = std::array::from_fn(|k| self.center[k] + away[k]);
        let PlacedSurface { surface, body, motion, pose, mass_center: [begun, here], reach, way, .. } = *self;
        let mass_center = [begun, std::array::from_fn(|k| here[k] + away[k])];
        PlacedSurface { surface, body, motion, pose: pose.moved(away), mass_center, away, center, reach, way }
    }

    /// Index of its body.
    pub fn index(&self) -> usize {
        self.surface.body
    }

    /// How far from another surface that stands still it matters in the step [m].
    pub fn ahead(&self) -> f64 {
        AHEAD * self.way
    }

    /// Whether all of it is out of the box around another surface that is larger by so much on all sides [m].
    fn is_beyond(&self, other: &PlacedSurface<T, D>, limit: f64) -> bool {
        let (off, half) = (Vector(self.center) - Vector(other.center), self.surface.half);
        // The axes of each box as it is now.
        let axes = [other, self].map(|one| one.pose.orientation.transpose().0);
        (0..D).any(|k| {
            let axis = Vector(axes[0][k]);
            let own: f64 = (0..D).map(|j| axis.dot(Vector(axes[1][j])).abs() * half[j]).sum();
            off.dot(axis).abs() > other.surface.half[k] + limit + own + ALIKE * self.surface.spacing
        })
    }

    /// Its radius, if it is a ball or a disk and not joined to itself [m].
    fn ball(&self) -> Option<f64> {
        self.surface.ball.filter(|_| !(0..D).any(|axis| self.body.whole.is_joined(axis)))
    }

    /// Signed distance to its surface where it is now.
    #[inline]
    fn level(&self, place: [f64; 3]) -> SignedDistance {
        if let Some(sides) = self.surface.sides {
            return self.level_of_box(sides, place);
        }
        let level = self.body.whole.level(self.pose.start(place));
        SignedDistance { gradient: self.pose.turned(level.gradient), ..level }
    }

    /// The same of a box in the plane: most of the search for contacts in walls.
    #[inline]
    fn level_of_box(&self, [min, max]: [[f64; 2]; 2], place: [f64; 3]) -> SignedDistance {
        let (turn, [begun, here]) = (&self.pose.orientation.0, self.mass_center);
        let off = [place[0] - here[0], place[1] - here[1]];
        let [(a, a_outward), (b, b_outward)] = [0, 1].map(|k| {
            let x = begun[k] + (turn[0][k] * off[0] + turn[1][k] * off[1]);
            let (below, above) = (min[k] - x, x - max[k]);
            if below > above { (below, -1.0) } else { (above, 1.0) }
        });
        let (distance, [x, y]) = if a > 0.0 && b > 0.0 {
            let distance = (a * a + b * b).sqrt();
            (distance, [a_outward * a / distance, b_outward * b / distance])
        } else if b > a {
            (b, [0.0, b_outward])
        } else {
            (a, [a_outward, 0.0])
        };
        let gradient = [turn[0][0] * x + turn[0][1] * y, turn[1][0] * x + turn[1][1] * y, 0.0];
        SignedDistance { distance, gradient }
    }

    /// The point of its surface next to `place`.
    fn onto(&self, mut place: Vector<f64, 3>) -> Vector<f64, 3> {
        for _ in 0..3 {
            let level = self.level(place.0);
            if !level.distance.is_finite() {
                break;
            }
            place -= Vector(level.gradient) * level.distance;
            if level.distance.abs() < NEARLY_ON * self.surface.spacing {
                break;
            }
        }
        place
    }

    /// From a point of its surface along it to where it is nearest to `other`, by no more than points are apart: where
    /// the gradient of the distance has no part along the surface (steepest descent, Barzilai and Borwein 1988). `None`
    /// if it goes on from there: another point is nearer then. So a wheel that rolls touches at its lowest point, and
    /// not at those that come down in front of it.
    fn nearest(
        &self,
        place: [f64; 3],
        other: &PlacedSurface<T, D>,
    ) -> Option<(Vector<f64, 3>, SignedDistance)> {
        let (first, spacing) = (Vector(place), self.surface.spacing);
        let mut at = first;
        let mut level = other.level(at.0);
        let mut step = spacing;
        let along = |at: Vector<f64, 3>, level: &SignedDistance| {
            let (normal, slope) = (Vector(self.level(at.0).gradient), Vector(level.gradient));
            slope - normal * slope.dot(normal)
        };
        let mut slope = along(at, &level);
        let goes_on = |at: Vector<f64, 3>, slope: Vector<f64, 3>| {
            let off = at - first;
            off.norm() > AT_END * spacing && slope.dot(off) < -LEVEL * spacing
        };
        for _ in 0..MAX_STEPS {
            if slope.norm() * step < FOUND * spacing {
                break;
            }
            let mut to = at - slope * step;
            let off = to - first;
            if off.norm() > spacing {
                to = first + off * (spacing / off.norm());
            }
            let to = self.onto(to);
            let there = other.level(to.0);
            if there.distance >= level.distance {
                // A corner, to which shorter steps lead back as well.
                if (to - at).norm() < FOUND * spacing {
                    break;
                }
                step *= 0.25;
                continue;
            }
            let moved = to - at;
            let turned = along(to, &there);
            let change = turned - slope;
            let curved = moved.dot(change);
            step = if curved > 0.0 { moved.dot(moved) / curved } else { 4.0 * step };
            (at, level, slope) = (to, there, turned);
            if moved.norm() < FOUND * spacing || goes_on(at, slope) {
                break;
            }
        }
        // Not even where it goes on by round-off.
        if let Some(distance) = self.faces(other, first, (at, &level)) {
            return Some((first, SignedDistance { distance, ..level }));
        }
        (!goes_on(at, slope)).then_some((at, level))
    }

    /// How far a point of its surface is from `other`, where both are flat from there to the place that was found
    /// nearest and nearly parallel. Such a point stays where it is, or round-off would choose another one in each step,
    /// and what it bears would not be found again.
    fn faces(
        &self,
        other: &PlacedSurface<T, D>,
        point: Vector<f64, 3>,
        (at, level): (Vector<f64, 3>, &SignedDistance),
    ) -> Option<f64> {
        let spacing = self.surface.spacing;
        let normal = Vector(level.gradient);
        let plane = |place: Vector<f64, 3>| level.distance + (place - at).dot(normal);
        let (way, distance) = (point - at, plane(point));
        let tilted = (distance - level.distance).abs() * 2.0 * self.reach > ALIKE * spacing * way.norm();
        if tilted || other.level(point.0).distance > distance + ALIKE * spacing {
            return None;
        }
        let middle = at + way * 0.5;
        let bent =
            self.level(middle.0).distance.abs().max((other.level(middle.0).distance - plane(middle)).abs());
        (bent <= FOUND * spacing).then_some(distance)
    }
}

/// Keeps of contacts with one normal the nearest one and those at the rim, of what touches and of what may touch soon.
/// Those at the rim of an area share it alike: so a bond bears its whole pull, and tips about an edge at half of that
/// times the way to the other one, as a bond of the same strength everywhere does.
fn reduce(mut near: Vec<RigidContact>, alike: f64, dimension: usize, kept: &mut Vec<RigidContact>) {
    while let Some(deepest) = near.iter().min_by(|a, b| a.gap.total_cmp(&b.gap)).copied() {
        let flat = |contact: &RigidContact| Vector(contact.normal).dot(Vector(deepest.normal)) > FLAT;
        let (group, rest): (Vec<_>, Vec<_>) = near.into_iter().partition(flat);
        near = rest;
        let area: f64 = group.iter().map(|contact| contact.area).sum();
        let of_area: Vec<_> = group.iter().filter(|contact| contact.area > 0.0).copied().collect();
        let (touching, apart): (Vec<_>, Vec<_>) =
            group.into_iter().partition(|contact| contact.gap <= deepest.gap.max(0.0) + alike);
        let around = around(&tangents(deepest.normal, dimension));
        let mut chosen = Vec::new();
        take_rim(&of_area, &around, alike, &mut chosen);
        let share = area / chosen.len().max(1) as f64;
        chosen.iter_mut().for_each(|contact| contact.area = share);
        let before = chosen.len();
        take_rim(&[deepest], &around, alike, &mut chosen);
        take_rim(&touching, &around, alike, &mut chosen);
        take_rim(&apart, &around, alike, &mut chosen);
        chosen[before..].iter_mut().for_each(|contact| contact.area = 0.0);
        // Where faces meet, the way from corner to corner is round-off.
        near.retain(|contact| {
            let beside = |other: &RigidContact| {
                (Vector(other.place) - Vector(contact.place)).norm() <= alike
                    && Vector(other.normal).dot(Vector(contact.normal)) > ASIDE
            };
            contact.gap.abs() > alike || !chosen.iter().any(beside)
        });
        kept.extend(chosen);
    }
}

/// Takes those of a set of contacts that are farthest along each direction, unless one that is there lies by it.
fn take_rim(set: &[RigidContact], around: &[[f64; 3]], alike: f64, chosen: &mut Vec<RigidContact>) {
    for direction in around {
        let far = |contact: &&RigidContact| Vector(contact.place).dot(Vector(*direction));
        let Some(extreme) = set.iter().max_by(|a, b| far(a).total_cmp(&far(b))) else { continue };
        let same = |contact: &RigidContact| (Vector(contact.place) - Vector(extreme.place)).norm() <= alike;
        if !chosen.iter().any(same) {
            chosen.push(*extreme);
        }
    }
}

/// Unit vectors along a contact: one in the plane, two in space.
pub fn tangents(normal: [f64; 3], dimension: usize) -> Vec<[f64; 3]> {
    if dimension == 2 {
        return vec![[-normal[1], normal[0], 0.0]];
    }
    super::joint::across(normal).to_vec()
}

/// Directions all around a contact.
fn around(tangents: &[[f64; 3]]) -> Vec<[f64; 3]> {
    match tangents {
        [t] => vec![*t, t.map(|t| -t)],
        // Askew to the edges of most bodies, so that one point is the farthest.
        [s, t] => [[0.8, 0.6], [-0.6, 0.8], [-0.8, -0.6], [0.6, -0.8]]
            .map(|[a, b]| std::array::from_fn(|k| a * s[k] + b * t[k]))
            .to_vec(),
        _ => Vec::new(),
    }
}

impl RigidContact {
    /// Where the centres of the first body and of the second one's image are [m].
    pub fn centers(&self, [a, b]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
        [a, std::array::from_fn(|k| b[k] + self.away[k])]
    }

    /// Velocity of the first body against the second there, with these centres as [`RigidContact::centers`] gives them
    /// [m/s].
    pub fn relative(&self, velocities: [&super::Six; 2], centers: [[f64; 3]; 2]) -> [f64; 3] {
        let [v, w] = [0, 1].map(|side| {
            let [v, spin] = super::six::parts(*velocities[side]);
            let arm = (Vector(self.place) - Vector(centers[side])).0;
            Vector(v) + Vector(cross(spin, arm))
        });
        (v - w).0
    }
}
