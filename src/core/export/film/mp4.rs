//! MP4 by the program ffmpeg, which gets the frames through a pipe.

use std::io::{ErrorKind, Read as _, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use super::job::Film;
use crate::{Error, Result};

const PROGRAM: &str = "ffmpeg";
/// The encoder of H.264: quality by constant rate factor, where 18 is hardly told from the original.
const ENCODER: &str = "libx264";
const RATE_FACTOR: &str = "16";

/// Whether ffmpeg is there and knows the encoder.
pub(super) fn require(place: &str) -> Result<()> {
    let mut asked = Command::new(PROGRAM);
    let asked = asked.args(["-hide_banner", "-encoders"]).stdin(Stdio::null()).output();
    let output = asked.map_err(|error| Error::value(place, missing(&error)))?;
    let known = String::from_utf8_lossy(&output.stdout);
    if known.split_whitespace().any(|word| word == ENCODER) {
        return Ok(());
    }
    let what = format!(
        "the program {PROGRAM} on this machine knows no encoder {ENCODER}, which MP4 films need; install a full build of it, or choose a film that ends in .gif or .apng"
    );
    Err(Error::value(place, what))
}

fn missing(error: &std::io::Error) -> String {
    let why = match error.kind() {
        ErrorKind::NotFound => format!("the program {PROGRAM} was not found"),
        _ => format!("the program {PROGRAM} does not start ({error})"),
    };
    format!(
        "{why}, which writes MP4 films; install it (apt install ffmpeg, brew install ffmpeg, winget install ffmpeg), or choose a film that ends in .gif or .apng"
    )
}

pub(super) fn write(film: &Film) -> Result<()> {
    let temporary = crate::files::temporary_beside(film.path, ".mp4")?;
    let mut child = start(film, temporary.path())?;
    let fed = feed(film, &mut child);
    // Without its input ffmpeg ends by itself; what is cancelled is not waited for.
    if matches!(fed, Err(Error::Cancelled)) {
        let _ = child.kill();
    }
    let mut said = String::new();
    if let Some(stderr) = &mut child.stderr {
        // What cannot be read is not told; the exit status counts.
        let _ = stderr.read_to_string(&mut said);
    }
    let status = child.wait().map_err(film.refused())?;
    match fed {
        Err(Error::Cancelled) => return Err(Error::Cancelled),
        Ok(()) if status.success() => {}
        fed => {
            let said = said.trim().lines().last().unwrap_or_default().to_owned();
            let what = if said.is_empty() { format!("{status}") } else { said };
            let what = format!("{PROGRAM} could not write it: {what}");
            return Err(fed.err().filter(|_| status.success()).unwrap_or(Error::format(film.path, "", what)));
        }
    }
    crate::files::keep(temporary, film.path)
}

/// Starts ffmpeg: raw frames of 8 bits from its input, to the file `out`.
fn start(film: &Film, out: &Path) -> Result<Child> {
    let [width, height] = film.reel.size();
    let [frames, seconds] = film.frames_per_second;
    let mut command = Command::new(PROGRAM);
    command.args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
    command.args(["-video_size", &format!("{width}x{height}"), "-framerate", &format!("{frames}/{seconds}")]);
    command.args(["-i", "-", "-an"]);
    // Chroma is stored for pairs of pixels, so sides are made even; players ask the tags how to show colours.
    let filters = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p,\
        setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=bt709";
    command.args(["-vf", filters, "-c:v", ENCODER, "-crf", RATE_FACTOR, "-preset", "slow"]);
    command.args(["-movflags", "+faststart"]).arg(out);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().map_err(|error| Error::format(film.path, "", missing(&error)))
}

/// Sends all frames, each as often as it is shown, and closes the input.
fn feed(film: &Film, child: &mut Child) -> Result<()> {
    let Some(mut input) = child.stdin.take() else { return Ok(()) };
    for (index, hold) in film.holds.iter().enumerate() {
        let bytes = film.reel.get(index)?;
        for _ in 0..*hold {
            film.check()?;
            input.write_all(&bytes).map_err(Error::io("write", film.path))?;
        }
        film.progress.advance(1);
    }
    Ok(())
}
