//! Surfaces of parts of images against the shapes of which those are.

use super::lattice::Lattice;
use super::{Pixels, Solids, image_parts};
use crate::geometry::{Curved, Shape};
use crate::tensor::Vector;

/// An image of disks or balls, in the grey of what they cover of each pixel, or in black and white.
fn balls(counts: [usize; 3], all: &[([f64; 3], f64)], grey: bool) -> Pixels {
    let lattice = Lattice::filled(counts, |at| {
        let outside = |&(center, radius): &([f64; 3], f64)| {
            (0..3).map(|k| (at[k] as f64 - center[k]).powi(2)).sum::<f64>().sqrt() - radius
        };
        let (number, nearest) =
            (all.iter().map(outside).enumerate()).min_by(|a, b| a.1.total_cmp(&b.1)).expect("there are some");
        match grey {
            true => (100.0 * (0.5 - nearest).clamp(0.0, 1.0)) as f32,
            false if nearest < 0.0 => number as f32 + 1.0,
            false => 0.0,
        }
    });
    Pixels { counts, values: lattice.values }
}

fn shapes(pixels: &Pixels, solids: &Solids) -> Vec<Shape> {
    let found = image_parts(pixels, solids, (1, "test"), ([0.0; 3], 1.0)).expect("room");
    found.into_iter().map(|(_, part)| Shape::from(Curved::Image(part))).collect()
}

/// How far the surface of a part is from a ball, mean and most, and its normal from that of the ball [rad].
fn errors(shape: &Shape, (center, radius): ([f64; 3], f64), dimension: usize) -> [f64; 3] {
    let surface = shape.surface(1.0, dimension, &shape.bounds(dimension).expect("bounded"));
    let (mut mean, mut most, mut turn) = (0.0_f64, 0.0_f64, 0.0_f64);
    for point in &surface {
        let arm = Vector(point.position) - Vector(center);
        let off = arm.norm() - radius;
        let normal = Vector(shape.level(point.position, dimension).gradient);
        mean += off / surface.len() as f64;
        most = most.max(off.abs());
        turn = turn.max((normal - arm / arm.norm()).norm());
    }
    [mean, most, turn]
}

const LABELS: Solids = Solids::Labels { background: 0.0, wanted: None };
const GREYS: Solids = Solids::Brighter { than: 50.0, inverted: false };

/// Disks of 40 pixels, wherever they lie between pixels: two fifths of a pixel from labels, a tenth from greys.
#[test]
fn a_disk_is_known_to_a_part_of_a_pixel() {
    for [x, y] in [[30.0, 30.0], [30.5, 30.5], [30.21, 30.37], [30.4, 30.05]] {
        let disk = ([x, y, 0.0], 20.0);
        let labels = &shapes(&balls([60, 60, 1], &[disk], false), &LABELS)[0];
        let [mean, most, turn] = errors(labels, disk, 2);
        assert!(mean.abs() < 0.12 && most < 0.4 && turn < 0.1, "{x} {y}: {mean} {most} {turn}");
        let greys = &shapes(&balls([60, 60, 1], &[disk], true), &GREYS)[0];
        let [mean, most, turn] = errors(greys, disk, 2);
        assert!(mean.abs() < 0.02 && most < 0.1 && turn < 0.06, "{x} {y}: {mean} {most} {turn}");
    }
}

#[test]
fn a_ball_is_known_to_a_part_of_a_voxel() {
    let ball = ([15.2, 14.9, 15.4], 10.0);
    let labels = &shapes(&balls([30, 30, 30], &[ball], false), &LABELS)[0];
    let [mean, most, turn] = errors(labels, ball, 3);
    assert!(mean.abs() < 0.3 && most < 0.5 && turn < 0.12, "{mean} {most} {turn}");
    let greys = &shapes(&balls([30, 30, 30], &[ball], true), &GREYS)[0];
    let [mean, most, turn] = errors(greys, ball, 3);
    assert!(mean.abs() < 0.05 && most < 0.15 && turn < 0.07, "{mean} {most} {turn}");
}

/// Each label has the surface that it has among all of them: two tables of one image make bodies that do not overlap.
#[test]
fn labels_asked_for_one_by_one_are_those_of_the_whole_image() {
    let mut image = balls([60, 60, 1], &[([20.0, 30.0, 0.0], 12.0), ([40.0, 30.0, 0.0], 12.0)], false);
    // A matrix around them, as thin between them as a pixel or two.
    for value in &mut image.values {
        *value = if *value == 0.0 { 9.0 } else { *value };
    }
    let all = shapes(&image, &LABELS);
    assert_eq!(all.len(), 3);
    for (shape, label) in all.iter().zip([1.0, 2.0, 9.0]) {
        let alone = shapes(&image, &Solids::Labels { background: 0.0, wanted: Some(vec![label]) });
        assert_eq!(&alone[..], std::slice::from_ref(shape), "{label}");
    }
}

/// Distances are those to the surface, in the field and beyond it.
#[test]
fn distances_hold_near_and_far() {
    let disk = ([30.3, 30.1, 0.0], 20.0);
    let part = &shapes(&balls([60, 60, 1], &[disk], true), &GREYS)[0];
    for (way, angle) in [(-8.0, 0.3), (-3.0, 1.0), (2.0, 2.0), (6.0, 3.0), (15.0, 4.0), (60.0, 5.0_f64)] {
        let out = [angle.cos(), angle.sin(), 0.0];
        let point = std::array::from_fn(|k| disk.0[k] + (disk.1 + way) * out[k]);
        let level = part.level(point, 2);
        // Far beyond the field, the place from which it is measured is not quite the nearest.
        let allowed = if way > 10.0 { 0.06 * way } else { 0.12 + 0.01 * way.abs() };
        assert!((level.distance - way).abs() < allowed, "{way}: {level:?}");
        assert!(Vector(level.gradient).dot(Vector(out)) > 0.9, "{way}: {level:?}");
    }
}

/// Labels that touch hold no point in common; specks are left out, and what is not wanted.
#[test]
fn parts_that_touch_share_no_point() {
    let all = [
        ([15.0, 15.0, 0.0], 10.0),
        ([34.0, 17.0, 0.0], 9.5),
        ([25.0, 33.0, 0.0], 8.5),
        ([45.0, 45.0, 0.0], 1.2),
    ];
    let image = balls([50, 50, 1], &all, false);
    let found = shapes(&image, &LABELS);
    assert_eq!(found.len(), 4);
    for i in 0..500 {
        for j in 0..500 {
            let point = [0.1 * f64::from(i), 0.1 * f64::from(j), 0.0];
            let holders = found.iter().filter(|shape| shape.level(point, 2).distance < -1e-6).count();
            assert!(holders <= 1, "{point:?}");
        }
    }
    let large = image_parts(&image, &LABELS, (20, ""), ([0.0; 3], 1.0)).expect("room");
    assert_eq!(large.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [1, 2, 3]);
    let some = Solids::Labels { background: 1.0, wanted: Some(vec![3.0, 1.0]) };
    assert_eq!(image_parts(&image, &some, (1, ""), ([0.0; 3], 1.0)).expect("room").len(), 1);
}
