//! Names of laws that other programs have, and what there is here for each.

use crate::material::LAWS;

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
            "linearelasticity",
            "isotropicelastic",
            "elasticisotropic",
        ],
        "here: `hypoelastic`, Hooke's law that turns with the material, for small strains; `hencky`, in logarithmic strain, \
         for moderate and `neo_hookean` for large ones",
    ),
    (
        &[
            "neohooke",
            "neoh",
            "compneohook",
            "hyperelastic",
            "corotated",
            "fixedcorotated",
            "jelly",
            "clampedneohookean",
            "heisotropic",
        ],
        "here: `neo_hookean`, for large strains and rotations",
    ),
    (
        &[
            "mooney",
            "mooneyrivlinrubber",
            "compmooneyrivlin",
            "ogdenrubber",
            "hyperelasticrubber",
            "simplifiedrubber",
            "yeoh",
            "arrudaboyce",
            "gent",
            "marlow",
            "vanderwaals",
            "polynomial",
            "reducedpolynomial",
            "murnaghan",
            "mullins",
            "blatzko",
            "hyperfoam",
        ],
        "here: `mooney_rivlin`, with c10, c01 and bulk_modulus, or `ogden`, with pairs of modulus and exponent; another \
         one is a law of your own in Python, chapter 15",
    ),
    (
        &[
            "chaboche",
            "lemaitrechaboche",
            "kinematichardening",
            "kinematic",
            "plastickinematic",
            "combinedhardening",
            "prager",
        ],
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
            "mises",
            "plasticity",
            "metalplasticity",
            "perfectplasticity",
            "perfectlyplastic",
            "elasticplastic",
            "elasticplastichp",
            "elasticplastichydro",
            "isotropicelasticplastic",
            "hypoelasticplastic",
            "piecewiselinearplasticity",
            "bilinear",
            "linearhardening",
            "ucnh",
        ],
        "here: `von_mises`, with yield_stress and hardening_modulus, or a hardening_table",
    ),
    (
        &[
            "john",
            "sjc",
            "sjcf",
            "jc",
            "jcf",
            "steinberg",
            "steinbergcochranguinan",
            "scgl",
            "zerilliarmstrong",
        ],
        "here: `johnson_cook`, with yield_stress = A, hardening_modulus = B, hardening_exponent = n, rate_coefficient = C \
         and thermal_exponent = m",
    ),
    (
        &["powerlaw", "powerlawplasticity", "ludwik", "hollomon", "swift", "rambergosgood"],
        "here: `johnson_cook` alone hardens by a power of the plastic strain, yield_stress + hardening_modulus times \
         strain^hardening_exponent; without rate_coefficient and thermal_exponent by that alone",
    ),
    (
        &["voce", "nonlinearhardening", "saturationhardening"],
        "here: `von_mises` saturates, with saturation_stress and saturation_exponent, or follows a hardening_table",
    ),
    (
        &[
            "perzyna",
            "viscoplastic",
            "viscoplasticity",
            "ratedependent",
            "strainratedependentplasticity",
            "cowpersymonds",
        ],
        "here: `von_mises` with reference_rate and rate_exponent flows as Cowper, Symonds and Perzyna have it; \
         `johnson_cook` hardens by the logarithm of its rate",
    ),
    (
        &["creep", "norton", "nortonhoff", "garofalo", "duvautlions", "anand", "bodnerpartom"],
        "here: `von_mises` flows by a power of its overstress, with reference_rate and rate_exponent, `fluid` with a \
         viscosity above its yield_stress; creep below it is a law of your own in Python, chapter 15",
    ),
    (
        &[
            "gurson",
            "gtn",
            "ductiledamage",
            "damageinitiation",
            "damagejohnsoncook",
            "johnsoncookdamage",
            "johnsoncookfailure",
            "erosion",
        ],
        "here: `johnson_cook` fails by a strain, with d1 to d5; no law has pores that grow",
    ),
    (
        &["hoekbrown", "matsuokanakai", "ladeduncan", "lade", "jointedrock", "jointedmaterial", "rock"],
        "here: `mohr_coulomb`, with friction_angle and cohesion fitted to the pressures in question; a curved envelope or \
         joints are a law of your own in Python, chapter 15",
    ),
    (
        &[
            "jh1",
            "jh2",
            "jhc",
            "hjc",
            "johnsonholmquist",
            "johnsonholmquistceramics",
            "johnsonholmquistconcrete",
            "rht",
            "ceramic",
            "ceramics",
            "glass",
            "kayenta",
            "arenisca",
            "arenisca3",
            "arena",
            "cscm",
            "winfrith",
            "concretedamagerel3",
            "pseudotensor",
            "soilconcrete",
        ],
        "here: none that tension cracks and pressure crushes: `damage` cracks, the strength of `mohr_coulomb` grows with \
         pressure; both in one are a law of your own in Python, chapter 15",
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
        &[
            "camclay",
            "clay",
            "mcc",
            "originalcamclay",
            "cap",
            "capplasticity",
            "clayplasticity",
            "geologiccapmodel",
            "soilandfoam",
            "soilfoam",
            "snow",
        ],
        "here: `modified_cam_clay`, which hardens as it is compacted, with critical_slope, compression_slope and \
         swelling_slope",
    ),
    (
        &["foam", "metalfoam", "deshpandefleckfoam", "deshpandefleck", "lowdensityfoam", "honeycomb"],
        "here: `crushable_foam`, with plateau_stress, plastic_poisson_ratio and a densification_strain, which stays \
         crushed; foam that comes back is a body drawn with its pores, or a law of your own in Python, chapter 15",
    ),
    (
        &["norsand", "hypoplastic", "hypoplasticity", "hardeningsoil", "externalsoilmodel"],
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
            "taitliquid",
            "binghamliquid",
            "idealgas",
            "gas",
        ],
        "here: `fluid`, with bulk_modulus, pressure_exponent (7 for water; of a gas its ratio of heat capacities, with \
         bulk_modulus that times the pressure), viscosity and yield_stress",
    ),
    (
        &[
            "eos",
            "miegruneisen",
            "gruneisen",
            "tillotson",
            "jwl",
            "hiex",
            "shock",
            "seos",
            "linearpolynomial",
            "palpha",
            "jwlpp",
            "tabulareos",
            "explosive",
        ],
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
            "mwviscoelastic",
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
            "isophasefield",
            "fracture",
            "cohesivezone",
            "mazars",
            "smearedcracking",
            "brittlecracking",
            "concretedamagedplasticity",
            "cdp",
            "concretedamage",
        ],
        "here: `damage`, which softens as it cracks, with tensile_strength and fracture_energy",
    ),
    (
        &[
            "cohesive",
            "tractionlaw",
            "lineartraction",
            "exponentialtraction",
            "cubictraction",
            "spotweld",
            "adhesive",
        ],
        "here: surfaces that hold together are a rule of [[contact]], with cohesion and adhesion; cracks within a body \
         are `damage`",
    ),
    (
        &["superelastic", "superelasticity", "shapememory", "nitinol", "phasetransition", "bistable"],
        "here: none; it would be a law of your own in Python, chapter 15",
    ),
    (
        &["linearelasticpml", "pml"],
        "here: no layer that absorbs waves; a support with dashpot = \"absorbing\" does",
    ),
    (
        &[
            "orthotropic",
            "anisotropic",
            "transverselyisotropic",
            "cubic",
            "composite",
            "fibre",
            "fiber",
            "orthotropicelastic",
            "compositedamage",
            "transisotropic",
            "transisotropic1",
            "transisotropic2",
            "transisohyper",
            "hill",
            "hillplastic",
            "barlat",
            "holzapfel",
            "hgo",
            "anisotropichyperelastic",
            "muscle",
        ],
        "here: all laws are isotropic; one that is not is a law of your own in Python, chapter 15",
    ),
    (&["rigid", "rigidcontact", "rigidbc"], "here: a key of the body, rigid = {}; its material is any"),
    (
        &[
            "type",
            "model",
            "law",
            "constitutivemodel",
            "constitutivelaw",
            "umat",
            "vumat",
            "usermaterial",
            "userdefined",
        ],
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

/// What there is here for a law of this name in another program: with `MAT_` before it as in LS-DYNA and 2D or 3D
/// behind it as in CB-Geo MPM, too, and for other spellings of our own.
pub fn answer(name: &str) -> Option<String> {
    let plain: String = name.to_lowercase().chars().filter(|letter| letter.is_alphanumeric()).collect();
    let bare = plain.strip_prefix("mat").unwrap_or(&plain);
    let bare = bare.strip_suffix("2d").or_else(|| bare.strip_suffix("3d")).unwrap_or(bare);
    let other = |plain: &str| ELSEWHERE.iter().find(|(names, _)| names.contains(&plain));
    if let Some((_, answer)) = other(&plain).or_else(|| other(bare)) {
        return Some(answer.to_string());
    }
    let ours = LAWS.iter().find(|law| law.name.replace('_', "") == bare);
    ours.map(|law| format!("did you mean `{}`?", law.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_as_other_programs_write_them() {
        for name in ["soil", "Cam Clay", "cam_clay", "Zerilli Armstrong", "arruda_boyce"] {
            assert!(answer(name).is_some_and(|text| text.starts_with("here: ")), "{name}");
        }
        for (name, ours) in [
            ("MAT_DRUCKER_PRAGER", "did you mean `drucker_prager`?"),
            ("MohrCoulomb3D", "did you mean `mohr_coulomb`?"),
            ("NeoHookean", "did you mean `neo_hookean`?"),
        ] {
            assert_eq!(answer(name).as_deref(), Some(ours));
        }
        assert_eq!(answer("rubber"), None);
    }

    /// Names of LS-DYNA, Abaqus, Uintah, NairnMPM, Karamelo and CB-Geo MPM: what the line begins with. Laws that have
    /// no counterpart say so.
    #[test]
    fn names_of_six_programs_have_a_true_line() {
        for (names, line) in [
            (
                &["jh2", "johnson_holmquist", "MAT_JOHNSON_HOLMQUIST_CERAMICS", "kayenta"][..],
                "here: none that tension",
            ),
            (&["hoek_brown"], "here: `mohr_coulomb`"),
            (&["creep", "norton"], "here: `von_mises` flows by a power of its overstress"),
            (&["perzyna", "Cowper-Symonds"], "here: `von_mises` with reference_rate"),
            (&["voce"], "here: `von_mises` saturates"),
            (&["MAT_DESHPANDE_FLECK_FOAM", "foam"], "here: `crushable_foam`"),
            (&["MAT_CRUSHABLE_FOAM"], "did you mean `crushable_foam`?"),
            (&["mises", "plasticity", "MAT_PIECEWISE_LINEAR_PLASTICITY"], "here: `von_mises`"),
            (&["concrete", "Concrete Damaged Plasticity"], "here: `damage`"),
            (&["MAT_PLASTIC_KINEMATIC"], "here: `armstrong_frederick`"),
            (&["ExponentialTraction"], "here: surfaces that hold together"),
            (&["damage_johnson_cook"], "here: `johnson_cook` fails by a strain"),
            (&["LinearElastic3D"], "here: `hypoelastic`"),
            (&["LinearElasticPML2D"], "here: no layer that absorbs waves"),
            (&["TransIsotropic1"], "here: all laws are isotropic"),
        ] {
            for name in names {
                let answer = answer(name).unwrap_or_default();
                assert!(answer.starts_with(line), "{name}: {answer}");
            }
        }
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
