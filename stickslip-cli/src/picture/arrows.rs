//! Velocities as arrows on a regular raster.

use super::field::Source;
use super::plane::{DrawnGrains, PlaneView};
use crate::drawing::SAMPLES;

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

/// The arrows where grains are drawn, of which the longest stands for the speed `fastest` [m/s].
pub fn arrows(drawn: &DrawnGrains, window: &PlaneView, source: &Source, fastest: f64) -> Arrows {
    let step = RASTER * SAMPLES;
    let length = LONGEST * step as f64;
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
    let [columns, rows] = window.size.map(|side| side / step);
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
    let each = places.filter_map(|place| arrow(place.map(|index| index * step + step / 2)));
    let speed = round_below(fastest);
    Arrows { each: each.collect(), legend: [speed, speed / fastest * length] }
}

/// The largest of 1, 2 and 5 times a power of ten that is not larger.
pub fn round_below(number: f64) -> f64 {
    let power = 10f64.powf(number.log10().floor());
    let round = [5.0, 2.0, 1.0].into_iter().find(|round| round * power <= number * (1.0 + 1e-12));
    round.unwrap_or(1.0) * power
}

/// The outline of an arrow whose shaft has a width, from tail to tip, all in drawn pixels.
pub fn outline([tail, tip]: [[f64; 2]; 2], width: f64) -> Vec<[f64; 2]> {
    let [dx, dy] = [tip[0] - tail[0], tip[1] - tail[1]];
    let length = dx.hypot(dy).max(1e-9);
    let (along, across) = ([dx / length, dy / length], [-dy / length, dx / length]);
    let head = (4.5 * width).min(0.6 * length);
    let at = |from: f64, aside: f64| [0, 1].map(|k| tail[k] + along[k] * from + across[k] * aside);
    let (half, neck) = (0.5 * width, length - head);
    let barb = (0.42 * head).max(half);
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
        let outline = outline([[0.0, 0.0], [30.0, 40.0]], 2.0);
        assert!(outline.contains(&[30.0, 40.0]) && outline.len() == 7);
    }
}
