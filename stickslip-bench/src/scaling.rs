//! What a step would take on many machines: a model of its time, fitted to problem P7.
//!
//! ```text
//! T = i (a n + e H) + b N + H / B + L (9 + 6 d),     d = log2 r, rounded up
//! ```
//! r: ranks, n: particles of a rank, N: bodies of the scene, H: bytes that a rank sends, by [`halo`] times what contact
//! adds; a, e, b: times that computing takes for a particle, a byte sent and a body that is elsewhere; i:
//! imbalance; B, L: bandwidth and latency of the network. A step has three exchanges of messages whose number nobody
//! knows before, each with an answer and a barrier (2 + d latencies), three that both sides expect (windows twice, and
//! guests), what the first rank asks for (d) and a sum over all (2 d). What is under way while the interior is done
//! counts in full, so the model is not too good. What it leaves out: output, and the moments in which the grid is
//! shared out anew.

use crate::on_ranks::WeakScaling;
use serde::Serialize;
use stickslip::surface::body_color;
use stickslip_cli::bench::{BenchScheme, Chart, Curve, PARTICLES_PER_CELL, Panel};

/// A network between machines.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Network {
    /// What it is called.
    pub name: &'static str,
    /// From one process to another [s].
    pub latency: f64,
    /// Of each process, with its share of what the machine has [bytes/s].
    pub bandwidth: f64,
}

/// InfiniBand HDR: 200 Gbit/s a machine, for 16 ranks.
pub const CLUSTER: Network =
    Network { name: "InfiniBand HDR, 16 ranks a machine", latency: 1.5e-6, bandwidth: 25e9 / 16.0 };

/// None at all.
const WITHIN_A_PROCESS: Network = Network { name: "none", latency: 0.0, bandwidth: f64::INFINITY };

/// The model of a step of one problem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepModel {
    /// The problem, in a few words.
    pub problem: String,
    /// a: computing for a particle [s].
    pub particle: f64,
    /// e: computing for a byte that is sent [s].
    pub byte: f64,
    /// b: computing for a body that is elsewhere [s].
    pub body: f64,
    /// i: the slowest rank's computing over the mean.
    pub imbalance: f64,
    /// Bytes that are sent over those of the halo alone.
    pub with_contact: f64,
    /// Bodies that take part, over particles.
    pub bodies: f64,
    #[serde(skip)]
    scheme: BenchScheme,
}

/// What a step takes, by what takes it [s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepTime {
    pub computing: f64,
    pub borders: f64,
    pub bodies: f64,
    pub sending: f64,
    pub waiting: f64,
}

/// One of these times.
type PartOfStep = fn(&StepTime) -> f64;

impl StepTime {
    pub fn sum(&self) -> f64 {
        self.computing + self.borders + self.bodies + self.sending + self.waiting
    }
}

impl StepModel {
    /// Fits the model to a problem that grows with the ranks, as each with a core has it, and of which so many
    /// particles make a body; a body elsewhere takes `body` [s].
    ///
    /// What ranks compute beyond their particles and bodies elsewhere is put down to the bytes that they send, by least
    /// squares. A particle takes what it does for single ranks, side by side, that each have all of the problem.
    pub fn fit(grown: &[WeakScaling], scheme: BenchScheme, (bodies, body): (f64, f64)) -> Option<Self> {
        let last = grown.last()?;
        let borders = |grown: &WeakScaling| {
            let of_particles = grown.particle * grown.particles as f64 / grown.ranks as f64;
            let beyond = grown.computed - of_particles - body * bodies * grown.particles as f64;
            [beyond * grown.bytes, grown.bytes * grown.bytes]
        };
        let [beyond, bytes] = grown.iter().map(borders).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        let with_contact = grown.iter().map(|grown| grown.bytes / grown.modelled).sum::<f64>();
        Some(StepModel {
            problem: last.problem.clone(),
            particle: last.particle,
            byte: (beyond / bytes.max(f64::MIN_POSITIVE)).max(0.0),
            body,
            imbalance: grown.iter().map(|grown| grown.imbalance).fold(1.0, f64::max),
            with_contact: with_contact / grown.len() as f64,
            bodies,
            scheme,
        })
    }

    /// A step of so many ranks, with so many particles each.
    pub fn step(&self, ranks: f64, particles: f64, network: Network) -> StepTime {
        let sent = if ranks > 1.0 {
            self.with_contact * halo(self.scheme, ((particles * ranks) as usize, ranks as usize))
        } else {
            0.0
        };
        let deep = ranks.log2().ceil();
        StepTime {
            computing: self.imbalance_of(ranks) * self.particle * particles,
            borders: self.imbalance_of(ranks) * self.byte * sent,
            bodies: if ranks > 1.0 { self.body * self.bodies * particles * ranks } else { 0.0 },
            sending: sent / network.bandwidth,
            waiting: if ranks > 1.0 { network.latency * (9.0 + 6.0 * deep) } else { 0.0 },
        }
    }

    /// What a step of so many ranks takes that have so many particles together, and send messages within a process [s].
    pub fn without_network(&self, ranks: usize, particles: usize) -> f64 {
        self.step(ranks as f64, particles as f64 / ranks as f64, WITHIN_A_PROCESS).sum()
    }

    fn imbalance_of(&self, ranks: f64) -> f64 {
        if ranks > 1.0 { self.imbalance } else { 1.0 }
    }

    /// Part of a step with so many particles a rank that the halo takes, on 1000 ranks.
    pub fn halo(&self, particles: f64, network: Network) -> f64 {
        let step = self.step(1000.0, particles, network);
        (step.borders + step.sending) / step.sum()
    }
}

/// Bytes that a rank sends in a step at least, of several that share so many particles which fill a cube: the mean over
/// ranks. Halving the cube again and again makes faces between ranks, in cells^2:
///
/// ```text
/// A = 3 s^2 (r^(1/3) - 1),   s: cells along the cube, r: ranks
/// ```
/// Through a face goes in both directions what tiles give to the nodes that particles of the other side reach, tile by
/// tile: as many layers as functions reach beyond a node of a particle's own cell, in each (4 + layers)^2 nodes for 4^2
/// cells, and of each node its momentum twice, its force and its mass.
pub fn halo(scheme: BenchScheme, (particles, ranks): (usize, usize)) -> f64 {
    let side = (particles as f64 / PARTICLES_PER_CELL).cbrt();
    let ranks = ranks as f64;
    let faces = 3.0 * side * side * (ranks.cbrt() - 1.0);
    let layers = if scheme.basis == "linear" { 1.0 } else { 2.0 };
    let nodes = layers * ((4.0 + layers) / 4.0_f64).powi(2);
    2.0 * faces / ranks * nodes * 10.0 * scheme.number_bytes()
}

/// Ranks up to 10,000, four for each factor of ten.
fn ranks() -> impl Iterator<Item = f64> {
    (0..=16).map(|i| 10_f64.powf(f64::from(i) / 4.0).round())
}

/// Weak and strong scaling by the models, and what a step is made of.
pub fn chart(models: &[StepModel], network: Network) -> Chart {
    let curve = |(label, i): (String, usize), of: &dyn Fn(f64) -> f64| Curve {
        label,
        color: body_color(i),
        dashed: false,
        points: ranks().map(|ranks| [ranks.log10(), of(ranks)]).collect(),
    };
    let weak = |model: &StepModel, ranks: f64| {
        model.step(1.0, WEAK, network).sum() / model.step(ranks, WEAK, network).sum()
    };
    let strong = |model: &StepModel, ranks: f64| {
        let one = model.step(1.0, STRONG, network).sum();
        one / (ranks * model.step(ranks, STRONG / ranks, network).sum())
    };
    let panel = |name: &str, of: &dyn Fn(&StepModel, f64) -> f64| Panel {
        name: name.to_owned(),
        unit: "",
        curves: (models.iter().enumerate())
            .map(|(i, model)| curve((model.problem.clone(), i), &|ranks| of(model, ranks)))
            .collect(),
    };
    let mut panels = vec![
        panel("weak scaling: efficiency, 10^6 particles a rank", &weak),
        panel("strong scaling: efficiency, 2 10^9 particles", &strong),
    ];
    if let Some(model) = models.iter().find(|model| model.problem.starts_with("P3")) {
        let parts: [(&str, PartOfStep); 5] = [
            ("computing", |step| step.computing),
            ("borders", |step| step.borders),
            ("bodies elsewhere", |step| step.bodies),
            ("sending", |step| step.sending),
            ("waiting", |step| step.waiting),
        ];
        let curves = parts.iter().enumerate().map(|(i, (label, of))| {
            let part = |ranks: f64| {
                let step = model.step(ranks, WEAK, network);
                of(&step) / step.sum()
            };
            curve(((*label).to_owned(), i), &part)
        });
        let name = "parts of a step of P3, 10^6 particles a rank".to_owned();
        panels.push(Panel { name, unit: "", curves: curves.collect() });
    }
    Chart {
        title: format!("Many ranks by the model of a step, {}", network.name),
        over: "log10 of the number of ranks".to_owned(),
        panels,
        caption: String::new(),
    }
}

/// Particles of a rank in weak scaling, and of all in strong scaling.
const WEAK: f64 = 1e6;
const STRONG: f64 = 2e9;

#[cfg(test)]
mod tests {
    use super::*;

    fn grown(ranks: usize, computed: f64, bytes: f64) -> WeakScaling {
        let scheme = BenchScheme::default();
        WeakScaling {
            problem: "P1".to_owned(),
            ranks,
            particles: 1_000_000,
            seconds: vec![0.1],
            computed,
            particle: 1e-7,
            bytes,
            modelled: halo(scheme, (1_000_000, ranks)),
            imbalance: 1.0,
        }
    }

    /// The fit gives back what was measured, and a network without end leaves computing alone.
    #[test]
    fn the_model_gives_back_what_was_measured() {
        let scheme = BenchScheme::default();
        let halo = halo(scheme, (1_000_000, 2));
        // 100 bodies elsewhere take 1e-7 s of it.
        let measured = [grown(2, 0.06 + 1e-7, 2.0 * halo)];
        let model = StepModel::fit(&measured, scheme, (1e-4, 1e-9)).unwrap();
        let [one, two] = [model.step(1.0, 1e6, WITHIN_A_PROCESS), model.step(2.0, 5e5, WITHIN_A_PROCESS)];
        assert!((one.sum() - 0.1).abs() < 1e-12, "{one:?}");
        assert!((two.computing + two.borders - 0.06).abs() < 1e-12, "{two:?}");
        assert!((two.bodies - 1e-7).abs() < 1e-15, "{two:?}");
        assert!((model.without_network(2, 1_000_000) - measured[0].computed).abs() < 1e-12);
        let slow = model.step(8.0, 1e6, Network { name: "slow", latency: 1e-3, bandwidth: 1e6 });
        assert!((slow.waiting - 27e-3).abs() < 1e-12 && slow.sending > 1.0, "{slow:?}");
    }
}
