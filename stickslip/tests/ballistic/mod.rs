//! Two bodies whose particles fly freely through gravity: a simulation in which every number is known.

use stickslip::door::{
    BodyState, ContactPatch, ContactSum, GridSnapshot, Ledger, ParticleSnapshot, Simulation, StepError, View,
};
use stickslip::geometry::{Arrangement, Shape};
use stickslip::material::LAWS;
use stickslip::scene::*;

const GRAVITY: f64 = 9.81;
/// Both bodies start at the origin with a velocity of 2 m/s along x; gravity pulls along -y.
pub struct Ballistic {
    time: f64,
    steps: u64,
    step: f64,
    last_step: f64,
    particles: [usize; 2],
    fails_at: Option<u64>,
    inverted: bool,
    trap: Option<(u64, Box<dyn FnMut() + Send>)>,
}

impl Ballistic {
    /// Four and three particles of one kilogram each, in steps of this length [s].
    pub fn new(step: f64) -> Self {
        Ballistic {
            time: 0.0,
            steps: 0,
            step,
            last_step: 0.0,
            particles: [4, 3],
            fails_at: None,
            inverted: false,
            trap: None,
        }
    }

    /// The same with these numbers of particles.
    pub fn with_particles(mut self, particles: [usize; 2]) -> Self {
        self.particles = particles;
        self
    }

    /// Does something before the step of this number, counted from zero.
    pub fn before_step(mut self, number: u64, trap: impl FnMut() + Send + 'static) -> Self {
        self.trap = Some((number, Box::new(trap)));
        self
    }

    /// Inverts a particle in the step of this number, and does not advance time then.
    pub fn failing_at(mut self, number: u64) -> Self {
        self.fails_at = Some(number);
        self
    }

    /// Length of the last step [s].
    pub fn last_step(&self) -> f64 {
        self.last_step
    }

    fn height(&self) -> f64 {
        -0.5 * GRAVITY * self.time * self.time
    }

    fn velocity(&self) -> [f64; 3] {
        [2.0, -GRAVITY * self.time, 0.0]
    }
}

impl View for Ballistic {
    fn time(&self) -> f64 {
        self.time
    }

    fn steps(&self) -> u64 {
        self.steps
    }

    fn particles(&self) -> usize {
        self.particles.iter().sum()
    }

    fn stable_step(&self) -> f64 {
        self.step
    }

    fn bodies(&self) -> Vec<BodyState> {
        let [vx, vy, _] = self.velocity();
        let body = |&particles: &usize| BodyState {
            mass: particles as f64,
            position: [vx * self.time, self.height(), 0.0],
            velocity: self.velocity(),
            spin: [0.0, 0.0, -1.0],
            angular_momentum: [0.0; 3],
            kinetic: 0.5 * particles as f64 * (vx * vx + vy * vy),
            strain: 0.0,
        };
        self.particles.iter().map(body).collect()
    }

    fn ledger(&self) -> Ledger {
        let mass = self.particles() as f64;
        let [vx, vy, _] = self.velocity();
        let kinetic = 0.5 * mass * (vx * vx + vy * vy);
        let potential = mass * GRAVITY * self.height();
        Ledger {
            kinetic,
            potential,
            total: kinetic + potential,
            momentum: self.velocity().map(|v| mass * v),
            ..Ledger::default()
        }
    }

    /// A constant force, and 0.75 J of friction in each step.
    fn contact_sums(&self) -> Vec<ContactSum> {
        let (time, steps) = (self.time, self.steps as f64);
        let sum = ContactSum {
            bodies: [0, 1],
            impulse: [1.0, 2.0, 2.0].map(|force| force * time),
            normal: 3.0 * time,
            tangential: [0.0; 3],
            magnitude: 3.0 * time,
            moment: [0.5, 0.0, 0.25].map(|x| 3.0 * time * x),
            turn: [0.0; 3],
            area: 0.125 * time,
            gap: -0.01 * 0.125 * time,
            slip: 0.02 * steps,
            friction: 0.75 * steps,
            nodes: 4,
            ..ContactSum::default()
        };
        if self.steps > 0 { vec![sum] } else { Vec::new() }
    }

    fn patches(&self) -> Vec<ContactPatch> {
        Vec::new()
    }

    fn snapshot(&self) -> ParticleSnapshot {
        let sign = if self.inverted { -1.0 } else { 1.0 };
        let mut snapshot = ParticleSnapshot { dimension: 3, ..Default::default() };
        for (body, &particles) in self.particles.iter().enumerate() {
            for number in 0..particles {
                snapshot.body.push(body as u32);
                snapshot.number.push(number as u32);
                snapshot.position.push([2.0 * self.time, self.height(), 0.1 * number as f64]);
                snapshot.velocity.push(self.velocity());
                snapshot.mass.push(1.0);
                snapshot.volume.push(0.001);
                snapshot.stress.push([-3.0, -3.0, -3.0, 1.0, 0.0, 0.0]);
                snapshot.deformation.push([sign, 0.1, 0.2, 0.3, 1.0, 0.4, 0.5, 0.6, 1.0]);
            }
        }
        snapshot
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        let mut snapshot = GridSnapshot { dimension: 3, cell: 0.1, ..Default::default() };
        if self.steps > 0 {
            for number in 0..5 {
                snapshot.body.push(number % 2);
                snapshot.position.push([0.1 * number as f64, self.height(), 0.0]);
                snapshot.mass.push(1.4);
                snapshot.velocity.push(self.velocity());
                snapshot.force.push([0.0, 1.0, 0.0]);
                snapshot.contact_impulse.push([0.0, 0.0, self.time]);
            }
        }
        snapshot
    }

    fn timings(&self) -> Vec<(&'static str, f64)> {
        vec![("fly", 0.75e-6 * self.steps as f64), ("land", 0.25e-6 * self.steps as f64)]
    }
}

impl Simulation for Ballistic {
    fn step(&mut self, longest: f64) -> Result<f64, StepError> {
        if let Some((number, trap)) = &mut self.trap
            && *number == self.steps
        {
            trap();
        }
        if self.fails_at == Some(self.steps) {
            self.inverted = true;
            return Err(StepError::Inverted {
                body: "sphere".into(),
                number: 0,
                position: [0.0; 3],
                time: self.time,
                determinant: -1.0,
            });
        }
        self.last_step = self.step.min(longest);
        self.time += self.last_step;
        self.steps += 1;
        Ok(self.last_step)
    }
}

/// The scene that [`Ballistic`] is the simulation of: one second, tables every 0.1 s, particles every 0.25 s,
/// grid every 0.5 s.
pub fn scene() -> Scene {
    let law = LAWS[0].build(&[("bulk_modulus", 6e6), ("shear_modulus", 3e6)].into()).unwrap();
    let body = |name: &str| Body {
        name: name.into(),
        material: 0,
        shape: Shape::Ball { center: [0.0; 3], radius: 1.0 },
        particles: Arrangement::Lattice,
        particles_per_side: None,
        interior: None,
        cell: None,
        motion: BodyMotion::Free { velocity: [2.0, 0.0, 0.0], spin: [0.0; 3] },
        stress: None,
        velocity_by_place: None,
    };
    Scene {
        title: "two bodies in flight".into(),
        about: "Every number is known.".into(),
        parameters: [("speed".to_string(), Parameter::Number(2.0))].into(),
        dimension: Dimension::Space,
        precision: Precision::Double,
        discretization: Discretization {
            cell: 0.1,
            particles_per_side: 2,
            basis: BasisKind::Gimp,
            interior: Default::default(),
            because: None,
        },
        domain: None,
        time: Time {
            end: 1.0,
            courant: 0.5,
            max_step: None,
            stress_update: StressUpdate::Last,
            transfer: Transfer::Flip,
            pic_share: 0.0,
            xpic_order: 2,
            relax: None,
            energy_drift: 0.1,
        },
        damping: Damping::default(),
        health: Health::default(),
        gravity: [0.0, -GRAVITY, 0.0].into(),
        materials: vec![NamedMaterial {
            name: "rubber".into(),
            density: 1000.0,
            law,
            volume_change: Default::default(),
            thermal_expansion: 0.0,
        }],
        bodies: vec![body("sphere"), body("plane")].into(),
        start: None,
        loads: Vec::new(),
        joints: Vec::new(),
        springs: Vec::new(),
        contact: vec![ContactRule { friction: f64::INFINITY, ..Default::default() }],
        outputs: Outputs {
            bodies: None,
            tables: 0.1,
            surfaces: None,
            surface_format: Default::default(),
            particles: Some(0.25),
            particles_at: Vec::new(),
            snapshots: SnapshotContent { precision: Precision::Double, ..Default::default() },
            grid: Some(0.5),
            fringes: None,
            checkpoints: None,
            measurements: Measurements::default(),
        },
        references: vec![Reference {
            body: "sphere".into(),
            quantity: "vx".into(),
            value: Expression::Constant(2.5),
            label: "a faster sphere".into(),
        }],
    }
}
