//! MTL files: what counts as glass, however it is spelled.

use lightloom_core::scene::material::{Glass, Material};
use lightloom_core::scene::mesh::Transform;

use super::{ball, load};

/// What a material is taken for.
enum Taken {
    /// Index and absorption (1/m).
    Glass(f32, [f32; 3]),
    Matt([f32; 3]),
}
use Taken::{Glass as G, Matt as M};

const CLEAR: [f32; 3] = [0.0; 3];
const GREY: [f32; 3] = [0.6; 3];

#[rustfmt::skip]
const ROWS: [(&str, &str, Taken, &[&str]); 33] = [
    ("plain", "newmtl M1\nNi 1.5\nd 0.1\nillum 7", G(1.5, CLEAR), &["by its transparency"]),
    ("a model with a point", "newmtl M1\nNi 1.5\nillum 6.0", G(1.5, CLEAR), &["illumination model"]),
    ("a model with an exponent", "newmtl M1\nNi 1.5\nillum 7e0", G(1.5, CLEAR), &["illumination model"]),
    ("halo", "newmtl M1\nNi 1.5\nd -halo 0.2\nillum 2", G(1.5, CLEAR), &["by its transparency"]),
    ("halo in capitals, by lower case d", "newmtl M1\nNi 1.5\nD -HALO 0.2\nillum 2", G(1.5, CLEAR), &["by its transparency"]),
    ("twice, glass last", "newmtl M1\nKd 1 1 1\nnewmtl M1\nNi 1.5\nd 0.2", G(1.5, CLEAR), &["defined 2 times"]),
    ("twice, glass first", "newmtl M1\nNi 1.5\nd 0.2\nnewmtl M1\nKd 0.6 0.6 0.6", M(GREY), &["defined 2 times", "last one counts"]),
    ("three times", "newmtl M1\nKd 1 1 1\nnewmtl M1\nKd 0 1 1\nnewmtl M1\nNi 1.5\nd 0.2", G(1.5, CLEAR), &["defined 3 times"]),
    ("Maya's clear glass", "newmtl M1\nillum 4\nKd 0 0 0\nTf 0.00 0.00 0.00\nNi 1.50", G(1.5, CLEAR), &["Maya"]),
    ("Maya's clear glass with d", "newmtl M1\nillum 2\nTf 0 0 0\nd 1\nNi 1.50", G(1.5, CLEAR), &["Maya"]),
    ("Maya's clear glass, one number", "newmtl M1\nillum 4\nTf 0\nNi 1.50", G(1.5, CLEAR), &["Maya"]),
    // -ln(0.5) over 1 cm.
    ("a filter of a half", "newmtl M1\nTf 0.5 1 1\nNi 1.5", G(1.5, [69.3147, 0.0, 0.0]), &["Tf makes it absorb 69, 0, 0 per m"]),
    ("a filter of 1", "newmtl M1\nTf 1 1 1\nillum 6\nNi 1.5", G(1.5, CLEAR), &["illumination model"]),
    ("a filter by a spectrum", "newmtl M1\nTf spectral glass.rfl 1\nd 0.5\nNi 1.5", G(1.5, CLEAR), &["line 2", "'spectral'"]),
    ("absorption counts before a filter", "newmtl M1\nTf 0 0 0\nabsorption 3 0.5 4\nNi 1.5", G(1.5, [3.0, 0.5, 4.0]), &[]),
    ("opaque by d, whatever Tr says", "newmtl M1\nKd 0.6 0.6 0.6\nNi 1.5\nd 1.0\nTr 1.0\nillum 2", M(GREY), &["d counts"]),
    ("the same in the other order", "newmtl M1\nKd 0.6 0.6 0.6\nNi 1.5\nTr 1.0\nd 1.0\nillum 2", M(GREY), &["d counts"]),
    ("clear by d, whatever Tr says", "newmtl M1\nNi 1.5\nd 0.1\nTr 0.1", G(1.5, CLEAR), &["d counts", "by its transparency"]),
    ("d and Tr agree", "newmtl M1\nNi 1.5\nd 0.25\nTr 0.75", G(1.5, CLEAR), &["by its transparency"]),
    ("Tr alone", "newmtl M1\nNi 1.5\nTr 0.9", G(1.5, CLEAR), &["by its transparency"]),
    ("small letters", "newmtl M1\nni 1.5\nkd 1 0 0\ntf 0.5 0.5 0.5\nILLUM 6", G(1.5, [69.3147; 3]), &[]),
    ("keyword of the name in capitals", "NEWMTL M1\nNI 1.5\nD 0.1", G(1.5, CLEAR), &[]),
    ("one number for a colour", "newmtl M1\nKd 0.6", M(GREY), &[]),
    ("two numbers for a colour", "newmtl M1\nKd 0.6 0.6", M(GREY), &[]),
    ("a decimal comma", "newmtl M1\nNi 1,5\nd 0,1", G(1.5, CLEAR), &["line 2, Ni: '1,5' has a decimal comma", "line 3"]),
    ("a word for a number", "newmtl M1\nNi 1.5\nd clear\nTr 0.9", G(1.5, CLEAR), &["line 3, d: 'clear' is no number"]),
    ("a missing number", "newmtl M1\nNi 1.5\nd\nTr 0.9", G(1.5, CLEAR), &["line 3, d: a number is missing"]),
    ("not finite", "newmtl M1\nKd nan nan nan\nNi 1.5\nd 0.1", G(1.5, CLEAR), &["line 2, Kd"]),
    ("comments and tabs", "# a\r\nnewmtl\tM1 # b\r\n\tNi\t1.5 # c\r\n\td 0.1\r\n", G(1.5, CLEAR), &[]),
    ("CR", "newmtl M1\rNi 1.5\rd 0.1\r", G(1.5, CLEAR), &[]),
    ("a byte order mark", "\u{feff}newmtl M1\nNi 1.5\nd 0.1\n", G(1.5, CLEAR), &[]),
    ("values before a name, and textures without one", "Ni 2\nnewmtl M1\nmap_Kd\nbump\nNi 1.5\nd 0.1\n", G(1.5, CLEAR), &[]),
    ("names that are empty", "newmtl\nKd 1 0 0\nnewmtl M1\nNi 1.5\nd 0.1\nnewmtl \n", G(1.5, CLEAR), &[]),
];

#[test]
fn materials_are_what_their_lines_mean() {
    for (name, text, taken, words) in ROWS {
        let mesh = format!("mtllib a.mtl\nusemtl M1\n{}", ball());
        let (scene, notes) = load(mesh, &[("a.mtl", text)], Transform::default()).unwrap();
        match (&scene.meshes()[0].material, taken) {
            (Material::Glass(Glass { ior, absorption, .. }), G(index, colour)) => {
                // Four decimals in the table.
                let near = absorption.iter().zip(colour).all(|(a, b)| (a - b).abs() < 1e-4);
                assert!(*ior == index && near, "{name}: {ior} {absorption:?}");
            }
            (Material::Diffuse(matt), M(colour)) => assert_eq!(matt.albedo, colour, "{name}"),
            (other, _) => panic!("{name}: {other:?}\n{notes}"),
        }
        assert!(words.iter().all(|word| notes.contains(word)), "{name}: {notes}");
        assert!(!notes.contains("d counts") || words.contains(&"d counts"), "{name}: {notes}");
        // What says that it is glass is no guess to be told of.
        assert!(!(text.contains("absorption") && notes.contains("taken as glass")), "{name}: {notes}");
    }
}

#[test]
fn the_same_definition_in_two_files_is_no_contradiction() {
    let mesh = format!("mtllib a.mtl b.mtl a.mtl\nusemtl M1\n{}", ball());
    let same = "newmtl M1\nNi 1.5\nd 0.1\n";
    let (_, notes) = load(mesh, &[("a.mtl", same), ("b.mtl", same)], Transform::default()).unwrap();
    assert!(!notes.contains("defined"), "{notes}");
}
