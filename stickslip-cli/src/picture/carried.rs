//! Bodies of the plane on grids of their own: their shapes as the particles have carried them along.
//!
//! A place belongs to such a body if what is there was in the undeformed shape at the start:
//!
//! ```text
//! X = sum_p w_p (X_p + d_p) / sum_p w_p,   d_p = F_p^-1 (x - x_p),   w_p = (1 - |d_p|^2 / R^2)^2,   R = 1.8 s
//! ```
//!
//! x, X: a place now and at the start [m]; x_p, X_p, F_p: the same of particle p, and its deformation gradient; s: side
//! of the body's largest particle. In a body that has folded, parts touch that were far from each other: a place goes
//! with the particles that were near its nearest one at the start.

use super::band::Band;
use super::grains::Grain;
use super::outlines::Cut;
use super::setting::SymmetryPlane;
use rayon::prelude::*;
use stickslip::door::ParticleSnapshot;
use stickslip::geometry::Shape;
use stickslip::scene::Scene;

/// How far a particle carries what is around it, and how far from each other particles were that carry the same, in
/// sides of the largest.
const REACH: f64 = 1.8;
const TOGETHER: f64 = 2.5;
/// Deeper in the shape, nothing that a particle is nearest to lies outside, and nothing that it carries.
const NEAREST: f64 = 1.5;
const CARRIES: f64 = 4.0;

/// A body on a grid of its own at the start.
#[derive(Clone, Debug)]
pub struct Deforming {
    /// Its index.
    pub body: u32,
    shape: Shape,
    /// Side of the square of its largest particle [m].
    side: f64,
    /// Numbers of its particles, in order.
    numbers: Vec<u32>,
    /// Where they were [m].
    places: Vec<[f64; 2]>,
    /// How deep in the shape, in sides of the largest.
    depths: Vec<f64>,
}

/// Such a body, or its mirror image, in a snapshot.
pub struct CarriedShape<'a> {
    /// Its index.
    pub body: u32,
    deforming: &'a Deforming,
    cuts: &'a [Cut],
    /// Its grains, and the places of these among its particles.
    grains: Vec<(u32, u32)>,
    /// The axis across which it is an image.
    mirrored: Option<usize>,
}

/// What is known of the pixels of a band while a shape is drawn.
pub struct Workspace {
    pixels: Vec<Sought>,
    /// Those with a nearest grain that are to be settled, and those that have been.
    touched: Vec<usize>,
    settled: Vec<usize>,
}

/// A pixel that may be in a shape.
#[derive(Clone)]
struct Sought {
    /// The nearest of the shape's grains, and the square of its distance [m^2].
    nearest: usize,
    far: f64,
    /// Sums of w, w X and w Y.
    sums: [f64; 3],
    state: PixelState,
}

#[derive(Clone, Copy)]
enum PixelState {
    Unknown,
    Marked,
    /// By what is around this grain, which is the nearest, it is not in the shape.
    Missed(usize),
}

const UNKNOWN: Sought = Sought { nearest: 0, far: f64::INFINITY, sums: [0.0; 3], state: PixelState::Unknown };

impl Deforming {
    /// A body of a scene by its particles in the first snapshot, `own`.
    pub fn new(scene: &Scene, body: usize, first: &ParticleSnapshot, own: &[usize]) -> Self {
        let mut own = own.to_vec();
        own.sort_by_key(|&i| first.number[i]);
        let shape = scene.bodies[body].shape.clone();
        let side = own.iter().map(|&i| first.volume[i]).fold(0.0, f64::max).sqrt();
        Deforming {
            body: body as u32,
            side,
            numbers: own.iter().map(|&i| first.number[i]).collect(),
            places: own.iter().map(|&i| [first.position[i][0], first.position[i][1]]).collect(),
            depths: own.par_iter().map(|&i| -shape.distance(first.position[i], 2) / side).collect(),
            shape,
        }
    }
}

impl<'a> CarriedShape<'a> {
    /// Of a body with these particles of a snapshot, place and number, or of its mirror image, whose grains come after
    /// so many.
    pub fn new(
        deforming: &'a Deforming,
        cuts: &'a [Cut],
        own: &[(u32, u32)],
        mirror: Option<(SymmetryPlane, u32)>,
    ) -> Self {
        let before = mirror.map_or(0, |(_, count)| count);
        let known = |&(i, number): &(u32, u32)| {
            let place = deforming.numbers.binary_search(&number).ok()?;
            Some((before + i, place as u32))
        };
        CarriedShape {
            body: deforming.body,
            deforming,
            cuts,
            grains: own.iter().filter_map(known).collect(),
            mirrored: mirror.map(|(mirror, _)| mirror.axis),
        }
    }

    /// Marks what of a band is in the shape by the nearest of its grains.
    pub fn draw(&self, grains: &[Grain], band: &Band, pixels: &mut [u32], work: &mut Workspace) {
        let all = 0..self.grains.len();
        self.seek((grains, all.clone()), band, work);
        self.settle(pixels, work);
        // What another part of the body overlaps or touches may be nearer to that one.
        let near_surface = all.filter(|&k| self.depth(k) < NEAREST);
        self.seek((grains, near_surface), band, work);
        self.settle(pixels, work);
        work.settled.drain(..).for_each(|pixel| work.pixels[pixel] = UNKNOWN);
    }

    /// Finds of each pixel the nearest of some grains, and where what is there was at the start.
    fn seek(
        &self,
        (grains, some): (&[Grain], impl Iterator<Item = usize>),
        band: &Band,
        Workspace { pixels, touched, .. }: &mut Workspace,
    ) {
        let side = self.deforming.side;
        for k in some {
            band.visit(&grains[self.grains[k].0 as usize], side, |pixel, [x, y]| {
                let (sought, far) = (&mut pixels[pixel], x * x + y * y);
                let may_be = match sought.state {
                    PixelState::Unknown => true,
                    PixelState::Marked => false,
                    PixelState::Missed(other) => !self.are_together(k, other),
                };
                if far < sought.far && may_be {
                    if sought.far == f64::INFINITY {
                        touched.push(pixel);
                    }
                    (sought.nearest, sought.far) = (k, far);
                }
            });
        }
        if touched.is_empty() {
            return;
        }
        let square = (REACH * side) * (REACH * side);
        for k in (0..self.grains.len()).filter(|&k| self.depth(k) < CARRIES) {
            let [x, y] = self.start(k);
            band.visit(&grains[self.grains[k].0 as usize], REACH * side, |pixel, mut local| {
                let sought = &mut pixels[pixel];
                let gap = 1.0 - (local[0] * local[0] + local[1] * local[1]) / square;
                let is_sought = sought.far < f64::INFINITY && self.depth(sought.nearest) < NEAREST;
                if gap > 0.0 && is_sought && self.are_together(k, sought.nearest) {
                    if let Some(axis) = self.mirrored {
                        local[axis] = -local[axis];
                    }
                    let weight = gap * gap;
                    let more = [1.0, x + local[0], y + local[1]];
                    sought.sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += weight * more);
                }
            });
        }
    }

    /// Marks the pixels that are in the shape, and leaves the others to be sought again.
    fn settle(&self, marked: &mut [u32], Workspace { pixels, touched, settled }: &mut Workspace) {
        for pixel in touched.drain(..) {
            let Sought { nearest, sums: [sum, x, y], .. } = std::mem::replace(&mut pixels[pixel], UNKNOWN);
            let is_inside = self.depth(nearest) >= NEAREST || self.holds([x / sum, y / sum]);
            pixels[pixel].state = if is_inside { PixelState::Marked } else { PixelState::Missed(nearest) };
            if is_inside {
                marked[pixel] = self.grains[nearest].0;
            }
            settled.push(pixel);
        }
    }

    /// Where one of its grains was at the start [m].
    fn start(&self, k: usize) -> [f64; 2] {
        self.deforming.places[self.grains[k].1 as usize]
    }

    /// How deep in the shape, in sides of the largest particle.
    fn depth(&self, k: usize) -> f64 {
        self.deforming.depths[self.grains[k].1 as usize]
    }

    /// Whether two of its grains carry the same.
    fn are_together(&self, one: usize, other: usize) -> bool {
        let ([a, b], [c, d]) = (self.start(one), self.start(other));
        (a - c).hypot(b - d) <= TOGETHER * self.deforming.side
    }

    /// Whether a place was in the undeformed shape [m].
    fn holds(&self, place: [f64; 2]) -> bool {
        let [x, y] = place;
        !self.cuts.iter().any(|cut| cut.takes(place)) && self.deforming.shape.contains([x, y, 0.0], 2)
    }
}

impl Workspace {
    /// For so many pixels.
    pub fn new(pixels: usize) -> Self {
        Workspace { pixels: vec![UNKNOWN; pixels], touched: Vec::new(), settled: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::grains::mirrored;
    use super::super::outlines::Outlines;
    use super::super::plane::{DrawnGrains, KnownShapes, PlaneView};
    use super::super::sample;
    use super::*;

    /// A window of which a pixel is so wide [m].
    fn window(low: [f64; 2], high: [f64; 2], pixel: f64) -> PlaneView {
        PlaneView { low, high, size: [0, 1].map(|axis| ((high[axis] - low[axis]) / pixel).round() as usize) }
    }

    /// Calls `look` with the place of each pixel and the body that is drawn there.
    fn drawn(
        (outlines, mirror): (&Outlines, Option<SymmetryPlane>),
        particles: &ParticleSnapshot,
        window: &PlaneView,
        look: impl Fn([f64; 2], Option<u32>),
    ) {
        let mut grains = sample::colored(particles);
        if let Some(mirror) = mirror {
            grains = mirrored(grains, mirror);
        }
        let known = KnownShapes { carried: outlines.carried(particles, mirror), ..KnownShapes::default() };
        let drawn = DrawnGrains::new(&grains, window, &known);
        for y in 0..window.size[1] {
            for x in 0..window.size[0] {
                let place = window.place([x as f64 + 0.5, y as f64 + 0.5]);
                look(place, drawn.grain(x, y).map(|(_, grain)| grain.body));
            }
        }
    }

    /// A disk of ten cells, and another 20 mm beside it: each pixel is as the deformed circles say, but for one around
    /// their rims.
    #[test]
    fn disks_are_round_and_stay_apart() {
        let disk = |name: &str, x: f64| {
            format!(
                "[[bodies]]\nname = '{name}'\nmaterial = 'rubber'\n\
                 shape.ball = {{ center = [{x}, 0], radius = 0.5 }}\n"
            )
        };
        let (scene, first) = sample::rubber("interior = 'reference'", &(disk("a", 0.0) + &disk("b", 1.02)));
        let outlines = Outlines::new(&scene, &first);
        for f in [[1.0, 0.0, 0.0, 1.0], [1.5, 0.0, 0.0, 0.7], [1.0, 0.6, 0.0, 1.0], [0.8, -0.6, 0.6, 0.8]] {
            let now = sample::deformed(&first, f);
            let view = window([-1.0, -1.0], [1.5, 1.0], 0.005);
            let det = f[0] * f[3] - f[1] * f[2];
            drawn((&outlines, None), &now, &view, |[x, y], body| {
                let start = [(f[3] * x - f[1] * y) / det, (f[0] * y - f[2] * x) / det];
                for (number, center) in [(0, 0.0), (1, 1.02)] {
                    let out = (start[0] - center).hypot(start[1]) - 0.5;
                    let is_wrong = (out < 0.0) != (body == Some(number));
                    assert!(
                        !is_wrong || out.abs() < 0.008,
                        "{f:?} [{x}, {y}]: {body:?}, {out} m out of {number}"
                    );
                }
            });
        }
    }

    /// Two arms of one body, 0.4 m apart, that have come as near as 20 mm, or overlap by 10 mm: the gap is there, and
    /// nothing else.
    #[test]
    fn a_folded_body_keeps_its_gap_and_has_no_other() {
        let body = "[[bodies]]\nname = 'fork'\nmaterial = 'rubber'\n\
                    shape.polygon = { points = [[0, 0], [1, 0], [1, 2], [0.7, 2], [0.7, 0.3], [0.3, 0.3], [0.3, 2], \
                    [0, 2]] }\n";
        let (scene, first) = sample::rubber("interior = 'reference'", body);
        let outlines = Outlines::new(&scene, &first);
        for nearer in [0.38, 0.41] {
            let mut now = first.clone();
            now.position.iter_mut().filter(|x| x[0] > 0.5).for_each(|x| x[0] -= nearer);
            // Far from the root of the arms, which this does not deform as it should.
            let view = window([-0.05, 1.0], [0.7, 2.05], 0.0025);
            drawn((&outlines, None), &now, &view, |[x, y], body| {
                let arms = [[0.0, 0.3], [0.7 - nearer, 1.0 - nearer]];
                let is_inside = |margin: f64| {
                    y < 2.0 - margin && arms.iter().any(|[low, high]| x > low + margin && x < high - margin)
                };
                assert!(!is_inside(0.004) || body == Some(0), "{nearer} [{x}, {y}] is in an arm");
                assert!(is_inside(-0.004) || body.is_none(), "{nearer} [{x}, {y}] is in none");
            });
        }
    }

    /// Half a disk at a face that is a mirror, stretched along it, and its image: one disk.
    #[test]
    fn a_body_that_ends_at_a_mirror_is_whole_with_its_image() {
        let body = "[[bodies]]\nname = 'half'\nmaterial = 'rubber'\nbeyond_mirrors = 'cut'\n\
                    shape.ball = { center = [0, 1], radius = 0.5 }\n";
        let domain = "domain = { min = [0, 0], max = [2, 2], x_min = 'symmetry' }";
        let (scene, first) = sample::rubber(&format!("interior = 'reference', {domain}"), body);
        let outlines = Outlines::new(&scene, &first);
        let now = sample::deformed(&first, [0.8, 0.0, 0.0, 1.3]);
        let mirror = Some(SymmetryPlane { axis: 0, position: 0.0 });
        let view = window([-0.6, 0.5], [0.6, 2.1], 0.005);
        drawn((&outlines, mirror), &now, &view, |[x, y], body| {
            let out = (x / 0.8).hypot(y / 1.3 - 1.0) - 0.5;
            assert!((out < 0.0) == body.is_some() || out.abs() < 0.01, "[{x}, {y}]: {body:?}");
        });
    }
}
