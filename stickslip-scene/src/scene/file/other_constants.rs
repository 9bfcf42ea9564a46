//! Names that other programs and textbooks give the constants of laws, and what they are here.

/// Keys here, each with names elsewhere. Where a law has several of the keys for a name, the first is meant. One letter
/// is as it is written, for C is no c.
const ELSEWHERE: &[(&str, &[&str])] = &[
    (
        "yield_stress",
        &["A", "sigma_y", "sigma_0", "sigma0", "sigy", "sy", "fy", "yield", "yield_strength", "tau_y"],
    ),
    ("hardening_modulus", &["B", "H", "hardening"]),
    ("hardening_exponent", &["n", "N"]),
    ("saturation_stress", &["Q", "Q_inf", "Qinf"]),
    ("saturation_exponent", &["b"]),
    ("hardening_table", &["table", "curve", "hardening_curve"]),
    ("rate_coefficient", &["C"]),
    ("rate_exponent", &["P", "p", "q"]),
    ("reference_rate", &["epsdot0", "eps_dot_0", "epso", "edot0", "ep0", "reference_strain_rate"]),
    ("thermal_exponent", &["m"]),
    ("melting_temperature", &["Tm", "T_melt", "tmelt", "melting_point"]),
    ("room_temperature", &["Tr", "T_0", "T0", "troom", "reference_temperature"]),
    ("kinematic_modulus", &["C", "c"]),
    ("dynamic_recovery", &["gamma", "D"]),
    ("critical_slope", &["M"]),
    ("compression_slope", &["lambda"]),
    ("swelling_slope", &["kappa"]),
    ("preconsolidation_pressure", &["pc", "p_c", "pc0", "p_c0"]),
    ("void_ratio", &["e", "e0", "e_0"]),
    ("plateau_stress", &["sigp", "sigma_p", "sigma_pl"]),
    ("plastic_poisson_ratio", &["nup", "nu_p"]),
    ("densification_strain", &["epsd", "e_D", "eps_D"]),
    ("densification_stress", &["alpha2", "alpha_2"]),
    ("densification_exponent", &["beta"]),
    ("friction_angle", &["phi", "friction", "angle_of_friction"]),
    ("dilation_angle", &["psi", "dilatancy", "dilatancy_angle", "dilation"]),
    ("cohesion", &["c", "C"]),
    ("tension_strength", &["ft", "f_t", "tension_cutoff", "tension_cut_off", "tensile_strength"]),
    ("tensile_strength", &["ft", "f_t", "sigma_t", "tension_strength", "tension_cutoff"]),
    ("fracture_energy", &["Gf", "G_f", "gic", "GI_c"]),
    ("static_friction", &["mu_s", "mus", "mu_1", "mu1"]),
    ("limiting_friction", &["mu_2", "mu2"]),
    ("inertial_number", &["I0", "I_0"]),
    ("grain_diameter", &["d", "diameter"]),
    ("grain_density", &["rho_s", "rhos"]),
    ("pressure_exponent", &["gamma"]),
    ("viscosity", &["mu", "eta", "dynamic_viscosity", "visc"]),
    ("bulk_modulus", &["K", "k", "kappa"]),
    ("shear_modulus", &["G", "g", "mu"]),
    ("young_modulus", &["E", "e", "youngs_modulus", "youngs", "elastic_modulus"]),
    ("poisson_ratio", &["nu", "v", "pr", "poissons_ratio", "poisson"]),
    ("prony", &["terms", "branches"]),
];

/// The key among `known` that a name elsewhere stands for.
pub fn meant<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let is_it = |elsewhere: &&str| match elsewhere.len() {
        1 => *elsewhere == name,
        _ => elsewhere.eq_ignore_ascii_case(name),
    };
    let mut keys = ELSEWHERE.iter().filter(|(_, names)| names.iter().any(is_it));
    keys.find_map(|(key, _)| known.iter().copied().find(|known| known == key))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::LAWS;

    fn keys(law: &str) -> Vec<&'static str> {
        let law = LAWS.iter().find(|of| of.name == law).expect("a law");
        law.constants.iter().map(|constant| constant.name).collect()
    }

    /// Johnson and Cook (1983) eq. (1) has A, B, n, C and m; Chaboche's law C and gamma; Cam clay M, lambda, kappa.
    #[test]
    fn letters_of_papers_lead_to_the_keys_of_each_law() {
        for (law, of_paper) in [
            (
                "johnson_cook",
                &[
                    ("A", "yield_stress"),
                    ("B", "hardening_modulus"),
                    ("n", "hardening_exponent"),
                    ("C", "rate_coefficient"),
                    ("m", "thermal_exponent"),
                    ("E", "young_modulus"),
                    ("G", "shear_modulus"),
                    ("tmelt", "melting_temperature"),
                ][..],
            ),
            (
                "von_mises",
                &[("Q", "saturation_stress"), ("b", "saturation_exponent"), ("H", "hardening_modulus")],
            ),
            ("armstrong_frederick", &[("C", "kinematic_modulus"), ("gamma", "dynamic_recovery")]),
            (
                "modified_cam_clay",
                &[
                    ("M", "critical_slope"),
                    ("lambda", "compression_slope"),
                    ("kappa", "swelling_slope"),
                    ("e0", "void_ratio"),
                ],
            ),
            ("mohr_coulomb", &[("c", "cohesion"), ("phi", "friction_angle"), ("psi", "dilation_angle")]),
            ("mu_i", &[("mu_s", "static_friction"), ("mu2", "limiting_friction"), ("I0", "inertial_number")]),
            ("fluid", &[("gamma", "pressure_exponent"), ("eta", "viscosity"), ("K", "bulk_modulus")]),
            ("damage", &[("Gf", "fracture_energy"), ("f_t", "tensile_strength")]),
        ] {
            for (name, key) in of_paper {
                assert_eq!(meant(name, &keys(law)), Some(*key), "{law} {name}");
            }
        }
        assert_eq!(meant("c", &keys("johnson_cook")), None, "C of the rate is no c");
    }

    #[test]
    fn every_key_is_one_of_a_law() {
        for (key, _) in ELSEWHERE {
            assert!(LAWS.iter().any(|law| keys(law.name).contains(key)), "{key}");
        }
    }
}
