//! What a run watches while it goes on, and what it does where something is wrong.

use super::Scene;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Something that makes the results of a run doubtful.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HealthCheck {
    /// Energy that comes from nowhere or is lost.
    Energy,
    /// Motion that becomes noise and is damped.
    Noise,
    /// Momentum of all bodies that nothing from outside explains.
    Momentum,
    /// Angular momentum of bodies that no torque acts on.
    AngularMomentum,
    /// Stretch by positions against stretch by deformation gradients.
    Strain,
    /// Numerical fracture.
    Tearing,
    /// Stressed particles that cross cells with linear functions.
    CellCrossing,
    /// Motion within a body that nears the speed of its waves.
    Speed,
    /// Steps that have become far shorter than the first.
    SmallStep,
    /// Steps that failed and were taken again.
    FailedStep,
    /// Contacts that the grid does not resolve.
    Contact,
    /// Impulses of contact that were reduced to the rule's `max_strain`.
    MaxStrain,
    /// Steps that are lost in the rounding of positions.
    Precision,
    /// Dynamic relaxation that did not come to rest.
    Relaxation,
    /// Particles that left the domain and were taken out.
    Leaving,
    /// Checkpoints that could not be written, or read.
    Checkpoint,
    /// Probes and sections that never had material around them, fronts and arrivals that never were.
    Probe,
    /// Parts of one body that meet, and share nodes.
    SelfContact,
}

/// What a run does where something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Response {
    /// It says so, and goes on.
    Warn,
    /// It ends there, with all records and a checkpoint.
    Stop,
    /// It says so, and takes shorter steps from there on; energy and momentum only.
    CutStep,
    /// It writes it into its record, and gives no warning.
    Record,
    /// It gives no warning.
    Ignore,
}

/// What a scene says of one check.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HealthRule {
    /// What to do beyond the bound.
    pub then: Response,
    /// The bound, if it is not the usual one: see [`Scene::health_bound`].
    pub bound: Option<f64>,
}

/// What a scene says of the checks; those that it does not name do what is usual.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Health {
    /// What it says of each, or of all.
    pub rules: BTreeMap<HealthCheck, HealthRule>,
    /// How often a step that fails is taken again with half of its length, and half of that, before the run gives up.
    pub retries: usize,
}

impl HealthCheck {
    /// Every check in the order in which a run looks.
    pub const ALL: [Self; 18] = [
        Self::Energy,
        Self::Noise,
        Self::Momentum,
        Self::AngularMomentum,
        Self::Strain,
        Self::Tearing,
        Self::CellCrossing,
        Self::Speed,
        Self::SmallStep,
        Self::FailedStep,
        Self::Contact,
        Self::MaxStrain,
        Self::Precision,
        Self::Relaxation,
        Self::Leaving,
        Self::Checkpoint,
        Self::Probe,
        Self::SelfContact,
    ];

    /// Its name in records; scene files have `_` for `-`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::Noise => "noise",
            Self::Momentum => "momentum",
            Self::AngularMomentum => "angular-momentum",
            Self::Strain => "strain",
            Self::Tearing => "tearing",
            Self::CellCrossing => "cell-crossing",
            Self::Speed => "speed",
            Self::SmallStep => "small-step",
            Self::FailedStep => "failed-step",
            Self::Contact => "contact",
            Self::MaxStrain => "max-strain",
            Self::Precision => "precision",
            Self::Relaxation => "relaxation",
            Self::Leaving => "leaving",
            Self::Checkpoint => "checkpoint",
            Self::Probe => "probe",
            Self::SelfContact => "self-contact",
        }
    }

    /// Whether shorter steps may help.
    pub fn can_cut_step(self) -> bool {
        matches!(self, Self::Energy | Self::Momentum)
    }

    /// What it does if the scene says nothing. Contacts that are not resolved have a line of their own in each summary,
    /// and count as a warning only where the scene asks for it.
    pub fn usual_response(self) -> Response {
        match self {
            Self::Contact => Response::Record,
            _ => Response::Warn,
        }
    }

    /// Beyond what it answers if the scene says nothing else; `None` where there is no measure to set a bound to, or
    /// another key sets it.
    pub fn usual_bound(self) -> Option<f64> {
        match self {
            Self::Energy | Self::Strain | Self::CellCrossing | Self::Precision => Some(0.1),
            Self::Noise => Some(0.05),
            Self::Momentum | Self::SmallStep => Some(0.01),
            Self::AngularMomentum => Some(0.02),
            Self::Speed | Self::MaxStrain => Some(0.5),
            Self::Tearing | Self::FailedStep | Self::Contact => None,
            Self::Relaxation | Self::Leaving | Self::Checkpoint | Self::Probe | Self::SelfContact => None,
        }
    }
}

impl Health {
    /// What to do where a check finds something.
    pub fn response(&self, check: HealthCheck) -> Response {
        self.rules.get(&check).map_or(check.usual_response(), |rule| rule.then)
    }
}

impl Scene {
    /// The bound of a check, beyond which it answers; infinite of those that have none, see
    /// [`HealthCheck::usual_bound`]. `time.energy_drift` is that of energy, and half of it that of noise, where these
    /// have none of their own.
    pub fn health_bound(&self, check: HealthCheck) -> f64 {
        let own = self.health.rules.get(&check).and_then(|rule| rule.bound);
        let usual = match check {
            HealthCheck::Energy => Some(self.time.energy_drift),
            HealthCheck::Noise => Some(0.5 * self.time.energy_drift),
            other => other.usual_bound(),
        };
        own.or(usual).unwrap_or(f64::INFINITY)
    }
}
