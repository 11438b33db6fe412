//! PLY, binary, little endian: a vertex for each photon; lines are edges.

use std::io::{self, Write};
use std::path::Path;

use super::sequence::{DrawnLine, PhotonFrame};
use crate::Result;
use crate::files::write_atomic;

/// What stands before the elements.
const HEAD: &str = "ply\nformat binary_little_endian 1.0\ncomment metres, y up; velocity m/s; flux W\n";

/// Writes `x y z vx vy vz flux_r flux_g flux_b` as `float`, and `id` as `int`.
pub(super) fn write_frame(path: &Path, frame: &PhotonFrame) -> Result<()> {
    write_atomic(path, |file| {
        writeln!(file, "{HEAD}element vertex {}", frame.positions.len())?;
        properties(file, "float", &["x", "y", "z", "vx", "vy", "vz", "flux_r", "flux_g", "flux_b"])?;
        properties(file, "int", &["id"])?;
        file.write_all(b"end_header\n")?;
        for (id, position) in frame.positions.iter().enumerate() {
            for vector in [*position, frame.velocities[id], frame.flux[id]] {
                file.write_all(bytemuck::cast_slice(&vector.to_array().map(f32::to_le_bytes)))?;
            }
            file.write_all(&(id as i32).to_le_bytes())?;
        }
        Ok(())
    })
}

/// Writes lines as vertices with `width`, `red green blue` (linear, 0 to 1) and `line`, the number of the line, and edges
/// between them.
pub(super) fn write_lines(path: &Path, lines: &[DrawnLine]) -> Result<()> {
    let points: usize = lines.iter().map(|line| line.points.len()).sum();
    write_atomic(path, |file| {
        writeln!(file, "{HEAD}element vertex {points}")?;
        properties(file, "float", &["x", "y", "z", "width", "red", "green", "blue"])?;
        properties(file, "int", &["line"])?;
        writeln!(file, "element edge {}", points - lines.len())?;
        properties(file, "int", &["vertex1", "vertex2"])?;
        file.write_all(b"end_header\n")?;
        for (number, line) in lines.iter().enumerate() {
            for point in &line.points {
                let ([x, y, z], [r, g, b]) = (point.to_array(), line.colour.to_array());
                for value in [x, y, z, line.width, r, g, b] {
                    file.write_all(&value.to_le_bytes())?;
                }
                file.write_all(&(number as i32).to_le_bytes())?;
            }
        }
        let mut first = 0;
        for line in lines {
            let end = first + line.points.len() as i32;
            for vertex in first..end - 1 {
                file.write_all(&vertex.to_le_bytes())?;
                file.write_all(&(vertex + 1).to_le_bytes())?;
            }
            first = end;
        }
        Ok(())
    })
}

fn properties(file: &mut impl Write, kind: &str, names: &[&str]) -> io::Result<()> {
    names.iter().try_for_each(|name| writeln!(file, "property {kind} {name}"))
}
