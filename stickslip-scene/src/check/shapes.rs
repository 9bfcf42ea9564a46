//! Shapes that are none: no radius, corners the wrong way round, only of three dimensions in the plane, without bounds.

use crate::geometry::{Arrangement, FITTED_SHAPES, Shape, fits};
use crate::scene::{Problem, Scene};

pub(super) fn check(scene: &Scene) -> Result<(), Problem> {
    for (i, body) in scene.bodies.iter().enumerate() {
        let key = format!("bodies[{i}].shape");
        check_shape(&body.shape, &key, scene.dimension.axes())?;
        if !body.is_rigid() && body.shape.bounds(scene.dimension.axes()).is_none() {
            return Err(Problem {
                key,
                found: format!("`{}` deforms and is unbounded", body.name),
                allowed: "a shape of finite size; a rigid body may be unbounded".into(),
                help: Some(
                    "make it rigid = {}, or cut it with a box: an intersection of the box and the half-space"
                        .into(),
                ),
            });
        }
        if body.particles == Arrangement::Fitted && !fits(&body.shape, scene.dimension.axes()) {
            return Err(Problem {
                key: format!("bodies[{i}].particles"),
                found: format!("particles fitted to the shape of `{}`", body.name),
                allowed: FITTED_SHAPES.into(),
                help: Some("particles = \"lattice\" fills every shape".into()),
            });
        }
    }
    Ok(())
}

fn check_shape(shape: &Shape, key: &str, dimension: usize) -> Result<(), Problem> {
    let require = |holds: bool, part: &str, found: String, allowed: &str| {
        let key = format!("{key}.{part}");
        if holds { Ok(()) } else { Err(Problem { key, found, allowed: allowed.into(), help: None }) }
    };
    let finite = |values: &[f64]| values.iter().all(|x| x.is_finite());
    let positive = |radius: f64| radius > 0.0 && radius.is_finite();
    let longer_than_zero = |v: &[f64]| finite(v) && v.iter().any(|&x| x != 0.0);
    match shape {
        Shape::Ball { center, radius } => {
            require(finite(center), "ball.center", format!("{center:?}"), "finite numbers")?;
            require(positive(*radius), "ball.radius", format!("{radius} m"), "a finite number above 0")
        }
        Shape::Box { min, max } => {
            let ordered = (0..dimension).all(|k| min[k] < max[k]);
            let found = format!("from {:?} to {:?} m", &min[..dimension], &max[..dimension]);
            require(
                ordered && finite(min) && finite(max),
                "box.max",
                found,
                "each component above that of min",
            )
        }
        Shape::Cylinder { start, end, radius } => {
            require(
                dimension == 3,
                "cylinder",
                "a cylinder in a plane scene".into(),
                "a ball, box or polygon",
            )?;
            let apart = start != end && finite(start) && finite(end);
            require(apart, "cylinder.end", format!("{end:?} m"), "a finite point other than start")?;
            require(positive(*radius), "cylinder.radius", format!("{radius} m"), "a finite number above 0")
        }
        Shape::HalfSpace { point, normal } => {
            require(finite(point), "half_space.point", format!("{point:?}"), "finite numbers")?;
            let allowed = "a vector of some length; in the plane, along x and y";
            require(
                longer_than_zero(&normal[..dimension]),
                "half_space.normal",
                format!("{normal:?}"),
                allowed,
            )
        }
        Shape::Polygon { points, height } => {
            let found = format!("{} corners", points.len());
            require(points.len() >= 3, "polygon.points", found, "three corners or more")?;
            let corners = points.iter().all(|point| finite(point));
            require(corners, "polygon.points", "a corner that is not finite".into(), "finite numbers")?;
            let area = shape.volume(2).unwrap_or(0.0);
            require(
                area > 0.0,
                "polygon.points",
                "no area between the corners".into(),
                "corners round an area",
            )?;
            let upright = dimension == 2 || height[0] < height[1] && finite(height);
            require(upright, "polygon.height", format!("{height:?} m"), "the lower z, then the upper z")
        }
        Shape::Mesh(_) => {
            require(dimension == 3, "mesh", "a mesh in a plane scene".into(), "a ball, box or polygon")
        }
        Shape::Revolved(revolved) => {
            require(
                dimension == 3,
                "revolved",
                "a shape of revolution in a plane scene".into(),
                "a polygon",
            )?;
            let fault = revolved.fault();
            fault.map_or(Ok(()), |(part, found, allowed)| {
                require(false, &format!("revolved.{part}"), found, allowed)
            })
        }
        Shape::Curved(curved) => curved.fault(dimension).map_or(Ok(()), |(part, found, allowed)| {
            let part = [curved.word(), part].join(".");
            require(false, part.trim_end_matches('.'), found, allowed)
        }),
        Shape::Union(shapes) => check_all(shapes, &format!("{key}.union"), dimension),
        Shape::Intersection(shapes) => check_all(shapes, &format!("{key}.intersection"), dimension),
        Shape::Difference(shapes) => check_all(shapes, &format!("{key}.difference"), dimension),
        Shape::Rotated { shape, center, axis, angle } => {
            require(finite(center), "rotated.center", format!("{center:?}"), "finite numbers")?;
            require(longer_than_zero(axis), "rotated.axis", format!("{axis:?}"), "a vector of some length")?;
            let in_plane = dimension == 3 || axis[0] == 0.0 && axis[1] == 0.0;
            require(in_plane, "rotated.axis", format!("{axis:?}"), "[0, 0, 1] in the plane")?;
            require(angle.is_finite(), "rotated.angle", format!("{angle}"), "a finite number")?;
            check_shape(shape, &format!("{key}.rotated.shape"), dimension)
        }
    }
}

fn check_all(shapes: &[Shape], key: &str, dimension: usize) -> Result<(), Problem> {
    if shapes.is_empty() {
        let (found, allowed) = ("no shape".into(), "at least one shape".into());
        return Err(Problem { key: key.into(), found, allowed, help: None });
    }
    let mut each = shapes.iter().enumerate();
    each.try_for_each(|(i, shape)| check_shape(shape, &format!("{key}[{i}]"), dimension))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{at_rest, free, scene};
    use crate::scene::Dimension;

    fn key_of(dimension: Dimension, shape: Shape) -> String {
        check(&scene(dimension, 0.1, vec![free("it", 0, shape)])).expect_err("a problem").key
    }

    #[test]
    fn shapes_that_are_none_are_named_by_their_path() {
        let (ball, floor) = (
            |radius| Shape::Ball { center: [0.0; 3], radius },
            |normal| Shape::HalfSpace { point: [0.0; 3], normal },
        );
        let space = Dimension::Space;
        assert_eq!(key_of(space, ball(0.0)), "bodies[0].shape.ball.radius");
        assert_eq!(
            key_of(space, Shape::Union(vec![ball(1.0), ball(f64::NAN)])),
            "bodies[0].shape.union[1].ball.radius"
        );
        assert_eq!(key_of(space, Shape::Union(vec![])), "bodies[0].shape.union");
        assert_eq!(key_of(space, floor([0.0; 3])), "bodies[0].shape.half_space.normal");
        let cube = Shape::Box { min: [0.0; 3], max: [1.0, 1.0, 0.0] };
        assert_eq!(key_of(space, cube), "bodies[0].shape.box.max");
        let line =
            Shape::Polygon { points: vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]].into(), height: [0.0, 1.0] };
        assert_eq!(key_of(space, line), "bodies[0].shape.polygon.points");
    }

    #[test]
    fn in_the_plane_there_are_no_cylinders_and_turns_are_about_z() {
        let can = Shape::Cylinder { start: [0.0; 3], end: [1.0; 3], radius: 1.0 };
        assert_eq!(key_of(Dimension::PlaneStrain, can), "bodies[0].shape.cylinder");
        let square = Box::new(Shape::Box { min: [0.0; 3], max: [1.0, 1.0, 0.0] });
        let turned = Shape::Rotated { shape: square, center: [0.0; 3], axis: [0.0, 1.0, 0.0], angle: 1.0 };
        assert_eq!(key_of(Dimension::PlaneStrain, turned), "bodies[0].shape.rotated.axis");
    }

    #[test]
    fn an_unbounded_body_that_deforms_is_refused_with_the_way_out() {
        let floor = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] };
        let problem =
            check(&scene(Dimension::Space, 0.1, vec![free("floor", 0, floor)])).expect_err("unbounded");
        assert_eq!(
            (problem.key.as_str(), problem.found.as_str()),
            ("bodies[0].shape", "`floor` deforms and is unbounded")
        );
        assert!(problem.help.is_some());
    }

    #[test]
    fn a_rigid_body_may_be_unbounded() {
        let floor = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] };
        assert_eq!(check(&scene(Dimension::Space, 0.1, vec![at_rest("floor", floor)])), Ok(()));
    }
}
