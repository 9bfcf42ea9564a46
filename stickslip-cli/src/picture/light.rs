//! Light on balls: a lamp with shadows, light from the sky that corners get less of, and a dark rim where bodies end.

use super::camera::{Camera, Point};
use super::grains::Grain;
use super::splat::{Layer, NOTHING, splat};
use super::surface::Ball;
use crate::drawing::{Rgb, SAMPLES};

/// Share of a ball's own normal in the normal that light sees; the rest is that of the body's surface.
const GRAININESS: f64 = 0.24;
/// Distance over which corners darken, in ball radii.
const CORNER: f64 = 5.0;
/// Pixels along each side of the picture that the lamp sees.
const SHADOW_MAP: usize = 2048;

/// A lit scene.
pub struct Lit<'a> {
    grains: &'a [Grain],
    balls: &'a [Ball],
    camera: Camera,
    layer: Layer,
    lamp: Camera,
    shadows: Layer,
    radius: f64,
    contrast: f64,
}

impl<'a> Lit<'a> {
    /// Draws the balls for the eye and for the lamp. `contrast` is 1 for light as it falls, 0 for colours as they are.
    pub fn new(
        grains: &'a [Grain],
        balls: &'a [Ball],
        camera: Camera,
        size: [usize; 2],
        contrast: f64,
    ) -> Self {
        let toward = camera.toward * 0.62 + camera.up * 0.66 - camera.right * 0.42;
        let lamp = Camera::facing(toward.direction().expect("the eye is not opposite the lamp"), camera.up);
        let side = SHADOW_MAP as f64;
        let lamp = lamp.fit(balls.iter().map(|ball| ball.center), [8.0, 8.0, side - 16.0, side - 16.0]);
        let radius = balls.iter().map(|ball| ball.radius).sum::<f64>() / balls.len().max(1) as f64;
        Lit {
            grains,
            balls,
            camera,
            layer: splat(balls, &camera, size),
            lamp,
            shadows: splat(balls, &lamp, [SHADOW_MAP; 2]),
            radius,
            contrast,
        }
    }

    /// The colour of a pixel; `None` where there is nothing.
    pub fn color(&self, x: usize, y: usize) -> Option<Rgb> {
        let place = y * self.layer.size[0] + x;
        let ball = self.balls.get(self.layer.ball[place] as usize)?;
        let depth = f64::from(self.layer.depth[place]);
        let point = self.camera.unproject([x as f64 + 0.5, y as f64 + 0.5, depth]);
        let own = (point - ball.center) / ball.radius;
        let normal = (own * GRAININESS + ball.normal * (1.0 - GRAININESS)).direction().unwrap_or(own);
        let lamp = normal.dot(self.lamp.toward).max(0.0);
        let lamp = if lamp > 0.0 { lamp * self.lit_share(point, normal) } else { 0.0 };
        let half = (self.lamp.toward + self.camera.toward).direction().expect("lamp and eye are on one side");
        let gloss = 0.10 * normal.dot(half).max(0.0).powi(28) * if lamp > 0.0 { 1.0 } else { 0.0 };
        let sky = 0.75 + 0.25 * normal.dot(self.camera.up);
        let open = self.openness([x, y], normal, depth);
        let light = 0.68 * sky * open + 0.60 * lamp * (0.6 + 0.4 * open);
        let light = (1.0 + self.contrast * (light - 1.0)) * self.rim([x, y], ball);
        let color = self.grains[ball.grain].color;
        Some(color.map(|c| (c * light as f32 + gloss as f32).clamp(0.0, 1.0)))
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
        const PROBES: usize = 20;
        let reach = CORNER * self.radius;
        let normal =
            [normal.dot(self.camera.right), normal.dot(self.camera.up), normal.dot(self.camera.toward)];
        let hidden = |k: usize| {
            // Points on a sunflower: evenly spread over a disk.
            let (r, angle) = (((k as f64 + 0.5) / PROBES as f64).sqrt() * reach, k as f64 * 2.399_963);
            let (dx, dy) = (r * angle.cos(), r * angle.sin());
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
        let hidden = (0..PROBES).map(hidden).sum::<f64>() / PROBES as f64;
        (1.0 - 2.2 * hidden).max(0.25)
    }

    /// Darkens a pixel next to another body or to the background.
    fn rim(&self, [x, y]: [usize; 2], ball: &Ball) -> f64 {
        let body = self.grains[ball.grain].body;
        let reach = SAMPLES as i64 / 2 + 1;
        let other = |dx: i64, dy: i64| {
            let (x, y) = (x as i64 + dx, y as i64 + dy);
            let [width, height] = self.layer.size;
            if x < 0 || y < 0 || x >= width as i64 || y >= height as i64 {
                return false;
            }
            match self.layer.ball[y as usize * width + x as usize] {
                NOTHING => true,
                neighbour => self.grains[self.balls[neighbour as usize].grain].body != body,
            }
        };
        let at_rim = other(-reach, 0) || other(reach, 0) || other(0, -reach) || other(0, reach);
        if at_rim { 0.55 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::Viewpoint;
    use super::super::setting::Setting;
    use super::super::{sample, surface::surface};
    use super::*;
    use stickslip::tensor::Vector;

    #[test]
    fn the_side_that_faces_the_lamp_is_brighter() {
        let grains = sample::ball([0.0; 3], 1.0, 0.1);
        let balls = surface(&grains);
        let camera = Camera::new(Viewpoint::Auto, &Setting::default());
        let corners = [Vector([-1.2; 3]), Vector([1.2; 3])];
        let lit = Lit::new(&grains, &balls, camera.fit(corners, [0.0, 0.0, 200.0, 200.0]), [200, 200], 1.0);
        let brightness = |x, y| lit.color(x, y).map(|rgb| rgb.iter().sum::<f32>());
        assert!(brightness(80, 70).unwrap() > 1.5 * brightness(120, 140).unwrap());
        assert_eq!(brightness(2, 2), None);
    }
}
