//! Interference fits: bodies that overlap at the start and are pressed apart.

use super::overlap::{Overlap, inside, overlaps, presses};
use crate::scene::{Problem, Scene};

/// An interference fit: how much surfaces grow, and within which time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interference {
    /// By which the deepest pair overlaps [m].
    pub depth: f64,
    /// Within which surfaces grow by that [s].
    pub time: f64,
}

/// Of each contact rule, how its pairs are pressed apart; `None` where they are not.
pub fn interferences(scene: &Scene) -> Vec<Option<Interference>> {
    if scene.contact.iter().all(|rule| rule.press.is_none()) {
        return vec![None; scene.contact.len()];
    }
    let inside = inside(scene);
    let crossing = |body: usize| {
        let body = &scene.bodies[body];
        let bounds = body.shape.bounds(scene.dimension.axes()).map(|bounds| bounds.intersected(&inside));
        let size = bounds.map_or(0.0, |bounds| bounds.size().into_iter().fold(0.0, f64::max));
        let speed = scene.materials[body.material].wave_speed(scene.dimension.thickness());
        if body.is_rigid() { 0.0 } else { size / speed }
    };
    let mut found = vec![None; scene.contact.len()];
    for Overlap { bodies: [a, _], of, room, .. } in overlaps(scene) {
        let Some(rule) = scene.contact_rule_between(a, of) else { continue };
        let Some(press) = scene.contact[rule].press.filter(|_| presses(scene, [a, of])) else { continue };
        let time = press.time.unwrap_or(CROSSINGS * crossing(a).max(crossing(of)));
        let before = found[rule].unwrap_or(Interference { depth: 0.0, time: 0.0 });
        found[rule] = Some(Interference { depth: before.depth.max(room.depth), time: before.time.max(time) });
    }
    found
}

/// Times that a wave runs through a body while surfaces grow, where the scene does not say how long.
const CROSSINGS: f64 = 10.0;

/// Cells by which bodies that are pressed apart may overlap: beyond, each lies in the other with more than the layer in
/// which surfaces are known.
const DEEPEST: f64 = 0.5;

/// # Errors
/// An interference that is too deep for the grid.
pub(super) fn check_press(scene: &Scene) -> Result<(), Problem> {
    let cell = scene.discretization.cell;
    for (rule, interference) in interferences(scene).into_iter().enumerate() {
        if let Some(depth) = interference.map(|fit| fit.depth).filter(|&depth| depth > DEEPEST * cell) {
            return Err(Problem {
                key: format!("contact[{rule}].overlap"),
                found: format!(
                    "\"press\" of bodies that overlap by {depth:.3e} m, {:.2} cells",
                    depth / cell
                ),
                allowed: format!("an overlap of at most {DEEPEST} cells"),
                help: Some("larger cells, or bodies that overlap by less".into()),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two blocks of 1 m on cells of 0.1 m, with so much of one in the other.
    fn fit(depth: f64, rule: &str) -> Result<Vec<Option<Interference>>, Problem> {
        let text = format!(
            "space = {{ dimension = 'plane-strain', cell = 0.1 }}\ntime.end = 1\n\
             materials.a = {{ density = 1, neo_hookean = {{ p_wave_modulus = 4, poisson_ratio = 0 }} }}\n\
             bodies = [\n{{ name = 'a', material = 'a', shape.box = {{ min = [0, 0], max = [1, 1] }} }},\n\
             {{ name = 'b', material = 'a', shape.box = {{ min = [{}, 0], max = [2, 1] }} }} ]\n\
             contact = [{{ {rule} }}]\n",
            1.0 - depth
        );
        let scene =
            crate::scene::parse("fit.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        check_press(&scene).map(|()| interferences(&scene))
    }

    /// The wave of 2 m/s runs through the longer one, 1 m and a bit, ten times.
    #[test]
    fn surfaces_grow_by_the_overlap_in_ten_crossings_or_the_time_given() {
        let found = fit(0.02, "overlap = 'press'").expect("no problem")[0].expect("an interference");
        assert!((found.depth - 0.02).abs() < 1e-9, "{found:?}");
        assert!((found.time - 10.0 * 1.02 / 2.0).abs() < 1e-9, "{found:?}");
        let found = fit(0.02, "overlap = 'press', press_time = '30 ms'").expect("no problem")[0];
        assert_eq!(found.map(|fit| fit.time), Some(0.03));
        assert_eq!(fit(0.02, "friction = 0.1"), Ok(vec![None]));
        assert_eq!(fit(-0.02, "overlap = 'press'"), Ok(vec![None]));
    }

    #[test]
    fn half_a_cell_is_the_most() {
        let problem = fit(0.06, "overlap = 'press'").expect_err("too deep");
        assert_eq!(problem.key, "contact[0].overlap");
        assert!(problem.found.contains("0.60 cells"), "{problem}");
    }
}
