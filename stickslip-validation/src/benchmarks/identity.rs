//! Identity: a body cut in two and glued is the body.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target, Tier};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;
use stickslip::door::ParticleSnapshot;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "identity",
    title: "Glued parts equal the whole",
    source: "Identity: with one velocity for all bodies at each node the grid sums the same particles",
    picture: "
             __________           __________
            |         |          |    /    |
            |  whole  |    =     |   / glued
            |_________|          |__/______|
",
    set_up: "Plane strain; a block of soft rubber 0.8 m x 0.6 m (E = 0.1 MPa, nu = 0.3), flying at (2, -1) m/s onto \
a rigid floor 0.1 m below that glues it; once whole, and cut along the grid, at 30 and at 70 degrees to it; in the \
full tier also in space, 0.4 m thick, along a plane oblique to all axes. 0.3 s.",
    exact: "The same motion of every particle. Measured are the largest differences of position over 1 m and of \
velocity over 3 m/s.",
    laws: Laws::Glued,
    measure: "1 m/h",
    resolutions: &[Resolution::quick(10.0), Resolution::full(20.0)],
    targets: &[
        Target::new(
            "difference of position",
            0.0,
            Allowed::Within(1e-9),
            "round-off of some hundred steps, summed in another order",
        ),
        Target::new(
            "difference of velocity",
            0.0,
            Allowed::Within(1e-9),
            "round-off of some hundred steps, summed in another order",
        ),
    ],
    reasons: &[],
    run,
};

/// Normals of the cuts, in the plane and in space.
const CUTS: [(&str, &[[f64; 3]]); 2] = [
    ("plane-strain", &[[-1.0, 0.0, 0.0], [-0.5, 0.866, 0.0], [-0.94, 0.342, 0.0]]),
    ("3d", &[[1.0, 0.5, -0.7]]),
];

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    let (mut place, mut speed) = (0.0_f64, 0.0_f64);
    for (dimension, cuts) in &CUTS[..if case.tier == Tier::Full { 2 } else { 1 }] {
        let whole = drop(case, dimension, None, &mut outcome)?;
        for &cut in *cuts {
            let parts = drop(case, dimension, Some(cut), &mut outcome)?;
            if parts.len() != whole.len() {
                return Err(CaseFailure::Absent("the parts have not the particles of the whole"));
            }
            for (part, whole) in parts.iter().zip(&whole) {
                for i in 0..3 {
                    place = place.max((part.position[i] - whole.position[i]).abs());
                    speed = speed.max((part.velocity[i] - whole.velocity[i]).abs() / 3.0);
                }
            }
        }
    }
    outcome.measure("difference of position", place);
    outcome.measure("difference of velocity", speed);
    Ok(outcome)
}

struct BlockParticle {
    start: [i64; 3],
    position: [f64; 3],
    velocity: [f64; 3],
}

/// The block's particles at the end in the order of their places at the start; cut through its centre across a normal,
/// or whole.
fn drop(
    case: &Case,
    dimension: &str,
    cut: Option<[f64; 3]>,
    outcome: &mut Outcome,
) -> Result<Vec<BlockParticle>, CaseFailure> {
    let h = 1.0 / case.cells;
    // Vectors of the scene have as many components as it has dimensions.
    let vector = |x: [f64; 3]| if dimension == "3d" { format!("{x:?}") } else { format!("{:?}", &x[..2]) };
    let (velocity, gravity) = (vector([2.0, -1.0, 0.0]), vector([0.0, -10.0, 0.0]));
    let body = |name: &str, shape: &str| {
        format!("[[bodies]]\nname = \"{name}\"\nmaterial = \"rubber\"\n{shape}\nvelocity = {velocity}\n")
    };
    let block = format!("{{ box = {{ min = {}, max = {} }} }}", vector([0.0; 3]), vector([0.8, 0.6, 0.4]));
    let bodies = match cut {
        None => body("whole", &format!("shape.union = [{block}, {block}]")),
        Some(normal) => {
            let part = |name: &str, normal: [f64; 3]| {
                let point = vector([0.4, 0.3, 0.2]);
                let half = format!("{{ half_space = {{ point = {point}, normal = {} }} }}", vector(normal));
                body(name, &format!("shape.intersection = [{block}, {half}]"))
            };
            part("first", normal) + &part("second", normal.map(|x| -x))
        }
    };
    let mut trial = Trial::start(
        format!("{dimension}_{}", cut.map_or("whole".to_owned(), |[x, y, z]| format!("cut_{x}_{y}_{z}"))),
        format!(
            r#"title = "Glued parts equal the whole"
gravity = {gravity}
space = {{ dimension = "{dimension}", interior = "grid", cell = {h} }}
time.end = 0.3
materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
{bodies}
[[bodies]]
name = "floor"
material = "rubber"
shape.box = {{ min = {}, max = {} }}
rigid = {{}}
{}"#,
            vector([-0.5, -0.4, -0.5]),
            vector([2.5, -0.1, 0.9]),
            case.contact(0.0)
        ),
    )?;
    let start = trial.snapshot();
    while trial.advance()? {}
    let particles = arranged(&trial.snapshot(), &start);
    outcome.include(trial);
    Ok(particles)
}

/// Deformable particles in the order of their places at the start, which the parts share with the whole.
fn arranged(end: &ParticleSnapshot, start: &ParticleSnapshot) -> Vec<BlockParticle> {
    let mut particles: Vec<BlockParticle> = (0..end.body.len())
        .filter(|&p| start.position[p][1] > -0.05)
        .map(|p| BlockParticle {
            start: [0, 1, 2].map(|i| (start.position[p][i] * 1e6).round() as i64),
            position: end.position[p],
            velocity: end.velocity[p],
        })
        .collect();
    particles.sort_by_key(|particle| particle.start);
    particles
}
