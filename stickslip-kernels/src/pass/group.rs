//! What a pass does to a group of particles: G2P of velocities, stress update, advection, P2G, in this order.

use super::members::{HistoryOfGroup, Members};
use super::{FaultKind, Pass, Verbs, Visit};
use crate::basis::{Basis, BoxSide};
use crate::lanes::{Laned, Lanes, Machine};
use crate::material::{Material, Motion, Recall, Thickening, Thickness};
use crate::matter::Gyration;
use crate::natural::Natural;
use crate::particles::ColumnStart;
use crate::signal::{no_faster, signal_speed};
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use crate::transfer::{
    Apic, Group, Momentum, SETTLES_EVERY, ScatterTerms, Share, Start, TransferRule, VelocityState, has_spin,
    is_affine, of_transfer,
};
use crate::viscosity::BulkViscosity;

/// What all particles of a tile have in common.
pub struct Constants<V, const D: usize> {
    /// The body's law.
    pub material: Material<V>,
    /// 1/rho_0 [m^3/kg]
    pub per_density: V,
    /// Expansion by temperature [1/K].
    pub expansion: V,
    /// Position of the node at zero [m].
    pub origin: Vector<V, D>,
    /// Side of a cell [m].
    pub cell: V,
    /// Inverse of it [1/m].
    pub per_cell: V,
    /// What the particles weigh against turning.
    pub gyration: Gyration<V>,
    /// Lower and upper corner of the domain [m].
    pub domain: Option<[Vector<V, D>; 2]>,
}

impl<V: Lanes, const D: usize> Constants<V, D> {
    #[inline(always)]
    fn in_cells(&self, position: &Vector<V, D>) -> Vector<V, D> {
        (*position - self.origin) * self.per_cell
    }
}

#[inline(always)]
pub fn splat<V: Lanes, const D: usize>(vector: &Vector<V::Real, D>) -> Vector<V, D> {
    Vector::from_fn(|i| V::splat(vector[i]))
}

/// Takes a group through a pass and says which particles did not leave their cells.
///
/// This is all that is ever done to a particle, written once for any number of lanes. `base` has the particles' base
/// nodes, `start` these nodes' places in the window.
///
/// # Errors
/// A particle has a fault. Of several lanes nothing is stored, and the fault may be any of theirs. A single lane stores
/// what a report shows of it, and the fault is its first.
#[inline(always)]
pub fn group<T: Laned, V: Lanes<Real = T>, M: Machine<T>, const D: usize, B: Basis<T>, S: Start>(
    visit: &mut Visit<'_, T, D>,
    constants: &Constants<V, D>,
    members: &Members<'_, T, D>,
    (base, start): (Vector<V, D>, S),
) -> Result<u32, FaultKind> {
    let Pass { verbs, dt, transfer, pic, viscosity, .. } = *visit.pass;
    let Verbs { smooth, update_velocity, update_stress, settle, advect, scatter } = verbs;
    let position = members.vector::<V>(ColumnStart::<D>::POSITION);
    let half_width = members.half_width::<V>();
    let half_side = match visit.pass.lattice.half_side {
        Some(half) => V::splat(half),
        None => half_width * constants.per_cell,
    };
    let side = BoxSide::new(half_side);
    let group = Group::<V, D, B, S>::new(constants.in_cells(&position) - base, &side, start, members.count());
    let mut sound = Sound::EVERYTHING;

    let mut state =
        VelocityState { velocity: Vector::ZERO, spin: Vector::ZERO, strain_rate: Symmetric::ZERO };
    let gyration_squared = constants.gyration.squared(half_width);
    // What the transfer takes beside the work of forces: v^2 + k^2 w^2 before less that after, so twice the kinetic
    // energy over the mass.
    let mut damped = V::ZERO;
    let rotates = has_spin(transfer);
    let gives_momentum = scatter.is_some_and(Share::has_momentum);
    // G2P: sum S_i u_i, in the place of v_p, or sum S_i dv_i with its moments.
    let (mut moments, mut change) = (Matrix::ZERO, Vector::ZERO);
    if update_velocity && is_affine(transfer) {
        (moments, change) = group.moments::<true>(&visit.window.change);
    } else if update_velocity && rotates {
        (moments, change) = group.moments::<false>(&visit.window.change);
    } else if update_velocity || smooth {
        change = group.interpolate(if smooth { &visit.window.integrated } else { &visit.window.change });
    }
    if smooth {
        state.velocity = change;
    } else if update_velocity || advect || gives_momentum {
        state.velocity = members.vector::<V>(ColumnStart::<D>::VELOCITY);
    }
    // By velocities of a second P2G, which are not quite their own.
    let carries = advect && !update_velocity && is_affine(transfer);
    let turns = update_stress && (settle || carries);
    if !smooth && (update_velocity || gives_momentum || turns) {
        state.spin = members.spin::<V>();
    }
    if !smooth && (update_velocity || gives_momentum || carries) {
        state.strain_rate = members.strain_rate::<V>();
    }
    // v_p += sum S_i dv_i, or what else the transfer takes.
    if update_velocity {
        let scale = constants.cell / gyration_squared;
        let given = of_transfer!(transfer, Rule => Rule::gradient::<V, D>(&state, V::ZERO));
        of_transfer!(transfer, Rule => Rule::take_change(&mut state, change, (&moments, scale)));
        if pic > T::ZERO {
            let before = kinetic(&state, gyration_squared);
            let (gradient, mean) = if is_affine(transfer) {
                let (moments, mean) = group.moments::<true>(&visit.window.integrated);
                (Apic::taken(&given, (&moments, &group.spread()), (constants.cell, scale)), mean)
            } else {
                let (gradient, mean) = group.flow(&visit.window.integrated);
                (gradient * constants.per_cell, mean)
            };
            of_transfer!(transfer, Rule => Rule::take_share(&mut state, (mean, &gradient), V::splat(pic)));
            damped = before - kinetic(&state, gyration_squared);
        }
        let VelocityState { velocity, spin, strain_rate } = &state;
        sound.require(finite(&spin.0) & finite(&velocity.0) & finite(&strain_rate.0), FaultKind::NotFinite);
    }

    let dilates = scatter == Some(Share::Dilatation);
    let mut deformation = Matrix::ZERO;
    let mut stress = Symmetric::ZERO;
    let mut history = HistoryOfGroup::new(members);
    let [mut jacobian, mut volume, mut modulus] = [V::ZERO; 3];
    // Whether the law says with the stress how fast waves are: where it sees F as it is.
    let mut stiffens = false;
    // sum S_i v_i of the velocities that strain and move.
    let mut flow = Vector::ZERO;
    // Whether the stress gives forces to the nodes.
    let pushes = scatter.is_some_and(Share::has_force);
    if update_stress || advect {
        deformation = members.deformation::<V>();
    }
    if update_stress || pushes || scatter == Some(Share::MeanStress) {
        stress = members.stress::<V>();
    }
    // What the law sees of F, where that is not all.
    let natural = if update_stress || advect { members.natural::<V>(constants.expansion) } else { None };
    let mut bulk = V::ZERO;
    if viscosity.is_some() && (update_stress || pushes) {
        bulk = members.viscosity::<V>();
    }
    // G2P: h L, then F = (I + L dt) F and sigma = law(F).
    let (mut gradient, mut mean) = (Matrix::ZERO, Vector::ZERO);
    if update_stress || dilates {
        (gradient, mean) = group.flow(&visit.window.flow);
    }
    if update_stress {
        let step = V::splat(dt) * constants.per_cell;
        flow = mean;
        if !visit.means.is_empty() {
            let rate = group.interpolate_mean(&visit.window.flow) * constants.cell;
            let more = (rate - gradient.trace()) * V::of(1.0 / D as f64);
            for i in 0..D {
                gradient.0[i][i] += more;
            }
        }
        if turns {
            let spin = state.spin;
            if settle {
                let gradient = gradient * constants.per_cell;
                let time = V::splat(dt * T::of(SETTLES_EVERY as f64));
                state.spin = of_transfer!(transfer, Rule => Rule::settle::<V, D>(spin, &gradient, time));
            }
            if carries {
                let (moments, _) = group.moments::<true>(&visit.window.flow);
                state.spin =
                    Apic::carried(&state, &moments, V::splat(dt) * constants.cell / gyration_squared);
            }
            damped += gyration_squared * spin.dot(spin) - gyration_squared * state.spin.dot(state.spin);
            sound.require(finite(&state.spin.0), FaultKind::NotFinite);
        }
        let increment = Matrix::IDENTITY + gradient * step;
        deformation = increment * deformation;
        jacobian = deformation.det();
        sound.require(finite(&[jacobian]), FaultKind::NotFinite);
        sound.require(jacobian.at_least(V::splat(T::TINY)), FaultKind::Inverted);
        volume = members.mass::<V>() * constants.per_density * jacobian;
        if V::COUNT == 1
            && let Some(kind) = sound.fault::<V>()
        {
            members.store_for_report((&deformation, volume), kind);
            return Err(kind);
        }
        let mut motion = Motion { deformation, jacobian, increment, stress, dt: V::splat(dt) };
        let thickness_is_free = D == 2 && visit.matter.thickness == Thickness::Free;
        if let Some(natural) = &natural {
            motion = if const { D == 2 } && thickness_is_free {
                natural.seen_with_free_thickness(&motion)
            } else {
                natural.seen(&motion)
            };
        }
        // A constant block, so that thickening is not compiled for registers of space.
        if const { D == 2 } && thickness_is_free {
            let Thickening { stretch, found } = constants.material.thickening(&motion, &history);
            sound.require(found, FaultKind::NoThickness);
            motion = motion.thickened(stretch);
            let stretch = natural.as_ref().map_or(stretch, |natural| natural.thickening(stretch));
            deformation.0[2][2] *= stretch;
            jacobian *= stretch;
        }
        stiffens = advect && natural.is_none() && !thickness_is_free;
        (stress, modulus) = constants.material.respond_with_modulus((&motion, stiffens), &mut history);
        history.changed = true;
        if let Some(BulkViscosity { coefficients }) = viscosity {
            let seen = (&natural, &deformation, jacobian);
            let modulus = wave_modulus(&constants.material, visit.matter.thickness, seen, &history);
            let (speed, rate) = ((modulus * constants.per_density).sqrt(), gradient.trace());
            let over_density = BulkViscosity::<T>::over_density(coefficients.map(V::splat), rate, speed);
            // The forces of this step were made with the one before, those of the next are made with this one.
            let before = bulk * constants.per_density;
            bulk = over_density / (constants.per_density * jacobian);
            damped -= (before * jacobian + over_density) * (rate * step);
        }
        sound.require(finite(&stress.0), FaultKind::NotFinite);
        volume = members.mass::<V>() * constants.per_density * jacobian;
    } else {
        if advect {
            jacobian = deformation.det();
        }
        if pushes || scatter == Some(Share::MeanStress) {
            volume = members.load::<V>(ColumnStart::<D>::VOLUME);
        }
    }

    // x += v dt; who leaves its cell, and how fast the fastest signal is.
    let mut inside = u32::MAX;
    if advect {
        if !update_stress {
            flow = group.interpolate(&visit.window.flow);
        }
        let moved = position + flow * V::splat(dt);
        sound.require(finite(&moved.0), FaultKind::NotFinite);
        let cells = constants.in_cells(&moved);
        for i in 0..D {
            let reach = B::reach(cells[i], half_side);
            inside &= reach.at_least(base[i]) & !reach.at_least(base[i] + V::ONE);
            if let Some([min, max]) = &constants.domain {
                sound.require(moved[i].at_least(min[i]) & max[i].at_least(moved[i]), FaultKind::Escaped);
            }
        }
        if !every::<V>(inside) {
            let far = V::splat(T::of(f64::from(crate::grid::MOST_CELLS - 1)));
            for i in 0..D {
                let reach = B::reach(cells[i], half_side);
                sound.require(reach.at_least(-far) & far.at_least(reach), FaultKind::Escaped);
            }
        }
        if let Some(kind) = sound.fault::<V>() {
            if V::COUNT == 1 && kind == FaultKind::Escaped {
                members.store_vector(ColumnStart::<D>::POSITION, &moved);
            }
            return Err(kind);
        }
        members.store_vector(ColumnStart::<D>::POSITION, &moved);
        members.give_back::<V>(ColumnStart::<D>::POSITION..ColumnStart::<D>::VELOCITY);
        let seen = (&natural, &deformation, jacobian);
        if !stiffens {
            modulus = wave_modulus(&constants.material, visit.matter.thickness, seen, &history);
        }
        let squares = [modulus * constants.per_density, state.velocity.dot(state.velocity)];
        if !every::<V>(no_faster(squares, V::splat(visit.found.signal))) {
            let signals = signal_speed(squares).numbers();
            for &signal in &signals.0[..V::COUNT] {
                visit.found.signal = visit.found.signal.max(signal);
            }
        }
    }
    if let Some(kind) = sound.fault::<V>() {
        return Err(kind);
    }
    // No fault: what changed goes back to memory.
    if update_velocity {
        members.store_vector(ColumnStart::<D>::VELOCITY, &state.velocity);
        members.give_back::<V>(ColumnStart::<D>::VELOCITY..ColumnStart::<D>::SPIN);
        members.store_strain_rate(&state.strain_rate);
    }
    if (update_velocity && pic > T::ZERO) || turns || (update_stress && viscosity.is_some()) {
        let energies = (damped * members.mass::<V>()).numbers();
        for &energy in &energies.0[..members.count().min(V::COUNT)] {
            visit.damped += 0.5 * energy.f64();
        }
    }
    if update_velocity || turns {
        members.store_spin(&state.spin);
        members.give_back::<V>(ColumnStart::<D>::SPIN..ColumnStart::<D>::MASS);
    }
    if update_stress {
        members.store_deformation(&deformation);
        members.store_stress(&stress);
        members.give_back::<V>(ColumnStart::<D>::DEFORMATION..ColumnStart::<D>::START);
        members.store_viscosity(bulk);
        members.store(ColumnStart::<D>::VOLUME, volume);
        members.give_back::<V>(ColumnStart::<D>::VOLUME..ColumnStart::<D>::VOLUME + 1);
        history.store::<V>();
    }
    // P2G: m, m (v + G (x_i - x_p)), -V sigma grad S.
    if let Some(share) = scatter {
        let mut load = ScatterTerms { momentum: None, stress: None };
        if gives_momentum {
            let mass = members.mass::<V>();
            let half_step = V::splat(T::HALF * dt);
            let gradient = of_transfer!(transfer, Rule => Rule::gradient::<V, D>(&state, half_step));
            load.momentum = Some(Momentum {
                own: state.velocity * mass,
                per_cell: gradient * (mass * constants.cell),
                mass: if share == Share::Momentum { V::ZERO } else { mass },
            });
        }
        if pushes {
            let mut pull = stress * (volume * constants.per_cell);
            if viscosity.is_some() {
                for i in 0..D {
                    pull.0[i] -= bulk * (volume * constants.per_cell);
                }
            }
            if !visit.means.is_empty() {
                let mass = members.mass::<V>();
                let more =
                    mass * group.interpolate_mean(&visit.window.flow) - mean_stress::<V, D>(&stress, volume);
                for i in 0..D {
                    pull.0[i] += more * constants.per_cell;
                }
            }
            load.stress = Some(pull);
        }
        if share.is_averaged() {
            let sum = match share {
                Share::MeanStress => mean_stress::<V, D>(&stress, volume),
                _ => members.mass::<V>() * (gradient.trace() * constants.per_cell),
            };
            load.momentum = Some(Momentum { own: Vector::ZERO, per_cell: Matrix::ZERO, mass: sum });
        }
        group.scatter::<M>(visit.window, &load);
    }
    Ok(inside)
}

/// Stiffness against the fastest wave, times J [Pa].
#[inline(always)]
fn wave_modulus<V: Lanes>(
    material: &Material<V>,
    thickness: Thickness,
    (natural, deformation, jacobian): (&Option<Natural<V>>, &Matrix<V>, V),
    history: &impl Recall<V>,
) -> V {
    let elastic;
    let (deformation, jacobian) = match natural {
        None => (deformation, jacobian),
        Some(natural) => {
            elastic = natural.elastic(deformation, jacobian);
            (&elastic.0, elastic.1)
        }
    };
    let modulus = material.wave_modulus(thickness, (deformation, jacobian), history);
    match natural {
        None => modulus,
        Some(natural) => modulus / natural.volume,
    }
}

/// V tr_D(sigma) / D [J]
#[inline(always)]
fn mean_stress<V: Lanes, const D: usize>(stress: &Symmetric<V>, volume: V) -> V {
    let mut sum = V::ZERO;
    for i in 0..D {
        sum += stress.0[i];
    }
    sum * (volume * V::of(1.0 / D as f64))
}

/// Which particles of a group have no fault.
struct Sound {
    lanes: u32,
    /// The first fault of the first lane.
    first: Option<FaultKind>,
}

impl Sound {
    const EVERYTHING: Self = Sound { lanes: u32::MAX, first: None };

    /// Demands a bit of every lane.
    #[inline(always)]
    fn require(&mut self, lanes: u32, kind: FaultKind) {
        self.lanes &= lanes;
        if self.first.is_none() && lanes & 1 == 0 {
            self.first = Some(kind);
        }
    }

    /// The first fault of a single lane; of several lanes any fault, if there is one.
    #[inline(always)]
    fn fault<V: Lanes>(&self) -> Option<FaultKind> {
        if every::<V>(self.lanes) {
            return None;
        }
        Some(if V::COUNT == 1 { self.first.unwrap_or(FaultKind::NotFinite) } else { FaultKind::NotFinite })
    }
}

/// v^2 + k^2 w^2 + k^2/2 |E|^2, with the square of the radius of gyration and the rate of strain that its transfer
/// keeps.
#[inline(always)]
fn kinetic<V: Lanes, const D: usize>(state: &VelocityState<V, D>, gyration: V) -> V {
    let VelocityState { velocity, spin, strain_rate } = state;
    let strains = V::HALF * strain_rate.double_dot(strain_rate);
    gyration.times_plus(spin.dot(*spin) + strains, velocity.dot(*velocity))
}

/// Whether the bits of all lanes are set.
#[inline(always)]
pub fn every<V: Lanes>(bits: u32) -> bool {
    let all = (1 << V::COUNT) - 1;
    bits & all == all
}

/// Lanes in which every number is finite; their sum must be, too.
#[inline(always)]
fn finite<V: Lanes>(numbers: &[V]) -> u32 {
    let mut sum = V::ZERO;
    for &x in numbers {
        sum += x;
    }
    V::splat(V::Real::LARGEST).at_least(sum.abs())
}
