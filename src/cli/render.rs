//! `lightloom render`: project file to numbered frames.

use lightloom_core::engine::{Output, prepare_film};
use lightloom_core::{Error, Result};

use super::args::RenderArgs;
use super::exit_code::BAD_FRAMES;
use super::job;

pub(super) fn run(args: &RenderArgs) -> Result<u8> {
    let summary = job::run(&args.project, &args.out, |engine, project, progress, saved| {
        let film = args.film.as_deref();
        if let Some(film) = film {
            prepare_film(film, args.project.path()?, project, "--film")?;
        }
        engine.render_to(project, &Output { folder: &args.out, film, progress, saved, observer: &() })
    })?;
    if summary.passes < summary.passes_planned {
        eprintln!("lightloom: stopped early; every frame is there, at the quality reached so far");
        return Err(Error::Cancelled);
    }
    Ok(if summary.has_bad_frames() { BAD_FRAMES } else { 0 })
}
