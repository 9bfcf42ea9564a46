//! Plane stress for any law: the thickness that leaves no stress out of the plane.
//!
//! ```text
//! sigma_zz(F') = 0,   F' = diag(1, 1, a) F,   a = F_zz' / F_zz
//! ```
//!
//! A thin plate with free faces. Its particles have the reference thickness one; the thickness is F_zz, so det F is the
//! volume, and the in-plane force of a particle is -V0 det F sigma grad S as in every scene: the stress acts on the
//! present thickness. F is block diagonal, so isotropic laws leave no shear out of the plane, and one unknown is left.
//!
//! Several particles search side by side, over any [`Number`]; a law knows nothing of it.

use super::{Law, Motion};
use crate::tensor::Number;

/// Which thickness a particle takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Thickness {
    /// What its motion says: in space, and in plane strain, where it never changes.
    #[default]
    Moved,
    /// The one without stress out of the plane: plane stress.
    Free,
}

/// By how much particles thicken in a step.
#[derive(Clone, Copy, Debug)]
pub struct Thickening<T> {
    /// a [-]
    pub stretch: T,
    /// Lanes whose law has an answer, from the lowest bit on.
    pub found: u32,
}

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

/// The stretch that frees the plane of stress, of every lane by itself.
///
/// `motion` has the thickness of the start of the step, which its increment leaves alone. The first trial is Hooke's,
/// `a = 1 - (1 - 2G/M) tr(dF - I)`, the next are Newton's with M and the secant's; once two trials enclose the answer,
/// none leaves the bracket and every third one halves it. Until then trials go thicker against compression and thinner
/// against tension, whatever the secant says. So the search ends for every law whose sigma_zz leads from compression to
/// tension as the thickness grows, also where what breaks makes it fall in between. What is left of sigma_zz is round-off of M; it stays in the stress, so
/// that the next step of a law in rate form makes up for it.
///
/// A lane that has its answer keeps it while others search on, so that it does not depend on them.
#[inline(always)]
pub(super) fn thickening<T: Number, L: Law<T>>(
    law: &L,
    motion: &Motion<T>,
    history: &L::History,
) -> Thickening<T> {
    let (one, two) = (T::ONE, T::of(2.0));
    let waves = law.wave_modulus(&motion.deformation, motion.jacobian, history);
    let shear = law.shear_modulus(&motion.deformation, motion.jacobian, history);
    // sigma_zz by a relative change of thickness.
    let stiffness = waves * (one / motion.jacobian);
    let round_off = T::of(64.0) * T::EPSILON * stiffness;
    let increment = &motion.increment.0;
    let guess = one - (one - two * shear / waves) * (increment[0][0] + increment[1][1] - two);
    let mut stretch = guess.max(T::HALF).min(two);
    let mut before = TrialStretch { stretch: one, stress: T::ZERO };
    let mut bracket = Bracket::new();
    let (mut searching, mut found) = ((1 << T::SIDE_BY_SIDE) - 1, 0);
    for count in 1..=MOST_TRIALS {
        let stress = law.respond(&motion.thickened(stretch), history).stress.0[2];
        let now = TrialStretch { stretch, stress };
        bracket.narrow(now);
        let sound = round_off.at_least(stress.abs()) | bracket.is_shut();
        searching &= finite(stress);
        found |= searching & sound;
        searching &= !sound;
        if searching == 0 {
            break;
        }
        let newton = stretch * (one - stress / stiffness);
        let next = if count == 1 { newton } else { secant(before, now) };
        let next = next.max(stretch * T::HALF).min(stretch * two);
        stretch = T::select(searching, bracket.next(now, next, count), stretch);
        before = now;
    }
    Thickening { stretch, found }
}

/// Lanes in which a number is finite.
#[inline(always)]
fn finite<T: Number>(x: T) -> u32 {
    (x * T::ZERO).at_least(T::ZERO)
}

#[inline(always)]
fn secant<T: Number>(a: TrialStretch<T>, b: TrialStretch<T>) -> T {
    b.stretch - b.stress * ((b.stretch - a.stretch) / (b.stress - a.stress))
}

/// The last stretches that left a lane in compression and in tension.
struct Bracket<T> {
    thin: T,
    thick: T,
    /// Lanes that have been in compression, and in tension.
    known: [u32; 2],
}

impl<T: Number> Bracket<T> {
    #[inline(always)]
    fn new() -> Self {
        Bracket { thin: T::ONE, thick: T::ONE, known: [0; 2] }
    }

    /// Lanes in which both ends are known.
    #[inline(always)]
    fn ends(&self) -> u32 {
        self.known[0] & self.known[1]
    }

    #[inline(always)]
    fn narrow(&mut self, now: TrialStretch<T>) {
        let tension = now.stress.at_least(T::ZERO);
        self.thin = T::select(tension, self.thin, now.stretch);
        self.thick = T::select(tension, now.stretch, self.thick);
        self.known = [self.known[0] | !tension, self.known[1] | tension];
    }

    /// Lanes in which nothing is left between the ends.
    #[inline(always)]
    fn is_shut(&self) -> u32 {
        self.ends() & (T::of(4.0) * T::EPSILON * self.thin).at_least((self.thin - self.thick).abs())
    }

    /// The trial after `now`: `next`, if it is of use.
    #[inline(always)]
    fn next(&self, now: TrialStretch<T>, next: T, count: usize) -> T {
        let (low, high) = (self.thin.min(self.thick), self.thin.max(self.thick));
        let outside = low.at_least(next) | next.at_least(high);
        let halved = self.ends() & if count.is_multiple_of(3) { u32::MAX } else { outside };
        // A secant that is flat or falls: thicker against compression, thinner against tension.
        let tension = now.stress.at_least(T::ZERO);
        let astray = (tension & next.at_least(now.stretch)) | (!tension & now.stretch.at_least(next));
        let away = T::select(tension, T::HALF, T::of(2.0));
        let free = T::select(astray, now.stretch * away, next);
        T::select(halved, (self.thin + self.thick) * T::HALF, free)
    }
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
    use crate::material::{History, Hypoelastic, Isotropic, Material, NeoHookean, Response, VonMises};
    use crate::tensor::{Matrix, Real, Symmetric};

    const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 6.0, shear_modulus: 3.0 };

    fn laws() -> [Material<f64>; 2] {
        [
            Material::NeoHookean(NeoHookean { elastic: ELASTIC }),
            Material::Hypoelastic(Hypoelastic { elastic: ELASTIC }),
        ]
    }

    /// A motion with its free thickness, and the response to it.
    type Moved<T, H> = (Motion<T>, Response<T, H>);

    /// The motion with its free thickness, and the response to it; `None` if the law has none.
    fn with_free_thickness<T: Real, L: Law<T>>(
        law: &L,
        motion: &Motion<T>,
        history: &L::History,
    ) -> Option<Moved<T, L::History>> {
        let Thickening { stretch, found } = thickening(law, motion, history);
        let moved = motion.thickened(stretch);
        (found == 1).then(|| (moved, law.respond(&moved, history)))
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
            hardening: None,
            rate: None,
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
        let mut history = [0.0; 2];
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
