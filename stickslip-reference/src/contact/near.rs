//! Which points of surfaces touch which partners.

use super::images::{PeriodLengths, pairs};
use super::look::{BACK, came_through, looks_at};
use super::{Deforming, Memory, Met, Obstacle, STIFFNESS, Touch, look, relative_velocity};
use crate::interior::Interior;
use rayon::prelude::*;
use stickslip_mechanics::geometry::form::digits;
use stickslip_mechanics::geometry::{Shape, SignedDistance};
use stickslip_mechanics::tensor::Vector;

/// Whom a body may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// Place in the list of bodies that deform.
    Deforming(usize),
    /// Place in the list of obstacles.
    Obstacle(usize),
}

/// By how much a body may bulge beyond the points of its surface, and move, in cells.
const MARGIN: f64 = 0.75;
/// How near points of two surfaces are where one comes to touch the other, in cells of the coarser.
const NEAR: f64 = 1.0;
/// How far a body may move before its neighbours are sought anew, in cells: points of two surfaces lie half as far
/// apart as neighbours do.
const SKIN: f64 = 0.25;
/// How near points of two surfaces are where they are neighbours, in cells: after both have moved as well.
const LISTED: f64 = NEAR + 2.0 * SKIN;
/// How far the nearest point of a surface may be from a place just inside, undeformed, in cells.
const AROUND: f64 = 2.0;
/// What touches within so many steps is told to bodies that are not ready.
const SOON: f64 = 3.0;
/// How far ahead that is looked for, in cells.
const AHEAD: f64 = 0.25;
/// What of a gap is certain: gaps are measured along one direction, and some distances are bounds.
const CERTAIN: f64 = 0.6;

/// How far apart surfaces are at most that touch without pressing, in cells: as on the common grid.
const BOND: f64 = 0.01;

/// How far apart surfaces are at most that are glued at the start, in cells: less than a point of a slanted face
/// beside.
const GLUE: f64 = 0.1;

/// How surfaces that do not press touch by their rule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bond {
    /// Bonds form without a push, at the start: the rule has adhesion.
    pub forms: bool,
    /// Slip is opposed: the rule has cohesion or viscosity.
    pub resists: bool,
    /// Surfaces are glued: what lies so near at the start that it is meant to touch is, as it lies.
    pub is_glue: bool,
}

impl Bond {
    /// How far apart surfaces of cells of this side are that come to touch [m].
    fn reach(self, cell: f64) -> f64 {
        match self {
            Bond { forms: true, is_glue: true, .. } => GLUE * cell,
            Bond { forms: true, .. } | Bond { resists: true, .. } => BOND * cell,
            _ => 0.0,
        }
    }
}

/// Points of surfaces that may come to touch, found anew once bodies have moved. They say where to look, not what is
/// found: touches are the same with neighbours of now and of before.
#[derive(Clone, Debug, Default)]
pub struct Neighbours<const D: usize> {
    pairs: Vec<Pair<D>>,
    at_obstacles: Vec<ObstaclePair>,
    /// Boxes around bodies when their neighbours were sought.
    boxes: Vec<[Vector<f64, D>; 2]>,
    /// How far each body has moved since at most [m].
    moved: Vec<f64>,
    /// Bodies beside obstacles, and how far these have moved there [m].
    beside: Vec<(usize, usize, f64)>,
    lengths: PeriodLengths<D>,
}

/// A point near a partner that deforms, by places in the list of these.
#[derive(Clone, Copy, Debug)]
struct Pair<const D: usize> {
    body: u32,
    point: u32,
    partner: u32,
    /// How far it was from the partner at least [m].
    gap: f64,
    /// Where the partner is undeformed there, about.
    place: Vector<f64, D>,
}

/// A point near an obstacle, and its place beside it in [`Neighbours::beside`].
#[derive(Clone, Copy, Debug)]
struct ObstaclePair {
    body: u32,
    point: u32,
    beside: u32,
    gap: f64,
}

/// What a search for points that touch is told.
#[derive(Clone, Copy)]
pub struct Search<'a, const D: usize> {
    /// The points that touched before, by body, point and partner.
    pub known: &'a [Memory],
    /// Whether a body touches a partner at all.
    pub meet: &'a (dyn Fn(usize, Partner) -> bool + Sync),
    /// How a body and a partner touch where they do not press; none: no two do.
    pub bond: Option<&'a (dyn Fn(usize, Partner) -> Bond + Sync)>,
    /// After which lengths everything is there again.
    pub lengths: PeriodLengths<D>,
    /// Which bodies are ready to touch: others are told of what will touch them in one of the next steps.
    pub ready: &'a [bool],
    /// How long the step is [s].
    pub dt: f64,
}

/// The points that touch, by body, point and partner, and the bodies that are not ready and will touch soon, by their
/// places in the list of those that deform. Bodies meet images of each other, and of themselves.
pub fn find<const D: usize>(
    (bodies, obstacles): (&[Deforming<'_, D>], &[&dyn Obstacle]),
    search: Search<'_, D>,
    neighbours: &mut Neighbours<D>,
) -> (Vec<Touch<D>>, Vec<usize>) {
    if neighbours.are_old((bodies, obstacles), search.meet) {
        *neighbours = Neighbours::new((bodies, obstacles), search.meet, search.lengths);
    }
    let here = &*neighbours;
    let touches = |a: usize| here.touches_of((bodies, obstacles, a), search);
    let mut all: Vec<Touch<D>> =
        (0..bodies.len()).into_par_iter().map(touches).collect::<Vec<_>>().into_iter().flatten().collect();
    let mut soon: Vec<usize> =
        all.iter().filter(|touch| touch.is_ahead).flat_map(|touch| touch.sides()).collect();
    soon.sort_unstable();
    soon.dedup();
    all.retain(|touch| !touch.is_ahead);
    (all, soon)
}

/// Points that are listed as neighbours, over those so near partners that they are looked at in every step: they lie
/// up to three times as far away.
const LISTED_OVER_NEAR: usize = 3;

impl<const D: usize> Neighbours<D> {
    /// Memory that a search among so many points of surfaces takes at most, of which so many are near partners [bytes]:
    /// their places, the cells that they are looked up in, twice as these lists are joined, and those found.
    pub const fn bytes_of(points: usize, near: usize) -> usize {
        let found = 2 * size_of::<Close>() + size_of::<Pair<D>>();
        points * (size_of::<Vector<f64, D>>() + 2 * size_of::<Entry<D>>()) + LISTED_OVER_NEAR * near * found
    }

    /// Takes note of how bodies move in a step of `dt` [s].
    pub fn moved(&mut self, (bodies, obstacles): (&[Deforming<'_, D>], &[&dyn Obstacle]), dt: f64) {
        for (moved, body) in self.moved.iter_mut().zip(bodies) {
            let squares = body.interior.velocities.iter().map(|v| v.dot(*v));
            *moved += squares.fold(0.0, f64::max).sqrt() * dt;
        }
        for (a, r, moved) in &mut self.beside {
            // A rigid motion is fastest at a corner, and which of its images is where in the box is not known.
            let [low, high] = self.boxes[*a];
            let (_, away) = nearest(obstacles[*r], (low + high) * 0.5);
            let [low, high] = [low - away - self.lengths.0, high - away + self.lengths.0];
            let corners = (0..1_usize << D).map(|corner| {
                let at = Vector::<f64, D>::from_fn(|k| if corner >> k & 1 == 1 { high[k] } else { low[k] });
                Vector::<f64, 3>(obstacles[*r].velocity(at.space())).norm()
            });
            *moved += corners.fold(0.0, f64::max) * dt;
        }
    }

    /// Whether a body has moved so far since that neighbours may be missed, or an obstacle has come beside it.
    fn are_old(
        &self,
        (bodies, obstacles): (&[Deforming<'_, D>], &[&dyn Obstacle]),
        meet: &(dyn Fn(usize, Partner) -> bool + Sync),
    ) -> bool {
        let far = |a: usize, moved: f64| moved.is_nan() || moved > SKIN * bodies[a].interior.form.cell;
        let has_come = |r: usize| {
            let bounds = obstacles[r].bounds().map(Vector::of);
            let beside = |a: usize| self.beside.binary_search_by_key(&(a, r), |&(a, r, _)| (a, r)).is_ok();
            let mut near = (0..bodies.len()).filter(|&a| self.lengths.overlap(&self.boxes[a], &bounds));
            near.any(|a| !beside(a) && meet(a, Partner::Obstacle(r)))
        };
        self.moved.len() != bodies.len()
            || self.moved.iter().enumerate().any(|(a, &moved)| far(a, moved))
            || self.beside.iter().any(|&(a, _, moved)| far(a, moved))
            || (0..obstacles.len()).any(has_come)
    }

    fn new(
        (bodies, obstacles): (&[Deforming<'_, D>], &[&dyn Obstacle]),
        meet: &(dyn Fn(usize, Partner) -> bool + Sync),
        lengths: PeriodLengths<D>,
    ) -> Self {
        let hulls: Vec<_> = bodies.par_iter().map(hull).collect();
        let folds = |a: usize, around: &[Vector<f64, D>; 2]| may_fold(&bodies[a]) || lengths.is_long(around);
        // Of a body that is far from all others nobody asks where its points are.
        let mut is_alone: Vec<bool> = (0..bodies.len())
            .map(|a| {
                let beside = |r: usize| lengths.overlap(&hulls[a], &obstacles[r].bounds().map(Vector::of));
                !folds(a, &hulls[a]) && !(0..obstacles.len()).any(beside)
            })
            .collect();
        pairs(&hulls, lengths).into_iter().flatten().for_each(|a| is_alone[a] = false);
        let places = |a: usize| -> Vec<Vector<f64, D>> {
            let points = if is_alone[a] { 0 } else { bodies[a].surface.len() };
            (0..points).map(|point| place(&bodies[a], point)).collect()
        };
        let places: Vec<Vec<Vector<f64, D>>> = (0..bodies.len()).into_par_iter().map(places).collect();
        let boxes: Vec<_> = (0..bodies.len())
            .map(|a| if is_alone[a] { hulls[a] } else { grown(&bodies[a], &places[a]) })
            .collect();
        let mut near = vec![Vec::new(); bodies.len()];
        for [a, b] in pairs(&boxes, lengths) {
            for [a, b] in [[a, b], [b, a]] {
                if meet(a, Partner::Deforming(b)) {
                    near[a].push(b);
                }
            }
        }
        for (a, near) in near.iter_mut().enumerate() {
            if folds(a, &boxes[a]) && meet(a, Partner::Deforming(a)) {
                near.push(a);
            }
            near.sort_unstable();
        }
        let seen = Seen { bodies, places: &places, boxes: &boxes, near: &near, lengths };
        let pairs = seen.close_points().into_par_iter().filter_map(|close| seen.pair(close)).collect();
        let beside: Vec<(usize, usize, f64)> = (0..bodies.len())
            .flat_map(|a| (0..obstacles.len()).map(move |r| (a, r, 0.0)))
            .filter(|&(a, r, _)| {
                lengths.overlap(&boxes[a], &obstacles[r].bounds().map(Vector::of))
                    && meet(a, Partner::Obstacle(r))
            })
            .collect();
        let obstacle_pairs = |(number, &(a, r, _)): (usize, &(usize, usize, f64))| {
            let far = (2.0 * SKIN + AHEAD) * bodies[a].interior.form.cell;
            let close = (0..).zip(&places[a]).filter_map(|(point, at)| {
                let gap = if obstacles[r].is_tracked() {
                    CERTAIN * nearest(obstacles[r], *at).0.distance
                } else {
                    f64::NEG_INFINITY
                };
                let gap = if gap.is_nan() { f64::NEG_INFINITY } else { gap };
                (gap <= far).then_some(ObstaclePair { body: a as u32, point, beside: number as u32, gap })
            });
            close.collect::<Vec<_>>()
        };
        let at_obstacles = beside.par_iter().enumerate().map(obstacle_pairs).collect::<Vec<_>>();
        let at_obstacles = at_obstacles.into_iter().flatten().collect();
        Neighbours { pairs, at_obstacles, boxes, moved: vec![0.0; bodies.len()], beside, lengths }
    }

    /// The points of a body's surface that touch: those that touched before, and neighbours that have come so near.
    fn touches_of(
        &self,
        (bodies, obstacles, a): (&[Deforming<'_, D>], &[&dyn Obstacle], usize),
        search: Search<'_, D>,
    ) -> Vec<Touch<D>> {
        let number = bodies[a].body as u32;
        let known = search.known;
        let known = &known[known.partition_point(|memory| memory.body < number)..];
        let known = &known[..known.partition_point(|memory| memory.body == number)];
        let is_known = |point: u32, partner: usize| {
            known.binary_search_by_key(&(number, point, partner as u32), Memory::key).is_ok()
        };
        let point =
            |number: usize| Point { bodies, a, number, at: place(&bodies[a], number), lengths: self.lengths };
        let point = |number: u32| point(number as usize);
        let bond = |partner: Partner| search.bond.map_or(Bond::default(), |bond| bond(a, partner));
        let again = |memory: &Memory| {
            let partner = memory.partner as usize;
            match bodies.binary_search_by_key(&partner, |body| body.body) {
                Ok(b) => point(memory.point).in_body((b, 0.0, bond(Partner::Deforming(b))), *memory),
                Err(_) => {
                    let r = obstacles.binary_search_by_key(&partner, |obstacle| obstacle.body()).ok()?;
                    let bond = bond(Partner::Obstacle(r));
                    point(memory.point).in_obstacle((r, obstacles[r]), (0.0, bond), *memory)
                }
            }
        };
        let mut touches: Vec<Touch<D>> = known.iter().filter_map(again).collect();
        let ahead = |ready: bool, cell: f64| if ready { 0.0 } else { AHEAD * cell };
        let is_soon = |touch: &Touch<D>| {
            !touch.is_ahead
                || touch.gap < SOON * search.dt * relative_velocity(bodies, obstacles, touch).norm()
        };
        let pairs = &self.pairs[self.pairs.partition_point(|pair| (pair.body as usize) < a)..];
        for pair in pairs.iter().take_while(|pair| pair.body as usize == a) {
            let b = pair.partner as usize;
            let cell = bodies[a].interior.form.cell.min(bodies[b].interior.form.cell);
            let bond = bond(Partner::Deforming(b));
            let ahead = ahead(search.ready[a] && search.ready[b], cell).max(bond.reach(cell));
            if pair.gap - ahead <= self.moved[a] + self.moved[b] && !is_known(pair.point, bodies[b].body) {
                touches.extend(point(pair.point).come_to((b, ahead, bond), pair.place).filter(is_soon));
            }
        }
        let pairs = &self.at_obstacles[self.at_obstacles.partition_point(|pair| (pair.body as usize) < a)..];
        for pair in pairs.iter().take_while(|pair| pair.body as usize == a) {
            let (_, r, moved) = self.beside[pair.beside as usize];
            let (cell, bond) = (bodies[a].interior.form.cell, bond(Partner::Obstacle(r)));
            let ahead = ahead(search.ready[a], cell).max(bond.reach(cell));
            if pair.gap - ahead <= self.moved[a] + moved && !is_known(pair.point, obstacles[r].body()) {
                let point = point(pair.point);
                let fresh = point.fresh(obstacles[r].body());
                touches.extend(point.in_obstacle((r, obstacles[r]), (ahead, bond), fresh).filter(is_soon));
            }
        }
        touches.sort_by_key(|touch| touch.memory.key());
        touches
    }
}

/// A point of a body's surface in a cell of the lattice in which they are looked up.
#[derive(Clone, Copy)]
struct Entry<const D: usize> {
    cell: [i32; D],
    body: u32,
    point: u32,
    at: Vector<f64, D>,
    /// Whether it is an image of a point that is in the list.
    is_image: bool,
}

/// A point that lies near a point of a partner's surface, by places in the list of bodies that deform.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Close {
    body: u32,
    point: u32,
    partner: u32,
    /// The nearest of the partner's points.
    nearest: u32,
}

/// All bodies that deform, where the points of their surfaces are, boxes around these, and whom each may touch.
struct Seen<'a, 'b, const D: usize> {
    bodies: &'a [Deforming<'b, D>],
    places: &'a [Vec<Vector<f64, D>>],
    boxes: &'a [[Vector<f64, D>; 2]],
    near: &'a [Vec<usize>],
    lengths: PeriodLengths<D>,
}

impl<const D: usize> Seen<'_, '_, D> {
    /// A pair of neighbours with what is known of its gap, if that may close before neighbours are sought anew.
    fn pair(&self, close: Close) -> Option<Pair<D>> {
        let Close { body, point, partner, nearest } = close;
        let (a, other) = (&self.bodies[body as usize], &self.bodies[partner as usize]);
        let at = self.places[body as usize][point as usize];
        let start = other.surface[nearest as usize].place;
        let toward = Some(normal(a, point as usize));
        let away = self.lengths.away(self.places[partner as usize][nearest as usize], at);
        let (gap, place) = match look((&*other.interior, other.shape), at - away, start, toward) {
            Some(seen) if seen.distance > 0.0 => (CERTAIN * seen.distance, seen.place),
            _ => (f64::NEG_INFINITY, start),
        };
        let [own, others] = [a, other].map(|body| body.interior.form.cell);
        let far = SKIN * (own + others) + AHEAD * own.min(others);
        (gap <= far).then_some(Pair { body, point, partner, gap, place })
    }

    /// Points that lie near a point of a partner's surface, ordered.
    fn close_points(&self) -> Vec<Close> {
        let width = LISTED * self.bodies.iter().map(|body| body.interior.form.cell).fold(0.0, f64::max);
        let entries_of = |a: usize| {
            let reach = Vector([width; D]);
            let around: Vec<_> =
                self.near[a].iter().map(|&b| [self.boxes[b][0] - reach, self.boxes[b][1] + reach]).collect();
            let is_beside = |at: Vector<f64, D>| around.iter().any(|it| self.lengths.overlap(&[at; 2], it));
            let beside = (0..).zip(&self.places[a]).filter(|(_, at)| is_beside(**at));
            let entries = |(point, &at): (u32, &Vector<f64, D>)| {
                let images = self.lengths.images(at, width).into_iter().enumerate();
                images.map(move |(image, at)| {
                    let cell = std::array::from_fn(|k| (at[k] / width).floor() as i32);
                    Entry { cell, body: a as u32, point, at, is_image: image > 0 }
                })
            };
            beside.flat_map(entries).collect::<Vec<_>>()
        };
        let entries = (0..self.bodies.len()).into_par_iter().map(entries_of).collect::<Vec<_>>();
        let mut entries: Vec<Entry<D>> = entries.into_iter().flatten().collect();
        entries.par_sort_unstable_by_key(|entry| (entry.cell, entry.body, entry.point));
        let cells: Vec<&[Entry<D>]> = entries.chunk_by(|a, b| a.cell == b.cell).collect();
        let close = |here: &&[Entry<D>]| self.close_in(here, &cells, width);
        let mut all: Vec<Close> =
            cells.par_iter().map(close).collect::<Vec<_>>().into_iter().flatten().collect();
        all.par_sort_unstable();
        all
    }

    /// The same of the points in a cell.
    fn close_in(&self, here: &[Entry<D>], cells: &[&[Entry<D>]], width: f64) -> Vec<Close> {
        // The last axis runs fastest: three cells behind each other.
        let mut around = Vec::new();
        for row in 0..3_usize.pow(D as u32 - 1) {
            let step = digits(row, [3; D]);
            let mut first = here[0].cell;
            for k in 0..D - 1 {
                first[k] += step[k + 1] as i32 - 1;
            }
            first[D - 1] -= 1;
            let start = cells.partition_point(|cell| cell[0].cell < first);
            let last = first[D - 1] + 2;
            let row = cells[start..]
                .iter()
                .take_while(|cell| cell[0].cell[..D - 1] == first[..D - 1] && cell[0].cell[D - 1] <= last);
            around.extend(row.copied());
        }
        let mut close = Vec::new();
        let mut best: Vec<(f64, Close)> = Vec::new();
        for entry in here.iter().filter(|entry| !entry.is_image) {
            let a = entry.body as usize;
            best.clear();
            for others in around.iter().flat_map(|cell| cell.chunk_by(|p, q| p.body == q.body)) {
                let (partner, b) = (others[0].body, others[0].body as usize);
                if self.near[a].binary_search(&b).is_err() {
                    continue;
                }
                let nearest = others
                    .iter()
                    .filter(|other| a != b || are_apart(&self.bodies[a], [entry.point, other.point]))
                    .map(|other| ((other.at - entry.at).dot(other.at - entry.at), other.point))
                    .min_by(|one, other| one.0.total_cmp(&other.0));
                let Some((square, nearest)) = nearest.filter(|(square, _)| *square < width * width) else {
                    continue;
                };
                let it = Close { body: entry.body, point: entry.point, partner, nearest };
                match best.iter_mut().find(|(_, close)| close.partner == partner) {
                    Some(known) if square < known.0 => *known = (square, it),
                    Some(_) => {}
                    None => best.push((square, it)),
                }
            }
            close.extend(best.iter().map(|(_, close)| *close));
        }
        close
    }
}

/// Distance from a place to an obstacle or the image of it that is nearest, and from it to that image [m].
fn nearest<const D: usize>(obstacle: &dyn Obstacle, at: Vector<f64, D>) -> (SignedDistance, Vector<f64, D>) {
    let (level, away) = obstacle.nearest(at.space());
    (level, Vector::of(away))
}

/// Where a point of a body's surface is.
fn place<const D: usize>(body: &Deforming<'_, D>, point: usize) -> Vector<f64, D> {
    body.interior.at(&body.surface[point].weights, &body.interior.places)
}

/// Whether two points of a body's surface lie so far apart, undeformed, that they may touch.
fn are_apart<const D: usize>(body: &Deforming<'_, D>, points: [u32; 2]) -> bool {
    let [one, other] = points.map(|point| body.surface[point as usize].place);
    (one - other).norm() > APART * body.interior.form.cell
}

/// How far apart two places of one body must be, undeformed, to touch each other: functions tie what is nearer together
/// [cells].
const APART: f64 = 3.0;
/// Sides of a box of which the longest is less than this many times the shortest do not fold.
const STOUT: f64 = 3.0;

/// Whether parts of a body may touch each other: of all but balls and stout boxes.
fn may_fold<const D: usize>(body: &Deforming<'_, D>) -> bool {
    let shape = match body.shape.half() {
        Shape::Rotated { shape, .. } => shape,
        shape => shape,
    };
    match shape {
        Shape::Ball { .. } => false,
        Shape::Box { min, max } => {
            let sides = (0..D).map(|k| max[k] - min[k]);
            sides.clone().fold(0.0, f64::max) > STOUT * sides.fold(f64::INFINITY, f64::min)
        }
        _ => true,
    }
}

/// A point of a body's surface.
struct Point<'a, 'b, const D: usize> {
    bodies: &'a [Deforming<'b, D>],
    a: usize,
    number: usize,
    at: Vector<f64, D>,
    lengths: PeriodLengths<D>,
}

/// Outward normal of the deformed surface at a point of it, F^-T N.
fn normal<const D: usize>(body: &Deforming<'_, D>, point: usize) -> Vector<f64, D> {
    let point = &body.surface[point];
    let (_, f) = body.interior.map(&point.weights);
    // Cofactors of F in space: J F^-T.
    let f = |i: usize, j: usize| if i < D && j < D { f[i][j] } else { f64::from(u8::from(i == j)) };
    let cofactor = |i: usize, j: usize| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        f(i1, j1) * f(i2, j2) - f(i1, j2) * f(i2, j1)
    };
    let normal = Vector::from_fn(|i| (0..D).map(|j| cofactor(i, j) * point.normal[j]).sum());
    normal * (1.0 / normal.norm())
}

impl<const D: usize> Point<'_, '_, D> {
    /// What a point that touches for the first time has to remember.
    fn fresh(&self, partner: usize) -> Memory {
        Memory {
            body: self.bodies[self.a].body as u32,
            point: self.number as u32,
            partner: partner as u32,
            place: [0.0; 3],
            remembered: -1.0,
            stored: [0.0; 3],
            borne: [0.0; 3],
            energy: 0.0,
            speed: 0.0,
            age: 0.0,
            unfelt: 0.0,
            patience: 1.0,
            felt: [0.0; 2],
            bond: None,
        }
    }

    /// How far from a partner a point touches by its bond, in cells of this side [m]: one that is bonded until the
    /// layer says that its bond gives way.
    fn reach(memory: &Memory, bond: Bond, cell: f64) -> f64 {
        if memory.bond.is_some() { f64::INFINITY } else { bond.reach(cell) }
    }

    /// A point that touches, with the share of its area on which it does; one that is further away than `reach` does
    /// not touch yet.
    fn touch(
        &self,
        (mut memory, met, away): (Memory, Met<D>, Vector<f64, D>),
        (normal, gap): (Vector<f64, D>, f64),
        (share, stiffness): (f64, [f64; 2]),
        (reach, bond): (f64, Bond),
    ) -> Touch<D> {
        let is_ahead = memory.age == 0.0 && gap >= reach;
        if bond.forms && memory.age == 0.0 && memory.bond.is_none() && !is_ahead {
            (memory.bond, memory.unfelt) = (Some(0.0), -gap.max(0.0));
            if bond.is_glue {
                // Its layer never feels how deep it lies.
                (memory.unfelt, memory.patience) = (-gap, f64::INFINITY);
            }
        }
        let gap = gap + memory.unfelt;
        let area = share * self.bodies[self.a].surface[self.number].area;
        let mut touch = Touch {
            memory,
            side: self.a,
            met,
            away,
            at: self.at,
            normal,
            gap,
            is_ahead,
            area,
            stiffness,
            traction: Vector::ZERO,
            friction: 0.0,
            torn: 0.0,
            deepening: 0.0,
            slip: Vector::ZERO,
        };
        // The layer's forces at both ends of the step give what bodies take of its energy, and this is the rest.
        let [before, deeper] = memory.felt;
        touch.deepening = 0.5 * area * stiffness[0] * (before + touch.depth()) * deeper;
        touch
    }

    /// Looks whether it has come to touch a neighbour that is undeformed about there, or to lie less than so far
    /// `ahead` of it [m]; if so it is sought from the nearest point of the neighbour's surface, whatever was known
    /// before.
    fn come_to(&self, (b, ahead, bond): (usize, f64, Bond), about: Vector<f64, D>) -> Option<Touch<D>> {
        let (body, partner) = (&self.bodies[self.a], &self.bodies[b]);
        let memory = |place: Vector<f64, D>| Memory { place: place.space(), ..self.fresh(partner.body) };
        let found = Vector::<f64, D>::of(self.in_body((b, ahead, bond), memory(about))?.memory.place);
        let reach = AROUND * partner.interior.form.cell;
        let is_near = |point: &u32| (partner.surface[*point as usize].place - found).norm() < reach;
        let is_apart = |point: &u32| self.a != b || are_apart(body, [self.number as u32, *point]);
        let square = |point: u32| {
            let place = place(partner, point as usize);
            let off = place + self.lengths.away(place, self.at) - self.at;
            (off.dot(off), point)
        };
        let all = (0..partner.surface.len() as u32).filter(is_near).filter(is_apart).map(square);
        let nearest = all.min_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        let near = NEAR * body.interior.form.cell.max(partner.interior.form.cell);
        let (_, nearest) = nearest.filter(|(square, _)| *square < near * near)?;
        self.in_body((b, ahead, bond), memory(partner.surface[nearest as usize].place))
    }

    /// Where it lies in a partner, sought from where it did before; of itself what lies far from a place of its own.
    fn in_body(&self, (b, ahead, bond): (usize, f64, Bond), before: Memory) -> Option<Touch<D>> {
        let (body, partner) = (&self.bodies[self.a], &self.bodies[b]);
        let start = Vector::of(before.place);
        let toward = Some(normal(body, self.number));
        let away = self.away(partner, start);
        let seen = look((&*partner.interior, partner.shape), self.at - away, start, toward)?;
        let own = body.surface[self.number].place;
        let is_beside = self.a == b && (seen.place - own).norm() <= APART * body.interior.form.cell;
        let (h, k) = (body.interior.form.cell, partner.interior.form.cell);
        let reach = Self::reach(&before, bond, h.min(k));
        if seen.distance >= ahead.max(reach) || is_beside {
            return None;
        }
        let of = |modulus: usize| STIFFNESS / (h / body.moduli[modulus] + k / partner.moduli[modulus]);
        let memory = Memory { place: seen.place.space(), ..before };
        // The partner looks back with the other half.
        let layer = (0.5, [of(0), of(1)]);
        let what = (memory, Met::Deforming(b, seen.weights), away);
        Some(self.touch(what, (seen.normal, seen.distance), layer, (reach, bond)))
    }

    /// From a partner to that image of it [m] in which what was undeformed at `start` is nearest.
    fn away(&self, partner: &Deforming<'_, D>, start: Vector<f64, D>) -> Vector<f64, D> {
        if !self.lengths.any() {
            return Vector::ZERO;
        }
        let nodes = &*partner.interior;
        self.lengths.away(nodes.at(&nodes.form.weights(start), &nodes.places), self.at)
    }

    fn in_obstacle(
        &self,
        (r, obstacle): (usize, &dyn Obstacle),
        (ahead, bond): (f64, Bond),
        memory: Memory,
    ) -> Option<Touch<D>> {
        let body = &self.bodies[self.a];
        let cell = body.interior.form.cell;
        let (level, away) = nearest(obstacle, self.at);
        let reach = Self::reach(&memory, bond, cell);
        if level.distance.is_nan() || level.distance >= ahead.max(reach) {
            return None;
        }
        let face = self.face_in(obstacle, (Vector::of(level.gradient), level.distance), cell);
        let softness = obstacle.softness();
        let of = |k: usize| STIFFNESS * body.moduli[k] / (cell + softness[k] * body.moduli[k]);
        let layer = (1.0, [of(0), of(1)]);
        // Beside an edge no face looks at it: there it touches where it lies inside.
        let is_beside = reach > 0.0 && !looks_at(face.0, normal(body, self.number));
        let reach = if is_beside { 0.0 } else { reach };
        Some(self.touch((memory, Met::Obstacle(r), away), face, layer, (reach, bond)))
    }

    /// Outward normal and distance of the face of an obstacle that a point came through: near an edge it need not be
    /// the nearest. The nearest counts where no face looks at the point, as on a sharp wedge.
    fn face_in(
        &self,
        obstacle: &dyn Obstacle,
        face: (Vector<f64, D>, f64),
        cell: f64,
    ) -> (Vector<f64, D>, f64) {
        let toward = normal(&self.bodies[self.a], self.number);
        if looks_at(face.0, toward) {
            return face;
        }
        let back = toward * (-BACK * cell);
        let (through, distance) = came_through(&nearest(obstacle, self.at + back).0, back);
        if looks_at(through, toward) && distance < 0.0 { (through, distance) } else { face }
    }
}

/// A box around places of a body and a margin.
fn grown<'a, const D: usize>(
    body: &Deforming<'_, D>,
    places: impl IntoIterator<Item = &'a Vector<f64, D>>,
) -> [Vector<f64, D>; 2] {
    let margin = Vector([MARGIN * body.interior.form.cell; D]);
    let none = [Vector([f64::INFINITY; D]), Vector([f64::NEG_INFINITY; D])];
    let [low, high] = places.into_iter().fold(none, |[low, high], at| {
        [Vector::from_fn(|k| low[k].min(at[k])), Vector::from_fn(|k| high[k].max(at[k]))]
    });
    [low - margin, high + margin]
}

/// A box around all nodes that move a body, between which its surface lies.
fn hull<const D: usize>(body: &Deforming<'_, D>) -> [Vector<f64, D>; 2] {
    let Interior { form, masses, places, .. } = &*body.interior;
    let free = places.iter().zip(masses).filter(|(_, mass)| **mass > 0.0).map(|(place, _)| place);
    grown(body, free.chain(form.followers.nodes.iter().map(|&node| &places[node as usize])))
}
