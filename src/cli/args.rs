//! Command-line arguments.

use std::io;
use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand, ValueEnum};
use lightloom_core::engine::Quality;
use lightloom_core::export::{FrameFormat, FrameLayer};
use lightloom_core::project::{AssetFolder, Project, frames};
use lightloom_core::{Error, Result};

use super::progress::Manner;
use crate::editor::store::{Folders, trusted};
use crate::log::LogChoice;

/// Paint where caustics shall flow, and export the animation. Without a command, the editor opens.
#[derive(Parser)]
#[command(version, about, args_conflicts_with_subcommands = true)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    /// Write what happens into a log: error, warn, info, debug or trace into the folder `logs` of the state folder; or into a
    /// file, whose name ends in .log. Without it the editor logs on level info, commands do not.
    #[arg(long, global = true, value_name = "LEVEL|FILE")]
    pub(crate) log: Option<LogChoice>,
    /// The project to open in the editor.
    #[arg(value_name = "PROJECT")]
    pub(crate) project: Option<PathBuf>,
    /// Open the editor with default preferences; the stored ones are neither read nor changed.
    #[arg(long)]
    pub(crate) safe_mode: bool,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Render a project's frames.
    Render(RenderArgs),
    /// Fit the flow without rendering: photon tracks, flux and fields as NPY and NPZ.
    Fit(FitArgs),
    /// Write the photons of all frames and the drawn lines for other programs: USD, or PLY per frame.
    Photons(PhotonsArgs),
    /// Render a project by the vector field, by the method of 2016 and by straight lines, side by side on one sheet.
    Compare(CompareArgs),
    /// Measure how well the light of projects holds together on its way: cracks, torn pieces, bunching, speed. A table with a
    /// row for each segment; nothing is rendered.
    Figures(FiguresArgs),
    /// Write the files by which a render farm does a project in parts: Slurm scripts, or an OpenJD job.
    Farm(FarmArgs),
    /// Look whether the frames in a folder are whole, finished, made from the same, and without gaps.
    Verify(VerifyArgs),
    /// Print what frames say of themselves: size, layers, passes, settings, and the fingerprint of what they are made from.
    Info(InfoArgs),
    /// Write the contact sheet of the frames in a folder.
    Sheet(SheetArgs),
    /// Say what would be done, what is left out and why, what is wrong, and what it would cost.
    Check(CheckArgs),
    /// Make a project of a scene from another program: glTF (.glb, .gltf) with its lamps, cameras and glass, or OBJ.
    Import(ImportArgs),
    /// Copy a project with all its files into one folder, to hand on or to render elsewhere.
    Collect(CollectArgs),
    /// Measure what a project's settings buy and cost: a page with plots, tables and pictures.
    Report(ReportArgs),
    /// Print the JSON schema of project files.
    Schema,
}

#[derive(Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) project: ProjectArgs,
    /// Folder for the frames, the contact sheet and summary.json; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// A film of all frames, too, by its ending: .gif, .apng or .mp4 (by ffmpeg, where it is installed). It runs at the frame
    /// rate of the project, over and over.
    #[arg(long, value_name = "FILE")]
    pub(crate) film: Option<PathBuf>,
    /// Replace frames in the folder that were made from another project or other settings. Finished frames of the same are kept
    /// in any case: they have the same bytes.
    #[arg(long, conflicts_with = "skip")]
    pub(crate) overwrite: bool,
    /// Keep frames in the folder that were made from another project or other settings.
    #[arg(long)]
    pub(crate) skip: bool,
    /// Start from what `lightloom fit PROJECT --bake DIR` made with the same options. Then --frames are a part of a render that is
    /// done in parts, on many machines: no contact sheet and no summary.json is written.
    #[arg(long, value_name = "DIR", conflicts_with = "film")]
    pub(crate) bake: Option<PathBuf>,
    /// Share the frames with other processes that are started with the same options, here or on other machines: each claims a chunk
    /// of so many frames, makes it, and takes the next that nobody has. No contact sheet and no summary.json is written.
    #[arg(long, value_name = "FRAMES", conflicts_with = "film", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) claim: Option<u32>,
}

#[derive(Args)]
pub(crate) struct FitArgs {
    #[command(flatten)]
    pub(crate) project: ProjectArgs,
    /// Folder for tracks.npy, flux.npy, fields.npz and summary.json; made if it is not there.
    #[arg(long, value_name = "DIR", required_unless_present = "bake", conflicts_with = "bake")]
    pub(crate) out: Option<PathBuf>,
    /// Bake into this folder instead: all that a render needs before its first pass, for `lightloom render --bake DIR`.
    #[arg(long, value_name = "DIR")]
    pub(crate) bake: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct FarmArgs {
    /// All options but those below are those of the render.
    #[command(flatten)]
    pub(crate) project: ProjectArgs,
    /// Folder on a disk that all machines see, for the job, the bake and the frames; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// slurm: scripts and submit.sh; openjd: job.json.
    #[arg(long = "as", value_enum)]
    pub(crate) kind: FarmKind,
    /// Frames of one task. Without it as many that a task lasts half a minute, and is a third its own.
    #[arg(long)]
    pub(crate) chunk: Option<usize>,
    /// The program as the machines of the farm call it.
    #[arg(long, value_name = "COMMAND", default_value = "lightloom")]
    pub(crate) program: String,
}

/// The kinds of render farms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FarmKind {
    Slurm,
    Openjd,
}

#[derive(Args)]
pub(crate) struct VerifyArgs {
    /// The folder of the frames.
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// The frames that must be there, such as 1-100; without it those between the first and the last.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) frames: Option<String>,
    /// The folder of the bake that they must be made from.
    #[arg(long, value_name = "DIR")]
    pub(crate) bake: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct InfoArgs {
    /// The files, EXR or PNG.
    #[arg(value_name = "FRAME", required = true)]
    pub(crate) frames: Vec<PathBuf>,
    /// Print it as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct SheetArgs {
    /// The folder of the frames.
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
}

#[derive(Args)]
pub(crate) struct PhotonsArgs {
    /// Without --photons, at most 20000 photons are written.
    #[command(flatten)]
    pub(crate) project: ProjectArgs,
    /// Folder for photons.usda, or for photons.0001.ply and so on and lines.ply, and for summary.json; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// usda: one file with a sample for each frame; ply: a file for each frame.
    #[arg(long = "as", value_name = "KIND", default_value = "usda")]
    pub(crate) kind: String,
}

#[derive(Args)]
#[command(mut_arg("path", |path| path.required(false).required_unless_present("stability")))]
pub(crate) struct ReportArgs {
    #[command(flatten)]
    pub(crate) project: ProjectArgs,
    /// Folder for report.html, report.json, and the folder report with tables and plots (of --stability: stability.html,
    /// stability.json, and the folder stability); made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Measure at preview size, within a minute.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Measure no project but the program: does it hold where inputs are stiff and extreme?
    #[arg(long, conflicts_with_all = ["path", "only", "frames", "size", "passes", "photons", "quality", "format", "layers", "draw_constraints", "seed"])]
    pub(crate) stability: bool,
    /// Sections to measure, such as gamma,render; all without it.
    #[arg(long, value_name = "SECTIONS", value_delimiter = ',')]
    pub(crate) only: Vec<String>,
}

#[derive(Args)]
pub(crate) struct CompareArgs {
    /// Without --frames, six frames are compared.
    #[command(flatten)]
    pub(crate) project: ProjectArgs,
    /// Folder for compare.png, compare.json and a folder of frames for each method; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
}

#[derive(Args)]
pub(crate) struct FiguresArgs {
    /// The project files.
    #[arg(value_name = "PROJECT", required = true)]
    pub(crate) paths: Vec<PathBuf>,
    /// Values of gamma in place of the project's own, such as 0,0.5,1: a row for each.
    #[arg(long, value_delimiter = ',')]
    pub(crate) gamma: Vec<f32>,
    /// Methods in place of the project's own, such as flow,linear: a row for each.
    #[arg(long, value_delimiter = ',')]
    pub(crate) method: Vec<String>,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args)]
pub(crate) struct ImportArgs {
    /// The scene: .glb, .gltf or .obj.
    #[arg(value_name = "SCENE")]
    pub(crate) file: PathBuf,
    /// What the light becomes at the last key frame: a picture, such as a logo. It is laid where the caustic falls.
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
    /// Folder for the project SCENE.json and a copy of the scene; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) into: PathBuf,
}

#[derive(Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) project: ProjectArgs,
}

#[derive(Args)]
pub(crate) struct CollectArgs {
    /// The project file.
    #[arg(value_name = "PROJECT")]
    pub(crate) path: PathBuf,
    /// Folder for the project file, its meshes with their material files, pictures and points; made if it is not there. What
    /// stands there is not overwritten.
    #[arg(long, value_name = "DIR")]
    pub(crate) into: PathBuf,
    /// Let the project read meshes and pictures from anywhere, not only from its own folder.
    #[arg(long)]
    pub(crate) allow_external: bool,
    /// Print the result as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// The project, and what differs from it in this run.
#[derive(Args)]
pub(crate) struct ProjectArgs {
    /// The project file.
    #[arg(value_name = "PROJECT", required = true)]
    path: Option<PathBuf>,
    /// Frames, such as 1-100, 1-100x5 or 1,5-10.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) frames: Option<String>,
    /// Picture size, such as 1280x720.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Progressive passes.
    #[arg(long)]
    passes: Option<u32>,
    /// Photons per pass.
    #[arg(long)]
    pub(crate) photons: Option<u64>,
    /// Picture formats, such as exr,png.
    #[arg(long, value_delimiter = ',')]
    format: Vec<String>,
    /// Layers of EXR files: beauty, caustic, caustics (one for each named caustic), background, depth, plane (the
    /// light on the receiver in W/m², a texture for any renderer, in files NAME_plane.0001.exr). Without beauty and background
    /// none is traced, and PNG files show the caustics on black.
    #[arg(long, value_delimiter = ',')]
    layers: Vec<String>,
    /// Draw the lines and walls of the project on sheets, thin.
    #[arg(long)]
    draw_constraints: bool,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// What can differ in a run of any project.
#[derive(Args)]
pub(crate) struct CommonArgs {
    /// Preview: few photons, coarse grid, small picture. Final: as the project says.
    #[arg(long, value_enum, default_value = "final")]
    quality: QualityName,
    /// Threads; the result does not depend on their number. Default: one per core.
    #[arg(long)]
    threads: Option<usize>,
    /// Seed of all random numbers.
    #[arg(long)]
    seed: Option<u64>,
    /// Let the project read meshes and pictures from anywhere, not only from its own folder.
    #[arg(long)]
    pub(crate) allow_external: bool,
    /// Print the result as JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// How progress is told: a bar on a terminal and plain lines elsewhere (auto), lines for logs and farms at least every 20 seconds
    /// (plain), a JSON object in each line (json), or as OpenJD reads it (openjd).
    #[arg(long, value_enum, default_value = "auto")]
    pub(super) progress: Manner,
}

#[derive(Clone, Copy, ValueEnum)]
enum QualityName {
    Preview,
    Final,
}

impl ProjectArgs {
    /// The project as this run shall do it.
    pub(crate) fn load(&self) -> Result<Project> {
        // What is asked for by name outweighs the quality.
        let mut project = self.common.load(self.path()?)?;
        if let Some(frames) = &self.frames {
            frames::parse(frames, "--frames")?;
            project.output.frames = Some(frames.clone());
        }
        if let Some(size) = &self.size {
            (project.render.width, project.render.height) = parse_size(size)?;
        }
        project.render.passes = self.passes.unwrap_or(project.render.passes);
        project.render.photons = self.photons.unwrap_or(project.render.photons);
        if !self.format.is_empty() {
            project.output.formats =
                self.format.iter().map(|name| parse_format(name)).collect::<Result<_>>()?;
        }
        if !self.layers.is_empty() {
            project.output.layers =
                self.layers.iter().map(|name| parse_layer(name)).collect::<Result<_>>()?;
        }
        project.output.draws_constraints |= self.draw_constraints;
        // The file was in order, so what is wrong now was typed.
        project.check().map_err(|error| match error {
            Error::Value { place, what } => {
                Error::value(format!("--{}", place.replace("render.", "").replace("output.", "")), what)
            }
            other => other,
        })?;
        Ok(project)
    }

    /// The options of this run but for the frames, as they were typed.
    pub(crate) fn options(&self) -> Vec<String> {
        let CommonArgs { quality, threads, seed, allow_external, .. } = &self.common;
        let named = [
            ("--size", self.size.clone()),
            ("--passes", self.passes.map(|n| n.to_string())),
            ("--photons", self.photons.map(|n| n.to_string())),
            ("--format", Some(self.format.join(",")).filter(|list| !list.is_empty())),
            ("--layers", Some(self.layers.join(",")).filter(|list| !list.is_empty())),
            ("--quality", matches!(quality, QualityName::Preview).then(|| "preview".into())),
            ("--threads", threads.map(|n| n.to_string())),
            ("--seed", seed.map(|n| n.to_string())),
        ];
        let named = named.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?]));
        let switches = [("--draw-constraints", self.draw_constraints), ("--allow-external", *allow_external)];
        let switches = switches.into_iter().filter(|(_, on)| *on).map(|(name, _)| name.to_owned());
        named.flatten().chain(switches).collect()
    }

    /// The project file.
    ///
    /// # Errors
    /// `Value` where a command that can do without one was given none.
    pub(crate) fn path(&self) -> Result<&Path> {
        self.path.as_deref().ok_or_else(|| Error::value("PROJECT", "name a project file"))
    }
}

/// Finds the files of the project at `path`: in its folder, those that the user trusts, or anywhere.
pub(crate) fn assets(path: &Path, allow_external: bool) -> Result<AssetFolder> {
    Ok(AssetFolder::new(path, allow_external)?.admitting(trusted(Folders::of_user().as_ref())))
}

impl CommonArgs {
    /// Finds the files of the project at `path`.
    pub(crate) fn assets(&self, path: &Path) -> Result<AssetFolder> {
        assets(path, self.allow_external)
    }

    /// The project of a file at the quality and with the seed of this run.
    pub(crate) fn load(&self, path: &Path) -> Result<Project> {
        let quality = match self.quality {
            QualityName::Preview => Quality::Fine,
            QualityName::Final => Quality::Final,
        };
        let project = quality.apply(&Project::load(path)?);
        Ok(Project { seed: self.seed.unwrap_or(project.seed), ..project })
    }

    /// Starts the threads of the whole process, of which this one is the first; done once. From a thread outside, each parallel loop
    /// would be handed over and waited for, which takes some 50 us: more than many loops of solvers and plans.
    pub(crate) fn set_threads(&self) -> Result<()> {
        let mut pool = rayon::ThreadPoolBuilder::new().use_current_thread();
        if let Some(threads) = self.threads {
            if !(1..=1024).contains(&threads) {
                return Err(Error::value("--threads", format!("{threads} is out of range; give 1 to 1024")));
            }
            pool = pool.num_threads(threads);
        }
        pool.build_global().map_err(|error| {
            let refused =
                std::error::Error::source(&error).and_then(|source| source.downcast_ref::<io::Error>());
            let kind = refused.map_or(io::ErrorKind::Other, io::Error::kind);
            Error::io("start the threads of", "--threads")(io::Error::new(kind, error.to_string()))
        })
    }
}

fn parse_size(text: &str) -> Result<(u32, u32)> {
    let numbers =
        text.split_once('x').and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    numbers
        .ok_or_else(|| Error::value("--size", format!("'{text}' is no picture size; write it like 1280x720")))
}

fn parse_layer(name: &str) -> Result<FrameLayer> {
    let known = FrameLayer::ALL.into_iter().find(|layer| layer.name() == name.trim());
    known.ok_or_else(|| {
        let names = FrameLayer::ALL.map(FrameLayer::name).join(",");
        Error::value("--layers", format!("'{name}' is not offered; give one or more of {names}"))
    })
}

fn parse_format(name: &str) -> Result<FrameFormat> {
    let known = FrameFormat::ALL.iter().copied().find(|format| format.extension() == name.trim());
    known.ok_or_else(|| {
        let names: Vec<_> = FrameFormat::ALL.iter().map(|format| format.extension()).collect();
        Error::value("--format", format!("'{name}' is not offered; give one or more of {}", names.join(",")))
    })
}
