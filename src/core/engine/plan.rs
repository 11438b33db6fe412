//! The plan of work for a project. Parts that are left out cost neither time nor memory.

use std::path::Path;

use glam::Vec2;
use serde::Serialize;

use crate::constraint::Constraint;
use crate::export::{FrameFormat, FrameLayer, PngDepth};
use crate::flow::{MotionMethod, TurbulenceSettings};
use crate::matching::MatchingMethod;
use crate::project::{Project, Shows};
use crate::render::RenderSettings;
use crate::render::frames::FrameStore;
use crate::{Error, Result, files};

/// A part of the work that a project does not need.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// The part.
    pub what: &'static str,
    /// The reason.
    pub why: &'static str,
}

/// The work ahead and its expected cost.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// Photons of one pass.
    pub photons: usize,
    /// Progressive passes.
    pub passes: usize,
    /// Requested frames.
    pub frames: usize,
    /// Parts that are not needed.
    pub left_out: Vec<LeftOut>,
    /// The stages in order, with the seconds each is expected to take.
    pub stages: Vec<(&'static str, f64)>,
    /// Expected peak memory in MiB.
    pub memory_mib: f64,
    /// Expected size of the files that hold all frames while they are rendered, and what they are made with, in MiB.
    pub scratch_mib: f64,
    /// Expected size of the frames in MiB.
    pub output_mib: f64,
    /// Seconds that the photons of all passes take before they are counted into frames.
    #[serde(skip)]
    pub(super) shared_seconds: f64,
    /// Texels of a texture.
    #[serde(skip)]
    texels: usize,
    /// Of the scratch files, what is not the light of frames, in MiB.
    #[serde(skip)]
    kept_mib: f64,
}

/// Bytes of a pixel in a frame, measured on noisy pictures.
mod bytes {
    /// Of a half float in an EXR file, compressed.
    pub(super) const HALF: f64 = 0.95;
    /// Of an 8-bit PNG.
    pub(super) const PNG: f64 = 1.3;
    /// Of a 16-bit PNG.
    pub(super) const PNG_16: f64 = 4.5;
}

/// Measured on two cores of a server of 2024; used by the progress bar and by `check` only.
mod pace {
    /// Caustic photons landed per second.
    pub(super) const TRACE: f64 = 1.0e6;
    /// Points matched per second, the continuous map included.
    pub(super) const MATCH: f64 = 0.25e6;
    /// Points sent through a known map and made a bijection, per second.
    pub(super) const REMATCH: f64 = 1.2e6;
    /// Points paired per second by the method of 2016.
    pub(super) const STYLIZED: f64 = 0.2e6;
    /// Unknowns solved per second in one step of the fit.
    pub(super) const FIT: f64 = 1.0e6;
    /// Seconds of the plan of one step.
    pub(super) const PLAN: f64 = 0.1;
    /// Photons carried over one step, per second.
    pub(super) const ADVECT: f64 = 10.0e6;
    /// Photons counted into the texture per second.
    pub(super) const SPLAT: f64 = 40.0e6;
    /// Texels filtered and stored per second.
    pub(super) const FILTER: f64 = 26.0e6;
    /// Camera samples towards the receiver per second.
    pub(super) const LOOKS: f64 = 2.0e6;
    /// Light paths of the background per second.
    pub(super) const PATHS: f64 = 0.5e6;
    /// Pixels gathered, encoded and written per second.
    pub(super) const WRITE: f64 = 4.7e6;
    /// Pixels of a film encoded per second.
    pub(super) const FILM: f64 = 8e6;
}

/// Plans `frames` frames of `project`. `given_rows` are the rows of its point files where those are paired as given;
/// `fixed` tells that every pass has the same points, and `texels` how many the texture of so many passes has.
pub(super) fn plan(
    project: &Project,
    extent: Vec2,
    frames: usize,
    given_rows: Option<usize>,
    fixed: bool,
    texels: impl Fn(usize) -> usize,
) -> Plan {
    let photons = given_rows.unwrap_or(project.render.photons as usize);
    let passes = if fixed { 1 } else { project.render.passes as usize };
    let mut plan = Plan {
        photons,
        passes,
        frames,
        left_out: left_out(project, fixed),
        stages: Vec::new(),
        memory_mib: 0.0,
        scratch_mib: 0.0,
        shared_seconds: 0.0,
        output_mib: 0.0,
        texels: texels(passes),
        kept_mib: 0.0,
    };
    plan.output_mib = frames as f64 * frame_bytes(project, plan.texels as f64) / MIB;
    plan.stages = stages(project, extent, &plan);
    plan.memory_mib = memory_mib(project, extent, &plan);
    plan.shared_seconds = passes as f64 * shared_by_frames(project, photons as f64, moving_segments(project));
    plan.kept_mib = kept_bytes(project) / MIB;
    plan.set_scratch(FrameStore::bytes(plan.texels, frames * textures(project)));
    plan
}

/// Whether a part is not needed, its name, and the reason.
type Unneeded = (bool, &'static str, &'static str);

fn left_out(project: &Project, fixed: bool) -> Vec<LeftOut> {
    let still = project.keys.len() < 2;
    let (scene, traces) = (project.scene.is_some(), project.traces());
    let mut parts: Vec<Unneeded> = vec![
        (!scene, "background and camera", "the project has no scene; the plane is seen straight on"),
        (!scene, "photon tracing", "the project has no scene"),
        (scene && !project.output.shows_background(), "background", "output.layers asks for caustics alone"),
        (scene && has_plate(project), "background", "render.plate stands behind the caustics"),
        (scene && !traces, "photon tracing", "no key shows the physical caustic"),
        (still, "matching, fit and advection", "there is one key frame, so nothing moves"),
        (
            project.caustics.is_empty(),
            "grouping by caustics",
            "no caustic is named, so all light moves as one",
        ),
    ];
    if !still {
        parts.extend(unneeded_in_motion(project));
    }
    let repeats = fixed && project.render.passes > 1;
    parts.push((
        repeats,
        "passes after the first",
        "every key is a file of points, and one pass shows them all",
    ));
    parts.into_iter().filter(|part| part.0).map(|(_, what, why)| LeftOut { what, why }).collect()
}

/// The parts between matching and arrival, for projects whose light moves.
fn unneeded_in_motion(project: &Project) -> [Unneeded; 11] {
    let (flow, given) = (project.fits(), project.matching == MatchingMethod::Given);
    let [linear, stylized] =
        [MotionMethod::Linear, MotionMethod::Stylized].map(|method| project.method == method);
    let rests = (1..project.keys.len()).any(|key| layers(project, key) == 0);
    let gamma = project.flow.gamma;
    let drawn = || project.constraints.iter().filter(|constraint| constraint.is_enabled());
    let walls = drawn().any(|constraint| matches!(constraint, Constraint::Wall(_)));
    let lines = drawn().any(|constraint| matches!(constraint, Constraint::DirectedLine(_)));
    [
        (given, "transport map", "the rows of the point files are paired as given"),
        (stylized, "transport map", "the method is stylized: a thin-plate warp takes its place"),
        (linear, "fit and advection", "the method is linear: photons go straight"),
        (stylized, "fit and advection", "the method is stylized: each photon has a cubic way of its own"),
        (!flow, "turbulence, directed lines and walls", "only the flow heeds them"),
        (rests, "matching and fit of a segment", "all light is the physical caustic before and after"),
        (flow && gamma == 0.0, "scalar potential", "gamma is 0: half the unknowns"),
        (flow && gamma == 1.0, "stream function", "gamma is 1: half the unknowns"),
        (flow && !walls, "ways around walls", "no wall is drawn"),
        (flow && !lines, "fit to directed lines", "none is drawn"),
        (flow && swirls(project).is_none(), "turbulence", "the flow asks for none, or for strength 0"),
    ]
}

/// Whether a picture takes the place of the background.
fn has_plate(project: &Project) -> bool {
    project.output.shows_background() && project.render.plate.is_some()
}

/// Textures of each frame: the named caustics and the rest, where they are written apart.
fn textures(project: &Project) -> usize {
    if project.output.separates_caustics() { project.caustics.len() + 1 } else { 1 }
}

fn stages(project: &Project, extent: Vec2, plan: &Plan) -> Vec<(&'static str, f64)> {
    let render = &project.render;
    let layers: Vec<usize> = (1..project.keys.len()).map(|key| layers(project, key)).collect();
    let segments = moving_segments(project);
    let (photons, passes) = (plan.photons as f64, plan.passes as f64);
    let pixels = f64::from(render.width) * f64::from(render.height);
    let traced = project.traces();
    let trace = if traced { photons / pace::TRACE } else { 0.0 };
    let mut stages = Vec::new();
    stages.push(("visible", pixels * f64::from(render.camera_samples) / pace::LOOKS));
    if project.scene.is_some() && project.output.shows_background() && !has_plate(project) {
        stages.push(("background", pixels * f64::from(render.background_samples) / pace::PATHS));
    }
    if traced {
        // A quarter of the samples, and several light paths in glass.
        stages.push(("still", trace + pixels * f64::from(render.camera_samples) / 2.0 / pace::LOOKS));
        stages.push(("trace", trace));
    }
    stages.extend(motion_stages(project, extent, photons, &layers));
    let per_pass = shared_by_frames(project, photons, segments)
        + plan.frames as f64
            * (photons / pace::SPLAT + textures(project) as f64 * plan.texels as f64 / pace::FILTER);
    stages.push(("render", passes * per_pass));
    stages.push(("write", plan.frames as f64 * pixels / pace::WRITE));
    stages
}

/// Seconds of a pass before its photons are counted into frames: they are traced, matched and carried.
fn shared_by_frames(project: &Project, photons: f64, segments: f64) -> f64 {
    // Each noise grid is asked for a velocity as the fitted field is.
    let fields_asked = 1.0 + swirls(project).map_or(0.0, |turbulence| turbulence.grids.len() as f64);
    let trace = if project.traces() { photons / pace::TRACE } else { 0.0 };
    let steps = segments * f64::from(project.flow.steps);
    trace
        + segments * photons / match_pace(project.method)[1]
        + if project.fits() { steps * photons * fields_asked / pace::ADVECT } else { 0.0 }
}

/// The segments in which light moves.
fn moving_segments(project: &Project) -> f64 {
    (1..project.keys.len()).filter(|&key| layers(project, key) > 0).count() as f64
}

/// Matching and fit of each segment, whose fields are counted by `layers`.
fn motion_stages(
    project: &Project,
    extent: Vec2,
    photons: f64,
    layers: &[usize],
) -> Vec<(&'static str, f64)> {
    let fit = f64::from(project.flow.steps) * (0.01 + unknowns(project, extent) / pace::FIT);
    let plan = f64::from(project.flow.steps) * pace::PLAN;
    let meets = project.method == MotionMethod::Flow && project.matching == MatchingMethod::Transport;
    let mut stages = Vec::new();
    for &layers in layers {
        let moving = if layers > 0 { photons } else { 0.0 };
        let matching = ("match", moving / match_pace(project.method)[0]);
        if meets {
            stages.extend((0..layers).flat_map(|_| [("plan", plan), ("fit", fit)]));
            stages.push(matching);
            continue;
        }
        stages.push(matching);
        if project.fits() {
            stages.extend((0..layers).map(|_| ("fit", fit)));
        }
    }
    stages
}

/// Points paired per second by the first pass, and by each later one.
fn match_pace(method: MotionMethod) -> [f64; 2] {
    match method {
        MotionMethod::Flow | MotionMethod::Guided | MotionMethod::Linear => [pace::MATCH, pace::REMATCH],
        MotionMethod::Stylized => [pace::STYLIZED; 2],
    }
}

/// The turbulence, where it is not left out.
fn swirls(project: &Project) -> Option<&TurbulenceSettings> {
    project.flow.turbulence.as_ref().filter(|turbulence| project.fits() && turbulence.is_on())
}

/// The number of fields that carry light to key `key`: a shared one, and one for each caustic with its own flow; light that is
/// physical before and after needs none.
fn layers(project: &Project, key: usize) -> usize {
    let (before, after) = (&project.keys[key - 1], &project.keys[key]);
    let moves = |caustic: Option<&str>| {
        [before, after].iter().any(|key| *key.shown_by(caustic) != Shows::PhysicalCaustic)
    };
    let (own, shared): (Vec<_>, Vec<_>) =
        project.caustics.iter().filter(|c| moves(Some(&c.name))).partition(|c| c.own_flow);
    own.len() + usize::from(moves(None) || !shared.is_empty())
}

/// Unknowns of one linear system.
fn unknowns(project: &Project, extent: Vec2) -> f64 {
    let nodes: f64 = project.flow.grid.cells(extent).iter().map(|cells| f64::from(*cells) + 3.0).product();
    let both = project.flow.gamma > 0.0 && project.flow.gamma < 1.0;
    if both { 2.0 * nodes } else { nodes }
}

/// Measured on the examples: the peak is in the passes.
fn memory_mib(project: &Project, extent: Vec2, plan: &Plan) -> f64 {
    // Of a photon: both keys' positions and flux, the pairing, the tracks, and copies of them; what is remembered of the first pass,
    // for further segments, too; what is known of it where it is traced.
    let segments = project.keys.len().saturating_sub(1);
    let moving = if segments > 0 { 575.0 + 25.0 * segments as f64 } else { 150.0 };
    let traced = if project.traces() { 130.0 } else { 0.0 };
    let photons = plan.photons as f64 * (moving + traced);
    let layers: usize = (1..project.keys.len()).map(|key| layers(project, key)).sum();
    let fields = if project.fits() {
        8.0 * layers as f64 * unknowns(project, extent) * f64::from(project.flow.steps + 1)
    } else {
        0.0
    };
    let noises = match swirls(project) {
        Some(turbulence) => segments as f64 * turbulence.bytes(extent) as f64,
        None => 0.0,
    };
    let pixels = f64::from(project.render.width) * f64::from(project.render.height);
    // The texture of a pass, its filtered copy, and the sums read back from the scratch file.
    let textures = 6.0 * 16.0 * plan.texels as f64;
    40.0 + (photons + fields + noises + pixels * (100.0 + bytes_seen(project)) + textures) / MIB
}

/// Bytes for the texels that a pixel sees: four for each sample, and no more than lie under it.
fn bytes_seen(project: &Project) -> f64 {
    let under: f64 = if project.scene.is_some() { 32.0 } else { 16.0 };
    16.0 * under.min(4.0 * f64::from(project.render.camera_samples))
}

/// Bytes on disk of what a render keeps besides the light of its frames: what the camera sees, and samples on their way, of which there
/// are two for a moment.
fn kept_bytes(project: &Project) -> f64 {
    let pixels = f64::from(project.render.width) * f64::from(project.render.height);
    pixels * (bytes_seen(project) + 150.0)
}

/// About the size of one frame in all formats.
fn frame_bytes(project: &Project, texels: f64) -> f64 {
    let (output, render) = (&project.output, &project.render);
    let pixels = f64::from(render.width) * f64::from(render.height);
    let halves = |layer: &FrameLayer| match layer {
        FrameLayer::Beauty | FrameLayer::Background => 4.0,
        FrameLayer::Caustic => 3.0,
        FrameLayer::Caustics => 3.0 * (project.caustics.len() + 1) as f64,
        FrameLayer::Depth => 2.0,
        FrameLayer::Plane => 0.0,
    };
    let of_format = |format: &FrameFormat| match (format, output.png_depth()) {
        (FrameFormat::Exr, _) => output.layers.iter().map(halves).sum::<f64>() * bytes::HALF,
        (FrameFormat::Png, PngDepth::Eight) => bytes::PNG,
        (FrameFormat::Png, PngDepth::Sixteen) => bytes::PNG_16,
    };
    let plane = if output.shows_plane() { 6.0 * bytes::HALF * texels } else { 0.0 };
    pixels * output.formats.iter().map(of_format).sum::<f64>() + plane
}

const MIB: f64 = 1_048_576.0;

impl Plan {
    /// Refuses work that would not fit into the free memory, where the system tells how much that is.
    pub(super) fn require_memory(&self) -> Result<()> {
        let Some(free) = free_mib().filter(|free| self.memory_mib > *free) else { return Ok(()) };
        let what = format!(
            "needs about {:.1} GiB of memory, {:.1} GiB are free; ask for fewer photons, a smaller picture or fewer texels",
            self.memory_mib / 1024.0,
            free / 1024.0
        );
        Err(Error::Limit { place: "render".into(), what })
    }

    /// Sets the size of the light of all frames in files.
    pub(super) fn set_scratch(&mut self, bytes: u64) {
        self.scratch_mib = bytes as f64 / MIB + self.kept_mib;
    }

    /// Refuses work whose scratch file and frames would not fit into `folder`, where the system tells how much is free there.
    /// `kept` bytes are there already.
    pub(super) fn require_space(&self, folder: &Path, kept: u64) -> Result<()> {
        let Some(free) = files::free_bytes(folder).map(|bytes| bytes as f64 / MIB) else { return Ok(()) };
        let needed = (self.scratch_mib - kept as f64 / MIB).max(0.0) + self.output_mib;
        if needed <= free {
            return Ok(());
        }
        let what = format!(
            "{needed:.1} MiB are needed: {:.1} MiB while the frames are rendered, {:.1} MiB for the frames; {free:.1} MiB are \
            free; ask for fewer frames or fewer texels, or for another folder",
            self.scratch_mib, self.output_mib
        );
        Err(Error::io("write the scratch file in", folder)(std::io::Error::new(
            std::io::ErrorKind::StorageFull,
            what,
        )))
    }

    /// Seconds that every part of a render takes that starts from a bake, and those of each frame.
    pub fn seconds_of_chunk(&self) -> [f64; 2] {
        let of =
            |name: &str| self.stages.iter().filter(|(stage, _)| *stage == name).map(|(_, s)| s).sum::<f64>();
        let frames = self.frames.max(1) as f64;
        [self.shared_seconds, (of("render") - self.shared_seconds + of("write")).max(0.0) / frames]
    }

    /// Seconds that a film of all frames takes, about.
    pub(super) fn film_seconds(&self, render: &RenderSettings) -> f64 {
        self.frames as f64 * f64::from(render.width) * f64::from(render.height) / pace::FILM
    }

    /// Seconds of all stages.
    pub fn seconds(&self) -> f64 {
        self.stages.iter().map(|(_, seconds)| seconds).sum()
    }
}

/// Memory that a program may take without driving others out, in MiB: proc_meminfo(5).
fn free_mib() -> Option<f64> {
    let memory = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = memory.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}
