//! `lightloom photons`: the photons of all frames and the drawn lines, for other programs.

use lightloom_core::export::PhotonFormat;
use lightloom_core::{Error, Result};

use super::args::PhotonsArgs;
use super::job;

/// Photons where none are asked for: enough to see the light, few enough for a text file.
const PHOTONS: u64 = 20_000;

pub(super) fn run(args: &PhotonsArgs) -> Result<u8> {
    let format = PhotonFormat::ALL.into_iter().find(|format| format.extension() == args.kind.trim());
    let format = format.ok_or_else(|| {
        let names = PhotonFormat::ALL.map(PhotonFormat::extension).join(" or ");
        Error::value("--as", format!("'{}' is not offered; give {names}", args.kind))
    })?;
    job::run(&args.project, &args.out, |engine, project, progress, saved| {
        let mut project = project.clone();
        if args.project.photons.is_none() {
            project.render.photons = project.render.photons.min(PHOTONS);
        }
        engine.photons(&project, (&args.out, format), progress, saved)
    })?;
    Ok(0)
}
