//! Which points of surfaces touch which partners.

use super::{Deforming, Memory, Met, Rigid, STIFFNESS, Touch, look};
use crate::surface::SurfacePoint;
use rayon::prelude::*;
use std::collections::HashMap;
use stickslip_mechanics::geometry::Shape;
use stickslip_mechanics::geometry::form::digits;
use stickslip_mechanics::tensor::Vector;

/// A pair of bodies that may touch: the second deforms, or is rigid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// Place in the list of bodies that deform.
    Deforming(usize),
    /// Place in the list of rigid bodies.
    Rigid(usize),
}

/// How far boxes may be apart whose bodies are looked at, in cells.
const MARGIN: f64 = 1e-3;
/// How far points may lie from the nearest point of the partner's surface, in cells.
const NEAR: f64 = 1.5;

/// The points that touch, by body, point and partner. `meet` says whether a body touches a partner at all; `known` are
/// the points that touched before, in the same order.
pub fn find<const D: usize>(
    bodies: &[Deforming<'_, D>],
    rigids: &[&dyn Rigid],
    known: &[Memory],
    meet: &(dyn Fn(usize, Partner) -> bool + Sync),
) -> Vec<Touch<D>> {
    let boxes: Vec<_> = bodies.iter().map(|body| grown(body)).collect();
    let pairs = pairs(&boxes);
    let mut near = vec![Vec::new(); bodies.len()];
    for [a, b] in pairs {
        near[a].push(b);
        near[b].push(a);
    }
    (near.iter_mut().enumerate()).filter(|(a, _)| may_fold(&bodies[*a])).for_each(|(a, near)| near.push(a));
    let partners = |a: usize| {
        let deforming = near[a].iter().copied().filter(|&b| meet(a, Partner::Deforming(b))).collect();
        let close = |(_, rigid): &(usize, &&dyn Rigid)| overlap(&boxes[a], &rigid.bounds().map(Vector::of));
        let rigid = rigids.iter().enumerate().filter(close).map(|(r, _)| r);
        (deforming, rigid.filter(|&r| meet(a, Partner::Rigid(r))).collect())
    };
    let partners: Vec<(Vec<usize>, Vec<usize>)> = (0..bodies.len()).map(partners).collect();
    // Where the points are of bodies that may touch anything.
    let places = |(body, (deforming, rigid)): (&Deforming<'_, D>, &(Vec<usize>, Vec<usize>))| {
        let of = |point: &SurfacePoint<D>| body.interior.at(&point.weights, &body.interior.places);
        let asked = !(deforming.is_empty() && rigid.is_empty());
        if asked { body.surface.iter().map(of).collect() } else { Vec::new() }
    };
    let places: Vec<Vec<Vector<f64, D>>> = bodies.par_iter().zip(&partners).map(places).collect();
    let of_body = |a: usize| {
        let (deforming, rigid) = &partners[a];
        touches_of((bodies, &places, a), (deforming, &boxes), (rigid, rigids), known)
    };
    let mut touches: Vec<_> = (0..bodies.len()).into_par_iter().map(of_body).collect::<Vec<_>>().concat();
    touches.sort_by_key(|touch| key(&touch.memory));
    touches
}

/// The points of a body's surface, at these places, that touch any of these partners.
fn touches_of<const D: usize>(
    (bodies, places, a): (&[Deforming<'_, D>], &[Vec<Vector<f64, D>>], usize),
    (partners, boxes): (&[usize], &[[Vector<f64, D>; 2]]),
    (rigid, rigids): (&[usize], &[&dyn Rigid]),
    known: &[Memory],
) -> Vec<Touch<D>> {
    let mut touches = Vec::new();
    let grid = |&b: &usize| Neighbours::new(&places[b], bodies[b].interior.form.cell, &boxes[a]);
    let grids: Vec<Neighbours<D>> = partners.iter().map(grid).collect();
    for (number, &at) in places[a].iter().enumerate() {
        let seen = Point { bodies, a, number, at };
        for (&b, grid) in partners.iter().zip(&grids) {
            if inside(&boxes[b], at) {
                // What is beside it is no partner.
                let own = (a == b).then_some(bodies[a].surface[number].place);
                touches.extend(seen.in_body(b, (grid, own), known));
            }
        }
        touches.extend(rigid.iter().filter_map(|&r| seen.in_rigid((r, rigids[r]), known)));
    }
    touches
}

fn key(memory: &Memory) -> (u32, u32, u32) {
    (memory.body, memory.point, memory.partner)
}

/// How far apart two places of one body must be, undeformed, to touch each other: functions tie what is nearer together
/// [cells].
const APART: f64 = 3.0;
/// Sides of a box of which the longest is less than this many times the shortest do not fold.
const STOUT: f64 = 3.0;

/// Whether parts of a body may touch each other: of all but balls and stout boxes.
fn may_fold<const D: usize>(body: &Deforming<'_, D>) -> bool {
    let shape = match body.shape {
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
}

impl<const D: usize> Point<'_, '_, D> {
    /// Outward normal of the deformed surface, F^-T N.
    fn normal(&self) -> Vector<f64, D> {
        let body = &self.bodies[self.a];
        let point = &body.surface[self.number];
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

    fn remembered(&self, partner: usize, known: &[Memory]) -> Option<Memory> {
        let key_here = (self.bodies[self.a].body as u32, self.number as u32, partner as u32);
        known.binary_search_by_key(&key_here, key).ok().map(|place| known[place])
    }

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
            speed: 0.0,
        }
    }

    /// A point that touches, with the share of its area on which it does.
    fn touch(
        &self,
        (memory, met): (Memory, Met<D>),
        (normal, gap): (Vector<f64, D>, f64),
        (share, stiffness): (f64, [f64; 2]),
    ) -> Touch<D> {
        Touch {
            memory,
            side: self.a,
            met,
            at: self.at,
            normal,
            gap,
            area: share * self.bodies[self.a].surface[self.number].area,
            stiffness,
            traction: Vector::ZERO,
            friction: 0.0,
            slip: Vector::ZERO,
        }
    }

    /// Where it lies in a partner; of itself what lies far from a place of its own.
    fn in_body(
        &self,
        b: usize,
        (grid, own): (&Neighbours<D>, Option<Vector<f64, D>>),
        known: &[Memory],
    ) -> Option<Touch<D>> {
        let (body, partner) = (&self.bodies[self.a], &self.bodies[b]);
        let apart = APART * body.interior.form.cell;
        let is_apart = |place: Vector<f64, D>| own.is_none_or(|own| (place - own).norm() > apart);
        let before = self.remembered(partner.body, known);
        let start = match before {
            Some(before) => Vector::of(before.place),
            None => {
                partner.surface[grid.nearest(self.at, |point| is_apart(partner.surface[point].place))?].place
            }
        };
        let seen = look((partner.interior, partner.shape), self.at, start, Some(self.normal()))?;
        if seen.distance >= 0.0 || !is_apart(seen.place) {
            return None;
        }
        let (h, k) = (body.interior.form.cell, partner.interior.form.cell);
        let of = |modulus: usize| STIFFNESS / (h / body.moduli[modulus] + k / partner.moduli[modulus]);
        let before = before.unwrap_or_else(|| self.fresh(partner.body));
        let memory = Memory { place: seen.place.space(), ..before };
        // The partner looks back with the other half.
        let layer = (0.5, [of(0), of(1)]);
        Some(self.touch((memory, Met::Deforming(b, seen.weights)), (seen.normal, seen.distance), layer))
    }

    fn in_rigid(&self, (r, rigid): (usize, &dyn Rigid), known: &[Memory]) -> Option<Touch<D>> {
        let level = rigid.level(self.at.space());
        if level.distance.is_nan() || level.distance >= 0.0 {
            return None;
        }
        let body = &self.bodies[self.a];
        let memory = self.remembered(rigid.body(), known).unwrap_or_else(|| self.fresh(rigid.body()));
        let layer = (1.0, body.moduli.map(|modulus| STIFFNESS * modulus / body.interior.form.cell));
        Some(self.touch((memory, Met::Rigid(r)), (Vector::of(level.gradient), level.distance), layer))
    }
}

/// Points of a body's surface that lie in a box, by cells of a lattice as wide as they may be far.
struct Neighbours<const D: usize> {
    width: f64,
    points: HashMap<[i32; D], Vec<(u32, Vector<f64, D>)>>,
}

impl<const D: usize> Neighbours<D> {
    /// Of points at these places.
    fn new(places: &[Vector<f64, D>], cell: f64, around: &[Vector<f64, D>; 2]) -> Self {
        let width = NEAR * cell;
        let mut points: HashMap<_, Vec<_>> = HashMap::new();
        let reach = Vector([width; D]);
        let around = [around[0] - reach, around[1] + reach];
        for (number, &at) in places.iter().enumerate() {
            if inside(&around, at) {
                points.entry(Self::cell(at, width)).or_default().push((number as u32, at));
            }
        }
        Neighbours { width, points }
    }

    fn cell(at: Vector<f64, D>, width: f64) -> [i32; D] {
        std::array::from_fn(|a| (at[a] / width).floor() as i32)
    }

    /// The nearest of those that count, if one is near; of several the first.
    fn nearest(&self, at: Vector<f64, D>, counts: impl Fn(usize) -> bool) -> Option<usize> {
        let here = Self::cell(at, self.width);
        let mut best: Option<(f64, u32)> = None;
        for number in 0..3_usize.pow(D as u32) {
            let step = digits(number, [3; D]);
            let cell = std::array::from_fn(|a| here[a] + step[a] as i32 - 1);
            for &(point, x) in self.points.get(&cell).into_iter().flatten() {
                let square = (x - at).dot(x - at);
                if square < self.width * self.width
                    && counts(point as usize)
                    && best.is_none_or(|best| (square, point) < best)
                {
                    best = Some((square, point));
                }
            }
        }
        best.map(|(_, point)| point as usize)
    }
}

/// A box around a body and a margin.
fn grown<const D: usize>(body: &Deforming<'_, D>) -> [Vector<f64, D>; 2] {
    let margin = Vector([MARGIN * body.interior.form.cell; D]);
    let [low, high] = body.interior.bounds();
    [low - margin, high + margin]
}

fn overlap<const D: usize>(a: &[Vector<f64, D>; 2], b: &[Vector<f64, D>; 2]) -> bool {
    (0..D).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

fn inside<const D: usize>(bounds: &[Vector<f64, D>; 2], at: Vector<f64, D>) -> bool {
    (0..D).all(|k| bounds[0][k] <= at[k] && at[k] <= bounds[1][k])
}

/// Pairs of boxes that overlap, the first by its lower number: by a sweep along the first axis.
fn pairs<const D: usize>(boxes: &[[Vector<f64, D>; 2]]) -> Vec<[usize; 2]> {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0][0].total_cmp(&boxes[b][0][0]).then(a.cmp(&b)));
    let mut found = Vec::new();
    for (place, &a) in order.iter().enumerate() {
        for &b in order[place + 1..].iter().take_while(|&&b| boxes[b][0][0] <= boxes[a][1][0]) {
            if overlap(&boxes[a], &boxes[b]) {
                found.push([a.min(b), a.max(b)]);
            }
        }
    }
    found.sort_unstable();
    found
}
