//! A law from outside this crate: an object that takes one particle at a time, in double precision.
//!
//! The laws of the list are compiled for several particles at a time; this one is called for each.
//! Its history lies in columns like any other.

use super::{
    BadConstants, Entries, History, Isotropic, Keep, Law, LawOverArrays, MOST_HISTORY, Motion, Recall,
    Response, history, history_entries,
};
use crate::tensor::{Matrix, Number, Symmetric, array};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::marker::PhantomData;

/// A law that a user of this crate writes: [`Law`] for one particle in double precision, as an object.
///
/// Put it into a scene by [`super::Material::custom`]. All quantities are in SI units, tension is positive.
pub trait CustomLaw: std::fmt::Debug + Send + Sync {
    /// Its name in manifests and errors, one word.
    fn name(&self) -> &'static str;

    /// Key of its material under which scene files name it, by default its name.
    fn key(&self) -> &'static str {
        self.name()
    }

    /// Its constants by their names, which manifests record beside its elastic moduli.
    fn constants(&self) -> Vec<(String, f64)> {
        Vec::new()
    }

    /// Whether it can be asked.
    ///
    /// # Errors
    /// What is wrong with it.
    fn check(&self) -> Result<(), BadConstants> {
        Ok(())
    }

    /// The law over arrays, if it takes all particles of a body at once; not in plane stress.
    fn over_arrays(&self) -> Option<&dyn LawOverArrays> {
        None
    }

    /// The columns that it remembers, with at most [`MOST_HISTORY`] components in space together. Their names must
    /// differ from those that all particles and files have ([`crate::column::reserved`]), and from those that other
    /// laws of the scene give to columns of another kind.
    fn history(&self) -> &'static [History] {
        &[]
    }

    /// Elastic moduli at small strain, of a sudden strain where they depend on time [Pa].
    fn elastic(&self) -> Isotropic<f64>;

    /// Cauchy stress at the end of the step [Pa]; `history` is that at its start, the components in space of one column
    /// after the other, to be changed into that at its end.
    ///
    /// It must depend on nothing else: plane stress asks several times for one step.
    fn respond(&self, motion: &Motion<f64>, history: &mut [f64]) -> Symmetric<f64>;

    /// Strain energy per undeformed volume [J/m^3].
    fn strain_energy(&self, deformation: &Matrix<f64>, stress: &Symmetric<f64>, history: &[f64]) -> f64;

    /// What the material dissipated so far per undeformed volume [J/m^3].
    fn dissipation(&self, _history: &[f64]) -> f64 {
        0.0
    }

    /// Stiffness against a longitudinal wave in the present state, times J [Pa];
    /// too small a value makes the step unstable.
    fn wave_modulus(&self, _deformation: &Matrix<f64>, jacobian: f64, _history: &[f64]) -> f64 {
        self.elastic().p_wave_modulus() * jacobian
    }

    /// Stiffness against a shear wave in the present state, times J [Pa].
    fn shear_modulus(&self, _deformation: &Matrix<f64>, jacobian: f64, _history: &[f64]) -> f64 {
        self.elastic().shear_modulus * jacobian
    }

    /// [`Law::trusts_deformation`]
    fn trusts_deformation(&self) -> bool {
        true
    }
}

/// A [`CustomLaw`] in other numbers.
#[derive(Clone, Copy, Debug)]
pub struct Custom<T> {
    law: &'static dyn CustomLaw,
    numbers: PhantomData<T>,
}

impl<T> Custom<T> {
    /// The law for several particles, one by one.
    pub fn new(law: &'static dyn CustomLaw) -> Self {
        Custom { law, numbers: PhantomData }
    }

    /// The law itself.
    pub fn law(&self) -> &'static dyn CustomLaw {
        self.law
    }
}

impl<T: Number> Custom<T> {
    /// The components in space of a particle's history, from where it is kept.
    pub fn recalled(&self, from: &impl Recall<T>) -> [T; MOST_HISTORY] {
        history::recalled(self.law.history(), from)
    }

    /// Keeps the components in space of a particle's history.
    pub fn keep(&self, components: &[T; MOST_HISTORY], to: &mut impl Keep<T>) {
        history::kept(self.law.history(), components, to);
    }
}

/// The same object.
impl<T> PartialEq for Custom<T> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::addr_eq(self.law, other.law) && self.law.name() == other.law.name()
    }
}

impl<T> Serialize for Custom<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Isotropic { bulk_modulus, shear_modulus } = self.law.elastic();
        let mut table = serializer.serialize_map(None)?;
        table.serialize_entry("law", self.law.name())?;
        table.serialize_entry("bulk_modulus", &bulk_modulus)?;
        table.serialize_entry("shear_modulus", &shear_modulus)?;
        for (name, value) in self.law.constants() {
            table.serialize_entry(&name, &value)?;
        }
        table.end()
    }
}

/// Lanes of any processor.
const MOST_LANES: usize = 8;

/// The state of some particles, each in a lane, and then what a law says of it.
struct LawState {
    deformation: [[f64; MOST_LANES]; 9],
    increment: [[f64; MOST_LANES]; 9],
    stress: [[f64; MOST_LANES]; 6],
    jacobian: [f64; MOST_LANES],
    dt: f64,
    history: [[f64; MOST_LANES]; MOST_HISTORY],
    /// An energy or a stiffness.
    answer: [f64; MOST_LANES],
}

/// What a law is asked.
#[derive(Clone, Copy)]
enum Question {
    Response,
    StrainEnergy,
    Dissipation,
    WaveModulus,
    ShearModulus,
}

/// Writes the lanes of a number.
#[inline(always)]
fn spread<T: Number>(number: T, to: &mut [f64; MOST_LANES]) {
    for (lane, to) in to.iter_mut().enumerate().take(T::SIDE_BY_SIDE) {
        *to = number.lane(lane);
    }
}

#[inline(always)]
fn collected<T: Number>(from: &[f64; MOST_LANES]) -> T {
    T::from_lanes(|lane| from[lane])
}

impl LawState {
    const NONE: Self = LawState {
        deformation: [[0.0; MOST_LANES]; 9],
        increment: [[0.0; MOST_LANES]; 9],
        stress: [[0.0; MOST_LANES]; 6],
        jacobian: [0.0; MOST_LANES],
        dt: 0.0,
        history: [[0.0; MOST_LANES]; MOST_HISTORY],
        answer: [0.0; MOST_LANES],
    };

    #[inline(always)]
    fn new<T: Number>(deformation: &Matrix<T>, history: &[T; MOST_HISTORY], components: usize) -> Self {
        let mut state = Self::NONE;
        for i in 0..3 {
            for j in 0..3 {
                spread(deformation.0[i][j], &mut state.deformation[3 * i + j]);
            }
        }
        for (&number, to) in history.iter().zip(&mut state.history).take(components) {
            spread(number, to);
        }
        state
    }

    #[inline(always)]
    fn put_stress<T: Number>(&mut self, stress: &Symmetric<T>) {
        for k in 0..6 {
            spread(stress.0[k], &mut self.stress[k]);
        }
    }

    /// Puts a question to a law for each particle, one after the other.
    #[inline(never)]
    fn ask(&mut self, law: &dyn CustomLaw, question: Question, (lanes, components): (usize, usize)) {
        for lane in 0..lanes {
            let deformation = Matrix::from_fn(|i, j| self.deformation[3 * i + j][lane]);
            let stress = Symmetric(array(0.0, |k| self.stress[k][lane]));
            let jacobian = self.jacobian[lane];
            let mut history: [f64; MOST_HISTORY] = array(0.0, |entry| self.history[entry][lane]);
            let history = &mut history[..components];
            let answer = &mut self.answer[lane];
            match question {
                Question::Response => {
                    let increment = Matrix::from_fn(|i, j| self.increment[3 * i + j][lane]);
                    let motion = Motion { deformation, jacobian, increment, stress, dt: self.dt };
                    let stress = law.respond(&motion, history);
                    for (place, x) in self.stress.iter_mut().zip(stress.0) {
                        place[lane] = x;
                    }
                    for (place, &mut x) in self.history.iter_mut().zip(history) {
                        place[lane] = x;
                    }
                }
                Question::StrainEnergy => *answer = law.strain_energy(&deformation, &stress, history),
                Question::Dissipation => *answer = law.dissipation(history),
                Question::WaveModulus => *answer = law.wave_modulus(&deformation, jacobian, history),
                Question::ShearModulus => *answer = law.shear_modulus(&deformation, jacobian, history),
            }
        }
    }
}

impl<T: Number> Custom<T> {
    /// Components in space of all its columns.
    #[inline(always)]
    pub fn components(&self) -> usize {
        history_entries(self.law.history(), 3).min(MOST_HISTORY)
    }

    #[inline(always)]
    fn answer(&self, state: &mut LawState, question: Question) -> T {
        state.ask(self.law, question, (T::SIDE_BY_SIDE, self.components()));
        collected(&state.answer)
    }
}

impl<T: Number> Law<T> for Custom<T> {
    type History = [T; MOST_HISTORY];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        self.law.history()
    }

    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        self.law.trusts_deformation()
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, history: &[T; MOST_HISTORY]) -> Response<T, [T; MOST_HISTORY]> {
        let components = self.components();
        let mut state = LawState::new(&motion.deformation, history, components);
        for i in 0..3 {
            for j in 0..3 {
                spread(motion.increment.0[i][j], &mut state.increment[3 * i + j]);
            }
        }
        state.put_stress(&motion.stress);
        spread(motion.jacobian, &mut state.jacobian);
        state.dt = motion.dt.lane(0);
        state.ask(self.law, Question::Response, (T::SIDE_BY_SIDE, components));
        let mut next = <[T; MOST_HISTORY]>::ZERO;
        for (next, from) in next.iter_mut().zip(&state.history).take(components) {
            *next = collected(from);
        }
        let stress = Symmetric(array(T::ZERO, |k| collected(&state.stress[k])));
        Response { stress, history: next }
    }

    #[inline(always)]
    fn strain_energy(
        &self,
        deformation: &Matrix<T>,
        stress: &Symmetric<T>,
        history: &[T; MOST_HISTORY],
    ) -> T {
        let mut state = LawState::new(deformation, history, self.components());
        state.put_stress(stress);
        self.answer(&mut state, Question::StrainEnergy)
    }

    #[inline(always)]
    fn dissipation(&self, history: &[T; MOST_HISTORY]) -> T {
        let mut state = LawState::new(&Matrix::ZERO, history, self.components());
        self.answer(&mut state, Question::Dissipation)
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &[T; MOST_HISTORY]) -> T {
        let mut state = LawState::new(deformation, history, self.components());
        spread(jacobian, &mut state.jacobian);
        self.answer(&mut state, Question::WaveModulus)
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &[T; MOST_HISTORY]) -> T {
        let mut state = LawState::new(deformation, history, self.components());
        spread(jacobian, &mut state.jacobian);
        self.answer(&mut state, Question::ShearModulus)
    }
}
