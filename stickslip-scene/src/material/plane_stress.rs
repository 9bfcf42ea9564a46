//! Plane stress for any law: the thickness that leaves no stress out of the plane.
//!
//! ```text
//! sigma_zz(F') = 0,   F' = diag(1, 1, a) F,   a = F_zz' / F_zz
//! ```
//!
//! A thin plate with free faces. Its particles have the reference thickness one; the thickness is F_zz, so det F is the
//! volume, and the in-plane force of a particle is -V0 det F sigma grad S as in every scene: the stress acts on the
//! present thickness. F is block diagonal, so isotropic laws leave no shear out of the plane, and one unknown is left.

use super::{Law, Motion, Response};
use crate::tensor::{Number, Real};

/// Which thickness a particle takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Thickness {
    /// What its motion says: in space, and in plane strain, where it never changes.
    #[default]
    Moved,
    /// The one without stress out of the plane: plane stress.
    Free,
}

/// A motion with its free thickness, and the response to it.
type Moved<T, H> = (Motion<T>, Response<T, H>);

/// Trials before a law counts as one without an answer; a sound step takes two or three.
const MOST_TRIALS: usize = 300;

/// A stretch with its stress out of the plane.
#[derive(Clone, Copy)]
struct TrialStretch<T> {
    /// a [-]
    stretch: T,
    /// sigma_zz [Pa]
    stress: T,
}

/// The motion with its free thickness, and the response to it; `None` if the law has none.
///
/// `motion` has the thickness of the start of the step, which its increment leaves alone. The first trial is Hooke's,
/// `a = 1 - (1 - 2G/M) tr(dF - I)`, the next are Newton's with M and the secant's; once two trials enclose the answer,
/// none leaves the bracket and every third one halves it, so the search ends for every law whose sigma_zz grows from
/// compression to tension as the thickness does. What is left of sigma_zz is round-off of M; it stays in the stress, so
/// that the next step of a law in rate form makes up for it.
pub(super) fn with_free_thickness<T: Real, L: Law<T>>(
    law: &L,
    motion: &Motion<T>,
    history: &L::History,
) -> Option<Moved<T, L::History>> {
    let (one, two) = (T::ONE, T::of(2.0));
    let waves = law.wave_modulus(&motion.deformation, motion.jacobian, history);
    let shear = law.shear_modulus(&motion.deformation, motion.jacobian, history);
    // sigma_zz by a relative change of thickness.
    let stiffness = waves * (one / motion.jacobian);
    let round_off = T::of(64.0) * T::EPSILON;
    let increment = &motion.increment.0;
    let guess = one - (one - two * shear / waves) * (increment[0][0] + increment[1][1] - two);
    let mut stretch = guess.max(T::HALF).min(two);
    let (mut before, mut too_thin, mut too_thick): (Option<TrialStretch<T>>, Option<T>, Option<T>) =
        (None, None, None);
    for count in 1..=MOST_TRIALS {
        let trial = stretched(motion, stretch);
        let response = law.respond(&trial, history);
        let now = TrialStretch { stretch, stress: response.stress.0[2] };
        if !now.stress.is_finite() {
            return None;
        }
        *(if now.stress < T::ZERO { &mut too_thin } else { &mut too_thick }) = Some(stretch);
        let enclosed = match (too_thin, too_thick) {
            (Some(a), Some(b)) => (a - b).abs() <= T::of(4.0) * T::EPSILON * stretch,
            _ => false,
        };
        if now.stress.abs() <= round_off * stiffness || enclosed {
            return Some((trial, response));
        }
        let newton = stretch * (one - now.stress / stiffness);
        let next =
            before.map_or(newton, |before| secant(before, now)).max(stretch * T::HALF).min(stretch * two);
        stretch = match (too_thin, too_thick) {
            (Some(a), Some(b)) if count % 3 == 0 || !(next > a.min(b) && next < a.max(b)) => {
                (a + b) * T::HALF
            }
            _ if next.is_finite() && next != stretch => next,
            // A flat secant: thicker against compression, thinner against tension.
            _ if now.stress < T::ZERO => stretch * two,
            _ => stretch * T::HALF,
        };
        before = Some(now);
    }
    None
}

/// The motion with another stretch out of the plane.
fn stretched<T: Real>(motion: &Motion<T>, stretch: T) -> Motion<T> {
    let mut motion = *motion;
    motion.increment.0[2][2] = stretch;
    motion.deformation.0[2][2] *= stretch;
    motion.jacobian *= stretch;
    motion
}

fn secant<T: Real>(a: TrialStretch<T>, b: TrialStretch<T>) -> T {
    b.stretch - b.stress * ((b.stretch - a.stretch) / (b.stress - a.stress))
}

/// Stiffness against the fastest wave of a thin plate, from those against longitudinal and shear waves,
/// all times J [Pa].
///
/// ```text
/// M - (M - 2G)^2 / M = 4 G (1 - G/M)          at rest E/(1 - nu^2)
/// ```
#[inline(always)]
pub(super) fn plate_modulus<T: Number>(waves: T, shear: T) -> T {
    T::of(4.0) * shear * (T::ONE - shear / waves)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::motion_of;
    use crate::material::{History, Hypoelastic, Isotropic, Material, NeoHookean, VonMises};
    use crate::tensor::{Matrix, Symmetric};

    const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 6.0, shear_modulus: 3.0 };

    fn laws() -> [Material<f64>; 2] {
        [
            Material::NeoHookean(NeoHookean { elastic: ELASTIC }),
            Material::Hypoelastic(Hypoelastic { elastic: ELASTIC }),
        ]
    }

    /// The motion with its free thickness and the stress, of a law without history.
    fn freed(law: &Material<f64>, motion: &Motion<f64>) -> (Motion<f64>, Symmetric<f64>) {
        match law {
            Material::NeoHookean(law) => with_free_thickness(law, motion, &[]),
            Material::Hypoelastic(law) => with_free_thickness(law, motion, &[]),
            _ => None,
        }
        .map(|(moved, response)| (moved, response.stress))
        .expect("a stable law")
    }

    fn in_plane(a: f64, b: f64, c: f64, d: f64) -> Motion<f64> {
        let f = Matrix([[a, b, 0.0], [c, d, 0.0], [0.0, 0.0, 1.0]]);
        motion_of(f)
    }

    #[test]
    fn small_strain_gives_hookes_law_of_plane_stress() {
        let (e, nu) = (ELASTIC.young_modulus(), ELASTIC.poisson_ratio());
        let (x, y, xy) = (2e-7, -5e-7, 3e-7);
        for law in laws() {
            let motion = in_plane(1.0 + x, xy, xy, 1.0 + y);
            let (moved, stress) = freed(&law, &motion);
            let plate = e / (1.0 - nu * nu);
            let exact = [plate * (x + nu * y), plate * (y + nu * x), 0.0, e / (1.0 + nu) * xy, 0.0, 0.0];
            for (found, exact) in stress.0.iter().zip(exact) {
                assert!((found - exact).abs() < 1e-11, "{stress:?} {exact:?}");
            }
            let thinning = -nu / (1.0 - nu) * (x + y);
            assert!((moved.deformation.0[2][2] - 1.0 - thinning).abs() < 1e-11);
        }
    }

    #[test]
    fn every_stretch_of_the_plane_finds_its_thickness() {
        for law in laws() {
            for a in [0.05, 0.3, 0.7, 0.999, 1.0, 1.4, 3.0, 20.0] {
                for shear in [0.0, 0.3, -2.0] {
                    let (moved, stress) = freed(&law, &in_plane(a, shear, 0.0, 1.0));
                    let (exact, scale) = match &law {
                        Material::NeoHookean(law) => {
                            (law.stress(&moved), law.wave_modulus(&moved.deformation, moved.jacobian, &[]))
                        }
                        Material::Hypoelastic(law) => {
                            (law.stress(&moved), law.wave_modulus(&moved.deformation, moved.jacobian, &[]))
                        }
                        _ => unreachable!("one of the two"),
                    };
                    let (exact, scale) = (exact.0[2], scale / moved.jacobian);
                    assert!(exact.abs() < 1e-12 * scale && stress.0[2] == exact, "{a} {shear}: {exact:e}");
                    assert!((moved.jacobian / moved.deformation.det() - 1.0).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn neo_hookean_energy_is_the_work_in_the_plane() {
        let law = NeoHookean { elastic: ELASTIC };
        let state = |t: f64| {
            let mut motion = in_plane(1.0 + 0.4 * t, 0.3 * t, 0.0, 1.0 - 0.2 * t);
            motion.increment = Matrix::IDENTITY;
            with_free_thickness(&law, &motion, &[]).expect("a stable law")
        };
        let (n, mut work) = (2000, 0.0);
        for i in 0..n {
            let t = (i as f64 + 0.5) / f64::from(n);
            let (motion, Response { stress, .. }) = state(t);
            let rate = Matrix([[0.4, 0.3, 0.0], [0.0, -0.2, 0.0], [0.0, 0.0, 0.0]]);
            let l = (rate * motion.deformation.inverse()).symmetric_part();
            work += motion.jacobian * stress.double_dot(&l) / f64::from(n);
        }
        let (motion, Response { stress, .. }) = state(1.0);
        let energy = law.strain_energy(&motion.deformation, &stress, &[]);
        assert!((work / energy - 1.0).abs() < 1e-6, "{work} {energy}");
    }

    #[test]
    fn a_law_without_an_answer_has_none() {
        #[derive(Clone, Copy)]
        struct Pressed;
        impl Law<f64> for Pressed {
            type History = [f64; 0];
            fn history(&self) -> &'static [History] {
                &[]
            }
            fn respond(&self, _: &Motion<f64>, _: &[f64; 0]) -> Response<f64, [f64; 0]> {
                Response { stress: Symmetric::isotropic(-1.0), history: [] }
            }
            fn strain_energy(&self, _: &Matrix<f64>, _: &Symmetric<f64>, _: &[f64; 0]) -> f64 {
                0.0
            }
            fn wave_modulus(&self, _: &Matrix<f64>, _: f64, _: &[f64; 0]) -> f64 {
                1.0
            }
            fn shear_modulus(&self, _: &Matrix<f64>, _: f64, _: &[f64; 0]) -> f64 {
                0.25
            }
        }
        assert!(with_free_thickness(&Pressed, &in_plane(1.1, 0.0, 0.0, 1.0), &[]).is_none());
    }

    #[test]
    fn single_precision_converges_too() {
        let law = NeoHookean { elastic: ELASTIC.map(|x| x as f32) };
        for a in [0.5, 0.99, 1.00001, 2.0] {
            let f = Matrix([[a, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
            let motion =
                Motion { deformation: f, jacobian: f.det(), increment: f, stress: Symmetric::ZERO, dt: 1.0 };
            assert!(with_free_thickness(&law, &motion, &[]).is_some(), "{a}");
        }
    }

    /// A strip drawn by a tenth in many steps thins as flow has it: it keeps its volume,
    /// though round-off is a part of the yield stress.
    #[test]
    fn single_precision_flows_at_constant_volume() {
        let law = VonMises {
            elastic: Hypoelastic { elastic: ELASTIC },
            yield_stress: ELASTIC.young_modulus() / 500.0,
            hardening_modulus: 0.0,
        };
        let law = law.map(|x| x as f32);
        let increment = Matrix([[1.0 + 1e-5, 0.0, 0.0], [0.0, 1.0 - 0.5e-5, 0.0], [0.0, 0.0, 1.0]]);
        let mut now = Motion {
            deformation: Matrix::IDENTITY,
            jacobian: 1.0_f32,
            increment,
            stress: Symmetric::ZERO,
            dt: 1.0,
        };
        let mut history = [0.0];
        for _ in 0..10_000 {
            let deformation = increment * now.deformation;
            let next = Motion { deformation, jacobian: deformation.det(), increment, ..now };
            let (moved, response) = with_free_thickness(&law, &next, &history).expect("a stable law");
            now = Motion { stress: response.stress, ..moved };
            history = response.history;
        }
        assert!((now.jacobian - 1.0).abs() < 3e-3, "{}", now.jacobian);
        assert!((history[0] - 0.098).abs() < 2e-3, "{}", history[0]);
    }

    #[test]
    fn the_plate_modulus_is_that_of_the_textbook() {
        let (e, nu) = (ELASTIC.young_modulus(), ELASTIC.poisson_ratio());
        let modulus = plate_modulus(ELASTIC.p_wave_modulus(), ELASTIC.shear_modulus);
        assert!((modulus * (1.0 - nu * nu) / e - 1.0).abs() < 1e-14);
    }
}
