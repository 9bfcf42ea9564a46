//! Soil and rock by Mohr and Coulomb, elastic in rate form as [`Hypoelastic`], with the exact return in principal
//! stresses (de Souza Neto, Peric and Owen 2008, section 8.2; Clausen, Damkilde and Andersen 2006) and a cut-off of
//! tension.
//!
//! ```text
//! J (s_1 - s_3) + J (s_1 + s_3) sin(phi) <= 2 c cos(phi)      s_1 >= s_2 >= s_3: principal stresses, tension positive
//! J s_1 <= t = min(t_0, c cot(phi))
//! flow: de = dl m,  m = (1 + sin(psi), 0, -(1 - sin(psi)))       of the plane between s_1 and s_3; at an edge of two
//!                                                                planes, at the end anywhere between them
//! s   = s* - C de_p                                              star: of the elastic step, C of Hooke's law
//! da  = sqrt(2/3 dev(de_p) : dev(de_p)),   dD = J sigma : de_p   with the mean of the stress over the step
//! ```
//!
//! With z = sin(phi), w = sin(psi), b = K - 2G/3, f_ij = s_i - s_j + (s_i + s_j) z - 2 c cos(phi)/J of the elastic
//! step:
//!
//! ```text
//! h = 4 G (1 + z w) + 4 b z w
//! plane         dl = f_13/h
//! s_1 = s_2     dl = (f_13 + f_23)/(h + 4 b z w + 2 G (1 - z)(1 - w))          the sum of both
//! s_2 = s_3     dl = (f_13 + f_12)/(h + 4 b z w + 2 G (1 + z)(1 + w))
//! end           s_1 = s_2 = s_3 = c cot(phi)/J
//! ```
//! The plane holds if its stress is in order; else (1 - w) s_1* - 2 s_2* + (1 + w) s_3* says by its sign which edge is
//! next, the second if it is above zero; and if that stress is not in order, the end is left. Tension is cut after that
//! by Rankine's planes with flow along their normals, which leads into what Mohr and Coulomb allow.
//!
//! The star is of a step that begins with the gap by which soil without tension came apart, see [`soil`]. Strength does
//! not change with strain: softening would follow the grid.

use super::declaration::{BadConstants, Constant, Declared, Given};
use super::soil::{self, Strength};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::eigen::Principal;
use crate::tensor::{Matrix, Number, Symmetric, array};
use serde::Serialize;

/// Soil by Mohr and Coulomb.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MohrCoulomb<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// phi [rad]
    pub friction_angle: T,
    /// psi [rad]
    pub dilation_angle: T,
    /// c [Pa]
    pub cohesion: T,
    /// t_0, largest principal tension if it is bounded [Pa].
    pub tension_strength: Option<T>,
    /// sin(phi)
    #[serde(skip)]
    friction: T,
    /// sin(psi)
    #[serde(skip)]
    dilation: T,
    /// 2 c cos(phi) [Pa]
    #[serde(skip)]
    strength: T,
    /// c cot(phi) [Pa]
    #[serde(skip)]
    end: T,
    /// t [Pa]
    #[serde(skip)]
    tension: T,
}

impl Declared for MohrCoulomb<f64> {
    const SUMMARY: &'static str = "Soil and rock by Mohr and Coulomb, with dilation and a cut-off of tension; \
                                   elastic below it as the hypoelastic law.";
    const CONSTANTS: &'static [Constant] = &{
        let [friction, dilation, cohesion, tension] =
            soil::constants("Largest principal tension; without it, that which friction and cohesion bear.");
        elastic::and::<4, 9>([friction, dilation, cohesion, tension])
    };

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has no friction within"));
        }
        let strength = Strength::build(given)?;
        let Strength { friction_angle, dilation_angle, cohesion, tension_strength } = strength;
        let (sine, cosine) = (libm::sin(friction_angle), libm::cos(friction_angle));
        let end = cohesion * cosine / sine;
        Ok(MohrCoulomb {
            elastic: Hypoelastic { elastic },
            friction_angle,
            dilation_angle,
            cohesion,
            tension_strength,
            friction: sine,
            dilation: libm::sin(dilation_angle),
            strength: 2.0 * cohesion * cosine,
            end: Strength { tension_strength: None, ..strength }.tension(end),
            tension: strength.tension(end),
        })
    }

    fn given(&self) -> Given {
        let strength = Strength {
            friction_angle: self.friction_angle,
            dilation_angle: self.dilation_angle,
            cohesion: self.cohesion,
            tension_strength: self.tension_strength,
        };
        strength.given(self.elastic.given())
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

impl<T: Copy> MohrCoulomb<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> MohrCoulomb<U> {
        MohrCoulomb {
            friction_angle: f(self.friction_angle),
            dilation_angle: f(self.dilation_angle),
            cohesion: f(self.cohesion),
            tension_strength: self.tension_strength.map(&f),
            friction: f(self.friction),
            dilation: f(self.dilation),
            strength: f(self.strength),
            end: f(self.end),
            tension: f(self.tension),
            elastic: self.elastic.map(f),
        }
    }
}

impl<T: Number> MohrCoulomb<T> {
    /// h, and the sum over two planes of the edges s_1 = s_2 and s_2 = s_3 [Pa].
    #[inline(always)]
    fn stiffness(&self) -> [T; 3] {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let (z, w, two_g) = (self.friction, self.dilation, g + g);
        let volume = T::of(4.0) * (k - T::of(2.0 / 3.0) * g) * z * w;
        let plane = two_g * T::of(2.0) * (T::ONE + z * w) + volume;
        let both = plane + volume;
        [plane, both + two_g * (T::ONE - z) * (T::ONE - w), both + two_g * (T::ONE + z) * (T::ONE + w)]
    }

    /// Principal stresses that friction and cohesion bear, from those of the elastic step, all in order.
    #[inline(always)]
    fn slid(&self, [s1, s2, s3]: [T; 3], j: T) -> [T; 3] {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let (z, w, two_g) = (self.friction, self.dilation, g + g);
        let strength = self.strength / j;
        let beyond = |a: T, b: T| (a - b) + (a + b) * z - strength;
        let [plane, first_two, last_two] = self.stiffness();
        // C m
        let across = (k + k - T::of(4.0 / 3.0) * g) * w;
        let (most, least) = (two_g * (T::ONE + w) + across, two_g * (T::ONE - w) - across);
        let excess = beyond(s1, s3).max(T::ZERO);

        let flow = excess / plane;
        let on_plane = [s1 - most * flow, s2 - across * flow, s3 + least * flow];
        let in_order = on_plane[0].at_least(on_plane[1]) & on_plane[1].at_least(on_plane[2]);

        let flow = (excess + beyond(s2, s3)) / first_two;
        let pair = T::HALF * ((s1 + s2) - (most + across) * flow);
        let first_two = [pair, pair, s3 + least * flow];
        let flow = (excess + beyond(s1, s2)) / last_two;
        let pair = T::HALF * ((s2 + s3) + (least - across) * flow);
        let last_two = [s1 - most * flow, pair, pair];

        let side = (T::ONE - w) * s1 - (s2 + s2) + (T::ONE + w) * s3;
        let last = side.at_least(T::ZERO);
        let edge: [T; 3] = array(T::ZERO, |i| T::select(last, last_two[i], first_two[i]));
        let before_end = edge[0].at_least(edge[2]);
        let end = self.end / j;
        array(T::ZERO, |i| T::select(in_order, on_plane[i], T::select(before_end, edge[i], end)))
    }

    /// Those of them that are no larger tension than allowed.
    #[inline(always)]
    fn cut(&self, [s1, s2, s3]: [T; 3], tension: T) -> [T; 3] {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let across = k - T::of(2.0 / 3.0) * g;
        let along = across + g + g;
        let first = (s1 - tension).max(T::ZERO);
        let (one2, one3) = (s2 - across / along * first, s3 - across / along * first);
        let two3 = s3 - across / (along + across) * (s1 + s2 - tension - tension);
        let third = T::select(tension.at_least(one2), one3, two3);
        [s1.min(tension), one2.min(tension), third.min(tension)]
    }
}

impl<T: Number> Law<T> for MohrCoulomb<T> {
    /// a, o and D.
    type History = [T; 3];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        &soil::HISTORY
    }

    /// Plastic flow resists no error of F.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, &[strain, opening, lost]: &[T; 3]) -> Response<T, [T; 3]> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let (j, tension) = (motion.jacobian, self.tension / motion.jacobian);
        let trial = soil::trial(&self.elastic, motion, opening);
        let principal = Principal::of(&trial.stress);
        let values = principal.values;
        let largest = values[0].max(values[1]).max(values[2]);
        let smallest = values[0].min(values[1]).min(values[2]);
        let middle = values[0].min(values[1]).max(values[2].min(values[0].max(values[1])));
        let ordered = [largest, middle, smallest];
        let after = self.cut(self.slid(ordered, j), tension);
        let taken: [T; 3] = array(T::ZERO, |i| ordered[i] - after[i]);
        let by_value: [T; 3] = array(T::ZERO, |i| {
            let rest = T::select(smallest.at_least(values[i]), taken[2], taken[1]);
            T::select(values[i].at_least(largest), taken[0], rest)
        });
        // C de_p
        let relaxed = principal.with(by_value);
        let stress = trial.stress - relaxed;

        let deviator = relaxed.deviator();
        let flow = soil::equivalent(&deviator) / (T::of(3.0) * g);
        // Beyond the end the volume grows by more than shear loosens it.
        let dilated = k * self.dilation * (taken[0] - taken[2]) / (g + g);
        let missing = (relaxed.trace() * T::of(1.0 / 3.0) - dilated).max(T::ZERO);
        let missing = T::select(after[2].at_least(tension), missing, T::ZERO);
        let opening = soil::opening(&self.elastic, self.tension, missing);

        let mean = trial.before * T::HALF + stress * (T::HALF * j);
        let by_shear = mean.double_dot(&deviator) / (g + g);
        let by_volume = mean.trace() * relaxed.trace() / (T::of(9.0) * k);
        let lost = lost + (by_shear + by_volume).max(T::ZERO);
        Response { stress, history: [strain + flow, opening, lost] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 3]) -> T {
        self.elastic.strain_energy(deformation, stress, &[])
    }

    #[inline(always)]
    fn dissipation(&self, &[_, _, lost]: &[T; 3]) -> T {
        lost
    }

    /// Of the elastic law, at the volume that closing an opening leaves, and more: where soil that dilates by less than
    /// it rubs flows while it expands, it is stiffer than elastic; at an edge by at most
    /// 2 ((z - w)(K + G/3) + c cos(phi))^2 over what divides f_13 + f_23.
    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, &[_, opening, _]: &[T; 3]) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let [_, edge, _] = self.stiffness();
        let apart = (self.friction - self.dilation) * (k + T::of(1.0 / 3.0) * g) + T::HALF * self.strength;
        let more = T::of(2.0) * apart * apart / edge;
        (self.elastic.wave_modulus(deformation, jacobian, &[]) + more * jacobian) * (-opening).exp()
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, &[_, opening, _]: &[T; 3]) -> T {
        self.elastic.shear_modulus(deformation, jacobian, &[]) * (-opening).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::soil::tests::{
        Chance, State, along_axes, in_single_precision, ledger, only_turns, plates_have_a_thickness, pressed,
        random_paths, stiffest_on_paths,
    };
    use crate::material::tests::{hooke, motion_of, sample_gradients};
    use crate::material::{LAWS, Material, NoStretch};

    const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 20e6, shear_modulus: 10e6 };

    fn law(angles: [f64; 2], cohesion: f64) -> MohrCoulomb<f64> {
        let given = ELASTIC
            .given()
            .with("friction_angle", angles[0].to_radians())
            .with("dilation_angle", angles[1].to_radians())
            .with("cohesion", cohesion);
        Declared::build(&given).expect("sound constants")
    }

    fn cut(law: MohrCoulomb<f64>, tension: f64) -> MohrCoulomb<f64> {
        Declared::build(&law.given().with("tension_strength", tension)).expect("sound constants")
    }

    fn laws() -> [MohrCoulomb<f64>; 7] {
        [
            law([30.0, 0.0], 0.0),
            law([35.0, 10.0], 0.0),
            law([30.0, 30.0], 20e3),
            law([30.0, 5.0], 20e3),
            law([0.0, 0.0], 20e3),
            cut(law([30.0, 5.0], 20e3), 5e3),
            cut(law([40.0, 0.0], 20e3), 0.0),
        ]
    }

    /// Principal stresses in order.
    fn principal(stress: &Symmetric<f64>) -> [f64; 3] {
        let mut values = Principal::of(stress).values;
        values.sort_by(|a, b| b.total_cmp(a));
        values
    }

    /// By how much a stress is outside of the surface, over the scale of it.
    fn outside(law: &MohrCoulomb<f64>, stress: &Symmetric<f64>, j: f64) -> f64 {
        let [s1, s2, s3] = principal(stress);
        let sheared = (s1 - s3) + (s1 + s3) * law.friction - law.strength / j;
        sheared.max(s1 - law.tension / j) / (ELASTIC.bulk_modulus + s1.abs() + s2.abs() + s3.abs())
    }

    #[test]
    fn below_yield_it_is_the_elastic_law_and_small_strain_gives_hooke() {
        for law in laws() {
            let under = Symmetric([-120e3, -100e3, -100e3, 0.0, 5e3, 0.0]);
            for h in sample_gradients() {
                let motion = Motion { stress: under, ..motion_of(Matrix::IDENTITY + h * 1e-5) };
                let response = law.respond(&motion, &[0.0; 3]);
                assert_eq!(response.stress, law.elastic.stress(&motion));
                assert_eq!(response.history, [0.0; 3]);
                let pressed = Symmetric::isotropic(-100e3);
                let motion = Motion { stress: pressed, ..motion_of(Matrix::IDENTITY + h * 1e-7) };
                let exact = hooke(&ELASTIC, &(h * 1e-7).symmetric_part()) + pressed;
                let stress = law.respond(&motion, &[0.0; 3]).stress;
                assert!(stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-5), "{stress:?}");
            }
            let rest = law.respond(&motion_of(Matrix::IDENTITY), &[0.0; 3]);
            assert_eq!((rest.stress, rest.history), (Symmetric::ZERO, [0.0; 3]));
        }
    }

    /// sigma_1 = sigma_3 N + 2 c sqrt(N), N = (1 + sin(phi))/(1 - sin(phi)), under a pressure of 100 kPa at the sides,
    /// in triaxial compression, triaxial extension and plane strain, with any dilation.
    #[test]
    fn strengths_are_those_of_the_textbook() {
        let side = 100e3;
        for (cohesion, angles) in
            [(0.0, [30.0f64, 0.0]), (15e3, [35.0, 12.0]), (15e3, [25.0, 25.0]), (15e3, [0.0, 0.0])]
        {
            let sine = angles[0].to_radians().sin();
            let ratio = (1.0 + sine) / (1.0 - sine);
            let law = law(angles, cohesion);
            let start = State::under(Symmetric::isotropic(-side));
            for (both, axial) in [(true, -1e-4), (true, 1e-4), (false, -1e-4)] {
                let end = pressed(&law, (start, both), (1000, axial), |_| {});
                // Cohesion is by undeformed area: soil that loosens has less of it.
                let cohesive = 2.0 * cohesion / end.motion.jacobian * ratio.sqrt();
                let exact = if axial < 0.0 { side * ratio + cohesive } else { (side - cohesive) / ratio };
                let found = -end.stress().0[2];
                assert!((found / exact - 1.0).abs() < 1e-9, "{angles:?} {both} {axial}: {found} {exact}");
            }
        }
    }

    /// A bar with free sides bears the cut-off, or 2 c sqrt(1/N) without one.
    #[test]
    fn a_bar_in_tension_bears_the_cut_off() {
        let whole = law([30.0, 5.0], 20e3);
        for (law, exact) in
            [(whole, 2.0 * 20e3 / 3f64.sqrt()), (cut(whole, 5e3), 5e3), (cut(whole, 0.0), 0.0)]
        {
            let end = pressed(&law, (State::under(Symmetric::ZERO), true), (200, 1e-4), |_| {});
            let exact = exact / end.motion.jacobian;
            assert!((end.stress().0[2] - exact).abs() < 1.0, "{} {exact}", end.stress().0[2]);
        }
    }

    /// In plane strain the rate of volume strain over that of shear in the plane is the sine of the dilation angle.
    #[test]
    fn dilation_in_plane_strain_is_the_angle_given() {
        let law = law([35.0, 12.0], 0.0);
        let start = State::under(Symmetric::isotropic(-100e3));
        let middle = pressed(&law, (start, false), (1000, -1e-4), |_| {});
        let end = pressed(&law, (middle, false), (100, -1e-4), |_| {});
        let length = |state: &State<[f64; 3]>, axis: usize| state.motion.deformation.0[axis][axis].ln();
        let grown = |axis: usize| length(&end, axis) - length(&middle, axis);
        let sine = (grown(0) + grown(2)) / (grown(0) - grown(2));
        assert!((sine - 12f64.to_radians().sin()).abs() < 1e-9, "{sine}");
    }

    /// What a return takes off is flow of the planes on which it ends, each by a factor that is not negative.
    #[test]
    fn returns_are_flows_of_the_planes_where_they_end() {
        let mut ends = [0; 4];
        for law in laws() {
            let (z, w) = (law.friction, law.dilation);
            let Isotropic { bulk_modulus: k, shear_modulus: g } = ELASTIC;
            let mut chance = Chance::new(5);
            for _ in 0..20_000 {
                let mut s = [0.0; 3].map(|_| 200e3 * chance.next() - 80e3);
                s.sort_by(|a, b| b.total_cmp(a));
                let r = law.slid(s, 1.0);
                let taken = [0, 1, 2].map(|i| s[i] - r[i]);
                let mean = taken.iter().sum::<f64>() / 3.0;
                let strain = taken.map(|x| (x - mean) / (2.0 * g) + mean / (3.0 * k));
                let small = 1e-12;
                let on = |a: usize, b: usize| ((r[a] - r[b]) + (r[a] + r[b]) * z - law.strength).abs() < 1e-6;
                if taken == [0.0; 3] {
                    ends[0] += 1;
                } else if r[0] == r[1] && r[1] == r[2] {
                    // In the cone of all flows, none of which makes the volume grow by less than its dilation.
                    let volume: f64 = strain.iter().sum();
                    assert!(volume >= w * (strain[0] - strain[2]) - small, "{s:?} {strain:?}");
                    ends[3] += 1;
                } else if r[0] == r[1] {
                    let flows = [strain[0] / (1.0 + w), strain[1] / (1.0 + w)];
                    assert!(flows.iter().all(|x| *x >= -small) && on(0, 2) && on(1, 2), "{s:?} {flows:?}");
                    assert!(
                        (strain[2] + (1.0 - w) * (flows[0] + flows[1])).abs() < small,
                        "{s:?} {strain:?}"
                    );
                    ends[2] += 1;
                } else if r[1] == r[2] {
                    let flows = [-strain[1] / (1.0 - w), -strain[2] / (1.0 - w)];
                    assert!(flows.iter().all(|x| *x >= -small) && on(0, 2) && on(0, 1), "{s:?} {flows:?}");
                    assert!(
                        (strain[0] - (1.0 + w) * (flows[0] + flows[1])).abs() < small,
                        "{s:?} {strain:?}"
                    );
                    ends[2] += 1;
                } else {
                    let flow = strain[0] / (1.0 + w);
                    assert!(flow > 0.0 && on(0, 2) && r[0] > r[1] && r[1] > r[2], "{s:?} {r:?}");
                    assert!(
                        (strain[2] + (1.0 - w) * flow).abs() < small && strain[1].abs() < small,
                        "{strain:?}"
                    );
                    ends[1] += 1;
                }
            }
        }
        assert!(ends.iter().all(|count| *count > 1000), "{ends:?}");
    }

    #[test]
    fn on_random_paths_the_stress_stays_within_and_dissipation_never_falls() {
        for law in laws() {
            let start = |chance: &mut Chance| Symmetric::isotropic(-100e3 * (1.0 + chance.next()));
            random_paths(&law, start, |before, after| {
                assert!(outside(&law, &after.stress(), after.motion.jacobian) < 1e-12, "{law:?} {after:?}");
                assert!(law.dissipation(&after.history) >= law.dissipation(&before.history));
                assert!(after.history[0] >= before.history[0] && after.history[1] >= 0.0);
            });
        }
    }

    #[test]
    fn single_precision_stays_within_too() {
        for law in laws() {
            in_single_precision(&law.map(|x| x as f32), 100e3, |motion, _| {
                let stress = Symmetric(motion.stress.0.map(f64::from));
                outside(&law, &stress, f64::from(motion.jacobian)) as f32
            });
        }
    }

    #[test]
    fn it_carries_a_stress_within_the_surface() {
        for law in [laws()[0], laws()[3]] {
            let material = Material::MohrCoulomb(law);
            assert!(material.carries_stress());
            let borne = Symmetric([-50e3, -50e3, -100e3, 1e3, 0.0, 0.0]);
            assert_eq!(material.stretch_under(&borne), Ok(Symmetric::isotropic(1.0)));
            let not = Symmetric([-50e3, -50e3, -400e3, 0.0, 0.0, 0.0]);
            assert_eq!(material.stretch_under(&not), Err(NoStretch::Yields));
        }
    }

    #[test]
    fn the_work_is_stored_or_dissipated() {
        for law in laws() {
            let misses = ledger(&law, (Symmetric::isotropic(-50e3), 0.05), 8000);
            assert!(misses < 2e-3, "{law:?}: {misses}");
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        for law in laws() {
            let start = State::under(Symmetric::isotropic(-100e3));
            only_turns(&law, &start.moved(&law, Matrix::IDENTITY + sample_gradients()[2] * 0.01));
        }
    }

    #[test]
    fn sand_that_came_apart_closes_before_it_presses() {
        let law = law([30.0, 0.0], 0.0);
        let mut state = State::under(Symmetric::isotropic(-10e3));
        for _ in 0..100 {
            state = state.moved(&law, along_axes([1e-3; 3]));
        }
        assert_eq!((state.p(), state.q()), (0.0, 0.0));
        for _ in 0..99 {
            state = state.moved(&law, along_axes([-1e-3; 3]));
            assert!(state.p().abs() < 1e-6, "{state:?}");
        }
        state = state.moved(&law, along_axes([-1e-3; 3]));
        assert!((state.p() / 10e3 - 1.0).abs() < 1e-2 && state.history[1].abs() < 1e-12, "{state:?}");
    }

    /// The stiffest that a small step finds, over what is said.
    #[test]
    fn the_wave_modulus_is_an_upper_bound() {
        for law in laws() {
            let largest = stiffest_on_paths(&law, Symmetric::isotropic(-100e3));
            assert!((0.75..1.0 + 1e-5).contains(&largest), "{law:?}: {largest}");
        }
    }

    #[test]
    fn a_thin_plate_of_it_has_a_thickness() {
        for law in laws() {
            plates_have_a_thickness(&law, ELASTIC.bulk_modulus);
        }
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "mohr_coulomb").expect("a law of the list");
        let with = |more: &[(&str, f64)]| {
            law.build(&more.iter().fold(ELASTIC.given(), |given, &(name, value)| given.with(name, value)))
        };
        for (constants, key) in [
            (&[][..], None),
            (&[("friction_angle", 30.0)], Some("friction_angle")),
            (&[("friction_angle", 0.5), ("dilation_angle", 0.6)], Some("dilation_angle")),
            (&[("friction_angle", 0.5), ("cohesion", -1.0)], Some("cohesion")),
            (&[("friction_angle", 0.5), ("tension_strength", -1.0)], Some("tension_strength")),
            (&[("friction_angle", 0.0)], None),
        ] {
            assert_eq!(with(constants).unwrap_err().key.as_deref(), key, "{constants:?}");
        }
        assert_eq!(with(&[("friction_angle", 0.5)]).expect("sand").given().get("tension_strength"), None);
    }
}
