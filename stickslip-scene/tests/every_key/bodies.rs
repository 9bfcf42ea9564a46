//! Keys of bodies, and of what makes many of them.

use crate::{Cases, PLANE, SPACE};

const BOX: &str = "{ name = 'g', material = 'm', shape.box = { min = [0, 0.5], max = [0.05, 0.55] } }";
const PACKED: &str = "[{ name = 'g', material = 'm', shape.box = { min = [0, 0], max = [0.02, 0.03] }, \
                      within.box = { min = [0, 0.5], max = [0.3, 0.8] }, count = 3 }]";
const IMAGE: &str = "[{ name = 'g', material = 'm', file = 'labels.png', pixel = '1 cm' }]";
const CLOUD: &str = "[{ name = 'g', material = 'm', file = 'grains.csv', unit = '5 mm' }]";

pub const CASES: &[Cases] = &[
    Cases {
        scene: PLANE,
        with: &[("space.domain.y_min", "symmetry"), ("bodies[0].shape.box.min", "[0, -1.1]")],
        keys: &[("bodies[0].beyond_mirrors", "cut")],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "materials.n",
            "{ density = 1, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }",
        )],
        keys: &[
            ("bodies[0].name", "other"),
            ("bodies[0].material", "n"),
            ("bodies[0].shape", "tip"),
            ("bodies[0].particles", "fitted"),
            ("bodies[0].particles_per_side", "3"),
            ("bodies[0].interior", "reference"),
            ("bodies[0].cell", "2 mm"),
            ("bodies[0].velocity", "[1, 0]"),
            ("bodies[0].spin", "1"),
            ("bodies[0].rigid", "{}"),
            ("bodies[3].rigid.velocity", "[1, 0]"),
            ("bodies[3].rigid.displacement", "['t * 1 m/s', 0]"),
            ("bodies[3].rigid.spin", "1"),
            ("bodies[3].rigid.velocity.outside", "push"),
            ("bodies[3].rigid.spin.outside", "push"),
            ("bodies[0].rigid.free", "{}"),
            ("bodies[2].rigid.free.mass", "3"),
            ("bodies[2].rigid.free.inertia", "3"),
            ("bodies[0].stress", "{ xx = 1 }"),
            ("bodies[0].stress.xx", "1"),
            ("bodies[0].stress.yy", "1"),
            ("bodies[0].stress.zz", "1"),
            ("bodies[0].stress.xy", "1"),
            ("bodies[0].array", "{ ring = { center = [0, 0], count = 3 } }"),
            ("bodies[0].array.ring", "{ center = [0, 0], count = 3 }"),
            ("bodies[0].array.square", "{ spacing = 0.2, counts = [2, 2] }"),
            ("bodies[0].array.hexagonal", "{ spacing = 0.2, counts = [2, 2] }"),
            ("bodies[0].array.path", "{ points = [[0, 0], [1, 0]], spacing = 0.2 }"),
            ("bodies", "[{ name = 'e', material = 'm', shape = 'tip' }]"),
            ("packings", PACKED),
            ("images", IMAGE),
            ("point_clouds", CLOUD),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].name", "'a {i}'"), ("bodies[0].repeat", "{ i = 2 }")],
        keys: &[("bodies[0].repeat", "{ i = 3 }")],
    },
    Cases { scene: SPACE, with: &[], keys: &[("bodies[0].stress.yz", "1"), ("bodies[0].stress.xz", "1")] },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].array", "{ square = { spacing = 0.2, counts = [2, 2] } }")],
        keys: &[("bodies[0].array.square.spacing", "0.3"), ("bodies[0].array.square.counts", "[3, 2]")],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].array.square.spacing", "0.2")],
        keys: &[("bodies[0].array.square.within", "{ box = { min = [0, 0], max = [0.5, 0.5] } }")],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].array", "{ ring = { center = [0, 0], count = 3 } }")],
        keys: &[
            ("bodies[0].array.ring.center", "[1, 0]"),
            ("bodies[0].array.ring.count", "4"),
            ("bodies[0].array.ring.angle", "20 deg"),
            ("bodies[0].array.ring.orientation", "kept"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].array", "{ ring = { center = [0, 0, 0], axis = [0, 0, 1], count = 3 } }")],
        keys: &[("bodies[0].array.ring.axis", "[0, 1, 0]")],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].array", "{ path = { points = [[0, 0], [1, 0], [1, 1]], spacing = 0.2 } }")],
        keys: &[
            ("bodies[0].array.path.points", "[[0, 0], [2, 0], [1, 1]]"),
            ("bodies[0].array.path.curve", "smooth"),
            ("bodies[0].array.path.spacing", "0.3"),
            ("bodies[0].array.path.orientation", "kept"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[
            ("materials.n", "{ density = 1, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }"),
            ("packings", PACKED),
        ],
        keys: &[
            ("packings[0].name", "other"),
            ("packings[0].material", "n"),
            ("packings[0].shape", "{ ball = { center = [0, 0], radius = 0.01 } }"),
            ("packings[0].sizes", "{ uniform = [0.8, 1.2] }"),
            ("packings[0].sizes.uniform", "[0.8, 1.2]"),
            ("packings[0].sizes.normal", "[1, 0.1]"),
            ("packings[0].sizes.lognormal", "[1, 0.1]"),
            ("packings[0].sizes.numbers", "[[1, 0.5], [2, 0.5]]"),
            ("packings[0].sizes.volumes", "[[1, 0.5], [2, 0.5]]"),
            ("packings[0].within", "{ box = { min = [0, 0.5], max = [0.4, 0.8] } }"),
            ("packings[0].count", "4"),
            ("packings[0].gap", "0.08"),
            ("packings[0].settle", "[0, -1]"),
            ("packings[0].orientation", "kept"),
            ("packings[0].seed", "5"),
            ("packings[0].particles", "lattice"),
            ("packings[0].particles_per_side", "3"),
            ("packings[0].interior", "reference"),
            ("packings[0].cell", "2 mm"),
            ("packings[0].velocity", "[1, 0]"),
            ("packings[0].spin", "1"),
            ("packings[0].rigid", "{}"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "packings",
            "[{ name = 'g', material = 'm', shape.ball = { center = [0, 0], radius = 0.02 }, \
             within.box = { min = [0, 0.5], max = [0.3, 0.8] }, solid_fraction = 0.2 }]",
        )],
        keys: &[("packings[0].solid_fraction", "0.3")],
    },
    Cases {
        scene: PLANE,
        with: &[
            ("materials.n", "{ density = 1, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }"),
            ("images", IMAGE),
        ],
        keys: &[
            ("images[0].name", "other"),
            ("images[0].file", "others.png"),
            ("images[0].pixel", "2 cm"),
            ("images[0].origin", "[1, 0]"),
            ("images[0].material", "n"),
            ("images[0].background", "3"),
            ("images[0].labels", "[3]"),
            ("images[0].threshold", "5"),
            ("images[0].least_pixels", "2"),
            ("images[0].particles_per_side", "3"),
            ("images[0].interior", "reference"),
            ("images[0].cell", "2 mm"),
            ("images[0].velocity", "[1, 0]"),
            ("images[0].spin", "1"),
            ("images[0].rigid", "{}"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("images", IMAGE), ("images[0].threshold", "5")],
        keys: &[("images[0].solid", "dark")],
    },
    Cases {
        scene: PLANE,
        with: &[
            ("materials.n", "{ density = 1, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }"),
            ("point_clouds", CLOUD),
        ],
        keys: &[
            ("point_clouds[0].name", "other"),
            ("point_clouds[0].file", "stones.csv"),
            ("point_clouds[0].unit", "4 mm"),
            ("point_clouds[0].material", "n"),
            ("point_clouds[0].velocity", "[1, 0]"),
            ("point_clouds[0].spin", "1"),
            ("point_clouds[0].rigid", "{}"),
        ],
    },
    Cases { scene: PLANE, with: &[], keys: &[("bodies[1]", BOX)] },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].shape", "tip")],
        keys: &[("shapes", "{ tip.ball = { center = [0, 0], radius = 0.2 } }")],
    },
];
