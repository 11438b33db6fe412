//! Wavefront OBJ and MTL, written compactly: micrometres for positions, 1e-4 for normals.

use std::fmt::Write;

use crate::mesh::Mesh;

/// A kind of glass or liquid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Medium {
    /// Name of the material.
    pub name: &'static str,
    /// Index of refraction.
    pub index: f64,
    /// Absorption for red, green and blue, per metre (Beer's law).
    pub absorption: [f64; 3],
}

/// The text of an OBJ file: one smooth object made of one material, which `name`.mtl describes.
pub(crate) fn obj(name: &str, title: &str, medium: &Medium, mesh: &Mesh) -> String {
    let mut text = format!(
        "# {title}\n# Metres, y up, standing on y = 0. Closed; {} triangles. Written by assets/generate.\n\
         mtllib {name}.mtl\no {name}\nusemtl {}\ns 1\n",
        mesh.triangles.len(),
        medium.name
    );
    for p in &mesh.positions {
        push_row(&mut text, "v", p.to_array().map(|x| decimal(x, 6)));
    }
    for n in &mesh.normals {
        push_row(&mut text, "vn", n.to_array().map(|x| decimal(x, 4)));
    }
    for triangle in &mesh.triangles {
        push_row(&mut text, "f", triangle.map(|i| format!("{0}//{0}", i + 1)));
    }
    text
}

/// The text of an MTL file. `absorption` is this program's own line; `Kd`, `Tf` and `d` are for programs that skip it.
pub(crate) fn mtl(medium: &Medium) -> String {
    // What is left of white light behind 5 mm of the medium.
    let tint = medium.absorption.map(|a| decimal(libm::exp(-0.005 * a), 3)).join(" ");
    let absorption = medium.absorption.map(|a| decimal(a, 3)).join(" ");
    format!(
        "# Written by assets/generate. absorption: per metre, for red, green and blue.\nnewmtl {}\nKd {tint}\nKs 1 1 1\n\
         Tf {tint}\nNi {}\nd 0.2\nillum 7\nabsorption {absorption}\n",
        medium.name, medium.index
    )
}

fn push_row(text: &mut String, keyword: &str, [x, y, z]: [String; 3]) {
    // Writing into a string cannot fail.
    let _ = writeln!(text, "{keyword} {x} {y} {z}");
}

/// A decimal number without needless zeros.
fn decimal(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_short_and_exact() {
        let cases = [(0.25, "0.25"), (-0.0000001, "0"), (3.0, "3"), (-1.5000004, "-1.5"), (120.0, "120")];
        for (value, text) in cases {
            assert_eq!(decimal(value, 6), text);
        }
    }
}
