//! `lightloom farm`: the files by which a render farm does a project in parts.
//!
//! A job is a bake, the frames in chunks that start from it, the contact sheet, and a check of all.

use std::path::{Path, PathBuf};

use lightloom_core::engine::{Engine, prepare_folder, write_report};
use lightloom_core::{Error, Result};
use serde_json::{Value, json};

use super::args::{self, FarmArgs, FarmKind};
use super::progress::Lines;

/// Least seconds of a task: starting one takes a second or two.
const LEAST_SECONDS: f64 = 30.0;
/// Most work of a task that others do, too, over what it does alone: fewer tasks waste less, more are done sooner.
const REPEATED: f64 = 2.0;

/// A job, as words of commands.
struct FarmJob {
    name: String,
    fit: Vec<String>,
    /// The command of one chunk, without the frames.
    render: Vec<String>,
    sheet: Vec<String>,
    verify: Vec<String>,
    chunks: Vec<String>,
}

pub(super) fn run(args: &FarmArgs) -> Result<u8> {
    let (path, project) = (args.project.path()?, args.project.load()?);
    prepare_folder(&args.out, path, &project, "--out")?;
    let assets = args::assets(path, args.project.common.allow_external)?;
    let report = Engine::new(assets).check(&project)?;
    let frames = project.frames()?;
    let chunk = match args.chunk {
        Some(0) => return Err(Error::value("--chunk", "0 is out of range; give 1 or more")),
        Some(chunk) => chunk,
        None => {
            let [shared, each] = report.plan.seconds_of_chunk();
            (((LEAST_SECONDS - shared).max(shared / REPEATED) / each.max(1e-6)).ceil() as usize)
                .clamp(1, frames.len())
        }
    };
    let absolute = |path: &Path| std::path::absolute(path).map_err(Error::io("find the folder", path));
    let (project_file, out) = (words(&absolute(path)?)?, absolute(&args.out)?);
    let [bake, pictures] = ["bake", "frames"].map(|name| words(&out.join(name)));
    let (bake, pictures) = (bake?, pictures?);
    let options = args.project.options();
    let command = |parts: &[&str], options: &[String]| -> Vec<String> {
        let parts = std::iter::once(args.program.as_str()).chain(parts.iter().copied());
        parts.map(ToOwned::to_owned).chain(options.iter().cloned()).collect()
    };
    let all = list(&frames);
    let manner = if args.kind == FarmKind::Openjd { "openjd" } else { "plain" };
    let job = FarmJob {
        name: project.name,
        fit: command(&["fit", &project_file, "--bake", &bake, "--progress", manner], &options),
        render: command(
            &["render", &project_file, "--bake", &bake, "--out", &pictures, "--progress", manner],
            &options,
        ),
        sheet: command(&["sheet", &pictures], &[]),
        verify: command(&["verify", &pictures, "--bake", &bake, "--frames", &all], &[]),
        chunks: frames.chunks(chunk).map(list).collect(),
    };
    let files = match args.kind {
        FarmKind::Slurm => slurm(&job, &out)?,
        FarmKind::Openjd => vec![("job.json", format!("{:#}\n", openjd(&job)))],
    };
    for (name, text) in &files {
        write_report(&out, name, text)?;
        Lines::Out.print(&format!("Saved: '{}'", out.join(name).display()))?;
    }
    let next = match args.kind {
        FarmKind::Slurm => format!("sh {}", quoted(&words(&out.join("submit.sh"))?)),
        FarmKind::Openjd => format!("openjd run {}", quoted(&words(&out.join("job.json"))?)),
    };
    Lines::Out
        .print(&format!("{} tasks of up to {chunk} frames; start them by: {next}", job.chunks.len()))?;
    Ok(0)
}

/// A path in words; Slurm and OpenJD take nothing else.
fn words(path: &Path) -> Result<String> {
    let text = path.to_str().filter(|text| !text.contains(['\n', '{']));
    text.map(ToOwned::to_owned)
        .ok_or_else(|| Error::value("--out", format!("'{}' cannot be written into a script", path.display())))
}

/// Frames as a list, runs of them as spans.
pub(super) fn list(frames: &[i32]) -> String {
    let mut spans: Vec<[i32; 2]> = Vec::new();
    for &frame in frames {
        match spans.last_mut() {
            Some([_, last]) if i64::from(*last) + 1 == i64::from(frame) => *last = frame,
            _ => spans.push([frame; 2]),
        }
    }
    let span =
        |[first, last]: &[i32; 2]| if first == last { first.to_string() } else { format!("{first}-{last}") };
    spans.iter().map(span).collect::<Vec<_>>().join(",")
}

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', "'\\''"))
}

fn line(words: &[String]) -> String {
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// The scripts of Slurm: each step starts when the one before it is done. A task whose machine is lost is done again, and
/// keeps the frames that are there.
fn slurm(job: &FarmJob, out: &Path) -> Result<Vec<(&'static str, String)>> {
    let logs: PathBuf = out.join("logs");
    std::fs::create_dir_all(&logs).map_err(Error::io("create the folder", &logs))?;
    let head = |step: &str, log: &str| {
        let log = logs.join(log);
        format!(
            "#!/bin/sh\n#SBATCH --job-name={step}\n#SBATCH --requeue --open-mode=append\n#SBATCH --output=\"{}\"\n",
            log.display()
        )
    };
    let chunks = quoted(&words(&out.join("chunks.txt"))?);
    let render = format!(
        "{}frames=$(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {chunks})\nexec {} --frames \"$frames\"\n",
        head("render", "render.%a.log"),
        line(&job.render)
    );
    let count = job.chunks.len();
    let submit = format!(
        "#!/bin/sh\nset -e\ncd \"$(dirname \"$0\")\"\nfit=$(sbatch --parsable fit.sbatch)\nrender=$(sbatch --parsable --dependency=afterok:$fit --array=1-{count} render.sbatch)\nsbatch \"$@\" --dependency=afterok:$render finish.sbatch\n"
    );
    let finish =
        format!("{}set -e\n{}\nexec {}\n", head("finish", "finish.log"), line(&job.sheet), line(&job.verify));
    Ok(vec![
        ("chunks.txt", job.chunks.join("\n") + "\n"),
        ("fit.sbatch", format!("{}exec {}\n", head("fit", "fit.log"), line(&job.fit))),
        ("render.sbatch", render),
        ("finish.sbatch", finish),
        ("submit.sh", submit),
    ])
}

/// The job template of Open Job Description.
fn openjd(job: &FarmJob) -> Value {
    let script = |words: &[String]| {
        let [command, args @ ..] = words else { return Value::Null };
        json!({ "actions": { "onRun": { "command": command, "args": args } } })
    };
    let after = |step: &str| json!([{ "dependsOn": step }]);
    let with_frames: Vec<String> =
        job.render.iter().cloned().chain(["--frames".into(), "{{Task.Param.Frames}}".into()]).collect();
    json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": job.name,
        "steps": [
            { "name": "Fit", "script": script(&job.fit) },
            {
                "name": "Render",
                "dependencies": after("Fit"),
                "parameterSpace": {
                    "taskParameterDefinitions": [{ "name": "Frames", "type": "STRING", "range": job.chunks }],
                },
                "script": script(&with_frames),
            },
            { "name": "Sheet", "dependencies": after("Render"), "script": script(&job.sheet) },
            { "name": "Verify", "dependencies": after("Sheet"), "script": script(&job.verify) },
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_listed_in_spans_and_words_are_quoted() {
        assert_eq!(list(&[-1, 0, 1, 5, 7, 8]), "-1-1,5,7-8");
        assert_eq!(quoted("it's"), "'it'\\''s'");
    }
}
