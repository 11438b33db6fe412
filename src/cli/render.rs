//! `lightloom render`: project file to numbered frames.

use lightloom_core::engine::{Existing, Output, Summary, prepare_film};
use lightloom_core::{Error, Result};

use super::args::RenderArgs;
use super::exit_code::BAD_FRAMES;
use super::{claim, job};

pub(super) fn run(args: &RenderArgs) -> Result<u8> {
    let (film, bake, is_part) = (args.film.as_deref(), args.bake.as_deref(), args.claim.is_some());
    let existing = match (args.overwrite, args.skip) {
        (true, _) => Existing::Overwrite,
        (_, true) => Existing::Skip,
        _ => Existing::Refuse,
    };
    let (stopped, bad) = match args.claim {
        None => {
            let summary = job::run(&args.project, &args.out, |engine, project, progress, saved| {
                if let Some(film) = film {
                    prepare_film(film, args.project.path()?, project, "--film")?;
                }
                let output = Output { existing, film, bake, ..Output::new(&args.out, progress, saved) };
                engine.render_to(project, &output)
            })?;
            (summary.passes < summary.passes_planned, summary.has_bad_frames())
        }
        Some(size) => {
            let claimed = job::run(&args.project, &args.out, |engine, project, progress, saved| {
                let output = Output { existing, bake, is_part, ..Output::new(&args.out, progress, saved) };
                claim::run(engine, project, &output, size as usize)
            })?;
            (claimed.is_stopped(), claimed.chunks.iter().any(Summary::has_bad_frames))
        }
    };
    if stopped {
        eprintln!(
            "lightloom: stopped early; every frame is there, at the quality reached so far; the same command goes on from there"
        );
        return Err(Error::Cancelled);
    }
    Ok(if bad { BAD_FRAMES } else { 0 })
}
