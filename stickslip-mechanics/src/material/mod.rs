//! Constitutive laws: pure functions from local motion to Cauchy stress, one file each, and the list of them.
//!
//! To add a law: write its file (what it declares, [`Law`], tests) and put its line on the list below. Scene files,
//! schema, checks, the engine, snapshots and pictures find it there, with its constants and its history.

mod apart;
mod custom;
mod declaration;
mod elastic;
mod history;
mod initial;
mod outside;
mod plane_stress;
mod principal;
mod soil;

pub use custom::{Custom, CustomLaw};
pub use declaration::{
    ANGLE, Absent, AllowedRange, BadConstants, Constant, ConstantUnit, Declared, Description, End, Form,
    Given, Quantity,
};
pub use elastic::Isotropic;
pub use history::{AtRest, Entries, History, Keep, MOST_HISTORY, Recall, history_entries};
pub use initial::NoStretch;
pub use outside::{LawArrays, LawOverArrays, OUTSIDE_CONSTANTS, outside_law};
pub use plane_stress::{Thickening, Thickness};

use crate::tensor::{Matrix, Number, Real, Symmetric};
use serde::Serialize;

/// The list of laws, each by its file and its type, becomes the modules, [`Material`], [`LAWS`] and `of_law!`, which
/// does one thing with whichever law a material has.
macro_rules! laws {
    ($d:tt $($file:ident $law:ident;)*) => {
        $(mod $file; pub use $file::$law;)*

        /// A law with its constants.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Material<T> {
            $(#[doc = concat!("See [`", stringify!($law), "`].")] $law($law<T>),)*
            /// See [`CustomLaw`]; scene files can only name it.
            Custom(Custom<T>),
        }

        /// Every law that a scene file can name.
        pub const LAWS: &[Description] = &[$(Description {
            name: stringify!($file),
            summary: <$law<f64> as Declared>::SUMMARY,
            constants: <$law<f64> as Declared>::CONSTANTS,
            build: |given| Ok(Material::$law(Declared::build(given)?)),
        }),*];

        macro_rules! of_law {
            ($d material:expr, $d law:ident => $d does:expr) => {
                match $d material {
                    $(Material::$law($d law) => $d does,)*
                    Material::Custom($d law) => $d does,
                }
            };
        }

        impl Material<f64> {
            /// Key of its law in scene files.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Material::$law(_) => stringify!($file),)*
                    Material::Custom(custom) => custom.law().key(),
                }
            }

            /// Elastic moduli at small strain, of a sudden strain where they depend on time.
            pub fn elastic(&self) -> Isotropic<f64> {
                match self {
                    $(Material::$law(law) => Declared::elastic(law),)*
                    Material::Custom(custom) => custom.law().elastic(),
                }
            }

            /// Its constants, as [`Description::build`] takes them; none of a law from outside.
            pub fn given(&self) -> Given {
                match self {
                    $(Material::$law(law) => Declared::given(law),)*
                    Material::Custom(_) => Given::default(),
                }
            }

            /// The material for cells of this side [m].
            ///
            /// # Errors
            /// Cells for which its law has no answer.
            pub fn on_grid(self, cell: f64) -> Result<Self, BadConstants> {
                Ok(match self {
                    $(Material::$law(law) => Material::$law(law.on_grid(cell)?),)*
                    Material::Custom(_) => self,
                })
            }
        }

        impl<T: Number> Material<T> {
            /// The same material with its constants in other numbers.
            #[inline(always)]
            pub fn map<U: Number>(&self, f: impl Fn(T) -> U) -> Material<U> {
                match self {
                    $(Material::$law(law) => Material::$law(law.map(f)),)*
                    Material::Custom(custom) => Material::Custom(Custom::new(custom.law())),
                }
            }
        }
    };
}

laws! { $
    neo_hookean NeoHookean;
    hypoelastic Hypoelastic;
    hencky Hencky;
    mooney_rivlin MooneyRivlin;
    ogden Ogden;
    fluid Fluid;
    johnson_cook JohnsonCook;
    armstrong_frederick ArmstrongFrederick;
    von_mises VonMises;
    crushable_foam CrushableFoam;
    viscoelastic Viscoelastic;
    damage Damage;
    drucker_prager DruckerPrager;
    modified_cam_clay ModifiedCamClay;
    mohr_coulomb MohrCoulomb;
    mu_i MuI;
}

/// What a law is told of a particle's step.
#[derive(Clone, Copy, Debug)]
pub struct Motion<T> {
    /// Deformation gradient F at the end of the step [-].
    pub deformation: Matrix<T>,
    /// Determinant of F, positive [-].
    pub jacobian: T,
    /// Deformation of this step alone, I + L dt [-].
    pub increment: Matrix<T>,
    /// Cauchy stress at the start of the step, tension positive [Pa].
    pub stress: Symmetric<T>,
    /// How long the step takes [s].
    pub dt: T,
}

impl<T: Number> Motion<T> {
    /// The motion with another stretch out of the plane in its step.
    #[inline(always)]
    pub fn thickened(&self, stretch: T) -> Self {
        let mut motion = *self;
        motion.increment.0[2][2] *= stretch;
        motion.deformation.0[2][2] *= stretch;
        motion.jacobian *= stretch;
        motion
    }
}

/// What a law answers.
#[derive(Clone, Copy, Debug)]
pub struct Response<T, H> {
    /// Cauchy stress at the end of the step, tension positive [Pa].
    pub stress: Symmetric<T>,
    /// History at the end of the step.
    pub history: H,
}

/// A constitutive law in three dimensions.
///
/// A law is written once over [`Number`], with no branch on the motion:
/// the engine calls it for several particles at a time.
pub trait Law<T: Number>: Copy + Send + Sync {
    /// What it remembers of a particle: `[T; N]`, the components in space of all columns of [`Law::history`],
    /// one after the other.
    type History: Entries<T>;

    /// The columns that it remembers.
    fn history(&self) -> &'static [History];

    /// Stress and history at the end of the step, from those at its start, its strain and its duration.
    fn respond(&self, motion: &Motion<T>, history: &Self::History) -> Response<T, Self::History>;

    /// Strain energy per undeformed volume in a state of deformation, Cauchy stress and history [J/m^3]. Laws that know
    /// it from F ignore the stress; laws in rate form know it from the stress alone.
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, history: &Self::History) -> T;

    /// What the material dissipated so far per undeformed volume [J/m^3].
    #[inline(always)]
    fn dissipation(&self, _history: &Self::History) -> T {
        T::ZERO
    }

    /// Stiffness against a longitudinal wave in the present state, times J [Pa]: over the undeformed density it is the
    /// squared wave speed. The stable step rests on it, so it should be that of the stiffest direction or above,
    /// and not below [`Law::shear_modulus`]; at rest it is K + 4G/3.
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &Self::History) -> T;

    /// Stiffness against a shear wave in the present state, times J [Pa]; plane stress needs it for its waves.
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &Self::History) -> T;

    /// Whether stress resists every error of F, so that it stays small and surfaces may be found by F. Where it does
    /// not, as in plastic flow, contact finds surfaces by means of positions, and stretch is judged less strictly.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        true
    }
}

impl Material<f64> {
    /// The same material in the precision of the engine.
    pub fn cast<T: Real>(&self) -> Material<T> {
        self.map(T::of)
    }

    /// Whether its constants are within the bounds that its law declares, and what its law remembers has names of its
    /// own.
    ///
    /// # Errors
    /// A constant that is not, or several that do not fit; a history whose name is taken, or too much of it.
    pub fn check(&self) -> Result<(), BadConstants> {
        history::check(self.history())?;
        if let Material::Custom(custom) = self {
            return custom.law().check();
        }
        let law = LAWS.iter().find(|law| law.name == self.name()).expect("the list has every law");
        law.build(&self.given()).map(|_| ())
    }

    /// A law from outside this crate, for a scene that is built in code.
    pub fn custom(law: &'static dyn CustomLaw) -> Self {
        Material::Custom(Custom::new(law))
    }
}

impl<T: Number> Material<T> {
    /// The columns that a particle of it has beside those that all have.
    #[inline(always)]
    pub fn history(&self) -> &'static [History] {
        of_law!(self, law => law.history())
    }

    /// [`Law::trusts_deformation`]
    #[inline(always)]
    pub fn trusts_deformation(&self) -> bool {
        of_law!(self, law => law.trusts_deformation())
    }

    /// [`Law::respond`] with a history where it is kept.
    #[inline(always)]
    pub fn respond(&self, motion: &Motion<T>, history: &mut impl Keep<T>) -> Symmetric<T> {
        self.respond_with_modulus((motion, false), history).0
    }

    /// The same, with [`Law::wave_modulus`] of the state after it if `waves` are asked for, else zero: for less than
    /// the two one after the other. It sees the history as the law gave it, also what a plane scene does not keep.
    #[inline(always)]
    pub fn respond_with_modulus(
        &self,
        (motion, waves): (&Motion<T>, bool),
        history: &mut impl Keep<T>,
    ) -> (Symmetric<T>, T) {
        of_law!(self, law => {
            let recalled = history::recalled(law.history(), history);
            let (response, modulus) = apart::respond(law, (motion, waves), &recalled);
            history::kept(law.history(), &response.history, history);
            (response.stress, modulus)
        })
    }

    /// By how much the thickness grows in a step that leaves no stress out of the plane; the motion has the thickness
    /// before it.
    #[inline(always)]
    pub fn thickening(&self, motion: &Motion<T>, history: &impl Recall<T>) -> Thickening<T> {
        of_law!(self, law => apart::thickening(law, motion, &history::recalled(law.history(), history)))
    }

    /// [`Law::strain_energy`] and [`Law::dissipation`]
    #[inline(always)]
    pub fn energies(
        &self,
        deformation: &Matrix<T>,
        stress: &Symmetric<T>,
        history: &impl Recall<T>,
    ) -> [T; 2] {
        of_law!(self, law => {
            apart::energies(law, (deformation, stress), &history::recalled(law.history(), history))
        })
    }

    /// Stiffness against the fastest wave in the present state, times J [Pa]: [`Law::wave_modulus`],
    /// in plane stress that of a plate.
    #[inline(always)]
    pub fn wave_modulus(
        &self,
        thickness: Thickness,
        (deformation, jacobian): (&Matrix<T>, T),
        history: &impl Recall<T>,
    ) -> T {
        of_law!(self, law => {
            let history = history::recalled(law.history(), history);
            apart::wave_modulus(law, thickness, (deformation, jacobian), &history)
        })
    }

    /// Stiffness against the fastest wave before anything moves [Pa].
    pub fn wave_modulus_at_rest(&self, thickness: Thickness) -> T {
        self.wave_modulus(thickness, (&Matrix::IDENTITY, T::ONE), &AtRest(self.history()))
    }
}

impl<T: Real> Material<T> {
    /// The motion with the thickness that the particle takes, and the stress after it; `None` if no thickness is free
    /// of stress, and then its history stays as it was.
    pub fn respond_with(
        &self,
        thickness: Thickness,
        motion: Motion<T>,
        history: &mut impl Keep<T>,
    ) -> Option<(Motion<T>, Symmetric<T>)> {
        let mut motion = motion;
        if thickness == Thickness::Free {
            let Thickening { stretch, found } = self.thickening(&motion, history);
            if found == 0 {
                return None;
            }
            motion = motion.thickened(stretch);
        }
        let stress = self.respond(&motion, history);
        Some((motion, stress))
    }
}

#[cfg(test)]
pub(crate) mod trials;

#[cfg(test)]
mod tests {
    use super::*;

    /// Displacement gradients of moderate size in every direction.
    pub fn sample_gradients() -> Vec<Matrix<f64>> {
        vec![
            Matrix([[0.1, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
            Matrix([[0.0, 0.2, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
            Matrix([[-0.1, 0.05, 0.02], [0.07, 0.12, -0.03], [-0.04, 0.06, 0.08]]),
        ]
    }

    /// The motion that leads to `f` in one step from rest.
    pub fn motion_of(f: Matrix<f64>) -> Motion<f64> {
        Motion { deformation: f, jacobian: f.det(), increment: f, stress: Symmetric::ZERO, dt: 1.0 }
    }

    /// The state and history after a motion from rest in equal steps of a duration,
    /// and the work of the stress per undeformed volume.
    pub fn follow<L: Law<f64>>(
        law: &L,
        (steps, duration): (usize, f64),
        at: impl Fn(f64) -> Matrix<f64>,
    ) -> (Motion<f64>, L::History, f64) {
        let mut now = Motion { dt: duration / steps as f64, ..motion_of(Matrix::IDENTITY) };
        let (mut history, mut work) = (L::History::ZERO, 0.0);
        for i in 1..=steps {
            let deformation = at(i as f64 / steps as f64);
            let increment = deformation * now.deformation.inverse();
            let jacobian = deformation.det();
            let motion = Motion { deformation, jacobian, increment, ..now };
            let response = law.respond(&motion, &history);
            // Half a step's Jacobian and stress, and the strain at its middle.
            let middle = (increment - Matrix::IDENTITY) * (increment + Matrix::IDENTITY).inverse() * 2.0;
            let mean = (response.stress * jacobian + now.stress * now.jacobian) * 0.5;
            work += mean.double_dot(&middle.symmetric_part());
            now = Motion { stress: response.stress, ..motion };
            history = response.history;
        }
        (now, history, work)
    }

    /// sigma = (K - 2G/3) tr(e) I + 2 G e
    pub fn hooke(elastic: &Isotropic<f64>, strain: &Symmetric<f64>) -> Symmetric<f64> {
        let lame = elastic.bulk_modulus - 2.0 / 3.0 * elastic.shear_modulus;
        Symmetric::isotropic(lame * strain.trace()) + *strain * (2.0 * elastic.shear_modulus)
    }

    /// A turn by 0.7 rad about (1, 2, 2)/3, after Rodrigues.
    pub fn rotation() -> Matrix<f64> {
        let n = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
        let k = Matrix([[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]]);
        let angle: f64 = 0.7;
        Matrix::IDENTITY + k * angle.sin() + k * k * (1.0 - angle.cos())
    }
}
