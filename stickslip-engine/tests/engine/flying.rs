//! A scene of two tests: a soft ball and a stone, which fly into each other and into a rigid floor before a symmetry
//! face, with friction and gravity; in the plane or in space.

/// Its text, with more keys of `space` and of `time`, and what else stands at its top, the material `rock` of the stone
/// among it.
pub fn flying(dimension: &str, [space, time, top]: [&str; 3]) -> String {
    let v = |x: &str, y: &str, z: &str| match dimension {
        "3d" => format!("[{x}, {y}, {z}]"),
        _ => format!("[{x}, {y}]"),
    };
    format!(
        r#"
        gravity = {}
        space = {{ dimension = "{dimension}", cell = 0.1, {space}, domain = {{ min = {}, max = {}, x_min = "symmetry", y_max = "fixed" }} }}
        time = {{ end = 1, {time} }}
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        {top}
        [[bodies]]
        name = "floor"
        material = "rock"
        shape.box = {{ min = {}, max = {} }}
        rigid = {{ velocity = {} }}
        [[bodies]]
        name = "ball"
        material = "rubber"
        shape.ball = {{ center = {}, radius = 0.3 }}
        velocity = {}
        [[bodies]]
        name = "stone"
        material = "rock"
        shape.ball = {{ center = {}, radius = 0.19 }}
        velocity = {}
        [[contact]]
        friction = 0.3
        "#,
        v("1", "-10", "0.5"),
        v("0", "-0.5", "-1"),
        v("2", "1", "1"),
        v("0", "-0.2", "-0.4"),
        v("1.2", "0", "0.4"),
        v("0.5", "0.1", "0"),
        v("0.52", "0.3", "0.1"),
        v("1", "-1", "0.3"),
        v("0.2", "0.68", "0.1"),
        v("1.5", "-2", "0.1"),
    )
}
