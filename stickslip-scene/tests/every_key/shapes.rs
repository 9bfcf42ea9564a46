//! Keys of shapes.

use crate::{Cases, PLANE, SPACE};

pub const CASES: &[Cases] = &[
    Cases {
        scene: PLANE,
        with: &[],
        keys: &[
            ("bodies[0].shape.box", "{ min = [0, 0], max = [0.2, 0.1] }"),
            ("bodies[0].shape.box.min", "[-0.1, 0]"),
            ("bodies[0].shape.box.max", "[0.2, 0.1]"),
            ("bodies[0].shape", "{ ball = { center = [0, 0], radius = 0.1 } }"),
            ("bodies[2].shape.ball", "{ center = [0, 0], radius = 0.1 }"),
            ("bodies[2].shape.ball.center", "[0, 0]"),
            ("bodies[2].shape.ball.radius", "0.2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].shape", "{ union = ['tip'] }")],
        keys: &[("bodies[0].shape.union", "['tip', { ball = { center = [1, 0], radius = 0.1 } }]")],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].shape", "{ intersection = ['tip'] }")],
        keys: &[(
            "bodies[0].shape.intersection",
            "['tip', { half_space = { point = [0, 0], normal = [0, 1] } }]",
        )],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].shape", "{ difference = ['tip'] }")],
        keys: &[(
            "bodies[0].shape.difference",
            "['tip', { half_space = { point = [0, 0], normal = [0, 1] } }]",
        )],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].shape", "{ half_space = { point = [0, 0], normal = [0, 1] } }")],
        keys: &[
            ("bodies[0].shape.half_space", "{ point = [0, 1], normal = [0, 1] }"),
            ("bodies[0].shape.half_space.point", "[0, 1]"),
            ("bodies[0].shape.half_space.normal", "[1, 1]"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[(
            "bodies[0].shape",
            "{ rotated = { shape.ball = { center = [0, 0, 0], radius = 1 }, center = [0, 0, 0], axis = [0, 0, 1], \
             angle = 1 } }",
        )],
        keys: &[
            (
                "bodies[0].shape.rotated",
                "{ shape.ball = { center = [0, 0, 0], radius = 2 }, center = [0, 0, 0], axis = [0, 0, 1], angle = 1 }",
            ),
            ("bodies[0].shape.rotated.shape", "{ ball = { center = [0, 0, 0], radius = 2 } }"),
            ("bodies[0].shape.rotated.center", "[1, 0, 0]"),
            ("bodies[0].shape.rotated.axis", "[0, 1, 0]"),
            ("bodies[0].shape.rotated.angle", "2"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].shape", "{ cylinder = { start = [0, 0, 0], end = [0, 0, 1], radius = 1 } }")],
        keys: &[
            ("bodies[0].shape.cylinder", "{ start = [0, 0, 0], end = [0, 0, 2], radius = 1 }"),
            ("bodies[0].shape.cylinder.start", "[0, 1, 0]"),
            ("bodies[0].shape.cylinder.end", "[0, 1, 1]"),
            ("bodies[0].shape.cylinder.radius", "2"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].shape", "{ cone = { start = [0, 0, 0], end = [0, 0, 1], start_radius = 1 } }")],
        keys: &[
            ("bodies[0].shape.cone", "{ start = [0, 0, 0], end = [0, 0, 2], start_radius = 1 }"),
            ("bodies[0].shape.cone.start", "[0, 1, 0]"),
            ("bodies[0].shape.cone.end", "[0, 1, 1]"),
            ("bodies[0].shape.cone.start_radius", "2"),
            ("bodies[0].shape.cone.end_radius", "0.5"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[(
            "bodies[0].shape",
            "{ ring = { center = [0, 0, 0], inner_radius = 1, outer_radius = 2, axis = [0, 0, 1], width = 1 } }",
        )],
        keys: &[
            (
                "bodies[0].shape.ring",
                "{ center = [0, 0, 1], inner_radius = 1, outer_radius = 2, axis = [0, 0, 1], width = 1 }",
            ),
            ("bodies[0].shape.ring.center", "[0, 1, 0]"),
            ("bodies[0].shape.ring.inner_radius", "1.5"),
            ("bodies[0].shape.ring.outer_radius", "3"),
            ("bodies[0].shape.ring.axis", "[0, 1, 0]"),
            ("bodies[0].shape.ring.width", "2"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].shape", "{ capsule = { start = [0, 0, 0], end = [0, 0, 1], radius = 1 } }")],
        keys: &[
            ("bodies[0].shape.capsule", "{ start = [0, 0, 0], end = [0, 0, 2], radius = 1 }"),
            ("bodies[0].shape.capsule.start", "[0, 1, 0]"),
            ("bodies[0].shape.capsule.end", "[0, 1, 1]"),
            ("bodies[0].shape.capsule.radius", "2"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[(
            "bodies[0].shape",
            "{ rounded_box = { min = [0, 0, 0], max = [1, 1, 1], rounding = 0.1 } }",
        )],
        keys: &[
            ("bodies[0].shape.rounded_box", "{ min = [0, 0, 0], max = [1, 1, 2], rounding = 0.1 }"),
            ("bodies[0].shape.rounded_box.min", "[-1, 0, 0]"),
            ("bodies[0].shape.rounded_box.max", "[2, 1, 1]"),
            ("bodies[0].shape.rounded_box.rounding", "0.2"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].shape", "{ ellipsoid = { center = [0, 0, 0], semi_axes = [1, 2, 3] } }")],
        keys: &[
            ("bodies[0].shape.ellipsoid", "{ center = [0, 0, 1], semi_axes = [1, 2, 3] }"),
            ("bodies[0].shape.ellipsoid.center", "[0, 1, 0]"),
            ("bodies[0].shape.ellipsoid.semi_axes", "[2, 2, 3]"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[(
            "bodies[0].shape",
            "{ superquadric = { center = [0, 0, 0], semi_axes = [1, 2, 3], exponent = 4 } }",
        )],
        keys: &[
            ("bodies[0].shape.superquadric", "{ center = [0, 0, 1], semi_axes = [1, 2, 3], exponent = 4 }"),
            ("bodies[0].shape.superquadric.center", "[0, 1, 0]"),
            ("bodies[0].shape.superquadric.semi_axes", "[2, 2, 3]"),
            ("bodies[0].shape.superquadric.exponent", "6"),
            ("bodies[0].shape.superquadric.exponent_along_z", "6"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[(
            "bodies[0].shape",
            "{ torus = { center = [0, 0, 0], axis = [0, 0, 1], radius = 2, tube_radius = 1 } }",
        )],
        keys: &[
            (
                "bodies[0].shape.torus",
                "{ center = [0, 0, 1], axis = [0, 0, 1], radius = 2, tube_radius = 1 }",
            ),
            ("bodies[0].shape.torus.center", "[0, 1, 0]"),
            ("bodies[0].shape.torus.axis", "[0, 1, 0]"),
            ("bodies[0].shape.torus.radius", "3"),
            ("bodies[0].shape.torus.tube_radius", "0.5"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].shape", "{ polygon = { points = [[0, 0], [1, 0], [0, 1]], height = [0, 1] } }")],
        keys: &[
            ("bodies[0].shape.polygon", "{ points = [[0, 0], [2, 0], [0, 1]], height = [0, 1] }"),
            ("bodies[0].shape.polygon.points", "[[0, 0], [2, 0], [0, 1]]"),
            ("bodies[0].shape.polygon.height", "[0, 2]"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].shape", "{ spline = { points = [[0, 0], [1, 0], [0, 1]], height = [0, 1] } }")],
        keys: &[
            ("bodies[0].shape.spline", "{ points = [[0, 0], [2, 0], [0, 1]], height = [0, 1] }"),
            ("bodies[0].shape.spline.points", "[[0, 0], [2, 0], [0, 1]]"),
            ("bodies[0].shape.spline.height", "[0, 2]"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[(
            "bodies[0].shape",
            "{ revolved = { polygon = [[0, 0], [1, 0], [0, 1]], center = [0, 0, 0], axis = [0, 0, 1] } }",
        )],
        keys: &[
            (
                "bodies[0].shape.revolved",
                "{ spline = [[1, 0], [2, 0], [1, 1]], center = [0, 0, 0], axis = [0, 0, 1] }",
            ),
            ("bodies[0].shape.revolved.polygon", "[[0, 0], [2, 0], [0, 1]]"),
            ("bodies[0].shape.revolved.center", "[1, 0, 0]"),
            ("bodies[0].shape.revolved.axis", "[0, 1, 0]"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[(
            "bodies[0].shape",
            "{ revolved = { spline = [[1, 0], [2, 0], [1, 1]], center = [0, 0, 0], axis = [0, 0, 1] } }",
        )],
        keys: &[("bodies[0].shape.revolved.spline", "[[1, 0], [3, 0], [1, 1]]")],
    },
    Cases {
        scene: SPACE,
        with: &[("bodies[0].shape", "{ mesh = { file = 'part.obj' } }")],
        keys: &[
            ("bodies[0].shape.mesh", "{ file = 'part.obj', scale = 2 }"),
            ("bodies[0].shape.mesh.file", "other.obj"),
            ("bodies[0].shape.mesh.scale", "2"),
            ("bodies[0].shape.mesh.translation", "[1, 0, 0]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].shape", "{ mesh = { file = 'part.obj', section = 0.2 } }")],
        keys: &[("bodies[0].shape.mesh.section", "0.3")],
    },
];
