//! Resistance of surfaces beside Coulomb's: static and kinetic friction, viscosity, cohesion, adhesion;
//! and what contact says of itself.
//!
//! Source: mechanics of a rigid block of mass m on a floor over the area A, weight m g, in the plane per depth.
//!
//! ```text
//! kinetic friction:   a = -mu_k g while it slips
//! viscosity:          v = v_0 exp(-eta A t / m)
//! cohesion:           a = -c A / m without any weight
//! adhesion:           hangs for a A > m g, falls for a A < m g
//! ```
//! Set-up: a block 1 m long and 0.5 m high on a rigid floor, 10 cells a metre; light and stiff enough to move as one,
//! surfaces by the law `surface`. Sheared at its lower face it also shears, turns and shakes,
//! hence the tolerances of some per cent. On a grid of its own: a soft block of 20 kg on a floor of 0.2 m, which a load
//! that grows by k t pulls up or along (`tests/sound/bonded_block.toml`).

use crate::trial::{RUBBER, run_to, start};
use stickslip::door::ContactCursor;
use stickslip::scene::{self, Interior};

struct Block<'a> {
    gravity: f64,
    speed: f64,
    contact: &'a str,
}

fn scene(block: &Block) -> String {
    let Block { gravity, speed, contact } = block;
    format!(
        r#"
        gravity = [0, {gravity}]
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time.end = 1
        {RUBBER}
        [[bodies]]
        name = "floor"
        material = "rubber"
        shape.box = {{ min = [-2, -0.3], max = [4, 0] }}
        rigid = {{}}
        [[bodies]]
        name = "block"
        material = "rubber"
        shape.box = {{ min = [0, 0], max = [1, 0.5] }}
        velocity = [{speed}, 0]
        [[contact]]
        law = "surface"
        {contact}
        "#
    )
}

const MASS: f64 = 500.0;
const AREA: f64 = 1.0;

/// Velocity of the block at `time`, and the contacts of all steps as (seconds, row).
fn velocity(block: &Block, time: f64) -> [f64; 3] {
    let mut simulation = start(&scene(block));
    run_to(&mut *simulation, time, |_| {});
    simulation.bodies()[1].velocity
}

#[test]
fn a_slipping_block_has_kinetic_friction_however_high_the_static_one() {
    let contact = "friction = 0.8\nkinetic_friction = 0.2";
    let time = 0.4;
    let v = velocity(&Block { gravity: -10.0, speed: 3.0, contact }, time)[0];
    let exact = 3.0 - 0.2 * 10.0 * time;
    println!("kinetic friction: {v:.4} m/s, exact {exact:.4}");
    assert!((v - exact).abs() < 0.05 * (3.0 - exact) + 0.02, "{v}");
    // Slower than the decay speed the friction is nearly the static one.
    let contact = "friction = 0.3\nkinetic_friction = 0.1\nfriction_decay_speed = 1e6";
    let v = velocity(&Block { gravity: -10.0, speed: 3.0, contact }, time)[0];
    let exact = 3.0 - 0.3 * 10.0 * time;
    println!("static friction at low speed: {v:.4} m/s, exact {exact:.4}");
    assert!((v - exact).abs() < 0.05 * (3.0 - exact) + 0.02, "{v}");
}

#[test]
fn a_viscous_contact_slows_the_block_exponentially() {
    let time = 0.4;
    let v = velocity(&Block { gravity: -10.0, speed: 1.0, contact: "viscosity = 1000" }, time)[0];
    let exact = (-1000.0 * AREA * time / MASS).exp();
    println!("viscosity: {v:.4} m/s, exact {exact:.4}");
    assert!((v - exact).abs() < 0.03, "{v} {exact}");
}

/// A second rigid body on top of the block: sheared below and above, it does not turn away from the floor.
const LID: &str = r#"
        [[bodies]]
        name = "lid"
        material = "rubber"
        shape.box = { min = [-2, 0.5], max = [4, 0.8] }
        rigid = {}
"#;

/// Surfaces that touch resist slip without any push, whether they adhere or not; here on two faces.
#[test]
fn cohesion_and_viscosity_bear_shear_without_weight() {
    let time = 0.1;
    let cohesion = 2.0 - 2.0 * 2000.0 * AREA / MASS * time;
    let viscosity = 2.0 * (-2.0 * 1000.0 * AREA * time / MASS).exp();
    for (keys, exact) in [
        ("cohesion = 2000", cohesion),
        ("cohesion = 2000\nadhesion = 1e5", cohesion),
        ("viscosity = 1000", viscosity),
    ] {
        let contact = format!("{keys}\n{LID}");
        let v = velocity(&Block { gravity: 0.0, speed: 2.0, contact: &contact }, time)[0];
        println!("{keys}: {v:.4} m/s, exact {exact:.4}");
        assert!((v - exact).abs() < 0.1 * (2.0 - exact), "{keys}: {v} {exact}");
    }
}

/// The weight comes at once: the block's own ringing doubles the load on the bond.
#[test]
fn adhesion_holds_what_its_strength_bears() {
    let falls = |contact| velocity(&Block { gravity: 10.0, speed: 0.0, contact }, 0.3)[1];
    let (strong, weak) = (falls("adhesion = 20000"), falls("adhesion = 1000"));
    println!("adhesion: {strong:.3e} m/s bonded, {weak:.3} m/s too weak, exact 0 and 3");
    assert!(strong.abs() < 0.1, "{strong}");
    assert!((weak - 3.0).abs() < 0.15, "{weak}");
}

/// A block that adheres to the floor is thrown off it or along it. Nothing drives it: kinetic and strain energy never
/// rise above the start's. Bonds that give way are in the ledger, whose total ends no higher: they take about their
/// strength times the way over which they act, a hundredth of a cell and a step's way.
#[test]
fn bonds_create_no_energy() {
    for (velocity, cohesion, adhesion) in [
        ([0.0, 1.0], 0.0, 1e4),
        ([0.0, 1.0], 0.0, 1e5),
        ([2.0, 0.0], 2000.0, 1e5),
        ([2.0, 0.0], 2e4, 1e4),
        ([2.0, 0.5], 2e4, 3e4),
    ] {
        let contact = format!("cohesion = {cohesion}\nadhesion = {adhesion}");
        let text = scene(&Block { gravity: 0.0, speed: velocity[0], contact: &contact });
        let text =
            text.replace(&format!("velocity = [{}, 0]", velocity[0]), &format!("velocity = {velocity:?}"));
        let mut simulation = start(&text);
        let first = simulation.ledger().total;
        let mut most = f64::NEG_INFINITY;
        run_to(&mut *simulation, 0.3, |s| {
            most = most.max((s.ledger().kinetic + s.ledger().strain) / first - 1.0)
        });
        let end = simulation.ledger();
        let drift = end.total / first - 1.0;
        println!(
            "{velocity:?} cohesion {cohesion} adhesion {adhesion}: mechanical at most {most:+.1e}, total at the end {drift:+.1e}; friction {:.2} J, adhesion {:.2} J of {first:.0} J",
            end.friction, end.adhesion
        );
        assert!(most < 1e-6, "{velocity:?} {cohesion} {adhesion}: gains {most:e}");
        assert!(drift < 1e-3, "{velocity:?} {cohesion} {adhesion}: total rises by {drift:e}");
        if velocity == [0.0, 1.0] && adhesion == 1e4 {
            let way = 0.001 + 1.0 * 0.0011;
            assert!(
                end.adhesion > 0.5 * adhesion * 0.001 && end.adhesion < adhesion * way,
                "{}",
                end.adhesion
            );
        }
    }
}

/// Speed of the block of `bonded_block.toml` on a grid of its own after a second, by axis, with these parameters [m/s].
/// Its energy, with what friction and bonds took, is the work of the load.
fn pulled(set: &[(&str, f64)]) -> [f64; 2] {
    let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let text = include_str!("../sound/bonded_block.toml");
    let loaded = scene::parse("bonded_block.toml", text, &set).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.scene.interior(0), Interior::Reference);
    let mut simulation = stickslip::step::build(&loaded.scene).expect("a sound scene");
    run_to(&mut *simulation, 1.0, |_| {});
    let (ledger, [vx, vy, _]) = (simulation.ledger(), simulation.bodies()[0].velocity);
    println!("{set:?}: {vx:.5} {vy:.5} m/s, {ledger:?}");
    assert!((ledger.total / ledger.external_work).abs() < 0.01, "{ledger:?}");
    [vx, vy]
}

/// A bond of 2 kN across keeps the block down, unless it is pulled up: cohesion of 200 N bears a load along the floor
/// for half of the second, and all of one of 190 N; viscosity lets it follow the load by a tenth of a second.
#[test]
fn a_block_on_a_grid_of_its_own_resists() {
    let bond = ("adh", 1e4);
    let [slides, _] = pulled(&[("n", 4.0), bond, ("coh", 1000.0), ("fx", 400.0)]);
    // m dv/dt = k t - c A from 0.5 s on.
    assert!((slides / 2.5 - 1.0).abs() < 0.02, "{slides}");
    let [holds, _] = pulled(&[("n", 4.0), bond, ("coh", 1000.0), ("fx", 190.0)]);
    assert!(holds.abs() < 0.01, "{holds}");
    // m dv/dt = k t - eta A v, with m / (eta A) = 0.1 s.
    let [creeps, _] = pulled(&[("n", 4.0), bond, ("vis", 1000.0), ("fx", 100.0)]);
    let exact = 0.5 * (1.0 - 0.1 * (1.0 - (-10.0_f64).exp()));
    assert!((creeps / exact - 1.0).abs() < 0.01, "{creeps} {exact}");
    // Its lower face bends: the bond gives way from its middle or its ends under 0.7 of its strength or more.
    let [_, hangs] = pulled(&[("n", 4.0), bond, ("fy", 1000.0)]);
    assert!(hangs.abs() < 0.01, "{hangs}");
    let [_, leaves] = pulled(&[("n", 4.0), bond, ("fy", 4000.0)]);
    let speed = |from: f64| 100.0 * (1.0 - from * from);
    assert!(leaves > speed(0.51) && leaves < speed(0.35), "{leaves}");
}

/// A block of ten cells on a grid of its own, glued between a ceiling and a floor that lie against it, or so far off
/// [m]: it hangs by its weight, m g H/(2 M) lower in its middle at most, and nothing pulls it to them.
#[test]
fn glue_holds_a_block_as_it_lies() {
    for far in [0.0, 2e-4] {
        let mut simulation = start(&format!(
            r#"
            gravity = [0, -9.81]
            space = {{ dimension = "plane-strain", interior = "reference", cell = 0.01 }}
            time.end = 1
            contact = [{{ law = "glued" }}]
            {RUBBER}
            [[bodies]]
            name = "block"
            material = "rubber"
            shape.box = {{ min = [0, 0], max = [0.1, 0.1] }}
            [[bodies]]
            name = "ceiling"
            material = "rubber"
            rigid = {{}}
            shape.box = {{ min = [-0.05, {}], max = [0.15, 0.15] }}
            [[bodies]]
            name = "floor"
            material = "rubber"
            rigid = {{}}
            shape.box = {{ min = [-0.05, -0.05], max = [0.15, -{far}] }}
            "#,
            0.1 + far
        ));
        let energy = simulation.ledger().total;
        run_to(&mut *simulation, 0.2, |_| {});
        let (sunk, ledger) = (0.05 - simulation.bodies()[0].position[1], simulation.ledger());
        println!("{far}: sunk by {sunk:.2e} m, {ledger:?}");
        assert!(sunk.abs() < 2e-4, "{far}: {sunk}");
        // Weight times the way that it sinks at most.
        assert!(ledger.strain < 1e-2 && ledger.external_work.abs() < 1e-3, "{far}: {ledger:?}");
        assert!((ledger.total - energy).abs() < 1e-3, "{far}: {ledger:?}");
    }
}

/// The block of 500 kg slides by 0.6 m under mu = 0.2: area 1 m, gap 0, the slip of its centre, work mu m g s.
#[test]
fn contact_says_where_how_wide_and_how_far() {
    let block = Block { gravity: -10.0, speed: 2.0, contact: "friction = 0.2" };
    let mut simulation = start(&scene(&block));
    run_to(&mut *simulation, 0.3, |_| {});
    let contacts = ContactCursor::default().read(&*simulation);
    let [contact] = contacts.as_slice() else { panic!("one pair touches: {contacts:?}") };
    let moved = simulation.bodies()[1].position[0] - 0.5;
    println!("{contact:?}, moved {moved}");
    assert_eq!((contact.body_a, contact.body_b), (0, 1));
    let contact = &contact.mean;
    assert!((contact.area - AREA).abs() < 0.1, "{}", contact.area);
    assert!(contact.gap.abs() < 0.005, "{}", contact.gap);
    assert!((contact.slip / moved - 1.0).abs() < 0.1, "{} {moved}", contact.slip);
    let work = 0.2 * MASS * 10.0 * moved;
    assert!((contact.friction / work - 1.0).abs() < 0.1, "{} {work}", contact.friction);
    // Friction tips the block forward, so the forces' centre lies ahead of its middle.
    let centre = 0.5 + 0.5 * moved;
    assert!((contact.position[0] - centre).abs() < 0.25, "{:?} {centre}", contact.position);
    assert!(contact.position[1].abs() < 0.1, "{:?}", contact.position);
    let patches = simulation.patches();
    assert!(patches.len() == 1 && patches[0].area >= contact.area, "{patches:?}");
}

/// A cylinder 3 m long drops on its side: the strip in which it touches is 3 m long, and its half-width the shorter
/// one, not the radius of a circle with its area. What an ellipse is for a strip makes it 1.1 of the half; the ends and
/// the layers of nodes are worth some percent.
#[test]
fn a_cylinder_on_its_side_touches_in_a_strip() {
    let text = format!(
        r#"
        space = {{ dimension = "3d", interior = "grid", cell = 0.125 }}
        time.end = 1
        {RUBBER}
        [[bodies]]
        name = "floor"
        material = "rubber"
        shape.half_space = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
        rigid = {{}}
        [[bodies]]
        name = "roller"
        material = "rubber"
        shape.cylinder = {{ start = [0, -1.5, 0.5], end = [0, 1.5, 0.5], radius = 0.5 }}
        velocity = [0, 0, -5]
        "#
    );
    let mut simulation = start(&text);
    run_to(&mut *simulation, 0.02, |_| {});
    let patch = simulation.patches()[0];
    let half = patch.area / (2.0 * 3.0);
    println!("{patch:?}, half {half}");
    assert!((0.125..0.5).contains(&half), "{patch:?}");
    assert!((patch.half_width / (1.1 * half) - 1.0).abs() < 0.05, "{patch:?}, half {half}");
}
