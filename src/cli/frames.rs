//! `lightloom verify`, `info` and `sheet`: frames that are there, without their project.

use lightloom_core::engine::{verify as look, write_sheet};
use lightloom_core::export::{FrameFile, inspect};
use lightloom_core::project::frames;
use lightloom_core::{Error, Result};
use serde_json::json;

use super::args::{InfoArgs, SheetArgs, VerifyArgs};
use super::exit_code::BAD_FRAMES;
use super::progress::Lines;

pub(super) fn verify(args: &VerifyArgs) -> Result<u8> {
    let frames = args.frames.as_deref().map(|list| frames::parse(list, "--frames")).transpose()?;
    let found = look(&args.folder, frames.as_deref(), args.bake.as_deref())?;
    Lines::Out.print(&if args.json { found.to_json() } else { found.to_text() })?;
    Ok(if found.is_good() { 0 } else { BAD_FRAMES })
}

pub(super) fn info(args: &InfoArgs) -> Result<u8> {
    let mut all = Vec::new();
    for path in &args.frames {
        let FrameFile { size, parts, texts } = inspect(path)?;
        if args.json {
            all.push(json!({ "file": path, "size": size, "parts": parts, "texts": texts }));
            continue;
        }
        let mut text = format!("{}: {} x {} pixels, whole", path.display(), size[0], size[1]);
        parts.iter().for_each(|part| text += &format!("\n  layer {part}"));
        texts.iter().for_each(|(name, value)| text += &format!("\n  {name}: {value}"));
        Lines::Out.print(&text)?;
    }
    if args.json {
        let text = serde_json::to_string_pretty(&all);
        Lines::Out.print(&text.map_err(|error| Error::value("FRAME", error.to_string()))?)?;
    }
    Ok(0)
}

pub(super) fn sheet(args: &SheetArgs) -> Result<u8> {
    let path = write_sheet(&args.folder)?;
    Lines::Out.print(&format!("Saved: '{}'", path.display()))?;
    Ok(0)
}
