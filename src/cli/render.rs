//! `lightloom render`: project file to numbered frames.

use lightloom_core::engine::{Existing, Output, prepare_film};
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
        let existing = match (args.overwrite, args.skip) {
            (true, _) => Existing::Overwrite,
            (_, true) => Existing::Skip,
            _ => Existing::Refuse,
        };
        let bake = args.bake.as_deref();
        let output = Output { existing, film, bake, ..Output::new(&args.out, progress, saved) };
        engine.render_to(project, &output)
    })?;
    if summary.passes < summary.passes_planned || summary.frames_left > 0 {
        let there = match summary.frames_left {
            0 => "every frame is there, at the quality reached so far".to_owned(),
            left => format!(
                "there was no time for {left} frames, whose light is kept; the others are there, at the quality reached so far"
            ),
        };
        eprintln!("lightloom: stopped early; {there}; the same command goes on from there");
        return Err(Error::Cancelled);
    }
    Ok(if summary.has_bad_frames() { BAD_FRAMES } else { 0 })
}
