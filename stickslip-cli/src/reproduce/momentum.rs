//! The balance of momentum of a run: what the disks or the sphere have,
//! against what everything else and gravity gave them.

use crate::failure::Failure;
use stickslip::observe::{BodyRow, ContactRow, EnergyRow, Results};
use stickslip::scene::Face;

/// Momentum from nowhere until a time [s], over all impulses [-]; M is the mass of the disks or the sphere,
/// p their momentum:
///
/// ```text
/// |p(t) - p(0) - M g t - sum of impulses of the other bodies| / (M |g| t + sum of |impulses of another body|)
/// ```
/// Axes across a mirror, which takes what it likes, are left out; `None` without a row until then.
///
/// # Errors
/// A table cannot be read.
pub fn momentum_error(results: &Results, until: f64) -> Result<Option<f64>, Failure> {
    let until = until * (1.0 + 1e-9);
    let energy = results.energy_table().map_err(Failure::input)?;
    let contacts = results.contacts_table().map_err(Failure::input)?;
    let bodies = results.bodies_table().map_err(Failure::input)?;
    let scene = results.scene().map_err(Failure::input)?;
    let (Some(start), Some(end)) = (energy.first(), energy.iter().rfind(|row| row.time <= until)) else {
        return Ok(None);
    };
    let mirrored = |axis: usize| {
        scene.domain.as_ref().is_some_and(|domain| domain.faces[axis].contains(&Face::Symmetry))
    };
    let axes = || (0..3).filter(|&axis| !mirrored(axis));
    let norm = |vector: [f64; 3]| axes().map(|axis| vector[axis].powi(2)).sum::<f64>().sqrt();
    let [(_, before), (mass, after)] = [start.time, end.time].map(|time| moving(&bodies, time));
    let weight: [f64; 3] = std::array::from_fn(|axis| mass * scene.gravity[axis] * (end.time - start.time));
    let names = results.body_names().iter().map(String::as_str);
    let others = names.filter(|name| !is_watched(name));
    let impulses: Vec<[f64; 3]> = others.map(|body| impulse(body, &contacts, &energy, end.time)).collect();
    let missing = norm(std::array::from_fn(|axis| {
        after[axis] - before[axis] - weight[axis] - impulses.iter().map(|each| each[axis]).sum::<f64>()
    }));
    Ok(Some(missing / (norm(weight) + impulses.into_iter().map(norm).sum::<f64>())))
}

/// Whether a body is one of those that the paper watches.
fn is_watched(name: &str) -> bool {
    name == "sphere" || name.starts_with("disk")
}

/// Mass [kg] and momentum [kg m/s] of the watched bodies at a time.
fn moving(bodies: &[BodyRow], time: f64) -> (f64, [f64; 3]) {
    let rows = bodies.iter().filter(|row| row.time == time && is_watched(&row.body));
    rows.fold((0.0, [0.0; 3]), |(mass, momentum), BodyRow { state, .. }| {
        let more = state.velocity.map(|v| state.mass * v);
        (mass + state.mass, [0, 1, 2].map(|axis| momentum[axis] + more[axis]))
    })
}

/// Impulse of one of the others on all watched bodies until a time [N s].
fn impulse(body: &str, contacts: &[ContactRow], energy: &[EnergyRow], until: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for row in contacts.iter().filter(|row| row.time <= until) {
        // The force is that of the first body on the second.
        let sign = match (&*row.body_a, &*row.body_b) {
            (a, b) if a == body && is_watched(b) => 1.0,
            (a, b) if b == body && is_watched(a) => -1.0,
            _ => continue,
        };
        // A row is a mean from the row of all tables before it to its own.
        let before = energy[..energy.partition_point(|other| other.time < row.time)].last();
        let duration = row.time - before.map_or(0.0, |other| other.time);
        for (sum, force) in sum.iter_mut().zip(row.mean.force) {
            *sum += sign * force * duration;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::door::ContactMean;

    #[test]
    fn impulses_are_forces_times_intervals_whoever_comes_first() {
        let time = |time| EnergyRow { time, ..EnergyRow::default() };
        let row = |time, body_a: &str, body_b: &str, fx| ContactRow {
            time,
            body_a: body_a.to_owned(),
            body_b: body_b.to_owned(),
            mean: ContactMean { force: [fx, 0.0, 0.0], ..ContactMean::default() },
        };
        let contacts = [
            row(0.5, "striker", "disk_1", -4.0),
            row(0.5, "disk_1", "disk_2", -9.0),
            row(1.5, "disk_2", "end_wall", -1.0),
            row(1.5, "striker", "end_wall", 70.0),
            row(2.5, "striker", "disk_1", -100.0),
        ];
        let times = [time(0.0), time(0.5), time(1.5), time(2.5)];
        let [striker, wall] = ["striker", "end_wall"].map(|body| impulse(body, &contacts, &times, 1.5)[0]);
        assert_eq!((striker, wall), (-2.0, 1.0));
    }
}
