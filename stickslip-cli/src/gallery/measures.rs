//! What is measured on the results of the gallery's scenes. Each function gives the number of one check; the book's
//! chapter on the gallery says where its bounds come from.

use stickslip::door::{Ledger, ParticleSnapshot};
use stickslip::observe::{BodyRow, JointRow, ReadError, Results};

type Measured = Result<f64, ReadError>;

/// [m/s²]
const GRAVITY: f64 = 9.81;

/// Length of Taylor's bar at the end [mm]: how far its particles reach, and half of their distance at rest.
pub fn length_of_bar(results: &Results) -> Measured {
    let particles = last_particles(results)?;
    let reach = particles.position.iter().map(|position| position[2]).fold(0.0, f64::max);
    // Three particles lie along a cell.
    Ok(1e3 * (reach + results.manifest().cell / 6.0))
}

/// Kinetic energy that a rolling wheel lost over what its material dissipated, from a fifth of the run on [-].
pub fn loss_of_wheel(results: &Results) -> Measured {
    let [first, last] = ledgers(results, 0.2)?;
    Ok((first.kinetic - last.kinetic) / (last.plastic - first.plastic))
}

/// Force on a seal over that of Hertz' line contact, where it is first squeezed by a twentieth of its diameter [-].
pub fn force_of_seal(results: &Results) -> Measured {
    let diameter = 5e-3;
    let bodies = results.bodies_table()?;
    let heights: Vec<f64> =
        bodies.iter().filter(|row| row.body == "flange").map(|row| row.state.position[1]).collect();
    let reactions = results.reactions_table()?;
    let forces = reactions.iter().filter(|row| row.reaction == "flange").map(|row| row.force[1]);
    // Forces are means between two rows.
    let squeezes = heights.windows(2).map(|pair| (heights[0] - 0.5 * (pair[0] + pair[1])) / diameter);
    let found = forces.zip(squeezes).find(|(_, squeeze)| *squeeze > 0.05);
    Ok(found.map_or(f64::NAN, |(force, squeeze)| force / line_contact(squeeze, diameter)))
}

/// Force per length that squeezes a cylinder of rubber between two plates, by a share C of its diameter [N/m]:
///
/// ```text
/// C = 4 F / (pi E* d) (ln(2 d / a) - 1/2),   a^2 = 2 F d / (pi E*)       Johnson (1985), Contact Mechanics, eq. (5.57)
/// ```
fn line_contact(squeeze: f64, diameter: f64) -> f64 {
    use std::f64::consts::PI;
    let modulus = 6e6 / (1.0 - 0.49 * 0.49);
    let squeeze_of = |force: f64| {
        let width = (2.0 * force / PI).sqrt();
        4.0 * force / PI * ((2.0 / width).ln() - 0.5)
    };
    // Of forces over E* d; the squeeze grows with the force.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if squeeze_of(middle) < squeeze { low = middle } else { high = middle }
    }
    low * modulus * diameter
}

/// Stress at which a foam is crushed, the mean from 2/3 of the run on, over that of buckling cells [-].
pub fn plateau_of_foam(results: &Results) -> Measured {
    // Side [m], share of walls within it, and Young's modulus in plane strain [Pa].
    let [side, solid, modulus] = [16e-3, 0.2136_f64, 5e6 / (1.0 - 0.09)];
    let end = results.manifest().performance.time;
    let rows = results.reactions_table()?;
    let force = mean(rows.iter().filter(|row| row.time > 2.0 / 3.0 * end).map(|row| row.force[1]));
    Ok(force / side / (0.143 * modulus * solid.powi(3)))
}

/// Speed of a bolt and the plug that it sheared out of a plate, over that of Recht and Ipson (1963) [-]:
///
/// ```text
/// v = sqrt((m_b v0 / (m_b + m_p))^2 - 2 W / (m_b + m_p)),   W = k h^2
/// ```
/// with the masses of bolt and plug, the bolt's speed before, the shear strength k, and the plate's thickness h: the
/// work W of shear on two planes, whose length falls to zero as the plug moves by h.
pub fn speed_of_bolt(results: &Results) -> Measured {
    let [speed, strength, thickness] = [600.0, 3e8 / 3_f64.sqrt(), 6e-3];
    let end = bodies_at(results, f64::INFINITY)?;
    let both =
        || end.iter().filter(|row| ["bolt", "plug"].contains(&row.body.as_str())).map(|row| &row.state);
    let mass: f64 = both().map(|state| state.mass).sum();
    let momentum: f64 = both().map(|state| -state.mass * state.velocity[1]).sum();
    let bolt: f64 = end.iter().filter(|row| row.body == "bolt").map(|row| row.state.mass).sum();
    let work = strength * thickness * thickness;
    let law = ((bolt * speed / mass).powi(2) - 2.0 * work / mass).sqrt();
    Ok(momentum / mass / law)
}

/// Mean axial stress of the crystals over that of the binder at the end [-].
pub fn bridging_of_stress(results: &Results) -> Measured {
    let particles = last_particles(results)?;
    let stress = |kind: &str| {
        let of_kind = |&i: &usize| results.body_names()[particles.body[i] as usize].starts_with(kind);
        let all = (0..particles.body.len()).filter(of_kind);
        let (force, volume) = all.fold((0.0, 0.0), |(force, volume), i| {
            (force + particles.stress[i][1] * particles.volume[i], volume + particles.volume[i])
        });
        force / volume
    };
    Ok(stress("crystal") / stress("binder"))
}

/// Normal force that those contacts of disks bear that bear more than the mean, over that of all contacts of disks, at
/// the end [-].
pub fn share_of_chains(results: &Results) -> Measured {
    let contacts = results.contacts_table()?;
    let end = contacts.last().map_or(0.0, |row| row.time);
    let disks = contacts
        .iter()
        .filter(|row| row.time == end && row.body_a.starts_with("disk") && row.body_b.starts_with("disk"));
    let forces: Vec<f64> = disks.map(|row| row.mean.normal).collect();
    let middle = mean(forces.iter().copied());
    Ok(forces.iter().filter(|force| **force > middle).sum::<f64>() / forces.iter().sum::<f64>())
}

/// How far a column of grains ran out over its width [-]: to the grain from which on 5 of 100 lie further.
pub fn run_out_of_column(results: &Results) -> Measured {
    /// Of the column [m].
    const WIDTH: f64 = 0.16;
    let end = bodies_at(results, f64::INFINITY)?;
    let mut places: Vec<f64> = grains(&end).map(|row| row.state.position[0]).collect();
    places.sort_by(f64::total_cmp);
    Ok((places[places.len() * 95 / 100] - WIDTH) / WIDTH)
}

/// Rate at which grains leave a silo, from 0.2 s to 0.6 s, over that of a free-fall arch [-]: grains fall from half a
/// circle as wide as the opening less a grain, where they were at rest, W = 0.874 rho sqrt(g) (D - d)^(3/2).
pub fn rate_of_silo(results: &Results) -> Measured {
    // Grains' diameter and opening [m], density of the grains times their share of the filling [kg/m³].
    let [d, opening, density] = [0.01, 0.06, 1100.0 * 0.8];
    let law = 0.874 * density * GRAVITY.sqrt() * f64::powf(opening - d, 1.5);
    Ok(rate_below_zero(results, [0.2, 0.6])? / law)
}

/// Rate at which grains leave a hopper, from 0.3 s after it opened to the end, over Beverloo's for slots [-],
/// W = 1.03 rho sqrt(g) (D - 1.4 d)^(3/2), with constants as Nedderman (1992) gives them.
pub fn rate_of_hopper(results: &Results) -> Measured {
    // Grains' mean diameter and opening [m], density of the grains times their share of the filling [kg/m³].
    let [d, opening, density] = [0.01, 0.1, 2500.0 * 0.82];
    let law = 1.03 * density * GRAVITY.sqrt() * f64::powf(opening - 1.4 * d, 1.5);
    Ok(rate_below_zero(results, [1.0, 2.5])? / law)
}

/// Rate at which grains fall below a height of zero between two times [kg/s].
fn rate_below_zero(results: &Results, times: [f64; 2]) -> Measured {
    let above = |rows: &[BodyRow]| -> f64 {
        grains(rows).filter(|row| row.state.position[1] > 0.0).map(|row| row.state.mass).sum()
    };
    let [early, late] = [bodies_at(results, times[0])?, bodies_at(results, times[1])?];
    Ok((above(&early) - above(&late)) / (late[0].time - early[0].time))
}

/// Moment that turns a mill over the moment of the balls' weight about its axis [-], means over its second half.
pub fn moment_of_mill(results: &Results) -> Measured {
    let half = 0.5 * results.manifest().performance.time;
    let reactions = results.reactions_table()?;
    let moment = mean(reactions.iter().filter(|row| row.time > half).map(|row| row.moment[2]));
    let groups = results.groups_table()?;
    let balls = groups.iter().filter(|row| row.time > half);
    Ok(moment / mean(balls.map(|row| -row.mass * GRAVITY * row.position[0])))
}

/// Contacts between unlike grains of a mixer over those of a random mixture, half of all [-], in the last second; not a
/// number if the paddle's work, the moment on it times its speed, is not that of the ledger within a hundredth.
pub fn mixing_of_grains(results: &Results) -> Measured {
    /// Of the paddle [rad/s].
    const SPEED: f64 = std::f64::consts::PI;
    let energy = results.energy_table()?;
    let steady = || energy.iter().filter(|row| row.time >= 1.0);
    let ends = (steady().next(), steady().next_back());
    let (Some(first), Some(last)) = ends else { return Ok(f64::NAN) };
    let reactions = results.reactions_table()?;
    let moment = mean(reactions.iter().filter(|row| row.time > first.time).map(|row| row.moment[2]));
    let work = SPEED * moment * (last.time - first.time);
    let booked = last.ledger.external_work - first.ledger.external_work;
    let contacts = results.contacts_table()?;
    let kind = |name: &str| ["left", "right"].iter().position(|kind| name.starts_with(kind));
    let pairs = contacts.iter().filter(|row| row.time > last.time - 1.0);
    let pairs = pairs.filter_map(|row| Some([kind(&row.body_a)?, kind(&row.body_b)?]));
    let unlike = mean(pairs.map(|[a, b]| f64::from(u8::from(a != b))));
    Ok(if (work / booked - 1.0).abs() < 0.01 { unlike / 0.5 } else { f64::NAN })
}

/// Power that a pair of gears of 18 and 27 teeth gives to its brake over that of its motor [-], from a fifth of the run
/// on; not a number if their mean speeds have not the ratio of the teeth within 1e-3.
pub fn efficiency_of_gears(results: &Results) -> Measured {
    let joints = results.joints_table()?;
    let end = results.manifest().performance.time;
    let over = |joint: &str, value: fn(&JointRow) -> f64| {
        let mut rows = joints.iter().filter(|row| row.joint == joint && row.time >= 0.2 * end);
        let first = rows.next().map_or(f64::NAN, value);
        rows.next_back().map_or(f64::NAN, value) - first
    };
    let ratio = -over("brake", |row| row.way) / over("motor", |row| row.way);
    let efficiency = -over("brake", |row| row.work) / over("motor", |row| row.work);
    Ok(if (ratio * 27.0 / 18.0 - 1.0).abs() < 1e-3 { efficiency } else { f64::NAN })
}

/// Friction's work on a slide over its weight times how far its middle went forward [-].
pub fn friction_of_slide(results: &Results) -> Measured {
    let (start, end) = (bodies_at(results, 0.0)?, bodies_at(results, f64::INFINITY)?);
    let [from, to] = [&start[0].state, &end[0].state];
    let way = (to.position[0] - from.position[0]).hypot(to.position[1] - from.position[1]);
    let [_, last] = ledgers(results, 0.0)?;
    Ok(last.friction / (from.mass * GRAVITY * way))
}

/// Force of the carcass on a tread block along the road over that down, means from 2/3 of the run on [-].
pub fn friction_of_tread(results: &Results) -> Measured {
    let end = results.manifest().performance.time;
    let rows = results.loads_table()?;
    let force =
        |axis: usize| mean(rows.iter().filter(|row| row.time > 2.0 / 3.0 * end).map(|row| row.force[axis]));
    Ok(-force(0) / force(2))
}

/// How deep a ball sank over what Uehara et al. (2003) found for balls in sand [-].
pub fn depth_of_ball(results: &Results) -> Measured {
    // Diameter, speed at first touch, and the bed's height [m, m/s, m].
    let [diameter, speed, bed] = [0.05, 1.5, 0.37_f64];
    // Densities of the ball and of the bed [kg/m³], and the slope of repose.
    let [ball, bulk, repose] = [7800.0, 1100.0 * 0.82, 0.4_f64];
    let end = bodies_at(results, f64::INFINITY)?;
    let lowest = end.iter().filter(|row| row.body == "ball").map(|row| row.state.position[1]);
    let depth = bed - (mean(lowest) - 0.5 * diameter);
    let fall = f64::powi(speed, 2) / (2.0 * GRAVITY) + depth;
    let law = 0.14 / repose * (ball / bulk).sqrt() * f64::powf(diameter, 2.0 / 3.0) * fall.cbrt();
    Ok(depth / law)
}

/// The ledgers after a share of the run and at its end.
fn ledgers(results: &Results, share: f64) -> Result<[Ledger; 2], ReadError> {
    let energy = results.energy_table()?;
    let last = energy.len().saturating_sub(1);
    Ok([(share * last as f64) as usize, last].map(|row| energy[row].ledger.clone()))
}

/// The rows of the bodies at the last time up to one.
fn bodies_at(results: &Results, time: f64) -> Result<Vec<BodyRow>, ReadError> {
    let rows = results.bodies_table()?;
    let found = rows.iter().map(|row| row.time).filter(|found| *found <= time).fold(0.0, f64::max);
    Ok(rows.into_iter().filter(|row| row.time == found).collect())
}

fn grains(rows: &[BodyRow]) -> impl Iterator<Item = &BodyRow> {
    rows.iter().filter(|row| row.body.starts_with("grain"))
}

fn last_particles(results: &Results) -> Result<ParticleSnapshot, ReadError> {
    results.frames().last().map_or_else(|| Ok(ParticleSnapshot::default()), |frame| results.particles(frame))
}

/// The mean; of nothing, not a number, which is within no bounds.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}
