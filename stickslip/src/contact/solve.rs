//! From pairs to a whole node: any number of bodies, each pair by its own law.

use super::law::law;
use super::{Change, Rules, Site, Span, Step, Survey, Use};
use crate::grid::Field;
use crate::tensor::{Real, Vector};
use rayon::prelude::*;

/// What contact did between two bodies at a node in one use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse<T, const D: usize> {
    /// Indices of the bodies, the first smaller.
    pub bodies: [usize; 2],
    /// Nodes of the bodies in the field.
    pub nodes: [usize; 2],
    /// The node in space.
    pub node: [i32; D],
    /// Distance between the surfaces there before the step [cells].
    pub gap: T,
    /// Its share of the contact area [m^2].
    pub area: T,
    /// How far the bodies slip there in this use: nothing where the velocities only strain [m].
    pub slip: T,
    /// The impulses on them, of this use or of the whole step as their law has it [N s].
    pub change: Change<T, D>,
    /// Changes of their velocities in this use [m/s].
    pub velocity: [Vector<T, D>; 2],
    /// Whether a later use of the same step takes it back and judges the whole.
    pub span: Span,
    /// Work that a rigid body's prescribed motion did on the other [J].
    pub work: T,
}

/// Sweeps over the pairs of a node until no velocity changes by more than this fraction of the largest.
const TOLERANCE: f64 = 1e-14;
const MAX_SWEEPS: usize = 200;

/// A use of contact.
pub struct Solve<'a, T, const D: usize> {
    /// Where bodies meet.
    pub survey: &'a Survey<T, D>,
    /// Which law holds for which pair.
    pub rules: &'a Rules<T>,
    /// The velocities.
    pub field: &'a Field<T, D>,
    /// The step.
    pub step: Step<T>,
    /// What an earlier use of contact in this step did, as [`Solve::impulses`] gave it; empty in the first use.
    pub given: &'a [Impulse<T, D>],
}

impl<T: Real, const D: usize> Solve<'_, T, D> {
    /// The impulses of all encounters in their order.
    ///
    /// Where more than two bodies meet, each pair's impulse is solved in turn with the others held until none changes
    /// (block Gauss-Seidel), so that every pair obeys its own law and momentum is conserved pair by pair. A law that judges
    /// the whole step sees the velocities without what it gave before.
    pub fn impulses(&self) -> Vec<Impulse<T, D>> {
        (self.survey.sites.par_iter().with_min_len(64)).flat_map_iter(|site| self.site(site)).collect()
    }

    fn site(&self, site: &Site<D>) -> Vec<Impulse<T, D>> {
        let Solve { survey, rules, field, step, .. } = *self;
        let sides = &survey.sides[site.sides.clone()];
        let mut velocity: Vec<Vector<T, D>> =
            sides.iter().map(|side| field.nodes[side.index].velocity).collect();
        let encounters = &survey.encounters[site.encounters.clone()];
        let given = if self.given.is_empty() { &[] } else { &self.given[site.encounters.clone()] };
        let mut impulses: Vec<Impulse<T, D>> = (encounters.iter().enumerate())
            .map(|(i, encounter)| {
                let [a, b] = encounter.sides.map(|side| &survey.sides[side]);
                let span = law::<T, D>(rules.rule(encounter.rule).law).span();
                let before = given.get(i).filter(|_| span == Span::WholeStep);
                Impulse {
                    bodies: [a.body, b.body],
                    nodes: [a.index, b.index],
                    node: site.node,
                    gap: encounter.facing.gap,
                    area: encounter.area,
                    slip: T::ZERO,
                    change: Change::NONE,
                    velocity: before.map_or([Vector::ZERO; 2], |impulse| impulse.velocity),
                    span,
                    work: T::ZERO,
                }
            })
            .collect();
        for _ in 0..MAX_SWEEPS {
            let (mut largest, mut moved) = (T::ZERO, T::ZERO);
            for (encounter, impulse) in encounters.iter().zip(&mut impulses) {
                let pair = survey.pair(encounter, rules, step);
                let places = encounter.sides.map(|side| side - site.sides.start);
                let old = impulse.velocity;
                let free = [0, 1].map(|i| velocity[places[i]] - old[i]);
                impulse.change = pair.change(free);
                impulse.work = T::ZERO;
                for i in 0..2 {
                    let inverse_mass = pair.surfaces[i].inverse_mass;
                    let new = impulse.change.impulse[i] * inverse_mass;
                    impulse.velocity[i] = new;
                    velocity[places[i]] = free[i] + new;
                    moved = moved.max((new - old[i]).norm());
                    largest = largest.max(new.norm());
                    if inverse_mass == T::ZERO {
                        impulse.work += impulse.change.impulse[1 - i].dot(free[i]);
                    }
                }
                if let (Use::Motion, Some(n)) = (step.purpose, pair.normal) {
                    let slip = velocity[places[0]] - velocity[places[1]];
                    impulse.slip = (slip - n * slip.dot(n)).norm() * step.duration;
                }
            }
            if encounters.len() == 1 || moved <= T::of(TOLERANCE.max(T::EPSILON.f64() * 4.0)) * largest {
                break;
            }
        }
        for (impulse, before) in impulses.iter_mut().zip(given) {
            if impulse.span == Span::WholeStep {
                (0..2).for_each(|i| impulse.velocity[i] -= before.velocity[i]);
            }
        }
        impulses
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Encounter, Facing, Friction, Place, Rule, Side, Surface};
    use crate::grid::Node;
    use crate::scene::{ContactLaw, Normal};
    use crate::tensor::Symmetric;
    use proptest::prelude::*;

    /// Mass, velocity and volume gradient of each body at one node.
    type State = Vec<(f64, [f64; 3], [f64; 3])>;

    /// Two to five bodies with masses over four decades, as at the rim of a body.
    fn states() -> impl Strategy<Value = State> {
        let vector = || prop::array::uniform3(-1.0..1.0_f64);
        prop::collection::vec(((-4.0..0.0_f64).prop_map(|e| 10_f64.powf(e)), vector(), vector()), 2..=5)
    }

    struct Outcome {
        masses: Vec<f64>,
        before: Vec<Vector<f64, 3>>,
        after: Vec<Vector<f64, 3>>,
        normals: Vec<Vector<f64, 3>>,
        impulses: Vec<Impulse<f64, 3>>,
    }

    impl Outcome {
        fn kinetic(&self, velocities: &[Vector<f64, 3>]) -> f64 {
            velocities.iter().zip(&self.masses).map(|(v, m)| 0.5 * m * v.dot(*v)).sum()
        }
    }

    /// What one rule does to bodies that touch at one node under pressure.
    fn at_node(state: &State, law: ContactLaw, friction: f64) -> Outcome {
        let mut field = Field { nodes: Vec::new() };
        let mut survey = Survey::default();
        for (body, &(mass, velocity, gradient)) in state.iter().enumerate() {
            field.nodes.push(Node { mass, velocity: Vector(velocity), ..Node::EMPTY });
            let volume_gradient = Vector(gradient);
            let surface = Surface {
                inverse_mass: 1.0 / mass,
                normal: (-volume_gradient).direction(),
                stress: Symmetric([-1.0, -2.0, -3.0, 0.5, 0.2, 0.1]),
                volume: 1.0,
                modulus: 10.0,
                force: Vector::ZERO,
                place: Place::EMPTY,
            };
            survey.sides.push(Side { body, index: body, surface, volume_gradient });
        }
        let n = state.len();
        for a in 0..n {
            for b in a + 1..n {
                let normal = (survey.sides[b].volume_gradient - survey.sides[a].volume_gradient).direction();
                survey.encounters.push(Encounter {
                    sides: [a, b],
                    rule: 0,
                    facing: Facing { normal, gap: 0.0 },
                    area: 1.0,
                });
            }
        }
        survey.sites.push(Site { node: [0; 3], sides: 0..n, encounters: 0..survey.encounters.len() });
        let rules = Rules::of_all(
            n,
            Rule { law, normal: Normal::Common, friction: Friction::coulomb(friction), max_strain: 1.0 },
        );
        let step = Step { duration: 1e-6, cell: 1.0, purpose: Use::Motion };
        let impulses = Solve { survey: &survey, rules: &rules, field: &field, step, given: &[] }.impulses();
        let before: Vec<_> = field.nodes.iter().map(|node| node.velocity).collect();
        let mut after = before.clone();
        for impulse in &impulses {
            (0..2).for_each(|i| after[impulse.nodes[i]] += impulse.velocity[i]);
        }
        let masses = state.iter().map(|body| body.0).collect();
        let normals = survey.encounters.iter().map(|e| e.facing.normal.expect("gradients differ")).collect();
        Outcome { masses, before, after, normals, impulses }
    }

    proptest! {
        #[test]
        fn momentum_stays_for_any_number_of_bodies(state in states(), friction in 0.0..2.0_f64) {
            use ContactLaw::{Gap, Glued, Kinematic, Surface, Traction};
            for (law, friction) in
                [Kinematic, Traction, Gap, Surface, Glued].into_iter().flat_map(|law| [(law, friction), (law, f64::INFINITY)])
            {
                let node = at_node(&state, law, friction);
                let change = (0..state.len())
                    .fold(Vector::<f64, 3>::ZERO, |sum, i| sum + (node.after[i] - node.before[i]) * node.masses[i]);
                let size: f64 = (0..state.len()).map(|i| node.before[i].norm() * node.masses[i]).sum();
                prop_assert!(change.norm() <= 1e-13 * size, "{law:?} {friction}: {:e} of {size:e}", change.norm());
            }
        }

        #[test]
        fn contact_of_approaching_bodies_gains_no_energy(state in states(), friction in 0.0..2.0_f64) {
            for law in [ContactLaw::Kinematic, ContactLaw::Surface, ContactLaw::Glued] {
                let node = at_node(&state, law, friction);
                let (before, after) = (node.kinetic(&node.before), node.kinetic(&node.after));
                prop_assert!(after <= before * (1.0 + 1e-12), "{law:?}: {before} to {after}");
            }
        }

        #[test]
        fn every_pair_obeys_coulomb(state in states(), friction in 0.0..2.0_f64) {
            for law in [ContactLaw::Kinematic, ContactLaw::Traction, ContactLaw::Gap, ContactLaw::Surface] {
                let node = at_node(&state, law, friction);
                for (impulse, normal) in node.impulses.iter().zip(&node.normals) {
                    let (push, across) = (-impulse.change.normal, impulse.change.tangential);
                    prop_assert!(across.norm() <= friction * push.max(0.0) * (1.0 + 1e-12), "{law:?}: {impulse:?}");
                    prop_assert!(across.dot(*normal).abs() <= 1e-14, "{law:?}: {impulse:?}");
                    prop_assert!(!matches!(law, ContactLaw::Kinematic | ContactLaw::Surface) || push >= 0.0, "{law:?} pulls: {impulse:?}");
                }
            }
        }

        #[test]
        fn glued_bodies_have_one_velocity(state in states()) {
            let node = at_node(&state, ContactLaw::Glued, 0.0);
            for v in &node.after {
                prop_assert!((*v - node.after[0]).norm() <= 1e-12, "{:?}", node.after);
            }
        }
    }
}
