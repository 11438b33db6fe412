//! USD in text: `Points` with velocities, widths, flux and display colour, a time sample for each frame, and `BasisCurves`.
//!
//! The format keeps the samples of one attribute together, and the photons come frame by frame: every attribute has a scratch
//! file of its own until the end.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Read as _, Seek as _, Write};
use std::path::{Path, PathBuf};

use glam::Vec3;

use super::sequence::{DrawnLine, PhotonFrame, PhotonSequence};
use crate::files::write_atomic;
use crate::{Error, Result};

/// The attributes with time samples: type, name and metadata.
const SAMPLED: [(&str, &str, &str); 5] = [
    ("float3[]", "extent", ""),
    ("point3f[]", "points", ""),
    ("vector3f[]", "velocities", ""),
    ("color3f[]", "primvars:flux", "interpolation = \"vertex\"\n            doc = \"watts, linear Rec.709\""),
    ("color3f[]", "primvars:displayColor", "interpolation = \"vertex\""),
];

/// A USD file in the making.
pub struct UsdaWriter<'a> {
    sequence: &'a PhotonSequence,
    folder: &'a Path,
    samples: Vec<BufWriter<File>>,
}

impl<'a> UsdaWriter<'a> {
    /// The file `photons.usda` in `folder`.
    pub(super) fn new(sequence: &'a PhotonSequence, folder: &'a Path) -> Result<Self> {
        let scratch = |_| tempfile::tempfile_in(folder).map(BufWriter::new);
        let samples = SAMPLED.iter().map(scratch).collect::<io::Result<_>>();
        Ok(Self {
            sequence,
            folder,
            samples: samples.map_err(Error::io("create a scratch file in", folder))?,
        })
    }

    /// Takes a frame.
    pub(super) fn frame(&mut self, photons: &PhotonFrame) -> Result<()> {
        let corner =
            |of: fn(Vec3, Vec3) -> Vec3| photons.positions.iter().copied().reduce(of).unwrap_or_default();
        let margin = Vec3::splat(self.sequence.width / 2.0);
        let extent = [corner(Vec3::min) - margin, corner(Vec3::max) + margin];
        let shown: Vec<Vec3> = photons.flux.iter().map(|flux| display_colour(*flux)).collect();
        let columns = [&extent[..], photons.positions, photons.velocities, photons.flux, &shown];
        for (file, column) in self.samples.iter_mut().zip(columns) {
            sample(file, photons.frame, column).map_err(Error::io("write a scratch file in", self.folder))?;
        }
        Ok(())
    }

    /// Writes the file and returns its path.
    pub(super) fn finish(mut self) -> Result<PathBuf> {
        let path = self.folder.join("photons.usda");
        write_atomic(&path, |file| {
            file.write_all(self.head().as_bytes())?;
            for ((kind, name, metadata), samples) in SAMPLED.iter().zip(&mut self.samples) {
                if !metadata.is_empty() {
                    writeln!(file, "        {kind} {name} (\n            {metadata}\n        )")?;
                }
                writeln!(file, "        {kind} {name}.timeSamples = {{")?;
                append(file, samples)?;
                file.write_all(b"        }\n")?;
            }
            file.write_all(b"    }\n")?;
            self.sequence.lines.iter().try_for_each(|line| file.write_all(curve(line).as_bytes()))?;
            file.write_all(b"}\n")
        })?;
        Ok(path)
    }

    /// The layer's metadata, and the photons up to the first attribute with samples.
    fn head(&self) -> String {
        let PhotonSequence { name, range: [first, last], frames_per_second: [frames, seconds], .. } =
            self.sequence;
        let rate = f64::from(*frames) / f64::from(*seconds);
        // The format has no other escapes that a name may need.
        let name: String = name.chars().filter(|c| !c.is_control() && !['"', '\\'].contains(c)).collect();
        let ids: Vec<String> = (0..self.sequence.photons).map(|id| id.to_string()).collect();
        format!(
            r#"#usda 1.0
(
    defaultPrim = "lightloom"
    doc = "{name}: photons of a caustic on its plane, by Lightloom {version}"
    metersPerUnit = 1
    upAxis = "Y"
    startTimeCode = {first}
    endTimeCode = {last}
    timeCodesPerSecond = {rate}
    framesPerSecond = {rate}
)

def Xform "lightloom"
{{
    def Points "photons"
    {{
        int64[] ids = [{ids}]
        float[] widths = [{width}] (
            interpolation = "constant"
        )
"#,
            version = env!("CARGO_PKG_VERSION"),
            ids = ids.join(", "),
            width = self.sequence.width,
        )
    }
}

/// The colour of a photon's flux, its strongest channel at 1; black without flux.
fn display_colour(flux: Vec3) -> Vec3 {
    let colour = flux / flux.max_element().max(f32::MIN_POSITIVE);
    (colour * 1000.0).round() / 1000.0
}

/// One time sample of an attribute.
fn sample(file: &mut impl Write, frame: i32, column: &[Vec3]) -> io::Result<()> {
    write!(file, "            {frame}: [")?;
    write_vectors(file, column)?;
    file.write_all(b"],\n")
}

fn write_vectors(file: &mut impl Write, column: &[Vec3]) -> io::Result<()> {
    for (i, v) in column.iter().enumerate() {
        write!(file, "{}({}, {}, {})", if i > 0 { ", " } else { "" }, v.x, v.y, v.z)?;
    }
    Ok(())
}

/// Copies a scratch file to the end of another.
fn append(file: &mut impl Write, scratch: &mut BufWriter<File>) -> io::Result<()> {
    scratch.flush()?;
    let scratch = scratch.get_mut();
    scratch.rewind()?;
    let mut piece = vec![0; 1 << 16];
    loop {
        let read = scratch.read(&mut piece)?;
        if read == 0 {
            return Ok(());
        }
        file.write_all(&piece[..read])?;
    }
}

/// A drawn line, hidden in the frames in which it does not act.
fn curve(line: &DrawnLine) -> String {
    let mut points = Vec::new();
    // Writing to memory does not fail.
    let _ = write_vectors(&mut points, &line.points);
    let points = String::from_utf8_lossy(&points).into_owned();
    let (lower, upper) = line
        .points
        .iter()
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lower, upper), p| (lower.min(*p), upper.max(*p)));
    let half = line.width / 2.0;
    let (lower, upper, colour) = (lower - half, upper + half, line.colour);
    let mut text = format!(
        r#"
    def BasisCurves "{name}"
    {{
        uniform token type = "linear"
        uniform token wrap = "nonperiodic"
        int[] curveVertexCounts = [{count}]
        float3[] extent = [({}, {}, {}), ({}, {}, {})]
        point3f[] points = [{points}]
        float[] widths = [{width}] (
            interpolation = "constant"
        )
        color3f[] primvars:displayColor = [({}, {}, {})]
"#,
        lower.x,
        lower.y,
        lower.z,
        upper.x,
        upper.y,
        upper.z,
        colour.x,
        colour.y,
        colour.z,
        name = line.name,
        count = line.points.len(),
        width = line.width,
    );
    if let Some([from, to]) = line.span {
        let (before, after) = (from - 1, to + 1);
        let samples = format!(r#"{before}: "invisible", {from}: "inherited", {after}: "invisible""#);
        let _ = writeln!(text, "        token visibility.timeSamples = {{ {samples} }}");
    }
    text + "    }\n"
}
