//! `lightloom import`: a scene of another program becomes a project.

use std::path::Path;

use lightloom_core::engine::Engine;
use lightloom_core::project::{AssetFolder, ProjectFile, Shows};
use lightloom_core::{Progress, Result, import};

use super::args::ImportArgs;
use super::progress::Lines;

pub(super) fn run(args: &ImportArgs) -> Result<u8> {
    let picture = args.picture.as_deref();
    let (import, project) = import::into_folder(&args.file, picture, &args.into, &Progress::new())?;
    let summary = &import.summary;
    summary.notes.iter().for_each(|note| Lines::Err.say(&format!("note: {note}")));
    if let Some(picture) = picture
        && let Err(error) = place(&project, picture)
    {
        // The project is whole without it.
        Lines::Err.say(&format!("note: the picture lies in the middle of the table: {error}"));
    }
    Lines::Out.print(&format!("{}\n{}", summary.line(), project.display()))?;
    Ok(0)
}

/// Lays the picture of the last key frame where the caustic falls.
fn place(path: &Path, picture: &Path) -> Result<()> {
    let (file, _) = ProjectFile::open(path)?;
    let mut project = file.project().clone();
    let last = project.keys.len().saturating_sub(1);
    let Some(Shows::Image(target)) = project.keys.get(last).map(|key| key.shows.clone()) else {
        return Ok(());
    };
    let engine = Engine::new(AssetFolder::new(path, false)?);
    let placement = engine.placement(&project, (last, None), (picture, &target), &Progress::new())?;
    if let Some(Shows::Image(target)) = project.keys.get_mut(last).map(|key| &mut key.shows) {
        target.placement = placement;
    }
    file.save(path, &project).map(|_| ())
}
