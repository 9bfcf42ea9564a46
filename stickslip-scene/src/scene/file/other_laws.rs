//! Names of laws that other programs have, and what there is here for each.

/// What stands here for a law of another program, by its names there, without case, `_`, `-` and spaces.
const ELSEWHERE: &[(&[&str], &str)] = &[
    (
        &[
            "elastic",
            "isotropic",
            "linear",
            "linearelastic",
            "elas",
            "hooke",
            "saintvenantkirchhoff",
            "stvk",
            "logarithmic",
        ],
        "here: `hypoelastic`, Hooke's law that turns with the material, for small strains; `hencky`, in logarithmic strain, \
         for moderate and `neo_hookean` for large ones",
    ),
    (
        &["neohooke", "neoh", "compneohook", "hyperelastic", "corotated", "fixedcorotated", "jelly"],
        "here: `neo_hookean`, for large strains and rotations",
    ),
    (
        &["mooney", "yeoh", "arrudaboyce", "gent"],
        "here: `mooney_rivlin`, with c10, c01 and bulk_modulus, or `ogden`, with pairs of modulus and exponent; another \
         one is a law of your own in Python, chapter 15",
    ),
    (
        &["chaboche", "lemaitrechaboche", "kinematichardening", "kinematic", "combinedhardening", "prager"],
        "here: `armstrong_frederick`, with yield_stress, kinematic_modulus, dynamic_recovery and, for a yield stress that \
         grows too, hardening_modulus",
    ),
    (
        &[
            "plastic",
            "elastoplastic",
            "isoplasticity",
            "j2",
            "j2plasticity",
            "pla1",
            "pla2",
            "compneohookplastic",
        ],
        "here: `von_mises`, with yield_stress and hardening_modulus",
    ),
    (
        &["john", "sjc", "sjcf", "jc", "jcf", "steinberg", "steinbergcochranguinan", "zerilliarmstrong"],
        "here: `johnson_cook`, with yield_stress = A, hardening_modulus = B, hardening_exponent = n, rate_coefficient = C \
         and thermal_exponent = m",
    ),
    (
        &["dpm", "mc", "tresca", "sand", "soil", "druckerpragercap"],
        "here: `drucker_prager` or `mohr_coulomb`, with friction_angle, dilation_angle and cohesion; or grains as bodies, \
         [[packings]] with `friction`",
    ),
    (
        &["granular", "mudi", "muirheology", "pouliquen", "granularflow", "mucoefficient"],
        "here: `mu_i`, with static_friction and limiting_friction, or `drucker_prager` where friction has no rate; or \
         grains as bodies, [[packings]] with `friction`",
    ),
    (
        &["camclay", "clay", "mcc", "originalcamclay", "cap", "crushablefoam", "foam", "snow"],
        "here: `modified_cam_clay`, which hardens as it is compacted, with critical_slope, compression_slope and \
         swelling_slope",
    ),
    (
        &["norsand", "hypoplastic", "hypoplasticity", "hardeningsoil"],
        "here: `mohr_coulomb` has strength, `modified_cam_clay` hardening; what is between them is a law of your own in \
         Python, chapter 15",
    ),
    (
        &[
            "newtonian",
            "newtonianfluid",
            "bingham",
            "herschelbulkley",
            "liquid",
            "water",
            "viscousfluid",
            "null",
            "tait",
            "idealgas",
            "gas",
        ],
        "here: `fluid`, with bulk_modulus, pressure_exponent (7 for water; of a gas its ratio of heat capacities, with \
         bulk_modulus that times the pressure), viscosity and yield_stress",
    ),
    (
        &["eos", "miegruneisen", "gruneisen", "tillotson", "jwl", "hiex", "shock", "seos"],
        "here: `fluid` has Tait's equation of state and that of gases; another one is a law of your own in Python, \
         chapter 15",
    ),
    (
        &[
            "maxwell",
            "kelvinvoigt",
            "zener",
            "sls",
            "prony",
            "generalizedmaxwell",
            "maxwellweichert",
            "viscous",
        ],
        "here: `viscoelastic`, with bulk_modulus, shear_modulus and a list `prony`; `[damping]` slows a whole body down",
    ),
    (
        &[
            "isosoftening",
            "brittle",
            "concrete",
            "rankine",
            "phasefield",
            "fracture",
            "cohesivezone",
            "gurson",
        ],
        "here: `damage`, which softens as it cracks, with tensile_strength and fracture_energy",
    ),
    (
        &["orthotropic", "anisotropic", "transverselyisotropic", "cubic", "composite", "fibre", "fiber"],
        "here: all laws are isotropic; one that is not is a law of your own in Python, chapter 15",
    ),
    (&["rigid", "rigidcontact", "rigidbc"], "here: a key of the body, rigid = {}; its material is any"),
    (
        &["type", "model", "law", "constitutivemodel", "constitutivelaw", "umat", "vumat"],
        "here: a law is a table by its own name, such as neo_hookean = { young_modulus = \"1 MPa\", poisson_ratio = 0.3 }; \
         a law of your own is a function in Python, chapter 15",
    ),
    (
        &[
            "e",
            "youngsmodulus",
            "youngmodulus",
            "nu",
            "poissonratio",
            "poisson",
            "bulkmodulus",
            "shearmodulus",
            "k",
            "g",
        ],
        "here: a constant of the law, in its table: neo_hookean = { young_modulus = \"1 MPa\", poisson_ratio = 0.3 }",
    ),
];

/// What there is here for a law of this name in another program.
pub fn answer(name: &str) -> Option<&'static str> {
    let plain: String = name.to_lowercase().chars().filter(|letter| letter.is_alphanumeric()).collect();
    ELSEWHERE.iter().find(|(names, _)| names.contains(&plain.as_str())).map(|(_, answer)| *answer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::LAWS;

    #[test]
    fn names_are_found_as_other_programs_write_them() {
        for name in ["soil", "Cam Clay", "cam_clay", "Zerilli Armstrong", "arruda_boyce"] {
            assert!(answer(name).is_some_and(|text| text.starts_with("here: ")), "{name}");
        }
        assert_eq!(answer("rubber"), None);
    }

    /// No name stands twice, none is a law of ours, and what is named in answers is.
    #[test]
    fn every_name_has_one_answer() {
        let names: Vec<&str> = ELSEWHERE.iter().flat_map(|(names, _)| *names).copied().collect();
        for (i, name) in names.iter().enumerate() {
            assert!(!names[..i].contains(name), "{name}");
            assert!(LAWS.iter().all(|law| law.name.replace('_', "") != *name), "{name}");
        }
        for law in LAWS {
            assert!(
                ELSEWHERE.iter().any(|(_, answer)| answer.contains(&format!("`{}`", law.name))),
                "{}",
                law.name
            );
        }
    }
}
