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
/// n = ceil(R/s) rings of width w = R/n
/// ring k: area A = pi (r_out^2 - r_in^2) in an even number m of sectors, none above w^2
/// particle at the sector's centroid: r = 2/3 (r_out^3 - r_in^3)/(r_out^2 - r_in^2) sin(pi/m)/(pi/m)
/// ```
/// The areas add up to pi R^2 exactly, and the moment of inertia lacks what the sectors have about their centroids,
/// some (w/R)^2/3. Volumes at their centroids balance a uniform stress best: particles at the radius of gyration, which
/// would make the moment exact, leave the stress at the centre 3 to 5 % off, however fine the rings. An even number,
/// the first half a sector from angle 0, makes the disk its own mirror image and lets a line of angle 0 cut it between
/// particles.
pub(super) fn sectors(disk: f64, spacing: f64, half: bool) -> impl Iterator<Item = Sector> {
    let rings = parts(disk, spacing);
    let edge = move |k: usize| disk * k as f64 / rings as f64;
    (0..rings).flat_map(move |k| {
        let [inner, outer] = [edge(k), edge(k + 1)];
        let area = PI * (outer * outer - inner * inner);
        let pairs = parts(area, 2.0 * edge(1) * edge(1));
        let half_angle = 0.5 * PI / pairs as f64;
        let chord = libm::sin(half_angle) / half_angle;
        let radius = 2.0 / 3.0 * PI * (outer.powi(3) - inner.powi(3)) / area * chord;
        let sector = move |j: usize| Sector {
            radius,
            angle: half_angle * (2 * j + 1) as f64,
            area: 0.5 * area / pairs as f64,
        };
        (0..if half { pairs } else { 2 * pairs }).map(sector)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_are_exact_and_moments_lack_what_sectors_have_about_their_centroids() {
        for (radius, spacing) in [(1.0, 0.1), (0.5, 1.0), (3.0, 0.07), (1.0, 1.0 / 3.0)] {
            let sum = |half: bool, f: &dyn Fn(&Sector) -> f64| {
                sectors(radius, spacing, half).map(|s| s.area * f(&s)).sum::<f64>()
            };
            assert!((sum(false, &|_| 1.0) / (PI * radius * radius) - 1.0).abs() < 1e-13);
            assert!((sum(true, &|_| 2.0) / (PI * radius * radius) - 1.0).abs() < 1e-13);
            // Half a disk has its centroid 4 R/(3 pi) above its edge.
            let above = sum(true, &|s| s.radius * s.angle.sin());
            assert!((above / (2.0 / 3.0 * radius.powi(3)) - 1.0).abs() < 1e-12, "{radius} {spacing}");
            let moment = 0.25 * PI * radius.powi(4);
            let width = radius / parts(radius, spacing) as f64;
            for trig in [f64::sin, f64::cos] {
                let found = sum(false, &|s| (s.radius * trig(s.angle)).powi(2));
                let lacks = 1.0 - found / moment;
                assert!(
                    lacks > 0.0 && lacks < 0.36 * (width / radius).powi(2),
                    "{radius} {spacing}: {lacks}"
                );
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
