//! Plane stress: each particle of a group finds the thickness that it finds alone.

use crate::lanes::{Laned, Lanes, Machine, Processor, Work};
use crate::material::{
    AtRest, CustomLaw, Given, Isotropic, LAWS, Law, Material, Motion, NeoHookean, Thickening,
};
use crate::tensor::{Matrix, Number, Real, Symmetric, array};
use std::marker::PhantomData;

const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 6.0, shear_modulus: 3.0 };

/// Neo-Hookean, but under pressure at any thickness once it is ten times as long along x.
#[derive(Debug)]
struct Pressed;

impl CustomLaw for Pressed {
    fn name(&self) -> &'static str {
        "pressed"
    }

    fn elastic(&self) -> Isotropic<f64> {
        ELASTIC
    }

    fn respond(&self, motion: &Motion<f64>, _: &mut [f64]) -> Symmetric<f64> {
        let law = NeoHookean { elastic: ELASTIC };
        if motion.deformation.0[0][0] < 10.0 { law.stress(motion) } else { Symmetric::isotropic(-1.0) }
    }

    fn strain_energy(&self, deformation: &Matrix<f64>, stress: &Symmetric<f64>, _: &[f64]) -> f64 {
        NeoHookean { elastic: ELASTIC }.strain_energy(deformation, stress, &[])
    }
}

fn laws() -> Vec<Material<f64>> {
    let build = |name: &str, constants: &[(&str, &[f64])]| {
        let mut given = Given::default().with("bulk_modulus", 6.0).with("shear_modulus", 3.0);
        for &(name, values) in constants {
            given.put(name, values.to_vec());
        }
        let law = LAWS.iter().find(|law| law.name == name).expect("a law of the list");
        law.build(&given).expect("fit constants")
    };
    vec![
        build("neo_hookean", &[]),
        build("hypoelastic", &[]),
        build("von_mises", &[("yield_stress", &[0.05]), ("hardening_modulus", &[0.1])]),
        build("viscoelastic", &[("prony", &[0.5, 0.3, 0.2, 2.0])]),
        Material::custom(&Pressed),
    ]
}

/// From rest in one step: two that need few trials, four that need many, and two of which one has no number and the
/// other no answer from [`Pressed`].
fn motions() -> Vec<Motion<f64>> {
    let stretches = [
        (1.0 + 1e-6, 0.0),
        (0.999, 2e-3),
        (0.3, 0.5),
        (0.1, 0.0),
        (3.0, -2.0),
        (6.0, 0.3),
        (f64::NAN, 0.0),
        (20.0, 0.0),
    ];
    let motion = |(along, shear)| {
        let deformation = Matrix([[along, shear, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let jacobian = deformation.det();
        Motion { deformation, jacobian, increment: deformation, stress: Symmetric::ZERO, dt: 0.1 }
    };
    stretches.map(motion).to_vec()
}

/// A motion in each lane.
fn side_by_side<V: Lanes>(motion: impl Fn(usize) -> Motion<f64>) -> Motion<V> {
    let lanes = |of: &dyn Fn(&Motion<f64>) -> f64| V::from_fn(|lane| V::Real::of(of(&motion(lane))));
    Motion {
        deformation: Matrix::from_fn(|i, j| lanes(&|motion| motion.deformation.0[i][j])),
        jacobian: lanes(&|motion| motion.jacobian),
        increment: Matrix::from_fn(|i, j| lanes(&|motion| motion.increment.0[i][j])),
        stress: Symmetric(array(V::ZERO, |k| lanes(&|motion| motion.stress.0[k]))),
        dt: lanes(&|motion| motion.dt),
    }
}

/// The stretch of each lane in bits that tell numbers apart, if it has one.
fn thicken<V: Lanes>(law: &Material<f64>, motion: &Motion<V>) -> Vec<Option<V::Real>> {
    let Thickening { stretch, found } = law.map(V::of).thickening(motion, &AtRest(law.history()));
    let stretches = stretch.numbers().0;
    (0..V::COUNT).map(|lane| (found >> lane & 1 == 1).then_some(stretches[lane])).collect()
}

fn neighbours_do_not_matter<V: Lanes>(tolerance: f64) {
    let motions = motions();
    for law in &laws() {
        let alone: Vec<_> = motions
            .iter()
            .map(|motion| {
                let found = thicken::<V>(law, &side_by_side(|_| *motion));
                assert!(found.iter().all(|one| *one == found[0]), "{law:?}: {found:?}");
                // A single number rounds products and sums by themselves.
                let motion = side_by_side::<crate::lanes::Pack<V::Real, 1>>(|_| *motion);
                let off = match (found[0], thicken(law, &motion)[0]) {
                    (Some(found), Some(exact)) => (found / exact - V::Real::ONE).abs().f64(),
                    (None, None) => 0.0,
                    _ => f64::INFINITY,
                };
                assert!(off < tolerance, "{law:?}: {motion:?} {off:e}");
                found[0]
            })
            .collect();
        let without = alone.iter().filter(|found| found.is_none()).count();
        assert_eq!(without, if matches!(law, Material::Custom(_)) { 2 } else { 1 }, "{law:?}: {alone:?}");
        for (first, apart) in (0..motions.len()).flat_map(|first| [1, 3].map(|apart| (first, apart))) {
            let of = |lane: usize| (first + apart * lane) % motions.len();
            let found = thicken::<V>(law, &side_by_side(|lane| motions[of(lane)]));
            let expected: Vec<_> = (0..V::COUNT).map(|lane| alone[of(lane)]).collect();
            assert_eq!(found, expected, "{law:?}");
        }
    }
}

struct Thicken<T>(f64, PhantomData<T>);

impl<T: Laned> Work for Thicken<T> {
    type Real = T;
    type Output = ();

    /// As many lanes as the plane has.
    #[inline(always)]
    fn run<M: Machine<T>>(self) {
        neighbours_do_not_matter::<M::Quad>(self.0);
    }

    /// One lane has no neighbours.
    #[cfg(all(target_arch = "x86_64", not(portable_lanes)))]
    fn run_anywhere(self) {}
}

/// Bit for bit, and to round-off of what a particle alone finds with products rounded before sums: neither a lane that
/// searches long nor one without an answer touches its neighbours.
#[test]
fn the_thickness_of_a_particle_does_not_depend_on_its_group() {
    for processor in Processor::available() {
        f64::run(processor, Thicken(1e-11, PhantomData));
        f32::run(processor, Thicken(1e-3, PhantomData));
    }
}
