//! Keys of supports, loads, joints and springs.

use crate::{Cases, PLANE, SPACE};

pub const CASES: &[Cases] = &[
    Cases {
        scene: PLANE,
        with: &[],
        keys: &[
            ("supports", "[{ body = 'a' }]"),
            ("loads", "[{ body = 'a', pressure = 1 }]"),
            ("joints", "[{ body = 'c', weld = {} }]"),
            ("springs", "[{ from.body = 'a', to.body = 'b', stiffness = 1 }]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("supports", "[{ body = 'a' }]")],
        keys: &[
            ("supports[0].name", "other"),
            ("supports[0].body", "b"),
            ("supports[0].on", "y_min"),
            ("supports[0].within", "tip"),
            ("supports[0].displacement", "[1, 0]"),
            ("supports[0].velocity", "[1, 0]"),
            ("supports[0].stiffness", "1"),
            ("supports[0].dashpot", "1"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[
            ("supports", "[{ body = 'a', name = 's {i}', repeat = { i = 1 } }]"),
            ("loads", "[{ body = 'a', pressure = 1, name = 'l {i}', repeat = { i = 1 } }]"),
            ("joints", "[{ body = 'c', weld = {}, name = 'j {i}', repeat = { i = 1 } }]"),
            (
                "springs",
                "[{ from.body = 'a', to.body = 'b', stiffness = 1, name = 'k {i}', repeat = { i = 1 } }]",
            ),
        ],
        keys: &[
            ("supports[0].repeat", "{ i = 2 }"),
            ("loads[0].repeat", "{ i = 2 }"),
            ("joints[0].repeat", "{ i = 2 }"),
            ("springs[0].repeat", "{ i = 2 }"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', pressure = 1 }]")],
        keys: &[
            ("loads[0].name", "other"),
            ("loads[0].body", "b"),
            ("loads[0].on", "y_min"),
            ("loads[0].within", "tip"),
            ("loads[0].pressure", "2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', pressure = { table = [[0, 1]] } }]")],
        keys: &[("loads[0].pressure.table", "[[0, 1], [1, 2]]")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', pressure = { csv = 'two.csv' } }]")],
        keys: &[("loads[0].pressure.csv", "three.csv")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', pressure = { outside = 'pull' } }]")],
        keys: &[("loads[0].pressure.outside", "push")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', force = { outside = 'pull' } }]")],
        keys: &[("loads[0].force.outside", "push")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', traction = { outside = 'pull' } }]")],
        keys: &[("loads[0].traction.outside", "push")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', acceleration = { outside = 'pull' } }]")],
        keys: &[("loads[0].acceleration.outside", "push")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', pressure = { csv = 'push.csv', columns = [1, 2] } }]")],
        keys: &[("loads[0].pressure.columns", "[1, 3]")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', force = [1, 0] }]")],
        keys: &[("loads[0].force", "[2, 0]")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', traction = [1, 0] }]")],
        keys: &[("loads[0].traction", "[2, 0]")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', acceleration = [1, 0] }]")],
        keys: &[("loads[0].acceleration", "[2, 0]")],
    },
    Cases {
        scene: PLANE,
        with: &[("loads", "[{ body = 'a', temperature = 1 }]")],
        keys: &[("loads[0].temperature", "2")],
    },
    Cases {
        scene: PLANE,
        with: &[("joints", "[{ body = 'c', hinge = { point = [0, 0] } }]")],
        keys: &[
            ("joints[0].name", "other"),
            ("joints[0].to", "d"),
            ("joints[0].hinge", "{ point = [1, 0] }"),
            ("joints[0].hinge.point", "[1, 0]"),
            ("joints[0].hinge.torque", "1"),
            ("joints[0].hinge.speed", "1"),
            ("joints[0].hinge.stiffness", "1"),
            ("joints[0].hinge.dashpot", "1"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("bodies[0].rigid", "{ free = {} }"), ("joints", "[{ body = 'c', weld = {} }]")],
        keys: &[("joints[0].body", "a")],
    },
    Cases {
        scene: PLANE,
        with: &[("joints", "[{ body = 'c', hinge = { point = [0, 0], speed = 1 } }]")],
        keys: &[("joints[0].hinge.limit", "1")],
    },
    Cases {
        scene: SPACE,
        with: &[("joints", "[{ body = 'c', planar = { normal = [0, 0, 1] } }]")],
        keys: &[
            ("joints[0].planar", "{ normal = [0, 1, 0] }"),
            ("joints[0].planar.normal", "[0, 1, 0]"),
            ("joints[0].planar.torque", "1"),
            ("joints[0].planar.speed", "1"),
            ("joints[0].planar.stiffness", "1"),
            ("joints[0].planar.dashpot", "1"),
        ],
    },
    Cases {
        scene: SPACE,
        with: &[("joints", "[{ body = 'c', planar = { normal = [0, 0, 1], speed = 1 } }]")],
        keys: &[("joints[0].planar.limit", "1")],
    },
    Cases {
        scene: SPACE,
        with: &[("joints", "[{ body = 'c', hinge = { point = [0, 0, 0], axis = [0, 0, 1] } }]")],
        keys: &[("joints[0].hinge.axis", "[0, 1, 0]")],
    },
    Cases {
        scene: PLANE,
        with: &[("joints", "[{ body = 'c', slider = { axis = [1, 0] } }]")],
        keys: &[
            ("joints[0].slider", "{ axis = [0, 1] }"),
            ("joints[0].slider.axis", "[0, 1]"),
            ("joints[0].slider.force", "1"),
            ("joints[0].slider.speed", "1"),
            ("joints[0].slider.stiffness", "1"),
            ("joints[0].slider.dashpot", "1"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("joints", "[{ body = 'c', slider = { axis = [1, 0], speed = 1 } }]")],
        keys: &[("joints[0].slider.limit", "1")],
    },
    Cases {
        scene: PLANE,
        with: &[("joints", "[{ body = 'c', ball = { point = [0, 0] } }]")],
        keys: &[("joints[0].ball", "{ point = [1, 0] }"), ("joints[0].ball.point", "[1, 0]")],
    },
    Cases {
        scene: PLANE,
        // Without it the joint is of no kind.
        with: &[("joints", "[{ body = 'c' }]")],
        keys: &[("joints[0].weld", "{}")],
    },
    Cases {
        scene: PLANE,
        with: &[("joints", "[{ body = 'c', spring = { from = [0, 0], to = [1, 0], stiffness = 1 } }]")],
        keys: &[
            ("joints[0].spring", "{ from = [0, 0], to = [2, 0], stiffness = 1 }"),
            ("joints[0].spring.from", "[0, 1]"),
            ("joints[0].spring.to", "[0, 1]"),
            ("joints[0].spring.stiffness", "2"),
            ("joints[0].spring.dashpot", "1"),
            ("joints[0].spring.length", "2"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("springs", "[{ from.body = 'a', to.body = 'b', stiffness = 1 }]")],
        keys: &[
            ("springs[0].name", "other"),
            ("springs[0].from", "{ body = 'c' }"),
            ("springs[0].from.body", "c"),
            ("springs[0].from.on", "y_min"),
            ("springs[0].from.within", "tip"),
            ("springs[0].to", "{ body = 'c' }"),
            ("springs[0].stiffness", "2"),
            ("springs[0].dashpot", "1"),
            ("springs[0].length", "2"),
        ],
    },
];
