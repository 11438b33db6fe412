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
    let (parts, stopped) = match args.claim {
        None => {
            let summary = job::run(&args.project, &args.out, |engine, project, progress, saved| {
                if let Some(film) = film {
                    prepare_film(film, args.project.path()?, project, "--film")?;
                }
                let output = Output { existing, film, bake, ..Output::new(&args.out, progress, saved) };
                engine.render_to(project, &output)
            })?;
            let stopped = summary.is_stopped();
            (vec![summary], stopped)
        }
        Some(size) => {
            let claimed = job::run(&args.project, &args.out, |engine, project, progress, saved| {
                let output = Output { existing, bake, is_part, ..Output::new(&args.out, progress, saved) };
                claim::run(engine, project, &output, size as usize)
            })?;
            let stopped = claimed.is_stopped();
            (claimed.chunks, stopped)
        }
    };
    if stopped {
        let there = match parts.iter().map(|part| part.frames_left).sum() {
            0_usize => "every frame is there, at the quality reached so far".to_owned(),
            left => format!(
                "there was no time for {left} frames, whose light is kept; the others are there, at the quality reached so far"
            ),
        };
        eprintln!("lightloom: stopped early; {there}; the same command goes on from there");
        return Err(Error::Cancelled);
    }
    Ok(if parts.iter().any(Summary::has_bad_frames) { BAD_FRAMES } else { 0 })
}
