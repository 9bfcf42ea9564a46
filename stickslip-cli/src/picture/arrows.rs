//! Velocities as arrows on a regular raster: in the plane, and in space from the surfaces that the camera sees.

use super::camera::Camera;
use super::field::Source;
use super::light::Lit;
use super::plane::{DrawnGrains, PlaneView};
use crate::drawing::{Canvas, Rgb, SAMPLES};
use stickslip::tensor::Vector;

/// Arrows of a picture, in drawn pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrows {
    /// Tail and tip of each.
    pub each: Vec<[[f64; 2]; 2]>,
    /// Speed and length of the one in the legend [m/s, drawn pixels].
    pub legend: [f64; 2],
}

/// Distance between arrows [pixels of the file].
const RASTER: usize = 32;
/// Length of the longest arrow in distances between arrows.
const LONGEST: f64 = 1.4;
/// Slower than this part of the fastest, and it is no arrow.
const SLOWEST: f64 = 0.06;
/// Width of a shaft, and of the pale rim around an arrow [drawn pixels].
const SHAFT: f64 = 1.8 * SAMPLES as f64;
const RIM: f64 = 0.5 * SAMPLES as f64;
/// Dark, with a rim to be seen on any colour.
const INK: Rgb = [0.094, 0.102, 0.118];
const PALE: Rgb = [0.957, 0.965, 0.973];

/// The arrows where grains are drawn, of which the longest stands for the speed `fastest` [m/s].
pub fn arrows(drawn: &DrawnGrains, window: &PlaneView, source: &Source, fastest: f64) -> Arrows {
    let length = LONGEST * (RASTER * SAMPLES) as f64;
    if fastest <= 0.0 {
        return Arrows::default();
    }
    let arrow = |[x, y]: [usize; 2]| {
        let (index, grain) = drawn.grain(x, y)?;
        let tail = [x as f64 + 0.5, y as f64 + 0.5];
        let [mut vx, mut vy, ..] = source.smoother.at(grain.body, source.own(index, window.place(tail)))?;
        match source.mirror.filter(|_| index >= source.count).map(|mirror| mirror.axis) {
            Some(0) => vx = -vx,
            Some(1) => vy = -vy,
            _ => {}
        }
        let [dx, dy] = [vx, -vy].map(|v| v / fastest * length);
        (vx.hypot(vy) > SLOWEST * fastest).then_some([tail, [tail[0] + dx, tail[1] + dy]])
    };
    let each = raster(window.size).filter_map(arrow);
    Arrows { each: each.collect(), legend: legend(fastest) }
}

/// An arrow in space, as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceArrow {
    /// Whose surface it begins on.
    body: u32,
    /// Tail and tip: drawn pixels from the left and from the top, and metres towards the eye.
    ends: [[f64; 3]; 2],
}

/// The arrows on the surfaces of bodies in a part (left, top, width, height) of the drawn pixels, the farthest first. An
/// arrow across the view is as long as its speed says, with that of `fastest` [m/s] as the longest; others are shorter,
/// as the camera sees them.
pub fn space_arrows(
    (lit, camera): (&Lit, &Camera),
    [left, top, width, height]: [usize; 4],
    source: &Source,
    fastest: f64,
) -> Vec<SpaceArrow> {
    if fastest <= 0.0 {
        return Vec::new();
    }
    let length = LONGEST * (RASTER * SAMPLES) as f64 / camera.scale;
    let arrow = |[x, y]: [usize; 2]| {
        let sight = lit.sight([x + left, y + top])?;
        let [vx, vy, vz, ..] = source.smoother.at(sight.body, source.seen(&sight))?;
        let mut velocity = Vector([vx, vy, vz]);
        if let Some(mirror) = source.mirror.filter(|_| sight.is_image) {
            velocity[mirror.axis] = -velocity[mirror.axis];
        }
        let ends = [sight.place, sight.place + velocity * (length / fastest)].map(|end| camera.project(end));
        (velocity.norm() > SLOWEST * fastest).then_some(SpaceArrow { body: sight.body, ends })
    };
    let mut all: Vec<SpaceArrow> = raster([width, height]).filter_map(arrow).collect();
    all.sort_by(|a, b| a.ends[0][2].total_cmp(&b.ends[0][2]));
    all
}

/// Draws arrows where nothing but their own body is in front of them.
pub fn draw_space_arrows(canvas: &mut Canvas, arrows: &[SpaceArrow], lit: &Lit) {
    for SpaceArrow { body, ends: [tail, tip] } in arrows {
        let ends = [[tail[0], tail[1]], [tip[0], tip[1]]];
        let shape = Outline::new(ends, SHAFT);
        let color = |x: usize, y: usize| {
            let [along, across] = shape.place([x as f64 + 0.5, y as f64 + 0.5]);
            let color = if shape.covers([along, across], 0.0) {
                INK
            } else if shape.covers([along, across], RIM) {
                PALE
            } else {
                return None;
            };
            let share = (along / shape.length).clamp(0.0, 1.0);
            (!lit.hides([x, y], (*body, tail[2] + share * (tip[2] - tail[2])))).then_some(color)
        };
        let reach = shape.barb + RIM + 1.0;
        let [[left, right], [top, bottom]] = [0, 1].map(|axis| {
            let [low, high] = [f64::min, f64::max].map(|of| of(ends[0][axis], ends[1][axis]));
            let within = |end: f64| end.clamp(0.0, canvas.size[axis] as f64) as usize;
            [within(low - reach), within(high + reach)]
        });
        canvas.paint([left, top, right - left, bottom - top], |x, y| color(x + left, y + top));
    }
}

/// The middles of a regular raster on an area [drawn pixels].
fn raster(size: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let step = RASTER * SAMPLES;
    let [columns, rows] = size.map(|side| side / step);
    let places = (0..rows).flat_map(move |row| (0..columns).map(move |column| [column, row]));
    places.map(move |place| place.map(|index| index * step + step / 2))
}

/// Speed and length of the arrow in the legend [m/s, drawn pixels].
pub fn legend(fastest: f64) -> [f64; 2] {
    if fastest <= 0.0 {
        return [0.0; 2];
    }
    let speed = round_below(fastest);
    [speed, speed / fastest * LONGEST * (RASTER * SAMPLES) as f64]
}

/// The largest of 1, 2 and 5 times a power of ten that is not larger.
pub fn round_below(number: f64) -> f64 {
    let power = 10f64.powf(number.log10().floor());
    let round = [5.0, 2.0, 1.0].into_iter().find(|round| round * power <= number * (1.0 + 1e-12));
    round.unwrap_or(1.0) * power
}

/// An arrow in a picture, all in drawn pixels.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    tail: [f64; 2],
    /// Unit vector to the tip.
    along: [f64; 2],
    length: f64,
    /// Half the width of the shaft.
    half: f64,
    /// Where the head begins.
    neck: f64,
    /// Half the width of the head there.
    barb: f64,
}

impl Outline {
    /// From tail to tip, with a shaft of a width.
    pub fn new([tail, tip]: [[f64; 2]; 2], width: f64) -> Self {
        let [dx, dy] = [tip[0] - tail[0], tip[1] - tail[1]];
        let length = dx.hypot(dy).max(1e-9);
        let head = (4.5 * width).min(0.6 * length);
        let half = 0.5 * width;
        let barb = (0.42 * head).max(half);
        Outline { tail, along: [dx / length, dy / length], length, half, neck: length - head, barb }
    }

    /// Its corners.
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let Outline { tail, along: [x, y], length, half, neck, barb } = *self;
        let at = |from: f64, aside: f64| [tail[0] + x * from - y * aside, tail[1] + y * from + x * aside];
        vec![
            at(0.0, half),
            at(neck, half),
            at(neck, barb),
            at(length, 0.0),
            at(neck, -barb),
            at(neck, -half),
            at(0.0, -half),
        ]
    }

    /// How far along the arrow, and aside of it, a place is.
    fn place(&self, at: [f64; 2]) -> [f64; 2] {
        let [dx, dy] = [at[0] - self.tail[0], at[1] - self.tail[1]];
        let [x, y] = self.along;
        [dx * x + dy * y, (dy * x - dx * y).abs()]
    }

    /// Whether such a place is in the arrow, or in a rim of a width around it.
    fn covers(&self, [along, aside]: [f64; 2], rim: f64) -> bool {
        // What points at the eye is a dot.
        if self.length < 2.0 * self.half {
            return along.hypot(aside) <= self.half + rim;
        }
        let in_shaft = along >= -rim && along <= self.neck && aside <= self.half + rim;
        let slope = self.barb / (self.length - self.neck).max(1e-9);
        let side = slope * (self.length - along) + rim * slope.hypot(1.0);
        in_shaft || (along >= self.neck - rim && aside <= side.min(self.barb + rim))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legend_has_a_round_speed() {
        let rounded = [0.0123, 1.0, 4.99, 5.0, 730.0].map(round_below);
        let expected = [0.01, 1.0, 2.0, 5.0, 500.0];
        assert!((0..5).all(|i| (rounded[i] - expected[i]).abs() < 1e-12 * expected[i]), "{rounded:?}");
    }

    #[test]
    fn an_arrow_ends_at_its_tip() {
        let outline = Outline::new([[0.0, 0.0], [30.0, 40.0]], 2.0);
        let corners = outline.corners();
        assert!(corners.contains(&[30.0, 40.0]) && corners.len() == 7);
        // Its corners lie on its rim, but for those where the shaft meets the head.
        for corner in corners {
            let [along, aside] = outline.place(corner);
            if (along - outline.neck).abs() < 1e-9 && aside < outline.barb - 1e-9 {
                continue;
            }
            assert!(
                outline.covers([along, aside - 1e-9], 1e-9) && !outline.covers([along, aside + 0.1], 0.0)
            );
            assert!(outline.covers([along, aside + 0.1], 0.2));
        }
    }
}
