//! OBJ and MTL files.

use super::Row;
use super::seeds::{BALL_MATERIAL, ball};
use crate::scenes::{Stage, box_obj, glass};
use glam::Vec3;

/// Loads a scene of one mesh; its notes.
fn read(mesh: &[u8], with_glass: bool) -> Result<Vec<String>, String> {
    let mut stage = Stage::new();
    stage.file("a.mtl", BALL_MATERIAL);
    let material = if with_glass { glass(1.5) } else { None };
    stage.mesh("mesh", mesh, material);
    let (_, notes) = stage.try_load().map_err(|error| super::told(error, stage.folder.path()))?;
    Ok(notes.iter().map(|note| super::without(note, stage.folder.path())).collect())
}

pub(super) fn rows() -> Vec<Row> {
    const V: &str = "v 0 0 0\nv 1 0 0\nv 0 0 -1\n";
    let faces = |rest: &str| format!("{V}{rest}").into_bytes();
    let cube = box_obj(Vec3::ZERO, Vec3::ONE);
    let open = cube.rsplit_once("\nf ").unwrap().0.to_owned() + "\n";
    let refused: Vec<(&str, Vec<u8>, &str)> = vec![
        ("an empty file", Vec::new(), "mesh.obj … no faces"),
        ("vertices alone", faces(""), "no faces (3 vertices)"),
        ("lines alone", faces("l 1 2 3\n"), "no faces"),
        ("a vertex of nan", faces("v nan 0 0\nf 1 2 4\n"), "line 4 … 1 vertices are no finite numbers"),
        ("a vertex of 1e400", faces("v 1e400 0 0\nf 1 2 4\n"), "1 vertices are no finite numbers"),
        ("decimal commas", b"v 0,5 0,25 1,0\n".to_vec(), "line 1 … decimal comma"),
        ("index 0", faces("f 1 2 0\n"), "line 4 … counts from 1"),
        ("an index beyond", faces("f 1 2 4\n"), "line 4 … only 3 stand before it"),
        ("a negative index beyond", faces("f 1 2 -4\n"), "line 4 … only 3 stand before it"),
        ("an index of 20 digits", faces("f 1 2 99999999999999999999\n"), "line 4"),
        ("a face of two corners", faces("f 1 2\n"), "line 4 … at least 3"),
        ("faces without area", faces("f 1 1 1\nf 2 2 1\n"), "no triangle of any size"),
        ("UTF-16", b"v\0 \x001\0 \x001\0".to_vec(), "UTF-16"),
        ("a scale of 1e-12", cube.replace(" 1", " 0.000000000001").into_bytes(), "mesh.obj"),
    ];
    let read_rows: Vec<(&str, Vec<u8>, bool, &str)> = vec![
        (
            "mtllib ../../nowhere/passwd",
            format!("mtllib ../../nowhere/passwd\nusemtl a\n{cube}").into(),
            false,
            "passwd",
        ),
        ("mtllib that is not there", format!("mtllib lost.mtl\nusemtl a\n{cube}").into(), false, "lost.mtl"),
        ("mtllib /dev/zero", format!("mtllib /dev/zero\nusemtl a\n{cube}").into(), false, "zero"),
        ("a byte order mark", [b"\xef\xbb\xbf", cube.as_bytes()].concat(), true, ""),
        ("CRLF", cube.replace('\n', "\r\n").into(), true, ""),
        ("continued lines", ball().replace("f ", "f \\\n").into(), true, ""),
        ("names that are no UTF-8", [b"mtllib a.mtl\nusemtl Gr\xfcn\n", cube.as_bytes()].concat(), false, ""),
        ("a triangle without area", format!("{cube}f 1 1 2\n").into(), true, "1 triangles"),
        ("open glass", open.into(), true, "open"),
        ("glass inside out", inside_out(&cube).into(), true, "turned"),
    ];
    let refused =
        refused.into_iter().map(|(input, bytes, words)| Row::refused(input, words, || read(&bytes, true)));
    let read_rows = read_rows
        .into_iter()
        .map(|(input, bytes, with_glass, words)| Row::read(input, words, || read(&bytes, with_glass)));
    refused.chain(read_rows).collect()
}

/// All faces the other way round.
fn inside_out(obj: &str) -> String {
    let turn = |line: &str| match line.strip_prefix("f ") {
        Some(corners) => format!("f {}\n", corners.split(' ').rev().collect::<Vec<_>>().join(" ")),
        None => format!("{line}\n"),
    };
    obj.lines().map(turn).collect()
}
