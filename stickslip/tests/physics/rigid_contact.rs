//! Rigid bodies rub, stick, hold and stand on each other as their rules say.
//!
//! Source: Coulomb's law with a static and a kinetic coefficient, mechanics of rigid bodies.
//!
//! Set-up: blocks and disks that are rigid and free, on planes, belts and each other, in the plane and in space.
//!
//! Expected: a block rests below the static coefficient, to 1e-9 m, and slides above it with the kinetic one, within
//! 1e-6; a disk rolls with 2/3 g sin(theta) within 1e-6; the stretch and the period of stick-slip on a belt within
//! 1 %; bonds that hold until the force is their strength times their area, and then give way, within 0.02 s of a force
//! that grows for 1 s; viscous slip with its time within 1e-3; a tower in which each box carries the weight above it,
//! within 0.5 %, a step of the time looked at, and stays where it is to 1e-7 m; the same bits for any threads.

use crate::trial::{distance, run_to, start, take_steps};
use rayon::ThreadPoolBuilder;
use std::f64::consts::PI;
use stickslip::door::Simulation;

const GRAVITY: f64 = 9.81;

/// A scene of rigid bodies of 1000 kg/m^3 on a floor that ends at y = 0.
fn on_floor(dimension: &str, [gravity, end]: [&str; 2], [floor, bodies, contact]: [&str; 3]) -> String {
    let third = if dimension == "3d" { ", 0" } else { "" };
    format!(
        r#"
        gravity = {gravity}
        space = {{ dimension = "{dimension}", interior = "grid", cell = 0.02 }}
        time = {{ end = {end}, max_step = 1e-3 }}
        materials.stone = {{ density = 1000, neo_hookean = {{ young_modulus = 1e7, poisson_ratio = 0.3 }} }}
        contact = [{{ {contact} }}]
        bodies = [
            {{ name = "floor", material = "stone", rigid = {{ {floor} }},
               shape.half_space = {{ point = [0, 0{third}], normal = [0, 1{third}] }} }},
            {bodies}
        ]
        "#
    )
}

/// A block of 0.2 m by 0.1 m, in space 0.1 m deep.
fn block(dimension: &str) -> &'static str {
    match dimension {
        "3d" => {
            "{ name = 'block', material = 'stone', rigid = { free = {} },
               shape.box = { min = [0, 0, 0], max = [0.2, 0.1, 0.1] } }"
        }
        _ => {
            "{ name = 'block', material = 'stone', rigid = { free = {} },
               shape.box = { min = [0, 0], max = [0.2, 0.1] } }"
        }
    }
}

/// Gravity on a slope that goes down by so much a metre along x, and in space the same along z.
fn sloping(slope: f64, dimension: &str) -> String {
    let share = slope / (1.0 + slope * slope).sqrt();
    let down = -GRAVITY / (1.0 + slope * slope).sqrt();
    match dimension {
        "3d" => format!("[{}, {down}, {}]", 0.6 * GRAVITY * share, 0.8 * GRAVITY * share),
        _ => format!("[{}, {down}]", GRAVITY * share),
    }
}

#[test]
fn a_block_rests_below_static_friction_and_slides_with_kinetic() {
    for dimension in ["plane-strain", "3d"] {
        for (slope, rests) in [(0.4, true), (0.49, true), (0.51, false), (0.8, false)] {
            let gravity = sloping(slope, dimension);
            let friction = "friction = 0.5, kinetic_friction = 0.3";
            let text = on_floor(dimension, [&gravity, "1"], ["", block(dimension), friction]);
            let mut simulation = start(&text);
            let begun = simulation.bodies()[1].position;
            run_to(&mut *simulation, 0.5, |_| {});
            let block = simulation.bodies()[1].clone();
            let way = distance(block.position, begun);
            let pull = GRAVITY * (slope - 0.3) / (1.0 + slope * slope).sqrt();
            let speed = distance(block.velocity, [0.0; 3]);
            println!("{dimension}, slope {slope}: {way:.3e} m, {speed:.8} m/s of {:.8}", 0.5 * pull);
            match rests {
                true => assert!(way < 1e-9, "{dimension}, {slope}: {way}"),
                false => assert!((speed / (0.5 * pull) - 1.0).abs() < 1e-6, "{dimension}, {slope}: {speed}"),
            }
        }
    }
}

/// With friction that falls with the slip, and a block that is pushed: below mu_k it stops after v^2 / (2 a) and stays.
#[test]
fn a_pushed_block_stops_and_then_bears_static_friction() {
    let gravity = sloping(0.2, "plane-strain");
    let moving = block("plane-strain").replace("name =", "velocity = [1, 0], name =");
    for (friction, kinetic) in [
        ("friction = 0.6, kinetic_friction = 0.3", 0.3),
        ("friction = 0.6, kinetic_friction = 0.3, friction_decay_speed = 1e-6", 0.3),
    ] {
        let text = on_floor("plane-strain", [&gravity, "2"], ["", &moving, friction]);
        let mut simulation = start(&text);
        run_to(&mut *simulation, 1.5, |_| {});
        let stopped = simulation.bodies()[1].position[0] - 0.1;
        run_to(&mut *simulation, 2.0, |_| {});
        let stayed = simulation.bodies()[1].position[0] - 0.1;
        let exact = 0.5 / (GRAVITY * (kinetic - 0.2) / 1.04_f64.sqrt());
        println!("{friction}: stopped after {stopped:.5} m of {exact:.5}");
        assert!(
            (stopped / exact - 1.0).abs() < 5e-3 && (stayed - stopped).abs() < 1e-9,
            "{stopped} {stayed}"
        );
    }
}

#[test]
fn a_disk_rolls_by_its_static_friction() {
    // It needs tan(theta) / 3 = 0.167: more than the kinetic coefficient.
    let disk = "{ name = 'disk', material = 'stone', rigid = { free = {} },
                  shape.ball = { center = [0, 0.1], radius = 0.1 } }";
    let gravity = sloping(0.5, "plane-strain");
    for (friction, rolls) in [
        ("friction = 0.2, kinetic_friction = 0.05", true),
        ("friction = 0.15, kinetic_friction = 0.05", false),
    ] {
        let mut simulation = start(&on_floor("plane-strain", [&gravity, "1"], ["", disk, friction]));
        run_to(&mut *simulation, 0.5, |_| {});
        let disk = simulation.bodies()[1].clone();
        let [along, down] = [0.5, 1.0].map(|x| GRAVITY * x / 1.25_f64.sqrt());
        let (pull, turning) = match rolls {
            true => (along / 1.5, along / 1.5),
            false => (along - 0.05 * down, 2.0 * 0.05 * down),
        };
        let [speed, rolled] = [disk.velocity[0] / (0.5 * pull), -disk.spin[2] * 0.1 / (0.5 * turning)];
        println!("{friction}: v {speed:.8}, w R {rolled:.8} of the exact ones");
        assert!((speed - 1.0).abs() < 1e-6 && (rolled - 1.0).abs() < 1e-6, "{speed} {rolled}");
    }
}

/// A block on a belt that moves with V, held by a spring: it sticks until k x = mu_s N, and slips back.
///
/// ```text
/// x_s, x_k = mu_s N / k, mu_k N / k;   w^2 = k / m
/// largest stretch x_k + sqrt((x_s - x_k)^2 + (V / w)^2)
/// period 2 (x_s - x_k) / V + 2 / w (pi - atan(w (x_s - x_k) / V))
/// ```
#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    let (mass, stiffness, belt) = (20.0, 2000.0_f64, 0.1);
    let text = on_floor(
        "plane-strain",
        ["[0, -9.81]", "6"],
        [&format!("velocity = [{belt}, 0]"), block("plane-strain"), "friction = 0.5, kinetic_friction = 0.3"],
    ) + &format!(
        "[[joints]]\nbody = 'block'\nspring = {{ from = [0.1, 0.05], to = [-1, 0.05], stiffness = {stiffness} }}"
    );
    let mut simulation = start(&text);
    let (mut largest, mut slips, mut before) = (0.0_f64, Vec::new(), 0.0);
    run_to(&mut *simulation, 6.0, |view| {
        let speed = view.bodies()[1].velocity[0];
        largest = largest.max(view.joints()[0].way);
        if before > 0.0 && speed <= 0.0 {
            slips.push(view.time());
        }
        before = speed;
    });
    let [still, moving] = [0.5, 0.3].map(|mu| mu * mass * GRAVITY / stiffness);
    let rate = (stiffness / mass).sqrt();
    let stretch = moving + ((still - moving).powi(2) + (belt / rate).powi(2)).sqrt();
    let period = 2.0 * (still - moving) / belt + 2.0 / rate * (PI - (rate * (still - moving) / belt).atan());
    let found = (slips[slips.len() - 1] - slips[0]) / (slips.len() - 1) as f64;
    println!(
        "stretch {largest:.6} m of {stretch:.6}; period {found:.5} s of {period:.5}, {} slips",
        slips.len()
    );
    assert!((largest / stretch - 1.0).abs() < 0.01 && (found / period - 1.0).abs() < 0.01);
    assert!(slips.len() > 4);
}

/// A bond of 1 kPa over 0.2 m, and in space over 0.02 m^2, of a block of 20 kg and 2 kg: gravity grows until it breaks.
#[test]
fn bonds_hold_up_to_their_strength_times_their_area() {
    for dimension in ["plane-strain", "3d"] {
        let third = if dimension == "3d" { ", 0" } else { "" };
        // a A / m in both.
        let strength = 10.0;
        let pulled = format!("[0, '10 m/s^3 * t'{third}]");
        let sheared = format!("['10 m/s^3 * t', -9.81{third}]");
        for (gravity, rule, breaks) in [
            (&pulled, "adhesion = '1 kPa'", strength / 10.0),
            (&sheared, "cohesion = '1 kPa'", strength / 10.0),
            (&sheared, "cohesion = '1 kPa', friction = 0.5", (strength + 0.5 * GRAVITY) / 10.0),
        ] {
            let mut simulation = start(&on_floor(dimension, [gravity, "2"], ["", block(dimension), rule]));
            let begun = simulation.bodies()[1].position;
            let mut last = 0.0;
            run_to(&mut *simulation, breaks + 0.3, |view| {
                if distance(view.bodies()[1].position, begun) < 1e-7 {
                    last = view.time();
                }
            });
            let way = distance(simulation.bodies()[1].position, begun);
            println!("{dimension}, {rule}: held until {last:.4} s of {breaks:.4}, then went {way:.4} m");
            assert!((last - breaks).abs() < 0.02, "{dimension}, {rule}: {last} {breaks}");
            assert!(way > 5e-3, "{dimension}, {rule}: {way}");
        }
        // Nothing holds a block that is pulled from a surface without adhesion.
        let mut simulation =
            start(&on_floor(dimension, [&pulled, "2"], ["", block(dimension), "cohesion = 1000"]));
        run_to(&mut *simulation, 0.3, |_| {});
        let speed = simulation.bodies()[1].velocity[1];
        assert!((speed / (5.0 * 0.09) - 1.0).abs() < 0.01, "{dimension}: {speed}");
    }
}

/// m dv/dt = m g - eta A v.
#[test]
fn a_block_slips_through_a_viscous_film() {
    for dimension in ["plane-strain", "3d"] {
        let third = if dimension == "3d" { ", 0" } else { "" };
        let gravity = format!("[2, -9.81{third}]");
        let rule = "viscosity = '200 Pa s/m'";
        let mut simulation = start(&on_floor(dimension, [&gravity, "1"], ["", block(dimension), rule]));
        run_to(&mut *simulation, 0.5, |_| {});
        let speed = simulation.bodies()[1].velocity[0];
        // eta A / m is 2 / s in both.
        let exact = 1.0 - (-1.0_f64).exp();
        println!("{dimension}: {speed:.6} m/s of {exact:.6}");
        assert!((speed / exact - 1.0).abs() < 1e-3, "{dimension}: {speed} {exact}");
    }
}

fn tower(count: usize) -> String {
    let box_of = |i: usize| {
        let y = 0.1 * i as f64;
        format!(
            "{{ name = 'box {i}', material = 'stone', rigid = {{ free = {{}} }},
                shape.box = {{ min = [-0.1, {y}], max = [0.1, {}] }} }},",
            y + 0.1
        )
    };
    let boxes: String = (0..count).map(box_of).collect();
    on_floor("plane-strain", ["[0, -9.81]", "2"], ["", &boxes, "friction = 0.5"])
}

/// Of ten boxes, each bears what is above it, and none moves.
#[test]
fn a_tower_carries_its_weight_and_stands() {
    let mut simulation = start(&tower(10));
    let begun = simulation.bodies();
    let mut before = Vec::new();
    run_to(&mut *simulation, 0.6, |view| {
        if view.time() < 0.3 {
            before = view.contact_sums();
        }
    });
    let (after, bodies) = (simulation.contact_sums(), simulation.bodies());
    let mut worst = 0.0_f64;
    for (i, (after, before)) in after.iter().zip(&before).enumerate() {
        assert_eq!(after.bodies, [i, i + 1]);
        let force = (after.normal - before.normal) / 0.3;
        let weight = (10 - i) as f64 * 20.0 * GRAVITY;
        worst = worst.max((force / weight - 1.0).abs());
    }
    let moved = bodies.iter().zip(&begun).map(|(a, b)| distance(a.position, b.position)).fold(0.0, f64::max);
    println!("weights within {worst:.1e}, places within {moved:.1e} m");
    assert!(worst < 5e-3 && moved < 1e-7, "{worst} {moved}");
    assert_eq!(simulation.ledger().unsettled_nodes, 0);
}

/// A wall of bricks in running bond, as many to a row, and a ball that flies into it.
fn wall(rows: usize, columns: usize) -> String {
    let mut bricks = String::new();
    for row in 0..rows {
        for column in 0..columns {
            let x = 0.2 * column as f64 + if row % 2 == 1 { 0.1 } else { 0.0 };
            let y = 0.1 * row as f64;
            bricks += &format!(
                "{{ name = 'brick {row} {column}', material = 'stone', rigid = {{ free = {{}} }},
                    shape.box = {{ min = [{x}, {y}], max = [{}, {}] }} }},",
                x + 0.2,
                y + 0.1
            );
        }
    }
    let half = 0.05 * rows as f64;
    let ball = format!(
        "{{ name = 'ball', material = 'stone', rigid = {{ free = {{}} }}, velocity = [6, 0],
            shape.ball = {{ center = [-0.2, {half}], radius = 0.1 }} }},"
    );
    let rule = "friction = 0.6, kinetic_friction = 0.4";
    on_floor("plane-strain", ["[0, -9.81]", "1"], ["", &(bricks + &ball), rule])
}

/// The same bits on one, two and five threads, with the workspace dropped, and from a saved state.
#[test]
fn a_wall_falls_alike_on_any_threads_and_after_any_pause() {
    let outcome = |threads: usize, take: fn(&mut dyn Simulation)| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| {
            let mut simulation = start(&wall(5, 4));
            take(&mut *simulation);
            format!("{:?} {:?}", simulation.bodies(), simulation.ledger())
        })
    };
    let plain = |simulation: &mut dyn Simulation| take_steps(simulation, 60);
    let one = outcome(1, plain);
    for threads in [2, 5] {
        assert!(outcome(threads, plain) == one, "{threads} threads differ from one");
    }
    let paused = |simulation: &mut dyn Simulation| {
        for step in 0..60 {
            if step % 17 == 3 {
                let saved = simulation.save().expect("the engine can be saved");
                take_steps(simulation, 3);
                simulation.restore(saved).expect("it is its own state");
            }
            if step % 13 == 5 {
                simulation.rebuild_workspace();
            }
            take_steps(simulation, 1);
        }
    };
    assert!(outcome(1, paused) == one, "a saved state takes other steps");
}

/// A block of 10 kg strikes a body of so little mass that this leaves with the block's speed, or with up to twice that.
#[test]
fn a_body_without_weight_to_speak_of_is_struck() {
    for mass in [1e-6, 1e-9] {
        let text = format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.02 }}
            time.end = 0.1
            materials.soft = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
            bodies = [
                {{ name = "a", material = "soft", velocity = [1, 0],
                   shape.box = {{ min = [0, 0], max = [0.1, 0.1] }} }},
                {{ name = "b", material = "soft", shape.box = {{ min = [0.11, 0], max = [0.2, 0.1] }},
                   rigid = {{ free = {{ mass = {mass} }} }} }},
            ]
            "#
        );
        let mut simulation = start(&text);
        run_to(&mut *simulation, 0.05, |_| {});
        let bodies = simulation.bodies();
        let [a, b] = [0, 1].map(|i| bodies[i].velocity[0]);
        println!(
            "{mass} kg: {a:.6} and {b:.6} m/s at {:.4}, {:.4} m",
            bodies[0].position[0], bodies[1].position[0]
        );
        assert!((a - 1.0).abs() < 1e-6 && (0.99..2.01).contains(&b), "{mass}: {a} {b}");
        assert!(bodies[1].position[0] - bodies[0].position[0] > 0.094, "it was entered: {bodies:?}");
    }
}
