//! Several ranks give the bits of one.
//!
//! Set-up: soft bodies that fall on each other and on a rigid floor with friction, cut by a symmetry face, a third body
//! glued on, as in `threads.rs`, and a disk that flies and spins through nothing; in the plane and in space, by all
//! stress updates, bases and transfers, damped, relaxed, nearly incompressible and periodic; by one rank, and by two,
//! three and four that are threads of the test. Particles go from rank to rank, and bodies meet at borders.
//!
//! Expected: the same bits of all particles, of the sums that tables hold, and of time. No tolerance.

use crate::mixed::thrown;
use crate::reference_free::several;
use crate::reference_periodic::packing;
use crate::threads::{damped, periodic, scene as crowd};
use crate::trial::{STRESS_UPDATES, start, take_steps};
use rayon::ThreadPoolBuilder;
use std::sync::Arc;
use stickslip::door::{ContactCursor, Simulation};
use stickslip::lanes::Processor;
use stickslip::ranks::{Ranks, Threads};
use stickslip::step::ParticleLoop;
use stickslip::{scene, step};

/// Every column of every particle, by body and number, in bits.
type Rows = Vec<(u32, u32, Vec<u64>)>;

fn rows(simulation: &dyn Simulation) -> Rows {
    let snapshot = simulation.snapshot();
    let row = |i: usize| {
        let mut bits: Vec<u64> = Vec::new();
        for (column, values) in snapshot.columns() {
            let count = column.kind.components();
            bits.extend(values[i * count..][..count].iter().map(|x| x.to_bits()));
        }
        for column in &snapshot.history {
            let count = column.kind.components();
            bits.extend(column.values[i * count..][..count].iter().map(|x| x.to_bits()));
        }
        (snapshot.body[i], snapshot.number[i], bits)
    };
    (0..snapshot.body.len()).map(row).collect()
}

/// What it knows of contacts, by pair, in Rust's shortest text that gives the bits back.
fn contacts(simulation: &dyn Simulation) -> Vec<([usize; 2], String)> {
    let all = ContactCursor::default().read(simulation);
    all.iter().map(|contact| ([contact.body_a, contact.body_b], format!("{contact:?}"))).collect()
}

/// What everybody knows of the run, likewise, and what one process and the first rank know of bodies.
fn known(simulation: &dyn Simulation) -> [String; 2] {
    let (ledger, bodies) = (simulation.ledger(), simulation.bodies());
    let points = simulation.contact_points();
    let all = format!("{} {ledger:?} {:?} {points:?}", simulation.time(), simulation.relaxation());
    [all, format!("{bodies:?}")]
}

/// What each of so many ranks says, which have a thread each.
fn among<X: Send>(text: &str, count: usize, say: impl Fn(&mut dyn Simulation) -> X + Sync) -> Vec<X> {
    let loaded = scene::parse("trial.toml", text, &[]).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    let path = ParticleLoop::Lanes(Processor::best());
    std::thread::scope(|scope| {
        let ranks = Threads::start(count).into_iter().map(|ranks| {
            let (scene, say) = (&loaded.scene, &say);
            // A pool for each: who waits for another rank keeps a thread of its pool.
            scope.spawn(move || {
                let pool = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
                pool.install(|| {
                    let ranks: Arc<dyn Ranks> = Arc::new(ranks);
                    say(&mut *step::build_among(scene, path, ranks).expect("ranks can share it"))
                })
            })
        });
        let ranks: Vec<_> = ranks.collect();
        ranks.into_iter().map(|rank| rank.join().expect("a rank ends")).collect()
    })
}

/// Ranks have the bits of one process, after so many steps.
pub fn compare(name: &str, text: &str, steps: usize) {
    let mut alone = start(text);
    take_steps(&mut *alone, steps);
    let (wanted, known_alone, met) = (rows(&*alone), known(&*alone), contacts(&*alone));
    for count in 2..=4 {
        let said = among(text, count, |simulation| {
            take_steps(simulation, steps);
            (rows(simulation), known(simulation), contacts(simulation))
        });
        let shares: Vec<usize> = said.iter().map(|(rows, ..)| rows.len()).collect();
        assert!(shares.iter().all(|share| *share < wanted.len()), "{name}: {shares:?} particles");
        let mut together: Rows = said.iter().flat_map(|(rows, ..)| rows.clone()).collect();
        together.sort_unstable();
        assert_eq!(together.len(), wanted.len(), "{name}: {count} ranks have every particle once");
        let other = together.iter().zip(&wanted).find(|(one, other)| one != other);
        assert!(other.is_none(), "{name}: {count} ranks differ from one, {other:?}");
        let (_, [_, bodies], _) = &said[0];
        assert_eq!(bodies, &known_alone[1], "{name}: the first of {count} ranks knows other bodies than one");
        for (_, [known, _], _) in &said {
            assert_eq!(known, &known_alone[0], "{name}: {count} ranks know other sums than one");
        }
        let mut met_together: Vec<_> = said.into_iter().flat_map(|(.., contacts)| contacts).collect();
        met_together.sort_unstable();
        assert_eq!(met_together, met, "{name}: {count} ranks keep other sums of pairs than one");
    }
}

/// A disk that flies and spins, in a scene with nothing else.
const DISK: &str = r#"
    [space]
    dimension = "plane-strain"
    interior = "grid"
    cell = 0.1
    [time]
    end = 1
    [materials]
    rubber = { density = 1000, neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 } }
    [[bodies]]
    name = "disk"
    material = "rubber"
    shape.ball = { center = [0.52, 0.3], radius = 1.0 }
    velocity = [9, -7]
    spin = 5
"#;

/// It crosses the borders of all ranks.
#[test]
fn one_body() {
    compare("a disk", DISK, 100);
}

#[test]
fn in_the_plane() {
    for update in STRESS_UPDATES {
        compare(&format!("gimp, {update}"), &crowd("plane-strain", "gimp", update), 200);
    }
    let plane = crowd("plane-strain", "gimp", "modified-last");
    let with = |time: &str| plane.replace("end = 1\n", &format!("end = 1\n{time}\n"));
    let averaged = plane.replace("density = 2000,", "density = 2000, volume_change = \"averaged\",");
    assert!(averaged.contains("averaged"));
    compare("averaged", &averaged, 200);
    compare("apic", &with("transfer = \"apic\"").replace("\"gimp\"", "\"spline\""), 200);
    compare("cubic", &plane.replace("\"gimp\"", "\"cubic\""), 200);
    compare("xpic", &with("transfer = \"xpic\"\nxpic_order = 3"), 200);
    let damped = damped(&with("relax = { residual = 1e-6 }"));
    compare("damped and relaxed", &damped, 200);
    let periodic = periodic(&plane);
    compare("periodic", &periodic, 200);
    // A layer without ends that is sheared: some of its tiles are a period away from others at the same nodes.
    let layer = periodic
        .replace(
            "shape.ball = { center = [0.52, 0.3], radius = 0.3 }",
            "shape.box = { min = [0, 0.05], max = [1.2, 0.7] }",
        )
        .replace("max = [0.2, 0.4]", "max = [0.2, 0.04]")
        .replace("gravity = [1, -10]", "gravity = [20, -10]");
    let layer = layer
        .split("[[bodies]]")
        .filter(|body| !["block", "patch"].iter().any(|name| body.contains(&format!("name = \"{name}\""))));
    let layer = layer.collect::<Vec<_>>().join("[[bodies]]") + "\n[[contact]]\nfriction = 0.3\n";
    compare("a layer without ends", &layer, 300);
}

#[test]
fn by_all_contact_laws() {
    let plane = crowd("plane-strain", "gimp", "modified-last");
    for law in ["kinematic", "traction", "gap", "separation", "regression"] {
        compare(law, &plane.replace("friction = 0.3", &format!("friction = 0.3\nlaw = \"{law}\"")), 100);
    }
    let both = plane
        .replace("\"gimp\"", "\"linear\"")
        .replace("friction = 0.3", "friction = 0.3\nlaw = \"regression\"");
    compare("regression, linear", &both, 100);
}

#[test]
fn in_space() {
    compare("gimp, modified-last", &crowd("3d", "gimp", "modified-last"), 100);
    compare("linear, first", &crowd("3d", "linear", "first"), 60);
}

/// Bodies on grids of their own that touch through periodic faces.
#[test]
fn on_grids_of_their_own_between_periodic_faces() {
    compare("a packing", &packing(), 200);
}

/// Bodies that are pulled, pressed and held at every particle, or all around.
/// Bodies on grids of their own, with free rigid ones, a spring and a joint between them.
#[test]
fn on_grids_of_their_own_among_free_rigid_ones() {
    compare("in the plane", &several("plane-strain"), 60);
    compare("in space", &several("3d"), 20);
    compare("on both grids, in the plane", &thrown("plane-strain"), 60);
    compare("on both grids, in space", &thrown("3d"), 20);
}

#[test]
fn with_loads() {
    let loaded = |text: &str, along_z: &str| {
        let loads = format!(
            r#"
            [[loads]]
            body = "ball"
            acceleration = [3, -20{along_z}]
            [[loads]]
            body = "patch"
            pressure = 2000
            [[supports]]
            body = "block"
            on = "volume"
            stiffness = 1e5
            dashpot = 100
            "#
        );
        [text, &loads].concat()
    };
    let plane = loaded(&crowd("plane-strain", "gimp", "modified-last"), "");
    for basis in ["linear", "spline", "cubic"] {
        compare(&format!("loads, {basis}"), &plane.replace("\"gimp\"", &format!("\"{basis}\"")), 100);
    }
    compare("loads, first", &plane.replace("\"modified-last\"", "\"first\""), 100);
    compare("loads, periodic", &periodic(&plane), 200);
    compare("loads in space", &loaded(&crowd("3d", "gimp", "modified-last"), ", 5"), 60);
}

/// A particle that leaves the domain ends the run of all ranks, with one and the same error.
#[test]
fn a_fault_on_one_rank_ends_all() {
    let text = DISK.replace("cell = 0.1", "cell = 0.1\n domain = { min = [-3, -3], max = [2, 3] }");
    let alone = failed(&mut *start(&text));
    assert!(alone.contains("disk"), "{alone}");
    assert_eq!(among(&text, 3, failed), vec![alone; 3]);
}

/// What ends a run.
fn failed(simulation: &mut dyn Simulation) -> String {
    (0..10_000)
        .find_map(|_| simulation.step(f64::INFINITY).err())
        .expect("a body leaves the domain")
        .to_string()
}
