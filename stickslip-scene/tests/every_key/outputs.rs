//! Keys of outputs and references.

use crate::{Cases, PLANE};

const FRINGES: &str = "{ interval = 0.1, stress_optic_coefficient = '1e-10 1/Pa', thickness = 0.01 }";
const PROBE: &str = "[{ name = 'p', at = [0, 0] }]";
const ARRIVAL: &str = "[{ quantity = 'speed', threshold = 1, bodies = ['a'] }]";
const FRONT: &str = "[{ name = 'f', quantity = 'xx', threshold = 1, from = [0, 0], direction = [1, 0] }]";
const SECTION: &str = "[{ name = 's', point = [0, 0], normal = [1, 0] }]";

pub const CASES: &[Cases] = &[
    Cases {
        scene: PLANE,
        with: &[],
        keys: &[
            ("outputs", "{ tables = 0.1 }"),
            ("outputs.tables", "0.1"),
            ("outputs.bodies", "['a']"),
            ("outputs.particles", "0.1"),
            ("outputs.particles_at", "[0.1]"),
            ("outputs.snapshots", "{ every = 2 }"),
            ("outputs.snapshots.precision", "double"),
            ("outputs.snapshots.compression", "none"),
            ("outputs.snapshots.columns", "['velocity']"),
            ("outputs.snapshots.bodies", "['a']"),
            ("outputs.snapshots.every", "2"),
            ("outputs.surfaces", "0.1"),
            ("outputs.grid", "0.1"),
            ("outputs.fringes", FRINGES),
            ("outputs.checkpoints", "0.1"),
            ("outputs.time_unit", "0.1"),
            ("outputs.probes", PROBE),
            ("outputs.arrivals", ARRIVAL),
            ("outputs.fronts", FRONT),
            ("outputs.sections", SECTION),
            ("outputs.reactions", "['d']"),
            ("outputs.groups", "[{ name = 'g', bodies = ['a'] }]"),
            ("outputs.fabric", "[{ name = 'f', bodies = ['a'], within = { min = [0, 0], max = [2, 2] } }]"),
            ("outputs.tractions", "{}"),
            ("references", "[{ body = 'a', quantity = 'x', value = 1, label = 'l' }]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("outputs.tractions", "{}")],
        keys: &[("outputs.tractions.interval", "0.1"), ("outputs.tractions.bodies", "['a']")],
    },
    Cases {
        scene: PLANE,
        with: &[("outputs.surfaces", "0.1"), ("outputs.probes", PROBE)],
        keys: &[
            ("outputs.surface_format", "glb"),
            ("outputs.samples", "step"),
            ("outputs.probes[0].name", "q"),
            ("outputs.probes[0].at", "[0.01, 0]"),
            ("outputs.probes[0].body", "a"),
            ("outputs.probes[0].fixed_in", "material"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("outputs.probes", "[{ name = 'p', at = [0, 0], to = [0.1, 0], count = 3 }]")],
        keys: &[("outputs.probes[0].to", "[0.2, 0]"), ("outputs.probes[0].count", "4")],
    },
    Cases {
        scene: PLANE,
        with: &[
            ("outputs.probes", "[{ name = 'p {i}', at = [0, 0], repeat = { i = 1 } }]"),
            ("outputs.sections", "[{ name = 's {i}', point = [0, 0], normal = [1, 0], repeat = { i = 1 } }]"),
            ("outputs.groups", "[{ name = 'g {i}', bodies = ['a'], repeat = { i = 1 } }]"),
            (
                "outputs.fabric",
                "[{ name = 'f {i}', bodies = ['a'], within = { min = [0, 0], max = [2, 2] }, repeat = { i = 1 } }]",
            ),
        ],
        keys: &[
            ("outputs.probes[0].repeat", "{ i = 2 }"),
            ("outputs.sections[0].repeat", "{ i = 2 }"),
            ("outputs.groups[0].repeat", "{ i = 2 }"),
            ("outputs.fabric[0].repeat", "{ i = 2 }"),
            ("outputs.fabric[0].name", "'h {i}'"),
            ("outputs.fabric[0].bodies", "['b']"),
            ("outputs.fabric[0].within", "{ min = [0, 0], max = [1, 1] }"),
            ("outputs.sections[0].name", "'t {i}'"),
            ("outputs.sections[0].point", "[0.01, 0]"),
            ("outputs.sections[0].normal", "[0, 1]"),
            ("outputs.sections[0].within", "{ min = [0, 0], max = [1, 1] }"),
            ("outputs.sections[0].bodies", "['a']"),
            ("outputs.groups[0].name", "'h {i}'"),
            ("outputs.groups[0].bodies", "['b']"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[
            ("outputs.sections", SECTION),
            ("outputs.sections[0].within", "{ min = [0, 0], max = [1, 1] }"),
        ],
        keys: &[("outputs.sections[0].within.min", "[-1, 0]"), ("outputs.sections[0].within.max", "[2, 2]")],
    },
    Cases {
        scene: PLANE,
        with: &[("outputs.probes", PROBE), ("outputs.arrivals", ARRIVAL)],
        keys: &[
            ("outputs.arrivals[0].quantity", "vx"),
            ("outputs.arrivals[0].threshold", "2"),
            ("outputs.arrivals[0].probes", "['p']"),
            ("outputs.arrivals[0].bodies", "['b']"),
            ("outputs.arrivals[0].reading", "mean"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("outputs.fronts", FRONT)],
        keys: &[
            ("outputs.fronts[0].name", "g"),
            ("outputs.fronts[0].quantity", "yy"),
            ("outputs.fronts[0].threshold", "2"),
            ("outputs.fronts[0].from", "[0.01, 0]"),
            ("outputs.fronts[0].direction", "[0, 1]"),
            ("outputs.fronts[0].within", "0.1"),
            ("outputs.fronts[0].bodies", "['a']"),
            ("outputs.fronts[0].fit", "[0.1, 0.2]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("outputs.fringes", FRINGES)],
        keys: &[
            ("outputs.fringes.first", "0.1"),
            ("outputs.fringes.interval", "0.2"),
            ("outputs.fringes.exposure", "0.05"),
            ("outputs.fringes.samples", "4"),
            ("outputs.fringes.stress_optic_coefficient", "2e-10 1/Pa"),
            ("outputs.fringes.thickness", "0.02"),
            ("outputs.fringes.wavelength", "600 nm"),
            ("outputs.fringes.field", "light"),
            ("outputs.fringes.light", "white"),
            ("outputs.fringes.polarizer", "30 deg"),
            ("outputs.fringes.bodies", "['a']"),
            ("outputs.fringes.view", "{ min = [0, 0], max = [1, 1] }"),
            ("outputs.fringes.width", "640"),
            ("outputs.fringes.overlay", "force-chains"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[(
            "outputs.fringes",
            "{ interval = 0.1, stress_parameter = 1e6, view = { min = [0, 0], max = [1, 1] } }",
        )],
        keys: &[
            ("outputs.fringes.stress_parameter", "2e6"),
            ("outputs.fringes.view.min", "[-1, 0]"),
            ("outputs.fringes.view.max", "[2, 1]"),
        ],
    },
    Cases {
        scene: PLANE,
        with: &[("references", "[{ body = 'a', quantity = 'x', value = 1, label = 'l' }]")],
        keys: &[
            ("references[0].body", "b"),
            ("references[0].quantity", "y"),
            ("references[0].value", "2"),
            ("references[0].label", "m"),
        ],
    },
];
