//! The step: explicit MPM with contact, as a list of verbs for each way to update the stress.
//!
//! Most verbs are a *pass* over all particles, or do one thing at each node. Where it is written out:
//!
//! | what | where |
//! |---|---|
//! | the length of the step, and what happens around it | `Simulation::step` below |
//! | which passes a step makes, and in which order | the recipes below |
//! | what a pass does to a particle: velocity, F and stress, position | `pass/group.rs`, from top to bottom |
//! | G2P's and P2G's sums over nodes | `interpolate`, `flow`, `moments`, `gradient`, `scatter` of [`crate::transfer`] |
//! | the same as the equations read, one particle and node after the other | `naive.rs`, and `transfer/naive.rs` |
//! | the stress | `respond` of a law in [`crate::material`] |
//! | the stress of laws that take a body at once | `together.rs` |
//! | bodies that keep their volume | `average.rs` |
//! | damping at a node | [`crate::damping`] |
//! | what is booked of a step | `account.rs` |
//! | dynamic relaxation, between two steps | `relax.rs` |
//! | what happens at a node: v = p / m, v += dt (f / m + g) | [`crate::grid::Node`] |
//! | gravity, and its work where it varies | `gravity.rs` |
//! | loads and supports at a node | `loads.rs` |
//! | loads that heat | `heat.rs`, and [`crate::natural`] |
//! | springs between parts of bodies | `springs.rs` |
//! | bodies on grids of their own undeformed places | `reference/`, and [`stickslip_reference`] |
//! | free rigid bodies, and joints between them | `mechanism/` |
//! | glue at a node | `glue.rs` |
//! | contact at a node | `contact/solve.rs`, by a law of `contact/law/` |

mod account;
mod among;
mod average;
mod build;
mod carrying;
mod cpu;
mod glue;
mod gravity;
mod heat;
mod hold;
mod leave;
mod limit;
mod loads;
mod mechanism;
mod reference;
mod relax;
mod saving;
mod springs;
mod state;
mod together;
mod unbounded;
mod verbs;
mod view;
mod walls;
mod watch;
mod writing;

pub use crate::pass::ParticleLoop;
pub(crate) use among::Find;
pub(crate) use build::{Shareable, build_empty, build_share};
pub use build::{build, build_among, build_by, build_on};
pub(crate) use build::{heated_bodies, own_columns};
pub(crate) use mechanism::{JointSums, TouchForce};
pub(crate) use reference::{ReferenceBody, SavedNodes};
pub(crate) use relax::RelaxationProgress;
pub(crate) use unbounded::particles_around;
pub(crate) use walls::WallSums;

use crate::Kernels;
use crate::body::Body;
use crate::boundary::Boundary;
use crate::contact::ContactUse;
use crate::door::{RestoreError, SavedColumn, SavedShare, SavedState, Simulation, StepError, WriteError};
use crate::lanes::Laned;
use crate::scene::{StartVelocities, StressUpdate};
use crate::threads::each;
use crate::transfer::Share;
use account::{Interpolated, StepSums};
use among::{Among, Kinds};
use state::{Settings, State, Workspace};
use std::sync::PoisonError;
use watch::Stopwatch;

/// A simulation in `D` dimensions and precision `T`.
pub struct Engine<T: 'static, const D: usize> {
    settings: Settings<T, D>,
    state: State<T, D>,
    workspace: Workspace<T, D>,
    /// The state before the last step, of simulations that take failed steps again.
    held: Option<hold::Held<T, D>>,
    watch: Stopwatch,
    /// The ranks that share the simulation, if there are any.
    among: Option<Among<T>>,
    /// Of one of several ranks, what it knows of bodies of which it has nothing.
    kinds: Option<Kinds<T, D>>,
    /// What knows the shape functions.
    kernels: &'static Kernels<T, D>,
}

/// The recipes. Numbers are equations of Bardenhagen et al. (2001). P2G: particles to grid, G2P: grid to particles.
///
/// ```text
/// v~    velocity of a node after contact and walls
/// v^0   the interpolated velocity, before contact, walls and forces; where glue joins bodies, that of all of them
/// dv    change of the step that a particle takes: sum S_i (v~_i - v_i^0), with v~ integrated, and damped
/// L     sum v~_i (x) grad S_i, of the velocities that strain
/// ```
/// All have contact on the interpolated and on the integrated velocities. In each, the velocities that strain particles
/// also move them; which velocities these are differs. In MUSL they are interpolated a second time, and contact acts a
/// third time. Walls are imposed after each contact, too. All contact laws but one act in all of these places, as the
/// paper's do. `surface`, the default, leaves alone interpolated velocities that strain nothing.
impl<T: Laned, const D: usize> Engine<T, D> {
    /// One step of `dt`.
    fn advance(&mut self, dt: T) -> Result<(), StepError> {
        match self.settings.time.stress_update {
            StressUpdate::First => self.update_stress_first(dt),
            StressUpdate::Last => self.update_stress_last(dt),
            StressUpdate::ModifiedLast => self.modified_update_stress_last(dt),
        }
    }

    /// Update stress first (USF): the interpolated velocities strain and move particles.
    fn update_stress_first(&mut self, dt: T) -> Result<(), StepError> {
        self.find_active_blocks(); //                             cell lists; blocks of nodes under bodies' particles
        self.find_free_bodies(); //                               rigid ones that forces move, and their joints
        self.particles_to_grid(Share::Mass); //                   P2G: m, p
        self.interpolate_velocities(); //                         v = p / m                            (4)
        self.impose_boundary_conditions(); //                     of rigid bodies and walls
        self.detect_contact(None); //                             surfaces, normals and gaps where bodies meet
        self.join_glued_bodies(); //                              one v for bodies that glue joins
        self.feel_loads(dt, None)?; //                            supports, on points of bodies
        self.hold_supported_nodes(); //                           v~, where they act
        self.contact_on_interpolated(dt, ContactUse::Strain); //  v~, and walls        (5)-(13), (20)-(22)
        self.average_dilatation(dt); //                           of nearly incompressible bodies
        self.heat(dt)?; //                                        temperatures at the end of the step
        self.update_stress(dt)?; //                               G2P: F = (I + L dt) F, sigma = law(F); P2G: f
        self.keep_velocities(); //                                v~ moves the particles, too
        self.release_supported_nodes(); //                        v as it was
        self.push_references(dt)?; //                             bodies on grids of their own: v += dt (f / m + g)
        self.update_velocities(dt); //                            v += dt (f / m + g)                  (3)
        self.feel_loads(dt, Some(dt))?; //                        supports and loads, on points of bodies
        self.apply_loads(dt); //                                  v += dt F / m
        self.push_free_bodies(dt); //                             rigid ones: v += dt (F / m + g)
        self.pull_springs(dt, Some(dt)); //                       between parts of bodies
        self.impose_boundary_conditions(); //                     once more
        self.contact_on_integrated(dt); //                        v~, and walls
        self.exchange_velocities(); //                            v~ that was kept, to move by; v~ of now, for dv
        self.move_references(dt)?; //                             x += v dt, F, sigma; what they rub, by v of all
        self.damp(dt); //                                         of v~ for dv
        self.update_velocities_and_positions(dt)?; //             G2P: v_p += dv, x += v~ dt
        self.move_rigid_bodies(dt)?; //                           as prescribed, free ones by their velocities
        self.account_mechanism(dt); //                            forces and works of joints
        self.account(dt, Interpolated::Once); //                  impulses, works, balance of forces
        self.account_loads(dt); //                                forces and works of supports and loads
        self.account_springs(dt); //                              and of springs
        Ok(())
    }

    /// Update stress last (USL): the integrated velocities strain and move particles.
    fn update_stress_last(&mut self, dt: T) -> Result<(), StepError> {
        self.find_active_blocks(); //                             cell lists; blocks of nodes under bodies' particles
        self.find_free_bodies(); //                               rigid ones that forces move, and their joints
        self.particles_to_grid(Share::Everything); //             P2G: m, p, f = -sum V sigma grad S
        self.interpolate_velocities(); //                         v = p / m                            (4)
        self.impose_boundary_conditions(); //                     of rigid bodies and walls
        self.push_references(dt)?; //                             bodies on grids of their own: v += dt (f / m + g)
        self.detect_contact(Some(dt)); //                         surfaces, normals and gaps where bodies meet
        self.join_glued_bodies(); //                              one v for bodies that glue joins
        self.contact_on_interpolated(dt, ContactUse::Start); //   by all laws but `surface`: (5)-(13), (20)-(22)
        self.update_velocities(dt); //                            v += dt (f / m + g)                  (3)
        self.feel_loads(dt, None)?; //                            supports and loads, on points of bodies
        self.apply_loads(dt); //                                  v += dt F / m
        self.push_free_bodies(dt); //                             rigid ones: v += dt (F / m + g)
        self.pull_springs(dt, None); //                           between parts of bodies
        self.impose_boundary_conditions(); //                     once more
        self.contact_on_integrated(dt); //                        v~, and walls
        self.heat(dt)?; //                                        temperatures at the end of the step
        self.move_references(dt)?; //                             x += v dt, F, sigma; what they rub, by v of all
        self.keep_velocities(); //                                v~, for dv
        self.damp(dt); //                                         of v~ for dv
        self.average_dilatation(dt); //                           of nearly incompressible bodies
        self.update_particles(dt)?; //                            G2P: v_p += dv, F, sigma, x += v~ dt
        self.move_rigid_bodies(dt)?; //                           as prescribed, free ones by their velocities
        self.account_mechanism(dt); //                            forces and works of joints
        self.account(dt, Interpolated::Once); //                  impulses, works, balance of forces
        self.account_loads(dt); //                                forces and works of supports and loads
        self.account_springs(dt); //                              and of springs
        Ok(())
    }

    /// Modified update stress last (MUSL), the default: the particles' new velocities, interpolated once more, strain
    /// and move particles. Works are accounted before contact acts on these, which no particle takes as a change.
    fn modified_update_stress_last(&mut self, dt: T) -> Result<(), StepError> {
        self.find_active_blocks(); //                             cell lists; blocks of nodes under bodies' particles
        self.find_free_bodies(); //                               rigid ones that forces move, and their joints
        self.particles_to_grid(Share::Everything); //             P2G: m, p, f = -sum V sigma grad S
        self.interpolate_velocities(); //                         v = p / m                            (4)
        self.impose_boundary_conditions(); //                     of rigid bodies and walls
        self.push_references(dt)?; //                             bodies on grids of their own: v += dt (f / m + g)
        self.detect_contact(Some(dt)); //                         surfaces, normals and gaps where bodies meet
        self.join_glued_bodies(); //                              one v for bodies that glue joins
        self.contact_on_interpolated(dt, ContactUse::Start); //   by all laws but `surface`: (5)-(13), (20)-(22)
        self.update_velocities(dt); //                            v += dt (f / m + g)                  (3)
        self.feel_loads(dt, None)?; //                            supports and loads, on points of bodies
        self.apply_loads(dt); //                                  v += dt F / m
        self.push_free_bodies(dt); //                             rigid ones: v += dt (F / m + g)
        self.pull_springs(dt, None); //                           between parts of bodies
        self.impose_boundary_conditions(); //                     once more
        self.contact_on_integrated(dt); //                        v~, and walls
        self.keep_velocities_and_clear_momentum(); //             v~, for dv; p = 0
        self.damp(dt); //                                         of v~ for dv
        self.update_particle_velocities(dt)?; //                  G2P: v_p += dv; P2G: p
        self.interpolate_again(); //                              v = p / m, with m as before
        self.impose_boundary_conditions(); //                     and again
        self.heat(dt)?; //                                        temperatures at the end of the step
        self.move_references(dt)?; //                             x += v dt, F, sigma; what they rub, by v of all
        self.account(dt, Interpolated::Twice); //                 the same, while u^1 is at the nodes
        self.hold_supported_nodes(); //                           v~, where supports act
        self.contact_on_straining(dt); //                         v~, and walls
        self.average_dilatation(dt); //                           of nearly incompressible bodies
        self.update_stress_and_positions(dt)?; //                 G2P: F, sigma, x += v~ dt
        self.move_rigid_bodies(dt)?; //                           as prescribed, free ones by their velocities
        self.account_mechanism(dt); //                            forces and works of joints
        self.account_loads(dt); //                                forces and works of supports and loads
        self.account_springs(dt); //                              and of springs
        Ok(())
    }
}

impl<T: Laned, const D: usize> Simulation for Engine<T, D> {
    fn step(&mut self, longest: f64) -> Result<f64, StepError> {
        let step = self.step_unseen(longest);
        self.show();
        step
    }

    fn step_unseen(&mut self, longest: f64) -> Result<f64, StepError> {
        *self.workspace.totals.get_mut().unwrap_or_else(PoisonError::into_inner) = None;
        let time = self.state.time;
        let stable = self.stable();
        let dt = self.settings.changes.step(time, stable.min(longest));
        let dt = self.shortened_by_way(time, dt, stable);
        for &body in &self.settings.rigid {
            let body = &mut self.state.bodies[body];
            let Some(motion) = &mut body.motion else { continue };
            motion.set_step(time, dt).map_err(|reason| {
                let what = format!("the prescribed motion of body `{}`", body.name);
                StepError::Outside { what, time, reason }
            })?;
        }
        self.workspace.sums = StepSums::default();
        let begun = self.among.as_mut().map(Among::begin);
        // One of the pool's threads takes the whole step: handing it every loop from outside would cost more than many
        // a loop.
        let weights = self.weigh();
        rayon::scope(|_| self.advance(T::of(dt)))?;
        self.end_step(T::of(dt)).map_err(|fault| self.error(&fault))?;
        self.book_gravity(T::of(dt), weights);
        self.count_disorder();
        self.relax(dt);
        self.state.time += dt;
        self.state.steps += 1;
        self.remove_leavers();
        self.among.iter_mut().zip(begun).for_each(|(among, begun)| among.end(begun));
        Ok(dt)
    }

    fn show(&mut self) {
        self.show_references();
    }

    fn rebuild_workspace(&mut self) {
        let boundary = Boundary::new(self.settings.walls.clone());
        let tallies = !self.state.walls.is_empty();
        let boundary = if tallies { boundary.tallied() } else { boundary };
        self.workspace = Workspace::new(boundary, self.settings.lattice.periods);
        // The lists that knew which had some are gone.
        let here = self.state.bodies.iter_mut().filter_map(Body::here_mut);
        here.for_each(|body| body.particles.dismiss_guests());
        self.watch_borders();
    }

    fn hold(&mut self) {
        self.hold_state();
    }

    fn take_back(&mut self) -> bool {
        let held = self.take_back_state();
        if held {
            self.rebuild_workspace();
        }
        held
    }

    fn settle(&mut self) {
        each(&mut self.state.bodies, 1, |_, body| {
            body.here_mut().into_iter().for_each(|body| body.particles.settle());
        });
    }

    fn write(&mut self, body: usize, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.put(body, name, values)
    }

    fn save(&self) -> Option<SavedState> {
        self.is_whole().is_ok().then(|| self.saved())
    }

    fn save_rest(&self) -> Option<SavedState> {
        Some(self.saved_rest())
    }

    fn save_shares(&self, most: usize, take: &mut dyn FnMut(Vec<SavedShare>)) {
        self.share_out(most, take);
    }

    fn save_columns(&self, body: usize, take: &mut dyn FnMut(&[u32], SavedColumn)) -> bool {
        let particles = &self.shown()[body].particles;
        saving::columns(particles).for_each(|column| take(particles.numbers(), column));
        true
    }

    fn begin_from(&mut self, state: &SavedState, velocities: StartVelocities) -> Result<(), RestoreError> {
        self.is_whole()?;
        self.carry_over(state, velocities)?;
        self.rebuild_workspace();
        Ok(())
    }

    fn restore(&mut self, state: SavedState) -> Result<(), RestoreError> {
        self.is_whole()?;
        self.take_up(state)?;
        self.rebuild_workspace();
        Ok(())
    }
}
