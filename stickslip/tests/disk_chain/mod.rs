//! The paper's scenes with disks, run for some transits of a longitudinal wave through a disk.

use std::path::Path;
use stickslip::door::{ContactCursor, ParticleSnapshot, Simulation};
use stickslip::march::March;
use stickslip::scene::{self, Scene};
use stickslip::step;

/// What happened to the disks.
#[derive(Debug)]
pub struct Chain {
    /// Momentum of the disks less the impulses of the striker and the frame, over the largest of these [-].
    pub momentum: f64,
    /// Energy of the disks less the striker's work, over that work [-].
    pub energy: f64,
    /// When the stress difference at the centre of each disk, from the striker on,
    /// first is above 0.3 rho c_L V [transits].
    pub arrivals: Vec<Option<f64>>,
    /// When each disk's centre of mass first is faster than 0.05 V [transits].
    pub starts: Vec<Option<f64>>,
    /// When two bodies, by name, first press on each other with 0.2 rho c_L V R [transits].
    loaded: Vec<([String; 2], f64)>,
}

/// Stress difference that counts as arrived [rho c_L V]: that of the reference with sharp contact.
const THRESHOLD: f64 = 0.3;

/// Speed of a disk that counts as moving [V].
const MOVING: f64 = 0.05;

/// Push that counts as load [rho c_L V R].
const LOAD: f64 = 0.2;

/// Transits between looks at the centres.
const LOOK: f64 = 0.01;

/// When a run ends: a time [transits], or when it has shown enough.
type Until = (f64, fn(&Chain) -> bool);

/// Numbers that a scene of disks names.
struct Setting {
    transit: f64,
    cell: f64,
    /// Stress difference that counts as arrived [Pa].
    threshold: f64,
    /// Speed that counts as moving [m/s].
    moving: f64,
    /// Push that counts as load [N/m].
    load: f64,
    /// Names of all bodies.
    names: Vec<String>,
    /// Bodies of the disks with their first centres, in the plane.
    disks: Vec<(usize, [f64; 2])>,
}

impl Chain {
    /// Runs a scene with overrides, written as `stickslip run --set` takes them, to a time [transits].
    pub fn run(name: &str, overrides: &[(&str, &str)], transits: f64) -> Chain {
        Chain::stopped(name, overrides, (transits, |_| false))
    }

    /// Runs a scene until the wave has arrived at every disk, at most to a time [transits].
    pub fn until_arrival(name: &str, overrides: &[(&str, &str)], transits: f64) -> Chain {
        Chain::stopped(name, overrides, (transits, |chain| chain.arrivals.iter().all(Option::is_some)))
    }

    /// Runs a scene until every disk moves, at most to a time [transits].
    pub fn until_start(name: &str, overrides: &[(&str, &str)], transits: f64) -> Chain {
        Chain::stopped(name, overrides, (transits, |chain| chain.starts.iter().all(Option::is_some)))
    }

    fn stopped(name: &str, overrides: &[(&str, &str)], until: Until) -> Chain {
        let scene = load(name, overrides);
        let chain = Chain::of(&scene, until);
        println!(
            "{name} {overrides:?}: energy {:+.4}, momentum {:.1e}, arrivals {:.3?}, starts {:.3?}",
            chain.energy, chain.momentum, chain.arrivals, chain.starts
        );
        chain
    }

    fn of(scene: &Scene, (transits, enough): Until) -> Chain {
        let mut simulation = step::build(scene).unwrap_or_else(|error| panic!("{error:?}"));
        let setting = Setting::of(scene, &*simulation);
        let end = transits * setting.transit;
        let disks = setting.disks.len();
        let mut chain = Chain {
            momentum: 0.0,
            energy: 0.0,
            arrivals: vec![None; disks],
            starts: vec![None; disks],
            loaded: Vec::new(),
        };
        let (mut impulse, mut pushed) = ([0.0; 2], 0.0_f64);
        let (mut stresses, mut speeds) = (First::new(disks), First::new(disks));
        let mut cursor = ContactCursor::default();
        let mut way = March::to(end);
        while !enough(&chain)
            && let Some(dt) = way.step(&mut *simulation).unwrap_or_else(|error| panic!("{error}"))
        {
            for contact in cursor.read(&*simulation) {
                let pair = [contact.body_a, contact.body_b].map(|body| setting.names[body].clone());
                if contact.mean.normal >= setting.load && chain.loaded.iter().all(|(other, _)| *other != pair)
                {
                    chain.loaded.push((pair, simulation.time() / setting.transit));
                }
                let deformable = [contact.body_a, contact.body_b].map(|body| setting.is_disk(body));
                if deformable[0] != deformable[1] {
                    let sign = if deformable[0] { -dt } else { dt };
                    (0..2).for_each(|i| impulse[i] += sign * contact.mean.force[i]);
                    pushed = pushed.max(impulse[0].abs());
                }
            }
            let now = simulation.time() / setting.transit;
            if now - stresses.time >= LOOK {
                stresses.look(now, setting.differences(&simulation.snapshot()), setting.threshold);
                speeds.look(now, setting.speeds(&*simulation), setting.moving);
                (chain.arrivals, chain.starts) = (stresses.found.clone(), speeds.found.clone());
            }
        }
        let ledger = simulation.ledger();
        let missing = (0..2).map(|i| (ledger.momentum[i] - impulse[i]).abs()).fold(0.0, f64::max);
        (chain.momentum, chain.energy) = (missing / pushed, ledger.total / ledger.external_work);
        chain
    }

    /// Arrival at a disk, counted from the striker and from 1 [transits].
    pub fn arrival(&self, disk: usize) -> f64 {
        self.arrivals[disk - 1].unwrap_or_else(|| panic!("nothing arrived at disk {disk}: {self:?}"))
    }

    /// When a disk starts, counted from the striker and from 1 [transits].
    pub fn start(&self, disk: usize) -> f64 {
        self.starts[disk - 1].unwrap_or_else(|| panic!("disk {disk} did not move: {self:?}"))
    }

    /// When a body and one of some others first press on each other; infinity if they do not [transits].
    pub fn load(&self, body: &str, others: &[&str]) -> f64 {
        let meets = |[a, b]: &[String; 2]| {
            (a == body && others.contains(&b.as_str())) || (b == body && others.contains(&a.as_str()))
        };
        self.loaded
            .iter()
            .filter(|(pair, _)| meets(pair))
            .map(|(_, time)| *time)
            .fold(f64::INFINITY, f64::min)
    }

    /// Mean time from centre to centre, from the second disk on [transits].
    pub fn interval(&self) -> f64 {
        let last = self.arrivals.len();
        (self.arrival(last) - self.arrival(2)) / (last - 2) as f64
    }
}

/// When each of some values first is above a threshold.
struct First {
    found: Vec<Option<f64>>,
    time: f64,
    values: Vec<f64>,
}

impl First {
    fn new(count: usize) -> Self {
        First { found: vec![None; count], time: 0.0, values: vec![0.0; count] }
    }

    fn look(&mut self, now: f64, values: Vec<f64>, threshold: f64) {
        for ((found, before), after) in self.found.iter_mut().zip(&self.values).zip(&values) {
            if found.is_none() && *after >= threshold {
                let share = (threshold - before) / (after - before);
                *found = Some(self.time + share * (now - self.time));
            }
        }
        (self.time, self.values) = (now, values);
    }
}

impl Setting {
    fn of(scene: &Scene, simulation: &dyn Simulation) -> Setting {
        let number =
            |name: &str| scene.parameters[name].number().unwrap_or_else(|| panic!("{name} is a number"));
        let disks = (scene.bodies.iter().zip(simulation.bodies()).enumerate())
            .filter(|(_, (body, _))| body.name.starts_with("disk"))
            .map(|(i, (_, state))| (i, [state.position[0], state.position[1]]));
        Setting {
            transit: number("transit"),
            cell: number("cell"),
            moving: MOVING * number("speed"),
            load: LOAD * number("density") * number("c_L") * number("speed") * number("radius"),
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            threshold: THRESHOLD * number("density") * number("c_L") * number("speed"),
            disks: disks.collect(),
        }
    }

    fn is_disk(&self, body: usize) -> bool {
        self.disks.iter().any(|&(disk, _)| disk == body)
    }

    /// Speed of each disk's centre of mass [m/s].
    fn speeds(&self, simulation: &dyn Simulation) -> Vec<f64> {
        let bodies = simulation.bodies();
        self.disks.iter().map(|&(disk, _)| bodies[disk].velocity[0].hypot(bodies[disk].velocity[1])).collect()
    }

    /// sigma_1 - sigma_2 of the mean stress within a cell and a half of each disk's centre [Pa].
    fn differences(&self, snapshot: &ParticleSnapshot) -> Vec<f64> {
        let mut sums = vec![[0.0; 4]; self.disks.len()];
        for (p, x) in snapshot.position.iter().enumerate() {
            let Some(i) = self.disks.iter().position(|&(disk, _)| disk == snapshot.body[p] as usize) else {
                continue;
            };
            let center = self.disks[i].1;
            if (x[0] - center[0]).hypot(x[1] - center[1]) < 1.5 * self.cell {
                let s = snapshot.stress[p];
                for (sum, value) in sums[i].iter_mut().zip([s[0], s[1], s[3], 1.0]) {
                    *sum += value;
                }
            }
        }
        sums.iter().map(|[xx, yy, xy, n]| (xx - yy).hypot(2.0 * xy) / n).collect()
    }
}

fn load(name: &str, overrides: &[(&str, &str)]) -> Scene {
    let path =
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/paper")).join(format!("disks_{name}.toml"));
    let overrides: Vec<_> =
        overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    scene::load(&path, &overrides).unwrap_or_else(|error| panic!("{error}")).scene
}
