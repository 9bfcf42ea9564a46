//! What M1 and M2 share: bodies that meet at one node.

use crate::benchmark::{Case, Tier};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Bodies at a node.
pub const BODIES: [usize; 4] = [2, 3, 4, 5];

/// A body at a node after a step.
pub struct BodyAtNode {
    /// Its mass there [kg].
    pub mass: f64,
    /// Its velocity with contact [m/s].
    pub velocity: [f64; 3],
    /// Its momentum from contact [N s].
    pub impulse: [f64; 3],
}

impl BodyAtNode {
    /// Velocity without what contact did [m/s].
    pub fn free(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.velocity[i] - self.impulse[i] / self.mass)
    }
}

/// Cuts a ball into so many pieces that meet at one node, lets them fly at it from all sides, and shows every node with
/// two or more pieces after every step. Once sticking and once slipping, in the plane and in space, a few times each
/// (quick: once).
pub fn meet(
    case: &Case,
    (bodies, steps): (usize, usize),
    outcome: &mut Outcome,
    look: &mut dyn FnMut(&[BodyAtNode]),
) -> Result<(), CaseFailure> {
    let draws = if case.tier == Tier::Full { 8 } else { 1 };
    for dimension in ["plane-strain", "3d"] {
        for friction in [0.3, f64::INFINITY] {
            for draw in 0..draws {
                let seed = (bodies as u64) << 8 | draw;
                let name = format!("{bodies}_bodies_{dimension}_friction_{friction}_draw_{draw}");
                let text = scene(case, (dimension, bodies), friction, &mut Random(seed));
                fly(Trial::start(name, text)?, steps, outcome, look)?;
            }
        }
    }
    Ok(())
}

fn fly(
    mut trial: Trial,
    steps: usize,
    outcome: &mut Outcome,
    look: &mut dyn FnMut(&[BodyAtNode]),
) -> Result<(), CaseFailure> {
    for _ in 0..steps {
        trial.advance()?;
        let grid = trial.grid();
        let mut nodes: BTreeMap<[i64; 3], Vec<BodyAtNode>> = BTreeMap::new();
        for (i, x) in grid.position.iter().enumerate() {
            let place = x.map(|x| (x / grid.cell).round() as i64);
            nodes.entry(place).or_default().push(BodyAtNode {
                mass: grid.mass[i],
                velocity: grid.velocity[i],
                impulse: grid.contact_impulse[i],
            });
        }
        nodes.values().filter(|sides| sides.len() > 1).for_each(|sides| look(sides));
    }
    outcome.include(trial);
    Ok(())
}

/// Pieces of a ball of radius 1 around a point near a node. Cuts go through one axis, which in space leans; densities,
/// from 1 to 10, cuts and velocities are drawn.
fn scene(case: &Case, (dimension, bodies): (&str, usize), friction: f64, random: &mut Random) -> String {
    let h = 1.0 / case.cells;
    let center: [f64; 3] = std::array::from_fn(|_| 0.5 * h * random.next());
    let center = if dimension == "3d" { center.to_vec() } else { center[..2].to_vec() };
    // Two across the axis, which in space leans by an angle.
    let lean = 0.6 * random.next();
    let across = |angle: f64| match dimension {
        "3d" => vec![angle.cos(), angle.sin() * lean.cos(), angle.sin() * lean.sin()],
        _ => vec![angle.cos(), angle.sin()],
    };
    // No piece is as wide as half of the ball, but where there are only two.
    let share = 2.0 * PI / bodies as f64;
    let turn = PI * random.next();
    let jitter = if bodies == 2 { 0.0 } else { 0.2 * share };
    let cuts: Vec<f64> = (0..bodies).map(|i| turn + share * i as f64 + jitter * random.next()).collect();
    let mut text = format!(
        "title = \"Bodies that meet at a node\"\nspace = {{ dimension = \"{dimension}\", interior = \"grid\", cell = {h} }}\ntime = {{ \
end = 100, stress_update = \"last\" }}\n"
    );
    for i in 0..bodies {
        let (from, to) = (cuts[i], if i + 1 < bodies { cuts[i + 1] } else { cuts[0] + 2.0 * PI });
        let density = 10f64.powf(0.5 + 0.5 * random.next());
        let inward = across(0.5 * (from + to) + PI);
        let velocity: Vec<f64> = inward.iter().map(|x| SPEED * (x + 0.7 * random.next())).collect();
        let half =
            |angle: f64| format!("{{ half_space = {{ point = {center:?}, normal = {:?} }} }}", across(angle));
        text += &format!(
            "[materials.m{i}]\ndensity = {density}\nneo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}\n\
[[bodies]]\nname = \"piece_{i}\"\nmaterial = \"m{i}\"\nvelocity = {velocity:?}\n\
shape.intersection = [{{ ball = {{ center = {center:?}, radius = 1 }} }}, {}, {}]\n",
            half(from - 0.5 * PI),
            half(to + 0.5 * PI),
        );
    }
    text + &case.contact(friction)
}

/// Speed of flight over that of waves in the lightest piece.
const SPEED: f64 = 0.02;

/// Numbers from -1 to 1 that look drawn and are the same in every run (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
    }
}
