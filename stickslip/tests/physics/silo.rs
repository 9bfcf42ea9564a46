//! B26: walls bear what is between them as Janssen says; and a silo empties as Beverloo says, below.
//!
//! Source: Janssen (1895): between rough walls a distance W apart, at a depth z,
//! sigma_z = rho g W / (2 mu K) (1 - exp(-2 mu K z / W)), where friction is used up and the pressure on the walls is K
//! times that on the floor. K of an elastic filling that cannot spread is nu / (1 - nu) in plane strain.
//!
//! Set-up: half of an elastic filling of W x 4 W between a rough wall and a mirror, eight cells on W, nu = 0.4, mu = 0.3,
//! so soft that it settles by 1 % of its height. The floor sinks by 2 % of W, ever slower, so that the filling slips down
//! its wall everywhere. Means over the last quarter of the run.
//!
//! Expected: the floor's force, half of the weight, within 5 % of Janssen's, and the vertical stress at three depths
//! likewise. Janssen takes the stress for even across, which it is to the square of mu K = 0.2.

use crate::trial::{mean_where, run_to, start};
use stickslip::door::ContactCursor;

#[test]
fn walls_bear_half_of_what_is_in_a_silo() {
    let (end, height, gravity) = (120.0, 4.0, 1e-3);
    let mut simulation = start(&format!(
        r#"
        gravity = [0, -{gravity}]
        time.end = {end}
        damping.viscous = 0.1
        materials.fill = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.4 }} }}
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.125
        domain = {{ min = [0, -1], max = [2, 6], x_min = "symmetry" }}
        [[bodies]]
        name = "fill"
        material = "fill"
        shape.box = {{ min = [0, 0], max = [0.5, {height}] }}
        [[bodies]]
        name = "wall"
        material = "fill"
        shape.half_space = {{ point = [0.5, 0], normal = [-1, 0] }}
        rigid = {{}}
        [[bodies]]
        name = "floor"
        material = "fill"
        shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
        rigid.velocity = [0, "-0.04 / {end} * (1 - t / {end})"]
        [[contact]]
        between = ["fill", "wall"]
        friction = 0.3
        "#
    ));
    let length = 1.0 / (2.0 * 0.3 * 0.4 / 0.6);
    let pressure = |depth: f64| gravity * length * (1.0 - (-depth / length).exp());
    let mut cursor = ContactCursor::default();
    run_to(&mut *simulation, 0.75 * end, |_| {});
    cursor.read(&*simulation);
    let bands = [0.5, 1.5, 2.5];
    let (mut stresses, mut samples) = ([0.0; 3], 0.0);
    run_to(&mut *simulation, end, |simulation| {
        if simulation.steps() % 20 == 0 {
            let all = simulation.snapshot();
            for (stress, low) in stresses.iter_mut().zip(bands) {
                let inside = |p: usize| all.body[p] == 0 && (low..low + 0.25).contains(&all.position[p][1]);
                *stress += mean_where(&all, inside, |p| -all.stress[p][1]);
            }
            samples += 1.0;
        }
    });
    let contacts = cursor.read(&*simulation);
    let on = |body: usize| &contacts.iter().find(|contact| contact.body_b == body).expect("it touches").mean;
    let (wall, floor) = (on(1), on(2));
    let (borne, exact) = (floor.normal, 0.5 * pressure(height));
    let share = exact / (0.5 * height * gravity);
    println!(
        "floor {:.4} of Janssen's, which is {share:.3} of the weight; friction used {:.4}",
        borne / exact,
        wall.tangential / (0.3 * wall.normal)
    );
    assert!((borne / exact - 1.0).abs() < 0.05 && share < 0.55, "{borne} {exact}");
    for (stress, low) in stresses.iter().zip(bands) {
        let (found, exact) = (stress / samples, pressure(height - low - 0.125));
        println!("at {low} m above the floor: {:.4} of Janssen's", found / exact);
        assert!((found / exact - 1.0).abs() < 0.05, "{low}: {found} {exact}");
    }
}

/// Rate at which a silo of 352 rigid disks of diameters up to 1 and density 1 empties through an opening from t = 2.5
/// to `end` [kg/s per depth].
fn discharge(opening: f64, end: f64) -> f64 {
    let half = 0.5 * opening;
    let mut simulation = start(&format!(
        r#"
        gravity = [0, -1]
        space = {{ dimension = "plane-strain", interior = "grid", cell = 1 }}
        time = {{ end = {end}, max_step = 0.03 }}
        materials.stone = {{ density = 1, neo_hookean = {{ young_modulus = 1e3, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "walls"
        material = "stone"
        rigid = {{}}
        shape.union = [
            {{ box = {{ min = [-7, -1], max = [-{half}, 0] }} }},
            {{ box = {{ min = [{half}, -1], max = [7, 0] }} }},
            {{ box = {{ min = [-8, -1], max = [-6.9, 50] }} }},
            {{ box = {{ min = [6.9, -1], max = [8, 50] }} }},
        ]
        [[bodies]]
        name = "grain {{i}} {{j}}"
        repeat = {{ j = 32, i = 11 }}
        material = "stone"
        rigid.free = {{}}
        [bodies.shape.ball]
        center = ["(i - 5) * 1.05 + 0.02 * sin(7 * j + 3 * i)", "1 + j * 1.05"]
        radius = "0.45 + 0.01 * mod(7 * i + 5 * j + i * j, 11) / 2"
        [[contact]]
        friction = 0.5
        restitution = 0.3
        "#
    ));
    let mut gone = |time: f64| {
        run_to(&mut *simulation, time, |_| {});
        let below = simulation.bodies().into_iter().skip(1).filter(|body| body.position[1] < -0.5);
        below.map(|body| body.mass).sum::<f64>()
    };
    let begin = 2.5;
    let [before, after] = [begin, end].map(&mut gone);
    (after - before) / (end - begin)
}

/// A slot of width D lets W = 1.03 rho g^(1/2) (D - k d)^(3/2) pass, Beverloo, Leniger and van de Velde
/// (1961), for slots Nedderman (1992), k = 1.4; rho is the density of the packing, here 0.82.
///
/// Scatter of constants in the literature: k from 1 to 2, and 10 % of the factor, which at D = 5 d and 8 d are 30 % and
/// 20 % of W; 220 grains come in bursts, which add 10 %. With k from 1 to 2 the ratio of the two rates is 2.3 to 2.8,
/// and 2.02 if grains had no size; bursts make a tenth of it either way, a fifth at most.
#[test]
fn a_silo_empties_as_beverloo_says() {
    let rates = [(5.0, 32.0, 0.3), (8.0, 13.5, 0.25)].map(|(opening, end, scatter)| {
        let (found, exact) = (discharge(opening, end), 1.03 * 0.82 * (opening - 1.4_f64).powf(1.5));
        println!("opening {opening} d: {found:.3} kg/s, Beverloo {exact:.3} kg/s");
        assert!((found / exact - 1.0).abs() < scatter, "{opening}: {found} {exact}");
        found
    });
    let ratio = rates[1] / rates[0];
    println!("ratio {ratio:.3}, Beverloo {:.3}", (6.6_f64 / 3.6).powf(1.5));
    assert!(ratio > 2.1 && ratio < 3.4, "{ratio}");
}
