//! Meshes: STL, OBJ and PLY files that a scene names.

use crate::image::read_beside;
use crate::is_one_in;
use stickslip::check::report;

const SCENE: &str = "space = { dimension = \"3d\", cell = 0.5 }\ntime.end = 1\n[materials.m]\ndensity = 1\n\
    neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }\n[[bodies]]\nname = \"a\"\nmaterial = \"m\"\n\
    shape.mesh = { file = \"FILE\", scale = 0.5 }\n";
/// One mesh of so many is filled: that takes a hundred times as long as reading.
const FILLED: u64 = 50;
/// Particle sites of those.
const MOST_SITES: f64 = 2e3;

fn read(file: &str, bytes: &[u8]) {
    let Some(loaded) = read_beside(&SCENE.replace("FILE", file), &[(file, bytes)]) else { return };
    if is_one_in(FILLED, bytes) && crate::scene::sites(&loaded.scene).0 < MOST_SITES {
        let _ = report(&loaded.scene);
    }
}

/// Reads an STL file, text or binary.
pub fn stl(bytes: &[u8]) {
    read("m.stl", bytes);
}

/// Reads an OBJ file.
pub fn obj(bytes: &[u8]) {
    read("m.obj", bytes);
}

/// Reads a PLY file, text or binary.
pub fn ply(bytes: &[u8]) {
    read("m.ply", bytes);
}

/// Corners of a tetrahedron, and of its sides in order around the outer normal.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
const SIDES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// A tetrahedron, binary and as text.
pub fn stl_seeds() -> Vec<Vec<u8>> {
    let mut binary = vec![0; 80];
    binary.extend(4_u32.to_le_bytes());
    let mut text = "solid t\n".to_string();
    for side in SIDES {
        binary.extend([0; 12]);
        text += "facet normal 0 0 0\nouter loop\n";
        for corner in side.map(|corner| CORNERS[corner]) {
            binary.extend(corner.into_iter().flat_map(f32::to_le_bytes));
            text += &format!("vertex {} {} {}\n", corner[0], corner[1], corner[2]);
        }
        binary.extend([0; 2]);
        text += "endloop\nendfacet\n";
    }
    text += "endsolid t\n";
    vec![binary, text.into_bytes()]
}

/// A tetrahedron, and a box of polygons.
pub fn obj_seeds() -> Vec<Vec<u8>> {
    [
        "o t\nv 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
        "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\nvn 0 0 1\nvt 0 0\n\
         f 4/1/1 3//1 2/1 1\nf 5 6 7 8\nf -8 -7 -3 -4\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\ng p\nusemtl m\nl 1 2\np 1\n",
    ]
    .map(|text| text.as_bytes().to_vec())
    .into()
}

/// A tetrahedron, as text and binary in both orders of bytes.
pub fn ply_seeds() -> Vec<Vec<u8>> {
    let head = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\n\
             property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let mut text = head("ascii");
    let (mut little, mut big) =
        (head("binary_little_endian").into_bytes(), head("binary_big_endian").into_bytes());
    for [x, y, z] in CORNERS {
        text += &format!("{x} {y} {z}\n");
        little.extend([x, y, z].into_iter().flat_map(f32::to_le_bytes));
        big.extend([x, y, z].into_iter().flat_map(f32::to_be_bytes));
    }
    for side in SIDES {
        text += &format!("3 {} {} {}\n", side[0], side[1], side[2]);
        little.push(3);
        big.push(3);
        little.extend(side.into_iter().flat_map(|corner| (corner as i32).to_le_bytes()));
        big.extend(side.into_iter().flat_map(|corner| (corner as i32).to_be_bytes()));
    }
    vec![text.into_bytes(), little, big]
}
