//! What a run came to, on one screen.

use super::WidestContacts;
use super::verdict::{line, share};
use crate::door::{Ledger, RelaxationState, View};
use crate::observe::{BodyRow, Manifest, Performance, RunWarning, Status, TableRow};
use crate::scene::Scene;
use std::fmt::{self, Display, Formatter};

/// What a run came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Finished or interrupted.
    pub status: Status,
    /// Time reached, steps, wall time, timing of each verb.
    pub performance: Performance,
    /// Energy and momentum at the start.
    pub start: Ledger,
    /// Energy and momentum at the end.
    pub end: Ledger,
    /// Largest energy that moved or was stored at a time, turned to heat or was set free by falling [J].
    pub energy_scale: f64,
    /// How far dynamic relaxation came, if the scene asks for it.
    pub relaxation: Option<RelaxationState>,
    /// How wide the bodies touched, and whether the grid resolved it.
    pub contacts: WidestContacts,
    /// What is wrong with the results.
    pub warnings: Vec<RunWarning>,
    /// How the run compares with each known answer of the scene.
    pub references: Vec<ReferenceResult>,
}

/// What drifts are held against.
pub(super) struct Energies {
    /// The ledger at the start.
    pub start: Ledger,
    /// See [`Summary::energy_scale`].
    pub scale: f64,
}

/// One quantity of one body against its known answer, at the time that the run reached.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceResult {
    /// Name of the body.
    pub body: String,
    /// A column of `bodies.csv`.
    pub quantity: String,
    /// What the answer assumes.
    pub label: String,
    /// What the run gave, in SI units.
    pub value: f64,
    /// What it should give, in SI units.
    pub exact: f64,
}

impl ReferenceResult {
    /// Value over exact value; not finite where the exact value is zero.
    pub fn ratio(&self) -> f64 {
        self.value / self.exact
    }
}

impl Summary {
    pub(super) fn new(
        scene: &Scene,
        simulation: &dyn View,
        energies: Energies,
        (manifest, contacts): (Manifest, WidestContacts),
    ) -> Self {
        let (time, bodies) = (simulation.time(), simulation.bodies());
        let references = scene.references.iter().filter_map(|reference| {
            let body = scene.bodies.iter().position(|body| body.name == reference.body)?;
            let row = BodyRow { time, body: reference.body.clone(), state: bodies[body].clone() };
            Some(ReferenceResult {
                body: reference.body.clone(),
                quantity: reference.quantity.clone(),
                label: reference.label.clone(),
                value: row.number(&reference.quantity)?,
                exact: reference.value.at(time),
            })
        });
        let references = references.collect();
        let Manifest { status, performance, relaxation, warnings, .. } = manifest;
        let Energies { start, scale: energy_scale } = energies;
        Summary {
            status,
            performance,
            start,
            energy_scale,
            end: simulation.ledger(),
            relaxation,
            contacts,
            warnings,
            references,
        }
    }

    /// Change of the total energy, which is zero in an exact solution [J].
    pub fn energy_drift(&self) -> f64 {
        self.end.total - self.start.total
    }

    /// [`Summary::energy_drift`] over [`Summary::energy_scale`] [-].
    pub fn relative_energy_drift(&self) -> f64 {
        share(self.energy_drift(), self.energy_scale)
    }

    /// The warnings as lines of text, one a kind: of several bodies the worst stands for all.
    pub fn warning_lines(&self) -> Vec<String> {
        let mut kinds: Vec<&str> = Vec::new();
        for warning in &self.warnings {
            if !kinds.contains(&warning.kind.as_str()) {
                kinds.push(&warning.kind);
            }
        }
        let told = |warning: &RunWarning| {
            let times = if warning.count == 1 { "once" } else { &format!("{} times", warning.count) };
            format!("from t = {:.4e} s, {times}: {}", warning.time, line(warning))
        };
        let of_kind = |kind: &str| {
            let all: Vec<_> = self.warnings.iter().filter(|warning| warning.kind == kind).collect();
            let worst = all.iter().max_by(|a, b| a.worst.abs().total_cmp(&b.worst.abs()))?;
            Some(match all.len() {
                1 => told(worst),
                count => format!("{kind}: {count} bodies, all in run.json; the worst {}", told(worst)),
            })
        };
        kinds.into_iter().filter_map(of_kind).collect()
    }
}

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Performance { time, steps, particles, wall_time, particle_steps_per_second, .. } =
            self.performance;
        let ended = match self.status {
            Status::Interrupted => "interrupted",
            Status::OutOfTime => "stopped, as it took as long as it was given,",
            Status::Running | Status::Finished | Status::Failed | Status::Stopped => "finished",
        };
        writeln!(f, "{ended} at t = {time:.6} s after {steps} steps of {particles} particles")?;
        writeln!(f, "  wall time  {wall_time:.1} s, {particle_steps_per_second:.3e} particle-steps/s")?;
        self.write_timings(f)?;
        writeln!(
            f,
            "  energy     {:.6e} J at the start, {:.6e} J at the end; drift {:+.2e} J ({:+.3} %)",
            self.start.total,
            self.end.total,
            self.energy_drift(),
            100.0 * self.relative_energy_drift()
        )?;
        writeln!(
            f,
            "  momentum   {} kg m/s at the start, {} kg m/s at the end",
            vector(self.start.momentum),
            vector(self.end.momentum)
        )?;
        if let Some(RelaxationState { residual, peaks, at_rest }) = self.relaxation {
            let state = if at_rest { "at rest" } else { "not at rest" };
            // Only bodies on the common grid are stopped at peaks.
            let stops = match peaks {
                0 => String::new(),
                _ => format!(" after {peaks} peaks of the kinetic energy"),
            };
            writeln!(f, "  relaxation {state}: residual {residual:.2e}{stops}")?;
        }
        if self.end.scaled_impulses > 0 {
            writeln!(
                f,
                "  contact    {} impulses at nodes were reduced to max_strain",
                self.end.scaled_impulses
            )?;
        }
        if self.end.unsettled_nodes > 0 {
            writeln!(
                f,
                "  contact    {} times sweeps over bodies that touch ended before their impulses were found to the \
                 tolerance",
                self.end.unsettled_nodes
            )?;
        }
        write!(f, "{}", self.contacts)?;
        self.write_warnings(f)?;
        self.references.iter().try_for_each(|reference| write!(f, "{reference}"))
    }
}

impl Summary {
    fn write_timings(&self, f: &mut Formatter) -> fmt::Result {
        let timings = &self.performance.timings;
        let total: f64 = timings.iter().map(|timing| timing.seconds).sum();
        if total <= 0.0 {
            return Ok(());
        }
        let shares: Vec<String> = timings
            .iter()
            .map(|timing| format!("{} {:.0} %", timing.verb, 100.0 * timing.seconds / total))
            .collect();
        writeln!(f, "  time       {}", shares.join(", "))
    }

    fn write_warnings(&self, f: &mut Formatter) -> fmt::Result {
        self.warning_lines().iter().try_for_each(|line| writeln!(f, "  warning    {line}"))
    }
}

impl Display for ReferenceResult {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let ReferenceResult { body, quantity, label, value, exact } = self;
        write!(f, "  {body} {quantity}: {value:.6}, exact {exact:.6}")?;
        if self.ratio().is_finite() {
            write!(f, ", ratio {:.4}", self.ratio())?;
        }
        writeln!(f, " ({label})")
    }
}

fn vector([x, y, z]: [f64; 3]) -> String {
    format!("({x:.4e}, {y:.4e}, {z:.4e})")
}
