//! A disk in rings, each divided into sectors of one area: particles that follow a round edge.

use super::filling::parts;
use std::f64::consts::PI;

/// A part of a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sector {
    /// Distance of its particle from the centre [m].
    pub radius: f64,
    /// Direction of its particle [rad].
    pub angle: f64,
    /// Its area [m^2].
    pub area: f64,
}

/// Sectors that tile a disk, or the half of it with angles from 0 to pi.
///
/// ```text
/// n = ceil(R/s) rings of width w = R/n,   ring k: area A = pi (r_out^2 - r_in^2) in an even number of sectors, none above w^2
/// particle at r^2 = (r_in^2 + r_out^2)/2
/// ```
/// The areas add up to pi R^2 and the moments of inertia to pi R^4/4, both exactly. An even number, the first half a sector from
/// angle 0, makes the disk its own mirror image and lets a line of angle 0 cut it between particles.
pub(super) fn sectors(disk: f64, spacing: f64, half: bool) -> impl Iterator<Item = Sector> {
    let rings = parts(disk, spacing);
    let edge = move |k: usize| disk * k as f64 / rings as f64;
    (0..rings).flat_map(move |k| {
        let [inner, outer] = [edge(k), edge(k + 1)].map(|r| r * r);
        let area = PI * (outer - inner);
        let pairs = parts(area, 2.0 * edge(1) * edge(1));
        let sector = move |j: usize| Sector {
            radius: (0.5 * (inner + outer)).sqrt(),
            angle: PI * (j as f64 + 0.5) / pairs as f64,
            area: 0.5 * area / pairs as f64,
        };
        (0..if half { pairs } else { 2 * pairs }).map(sector)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn area_and_moments_are_those_of_the_disk() {
        for (radius, spacing) in [(1.0, 0.1), (0.5, 1.0), (3.0, 0.07), (1.0, 1.0 / 3.0)] {
            let sum = |half: bool, f: &dyn Fn(&Sector) -> f64| {
                sectors(radius, spacing, half).map(|s| s.area * f(&s)).sum::<f64>()
            };
            assert!((sum(false, &|_| 1.0) / (PI * radius * radius) - 1.0).abs() < 1e-13);
            assert!((sum(true, &|_| 2.0) / (PI * radius * radius) - 1.0).abs() < 1e-13);
            let moment = 0.25 * PI * radius.powi(4);
            for trig in [f64::sin, f64::cos] {
                let found = sum(false, &|s| (s.radius * trig(s.angle)).powi(2));
                assert!((found / moment - 1.0).abs() < 1e-12, "{radius} {spacing}");
                assert!(sum(false, &|s| s.radius * trig(s.angle)).abs() < 1e-12 * radius.powi(3));
            }
        }
    }

    #[test]
    fn no_sector_is_larger_than_its_square_and_few_are_much_smaller() {
        for n in [1.0, 2.0, 10.0, 40.0] {
            let square = 1.0 / (n * n);
            let areas: Vec<f64> = sectors(1.0, 1.0 / n, false).map(|s| s.area).collect();
            assert!(areas.iter().all(|&a| a <= square * (1.0 + 1e-9) && a > 0.75 * square), "{n}");
            assert!(
                areas.iter().sum::<f64>() / areas.len() as f64 > if n < 10.0 { 0.75 } else { 0.95 } * square
            );
        }
    }
}
