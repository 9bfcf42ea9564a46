//! Balls and triangles drawn with a depth buffer.

use super::camera::Camera;
use super::surface::Ball;
use rayon::prelude::*;

/// Which ball each pixel sees, and how near.
pub struct Layer {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Metres towards the eye; minus infinity where there is nothing.
    pub depth: Vec<f32>,
    /// Index of the ball, or after all of these of the triangle; [`NOTHING`] where there is none.
    pub ball: Vec<u32>,
}

/// No ball.
pub const NOTHING: u32 = u32::MAX;
/// Rows of the image that one thread draws at a time.
const BAND: usize = 48;

impl Layer {
    /// The depth at a pixel; minus infinity outside the image.
    pub fn depth_at(&self, x: i64, y: i64) -> f32 {
        let [width, height] = self.size;
        let inside = x >= 0 && y >= 0 && (x as usize) < width && (y as usize) < height;
        if inside { self.depth[y as usize * width + x as usize] } else { f32::NEG_INFINITY }
    }
}

/// A ball in the image.
#[derive(Clone, Copy)]
struct Spot {
    /// Centre [pixels].
    x: f32,
    y: f32,
    /// Depth of the centre [m].
    depth: f32,
    /// Radius [pixels].
    radius: f32,
}

/// Draws balls as a camera sees them.
pub fn splat(balls: &[Ball], camera: &Camera, size: [usize; 2]) -> Layer {
    let [width, height] = size;
    let mut layer =
        Layer { size, depth: vec![f32::NEG_INFINITY; width * height], ball: vec![NOTHING; width * height] };
    let spot = |ball: &Ball| {
        let [x, y, depth] = camera.project(ball.center);
        Spot {
            x: x as f32,
            y: y as f32,
            depth: depth as f32,
            radius: ((ball.radius * camera.scale) as f32).max(0.75),
        }
    };
    let spots: Vec<Spot> = balls.par_iter().map(spot).collect();
    let mut bands: Vec<Vec<u32>> = vec![Vec::new(); height.div_ceil(BAND)];
    for (i, spot) in spots.iter().enumerate() {
        let first = ((spot.y - spot.radius).max(0.0) as usize) / BAND;
        let last = ((spot.y + spot.radius).max(0.0) as usize) / BAND;
        bands.iter_mut().take(last + 1).skip(first).for_each(|band| band.push(i as u32));
    }
    let metres = 1.0 / camera.scale as f32;
    let depths = layer.depth.par_chunks_mut(BAND * width);
    let indices = layer.ball.par_chunks_mut(BAND * width);
    depths.zip(indices).zip(bands).enumerate().for_each(|(band, ((depth, ball), members))| {
        for i in members {
            draw((i, spots[i as usize]), metres, band * BAND, (width, depth, ball));
        }
    });
    layer
}

/// Draws triangles into the same image, from their corners in it: pixels from the left and from the top, and depth [m].
/// Their indices begin with `first`.
pub fn splat_triangles(layer: &mut Layer, corners: &[[f64; 3]], triangles: &[[u32; 3]], first: u32) {
    let [width, height] = layer.size;
    let mut bands: Vec<Vec<u32>> = vec![Vec::new(); height.div_ceil(BAND)];
    for (i, triangle) in triangles.iter().enumerate() {
        let rows = triangle.map(|corner| corners[corner as usize][1]);
        let low = rows.iter().copied().fold(f64::INFINITY, f64::min).max(0.0) as usize / BAND;
        let high = rows.iter().copied().fold(f64::NEG_INFINITY, f64::max).max(0.0) as usize / BAND;
        bands.iter_mut().take(high + 1).skip(low).for_each(|band| band.push(i as u32));
    }
    let depths = layer.depth.par_chunks_mut(BAND * width);
    let indices = layer.ball.par_chunks_mut(BAND * width);
    depths.zip(indices).zip(bands).enumerate().for_each(|(band, ((depth, index), members))| {
        for i in members {
            let places = triangles[i as usize].map(|corner| corners[corner as usize]);
            draw_triangle((first + i, places), band * BAND, (width, depth, index));
        }
    });
}

/// Draws one triangle on the rows from `top` on.
fn draw_triangle(
    (number, places): (u32, [[f64; 3]; 3]),
    top: usize,
    (width, depth, index): (usize, &mut [f32], &mut [u32]),
) {
    let Some(plane) = Shares::new(places) else { return };
    let rows = depth.len() / width;
    let reach = |axis: usize, offset: usize, end: usize| {
        let along = places.map(|place| place[axis] - offset as f64);
        let low = along.iter().copied().fold(f64::INFINITY, f64::min).max(0.0) as usize;
        let high = along.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil().max(0.0) as usize;
        low..high.min(end)
    };
    for row in reach(1, top, rows) {
        for x in reach(0, 0, width) {
            let shares = plane.at([x as f64 + 0.5, (top + row) as f64 + 0.5]);
            // Neighbours share an edge, and rounding must leave no pixel of it out.
            if shares.iter().all(|share| *share >= -1e-9) {
                let here = (0..3).map(|k| shares[k] * places[k][2]).sum::<f64>() as f32;
                let place = row * width + x;
                if here > depth[place] {
                    depth[place] = here;
                    index[place] = number;
                }
            }
        }
    }
}

/// Of a place in a triangle of the image, the share of each corner in it: they add up to one, and inside all are
/// positive.
pub struct Shares {
    origin: [f64; 2],
    rows: [[f64; 2]; 2],
}

impl Shares {
    /// The triangle with these corners; `None` if it has no area.
    pub fn new([a, b, c]: [[f64; 3]; 3]) -> Option<Self> {
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let det = u[0] * v[1] - u[1] * v[0];
        let rows = [[v[1] / det, -v[0] / det], [-u[1] / det, u[0] / det]];
        (det.abs() > 1e-12).then_some(Shares { origin: [a[0], a[1]], rows })
    }

    /// The shares of a place.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let d = [x - self.origin[0], y - self.origin[1]];
        let [b, c] = self.rows.map(|row| row[0] * d[0] + row[1] * d[1]);
        [1.0 - b - c, b, c]
    }
}

/// Draws one ball on the rows from `top` on.
fn draw(
    (index, spot): (u32, Spot),
    metres: f32,
    top: usize,
    (width, depth, ball): (usize, &mut [f32], &mut [u32]),
) {
    let rows = depth.len() / width;
    let reach = |center: f32, offset: usize, end: usize| {
        let low = (center - spot.radius - offset as f32).max(0.0) as usize;
        let high = (center + spot.radius - offset as f32 + 1.0).max(0.0) as usize;
        low..high.min(end)
    };
    for row in reach(spot.y, top, rows) {
        let dy = (top + row) as f32 + 0.5 - spot.y;
        for x in reach(spot.x, 0, width) {
            let dx = x as f32 + 0.5 - spot.x;
            let rest = spot.radius * spot.radius - dx * dx - dy * dy;
            if rest >= 0.0 {
                let here = spot.depth + rest.sqrt() * metres;
                let place = row * width + x;
                if here > depth[place] {
                    depth[place] = here;
                    ball[place] = index;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Point, Viewpoint};
    use super::super::setting::Setting;
    use super::*;
    use stickslip::tensor::Vector;

    fn ball(center: [f64; 3], grain: usize) -> Ball {
        Ball { center: Vector(center), radius: 1.0, normal: Point::ZERO, grain }
    }

    #[test]
    fn two_triangles_make_a_square_without_a_crack() {
        let mut layer = splat(&[], &Camera::new(Viewpoint::Auto, &Setting::default()), [100, 100]);
        let corners = [[10.3, 10.7, 1.0], [90.2, 10.7, 1.0], [90.2, 70.4, 3.0], [10.3, 70.4, 3.0]];
        splat_triangles(&mut layer, &corners, &[[0, 1, 2], [0, 2, 3]], 5);
        let drawn = layer.ball.iter().filter(|index| **index != NOTHING).count();
        assert_eq!(drawn, 80 * 59, "pixels whose middle is inside");
        assert!((5..=6).contains(&layer.ball[40 * 100 + 50]));
        let middle = layer.depth_at(50, 40);
        assert!((f64::from(middle) - (1.0 + 2.0 * (40.5 - 10.7) / 59.7)).abs() < 1e-5, "{middle}");
    }

    #[test]
    fn the_nearer_ball_hides_the_other() {
        let camera = Camera::new(Viewpoint::Axis(2, false), &Setting::default());
        let corners = [Vector([-2.0, -2.0, 0.0]), Vector([2.0, 2.0, 0.0])];
        let camera = camera.fit(corners, [0.0, 0.0, 100.0, 100.0]);
        for order in [[0, 1], [1, 0]] {
            let depths = [0.0, 3.0];
            let balls = order.map(|i| ball([0.0, 0.0, depths[i]], i));
            let layer = splat(&balls, &camera, [100, 100]);
            let seen = layer.ball[50 * 100 + 50] as usize;
            assert_eq!(balls[seen].grain, 1);
            assert!((layer.depth_at(50, 50) - 4.0).abs() < 1e-3);
            assert_eq!(layer.ball[0], NOTHING);
        }
    }
}
