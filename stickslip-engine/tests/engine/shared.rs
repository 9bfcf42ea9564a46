//! Ranks show the bytes that one has.

use std::collections::BTreeMap;
use stickslip_engine::door::{SavedBody, Simulation};
use stickslip_engine::ranks::{Ranks, Threads};
use stickslip_engine::scene::parse;
use stickslip_engine::shared::{BYTES_OF_AT_A_TIME, Program, among_threads, visit_found};
use stickslip_engine::step;

/// Two bodies that find room together, a large one, and one without particles.
const SCENE: &str = r#"
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.0044
[time]
end = 1
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 }
[[bodies]]
name = "ball {i}"
repeat = { i = 2 }
material = "rubber"
shape.ball = { center = ["i", 0.5], radius = 0.3 }
[[bodies]]
name = "block"
material = "rubber"
shape.box = { min = [0, 1], max = [2, 2] }
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = { point = [0, -9], normal = [0, 1] }
rigid = {}
"#;

const PROGRAM: Program = Program { act: |_, _, _| Vec::new(), find: |_, _, _| Ok(()) };

#[test]
fn ranks_show_the_bytes_that_one_has() {
    let scene = parse("scene.toml", SCENE, &[]).unwrap().scene;
    let shown = |simulation: &dyn Simulation| {
        let mut all: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
        let mut look = |body, bytes: &[u8]| all.entry(body).or_default().extend(bytes);
        assert!(simulation.visit_bytes(0..scene.bodies.len(), &mut look));
        all
    };
    let one = step::build(&scene).unwrap();
    assert!(one.particles() > 3 * BYTES_OF_AT_A_TIME);
    let one = shown(&*one);
    for count in [2, 3] {
        let several = among_threads(&scene, (count, PROGRAM), |first| shown(&*first.unwrap()));
        assert!(one == several, "{count} ranks");
    }
}

/// Particles of a state that ranks have found, whichever each: of the large body the last rank has none.
#[test]
fn ranks_show_the_bytes_of_what_they_found() {
    let scene = parse("scene.toml", SCENE, &[]).unwrap().scene;
    let one = step::build(&scene).unwrap();
    let mut expected: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
    let mut look = |body, bytes: &[u8]| expected.entry(body).or_default().extend(bytes);
    one.visit_bytes(0..scene.bodies.len(), &mut look);
    let state = one.save().unwrap();
    for count in [1, 2, 3] {
        let part = |rank: usize| {
            let of_body = |body: &SavedBody| {
                let all = body.numbers.len();
                let parts = if all > BYTES_OF_AT_A_TIME { (count - 1).max(1) } else { count };
                let end = |rank: usize| rank.min(parts) * all / parts;
                let mut own = state.without_particles().bodies.remove(0);
                let share = body.share(0, end(rank)..end(rank + 1));
                if all == 0 {
                    own.columns = share.columns;
                } else if !share.numbers.is_empty() {
                    assert!(own.fill(vec![share]));
                }
                own
            };
            state.bodies.iter().map(of_body).collect::<Vec<_>>()
        };
        let shown = |ranks: &Threads| {
            let mut all: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
            let mut look = |body, bytes: &[u8]| all.entry(body).or_default().extend(bytes);
            visit_found(ranks, &mut part(ranks.rank()), &mut look);
            all
        };
        let shown = &shown;
        let all: Vec<_> = std::thread::scope(|scope| {
            let ranks = Threads::start(count).into_iter();
            let all: Vec<_> = ranks.map(|ranks| scope.spawn(move || shown(&ranks))).collect();
            all.into_iter().map(|one| one.join().unwrap()).collect()
        });
        assert!(all[0] == expected, "{count} ranks");
    }
}
