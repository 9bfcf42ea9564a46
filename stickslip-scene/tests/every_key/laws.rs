//! Keys of materials and of contact rules.

use crate::{Cases, PLANE};

const RULE: &str = "[{ law = 'surface' }]";

pub const CASES: &[Cases] = &[
    Cases {
        scene: PLANE,
        with: &[],
        keys: &[
            (
                "materials",
                "{ m = { density = 1, hypoelastic = { young_modulus = 1e6, poisson_ratio = 0.3 } } }",
            ),
            ("materials.m.density", "2000"),
            ("materials.m.volume_change", "averaged"),
            ("materials.m.thermal_expansion", "1e-5"),
            ("materials.m.neo_hookean", "{ young_modulus = 2e6, poisson_ratio = 0.3 }"),
            ("materials.m.neo_hookean.young_modulus", "2e6"),
            ("materials.m.neo_hookean.poisson_ratio", "0.2"),
            ("contact", "[{ friction = 0.3 }]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, neo_hookean = { bulk_modulus = 1e6, shear_modulus = 1e6 } }",
        )],
        keys: &[
            ("materials.m.neo_hookean.bulk_modulus", "2e6"),
            ("materials.m.neo_hookean.shear_modulus", "2e6"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, neo_hookean = { p_wave_modulus = 1e6, poisson_ratio = 0.3 } }",
        )],
        keys: &[("materials.m.neo_hookean.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, hypoelastic = { bulk_modulus = 1e6, shear_modulus = 1e6 } }",
        )],
        keys: &[
            ("materials.m.hypoelastic", "{ bulk_modulus = 3e6, shear_modulus = 1e6 }"),
            ("materials.m.hypoelastic.bulk_modulus", "2e6"),
            ("materials.m.hypoelastic.shear_modulus", "2e6"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, hypoelastic = { young_modulus = 1e6, poisson_ratio = 0.3 } }",
        )],
        keys: &[
            ("materials.m.hypoelastic.young_modulus", "2e6"),
            ("materials.m.hypoelastic.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, hypoelastic = { p_wave_modulus = 1e6, poisson_ratio = 0.3 } }",
        )],
        keys: &[("materials.m.hypoelastic.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[("materials.m", "{ density = 1, hencky = { bulk_modulus = 1e6, shear_modulus = 1e6 } }")],
        keys: &[
            ("materials.m.hencky", "{ bulk_modulus = 3e6, shear_modulus = 1e6 }"),
            ("materials.m.hencky.bulk_modulus", "2e6"),
            ("materials.m.hencky.shear_modulus", "2e6"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("materials.m", "{ density = 1, hencky = { young_modulus = 1e6, poisson_ratio = 0.3 } }")],
        keys: &[("materials.m.hencky.young_modulus", "2e6"), ("materials.m.hencky.poisson_ratio", "0.2")],
    },
    Cases {
        scene: PLANE,
        with: &[("materials.m", "{ density = 1, hencky = { p_wave_modulus = 1e6, poisson_ratio = 0.3 } }")],
        keys: &[("materials.m.hencky.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[("materials.m", "{ density = 1, ogden = { terms = [[1e5, 2]], bulk_modulus = 1e6 } }")],
        keys: &[
            ("materials.m.ogden", "{ terms = [[2e5, 2]], bulk_modulus = 1e6 }"),
            ("materials.m.ogden.terms", "[[1e5, 3]]"),
            ("materials.m.ogden.bulk_modulus", "2e6"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, armstrong_frederick = { bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 1e3, \
             kinematic_modulus = 1e4 } }",
        )],
        keys: &[
            (
                "materials.m.armstrong_frederick",
                "{ bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 2e3, kinematic_modulus = 1e4 }",
            ),
            ("materials.m.armstrong_frederick.bulk_modulus", "2e6"),
            ("materials.m.armstrong_frederick.shear_modulus", "2e6"),
            ("materials.m.armstrong_frederick.yield_stress", "2e3"),
            ("materials.m.armstrong_frederick.kinematic_modulus", "2e4"),
            ("materials.m.armstrong_frederick.dynamic_recovery", "10"),
            ("materials.m.armstrong_frederick.hardening_modulus", "1e3"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, armstrong_frederick = { young_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e3, kinematic_modulus = 1e4 } }",
        )],
        keys: &[
            ("materials.m.armstrong_frederick.young_modulus", "2e6"),
            ("materials.m.armstrong_frederick.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, armstrong_frederick = { p_wave_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e3, kinematic_modulus = 1e4 } }",
        )],
        keys: &[("materials.m.armstrong_frederick.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[("materials.m", "{ density = 1, mooney_rivlin = { c10 = 1e5, bulk_modulus = 1e6 } }")],
        keys: &[
            ("materials.m.mooney_rivlin", "{ c10 = 2e5, bulk_modulus = 1e6 }"),
            ("materials.m.mooney_rivlin.c10", "2e5"),
            ("materials.m.mooney_rivlin.c01", "1e5"),
            ("materials.m.mooney_rivlin.bulk_modulus", "2e6"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("materials.m", "{ density = 1, fluid = { bulk_modulus = 1e6, viscosity = 0.1 } }")],
        keys: &[
            ("materials.m.fluid", "{ bulk_modulus = 2e6 }"),
            ("materials.m.fluid.bulk_modulus", "2e6"),
            ("materials.m.fluid.pressure_exponent", "1.4"),
            ("materials.m.fluid.tensile_strength", "0"),
            ("materials.m.fluid.viscosity", "0.2"),
            ("materials.m.fluid.yield_stress", "10"),
            ("materials.m.fluid.flow_exponent", "0.5"),
            ("materials.m.fluid.shear_modulus", "1e6"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, johnson_cook = { bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 1e3, \
             thermal_exponent = 1, melting_temperature = 1000, heat_capacity = 1e6 } }",
        )],
        keys: &[
            ("materials.m.johnson_cook", "{ bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 2e3 }"),
            ("materials.m.johnson_cook.bulk_modulus", "2e6"),
            ("materials.m.johnson_cook.shear_modulus", "2e6"),
            ("materials.m.johnson_cook.yield_stress", "2e3"),
            ("materials.m.johnson_cook.hardening_modulus", "1e3"),
            ("materials.m.johnson_cook.hardening_exponent", "0.5"),
            ("materials.m.johnson_cook.rate_coefficient", "0.1"),
            ("materials.m.johnson_cook.reference_rate", "2"),
            ("materials.m.johnson_cook.thermal_exponent", "2"),
            ("materials.m.johnson_cook.melting_temperature", "2000"),
            ("materials.m.johnson_cook.room_temperature", "300"),
            ("materials.m.johnson_cook.heat_capacity", "2e6"),
            ("materials.m.johnson_cook.heated_share", "1"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, johnson_cook = { bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 1e3, d1 = 0.1 } }",
        )],
        keys: &[
            ("materials.m.johnson_cook.d1", "0.2"),
            ("materials.m.johnson_cook.d2", "0.2"),
            ("materials.m.johnson_cook.d3", "-1.5"),
            ("materials.m.johnson_cook.d4", "0.1"),
            ("materials.m.johnson_cook.d5", "1"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, johnson_cook = { young_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e3 } }",
        )],
        keys: &[
            ("materials.m.johnson_cook.young_modulus", "2e6"),
            ("materials.m.johnson_cook.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, johnson_cook = { p_wave_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e3 } }",
        )],
        keys: &[("materials.m.johnson_cook.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, von_mises = { bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 1e3 } }",
        )],
        keys: &[
            ("materials.m.von_mises", "{ bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 2e3 }"),
            ("materials.m.von_mises.bulk_modulus", "2e6"),
            ("materials.m.von_mises.shear_modulus", "2e6"),
            ("materials.m.von_mises.yield_stress", "2e3"),
            ("materials.m.von_mises.hardening_modulus", "1e3"),
            ("materials.m.von_mises.hardening_table", "[[0.1, 2e3]]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, von_mises = { bulk_modulus = 1e6, shear_modulus = 1e6, yield_stress = 1e3, \
             saturation_stress = 1e3, saturation_exponent = 10, reference_rate = 40, rate_exponent = 5 } }",
        )],
        keys: &[
            ("materials.m.von_mises.saturation_stress", "2e3"),
            ("materials.m.von_mises.saturation_exponent", "20"),
            ("materials.m.von_mises.reference_rate", "50"),
            ("materials.m.von_mises.rate_exponent", "4"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, von_mises = { young_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e3 } }",
        )],
        keys: &[
            ("materials.m.von_mises.young_modulus", "2e6"),
            ("materials.m.von_mises.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, von_mises = { p_wave_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 1e3 } }",
        )],
        keys: &[("materials.m.von_mises.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, crushable_foam = { bulk_modulus = 1e6, shear_modulus = 1e6, plateau_stress = 1e3 } }",
        )],
        keys: &[
            (
                "materials.m.crushable_foam",
                "{ bulk_modulus = 1e6, shear_modulus = 1e6, plateau_stress = 2e3 }",
            ),
            ("materials.m.crushable_foam.bulk_modulus", "2e6"),
            ("materials.m.crushable_foam.shear_modulus", "2e6"),
            ("materials.m.crushable_foam.plateau_stress", "2e3"),
            ("materials.m.crushable_foam.plastic_poisson_ratio", "0.2"),
            ("materials.m.crushable_foam.hardening_modulus", "1e3"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, crushable_foam = { bulk_modulus = 1e6, shear_modulus = 1e6, plateau_stress = 1e3, \
             densification_strain = 1, densification_stress = 1e3, densification_exponent = 3 } }",
        )],
        keys: &[
            ("materials.m.crushable_foam.densification_strain", "2"),
            ("materials.m.crushable_foam.densification_stress", "2e3"),
            ("materials.m.crushable_foam.densification_exponent", "4"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, crushable_foam = { young_modulus = 1e6, poisson_ratio = 0.3, plateau_stress = 1e3 } }",
        )],
        keys: &[
            ("materials.m.crushable_foam.young_modulus", "2e6"),
            ("materials.m.crushable_foam.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, crushable_foam = { p_wave_modulus = 1e6, poisson_ratio = 0.3, plateau_stress = 1e3 } }",
        )],
        keys: &[("materials.m.crushable_foam.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, viscoelastic = { bulk_modulus = 1e6, shear_modulus = 1e6, prony = [[0.5, 1]] } }",
        )],
        keys: &[
            ("materials.m.viscoelastic", "{ bulk_modulus = 3e6, shear_modulus = 1e6, prony = [[0.5, 1]] }"),
            ("materials.m.viscoelastic.bulk_modulus", "2e6"),
            ("materials.m.viscoelastic.shear_modulus", "2e6"),
            ("materials.m.viscoelastic.prony", "[[0.4, 1]]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, viscoelastic = { young_modulus = 1e6, poisson_ratio = 0.3, prony = [[0.5, 1]] } }",
        )],
        keys: &[
            ("materials.m.viscoelastic.young_modulus", "2e6"),
            ("materials.m.viscoelastic.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, viscoelastic = { p_wave_modulus = 1e6, poisson_ratio = 0.3, prony = [[0.5, 1]] } }",
        )],
        keys: &[("materials.m.viscoelastic.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, damage = { bulk_modulus = 1e9, shear_modulus = 1e9, tensile_strength = 1e6, \
             fracture_energy = 100 } }",
        )],
        keys: &[
            (
                "materials.m.damage",
                "{ bulk_modulus = 2e9, shear_modulus = 1e9, tensile_strength = 1e6, fracture_energy = 100 }",
            ),
            ("materials.m.damage.bulk_modulus", "2e9"),
            ("materials.m.damage.shear_modulus", "2e9"),
            ("materials.m.damage.tensile_strength", "2e6"),
            ("materials.m.damage.fracture_energy", "200"),
            ("materials.m.damage.strength_ratio", "8"),
            ("materials.m.damage.criterion", "modified-von-mises"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, damage = { young_modulus = 1e9, poisson_ratio = 0.3, tensile_strength = 1e6, \
             fracture_energy = 100 } }",
        )],
        keys: &[("materials.m.damage.young_modulus", "2e9"), ("materials.m.damage.poisson_ratio", "0.2")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, damage = { p_wave_modulus = 1e9, poisson_ratio = 0.3, tensile_strength = 1e6, \
             fracture_energy = 100 } }",
        )],
        keys: &[("materials.m.damage.p_wave_modulus", "2e9")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, drucker_prager = { bulk_modulus = 1e6, shear_modulus = 1e6, friction_angle = '30 deg' } }",
        )],
        keys: &[
            (
                "materials.m.drucker_prager",
                "{ bulk_modulus = 2e6, shear_modulus = 1e6, friction_angle = '30 deg' }",
            ),
            ("materials.m.drucker_prager.bulk_modulus", "2e6"),
            ("materials.m.drucker_prager.shear_modulus", "2e6"),
            ("materials.m.drucker_prager.friction_angle", "20 deg"),
            ("materials.m.drucker_prager.dilation_angle", "10 deg"),
            ("materials.m.drucker_prager.cohesion", "1e3"),
            ("materials.m.drucker_prager.tension_strength", "1e3"),
            ("materials.m.drucker_prager.fit", "plane-strain"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, drucker_prager = { young_modulus = 1e6, poisson_ratio = 0.3, friction_angle = 0.5 } }",
        )],
        keys: &[
            ("materials.m.drucker_prager.young_modulus", "2e6"),
            ("materials.m.drucker_prager.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, drucker_prager = { p_wave_modulus = 1e6, poisson_ratio = 0.3, friction_angle = 0.5 } }",
        )],
        keys: &[("materials.m.drucker_prager.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, mohr_coulomb = { bulk_modulus = 1e6, shear_modulus = 1e6, friction_angle = '30 deg' } }",
        )],
        keys: &[
            (
                "materials.m.mohr_coulomb",
                "{ bulk_modulus = 2e6, shear_modulus = 1e6, friction_angle = '30 deg' }",
            ),
            ("materials.m.mohr_coulomb.bulk_modulus", "2e6"),
            ("materials.m.mohr_coulomb.shear_modulus", "2e6"),
            ("materials.m.mohr_coulomb.friction_angle", "20 deg"),
            ("materials.m.mohr_coulomb.dilation_angle", "10 deg"),
            ("materials.m.mohr_coulomb.cohesion", "1e3"),
            ("materials.m.mohr_coulomb.tension_strength", "1e3"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, mohr_coulomb = { young_modulus = 1e6, poisson_ratio = 0.3, friction_angle = 0.5 } }",
        )],
        keys: &[
            ("materials.m.mohr_coulomb.young_modulus", "2e6"),
            ("materials.m.mohr_coulomb.poisson_ratio", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, mohr_coulomb = { p_wave_modulus = 1e6, poisson_ratio = 0.3, friction_angle = 0.5 } }",
        )],
        keys: &[("materials.m.mohr_coulomb.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, modified_cam_clay = { critical_slope = 1, compression_slope = 0.2, swelling_slope = 0.04, poisson_ratio = 0.3, \
             preconsolidation_pressure = 1e5, void_ratio = 1 } }",
        )],
        keys: &[
            (
                "materials.m.modified_cam_clay",
                "{ critical_slope = 0.8, compression_slope = 0.2, swelling_slope = 0.04, poisson_ratio = 0.3, \
             preconsolidation_pressure = 1e5, void_ratio = 1 }",
            ),
            ("materials.m.modified_cam_clay.critical_slope", "1.2"),
            ("materials.m.modified_cam_clay.compression_slope", "0.3"),
            ("materials.m.modified_cam_clay.swelling_slope", "0.05"),
            ("materials.m.modified_cam_clay.poisson_ratio", "0.2"),
            ("materials.m.modified_cam_clay.preconsolidation_pressure", "2e5"),
            ("materials.m.modified_cam_clay.void_ratio", "1.5"),
            ("materials.m.modified_cam_clay.tension_strength", "1e2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, mu_i = { bulk_modulus = 1e6, shear_modulus = 1e6, static_friction = 0.4, limiting_friction = 0.6, \
             grain_diameter = 1e-3, grain_density = 2500 } }",
        )],
        keys: &[
            (
                "materials.m.mu_i",
                "{ bulk_modulus = 2e6, shear_modulus = 1e6, static_friction = 0.4, limiting_friction = 0.6, \
             grain_diameter = 1e-3, grain_density = 2500 }",
            ),
            ("materials.m.mu_i.bulk_modulus", "2e6"),
            ("materials.m.mu_i.shear_modulus", "2e6"),
            ("materials.m.mu_i.static_friction", "0.5"),
            ("materials.m.mu_i.limiting_friction", "0.7"),
            ("materials.m.mu_i.inertial_number", "0.3"),
            ("materials.m.mu_i.grain_diameter", "2 mm"),
            ("materials.m.mu_i.grain_density", "2000"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, mu_i = { young_modulus = 1e6, poisson_ratio = 0.3, static_friction = 0.4, limiting_friction = 0.6, \
             grain_diameter = 1e-3, grain_density = 2500 } }",
        )],
        keys: &[("materials.m.mu_i.young_modulus", "2e6"), ("materials.m.mu_i.poisson_ratio", "0.2")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, mu_i = { p_wave_modulus = 1e6, poisson_ratio = 0.3, static_friction = 0.4, limiting_friction = 0.6, \
             grain_diameter = 1e-3, grain_density = 2500 } }",
        )],
        keys: &[("materials.m.mu_i.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, outside = { law = 'l', bulk_modulus = 1e6, shear_modulus = 1e6 } }",
        )],
        keys: &[
            ("materials.m.outside", "{ law = 'k', bulk_modulus = 1e6, shear_modulus = 1e6 }"),
            ("materials.m.outside.law", "k"),
            ("materials.m.outside.bulk_modulus", "2e6"),
            ("materials.m.outside.shear_modulus", "2e6"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, outside = { law = 'l', young_modulus = 1e6, poisson_ratio = 0.3 } }",
        )],
        keys: &[("materials.m.outside.young_modulus", "2e6"), ("materials.m.outside.poisson_ratio", "0.2")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.m",
            "{ density = 1, outside = { law = 'l', p_wave_modulus = 1e6, poisson_ratio = 0.3 } }",
        )],
        keys: &[("materials.m.outside.p_wave_modulus", "2e6")],
    },
    Cases {
        scene: PLANE,
        with: &[("contact", RULE)],
        keys: &[
            ("contact[0].between", "['a', 'b']"),
            ("contact[0].law", "gap"),
            ("contact[0].friction", "0.3"),
            ("contact[0].cohesion", "1"),
            ("contact[0].adhesion", "1"),
            ("contact[0].viscosity", "1"),
            ("contact[0].max_strain", "0.3"),
            ("contact[0].restitution", "0.5"),
            ("contact[0].overlap", "press"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("contact", RULE), ("contact[0].overlap", "press")],
        keys: &[("contact[0].press_time", "1 ms")],
    },
    Cases {
        scene: PLANE,
        with: &[("contact", RULE), ("contact[0].friction", "0.3")],
        keys: &[("contact[0].kinetic_friction", "0.2")],
    },
    Cases {
        scene: PLANE,
        with: &[("contact", RULE), ("contact[0].friction", "0.3"), ("contact[0].kinetic_friction", "0.2")],
        keys: &[("contact[0].friction_decay_speed", "1")],
    },
    Cases {
        scene: PLANE,
        with: &[
            ("contact", RULE),
            ("contact[0].friction_memory_length", "1 mm"),
            ("contact[0].friction_memory_speed", "1 cm/s"),
        ],
        keys: &[
            ("contact[0].friction_memory_length", "2 mm"),
            ("contact[0].friction_memory_speed", "2 cm/s"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("contact", RULE), ("contact[0].law", "kinematic")],
        keys: &[("contact[0].normal", "common")],
    },
];
