//! Force chains: lines along which bodies press on each other.

use super::ImageWindow;
use super::cloud::{Cloud, clouds};
use crate::door::ParticleSnapshot;
use crate::image::Image;
use serde::{Deserialize, Serialize};

/// Two bodies that press on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Indices of the bodies.
    pub bodies: [usize; 2],
    /// Normal force, positive in compression [N].
    pub force: f64,
}

/// A line from the centre of a body to a contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Link {
    /// Centre of mass [m].
    pub center: [f64; 2],
    /// Where the bodies touch [m].
    pub contact: [f64; 2],
    /// Normal force [N].
    pub force: f64,
}

/// Distances between particles up to which bodies can meet: they press on each other with a small gap, from the start
/// or through the grid, and the surfaces of lattices have steps.
const REACH: f64 = 4.0;
/// Width of the line of the largest force, over the width of the image.
const WIDEST: f64 = 0.009;
/// Forces below this part of the largest are not drawn.
const LEAST: f64 = 0.01;
/// Red, green, blue; and its share over what lies under it.
const COLOR: [f64; 3] = [235.0, 70.0, 30.0];
const OPACITY: f64 = 0.85;

/// The links of some bodies: from the centre of each to where it presses on another. Bodies that are not among
/// `specimens`, such as walls, have no links of their own.
pub fn links(particles: &ParticleSnapshot, pushes: &[Push], specimens: &[usize]) -> Vec<Link> {
    let clouds = clouds(particles, REACH, 0.0);
    let find = |body: usize| clouds.iter().find(|cloud| cloud.body == body);
    let mut links = Vec::new();
    for push in pushes.iter().filter(|push| push.force > 0.0) {
        let [Some(a), Some(b)] = push.bodies.map(find) else { continue };
        let Some(contact) = meeting_place(a, b) else { continue };
        for cloud in [a, b].into_iter().filter(|cloud| specimens.contains(&cloud.body)) {
            links.push(Link { center: cloud.center, contact, force: push.force });
        }
    }
    links
}

/// Mean of the places half-way between points of two bodies that are within reach, weighted by nearness;
/// `None` if they are apart.
fn meeting_place(a: &Cloud, b: &Cloud) -> Option<[f64; 2]> {
    let (few, many) = if a.points().len() < b.points().len() { (a, b) } else { (b, a) };
    let reach = many.reach;
    let mut sum = [0.0; 3];
    for x in few.points().iter().map(|point| point.place) {
        if (0..2).any(|i| x[i] < many.bounds[0][i] - reach || x[i] > many.bounds[1][i] + reach) {
            continue;
        }
        for y in many.near(x).map(|point| point.place) {
            let gap = 1.0 - ((x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2)) / (reach * reach);
            if gap > 0.0 {
                let weight = gap * gap * gap;
                sum = [
                    sum[0] + weight,
                    sum[1] + weight * 0.5 * (x[0] + y[0]),
                    sum[2] + weight * 0.5 * (x[1] + y[1]),
                ];
            }
        }
    }
    (sum[0] > 0.0).then(|| [sum[1] / sum[0], sum[2] / sum[0]])
}

/// Draws links as lines, their width in proportion to the force and widest at the force `full` [N].
pub fn draw_links(image: &mut Image, window: &ImageWindow, (links, full): (&[Link], f64)) {
    let widest = (WIDEST * image.size[0] as f64).max(2.0);
    for link in links.iter().filter(|link| link.force > LEAST * full) {
        let half = 0.5 * (widest * (link.force / full).clamp(0.0, 1.0)).max(1.0);
        draw_line(image, [window.pixel(link.center), window.pixel(link.contact)], half);
    }
}

/// Draws a line with round ends, `half` pixels to either side.
fn draw_line(image: &mut Image, [from, to]: [[f64; 2]; 2], half: f64) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let square = (along[0] * along[0] + along[1] * along[1]).max(f64::MIN_POSITIVE);
    let [columns, rows] = [0, 1].map(|axis| {
        let end = image.size[axis] as f64;
        let low = (from[axis].min(to[axis]) - half - 1.0).clamp(0.0, end);
        let high = (from[axis].max(to[axis]) + half + 1.0).clamp(0.0, end);
        low as usize..high as usize
    });
    for row in rows {
        for column in columns.clone() {
            let x = [column as f64 + 0.5 - from[0], row as f64 + 0.5 - from[1]];
            let share = ((x[0] * along[0] + x[1] * along[1]) / square).clamp(0.0, 1.0);
            let distance = (x[0] - share * along[0]).hypot(x[1] - share * along[1]);
            let alpha = OPACITY * (half + 0.5 - distance).clamp(0.0, 1.0);
            let start = 3 * (row * image.size[0] + column);
            for (byte, color) in image.pixels[start..start + 3].iter_mut().zip(COLOR) {
                *byte = (f64::from(*byte) * (1.0 - alpha) + color * alpha).round() as u8;
            }
        }
    }
}
