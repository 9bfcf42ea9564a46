//! Numbers that do not fit each other: the grid, the domain, time, materials, motion out of the plane.

use super::table::short;
use crate::column::ColumnDescription;
use crate::material::Material;
use crate::outside::{GIVEN, OUTSIDE};
use crate::scene::{
    BodyMotion, Damping, Dimension, Domain, Expression, FACES, Face, FreeRigid, MOST_BULK, NamedMaterial,
    PERIOD_STEP, Problem, Relaxation, SHORTEST_PERIOD, Scene,
};

/// Walls may miss the nodes of the grid by this share of a cell.
const WALL_TOLERANCE: f64 = 1e-6;

pub(super) fn check(scene: &Scene) -> Result<(), Problem> {
    require_positive("space.cell", scene.discretization.cell, "m")?;
    if scene.discretization.particles_per_side == 0 {
        return Err(problem("space.particles_per_side", "0".into(), "1 or more"));
    }
    if let Some(i) = scene.bodies.iter().position(|body| body.particles_per_side == Some(0)) {
        return Err(problem(&format!("bodies[{i}].particles_per_side"), "0".into(), "1 or more"));
    }
    require_positive("time.courant", scene.time.courant, "")?;
    if let Some(step) = scene.time.max_step {
        require_positive("time.max_step", step, "s")?;
    }
    if !(scene.time.end >= 0.0 && scene.time.end.is_finite()) {
        return Err(problem("time.end", format!("{} s", scene.time.end), "a finite number, at least 0"));
    }
    check_damping(scene)?;
    if scene.bodies.is_empty() {
        return Err(problem("bodies", "no body".into(), "at least one body"));
    }
    for material in &scene.materials {
        check_material(&format!("materials.{}", material.name), material, scene)?;
    }
    check_histories(scene)?;
    check_outside(scene)?;
    if let Some(domain) = &scene.domain {
        check_domain(domain, scene.discretization.cell, scene.dimension.axes())?;
    }
    if scene.dimension.axes() == 2 { check_plane(scene) } else { Ok(()) }
}

/// Damping takes energy and never gives any; a residual of 1 is a body on which forces act unopposed.
fn check_damping(scene: &Scene) -> Result<(), Problem> {
    let Damping { viscous, local, bulk } = scene.damping;
    if !(viscous >= 0.0 && viscous.is_finite()) {
        return Err(problem("damping.viscous", format!("{viscous} 1/s"), "a finite number, at least 0"));
    }
    if !(0.0..1.0).contains(&local) {
        return Err(problem("damping.local", format!("{local}"), "a number from 0 to below 1"));
    }
    for (key, (coefficient, most)) in
        ["bulk_linear", "bulk_quadratic"].into_iter().zip(bulk.into_iter().zip(MOST_BULK))
    {
        if !(0.0..=most).contains(&coefficient) {
            let allowed = format!("a number from 0 to {most}");
            return Err(problem(&format!("damping.{key}"), format!("{coefficient}"), &allowed));
        }
    }
    match scene.time.relax {
        Some(Relaxation { residual }) if !(residual > 0.0 && residual < 1.0) => {
            Err(problem("time.relax.residual", format!("{residual}"), "a number above 0 and below 1"))
        }
        _ => Ok(()),
    }
}

fn problem(key: &str, found: String, allowed: &str) -> Problem {
    Problem { key: key.into(), found, allowed: allowed.into(), help: None }
}

fn require_positive(key: &str, value: f64, unit: &str) -> Result<(), Problem> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(problem(key, format!("{value} {unit}").trim_end().into(), "a finite number above 0"))
}

/// A material is stable if waves in it have a real speed: positive density, K > 0 and G >= 0; a thin plate needs G > 0.
/// Its constants are within the bounds that its law declares, and its law has an answer for the scene's cells.
fn check_material(key: &str, material: &NamedMaterial, scene: &Scene) -> Result<(), Problem> {
    require_positive(&format!("{key}.density"), material.density, "kg/m^3")?;
    let dimension = scene.dimension;
    let elastic = material.law.elastic();
    let (k, g) = (elastic.bulk_modulus, elastic.shear_modulus);
    let speed = material.wave_speed(dimension.thickness());
    if k > 0.0 && g >= 0.0 && speed > 0.0 && speed.is_finite() {
        check_arrays(key, material, dimension)?;
        let sound = material.law.check().and_then(|()| material.law.on_grid(scene.discretization.cell));
        return sound.map(|_| ()).map_err(|bad| {
            let law = format!("{key}.{}", material.law.name());
            let key = bad.key.map_or(law.clone(), |constant| format!("{law}.{constant}"));
            problem(&key, bad.found, &bad.allowed)
        });
    }
    let found = format!("`{}` has K = {k:.4e} Pa, G = {g:.4e} Pa, wave speed {speed:.4e} m/s", material.name);
    Err(problem(
        key,
        found,
        match dimension {
            Dimension::PlaneStress => {
                "K and G above 0 and a finite wave speed, else a thin plate is not stable"
            }
            _ => "K above 0, G at least 0 and a finite wave speed, else the material is not stable",
        },
    ))
}

/// Whether a material's law takes all particles of a body at once.
pub(super) fn is_over_arrays(material: &NamedMaterial) -> bool {
    matches!(material.law, Material::Custom(custom) if custom.law().over_arrays().is_some())
}

/// A law over arrays has no thickness to look for.
fn check_arrays(key: &str, material: &NamedMaterial, dimension: Dimension) -> Result<(), Problem> {
    if dimension == Dimension::PlaneStress && is_over_arrays(material) {
        let found = format!("a law over arrays in plane stress, of the material `{}`", material.name);
        let allowed = "plane-strain or 3d, or a law that takes one particle at a time";
        return Err(problem(&format!("{key}.{}", material.law.name()), found, allowed));
    }
    Ok(())
}

/// What moves rigid bodies and comes from outside is given.
fn check_outside(scene: &Scene) -> Result<(), Problem> {
    for (i, body) in scene.bodies.iter().enumerate() {
        let BodyMotion::Rigid { velocity, spin } = &body.motion else { continue };
        for (key, values) in [("velocity", velocity), ("spin", spin)] {
            let missing =
                values.iter().filter_map(Expression::outside).find(|value| value.function().is_none());
            if let Some(value) = missing {
                let found = format!("the function `{}`, which is not given", value.name());
                return Err(problem(&format!("bodies[{i}].rigid.{key}.{OUTSIDE}"), found, GIVEN));
            }
        }
    }
    Ok(())
}

/// What two laws call alike is one column in snapshots and files, so it must be of one kind.
fn check_histories(scene: &Scene) -> Result<(), Problem> {
    let all = || (scene.materials.iter()).flat_map(|of| of.law.history().iter().map(move |h| (of, h.column)));
    for (i, (material, column)) in all().enumerate() {
        let unlike =
            |(_, other): &(_, ColumnDescription)| other.name == column.name && other.kind != column.kind;
        if let Some((other, theirs)) = all().take(i).find(unlike) {
            let key = format!("materials.{}.{}", material.name, material.law.name());
            let found = format!("a history called `{}` of kind {:?}", column.name, column.kind);
            let allowed = format!("{:?}, as in `{}`, or another name", theirs.kind, other.name);
            return Err(problem(&key, found, &allowed));
        }
    }
    Ok(())
}

fn check_domain(domain: &Domain, cell: f64, dimension: usize) -> Result<(), Problem> {
    for k in 0..dimension {
        let axis = ["x", "y", "z"][k];
        let (min, max) = (domain.min[k], domain.max[k]);
        if !(min < max && min.is_finite() && max.is_finite()) {
            let found = format!("from {min} to {max} m along {axis}");
            return Err(problem("space.domain.max", found, "finite corners, the upper above the lower"));
        }
        let cells = (max - min) / cell;
        check_periodic(domain, (k, cells), cell)?;
        if domain.faces[k][1] != Face::Open && (cells - cells.round()).abs() > WALL_TOLERANCE {
            let whole = cells.round().max(1.0);
            return Err(Problem {
                key: "space.domain.max".into(),
                found: format!("{} cells of {} m along {axis}", short(cells), short(cell)),
                allowed: "a whole number of cells between the domain's lower corner and an upper wall".into(),
                help: Some(format!(
                    "put the upper {axis} wall at {} m, or take cells of {} m",
                    rounded(min + whole * cell),
                    rounded((max - min) / whole)
                )),
            });
        }
    }
    Ok(())
}

/// Periodic faces come in pairs, a whole number of the grid's blocks apart.
fn check_periodic(domain: &Domain, (k, cells): (usize, f64), cell: f64) -> Result<(), Problem> {
    let axis = ["x", "y", "z"][k];
    let Some(side) = domain.faces[k].iter().position(|face| *face == Face::Periodic) else { return Ok(()) };
    if !domain.is_periodic(k) {
        return Err(Problem {
            key: format!("space.domain.{}", FACES[k][side]),
            found: format!("\"periodic\", and `{}` is not", FACES[k][1 - side]),
            allowed: format!("both faces across {axis} periodic, or neither"),
            help: None,
        });
    }
    let (step, shortest) = (PERIOD_STEP as f64, SHORTEST_PERIOD as f64);
    let whole = (step * (cells / step).round()).max(shortest);
    if (cells - whole).abs() <= WALL_TOLERANCE {
        return Ok(());
    }
    Err(Problem {
        key: "space.domain.max".into(),
        found: format!("a period of {} cells of {} m along {axis}", short(cells), short(cell)),
        allowed: format!(
            "{SHORTEST_PERIOD} cells or more between periodic faces, a multiple of {PERIOD_STEP}"
        ),
        help: Some(format!(
            "put the upper {axis} face at {} m, or take cells of {} m",
            rounded(domain.min[k] + whole * cell),
            rounded((domain.max[k] - domain.min[k]) / whole)
        )),
    })
}

/// Ten digits: near enough to be a whole number of cells.
fn rounded(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

/// In the plane nothing accelerates or moves out of it or turns about an axis in it.
fn check_plane(scene: &Scene) -> Result<(), Problem> {
    let stays = "0 in a plane scene";
    let [_, _, along_z] = scene.gravity.strongest(scene.time.end);
    if along_z != 0.0 {
        return Err(problem("gravity", format!("{along_z} m/s^2 along z"), stays));
    }
    for (i, body) in scene.bodies.iter().enumerate() {
        let still = |key: &str, part: &str, zero: bool| {
            let found = format!("`{}` has {part}", body.name);
            if zero { Ok(()) } else { Err(problem(&format!("bodies[{i}].{key}"), found, stays)) }
        };
        let (moves, turns) = match &body.motion {
            BodyMotion::Free { velocity, spin } => (velocity[2] != 0.0, spin[0] != 0.0 || spin[1] != 0.0),
            BodyMotion::Rigid { velocity, spin } => {
                let zero = Expression::Constant(0.0);
                (velocity[2] != zero, spin[0] != zero || spin[1] != zero)
            }
            BodyMotion::FreeRigid(FreeRigid { velocity, spin, .. }) => {
                (velocity[2] != 0.0, spin[0] != 0.0 || spin[1] != 0.0)
            }
        };
        still("velocity", "a velocity along z", !moves)?;
        still("spin", "a spin about x or y", !turns)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{free, incline, scene};
    use crate::geometry::Shape;

    fn key_of(change: impl FnOnce(&mut Scene)) -> String {
        let mut scene = incline(4.0);
        change(&mut scene);
        check(&scene).expect_err("a problem").key
    }

    #[test]
    fn numbers_that_allow_no_step_are_named() {
        assert_eq!(key_of(|s| s.discretization.cell = 0.0), "space.cell");
        assert_eq!(key_of(|s| s.discretization.cell = f64::NAN), "space.cell");
        assert_eq!(key_of(|s| s.discretization.particles_per_side = 0), "space.particles_per_side");
        assert_eq!(key_of(|s| s.bodies[0].particles_per_side = Some(0)), "bodies[0].particles_per_side");
        assert_eq!(key_of(|s| s.time.courant = -0.1), "time.courant");
        assert_eq!(key_of(|s| s.time.max_step = Some(0.0)), "time.max_step");
        assert_eq!(key_of(|s| s.time.end = f64::INFINITY), "time.end");
        assert_eq!(key_of(|s| s.damping.viscous = f64::NAN), "damping.viscous");
        assert_eq!(key_of(|s| s.damping.local = 1.0), "damping.local");
        assert_eq!(key_of(|s| s.damping.bulk[1] = -1.0), "damping.bulk_quadratic");
        let never = Relaxation { residual: 0.0 };
        assert_eq!(key_of(|s| s.time.relax = Some(never)), "time.relax.residual");
        assert_eq!(key_of(|s| s.bodies.clear()), "bodies");
        assert_eq!(
            key_of(|s| s.materials[1].density = -1.0),
            format!("materials.{}.density", incline(4.0).materials[1].name)
        );
    }

    #[test]
    fn an_unstable_material_is_named_with_its_moduli() {
        let mut scene = incline(4.0);
        scene.materials[0].law = {
            let elastic = crate::material::Isotropic { bulk_modulus: -6e6, shear_modulus: 3e6 };
            crate::material::Material::NeoHookean(crate::material::NeoHookean { elastic })
        };
        let problem = check(&scene).expect_err("K < 0");
        assert_eq!(problem.key, format!("materials.{}", incline(4.0).materials[0].name));
        assert!(problem.found.contains("`soft`") && problem.found.contains("-6.0000e6"), "{problem}");
    }

    #[test]
    fn walls_lie_on_nodes_and_open_faces_anywhere() {
        let mut scene = incline(4.0);
        let domain = scene.domain.as_mut().expect("the incline has a domain");
        domain.max[0] = 20.9;
        assert_eq!(check(&scene), Ok(()));
        scene.domain.as_mut().expect("as above").faces[0][1] = Face::Fixed;
        let problem = check(&scene).expect_err("52.25 cells");
        assert_eq!(problem.key, "space.domain.max");
        assert!(problem.found.starts_with("52.25"), "{problem}");
        assert!(problem.help.expect("a wall to take").contains("20.8"));
    }

    #[test]
    fn nothing_leaves_the_plane() {
        let disk = Shape::Ball { center: [0.0; 3], radius: 1.0 };
        let plane = || scene(Dimension::PlaneStrain, 0.1, vec![free("disk", 0, disk.clone())]);
        assert_eq!(check(&plane()), Ok(()));
        let mut falling = plane();
        falling.gravity = [0.0, 0.0, -9.81].into();
        assert_eq!(check(&falling).expect_err("along z").key, "gravity");
        let mut rolling = plane();
        rolling.bodies[0].motion = BodyMotion::Free { velocity: [0.0; 3], spin: [1.0, 0.0, 0.0] };
        assert_eq!(check(&rolling).expect_err("about x").key, "bodies[0].spin");
        let mut leaving = plane();
        let [zero, one] = [0.0, 1.0].map(Expression::Constant);
        let spin = Box::new([zero.clone(), zero.clone(), one.clone()]);
        leaving.bodies[0].motion = BodyMotion::Rigid { velocity: Box::new([zero.clone(), zero, one]), spin };
        assert_eq!(check(&leaving).expect_err("along z").key, "bodies[0].velocity");
    }
}
