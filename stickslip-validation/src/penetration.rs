//! How deep bodies reach into each other.

use std::collections::HashMap;
use stickslip::door::ParticleSnapshot;

/// Largest overlap of two particles of different bodies, each taken as round and as wide as the root of its volume [m];
/// zero or more.
///
/// ```text
/// max over p in a, q in b != a:  (V_p^(1/D) + V_q^(1/D)) / 2 - |x_p - x_q|
/// ```
/// Exact where the particles of two surfaces face each other; less than the truth, by up to a fifth of the spacing in
/// the plane, where they sit gap on peak.
pub fn penetration(snapshot: &ParticleSnapshot) -> f64 {
    let width = |p: usize| snapshot.volume[p].powf(1.0 / snapshot.dimension as f64);
    let widest = (0..snapshot.body.len()).map(width).fold(0.0, f64::max);
    let cell = |x: [f64; 3]| x.map(|x| (x / widest).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (p, &x) in snapshot.position.iter().enumerate() {
        cells.entry(cell(x)).or_default().push(p);
    }
    let around = |[x, y, z]: [i64; 3]| {
        (x - 1..=x + 1)
            .flat_map(move |x| (y - 1..=y + 1).flat_map(move |y| (z - 1..=z + 1).map(move |z| [x, y, z])))
    };
    let mut deepest = 0.0_f64;
    for (&place, particles) in &cells {
        let near: Vec<usize> =
            around(place).filter_map(|neighbour| cells.get(&neighbour)).flatten().copied().collect();
        let first = particles.first().map(|&p| snapshot.body[p]);
        if near.iter().all(|&q| Some(snapshot.body[q]) == first) {
            continue;
        }
        for &p in particles {
            for &q in near.iter().filter(|&&q| snapshot.body[q] > snapshot.body[p]) {
                let [a, b] = [snapshot.position[p], snapshot.position[q]];
                let distance = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
                deepest = deepest.max(0.5 * (width(p) + width(q)) - distance);
            }
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_that_face_each_other_overlap_by_what_they_miss_to_a_spacing() {
        for (distance, expected) in [(1.0, 0.0), (0.9, 0.1), (1.3, 0.0), (0.25, 0.75)] {
            for shift in [0.0, 0.4, -7.7] {
                let position: Vec<[f64; 3]> =
                    (0..3).flat_map(|y| [0.0, distance].map(|x| [x + shift, f64::from(y), 0.0])).collect();
                let snapshot = ParticleSnapshot {
                    dimension: 2,
                    body: vec![0, 1, 0, 1, 0, 1],
                    volume: vec![1.0; 6],
                    position,
                    ..ParticleSnapshot::default()
                };
                assert!((penetration(&snapshot) - expected).abs() < 1e-12, "{distance}, {shift}");
            }
        }
    }
}
