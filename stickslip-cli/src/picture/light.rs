//! Light on balls, surfaces and half-spaces: a lamp with shadows, light from the sky that corners get less of, and a
//! dark rim where bodies end.

use super::camera::{Camera, Point};
use super::floor::{SlabHit, Slabs, SlabsInView};
use super::grains::Grain;
use super::skins::Mesh;
use super::splat::{Layer, Shares, splat, splat_triangles};
use super::surface::Ball;
use crate::drawing::{Rgb, SAMPLES, Scale, body_color, shaded};
use rayon::prelude::*;
use stickslip::tensor::Vector;

/// Share of a ball's own normal in the normal that light sees; the rest is that of the body's surface.
const GRAININESS: f64 = 0.24;
/// Points around another at which it is looked for what hides the sky from it.
const PROBES: usize = 20;
/// Distance over which corners darken, in ball radii.
const CORNER: f64 = 5.0;
/// Cosine of the angle between a triangle and the surface around a corner of it beyond which the body has an edge
/// there.
const EDGE: f64 = 0.72;
/// Light left where a body ends.
const RIM: f64 = 0.55;
/// Pixels along each side of the picture that the lamp sees.
const SHADOW_MAP: usize = 2048;

/// A lit scene.
pub struct Lit<'a> {
    grains: &'a [Grain],
    balls: &'a [Ball],
    mesh: Mesh,
    tint: Tint,
    /// The corners of the mesh in the image.
    seen: Vec<[f64; 3]>,
    camera: Camera,
    layer: Layer,
    lamp: Camera,
    shadows: Layer,
    radius: f64,
    contrast: f64,
    mirrored: bool,
    slabs: SlabsInView,
    /// The colour of half-spaces; that of their bodies, without it.
    slab_color: Option<Rgb>,
    /// Where around a point it is looked for what hides the sky [m].
    probes: Vec<[f64; 2]>,
    /// Of each pixel of the file, what falls on the surface in its middle.
    coarse: Vec<Option<Illumination>>,
}

/// How much of the light there is arrives at a surface.
#[derive(Clone, Copy, Debug)]
struct Illumination {
    /// Where the surface is, and which way it faces: a pixel next to it sees the same if these differ little.
    depth: f32,
    normal: [f32; 3],
    /// Shares of the lamp's light and of the sky's.
    lamp: f32,
    sky: f32,
}

/// A point of a surface.
#[derive(Clone, Copy)]
struct Lighted {
    depth: f64,
    normal: Point,
    color: Rgb,
    /// Light left at the rim of a body.
    rim: f64,
}

/// A point of a body that a pixel sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Index of the body.
    pub body: u32,
    /// Where it is [m].
    pub place: Point,
    /// Towards the eye [m].
    pub depth: f64,
    /// Whether it is the mirror image of another.
    pub is_image: bool,
}

/// What colours surfaces have.
pub enum Tint {
    /// Those of bodies, which in every other quarter of a round one are paler; of each body the centre if it is round.
    Bodies(Vec<Option<[f64; 3]>>),
    /// Those of values.
    Values(Scale),
}

/// What there is to be lit besides balls, and how.
pub struct Surroundings {
    /// Surfaces of bodies.
    pub mesh: Mesh,
    /// Their colours.
    pub tint: Tint,
    /// Radius of a ball, and what rooms and corners are measured by [m].
    pub radius: f64,
    /// Half-spaces at rest.
    pub slabs: Slabs,
    /// Their colour; that of their bodies, without it.
    pub slab_color: Option<Rgb>,
    /// 1 for light as it falls, 0 for colours as they are.
    pub contrast: f64,
    /// Whether the second half of the balls and of the triangles is the mirror image of the first.
    pub mirrored: bool,
}

impl<'a> Lit<'a> {
    /// Draws the balls for the eye and for the lamp.
    pub fn new(
        grains: &'a [Grain],
        balls: &'a [Ball],
        camera: Camera,
        size: [usize; 2],
        surroundings: Surroundings,
    ) -> Self {
        let Surroundings { mesh, tint, radius, slabs, slab_color, contrast, mirrored } = surroundings;
        let toward = camera.toward * 0.62 + camera.up * 0.66 - camera.right * 0.42;
        let lamp = Camera::facing(toward.direction().expect("the eye is not opposite the lamp"), camera.up);
        let side = SHADOW_MAP as f64;
        let points = balls.iter().map(|ball| ball.center).chain(mesh.corners.iter().copied());
        let lamp = lamp.fit(points, [8.0, 8.0, side - 16.0, side - 16.0]);
        let layers = |camera: &Camera, size: [usize; 2]| {
            let corners: Vec<[f64; 3]> =
                mesh.corners.par_iter().map(|corner| camera.project(*corner)).collect();
            let mut layer = splat(balls, camera, size);
            splat_triangles(&mut layer, &corners, &mesh.triangles, balls.len() as u32);
            (layer, corners)
        };
        let ((layer, seen), (shadows, _)) = (layers(&camera, size), layers(&lamp, [SHADOW_MAP; 2]));
        // Points on a sunflower: evenly spread over a disk.
        let probe = |k: usize| {
            let (r, angle) =
                (((k as f64 + 0.5) / PROBES as f64).sqrt() * CORNER * radius, k as f64 * 2.399_963);
            [r * angle.cos(), r * angle.sin()]
        };
        let mut lit = Lit {
            grains,
            balls,
            camera,
            layer,
            lamp,
            shadows,
            mesh,
            tint,
            seen,
            radius,
            contrast,
            mirrored,
            slabs: slabs.seen(&camera),
            slab_color,
            probes: (0..PROBES).map(probe).collect(),
            coarse: Vec::new(),
        };
        // What is costly and varies slowly is found once for the samples of a pixel.
        let [columns, rows] = size.map(|side| side / SAMPLES);
        let middle = |place: usize| {
            let pixel = [place % columns, place / columns].map(|index| index * SAMPLES + SAMPLES / 2);
            lit.surface(pixel).map(|point| lit.illumination(pixel, &point))
        };
        lit.coarse = (0..columns * rows).into_par_iter().map(middle).collect();
        lit
    }

    /// The colour of a pixel; `None` where there is nothing.
    pub fn color(&self, x: usize, y: usize) -> Option<Rgb> {
        let point = self.surface([x, y])?;
        let columns = self.layer.size[0] / SAMPLES;
        let coarse = self.coarse.get(y / SAMPLES * columns + x / SAMPLES).copied().flatten();
        let alike = |near: &Illumination| {
            let normal = Vector(near.normal.map(f64::from));
            (f64::from(near.depth) - point.depth).abs() < self.radius && normal.dot(point.normal) > 0.9
        };
        let here = coarse.filter(alike).unwrap_or_else(|| self.illumination([x, y], &point));
        Some(self.shine(&point, here))
    }

    /// The point of a body that a pixel sees; half-spaces are none.
    pub fn sight(&self, [x, y]: [usize; 2]) -> Option<Sight> {
        let place = y * self.layer.size[0] + x;
        let depth = f64::from(self.layer.depth[place]);
        let sight = [x as f64 + 0.5, y as f64 + 0.5];
        if self.slabs.hit(sight).is_some_and(|hit| hit.depth > depth) {
            return None;
        }
        let body = self.body(self.layer.ball[place])?;
        let index = self.layer.ball[place] as usize;
        let is_second = match index.checked_sub(self.balls.len()) {
            None => self.balls[index].grain >= self.grains.len() / 2,
            Some(triangle) => triangle >= self.mesh.triangles.len() / 2,
        };
        let place = self.camera.unproject([sight[0], sight[1], depth]);
        Some(Sight { body, place, depth, is_image: self.mirrored && is_second })
    }

    /// Width and height in drawn pixels.
    pub fn size(&self) -> [usize; 2] {
        self.layer.size
    }

    /// Where neighbouring pixels of the file differ by more in depth, a body is in front of itself [m].
    pub fn step(&self) -> f64 {
        self.radius.max(8.0 * SAMPLES as f64 / self.camera.scale)
    }

    /// Whether another body, or a half-space, is in front of a point of a body at a pixel, so deep towards the eye [m].
    pub fn hides(&self, [x, y]: [usize; 2], (body, depth): (u32, f64)) -> bool {
        let place = y * self.layer.size[0] + x;
        let is_before =
            |other: u32, at: f64| other != body && at > depth + f64::from(f32::EPSILON) * depth.abs();
        let slab = self.slabs.hit([x as f64 + 0.5, y as f64 + 0.5]);
        slab.is_some_and(|hit| is_before(hit.body, hit.depth))
            || self
                .body(self.layer.ball[place])
                .is_some_and(|other| is_before(other, f64::from(self.layer.depth[place])))
    }

    /// The surface that a pixel sees.
    fn surface(&self, [x, y]: [usize; 2]) -> Option<Lighted> {
        let place = y * self.layer.size[0] + x;
        let depth = f64::from(self.layer.depth[place]);
        let sight = [x as f64 + 0.5, y as f64 + 0.5];
        let slab = self.slabs.hit(sight).filter(|hit| hit.depth > depth);
        if let Some(hit) = slab {
            let color = self.slab_color.unwrap_or_else(|| body_color(hit.body as usize));
            return Some(Lighted { depth: hit.depth, normal: hit.normal, color, rim: self.edge(sight, hit) });
        }
        let index = self.layer.ball[place] as usize;
        let rim = || self.rim([x, y]);
        let Some(ball) = self.balls.get(index) else {
            let triangle = index.checked_sub(self.balls.len()).filter(|i| *i < self.mesh.triangles.len())?;
            let (normal, color) = self.face(triangle, sight)?;
            return Some(Lighted { depth, normal, color, rim: rim() });
        };
        let point = self.camera.unproject([sight[0], sight[1], depth]);
        let own = (point - ball.center) / ball.radius;
        let normal = (own * GRAININESS + ball.normal * (1.0 - GRAININESS)).direction().unwrap_or(own);
        Some(Lighted { depth, normal, color: self.grains[ball.grain].color, rim: rim() })
    }

    /// Normal and colour of a triangle at a pixel: those of its corners by their shares in the place, but for corners
    /// at an edge of the body.
    fn face(&self, triangle: usize, sight: [f64; 2]) -> Option<(Point, Rgb)> {
        let corners = self.mesh.triangles[triangle].map(|corner| corner as usize);
        let shares = Shares::new(corners.map(|corner| self.seen[corner]))?.at(sight);
        let flat = self.mesh.face(triangle);
        let at = |corner: usize| {
            let normal = self.mesh.normals[corner];
            if normal.dot(flat) > EDGE { normal } else { flat }
        };
        let normal = (0..3).fold(Vector::ZERO, |sum, k| sum + at(corners[k]) * shares[k]);
        // A surface cut open shows its inside.
        let normal = normal.direction().unwrap_or(flat);
        let normal = if normal.dot(self.camera.toward) < 0.0 && flat.dot(self.camera.toward) < 0.0 {
            -normal
        } else {
            normal
        };
        let color = match &self.tint {
            Tint::Values(scale) => {
                scale.color((0..3).map(|k| shares[k] * self.mesh.values[corners[k]]).sum())
            }
            Tint::Bodies(centers) => {
                let body = self.mesh.body[triangle] as usize;
                let start = |axis: usize| {
                    (0..3).map(|k| shares[k] * self.mesh.reference[corners[k]][axis]).sum::<f64>()
                };
                let is_below =
                    |center: &[f64; 3]| (0..3).filter(|&axis| start(axis) < center[axis]).count() % 2 == 1;
                let is_pale = centers.get(body).and_then(Option::as_ref).is_some_and(is_below);
                let color = body_color(body);
                if is_pale { shaded(color, 1.6) } else { color }
            }
        };
        Some((normal, color))
    }

    /// The body of what the layer has an index of.
    fn body(&self, index: u32) -> Option<u32> {
        let index = index as usize;
        match self.balls.get(index) {
            Some(ball) => Some(self.grains[ball.grain].body),
            None => self.mesh.body.get(index - self.balls.len()).copied(),
        }
    }

    /// Darkens a pixel at the edge of a half-space.
    fn edge(&self, [x, y]: [f64; 2], hit: SlabHit) -> f64 {
        let reach = (SAMPLES / 2 + 1) as f64;
        let around = [[-reach, 0.0], [reach, 0.0], [0.0, -reach], [0.0, reach]];
        let inside = around.iter().all(|[dx, dy]| hit.is_beside(self.slabs.hit([x + dx, y + dy])));
        if inside { 1.0 } else { RIM }
    }

    fn illumination(&self, [x, y]: [usize; 2], point: &Lighted) -> Illumination {
        let Lighted { depth, normal, .. } = *point;
        let faces = normal.dot(self.lamp.toward) > 0.0;
        let place = self.camera.unproject([x as f64 + 0.5, y as f64 + 0.5, depth]);
        let lamp = if faces { self.lit_share(place, normal) } else { 0.0 };
        let sky = self.openness([x, y], normal, depth);
        Illumination {
            depth: depth as f32,
            normal: normal.0.map(|n| n as f32),
            lamp: lamp as f32,
            sky: sky as f32,
        }
    }

    /// A surface's colour in the light that falls on it.
    fn shine(&self, point: &Lighted, here: Illumination) -> Rgb {
        let Lighted { normal, color, rim, .. } = *point;
        let (open, arrives) = (f64::from(here.sky), f64::from(here.lamp));
        let lamp = normal.dot(self.lamp.toward).max(0.0) * arrives;
        let half = (self.lamp.toward + self.camera.toward).direction().expect("lamp and eye are on one side");
        let gloss = 0.10 * normal.dot(half).max(0.0).powi(28) * if lamp > 0.0 { 1.0 } else { 0.0 };
        let sky = 0.75 + 0.25 * normal.dot(self.camera.up);
        let light = 0.68 * sky * open + 0.60 * lamp * (0.6 + 0.4 * open);
        let light = (1.0 + self.contrast * (light - 1.0)) * rim;
        color.map(|c| (c * light as f32 + gloss as f32).clamp(0.0, 1.0))
    }

    /// Share of the lamp's light that arrives: the mean over a small patch of the lamp's own picture.
    fn lit_share(&self, point: Point, normal: Point) -> f64 {
        let [x, y, depth] = self.lamp.project(point + normal * (0.7 * self.radius));
        let bias = 0.5 * self.radius;
        let spread = (0.45 * self.radius * self.lamp.scale).max(1.0);
        let arrives = |k: i64| {
            let (dx, dy) = (((k % 5 - 2) as f64) * spread, ((k / 5 - 2) as f64) * spread);
            let blocker = self.shadows.depth_at((x + dx).floor() as i64, (y + dy).floor() as i64);
            f64::from(u8::from(f64::from(blocker) < depth + bias))
        };
        (0..25).map(arrives).sum::<f64>() / 25.0
    }

    /// 1 on open ground, less in corners: how little of the surroundings in the image stands above the tangent plane.
    fn openness(&self, [x, y]: [usize; 2], normal: Point, depth: f64) -> f64 {
        let reach = CORNER * self.radius;
        let normal =
            [normal.dot(self.camera.right), normal.dot(self.camera.up), normal.dot(self.camera.toward)];
        let hidden = |&[dx, dy]: &[f64; 2]| {
            let pixel = |offset: f64| (offset * self.camera.scale) as i64;
            let there = self.layer.depth_at(x as i64 + pixel(dx), y as i64 - pixel(dy));
            let rise = f64::from(there) - depth;
            if rise < -reach {
                return 0.0;
            }
            let distance = (dx * dx + dy * dy + rise * rise).sqrt().max(1e-12);
            let cosine = (normal[0] * dx + normal[1] * dy + normal[2] * rise) / distance;
            let fade = (1.0 - (distance / (2.0 * reach)).powi(2)).max(0.0);
            (cosine - 0.15).max(0.0) * fade
        };
        let hidden = self.probes.iter().map(hidden).sum::<f64>() / PROBES as f64;
        (1.0 - 2.2 * hidden).max(0.25)
    }

    /// Darkens a pixel next to another body or to the background.
    fn rim(&self, [x, y]: [usize; 2]) -> f64 {
        let [width, height] = self.layer.size;
        let body = self.body(self.layer.ball[y * width + x]);
        let reach = SAMPLES as i64 / 2 + 1;
        let other = |dx: i64, dy: i64| {
            let (x, y) = (x as i64 + dx, y as i64 + dy);
            if x < 0 || y < 0 || x >= width as i64 || y >= height as i64 {
                return false;
            }
            self.body(self.layer.ball[y as usize * width + x as usize]) != body
        };
        let at_rim = other(-reach, 0) || other(reach, 0) || other(0, -reach) || other(0, reach);
        if at_rim { RIM } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::Viewpoint;
    use super::super::setting::{Floor, Setting};
    use super::super::{sample, surface::surface};
    use super::*;

    #[test]
    fn the_side_that_faces_the_lamp_is_brighter() {
        let grains = sample::ball([0.0; 3], 1.0, 0.1);
        let balls = surface(&grains);
        let camera = Camera::new(Viewpoint::Auto, &Setting::default());
        let corners = [Vector([-1.2; 3]), Vector([1.2; 3])];
        let camera = camera.fit(corners, [0.0, 0.0, 200.0, 200.0]);
        let lit = |floors: &[Floor]| {
            let slabs = Slabs::new(floors, &camera, [Vector([-1.0; 3]), Vector([1.0; 3])]);
            let surroundings = Surroundings {
                mesh: Mesh::default(),
                tint: Tint::Bodies(Vec::new()),
                radius: 0.07,
                slabs,
                slab_color: Some([0.8; 3]),
                contrast: 1.0,
                mirrored: false,
            };
            Lit::new(&grains, &balls, camera, [200, 200], surroundings)
        };
        let under = lit(&[Floor { body: 0, point: [0.0, 0.0, -1.0], normal: [0.0, 0.0, 1.0] }]);
        let seen = |point: [f64; 3]| {
            let [x, y, _] = camera.project(Vector(point));
            under.color(x as usize, y as usize).map(|rgb| rgb.iter().sum::<f32>())
        };
        let (lit_floor, shadow) = (seen([0.95, -0.95, -1.0]).unwrap(), seen([0.1, -0.1, -1.0]));
        assert!(
            shadow.is_some_and(|shadow| shadow < lit_floor),
            "the floor is below the ball, in its shadow"
        );
        let lit = lit(&[]);
        let brightness = |x, y| lit.color(x, y).map(|rgb| rgb.iter().sum::<f32>());
        assert!(brightness(80, 70).unwrap() > 1.5 * brightness(120, 140).unwrap());
        assert_eq!(brightness(2, 2), None);
    }
}
