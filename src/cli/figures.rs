//! `lightloom figures`: how well the light of projects holds together, as a table.

use std::path::Path;

use lightloom_core::continuity::{Row, Table};
use lightloom_core::engine::{Engine, SegmentContinuity};
use lightloom_core::flow::MotionMethod;
use lightloom_core::project::Project;
use lightloom_core::{Error, Progress, Result};

use super::args::FiguresArgs;
use super::job;
use super::progress::Lines;

/// A project as one row, or several, shall have it.
struct Variant {
    engine: Engine,
    project: Project,
    /// What is told of it beside its name.
    differs: String,
}

pub(super) fn run(args: &FiguresArgs) -> Result<u8> {
    args.common.set_threads()?;
    let mut variants = Vec::new();
    for path in &args.paths {
        variants.extend(variants_of(path, args)?);
    }
    let table = job::shown((Lines::Err, args.common.progress), |progress, _| measure(&variants, progress))?;
    let json = || serde_json::to_string_pretty(&table).unwrap_or_default();
    let text = if args.common.json { json() } else { table.to_text() };
    Lines::Out.print(text.trim_end())?;
    Ok(0)
}

/// A project by all methods and values of gamma that were asked for.
fn variants_of(path: &Path, args: &FiguresArgs) -> Result<Vec<Variant>> {
    let project = args.common.load(path)?;
    let engine = Engine::new(args.common.assets(path)?);
    let methods = match &args.method[..] {
        [] => vec![(project.method, String::new())],
        names => names
            .iter()
            .map(|name| parse_method(name).map(|method| (method, format!(", {}", method.name()))))
            .collect::<Result<_>>()?,
    };
    let mut variants = Vec::new();
    for (method, named) in methods {
        // The others heed no gamma: one row is enough.
        let gammas = if method.fits() { &args.gamma[..] } else { &[] };
        let own = (project.flow.gamma, named.clone());
        let of = |&gamma: &f32| (gamma, format!("{named}, gamma {gamma}"));
        let gammas = if gammas.is_empty() { vec![own] } else { gammas.iter().map(of).collect() };
        for (gamma, differs) in gammas {
            let mut project = Project { method, ..project.clone() };
            project.flow.gamma = gamma;
            project.check().map_err(|error| match error {
                Error::Value { place, what } if place == "flow.gamma" => Error::value("--gamma", what),
                other => other,
            })?;
            variants.push(Variant { engine: engine.clone(), project, differs });
        }
    }
    Ok(variants)
}

fn parse_method(name: &str) -> Result<MotionMethod> {
    let known = MotionMethod::ALL.into_iter().find(|method| method.name() == name.trim());
    known.ok_or_else(|| {
        let names = MotionMethod::ALL.map(MotionMethod::name).join(",");
        Error::value("--method", format!("'{name}' is not offered; give one or more of {names}"))
    })
}

fn measure(variants: &[Variant], progress: &Progress) -> Result<Table> {
    progress.set_stages(vec![("measure", 1.0)]);
    progress.begin("measure", variants.len() as u64);
    let mut table = Table::default();
    for Variant { engine, project, differs } in variants {
        let segments = engine.continuity(project, &progress.inner())?;
        let row = |SegmentContinuity { frames: [from, to], all, .. }| Row {
            name: format!("{}{differs}, {from}-{to}", project.name),
            figures: all,
        };
        table.rows.extend(segments.into_iter().map(row));
        progress.advance(1);
    }
    Ok(table)
}
