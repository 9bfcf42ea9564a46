//! A body from a mesh does what the same body does whose shape is known in closed form.
//!
//! Source: identity. Set-ups: a block set down on a slope and sliding, both from STL files, against the same two boxes;
//! a ball that rolls down a slab from an OBJ file, scaled, moved and turned, against the same slab;
//! a ball of 5120 triangles, filled. Rigid and free, mesh on mesh: the block slides down the slab, and a ball of 80
//! triangles strikes a cube with a corner, straight on and beside its middle.
//!
//! Expected: corners have few binary digits, so files say exactly what scenes say, and the motion is the same but for
//! round-off: 1e-9 of the way. The filled ball has the volume of its polyhedron, 0.4 % below the ball's,
//! within the stairs of its lattice: 1 %. A rigid block slides with the acceleration that friction leaves to 1e-4: it
//! is set down on five points of one of its faces, and rocks by as little; a rigid ball and a cube part with the
//! restitution of their rule to 1e-6 if they meet straight on, and keep momentum to round-off and angular momentum to
//! what a step moves where they touch.

use crate::trial::{RUBBER, distance, norm, run_to, start_in};
use std::fs;
use stickslip::door::Simulation;

type Triangles = Vec<[[f64; 3]; 3]>;

/// The triangles of a box.
fn cuboid(min: [f64; 3], max: [f64; 3]) -> Triangles {
    let at = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 1 { max[k] } else { min[k] });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|corners| corners.map(at))).collect()
}

/// The triangles of a unit ball: an icosahedron's, halved along each edge so many times.
fn icosphere(halvings: usize) -> Triangles {
    let unit = |a: [f64; 3]| {
        let length = distance(a, [0.0; 3]);
        a.map(|a| a / length)
    };
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]].map(unit));
    }
    // The edge of an icosahedron in a unit ball is 1.05; corners further apart than 1.1 share none.
    let near = |i: usize, j: usize| distance(corners[i], corners[j]) < 1.1;
    let mut triangles = Triangles::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let [a, b, c]: [[f64; 3]; 3] = [corners[i], corners[j], corners[k]];
                    let normal: [f64; 3] = std::array::from_fn(|n| {
                        let (p, q) = ((n + 1) % 3, (n + 2) % 3);
                        (b[p] - a[p]) * (c[q] - a[q]) - (b[q] - a[q]) * (c[p] - a[p])
                    });
                    let outward = (0..3).map(|n| normal[n] * a[n]).sum::<f64>() > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..halvings {
        let middle = |a: [f64; 3], b: [f64; 3]| unit(std::array::from_fn(|k| a[k] + b[k]));
        let parts = |[a, b, c]: [[f64; 3]; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(parts).collect();
    }
    triangles
}

/// STL with numbers.
fn binary(triangles: &Triangles) -> Vec<u8> {
    let mut bytes = b"solid but binary".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flatten().flat_map(|x| (*x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// STL with words.
fn text(triangles: &Triangles) -> Vec<u8> {
    let mut text = "solid block\n".to_string();
    for corners in triangles {
        text += "facet normal 0 0 0\n outer loop\n";
        corners.iter().for_each(|[x, y, z]| text += &format!("  vertex {x} {y} {z}\n"));
        text += " endloop\nendfacet\n";
    }
    (text + "endsolid block\n").into_bytes()
}

fn obj(triangles: &Triangles) -> Vec<u8> {
    let mut text = "# triangles\no body\n".to_string();
    triangles.iter().flatten().for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
    (0..triangles.len()).for_each(|i| text += &format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3));
    text.into_bytes()
}

/// Asserts that the second body moves alike in two scenes, and returns its masses.
fn alike(what: &str, simulations: [Box<dyn Simulation>; 2], end: f64) -> [f64; 2] {
    let runs = simulations.map(|mut simulation| {
        let first = simulation.bodies()[1].position;
        run_to(&mut *simulation, end, |_| {});
        (first, simulation.bodies()[1].clone())
    });
    let [(first, a), (_, b)] = &runs;
    let off = distance(a.position, b.position) / distance(a.position, *first);
    println!("{what}: off by {off:.1e} of the way {:.3} m", distance(a.position, *first));
    assert!(off < 1e-9, "{what}: {off:e}");
    runs.map(|(_, body)| body.mass)
}

#[test]
fn a_meshed_block_slides_on_a_meshed_slab_as_boxes_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let [slab, block] = [([-0.5, -0.5, -0.5], [2.0, 1.0, 0.0]), ([0.0, 0.0, 0.0], [0.5, 0.5, 0.25])];
    fs::write(folder.path().join("slab.stl"), binary(&cuboid(slab.0, slab.1))).expect("written");
    fs::write(folder.path().join("block.STL"), text(&cuboid(block.0, block.1))).expect("written");
    let scene = |slab: &str, block: &str| {
        let text = format!(
            r#"
            gravity = [5, 0, -8]
            space = {{ dimension = "3d", interior = "grid", cell = 0.125 }}
            time.end = 1
            {RUBBER}
            [[bodies]]
            name = "slab"
            material = "rubber"
            shape = {slab}
            rigid = {{}}
            [[bodies]]
            name = "block"
            material = "rubber"
            shape = {block}
            [[contact]]
            friction = 0.2
            "#
        );
        start_in(folder.path(), &text)
    };
    let cuboid = |(min, max): ([f64; 3], [f64; 3])| format!("{{ box = {{ min = {min:?}, max = {max:?} }} }}");
    let boxes = scene(&cuboid(slab), &cuboid(block));
    let meshes = scene("{ mesh.file = \"slab.stl\" }", "{ mesh.file = \"block.STL\" }");
    let [exact, meshed] = alike("block", [boxes, meshes], 0.25);
    assert_eq!(exact, meshed);
}

#[test]
fn a_ball_rolls_on_a_turned_and_scaled_slab_as_on_a_box() {
    let folder = tempfile::tempdir().expect("a folder");
    let slab = cuboid([-500.0, -500.0, 0.0], [1500.0, 500.0, 500.0]);
    fs::write(folder.path().join("slab.obj"), obj(&slab)).expect("written");
    let scene = |slab: &str| {
        let text = format!(
            r#"
            gravity = [0, 0, -8]
            space = {{ dimension = "3d", interior = "grid", cell = 0.125 }}
            time.end = 1
            {RUBBER}
            [[bodies]]
            name = "slab"
            material = "rubber"
            shape.rotated = {{ angle = "0.4 rad", axis = [0, 1, 0], center = [0, 0, 0], shape = {slab} }}
            rigid = {{}}
            [[bodies]]
            name = "ball"
            material = "rubber"
            shape.ball = {{ center = ["0.25 * sin(0.4)", 0, "0.25 * cos(0.4)"], radius = 0.25 }}
            [[contact]]
            friction = 0.5
            "#
        );
        start_in(folder.path(), &text)
    };
    let exact = scene("{ box = { min = [-0.5, -0.5, -0.5], max = [1.5, 0.5, 0] } }");
    let meshed = scene("{ mesh = { file = \"slab.obj\", scale = \"1 mm\", translation = [0, 0, -0.5] } }");
    alike("ball", [exact, meshed], 0.3);
}

#[test]
fn a_rigid_block_slides_mesh_on_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    let [slab, block] = [([-0.5, -0.5, -0.5], [2.0, 1.0, 0.0]), ([0.0, 0.0, 0.0], [0.5, 0.5, 0.25])];
    fs::write(folder.path().join("slab.stl"), binary(&cuboid(slab.0, slab.1))).expect("written");
    fs::write(folder.path().join("block.stl"), binary(&cuboid(block.0, block.1))).expect("written");
    let text = format!(
        r#"
        gravity = [5, 0, -8]
        space = {{ dimension = "3d", interior = "grid", cell = 0.125 }}
        time = {{ end = 1, max_step = 1e-3 }}
        {RUBBER}
        contact = [{{ friction = 0.2 }}]
        [[bodies]]
        name = "slab"
        material = "rubber"
        shape.mesh.file = "slab.stl"
        rigid = {{}}
        [[bodies]]
        name = "block"
        material = "rubber"
        shape.mesh.file = "block.stl"
        rigid.free = {{}}
        "#
    );
    let mut simulation = start_in(folder.path(), &text);
    run_to(&mut *simulation, 0.5, |_| {});
    let block = simulation.bodies()[1].clone();
    let off = block.velocity[0] / (0.5 * (5.0 - 0.2 * 8.0)) - 1.0;
    println!("rigid block: speed off by {off:.1e}, at {:?}, turning with {:?}", block.position, block.spin);
    assert!(off.abs() < 1e-4 && norm(block.spin) < 1e-4, "{block:?}");
    assert!((block.position[2] - 0.125).abs() < 1e-7, "{block:?}");
}

#[test]
fn rigid_meshes_strike_each_other() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("ball.stl"), binary(&icosphere(1))).expect("written");
    fs::write(folder.path().join("cube.stl"), binary(&cuboid([0.0; 3], [0.5; 3]))).expect("written");
    for (restitution, beside) in [(0.0, 0.0), (0.6, 0.0), (1.0, 0.0), (0.6, 0.125), (1.0, 0.125)] {
        let text = format!(
            r#"
            space = {{ dimension = "3d", interior = "grid", cell = 0.125 }}
            time = {{ end = 1, max_step = 1e-3 }}
            {RUBBER}
            contact = [{{ friction = 0, restitution = {restitution} }}]
            [[bodies]]
            name = "ball"
            material = "rubber"
            shape.mesh = {{ file = "ball.stl", scale = 0.25, translation = [0, {beside}, 0] }}
            velocity = [2, 0, 0]
            rigid.free = {{}}
            [[bodies]]
            name = "cube"
            material = "rubber"
            shape.mesh = {{ file = "cube.stl", translation = [0.5, -0.25, -0.25] }}
            velocity = [-1, 0, 0]
            rigid.free = {{}}
            "#
        );
        let mut simulation = start_in(folder.path(), &text);
        let before = simulation.ledger();
        run_to(&mut *simulation, 0.3, |_| {});
        let (after, bodies) = (simulation.ledger(), simulation.bodies());
        let parted = (bodies[1].velocity[0] - bodies[0].velocity[0]) / 3.0;
        let scale = norm(before.momentum);
        let lost = distance(before.momentum, after.momentum) / scale;
        let turned = distance(before.angular_momentum, after.angular_momentum) / scale;
        let kept = after.kinetic / before.kinetic;
        println!(
            "e = {restitution}, {beside} m beside: parted with {parted:.8}, momentum {lost:.1e}, angular {turned:.1e}, energy {kept:.8}"
        );
        assert!(lost < 1e-12 && turned < 1e-3, "{lost:e} {turned:e}");
        if beside == 0.0 {
            assert!((parted - restitution).abs() < 1e-6, "{parted} of {restitution}");
        } else {
            assert!(norm(bodies[1].spin) > 0.1, "the cube turns: {:?}", bodies[1]);
        }
        if restitution == 1.0 {
            assert!((kept - 1.0).abs() < 1e-3, "{kept}");
        }
    }
}

#[test]
fn a_ball_of_triangles_has_its_mass() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("ball.stl"), binary(&icosphere(4))).expect("written");
    for (cell, allowed) in [(0.1, 0.03), (0.05, 0.01)] {
        let text = format!(
            r#"
            space = {{ dimension = "3d", interior = "grid", cell = {cell} }}
            time.end = 1
            {RUBBER}
            [[bodies]]
            name = "ball"
            material = "rubber"
            shape.mesh = {{ file = "ball.stl", scale = 0.5 }}
            "#
        );
        let mass = start_in(folder.path(), &text).bodies()[0].mass;
        let short = mass / (1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125) - 1.0;
        println!("ball of triangles, cells of {cell}: mass off by {short:.4}");
        assert!(short.abs() < allowed, "{cell}: {short}");
    }
}
