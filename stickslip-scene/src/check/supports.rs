//! Supports that hold the same part of a body and move it to different places.

use super::loads::keys;
use super::table::short;
use super::warning::Warning;
use crate::part;
use crate::scene::{Action, Load, Moment, Scene, SupportMotion};
use std::collections::HashMap;

/// Instants of the run at which ways are compared.
const INSTANTS: usize = 16;
/// Parts of the time between two instants over which velocities are summed up.
const PARTS: usize = 32;
/// By how much two ways may differ, over the longer one and over the cell.
const OFF: f64 = 1e-3;

/// Supports of which each holds points that an earlier one moves differently along the same axis: springs of both pull
/// them to and fro.
pub(super) fn warnings(scene: &Scene) -> Vec<Warning> {
    let rigid: Vec<usize> = (0..scene.loads.len()).filter(|&load| is_rigid(&scene.loads[load])).collect();
    let body_of = |&load: &usize| scene.loads[load].body;
    let several = |load: &usize| rigid.iter().filter(|other| body_of(other) == body_of(load)).count() > 1;
    if !rigid.iter().any(several) {
        return Vec::new();
    }
    let keys = keys(scene);
    // The supports of each point of a body.
    let mut holding: HashMap<(usize, [u64; 3]), Vec<usize>> = HashMap::new();
    let mut found: Vec<([usize; 2], Warning)> = Vec::new();
    for &load in rigid.iter().filter(|load| several(load)) {
        let Load { body, part, .. } = &scene.loads[load];
        part::visit(scene, *body, part, &mut |point| {
            let others = holding.entry((*body, point.position.map(f64::to_bits))).or_default();
            for &other in others.iter() {
                if found.iter().any(|(pair, _)| *pair == [other, load]) {
                    continue;
                }
                if let Some((axis, apart)) = apart(scene, [other, load], point.position) {
                    let text = format!(
                        "it moves points of `{}` up to {} m from where {} moves them along {}: both pull, and the part \
                         goes between; leave out one of the two there, or the axis in one of them",
                        scene.bodies[*body].name,
                        short(apart),
                        keys[other],
                        ["x", "y", "z"][axis]
                    );
                    found.push(([other, load], Warning::about(keys[load].as_str(), text)));
                }
            }
            others.push(load);
        });
    }
    found.into_iter().map(|(_, warning)| warning).collect()
}

/// Whether it is a support without a spring or a dashpot, moved by nothing from outside.
fn is_rigid(load: &Load) -> bool {
    let Action::Support(support) = &load.action else { return false };
    support.stiffness.is_none() && support.dashpot.is_none() && load.action.outside().is_none()
}

/// The axis along which two supports move a point apart, and how far at most [m].
fn apart(scene: &Scene, pair: [usize; 2], place: [f64; 3]) -> Option<(usize, f64)> {
    let motion = |load: usize, axis: usize| match &scene.loads[load].action {
        Action::Support(support) => support.motion[axis].as_ref(),
        _ => None,
    };
    (0..scene.dimension.axes()).find_map(|axis| {
        let [a, b] = [motion(pair[0], axis)?, motion(pair[1], axis)?];
        let [a, b] = [a, b].map(|motion| ways(motion, (scene.time.end, place)));
        let longest = a.iter().chain(&b).fold(0.0, |most: f64, way| most.max(way.abs()));
        let apart = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (apart > OFF * longest.max(scene.discretization.cell * OFF)).then_some((axis, apart))
    })
}

/// Where a support moves a point by some instants of the run [m].
fn ways(motion: &SupportMotion, (end, place): (f64, [f64; 3])) -> Vec<f64> {
    let moment = |time: f64| Moment { time, place, start: place, ..Moment::default() };
    let step = end / (INSTANTS * PARTS) as f64;
    let (mut way, mut ways) = (0.0, Vec::with_capacity(INSTANTS));
    for instant in 1..=INSTANTS {
        match motion {
            SupportMotion::Displacement(displacement) => {
                way = displacement.at_moment(&moment(end * instant as f64 / INSTANTS as f64));
            }
            SupportMotion::Velocity(velocity) => {
                let middles = (0..PARTS).map(|part| ((instant - 1) * PARTS + part) as f64 + 0.5);
                way += middles.map(|middle| velocity.at_moment(&moment(middle * step)) * step).sum::<f64>();
            }
        }
        ways.push(way);
    }
    ways
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warned(supports: &str) -> Vec<String> {
        let text = format!(
            "space = {{ dimension = 'plane-strain', cell = 0.02 }}\ntime.end = 0.05\n\
             materials.m = {{ density = 1e3, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}\n\
             [[bodies]]\nname = 'a'\nmaterial = 'm'\nshape.box = {{ min = [0, 0], max = [0.1, 0.1] }}\n{supports}"
        );
        let scene = crate::scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        warnings(&scene).into_iter().map(|warning| format!("{}: {}", warning.key, warning.text)).collect()
    }

    fn support(on: &str, more: &str) -> String {
        format!("[[supports]]\nbody = 'a'\non = '{on}'\n{more}\n")
    }

    /// One holds the face, the other moves it 0.05 m: it went half the way, without a word.
    #[test]
    fn supports_that_contradict_each_other_are_told() {
        let held = support("x_min", "");
        let said = warned(&(held.clone() + &support("x_min", "velocity = [1, 0]")));
        assert_eq!(said.len(), 1, "{said:?}");
        let start =
            "supports[1]: it moves points of `a` up to 0.05 m from where supports[0] moves them along x: ";
        assert!(said[0].starts_with(start), "{said:?}");
    }

    /// A displacement and the velocity that it has, another face, another axis, and a spring beside a support.
    #[test]
    fn supports_that_agree_are_not() {
        let moved = support("x_min", "displacement = ['0.5 m/s^2 * t^2', 0]");
        let same = support("x_min", "velocity = ['1 m/s^2 * t', 0]");
        let held = support("x_min", "displacement = [0, 'free']");
        for pair in [
            moved.clone() + &same,
            moved.clone() + &support("x_max", ""),
            held + &support("x_min", "velocity = ['free', 1]"),
            moved + &support("x_min", "stiffness = 10"),
        ] {
            assert_eq!(warned(&pair), Vec::<String>::new(), "{pair}");
        }
    }
}
