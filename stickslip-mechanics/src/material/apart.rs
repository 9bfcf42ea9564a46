//! What loops over particles ask of a law, each in a function of its own.
//!
//! There is a loop for every dimension, basis, transfer and processor. A law that were inlined into all of them would
//! make the program grow by as much as a transfer, and its build by a minute; [`Number::apart`] compiles it once for
//! each kind of number.

use super::{Law, Motion, Response, Thickening, Thickness, plane_stress};
use crate::number::Task;
use crate::tensor::{Matrix, Number, Symmetric};

struct Respond<'a, T: Number, L: Law<T>> {
    law: &'a L,
    motion: &'a Motion<T>,
    history: &'a L::History,
    waves: bool,
}

impl<T: Number, L: Law<T>> Task for Respond<'_, T, L> {
    type Output = (Response<T, L::History>, T);
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Respond { law, motion, history, waves } = self;
        let response = law.respond(motion, history);
        // Both need the same roots and powers of J.
        let modulus = match waves {
            true => law.wave_modulus(&motion.deformation, motion.jacobian, &response.history),
            false => T::ZERO,
        };
        (response, modulus)
    }
}

/// [`Law::respond`], and [`Law::wave_modulus`] of the state after it if `waves` are asked for.
#[inline(always)]
pub fn respond<T: Number, L: Law<T>>(
    law: &L,
    (motion, waves): (&Motion<T>, bool),
    history: &L::History,
) -> (Response<T, L::History>, T) {
    T::apart(Respond { law, motion, history, waves })
}

struct Thicken<'a, T: Number, L: Law<T>> {
    law: &'a L,
    motion: &'a Motion<T>,
    history: &'a L::History,
}

impl<T: Number, L: Law<T>> Task for Thicken<'_, T, L> {
    type Output = Thickening<T>;
    #[inline(always)]
    fn run(self) -> Thickening<T> {
        plane_stress::thickening(self.law, self.motion, self.history)
    }
}

/// [`plane_stress::thickening`]
#[inline(always)]
pub fn thickening<T: Number, L: Law<T>>(law: &L, motion: &Motion<T>, history: &L::History) -> Thickening<T> {
    T::apart(Thicken { law, motion, history })
}

struct StoredAndDissipated<'a, T: Number, L: Law<T>> {
    law: &'a L,
    deformation: &'a Matrix<T>,
    stress: &'a Symmetric<T>,
    history: &'a L::History,
}

impl<T: Number, L: Law<T>> Task for StoredAndDissipated<'_, T, L> {
    type Output = [T; 2];
    #[inline(always)]
    fn run(self) -> [T; 2] {
        let StoredAndDissipated { law, deformation, stress, history } = self;
        [law.strain_energy(deformation, stress, history), law.dissipation(history)]
    }
}

/// [`Law::strain_energy`] and [`Law::dissipation`]
#[inline(always)]
pub fn energies<T: Number, L: Law<T>>(
    law: &L,
    (deformation, stress): (&Matrix<T>, &Symmetric<T>),
    history: &L::History,
) -> [T; 2] {
    T::apart(StoredAndDissipated { law, deformation, stress, history })
}

struct WaveModulus<'a, T: Number, L: Law<T>> {
    law: &'a L,
    thickness: Thickness,
    deformation: &'a Matrix<T>,
    jacobian: T,
    history: &'a L::History,
}

impl<T: Number, L: Law<T>> Task for WaveModulus<'_, T, L> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        let WaveModulus { law, thickness, deformation, jacobian, history } = self;
        let waves = law.wave_modulus(deformation, jacobian, history);
        match thickness {
            Thickness::Moved => waves,
            Thickness::Free => {
                plane_stress::plate_modulus(waves, law.shear_modulus(deformation, jacobian, history))
            }
        }
    }
}

/// [`Law::wave_modulus`], in plane stress that of a plate.
#[inline(always)]
pub fn wave_modulus<T: Number, L: Law<T>>(
    law: &L,
    thickness: Thickness,
    (deformation, jacobian): (&Matrix<T>, T),
    history: &L::History,
) -> T {
    T::apart(WaveModulus { law, thickness, deformation, jacobian, history })
}
