//! Keys of a scene that do nothing with the bodies that it has.

use super::bodies::smallest_extent;
use super::rules::CountedRules;
use super::warning::{Warning, and_more};
use crate::scene::{
    Action, BasisKind, Body, Changes, ContactLaw, ContactRule, Damping, Expression, HealthCheck, Interior,
    JointKind, Load, Motor, Normal, Scene,
};
use std::collections::HashSet;

/// What a scene says and nothing comes of, a line for each kind.
pub(super) fn warnings(scene: &Scene) -> impl Iterator<Item = Warning> {
    (rigid_rules(scene).into_iter())
        .chain(nothing_deforms(scene))
        .chain(nothing_falls(scene))
        .chain(nothing_on_the_grid(scene))
        .chain(nothing_heats(scene))
        .chain(rigid_interiors(scene))
        .chain(rigid_particles(scene))
        .chain(overruled_drift(scene))
        .chain(overruled_motor(scene))
        .chain(late_tables(scene))
        .chain(tractions_of_nobody(scene))
}

/// Of rules between rigid bodies alone, keys that are about nodes: these bodies touch without a grid.
fn rigid_rules(scene: &Scene) -> Vec<Warning> {
    let rules = CountedRules::new(scene);
    let told = |(rule, of): (usize, &ContactRule)| {
        let usual = ContactRule::new(of.law);
        let law = !matches!(of.law, ContactLaw::None | ContactLaw::Glued | ContactLaw::Surface);
        let keys = [
            ("law", law),
            ("normal", of.normal == Normal::Own && !law),
            ("max_strain", of.max_strain != usual.max_strain),
            ("overlap", of.press.is_some()),
        ];
        let dead: Vec<&str> = keys.iter().filter(|(_, dead)| *dead).map(|(key, _)| *key).collect();
        let (first, others) = dead.split_first().filter(|_| rules.is_of_rigid_bodies(rule))?;
        let why = format!(
            "does not act{}: the rule matches rigid bodies only, which touch by their exact surfaces, without the grid",
            nor(others)
        );
        Some(Warning::about(format!("contact[{rule}].{first}"), why))
    };
    scene.contact.iter().enumerate().filter_map(told).collect()
}

/// Other keys that do not act either, in a sentence about the first.
fn nor(others: &[&str]) -> String {
    let others: Vec<String> = others.iter().map(|key| format!("`{key}`")).collect();
    if others.is_empty() { String::new() } else { format!(", nor do {}", others.join(", ")) }
}

/// Shape functions, transfer and stress update are of bodies that deform on the grid, and a courant number of bodies
/// that deform.
fn nothing_on_the_grid(scene: &Scene) -> Option<Warning> {
    let mut deforming = (0..scene.bodies.len()).filter(|&body| !scene.bodies[body].is_rigid()).peekable();
    let none_deforms = deforming.peek().is_none();
    if !deforming.all(|body| scene.interior(body) == Interior::Reference) {
        return None;
    }
    let (usual, time) = (crate::scene::Time::until(1.0), &scene.time);
    let keys = [
        ("space.basis", scene.discretization.basis != BasisKind::default()),
        ("time.transfer", time.transfer != usual.transfer),
        ("time.stress_update", time.stress_update != usual.stress_update),
        ("time.pic_share", time.pic_share != usual.pic_share),
        ("time.courant", none_deforms && time.courant != usual.courant),
    ];
    let dead: Vec<&str> = keys.iter().filter(|(_, dead)| *dead).map(|(key, _)| *key).collect();
    let (first, others) = dead.split_first()?;
    let (of, none) = match none_deforms {
        true => ("that deform", "none"),
        false => ("with interior = \"grid\"", "none that deform"),
    };
    let why = format!("does not act{}: it is that of bodies {of}, and the scene has {none}", nor(others));
    Some(Warning::about(*first, why))
}

/// What a material says of heat is of bodies that something heats.
fn nothing_heats(scene: &Scene) -> Option<Warning> {
    let heats = |load: &Load| matches!(load.action, Action::Temperature(_));
    let expands = scene.materials.iter().find(|material| material.thermal_expansion != 0.0)?;
    (!scene.loads.iter().any(heats)).then(|| {
        let key = format!("materials.{}.thermal_expansion", expands.name);
        Warning::about(key, "does not act: no load is a temperature")
    })
}

/// A rigid body has no interior to compute.
fn rigid_interiors(scene: &Scene) -> impl Iterator<Item = Warning> {
    let told = |(i, body): (usize, &Body)| {
        let of = body.interior.filter(|of| *of == Interior::Reference && body.is_rigid());
        of.map(|_| Warning::about(format!("bodies[{i}].interior"), "does not act: the body is rigid"))
    };
    scene.bodies.iter().enumerate().filter_map(told)
}

/// Particles of rigid bodies are for bodies on the common grid, which feel them at nodes. Free rigid bodies look for
/// others from points of surfaces that are as far apart as particles, and loads and springs hold on at such points,
/// too. All else touches a rigid body by its exact shape. Where a body is so thin that the scene's own count hardly
/// fills it, the key acts: a body without particles is refused.
fn rigid_particles(scene: &Scene) -> Option<Warning> {
    let by_points = |(i, body): (usize, &Body)| match body.is_rigid() {
        true => body.as_free_rigid().is_some(),
        false => scene.interior(i) == Interior::Grid,
    };
    if scene.bodies.iter().enumerate().any(by_points) {
        return None;
    }
    let usual = scene.discretization.particles_per_side;
    let filled = 2.0 * scene.discretization.cell / usual as f64 * (1.0 - 1e-9);
    let is_held = |i: usize| {
        let mut ends = scene.springs.iter().flat_map(|spring| &spring.ends);
        ends.any(|end| end.body == i) || scene.loads.iter().any(|load| load.body == i)
    };
    let is_dead = |&(i, body): &(usize, &Body)| {
        let differs = body.particles_per_side.is_some_and(|count| count != usual);
        differs
            && body.is_rigid()
            && !is_held(i)
            && smallest_extent(&body.shape, scene.dimension.axes()) >= filled
    };
    let mut dead = scene.bodies.iter().enumerate().filter(is_dead);
    let (first, body) = dead.next()?;
    let why = format!(
        "does not act on how anything moves: no body deforms on the common grid and no rigid one is free, so exact \
         shapes alone touch; particles of {} are only those of snapshots, with their mass in bodies.csv",
        and_more(&format!("`{}`", body.name), dead.count())
    );
    Some(Warning::about(format!("bodies[{first}].particles_per_side"), why))
}

/// Damping and relaxation are of bodies that deform.
fn nothing_deforms(scene: &Scene) -> Option<Warning> {
    let damps = scene.damping != Damping::of(scene.time.relax);
    let none = scene.bodies.iter().all(|body| body.is_rigid());
    (damps && none).then(|| {
        Warning::about("damping", "does not act: it is that of bodies that deform, and the scene has none")
    })
}

/// Gravity acts on what is free.
fn nothing_falls(scene: &Scene) -> Option<Warning> {
    let falls = scene.gravity.strongest(scene.time.end) != [0.0; 3];
    let none = scene.bodies.iter().all(|body| body.is_prescribed());
    (falls && none).then(|| {
        Warning::about("gravity", "does not act: all bodies move as prescribed, whatever pulls them")
    })
}

/// `time.energy_drift` is the bound of checks that have none of their own.
fn overruled_drift(scene: &Scene) -> Option<Warning> {
    let own = |check| scene.health.rules.get(&check).is_some_and(|rule| rule.bound.is_some());
    let given = scene.time.energy_drift != crate::scene::Time::until(1.0).energy_drift;
    let overruled = given && own(HealthCheck::Energy) && own(HealthCheck::Noise);
    overruled.then(|| {
        let why = "does not act: health.energy and health.noise have bounds of their own";
        Warning::about("time.energy_drift", why)
    })
}

/// A motor that keeps up its speed whatever it takes leaves nothing to other forces.
fn overruled_motor(scene: &Scene) -> Option<Warning> {
    let overruled = |(number, joint): (usize, &crate::scene::Joint)| {
        let (motor, push) = match &joint.kind {
            JointKind::Hinge { motor, .. } => (motor, "torque"),
            JointKind::Slider { motor, .. } => (motor, "force"),
            _ => return None,
        };
        let key = first_key(motor, push).filter(|_| motor.speed.is_some() && motor.limit == f64::INFINITY)?;
        Some(Warning::about(
            format!("joints[{number}].{}.{key}", joint.kind.name()),
            format!(
                "does not act: the motor of `{}` keeps up its speed with as much as it takes; give it a `limit`",
                joint.name
            ),
        ))
    };
    scene.joints.iter().enumerate().find_map(overruled)
}

/// Tables of time of which a run sees the first value alone.
fn late_tables(scene: &Scene) -> Option<Warning> {
    let (changes, end) = (Changes::of(scene), scene.time.end);
    let mut late = changes.tables_not_begun(end);
    let (change, first) = late.next()?;
    let others = match late.count() {
        0 => String::new(),
        others => format!("; so it is with {others} more"),
    };
    let why = format!(
        "the table begins at {first} s, not before the end of the run, {end} s: its first value holds \
         all the time{others}"
    );
    Some(Warning::about(change.key.clone(), why))
}

/// Points of contact are those of bodies on grids of their own.
fn tractions_of_nobody(scene: &Scene) -> Option<Warning> {
    let asked = scene.outputs.measurements.tractions.as_ref()?;
    let on_grid = (0..scene.bodies.len()).filter(|&body| scene.interior(body) == Interior::Grid);
    let Some(names) = &asked.bodies else {
        let why = "does not act: it is that of bodies with interior = \"reference\", and the scene has none";
        let none = on_grid.count() == scene.bodies.len();
        return none.then(|| Warning::about("outputs.tractions", why));
    };
    let names: HashSet<&String> = names.iter().collect();
    let mut dead = on_grid.map(|body| &scene.bodies[body].name).filter(|name| names.contains(name));
    let first = dead.next()?;
    let named = and_more(&format!("`{first}`"), dead.count());
    let why = format!("does not act on {named}: contact on the common grid has no points");
    Some(Warning::about("outputs.tractions.bodies", why))
}

/// The first key of a motor beside its speed that pushes.
pub(super) fn first_key(motor: &Motor, push: &'static str) -> Option<&'static str> {
    let pushes = motor.push != Expression::Constant(0.0);
    let keys = [(push, pushes), ("stiffness", motor.stiffness > 0.0), ("dashpot", motor.dashpot > 0.0)];
    keys.into_iter().find(|(_, acts)| *acts).map(|(key, _)| key)
}

#[cfg(test)]
mod tests {
    use crate::check::tests::report;

    fn told(rest: &str) -> Vec<String> {
        let text = format!(
            "space = {{ dimension = 'plane-strain', cell = 0.1 }}\n\
             materials.iron = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n\
             bodies = [\n\
             {{ name = 'a', material = 'iron', shape.ball = {{ center = [0, 0], radius = 1 }}, rigid.free = {{}} }},\n\
             {{ name = 'b', material = 'iron', shape.ball = {{ center = [3, 0], radius = 1 }}, rigid = {{}} }} ]\n\
             {rest}\n"
        );
        let text = if rest.contains("time") { text } else { text + "time.end = 1\n" };
        let scene =
            crate::scene::parse("dead.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let warnings = report(&scene).expect("no problem").warnings;
        warnings.iter().map(|warning| warning.to_string()).collect()
    }

    #[test]
    fn keys_of_the_grid_do_not_act_where_nothing_deforms_on_it() {
        let told = |keys: &str, others: &str| {
            let text = format!(
                "space = {{ dimension = '2d', cell = 0.1, interior = 'reference' }}\n{keys}\n\
                 materials.iron = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n\
                 contact = [{{ law = 'none' }}]\n\
                 [[bodies]]\nname = 'a'\nmaterial = 'iron'\nshape.ball = {{ center = [0, 0], radius = 1 }}\n\
                 [[bodies]]\nname = 'b'\nmaterial = 'iron'\nshape.ball = {{ center = [3, 0], radius = 1 }}\n{others}"
            );
            let scene = crate::scene::parse("dead.toml", &text, &[]).expect("a scene").scene;
            super::warnings(&scene).map(|warning| warning.to_string()).collect::<Vec<_>>()
        };
        let time = "time = { end = 1, transfer = 'flip', stress_update = 'last', pic_share = 0.1 }";
        let found = told(time, "");
        let why = "time.transfer: does not act, nor do `time.stress_update`, `time.pic_share`: it is that of bodies \
                   with interior = \"grid\", and the scene has none that deform";
        assert_eq!(found, [why]);
        assert_eq!(told(time, "interior = 'grid'"), [""; 0]);
        assert_eq!(told("time = { end = 1, transfer = 'rflip' }", ""), [""; 0]);
        let tractions = "time.end = 1\noutputs.tractions.bodies = ['*']";
        let why = "outputs.tractions.bodies: does not act on `b`: contact on the common grid has no points";
        assert_eq!(told(tractions, "interior = 'grid'"), [why]);
        assert_eq!(told(tractions, ""), [""; 0]);
        let found = told("time.end = 1", "interior = 'reference'\nrigid = {}");
        assert_eq!(found, ["bodies[1].interior: does not act: the body is rigid"]);
    }

    #[test]
    fn particles_of_a_rigid_body_act_on_the_common_grid_alone() {
        let told = |of_a: &str, of_b: &str, rest: &str| {
            let text = format!(
                "space = {{ dimension = '2d', cell = 0.1, interior = 'reference' }}\n\
                 time.end = 1\n\
                 materials.iron = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n\
                 contact = [{{ friction = 0 }}]\n\
                 [[bodies]]\nname = 'a'\nmaterial = 'iron'\nshape.ball = {{ center = [0, 0], radius = 1 }}\n{of_a}\n\
                 [[bodies]]\nname = 'b'\nmaterial = 'iron'\n{of_b}\n{rest}"
            );
            let scene =
                crate::scene::parse("dead.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
            super::warnings(&scene).map(|warning| warning.to_string()).collect::<Vec<_>>()
        };
        let box_of = |high: &str| format!("shape.box = {{ min = [2, 0], max = [3, {high}] }}");
        let (high, thin) = (box_of("1"), box_of("0.06"));
        let fine = format!("{high}\nrigid = {{}}\nparticles_per_side = 4");
        let why = "bodies[1].particles_per_side: does not act on how anything moves: no body deforms on the common \
                   grid and no rigid one is free, so exact shapes alone touch; particles of `b` are only those of \
                   snapshots, with their mass in bodies.csv";
        assert_eq!(told("", &fine, ""), [why]);
        let spring = "[[springs]]\nname = 'strut'\nstiffness = 1\nfrom = { body = 'a', on = 'x_max' }\n\
                      to = { body = 'b', on = 'x_min' }";
        let free = fine.replace("rigid = {}", "rigid.free = {}");
        let usual = fine.replace("= 4", "= 2");
        for (of_a, of_b, rest) in [
            ("interior = 'grid'", &fine, ""),
            ("rigid.free = {}", &fine, ""),
            ("", &free, ""),
            ("", &usual, ""),
            ("", &fine, spring),
            ("", &format!("{thin}\nrigid = {{}}\nparticles_per_side = 4"), ""),
        ] {
            assert_eq!(told(of_a, of_b, rest), [""; 0], "{of_a} {of_b} {rest}");
        }
    }

    #[test]
    fn what_acts_on_no_body_is_told_of() {
        for (rest, said) in [
            ("damping.viscous = 3", "damping: does not act: it is that of bodies that deform"),
            (
                "contact = [{ law = 'gap', max_strain = 0.2 }]",
                "contact[0].law: does not act, nor do `max_strain`",
            ),
            (
                "time = { end = 1, energy_drift = 0.2 }\nhealth = { energy.bound = 0.3, noise.bound = 0.1 }",
                "time.energy_drift: does not act",
            ),
            (
                "time = { end = 1, transfer = 'apic', courant = 0.2 }",
                "time.transfer: does not act, nor do `time.courant`: it is that of bodies that deform, and the scene \
                 has none",
            ),
            (
                "materials.copper = { density = 1, thermal_expansion = 1e-5, neo_hookean = \
                 { young_modulus = 9, poisson_ratio = 0 } }",
                "materials.copper.thermal_expansion: does not act: no load is a temperature",
            ),
            (
                "joints = [{ body = 'a', hinge = { point = [0, 0], speed = 1, dashpot = 3 } }]",
                "joints[0].hinge.dashpot: does not act: the motor of `joint 1` keeps up",
            ),
            (
                "loads = [{ body = 'a', force = [{ table = [[2, 0], [3, 5]] }, 0] }]",
                "loads[0].force: the table begins at 2 s, not before the end of the run, 1 s: its first value holds all \
                 the time",
            ),
            (
                "gravity = [{ table = [[1, 0], [3, 5]] }, { table = [[4, 0], [5, 5]] }]",
                "gravity: the table begins at 1 s, not before the end of the run, 1 s: its first value holds all the \
                 time; so it is with 1 more",
            ),
            (
                "contact = [{ overlap = 'press' }]",
                "contact[0].overlap: does not act: the rule matches rigid bodies only",
            ),
            (
                "outputs.tractions = {}",
                "outputs.tractions: does not act: it is that of bodies with interior = \"reference\", and the scene \
                 has none",
            ),
        ] {
            let found = told(rest);
            assert!(found.len() == 1 && found[0].starts_with(said), "{rest}: {found:?}");
        }
        for rest in [
            "contact = [{ friction = 0.3 }]",
            "time = { end = 1, energy_drift = 0.2 }\nhealth.energy.bound = 0.3",
            "joints = [{ body = 'a', hinge = { point = [0, 0], speed = 1, dashpot = 3, limit = 2 } }]",
            "gravity = [0, -9.81]",
            // A table that the end cuts short acts, and so does one of one row.
            "gravity = [{ table = [[0.99, 0], [3, 5]] }, { table = [[4, 1]] }]",
        ] {
            assert_eq!(told(rest), [""; 0], "{rest}");
        }
    }
}
