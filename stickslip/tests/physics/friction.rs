//! Coulomb friction: a block on an incline, and a rule for every pair.
//!
//! Source: mechanics. Benchmark "block on an incline": at rest for tan(angle) < mu, else a = g (sin(angle) - mu
//! cos(angle)). Gravity is inclined, the geometry lies along the grid.
//!
//! Set-up: the plane; a soft block 1 m long and 0.5 m high on a rigid floor, 10 cells a metre, the law `surface`. The
//! load comes at once, so the block shakes while it settles.
//!
//! Expected: without friction the acceleration within 0.1 %, by least squares over the second half of the run. With
//! friction the tangential over the normal impulse within 1 % of mu up to 0.4 (measured 0.1 %), and the effective
//! coefficient within 5 %. Near tan(angle) = 0.577 the shaking is as fast as the slip, so that the block sticks now and
//! then: at mu = 0.5 the ratio is 3 % low, the same with half the cell and with a quarter of the step. Sticking: the
//! exact answer is rest, if the load comes slowly; loaded at once, an undamped elastic block creeps. So block and floor
//! first fall together, and within 0.2 s the floor comes to rest. Expected: no way in the second half of the run, to
//! 1e-4 of what gravity alone would do (measured 3e-5 at most).

use crate::trial::{RUBBER, run_to, start};
use stickslip::door::ContactCursor;

const ANGLE: f64 = 30.0;
const G: f64 = 10.0;

fn incline(friction: f64) -> String {
    let (sin, cos) = ANGLE.to_radians().sin_cos();
    format!(
        r#"
        gravity = [{}, {}]
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time.end = 1
        {RUBBER}
        [[bodies]]
        name = "floor"
        material = "rubber"
        shape.box = {{ min = [-1, -0.3], max = [5, 0] }}
        rigid = {{}}
        [[bodies]]
        name = "block"
        material = "rubber"
        shape.box = {{ min = [0, 0], max = [1, 0.5] }}
        [[contact]]
        friction = {friction}
        "#,
        G * sin,
        -G * cos
    )
}

/// Slope of y over x by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// Second half of a run of a body on the floor.
struct Slide {
    /// Acceleration along x by least squares [m/s^2].
    acceleration: f64,
    /// Impulse across the contact over impulse along its normals.
    ratio: f64,
}

fn slide(scene: &str, body: usize, end: f64) -> Slide {
    let mut simulation = start(scene);
    let (mut points, mut last) = (Vec::new(), 0.0);
    let (mut normal, mut tangential) = (0.0, 0.0);
    let mut cursor = ContactCursor::default();
    run_to(&mut *simulation, end, |s| {
        let dt = s.time() - last;
        last = s.time();
        let contacts = cursor.read(s);
        if s.time() > 0.5 * end {
            points.push((s.time(), s.bodies()[body].velocity[0]));
            for contact in contacts.iter().filter(|contact| contact.body_b == body) {
                normal += contact.mean.normal * dt;
                tangential += contact.mean.tangential * dt;
            }
        }
    });
    Slide { acceleration: slope(&points), ratio: tangential / normal }
}

#[test]
fn a_block_slides_down_an_incline() {
    let (sin, cos) = ANGLE.to_radians().sin_cos();
    for friction in [0.0, 0.2, 0.4, 0.5] {
        let seen = slide(&incline(friction), 1, 0.8);
        let a = seen.acceleration;
        println!("   tangential/normal {:.4}", seen.ratio);
        let (exact, effective) = (G * (sin - friction * cos), (G * sin - a) / (G * cos));
        println!(
            "friction {friction}: acceleration/exact {:.4}, effective friction {effective:.4}",
            a / exact
        );
        assert!(
            (effective - friction).abs() < 0.05 * friction + 0.001 * sin / cos,
            "{friction}: {effective}"
        );
        if friction <= 0.4 {
            assert!((seen.ratio - friction).abs() <= 0.01 * friction, "{friction}: {}", seen.ratio);
        }
    }
}

#[test]
fn a_block_rests_on_an_incline() {
    let (sin, cos) = ANGLE.to_radians().sin_cos();
    let gravity = [G * sin, -G * cos];
    // g (1 + cos(pi t/T))/2 until T = 0.2 s
    let floor =
        gravity.map(|g| format!("if(t < 0.2, {} * (t - 0.2 + 0.2/pi * sin(pi * t / 0.2)), 0)", 0.5 * g));
    for friction in ["0.65", "0.8", "inf"] {
        let scene = incline(0.0)
            .replace("friction = 0", &format!("friction = {friction}"))
            .replace("rigid = {}", &format!("rigid = {{ velocity = {floor:?} }}"))
            .replace(
                "name = \"block\"",
                &format!("name = \"block\"\nvelocity = {:?}", gravity.map(|g| -0.1 * g)),
            );
        let mut simulation = start(&scene);
        let (mut early, end) = (0.0, 0.8);
        run_to(&mut *simulation, end, |s| {
            if s.time() < 0.5 * end {
                early = s.bodies()[1].position[0];
            }
        });
        let now = simulation.bodies()[1].position[0];
        let free = 0.5 * G * ANGLE.to_radians().sin() * end * end;
        println!("friction {friction}: moved {:.1e} m in the second half, of {free:.2} m", now - early);
        assert!((now - early).abs() < 1e-4 * free, "friction {friction}: creeps {} m", now - early);
    }
}

/// Two equal disks that meet head on do not slip, by symmetry, so friction takes nothing; nor may it, as nothing rubs,
/// gain anything. Nodes at the rim of the contact, with next to no mass, do slip; booked with their velocities the work
/// was 0.7 % of the energy of the disks.
#[test]
fn friction_takes_no_energy_where_nothing_slips() {
    let mut simulation = start(
        r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.1, particles_per_side = 1 }
        time.end = 12
        materials.elastic = { density = 1, hypoelastic = { young_modulus = 1, poisson_ratio = 0.214 } }
        [[bodies]]
        name = "first"
        material = "elastic"
        shape.ball = { center = [-1, 0], radius = 1 }
        particles = "fitted"
        velocity = [0.02, 0]
        [[bodies]]
        name = "second"
        material = "elastic"
        shape.ball = { center = [1, 0], radius = 1 }
        particles = "fitted"
        velocity = [-0.02, 0]
        [[contact]]
        friction = 0.5
        "#,
    );
    let before = simulation.ledger();
    run_to(&mut *simulation, 12.0, |_| {});
    let after = simulation.ledger();
    println!(
        "friction {:.1e}, total {:.4} of the energy",
        after.friction / before.total,
        after.total / before.total
    );
    assert!(simulation.bodies()[0].velocity[0] < -0.018, "they bounce");
    assert!(after.friction.abs() < 1e-3 * before.total, "{after:?}");
    assert!(after.total <= before.total, "{after:?}");
}

/// Blocks thrown along a floor slow down by the friction of their own pair: by names of bodies,
/// by names of materials, by default.
#[test]
fn every_pair_has_its_own_friction() {
    let bodies = [
        ("rubber_one", "rubber", 0.0),
        ("rubber_two", "rubber", 2.0),
        ("stone_one", "stone", 4.0),
        ("stone_two", "stone", 6.0),
    ];
    let mut scene = String::from(
        r#"
        gravity = [0, -10]
        space = { dimension = "plane-strain", interior = "grid", cell = 0.1 }
        time.end = 1
        materials.rubber = { density = 1000, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }
        materials.stone = { density = 2000, hypoelastic = { young_modulus = 2e6, poisson_ratio = 0.3 } }
        materials.steel = { density = 8000, hypoelastic = { young_modulus = 2e6, poisson_ratio = 0.3 } }
        [[contact]]
        between = ["floor", "rubber_two"]
        friction = 0.4
        [[contact]]
        between = ["rubber", "steel"]
        friction = 0.1
        [[contact]]
        between = ["any", "stone_two"]
        friction = 0.3
        [[contact]]
        friction = 0.2
        [[bodies]]
        name = "floor"
        material = "steel"
        shape.box = { min = [-1, -0.3], max = [10, 0] }
        rigid = {}
        "#,
    );
    for (name, material, x) in bodies {
        scene += &format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"{material}\"\nshape.box = {{ min = [{x}, 0], max = [{}, 0.3] }}\nvelocity = [3, 0]\n",
            x + 1.0
        );
    }
    for ((name, ..), (body, friction)) in bodies.iter().zip([(1, 0.1), (2, 0.4), (3, 0.2), (4, 0.3)]) {
        let seen = slide(&scene, body, 0.5);
        let ratio = seen.acceleration / (-friction * G);
        println!("   tangential/normal/mu {:.4}", seen.ratio / friction);
        println!("{name}: deceleration / (mu g) {ratio:.4}");
        assert!((ratio - 1.0).abs() < 0.15, "{name}: {ratio}");
    }
}
