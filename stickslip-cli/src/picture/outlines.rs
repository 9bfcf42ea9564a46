//! Bodies of the plane by their own shapes: rigid ones carried along by two of their particles, others as
//! [`super::carried`] has them.

use super::carried::{CarriedShape, Deforming};
use super::setting::SymmetryPlane;
use stickslip::door::ParticleSnapshot;
use stickslip::geometry::{Bounds, Shape};
use stickslip::scene::{Face, Interior, Scene};

/// The shapes of a run's bodies, tied to the particles of its first snapshot: of rigid ones with bounds, and of those
/// on grids of their own. Other bodies are where their particles are: they may tear and flow.
#[derive(Clone, Debug, Default)]
pub struct Outlines {
    all: Vec<Outline>,
    deforming: Vec<Deforming>,
    cuts: Vec<Cut>,
}

#[derive(Clone, Debug)]
struct Outline {
    body: u32,
    shape: Shape,
    bounds: Bounds,
    /// Numbers of two of its particles, far from each other.
    numbers: [u32; 2],
    /// Where they were at the start [m].
    places: [[f64; 2]; 2],
}

/// A face of the domain that is a mirror: bodies end there.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    axis: usize,
    position: f64,
    /// 1 where the domain lies above it, -1 where it lies below.
    side: f64,
}

/// A shape where its body is.
pub struct PosedShape<'a> {
    pub body: u32,
    shape: &'a Shape,
    bounds: Bounds,
    cuts: &'a [Cut],
    /// Cosine and sine of how far it has turned.
    turn: [f64; 2],
    /// Where the origin of its start is now [m].
    origin: [f64; 2],
    mirror: Option<SymmetryPlane>,
}

impl Outlines {
    /// Those of a plane scene by its particles at the start.
    pub fn new(scene: &Scene, first: &ParticleSnapshot) -> Self {
        let mut own = vec![Vec::new(); scene.bodies.len()];
        let known = first.body.iter().enumerate().filter(|(_, body)| (**body as usize) < own.len());
        known.collect::<Vec<_>>().into_iter().for_each(|(i, body)| own[*body as usize].push(i));
        let outline = |(number, body): (usize, &stickslip::scene::Body)| {
            let bounds = body.shape.bounds(2).filter(|_| body.is_rigid())?;
            let (&one, own) = own[number].split_first()?;
            let apart = |i: &usize| {
                let [a, b] = [first.position[one], first.position[*i]];
                (a[0] - b[0]).hypot(a[1] - b[1])
            };
            let &other = own.iter().max_by(|a, b| apart(a).total_cmp(&apart(b)))?;
            let both = [one, other];
            Some(Outline {
                body: number as u32,
                shape: body.shape.clone(),
                bounds,
                numbers: both.map(|i| first.number[i]),
                places: both.map(|i| [first.position[i][0], first.position[i][1]]),
            })
        };
        let all = scene.bodies.iter().enumerate().filter_map(outline).collect();
        let with_grids = (0..scene.bodies.len()).filter(|&body| scene.interior(body) == Interior::Reference);
        let deforming = with_grids.map(|body| Deforming::new(scene, body, first, &own[body])).collect();
        let cut = |domain: &stickslip::scene::Domain, i: usize| {
            let (axis, side) = (i / 2, i % 2);
            let position = [domain.min, domain.max][side][axis];
            let is_mirror = domain.faces[axis][side] == Face::Symmetry;
            is_mirror.then_some(Cut { axis, position, side: if side == 0 { 1.0 } else { -1.0 } })
        };
        let cuts = scene.domain.iter().flat_map(|domain| (0..4).filter_map(|i| cut(domain, i))).collect();
        Outlines { all, deforming, cuts }
    }

    /// The shapes of bodies on grids of their own in a snapshot, and their mirror images.
    pub fn carried<'a>(
        &'a self,
        particles: &ParticleSnapshot,
        mirror: Option<SymmetryPlane>,
    ) -> Vec<CarriedShape<'a>> {
        let mut own = vec![Vec::new(); self.deforming.len()];
        for (i, body) in particles.body.iter().enumerate() {
            if let Ok(place) = self.deforming.binary_search_by_key(body, |deforming| deforming.body) {
                own[place].push((i as u32, particles.number[i]));
            }
        }
        let carried = |(deforming, own): (&'a Deforming, &Vec<(u32, u32)>)| {
            let count = particles.body.len() as u32;
            let image =
                mirror.map(|mirror| CarriedShape::new(deforming, &self.cuts, own, Some((mirror, count))));
            [Some(CarriedShape::new(deforming, &self.cuts, own, None)), image]
        };
        self.deforming.iter().zip(&own).flat_map(carried).flatten().collect()
    }

    /// The shapes in a snapshot, and their mirror images; bodies whose particles have left have none.
    pub fn posed<'a>(
        &'a self,
        particles: &ParticleSnapshot,
        mirror: Option<SymmetryPlane>,
    ) -> Vec<PosedShape<'a>> {
        let mut places = vec![[None; 2]; self.all.len()];
        let of_body = |body: u32| self.all.binary_search_by_key(&body, |outline| outline.body);
        for (i, &body) in particles.body.iter().enumerate() {
            let Ok(place) = of_body(body) else { continue };
            for (k, number) in self.all[place].numbers.iter().enumerate() {
                if particles.number[i] == *number {
                    places[place][k] = Some([particles.position[i][0], particles.position[i][1]]);
                }
            }
        }
        let pose = |(outline, places): (&'a Outline, &[Option<[f64; 2]>; 2])| -> Option<Vec<PosedShape<'a>>> {
            let now = [places[0]?, places[1]?];
            let way = |ends: &[[f64; 2]; 2]| [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
            let ([a, b], [c, d]) = (way(&outline.places), way(&now));
            let length = a.hypot(b) * c.hypot(d);
            let turn = [(a * c + b * d) / length, (a * d - b * c) / length];
            let start = turned(outline.places[0], turn);
            let posed = |mirror: Option<SymmetryPlane>| PosedShape {
                body: outline.body,
                shape: &outline.shape,
                bounds: outline.bounds,
                cuts: &self.cuts,
                turn,
                origin: [now[0][0] - start[0], now[0][1] - start[1]],
                mirror,
            };
            (length > 0.0).then(|| [None].into_iter().chain(mirror.map(Some)).map(posed).collect())
        };
        self.all.iter().zip(&places).filter_map(pose).flatten().collect()
    }
}

impl Cut {
    /// Whether a place is beyond the face [m].
    pub fn takes(&self, place: [f64; 2]) -> bool {
        (place[self.axis] - self.position) * self.side < 0.0
    }
}

impl PosedShape<'_> {
    /// Whether a place is in it [m].
    pub fn holds(&self, mut place: [f64; 2]) -> bool {
        if let Some(SymmetryPlane { axis, position }) = self.mirror {
            place[axis] = 2.0 * position - place[axis];
        }
        let [cos, sin] = self.turn;
        let away = [place[0] - self.origin[0], place[1] - self.origin[1]];
        let [x, y] = turned(away, [cos, -sin]);
        !self.cuts.iter().any(|cut| cut.takes(place)) && self.shape.contains([x, y, 0.0], 2)
    }

    /// A box around it: lower and upper corner [m].
    pub fn reach(&self) -> [[f64; 2]; 2] {
        let mut reach = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for corner in self.bounds.corners() {
            let place = turned([corner[0], corner[1]], self.turn);
            let mut place = [place[0] + self.origin[0], place[1] + self.origin[1]];
            if let Some(SymmetryPlane { axis, position }) = self.mirror {
                place[axis] = 2.0 * position - place[axis];
            }
            for axis in 0..2 {
                reach[0][axis] = reach[0][axis].min(place[axis]);
                reach[1][axis] = reach[1][axis].max(place[axis]);
            }
        }
        reach
    }
}

fn turned([x, y]: [f64; 2], [cos, sin]: [f64; 2]) -> [f64; 2] {
    [cos * x - sin * y, sin * x + cos * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A beam that has turned by a right angle about the origin, and moved by (3, 0).
    #[test]
    fn a_shape_goes_where_its_particles_are() {
        let text = r#"
            space = { dimension = "plane-strain", interior = "grid", cell = 0.25 }
            time.end = 1
            materials.iron = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 } }
            bodies = [
                { name = "soft", material = "iron", shape.ball = { center = [9, 9], radius = 1 } },
                { name = "beam", material = "iron", shape.box = { min = [1, 0], max = [3, 1] }, rigid = {} },
                { name = "floor", material = "iron", shape.half_space = { point = [0, -9], normal = [0, 1] }, rigid = {} },
            ]
        "#;
        let loaded = stickslip::scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let simulation =
            stickslip::step::build(&loaded.scene).unwrap_or_else(|problem| panic!("{problem:?}"));
        let first = simulation.snapshot();
        let outlines = Outlines::new(&loaded.scene, &first);
        assert_eq!(outlines.all.len(), 1, "the beam alone");
        let mut later = first.clone();
        for x in &mut later.position {
            *x = [3.0 - x[1], x[0], 0.0];
        }
        let mirror = SymmetryPlane { axis: 0, position: 0.0 };
        let posed = outlines.posed(&later, Some(mirror));
        let near = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
            a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert!(near(posed[0].reach(), [[2.0, 1.0], [3.0, 3.0]]));
        assert!(near(posed[1].reach(), [[-3.0, 1.0], [-2.0, 3.0]]));
        for (x, inside) in
            [([2.01, 1.01], true), ([2.99, 2.99], true), ([1.99, 2.0], false), ([2.5, 3.01], false)]
        {
            assert_eq!(posed[0].holds(x), inside, "{x:?}");
            assert_eq!(posed[1].holds([-x[0], x[1]]), inside, "{x:?}");
        }
        assert!(outlines.posed(&ParticleSnapshot::default(), None).is_empty());
    }
}
