//! OBJ files: vertices and faces, as text.
//!
//! Wavefront Technologies, Advanced Visualizer manual, appendix B1. Of all lines two kinds are taken: `v x y z`, and
//! `f a b c ...`, where each word begins with the number of a vertex, from 1, or from -1 back from the last one.

/// Corners of triangles in the units of their file, of all its objects; polygons are cut into fans.
///
/// # Errors
/// What is wrong, in words.
pub fn triangles(bytes: &[u8]) -> Result<Vec<[[f64; 3]; 3]>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is no text")?;
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for (i, line) in text.lines().enumerate() {
        let at = |what: String| format!("{what} in line {}", i + 1);
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        match words.next() {
            Some("v") => corners.push(corner(words).map_err(at)?),
            Some("f") => {
                let polygon = words.map(|word| vertex(word, &corners)).collect::<Result<Vec<_>, _>>();
                let polygon = polygon.map_err(at)?;
                triangles.extend(polygon.windows(2).skip(1).map(|pair| [polygon[0], pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    Ok(triangles)
}

fn corner<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3], String> {
    let mut number = || {
        let word = words.next().unwrap_or_default();
        word.parse().map_err(|_| format!("`{word:.20}` where a coordinate should be"))
    };
    Ok([number()?, number()?, number()?])
}

/// The vertex that a word of a face names, `7`, `-1` or `7/2/3`, of those before it.
fn vertex(word: &str, corners: &[[f64; 3]]) -> Result<[f64; 3], String> {
    let number = word.split('/').next().unwrap_or_default();
    let place = match number.parse::<i64>() {
        Ok(number @ 1..) => usize::try_from(number - 1).ok(),
        Ok(number) => {
            usize::try_from(number.unsigned_abs()).ok().and_then(|back| corners.len().checked_sub(back))
        }
        Err(_) => None,
    };
    let found = place.and_then(|place| corners.get(place));
    found.copied().ok_or_else(|| format!("a face with vertex `{number:.20}` of {}", corners.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_count_vertices_from_either_end_and_are_cut_into_fans() {
        let text = "# by hand\no a\nv 0 0 0 1 # w\nv 1 0 0\nvt 5 5\nv 1 1 0\nv 0 1 0\nf 1/1/1 2//1 3/1 -1\nl 1 2\np 1\n";
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(triangles(text.as_bytes()), Ok(vec![[a, b, c], [a, c, d]]));
        assert_eq!(triangles(b"v 0 0 0\nf 1 1\nf\n"), Ok(Vec::new()));
    }

    /// Vertices that are not there, -8 of four among them, at which a reader that was used before overflowed.
    #[test]
    fn what_is_no_obj_says_where() {
        for (text, expected) in [
            ("v 0 0\n", "`` where a coordinate should be in line 1"),
            ("v 0 0 zero\n", "`zero` where"),
            ("v 0 0 0\n\nf 1 2 3\n", "a face with vertex `2` of 1 in line 3"),
            ("v 0 0 0\nf 1 1 0\n", "a face with vertex `0` of 1"),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 -8/-8\n", "a face with vertex `-8` of 4"),
            ("v 0 0 0\nf 1 1 -9223372036854775808\n", "a face with vertex"),
            ("v 0 0 0\nf a 1 1\n", "a face with vertex `a`"),
        ] {
            let found = triangles(text.as_bytes()).expect_err("it is no OBJ");
            assert!(found.contains(expected), "{found}");
        }
        assert!(triangles(b"v 0 0 0\xff\n").is_err());
    }
}
