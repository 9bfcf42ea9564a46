//! Two bodies in one place.

use super::bodies::FillingExtent;
use super::neighbours::pairs_within;
use super::penetration::{SharedRoom, deepest};
use super::periodic::Images;
use super::rules::CountedRules;
use super::warning::Warning;
use crate::geometry::{Bounds, SiteLattice};
use crate::scene::{Body, ContactLaw, ContactRule, Interior, Problem, Scene};
use rayon::prelude::*;

/// A particle this share of the spacing inside a body is inside beyond round-off; touching bodies stay allowed.
const ROUND_OFF: f64 = 1e-6;

/// Refuses particle sites that lie inside two bodies, but for those that a joint holds together or that are pressed apart.
///
/// Bodies that overlap by more than a lattice resolves share sites of it. If each has its own, the coarser one may see
/// what lies between the sites of the finer one.
pub(super) fn check(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    let boxes: Vec<_> = extents.iter().map(|extent| extent.bounds).collect();
    let images = Images::new(scene, &boxes);
    let boxes = images.boxes(&boxes);
    let pairs = pairs_within(&boxes, 0.0);
    let pairs_joined = scene.joined_pairs();
    let joined = |[a, b]: [usize; 2]| pairs_joined.contains(&[a, images.of[b]]);
    let pressed = |[a, b]: [usize; 2]| presses(scene, [a, images.of[b]]);
    let counts = |pair: [usize; 2]| images.counts(pair) && !joined(pair) && !pressed(pair);
    match pairs.par_iter().find_map_first(|&pair| shared(&images, &boxes, pair).filter(|_| counts(pair))) {
        Some(problem) => Err(problem),
        None => Ok(()),
    }
}

/// Whether contact presses two bodies apart that overlap: it cannot where both are rigid.
pub(super) fn presses(scene: &Scene, [a, b]: [usize; 2]) -> bool {
    let deforms = [a, b].iter().any(|&body| !scene.bodies[body].is_rigid());
    deforms && scene.contact_between(a, b).press.is_some()
}

/// Bodies that overlap by less than this touch [cells].
const TOUCH: f64 = 1e-6;

/// So do those whose coordinates are given in seven digits, as those of many meshes are: a share of the coordinates.
const SEVEN_DIGITS: f64 = 2e-7;

/// Two bodies that overlap at the start, by the distances to their exact surfaces.
pub(super) struct Overlap {
    /// The second perhaps an image.
    pub bodies: [usize; 2],
    /// Of which body the second is, or is an image.
    pub of: usize,
    /// By which face of the domain, in words.
    through: &'static str,
    pub room: SharedRoom,
}

/// All pairs that overlap; those that are glued or left alone may.
pub(super) fn overlaps(scene: &Scene) -> Vec<Overlap> {
    if scene.start.is_some() {
        return Vec::new();
    }
    let (cell, axes) = (scene.discretization.cell, scene.dimension.axes());
    let inside = inside(scene);
    let bounds = |body: &Body| body.shape.bounds(axes).unwrap_or(Bounds::EVERYTHING).intersected(&inside);
    let boxes: Vec<_> = scene.bodies.iter().map(bounds).collect();
    let images = Images::new(scene, &boxes);
    let boxes = images.boxes(&boxes);
    let joined = scene.joined_pairs();
    let overlap = |&[a, b]: &[usize; 2]| {
        let bodies = [a, images.of[b]];
        let law = scene.contact_between(bodies[0], bodies[1]).law;
        let meant = matches!(law, ContactLaw::None | ContactLaw::Glued);
        if meant || !images.counts([a, b]) || !scene.may_touch(bodies, &joined) {
            return None;
        }
        let room = boxes[a].intersected(&boxes[b]);
        let shapes = [a, b].map(|body| &images.scene.bodies[body].shape);
        let [of_a, of_b] = shapes.map(|shape| move |x| shape.level(x, axes));
        let shared = deepest([&of_a, &of_b], &room, cell, axes)?;
        let far = room.min.iter().chain(&room.max).fold(0.0_f64, |far, x| far.max(x.abs()));
        let (of, through) = (images.of[b], images.through(b));
        (shared.depth > TOUCH * cell + SEVEN_DIGITS * far).then_some(Overlap {
            bodies: [a, b],
            of,
            through,
            room: shared,
        })
    };
    pairs_within(&boxes, 0.0).par_iter().filter_map(overlap).collect()
}

/// The domain, as far as it has faces that bound it.
pub(super) fn inside(scene: &Scene) -> Bounds {
    let axes = scene.dimension.axes();
    scene.domain.as_ref().map_or(Bounds::EVERYTHING, |domain| {
        let upper = |k: usize| match k < axes {
            true if domain.is_periodic(k) => [f64::NEG_INFINITY, f64::INFINITY],
            true => [domain.min[k], domain.max[k]],
            false => [0.0; 2],
        };
        Bounds { min: std::array::from_fn(|k| upper(k)[0]), max: std::array::from_fn(|k| upper(k)[1]) }
    })
}

/// Bodies that overlap and are not pressed apart, and rules that press where nothing overlaps.
pub(super) fn warnings(scene: &Scene) -> Vec<Warning> {
    let found = overlaps(scene);
    // Rules of rigid bodies alone are told of with their other keys.
    let rules = CountedRules::new(scene);
    let presses_something =
        |number: usize, rule: &ContactRule| rule.press.is_some() && !rules.is_of_rigid_bodies(number);
    let idle = scene.contact.iter().enumerate().filter(|(number, rule)| {
        let holds =
            |overlap: &Overlap| scene.contact_rule_between(overlap.bodies[0], overlap.of) == Some(*number);
        presses_something(*number, rule) && scene.start.is_none() && !found.iter().any(holds)
    });
    let idle = idle.map(|(number, _)| {
        let why = "presses nothing: none of its bodies overlap at the start";
        Warning::about(format!("contact[{number}].overlap"), why)
    });
    let mut all: Vec<Warning> = idle.collect();
    let mut pressing =
        scene.contact.iter().enumerate().filter(|(number, rule)| presses_something(*number, rule));
    if let Some((number, _)) = pressing.next().filter(|_| scene.start.is_some()) {
        let why = "does not act: the bodies begin as another run left them";
        all.push(Warning::about(format!("contact[{number}].overlap"), why));
    }
    let kept: Vec<&Overlap> =
        found.iter().filter(|overlap| !presses(scene, [overlap.bodies[0], overlap.of])).collect();
    let deepest = kept.iter().max_by(|x, y| x.room.depth.total_cmp(&y.room.depth));
    all.extend(deepest.map(|deepest| kept_overlap(scene, deepest, kept.len() - 1)));
    all
}

/// What becomes of an overlap that nothing presses apart.
fn kept_overlap(scene: &Scene, overlap: &Overlap, others: usize) -> Warning {
    let Overlap { bodies: [a, _], of, through, room } = overlap;
    let (cell, axes) = (scene.discretization.cell, scene.dimension.axes());
    let [first, second] = [*a, *of].map(|body| format!("`{}`", scene.bodies[body].name));
    let place: Vec<_> = room.place[..axes].iter().map(|x| format!("{x:.4}")).collect();
    let others = match others {
        0 => String::new(),
        more => format!(", and {more} more pair{} by less", if more == 1 { "" } else { "s" }),
    };
    let rigid = [*a, *of].iter().all(|&body| scene.bodies[body].is_rigid());
    let on_own_grid = [*a, *of].iter().any(|&body| scene.interior(body) == Interior::Reference);
    let becomes = match (rigid, on_own_grid) {
        (true, _) => "they part slowly, as their weight would let them fall by as much",
        (false, true) => {
            "contact presses them apart within some transits of a wave, as an interference fit; they fly apart where \
             nothing holds them"
        }
        (false, false) => {
            "contact keeps them from going deeper and does not press them apart: the overlap stays, without stress; \
             overlap = \"press\" in their contact rule makes an interference fit of it"
        }
    };
    Warning::about(
        format!("bodies[{of}].shape"),
        format!(
            "{second} overlaps {first} by {:.3e} m ({:.2e} cells) near ({}) m{through}{others}: {becomes}; else move one \
             of them, or cut one shape out of the other with a difference",
            room.depth,
            room.depth / cell,
            place.join(", "),
        ),
    )
}

/// The problem with a pair of bodies, if they share sites.
fn shared(images: &Images, boxes: &[Bounds], [a, b]: [usize; 2]) -> Option<Problem> {
    let scene = &images.scene;
    let (first, second) = (&scene.bodies[a], &scene.bodies[b]);
    let mut lattices = [first, second].map(|body| scene.lattice(body));
    lattices.sort_by(|a, b| a.spacing.total_cmp(&b.spacing));
    let dimension = lattices[0].dimension;
    let depth = |point: [f64; 3]| {
        let inside = |body: &crate::scene::Body| -body.shape.distance(point, dimension);
        inside(first).min(inside(second))
    };
    let common = boxes[a].intersected(&boxes[b]);
    let in_both = |lattice: &SiteLattice| {
        let deep = |&point: &[f64; 3]| depth(point) > ROUND_OFF * lattice.spacing;
        let mut sites = lattice.sites_around(&common).filter(deep);
        Some((sites.next()?, 1 + sites.count()))
    };
    let [finer, coarser] = &lattices;
    let one = finer.spacing == coarser.spacing;
    let (at, count) = in_both(finer).or_else(|| if one { None } else { in_both(coarser) })?;
    let place: Vec<_> = at[..dimension].iter().map(|x| format!("{x:.4}")).collect();
    Some(Problem {
        key: format!("bodies[{}].shape", images.of[b]),
        found: format!(
            "`{}` overlaps `{}` in {count} particle{} near ({}) m{}",
            second.name,
            first.name,
            if count == 1 { "" } else { "s" },
            place.join(", "),
            images.through(b)
        ),
        allowed: "bodies that touch but do not overlap".into(),
        help: Some("move one of them, or cut one shape out of the other with a difference".into()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{free, scene};
    use crate::geometry::Shape;
    use crate::scene::{Body, Dimension};

    fn overlap(dimension: Dimension, bodies: Vec<Body>) -> Result<(), Problem> {
        let scene = scene(dimension, 0.1, bodies);
        check(&scene, &measure(&scene).expect("filled"))
    }

    fn disks(rows: usize, pitch: f64) -> Vec<Body> {
        let disk = |i: usize| {
            let center = [(i % rows) as f64 * pitch, (i / rows) as f64 * pitch, 0.0];
            free(&format!("disk {i}"), 0, Shape::Ball { center, radius: 0.5 })
        };
        (0..rows * rows).map(disk).collect()
    }

    #[test]
    fn touching_bodies_do_not_overlap() {
        let cube = |x: f64| free("cube", 0, Shape::Box { min: [x, 0.0, 0.0], max: [x + 0.3, 0.3, 0.3] });
        assert_eq!(overlap(Dimension::Space, vec![cube(0.0), cube(0.3), cube(0.6)]), Ok(()));
        // Faces through the particles' sites.
        assert_eq!(overlap(Dimension::Space, vec![cube(0.025), cube(0.325)]), Ok(()));
        assert_eq!(overlap(Dimension::PlaneStrain, disks(4, 1.0)), Ok(()));
    }

    #[test]
    fn turned_faces_that_touch_do_not_overlap() {
        let angle = 0.3;
        let turned = |y: f64| {
            let shape = Box::new(Shape::Box { min: [-1.0, y, 0.0], max: [1.0, y + 1.0, 0.0] });
            free("slab", 0, Shape::Rotated { shape, center: [0.0; 3], axis: [0.0, 0.0, 1.0], angle })
        };
        assert_eq!(overlap(Dimension::PlaneStrain, vec![turned(0.0), turned(1.0)]), Ok(()));
        assert!(overlap(Dimension::PlaneStrain, vec![turned(0.0), turned(0.9)]).is_err());
    }

    /// Sites of one a side at 0.05, 0.15, ... miss an overlap that those of five see, and sites of three at 0.25 and
    /// 0.283 one that those of two see, at 0.275.
    #[test]
    fn either_of_two_lattices_tells_an_overlap() {
        let overlap = |[end, start]: [f64; 2], per_side: [usize; 2]| {
            let square = |[min, max]: [f64; 2], per_side| Body {
                particles_per_side: Some(per_side),
                ..free("square", 0, Shape::Box { min: [min, 0.0, 0.0], max: [max, 0.3, 0.0] })
            };
            let bodies = vec![square([0.0, end], per_side[0]), square([start, 0.6], per_side[1])];
            overlap(Dimension::PlaneStrain, bodies)
        };
        assert_eq!(overlap([0.3, 0.26], [1, 1]), Ok(()));
        assert!(overlap([0.3, 0.26], [1, 5]).is_err());
        assert_eq!(overlap([0.28, 0.26], [3, 3]), Ok(()));
        for per_side in [[2, 3], [3, 2]] {
            let problem = overlap([0.28, 0.26], per_side).expect_err("0.02 m");
            assert!(problem.found.contains("in 6 particles near (0.2750, 0.0250) m"), "{problem}");
        }
    }

    fn warned(dimension: Dimension, bodies: Vec<Body>) -> Option<String> {
        let scene = scene(dimension, 0.1, bodies);
        assert_eq!(check(&scene, &measure(&scene).expect("filled")), Ok(()));
        warnings(&scene).pop().map(|warning| warning.to_string())
    }

    /// Too little for particles to see, down to a hundred-thousandth of a cell.
    #[test]
    fn an_overlap_that_no_particle_sees_is_told_of_with_its_depth() {
        for (depth, cells) in [(4e-3, "4.00e-2"), (1e-4, "1.00e-3"), (1e-6, "1.00e-5")] {
            let pair = disks(1, 1.0).into_iter().chain([free(
                "other",
                0,
                Shape::Ball { center: [0.6 * (1.0 - depth), 0.8 * (1.0 - depth), 0.0], radius: 0.5 },
            )]);
            let text = warned(Dimension::PlaneStrain, pair.collect()).expect("overlap");
            let start = format!(
                "bodies[1].shape: `other` overlaps `disk 0` by {depth:.3e} m ({cells} cells) near (0."
            );
            assert!(text.starts_with(&start), "{text}");
        }
        let mut three = disks(2, 1.0 - 1e-3);
        three.truncate(3);
        let text = warned(Dimension::PlaneStrain, three).expect("overlap");
        assert!(text.contains(", and 1 more pair by less"), "{text}");
    }

    /// Rigid bodies are not pressed apart: that is told once, with the other keys of their rule, and they overlap as
    /// without it.
    #[test]
    fn rigid_bodies_overlap_whether_or_not_a_rule_presses() {
        let disk = |name: &str, x: f64| {
            format!(
                "[[bodies]]\nname = '{name}'\nmaterial = 'm'\nrigid.free = {{}}\n\
                 shape.ball = {{ center = [{x}, 0], radius = 0.5 }}\n"
            )
        };
        let scene = |apart: f64| {
            let text = format!(
                "space = {{ dimension = 'plane-strain', cell = 0.1 }}\ntime.end = 1\ncontact = [{{ overlap = 'press' }}]\n\
                 materials.m = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n{}{}",
                disk("a", 0.0),
                disk("b", apart)
            );
            crate::scene::parse("rigid.toml", &text, &[]).expect("a scene").scene
        };
        let told = |apart: f64| {
            let report = crate::check::tests::report(&scene(apart)).expect("no problem");
            report.warnings.iter().map(|warning| warning.to_string()).collect::<Vec<_>>()
        };
        let dead = "contact[0].overlap: does not act: the rule matches rigid bodies only";
        let [idle] = &told(1.0)[..] else { panic!("one line: {:?}", told(1.0)) };
        assert!(idle.starts_with(dead), "{idle}");
        let [idle, overlap] = &told(0.999)[..] else { panic!("two lines: {:?}", told(0.999)) };
        assert!(idle.starts_with(dead) && overlap.contains("they part slowly"), "{idle}\n{overlap}");
        // A third of a cell: refused as without the rule.
        let deep = scene(0.6);
        assert!(check(&deep, &measure(&deep).expect("filled")).is_err());
    }

    #[test]
    fn what_touches_is_not_told_of() {
        assert_eq!(warned(Dimension::PlaneStrain, disks(8, 1.0)), None);
        let cube = |x: f64| free("cube", 0, Shape::Box { min: [x, 0.0, 0.0], max: [x + 0.3, 0.3, 0.3] });
        assert_eq!(warned(Dimension::Space, vec![cube(0.0), cube(0.3), cube(0.6)]), None);
        // What seven digits hold of coordinates of 1000 m.
        let at = |x: f64| free("far", 0, Shape::Box { min: [x, 0.0, 0.0], max: [x + 0.3, 0.3, 0.3] });
        assert_eq!(warned(Dimension::Space, vec![at(1000.0), at(1000.3 - 5e-5)]), None);
    }

    #[test]
    fn the_overlapping_pair_is_named_among_thousands() {
        let mut bodies = disks(64, 1.0);
        assert_eq!(overlap(Dimension::PlaneStrain, bodies.clone()), Ok(()));
        let Shape::Ball { center, .. } = &mut bodies[2000].shape else { unreachable!("disks are balls") };
        center[0] += 0.2;
        let problem = overlap(Dimension::PlaneStrain, bodies).expect_err("2000 runs into 2001");
        assert_eq!(problem.key, "bodies[2001].shape");
        assert!(problem.found.contains("`disk 2001` overlaps `disk 2000`"), "{problem}");
    }

    #[test]
    fn a_box_with_thousands_of_grains_inside_overlaps_none() {
        let mut bodies = disks(16, 1.0);
        let room = |min: f64, max: f64| Shape::Box { min: [min, min, 0.0], max: [max, max, 0.0] };
        bodies.push(free("walls", 1, Shape::Difference(vec![room(-0.8, 15.8), room(-0.5, 15.5)])));
        assert_eq!(overlap(Dimension::PlaneStrain, bodies.clone()), Ok(()));
        bodies.last_mut().expect("walls").shape = room(-0.8, 15.8);
        assert!(overlap(Dimension::PlaneStrain, bodies).is_err());
    }
}
