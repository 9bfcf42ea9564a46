//! Force chains: lines along which bodies press on each other.

use super::ImageWindow;
use super::cloud::{Cloud, Outline};
use super::seen::SeenBody;
use crate::door::ParticleSnapshot;
use crate::image::Image;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Two bodies that press on each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
    let pressing = pressing(pushes);
    let seen = SeenBody::each(particles, |body| pressing.contains(&body));
    let clouds: BTreeMap<usize, Cloud> = seen.map(|seen| (seen.body, wide_cloud(&seen))).collect();
    let pairs = pairs(pushes, clouds.values().map(|cloud| cloud.outline));
    let place = |pair: &Pair| {
        let [few, many] = [pair.few, pair.many].map(|outline| &clouds[&outline.body]);
        meeting_place(&places_near(few, &pair.many), many)
    };
    let places: Vec<_> = pairs.iter().map(place).collect();
    links_to(&places, &pairs, specimens)
}

/// Points of a body among which those of others are looked for.
pub fn wide_cloud(seen: &SeenBody) -> Cloud {
    Cloud::of(seen, REACH, 0.0)
}

/// The bodies that press on each other.
pub fn pressing(pushes: &[Push]) -> BTreeSet<usize> {
    pushes.iter().filter(|push| push.force > 0.0).flat_map(|push| push.bodies).collect()
}

/// Two bodies with points that press on each other.
pub struct Pair {
    push: Push,
    /// In the order of the push.
    centers: [[f64; 2]; 2],
    /// That with fewer points.
    pub few: Outline,
    /// The other.
    pub many: Outline,
}

/// Those of some pushes, by the outlines of the bodies that have points.
pub fn pairs(pushes: &[Push], outlines: impl Iterator<Item = Outline>) -> Vec<Pair> {
    let known: BTreeMap<usize, Outline> = outlines.map(|outline| (outline.body, outline)).collect();
    let pair = |push: &Push| {
        let [a, b] = [*known.get(&push.bodies[0])?, *known.get(&push.bodies[1])?];
        let (few, many) = if a.points < b.points { (a, b) } else { (b, a) };
        Some(Pair { push: *push, centers: [a.center, b.center], few, many })
    };
    pushes.iter().filter(|push| push.force > 0.0).filter_map(pair).collect()
}

/// The links to the place at which each pair meets, if it does.
pub fn links_to(places: &[Option<[f64; 2]>], pairs: &[Pair], specimens: &[usize]) -> Vec<Link> {
    let of_pair = |(pair, place): (&Pair, &Option<[f64; 2]>)| {
        let (Push { bodies, force }, contact) = (pair.push, *place);
        let centers = bodies.into_iter().zip(pair.centers).filter(|(body, _)| specimens.contains(body));
        let link = |(_, center)| Some(Link { center, contact: contact?, force });
        centers.filter_map(link).collect::<Vec<_>>()
    };
    pairs.iter().zip(places).flat_map(of_pair).collect()
}

/// Places of points that may be within reach of another body, which has more of them.
pub fn places_near(few: &Cloud, many: &Outline) -> Vec<[f64; 2]> {
    let Outline { bounds, reach, .. } = many;
    let is_near =
        |x: &[f64; 2]| (0..2).all(|i| !(x[i] < bounds[0][i] - reach || x[i] > bounds[1][i] + reach));
    few.points().iter().map(|point| point.place).filter(is_near).collect()
}

/// Mean of the places half-way between points of two bodies that are within reach, weighted by nearness;
/// `None` if they are apart.
pub fn meeting_place(few: &[[f64; 2]], many: &Cloud) -> Option<[f64; 2]> {
    let reach = many.outline.reach;
    let mut sum = [0.0; 3];
    for x in few {
        for y in many.near(*x).map(|point| point.place) {
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
