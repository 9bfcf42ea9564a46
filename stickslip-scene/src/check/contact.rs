//! Whether the grid resolves contacts: the patch that Hertz predicts, in cells.

use super::accuracy::Errors;
use super::bodies::FillingExtent;
use super::flat::Flat;
use super::hertz::{Hertz, HertzPatch};
use super::neighbours::pairs_within;
use super::rules::named_pairs;
use super::touch::{BallContact, SAME};
use crate::geometry::SiteLattice;
use crate::scene::{Body, BodyMotion, ContactLaw, Scene};
use crate::tensor::Vector;
use serde::Serialize;
use std::collections::BTreeSet;

/// The contact of a ball, a cylinder or a flat face with another body, as the start of the scene lets expect it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactEstimate {
    /// Names of the ball's, cylinder's or face's body and of the other one.
    pub bodies: [String; 2],
    /// Distance between the two at the start [m].
    pub gap: f64,
    /// Weight that presses them together [N], in the plane [N/m].
    pub load: f64,
    /// Speed at which they approach at the start [m/s].
    pub approach: f64,
    /// The wider one of Hertz's patches under the load and at the impact; of a flat face its own half-width,
    /// without a depth.
    pub patch: HertzPatch,
    /// Radius of the patch, in the plane its half-width, over the cell size [-].
    pub cells: f64,
    /// What to expect of the contact.
    pub verdict: ContactResolution,
    /// By how much its results may be off.
    pub off: Errors,
}

/// What to expect of a contact on the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactResolution {
    /// Narrower than a cell: the grid decides how wide the bodies touch.
    NotResolved,
    /// 1 to 4 cells.
    Marginal,
    /// At least 4 cells.
    Resolved,
}

impl ContactResolution {
    /// From the radius or half-width of the patch in cells.
    pub fn of(cells: f64) -> Self {
        match cells {
            cells if cells >= 4.0 => ContactResolution::Resolved,
            cells if cells >= 1.0 => ContactResolution::Marginal,
            _ => ContactResolution::NotResolved,
        }
    }
}

/// What the start of a scene lets expect of its contacts.
pub(super) struct Estimates {
    /// Narrowest first.
    pub found: Vec<ContactEstimate>,
    /// Pairs whose shapes tell no patch, by name.
    pub unknown: Vec<[String; 2]>,
}

/// Estimates for all pairs within a cell of each other or named by a contact rule.
///
/// Only balls, cylinders that lie all along, and faces of boxes that lie flat touch in a patch that the start tells; to
/// a ball the other body may be a ball, to a cylinder a cylinder, hollow or full, and it counts as flat where it is
/// something else. The load is the weight of the upper body alone, without what rests on it. Pairs that nothing presses
/// together at the start are left out, as are rigid or glued pairs.
pub(super) fn estimates(scene: &Scene, extents: &[FillingExtent]) -> Estimates {
    let named = named_pairs(scene);
    let boxes: Vec<_> = extents.iter().map(|extent| extent.bounds).collect();
    let near = pairs_within(&boxes, scene.discretization.cell);
    let pairs: BTreeSet<_> = near.into_iter().chain(named.iter().copied()).collect();
    let (mut found, mut unknown) = (Vec::new(), Vec::new());
    for pair in pairs.into_iter().filter(|&pair| pushes(scene, pair)) {
        let [a, b] = pair;
        let touches = [BallContact::of(scene, extents, [a, b]), BallContact::of(scene, extents, [b, a])];
        let near = |gap: f64| gap <= scene.discretization.cell || named.contains(&pair);
        if let Some(nearest) = touches.into_iter().flatten().min_by(|a, b| a.gap.total_cmp(&b.gap)) {
            found.extend(estimate(&nearest, scene).filter(|_| near(nearest.gap)));
            continue;
        }
        let flats = [Flat::of(scene, [a, b]), Flat::of(scene, [b, a])];
        if let Some(flat) = flats.into_iter().flatten().min_by(|a, b| a.gap.total_cmp(&b.gap)) {
            found.extend(of_face(&flat, scene, extents).filter(|_| near(flat.gap)));
        } else if named.contains(&pair) || within_a_cell(scene, extents, pair) {
            unknown.push(pair.map(|i| scene.bodies[i].name.clone()));
        }
    }
    found.sort_by(|a, b| a.cells.total_cmp(&b.cells));
    Estimates { found, unknown }
}

/// Whether two shapes are less than a cell apart: surely if they touch, and not if they are further apart than that,
/// but for combined ones, whose distances are lower bounds.
///
/// From a point the two are as far away as they are apart, or more. Around a point where they touch, one on a lattice
/// of half a cell is within a quarter of a cell along each axis.
fn within_a_cell(scene: &Scene, extents: &[FillingExtent], [a, b]: [usize; 2]) -> bool {
    let (cell, dimension) = (scene.discretization.cell, scene.dimension.axes());
    let around = |i: usize| extents[i].bounds.grown(0.5 * cell);
    let away = |i: usize, point| scene.bodies[i].shape.distance(point, dimension).max(0.0);
    SiteLattice { origin: [0.0; 3], spacing: 0.5 * cell, dimension }
        .sites_around(&around(a).intersected(&around(b)))
        .any(|point| away(a, point) + away(b, point) <= cell)
}

/// Whether contact of a pair can press it together: not both rigid, and neither glued nor left alone.
fn pushes(scene: &Scene, [a, b]: [usize; 2]) -> bool {
    let rigid = scene.bodies[a].is_rigid() && scene.bodies[b].is_rigid();
    !rigid && !matches!(scene.contact_between(a, b).law, ContactLaw::None | ContactLaw::Glued)
}

/// What presses two bodies together at the start.
struct Pressing {
    load: f64,
    approach: f64,
    reduced_mass: f64,
}

impl Pressing {
    fn new(scene: &Scene, pair: [usize; 2], direction: Vector<f64, 3>, masses: [f64; 2]) -> Self {
        let bodies = pair.map(|i| &scene.bodies[i]);
        let held = bodies.map(Body::is_prescribed);
        let gravity = Vector(scene.gravity.strongest(scene.time.end));
        // The one above rests on the other; gravity along the surface presses nothing, but for round-off.
        let along = direction.dot(gravity);
        let above = usize::from(along < 0.0);
        let presses = along.abs() > SAME * gravity.norm() && !held[above];
        let load = if presses { masses[above] * along.abs() } else { 0.0 };
        let velocities = bodies.map(|body| Vector(starting_velocity(body)));
        let closing = direction.dot(velocities[0] - velocities[1]);
        let approach = if closing > SAME * (velocities[0] - velocities[1]).norm() { closing } else { 0.0 };
        let inverse_masses = [0, 1].map(|i| if held[i] { 0.0 } else { 1.0 / masses[i] });
        Pressing { load, approach, reduced_mass: 1.0 / (inverse_masses[0] + inverse_masses[1]) }
    }

    fn estimate(&self, scene: &Scene, pair: [usize; 2], gap: f64, patch: HertzPatch) -> ContactEstimate {
        let cells = patch.radius / scene.discretization.cell;
        ContactEstimate {
            bodies: pair.map(|i| scene.bodies[i].name.clone()),
            gap,
            load: self.load,
            approach: self.approach,
            patch,
            cells,
            verdict: ContactResolution::of(cells),
            off: Errors::of(cells),
        }
    }
}

/// `None` if nothing presses the two together.
fn estimate(touch: &BallContact, scene: &Scene) -> Option<ContactEstimate> {
    let bodies = touch.pair.map(|i| &scene.bodies[i]);
    let rigid = bodies.map(Body::is_rigid);
    let materials =
        std::array::from_fn(|i| (!rigid[i]).then(|| scene.materials[bodies[i].material].law.elastic()));
    let modulus = Hertz::effective_modulus(materials, scene.dimension);
    // Along a line each metre is as in the plane.
    let (dimension, length) = touch.length.map_or((scene.dimension.axes(), 1.0), |length| (2, length));
    let hertz = Hertz { modulus, radius: touch.radius, dimension };
    let pressing = Pressing::new(scene, touch.pair, touch.direction, touch.masses);
    let rest = hertz.under_load(pressing.load / length);
    let impact = hertz.at_impact(pressing.reduced_mass / length, pressing.approach);
    let patch = if impact.radius > rest.radius { impact } else { rest };
    (patch.radius > 0.0).then(|| pressing.estimate(scene, touch.pair, touch.gap, patch))
}

/// A face touches as wide as it is, if anything presses it.
fn of_face(flat: &Flat, scene: &Scene, extents: &[FillingExtent]) -> Option<ContactEstimate> {
    let pressing = Pressing::new(scene, flat.pair, flat.direction, flat.pair.map(|i| extents[i].mass));
    let patch = HertzPatch { radius: flat.half_width, depth: 0.0 };
    let pressed = pressing.load > 0.0 || pressing.approach > 0.0;
    pressed.then(|| pressing.estimate(scene, flat.pair, flat.gap, patch))
}

/// Velocity of the centre of mass at the start [m/s]; spin moves a ball's surface along the contact, not into it.
pub(super) fn starting_velocity(body: &Body) -> [f64; 3] {
    match &body.motion {
        BodyMotion::Free { velocity, .. } => *velocity,
        BodyMotion::Rigid { velocity, .. } => velocity.each_ref().map(|v| v.at(0.0)),
        BodyMotion::FreeRigid(free) => free.velocity,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{at_rest, free, incline, scene};
    use crate::geometry::Shape;
    use crate::scene::{ContactRule, Dimension, Expression};
    use std::f64::consts::PI;

    fn estimates_of(scene: &Scene) -> Vec<ContactEstimate> {
        estimates(scene, &measure(scene).expect("filled")).found
    }

    fn ball(x: f64, radius: f64) -> Shape {
        Shape::Ball { center: [x, 0.0, 0.0], radius }
    }

    fn moving(mut body: Body, velocity: [f64; 3]) -> Body {
        body.motion = BodyMotion::Free { velocity, spin: [0.0, 0.0, 5.0] };
        body
    }

    /// The paper's sphere: the mean height of its centre on the slope is 1.555 m by Hertz.
    #[test]
    fn the_papers_sphere_sinks_by_what_hertz_says() {
        let found = estimates_of(&incline(8.0));
        assert_eq!(found.len(), 1);
        let contact = &found[0];
        assert_eq!(contact.bodies, ["sphere", "plane"]);
        assert!(contact.gap.abs() < 1e-12);
        // The half sphere carries the load of the whole one.
        let weight = 4.0 / 3.0 * PI * 1.6f64.powi(3) * 1000.0 * 10.0 * (PI / 4.0).cos();
        assert!((contact.load / weight - 1.0).abs() < 1e-9);
        assert!((1.6 - contact.patch.depth - 1.555).abs() < 5e-4, "{}", contact.patch.depth);
        assert!((contact.patch.radius / (1.6 / 6.0) - 1.0).abs() < 0.01, "{}", contact.patch.radius);
        assert_eq!(contact.verdict, ContactResolution::Marginal);
    }

    #[test]
    fn the_verdict_follows_the_cells() {
        assert_eq!(estimates_of(&incline(4.0))[0].verdict, ContactResolution::NotResolved);
        assert_eq!(ContactResolution::of(4.0), ContactResolution::Resolved);
        assert!(
            ContactResolution::NotResolved < ContactResolution::Marginal
                && ContactResolution::Marginal < ContactResolution::Resolved
        );
    }

    #[test]
    fn two_spheres_at_impact_agree_with_the_closed_form() {
        let bodies = vec![
            moving(free("a", 0, ball(0.0, 1.0)), [0.5, 0.0, 0.0]),
            moving(free("b", 0, ball(2.05, 1.0)), [-0.5, 0.0, 0.0]),
        ];
        let scene = scene(Dimension::Space, 0.1, bodies);
        let found = estimates_of(&scene);
        let contact = &found[0];
        let elastic = scene.materials[0].law.elastic();
        let modulus = elastic.young_modulus() / (2.0 * (1.0 - elastic.poisson_ratio().powi(2)));
        let mass = 0.5 * 4.0 / 3.0 * PI * 1000.0;
        let depth = (15.0 * mass / (16.0 * modulus * 0.5f64.sqrt())).powf(0.4);
        assert!((contact.gap - 0.05).abs() < 1e-9 && (contact.approach - 1.0).abs() < 1e-9);
        assert!((contact.patch.depth / depth - 1.0).abs() < 1e-9, "{} {depth}", contact.patch.depth);
        assert_eq!(contact.load, 0.0);
    }

    #[test]
    fn a_disk_presses_a_rigid_floor_with_its_weight_per_metre() {
        let mut floor = free("floor", 1, Shape::Box { min: [-2.0, -1.0, 0.0], max: [2.0, 0.0, 0.0] });
        let still = || Box::new([0.0; 3].map(Expression::Constant));
        floor.motion = BodyMotion::Rigid { velocity: still(), spin: still() };
        let disk = free("disk", 0, Shape::Ball { center: [0.0, 0.5, 0.0], radius: 0.5 });
        let mut scene = scene(Dimension::PlaneStrain, 0.1, vec![floor, disk]);
        scene.gravity = [0.0, -10.0, 0.0].into();
        let contact = &estimates_of(&scene)[0];
        let elastic = scene.materials[0].law.elastic();
        let modulus = elastic.young_modulus() / (1.0 - elastic.poisson_ratio().powi(2));
        let load = PI * 0.25 * 1000.0 * 10.0;
        assert!((contact.load / load - 1.0).abs() < 1e-9);
        let half_width = (4.0 * load * 0.5 / (PI * modulus)).sqrt();
        assert!((contact.patch.radius / half_width - 1.0).abs() < 1e-9);
    }

    /// A roller 2 m long presses a half-space as a disk does per metre; one askew touches with its rim,
    /// and is not estimated.
    #[test]
    fn a_cylinder_on_its_side_presses_as_a_disk_does() {
        let on_floor = |end: [f64; 3]| {
            let roller = Shape::Cylinder { start: [0.0, -1.0, 0.5], end, radius: 0.5 };
            let floor = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] };
            let mut scene =
                scene(Dimension::Space, 0.1, vec![free("roller", 0, roller), at_rest("floor", floor)]);
            scene.gravity = [0.0, 0.0, -10.0].into();
            estimates_of(&scene)
        };
        let found = on_floor([0.0, 1.0, 0.5]);
        let load = PI * 0.25 * 1000.0 * 10.0;
        assert!((found[0].load / (2.0 * load) - 1.0).abs() < 1e-9, "{found:?}");
        let elastic = scene(Dimension::Space, 0.1, vec![]).materials[0].law.elastic();
        let modulus = elastic.young_modulus() / (1.0 - elastic.poisson_ratio().powi(2));
        let half_width = (4.0 * load * 0.5 / (PI * modulus)).sqrt();
        assert!((found[0].patch.radius / half_width - 1.0).abs() < 1e-9, "{found:?}");
        assert!(on_floor([0.0, 1.0, 0.6]).is_empty());
    }

    #[test]
    fn a_block_touches_as_wide_as_its_face() {
        let block = Shape::Box { min: [0.0, 0.0, 0.0], max: [1.0, 0.5, 1.0] };
        let floor = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] };
        let mut scene = scene(Dimension::Space, 0.1, vec![free("block", 0, block), at_rest("floor", floor)]);
        assert!(estimates_of(&scene).is_empty());
        scene.gravity = [0.0, 0.0, -10.0].into();
        let found = estimates_of(&scene);
        assert!(
            (found[0].cells - 2.5).abs() < 1e-9 && found[0].verdict == ContactResolution::Marginal,
            "{found:?}"
        );
    }

    #[test]
    fn a_ball_in_a_hollow_touches_wider_than_on_a_plane() {
        let on = |support: Shape| {
            let ball = free("ball", 0, Shape::Ball { center: [0.0, 0.0, 1.0], radius: 1.0 });
            let mut scene = scene(Dimension::Space, 0.2, vec![ball, free("support", 1, support)]);
            scene.gravity = [0.0, 0.0, -10.0].into();
            estimates_of(&scene)[0].patch.radius
        };
        let block = || Shape::Box { min: [-2.0, -2.0, -1.0], max: [2.0, 2.0, 1.0] };
        let bowl = Shape::Ball { center: [0.0, 0.0, 2.0], radius: 2.0 };
        let flat = on(Shape::Box { min: [-2.0, -2.0, -1.0], max: [2.0, 2.0, 0.0] });
        let hollow = on(Shape::Difference(vec![block(), bowl]));
        // 1/R* = 1 - 1/2, so R* doubles and a grows by the cube root of 2.
        assert!((hollow / flat - 2f64.cbrt()).abs() < 1e-6, "{hollow} {flat}");
    }

    /// A cylinder on its rim, and one 1.1 cells above the floor, which a rule may name.
    #[test]
    fn pairs_that_are_near_and_whose_shapes_tell_nothing_are_named() {
        let askew = |name: &str, x: f64, gap: f64| {
            // The rim is lowest 0.3 cos below the lower end's centre.
            let (sin, cos) = 0.5f64.sin_cos();
            let [start, end] = [0.0, 1.0].map(|s| [x + s * cos, 0.0, 0.3 * cos + gap + s * sin]);
            free(name, 0, Shape::Cylinder { start, end, radius: 0.3 })
        };
        let floor = at_rest("floor", Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] });
        let bodies = vec![askew("rim", 0.0, 0.0), askew("far", 3.0, 0.11), floor];
        let mut scene = scene(Dimension::Space, 0.1, bodies);
        let unknown = |scene: &Scene| estimates(scene, &measure(scene).expect("filled")).unknown;
        assert_eq!(unknown(&scene), [["rim", "floor"]]);
        let between = [Some("far".to_string()), Some("floor".to_string())];
        scene.contact = vec![ContactRule { between, ..Default::default() }];
        assert_eq!(unknown(&scene), [["rim", "floor"], ["far", "floor"]]);
        scene.contact[0].law = ContactLaw::Glued;
        assert_eq!(unknown(&scene), [["rim", "floor"]]);
    }

    #[test]
    fn only_what_is_pressed_near_or_named_is_estimated() {
        let far =
            || vec![moving(free("a", 0, ball(0.0, 0.5)), [1.0, 0.0, 0.0]), free("b", 0, ball(5.0, 0.5))];
        let mut scene = scene(Dimension::Space, 0.1, far());
        assert!(estimates_of(&scene).is_empty());
        let between = [Some("b".to_string()), Some("a".to_string())];
        scene.contact = vec![ContactRule { between, ..Default::default() }];
        let found = estimates_of(&scene);
        assert!((found[0].gap - 4.0).abs() < 1e-9, "{}", found[0].gap);
        scene.contact[0].law = ContactLaw::Glued;
        assert!(estimates_of(&scene).is_empty());
        scene.contact[0].law = ContactLaw::Gap;
        scene.bodies[0].motion = BodyMotion::Free { velocity: [-1.0, 0.0, 0.0], spin: [0.0; 3] };
        assert!(estimates_of(&scene).is_empty());
    }

    #[test]
    fn spheres_side_by_side_on_a_level_floor_do_not_press_each_other() {
        let mut bodies: Vec<_> = (0..3).map(|i| free(&format!("{i}"), 0, ball(f64::from(i), 0.5))).collect();
        bodies.push(free("floor", 1, Shape::Box { min: [-1.0, -1.0, -1.0], max: [3.0, 1.0, -0.5] }));
        let mut scene = scene(Dimension::Space, 0.1, bodies);
        scene.gravity = [0.0, 0.0, -10.0].into();
        let found = estimates_of(&scene);
        assert_eq!(found.len(), 3);
        assert!(found.iter().all(|contact| contact.bodies[1] == "floor"));
    }
}
