//! A ball in shells, each in rings of latitude, each divided into pieces of one volume:
//! particles that follow a round surface.

use super::filling::parts;
use std::f64::consts::PI;

/// A part of a ring of latitude of a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// Its particle from the centre, the third component along the poles [m].
    pub position: [f64; 3],
    /// Its volume [m^3].
    pub volume: f64,
}

/// Pieces that tile a ball, or its northern half.
///
/// ```text
/// n = ceil(R/s) shells of width w = R/n
/// shell k:   V = 4/3 pi (r_out^3 - r_in^3),   r^2 = (3/5)(r_out^5 - r_in^5)/(r_out^3 - r_in^3)
/// an even number near pi r_mid/w of bands of latitude between cosines c_1 and c_2:
///            V (c_1 - c_2)/2,   c^2 = (c_1^2 + c_1 c_2 + c_2^2)/3
/// each in an even number of pieces, at least 4, none above w^3
/// ```
/// The volumes add up to 4/3 pi R^3 and the moments of inertia to those of the ball, both exactly. The equator lies
/// between particles, so half a ball is half of them.
pub(super) fn pieces(ball: f64, spacing: f64, half: bool) -> impl Iterator<Item = Piece> {
    let shells = parts(ball, spacing);
    let edge = move |k: usize| ball * k as f64 / shells as f64;
    (0..shells).flat_map(move |k| {
        let (inner, outer) = (edge(k), edge(k + 1));
        let cubes = outer.powi(3) - inner.powi(3);
        let radius = (0.6 * (outer.powi(5) - inner.powi(5)) / cubes).sqrt();
        let half_bands = (0.25 * PI * (inner + outer) / edge(1)).round().max(1.0) as usize;
        let bands = 2 * half_bands;
        (0..if half { half_bands } else { bands }).flat_map(move |band| {
            let [c, d] = [band, band + 1].map(|b| libm::cos(PI * b as f64 / bands as f64));
            let volume = 2.0 / 3.0 * PI * cubes * (c - d);
            let square = (c * c + c * d + d * d) / 3.0;
            let pairs = parts(volume, 2.0 * edge(1).powi(3)).max(2);
            let (height, across) = (radius * square.sqrt().copysign(c + d), radius * (1.0 - square).sqrt());
            (0..2 * pairs).map(move |j| {
                let angle = PI * (j as f64 + 0.5) / pairs as f64;
                let position = [across * libm::cos(angle), across * libm::sin(angle), height];
                Piece { position, volume: 0.5 * volume / pairs as f64 }
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_and_moments_are_those_of_the_ball() {
        for (radius, spacing) in [(1.0, 0.13), (0.5, 1.0), (2.0, 0.25)] {
            let sum = |half: bool, f: &dyn Fn([f64; 3]) -> f64| {
                pieces(radius, spacing, half).map(|p| p.volume * f(p.position)).sum::<f64>()
            };
            let volume = 4.0 / 3.0 * PI * radius.powi(3);
            assert!((sum(false, &|_| 1.0) / volume - 1.0).abs() < 1e-13);
            assert!((sum(true, &|_| 2.0) / volume - 1.0).abs() < 1e-13);
            for k in 0..3 {
                let moment = 0.2 * volume * radius * radius;
                assert!((sum(false, &|x| x[k] * x[k]) / moment - 1.0).abs() < 1e-12, "{k}");
                assert!((sum(true, &|x| 2.0 * x[k] * x[k]) / moment - 1.0).abs() < 1e-12, "{k}");
                assert!(sum(false, &|x| x[k]).abs() < 1e-12 * volume);
            }
        }
    }

    #[test]
    fn pieces_of_a_ball_neither_clump_nor_leave_holes() {
        let (n, w) = (6.0, 1.0 / 6.0);
        let all: Vec<Piece> = pieces(1.0, w, false).collect();
        assert!(all.iter().all(|p| p.volume <= w * w * w * (1.0 + 1e-9)));
        let distance = |a: &Piece, b: &Piece| {
            (0..3).map(|k| (a.position[k] - b.position[k]).powi(2)).sum::<f64>().sqrt()
        };
        for (i, a) in all.iter().enumerate() {
            let nearest = all.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, b)| distance(a, b));
            let nearest = nearest.fold(f64::INFINITY, f64::min) / w;
            assert!((0.6..1.3).contains(&nearest), "{a:?}: {nearest} of 1/{n}");
        }
    }
}
