//! How long the next step may be, and what makes it no longer.

use super::Engine;
use crate::clock::{Fastest, fastest_signal};
use crate::door::StepLimit;
use crate::lanes::Laned;
use crate::ranks::largest;

/// A step is shortened so often at most for the way of a rigid body.
const MOST_CUTS: usize = 8;
/// A body may go so much further than stable steps let it: its speed changes a little from step to step.
const MOST_OF_ALLOWED: f64 = 1.5;
/// Nor is a step made shorter than this part of the stable one for it: a body that goes too far even so, jumps.
const LEAST_OF_STABLE: f64 = 1e-3;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Longest stable step now, courant h / max(c + |v_p|): the speed is the fastest *signal* ([`crate::clock`]) [s].
    pub(super) fn stable(&self) -> f64 {
        let fastest = || {
            let here =
                fastest_signal(self.shown(), &|body| self.finer(body)).map_or(0.0, |fastest| fastest.speed);
            self.among.as_ref().map_or(here, |among| largest(&*among.ranks, here))
        };
        let signal = self.state.signal.unwrap_or_else(fastest);
        self.step_of_signal(signal).min(self.longest_turn()).min(self.longest_whatever_moves())
    }

    /// What makes it so short; none where the scene alone does.
    pub(super) fn limit(&self) -> Option<StepLimit> {
        let (turn, longest) = (self.longest_turn(), self.longest_whatever_moves());
        let shortest = |(speed, _): &(f64, StepLimit)| self.step_of_signal(*speed) < turn.min(longest);
        if let Some((_, limit)) = self.fastest_of_all().filter(shortest) {
            return Some(limit);
        }
        let (body, _) = self.longest_turns().min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        let motion = self.state.bodies[body].motion.as_deref()?;
        (turn < longest).then_some(StepLimit { body, particle: None, position: motion.center })
    }

    /// The particle with the fastest signal [m/s] of all ranks.
    fn fastest_of_all(&self) -> Option<(f64, StepLimit)> {
        let here = fastest_signal(self.shown(), &|body| self.finer(body)).map(
            |Fastest { body, particle, speed, .. }| {
                let particle = self.state.bodies[body].particles.get(particle);
                let position = particle.position.space();
                (speed, StepLimit { body, particle: Some(particle.number), position })
            },
        );
        let Some(among) = &self.among else { return here };
        let first = |(_, limit): &(f64, StepLimit)| (limit.body, limit.particle);
        let faster = |a: &(f64, StepLimit), b: &(f64, StepLimit)| {
            a.0.total_cmp(&b.0).then_with(|| first(b).cmp(&first(a)))
        };
        among.gathered(&here).into_iter().flatten().max_by(faster)
    }

    /// The step in which a signal of this speed [m/s] crosses as much of a cell as is stable [s].
    fn step_of_signal(&self, speed: f64) -> f64 {
        self.settings.time.courant * self.settings.lattice.cell.f64() / speed
    }

    /// A step of `dt` from `time` on, shorter where it would take a rigid body of prescribed motion further than a
    /// stable one of this length should: its speed was another before, by which stable steps go. Where it jumps no step
    /// is short enough, and one takes it there [s].
    pub(super) fn shortened_by_way(&self, time: f64, dt: f64, stable: f64) -> f64 {
        let least = dt.min(LEAST_OF_STABLE * stable);
        let allowed = self.settings.time.courant * self.settings.lattice.cell.f64();
        let motions =
            self.settings.rigid.iter().filter_map(|&body| self.state.bodies[body].motion.as_deref());
        motions.fold(dt, |dt, motion| {
            let mut dt = dt;
            for _ in 0..MOST_CUTS {
                let way = motion.prescribed_way(time, dt);
                // What is no number is found as the body moves.
                if way.is_nan() || way <= MOST_OF_ALLOWED * allowed {
                    break;
                }
                dt = least.max(dt * allowed / way);
            }
            dt
        })
    }

    /// The longest step that the scene allows, whatever moves [s].
    fn longest_whatever_moves(&self) -> f64 {
        self.state.longest_rigid.min(self.settings.time.max_step.unwrap_or(f64::INFINITY))
    }
}
