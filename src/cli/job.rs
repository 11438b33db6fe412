//! What every command that works does around its work: Ctrl-C, the folder, the progress, the summary.

use std::io::Write as _;
use std::path::Path;

use lightloom_core::flow::Movement;
use lightloom_core::pipeline::{Comparison, Pipeline, Summary};
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::report::GammaResponse;
use lightloom_core::{Error, Progress, Result};

use super::args::ProjectArgs;
use super::progress::{Display, Lines};

/// Told of each file that is complete.
type Saved<'a> = &'a (dyn Fn(&Path) + Sync);

/// What a command leaves in words.
pub(super) trait Outcome {
    /// The file for it in the output folder.
    const FILE: &'static str;
    /// Folders below the output folder that get frames, too.
    fn folders() -> Vec<&'static str> {
        Vec::new()
    }
    fn to_json(&self) -> String;
    fn to_text(&self) -> String;
}

impl Outcome for Summary {
    const FILE: &'static str = "summary.json";
    fn to_json(&self) -> String {
        self.to_json()
    }
    fn to_text(&self) -> String {
        self.to_text()
    }
}

impl Outcome for Comparison {
    const FILE: &'static str = "compare.json";
    fn folders() -> Vec<&'static str> {
        Movement::ALL.map(Movement::name).to_vec()
    }
    fn to_json(&self) -> String {
        self.to_json()
    }
    fn to_text(&self) -> String {
        self.to_text()
    }
}

impl Outcome for GammaResponse {
    const FILE: &'static str = "gamma.json";
    fn to_json(&self) -> String {
        self.to_json()
    }
    fn to_text(&self) -> String {
        self.to_text()
    }
}

/// Loads the project, shows how far `work` is, then writes and prints its summary.
pub(super) fn run<T: Outcome>(
    args: &ProjectArgs,
    out: &Path,
    work: impl FnOnce(&mut Pipeline, &Project, &Progress, Saved) -> Result<T>,
) -> Result<T> {
    args.set_threads()?;
    let project = args.load()?;
    let assets = AssetFolder::new(&args.path, args.allow_external)?;
    prepare_folder(out, &args.path, &project)?;
    for folder in T::folders() {
        prepare_folder(&out.join(folder), &args.path, &project)?;
    }
    let progress = Progress::new();
    stop_on_interrupt(&progress);

    let display = Display::start(&progress, Lines::beside(args.json));
    let saved = |path: &Path| display.line(&format!("Saved: '{}'", path.display()));
    let summary = work(&mut Pipeline::new(assets), &project, &progress, &saved)?;
    drop(display);
    conclude(&summary, out, args.json)?;
    Ok(summary)
}

/// Ctrl-C asks the work to stop; a second one leaves at once.
fn stop_on_interrupt(progress: &Progress) {
    let progress = progress.clone();
    let set = ctrlc::set_handler(move || {
        if progress.is_cancelled() {
            std::process::exit(130);
        }
        progress.cancel();
    });
    if let Err(error) = set {
        eprintln!("lightloom: Ctrl-C stops at once and keeps nothing: {error}");
    }
}

/// Makes the output folder, and tries whether files can be made in it before hours of work go there. No file of the
/// project may take the place of one that it is made from.
fn prepare_folder(dir: &Path, project_path: &Path, project: &Project) -> Result<()> {
    if dir.is_file() {
        return Err(Error::value("--out", format!("'{}' is a file; name a folder", dir.display())));
    }
    std::fs::create_dir_all(dir).map_err(Error::io("create the folder", dir))?;
    tempfile::Builder::new().tempfile_in(dir).map_err(Error::io("write into the folder", dir))?;
    let folder = dir.canonicalize().map_err(Error::io("find the folder", dir))?;
    let base = project_path.parent().unwrap_or(Path::new(""));
    let inputs = project.files().into_iter().map(|file| base.join(file)).chain([project_path.to_owned()]);
    for input in
        inputs.filter_map(|path| path.canonicalize().ok()).filter(|path| path.parent() == Some(&folder))
    {
        let name = input.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if OUTPUTS.contains(&name.as_str()) || project.output.writes(&name) {
            let what = format!(
                "'{name}' there is what the project is made from, and would be overwritten; name another folder"
            );
            return Err(Error::value("--out", what));
        }
    }
    Ok(())
}

/// What stands in an output folder beside the frames.
const OUTPUTS: [&str; 10] = [
    "summary.json",
    "contact_sheet.png",
    "tracks.npy",
    "flux.npy",
    "fields.npz",
    "compare.png",
    "compare.json",
    "gamma.svg",
    "gamma.csv",
    "gamma.json",
];

/// Writes the summary as JSON, and prints it so or as a few lines.
fn conclude<T: Outcome>(summary: &T, dir: &Path, json: bool) -> Result<()> {
    let text = summary.to_json();
    let path = dir.join(T::FILE);
    lightloom_core::files::write_atomic(&path, |file| file.write_all(text.as_bytes()))?;
    let shown = if json { text } else { summary.to_text() };
    Lines::Out.say(shown.trim_end());
    Ok(())
}
