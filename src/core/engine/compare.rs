//! One project by all methods: the same photons, background and frames, side by side on one sheet.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use super::fingerprint::fingerprint;
use super::meter::Meter;
use super::output::Output;
use super::prepare::Prepared;
use super::render::Rendered;
use super::run_files::RunFiles;
use super::segment_figures::SegmentContinuity;
use super::{Engine, Summary, active_constraints};
use crate::continuity::Continuity;
use crate::export::{ComparisonSheet, MethodRow, Overlay, OverlayLine, evenly_chosen, write_comparison};
use crate::flow::MotionMethod;
use crate::project::Project;
use crate::render::Image;
use crate::{Error, Progress, Result};

/// Frames on the sheet.
const COLUMNS: usize = 6;
/// Width of its pictures in pixels.
const WIDTH: usize = 400;

/// A project by all methods.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The project's name.
    pub project: String,
    /// This program and its version.
    pub software: String,
    /// Seed of the random numbers, the same for all methods.
    pub seed: u64,
    /// Photons of one pass.
    pub photons: usize,
    /// Passes of each method.
    pub passes: usize,
    /// The frames on the sheet.
    pub frames: Vec<i32>,
    /// One entry for each method that was finished, in the order of the sheet.
    pub methods: Vec<Compared>,
    /// Whether the run was stopped before all methods were done as planned.
    pub stopped: bool,
}

/// One method of a comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// Its name in project files.
    pub method: MotionMethod,
    /// Unexplained share of the velocity variance at t = 0.25, 0.5, 0.75, the worst of all segments; absent where nothing
    /// moves.
    pub crossing_index: Option<[f64; 3]>,
    /// Mean squared distance of the pairs over a lower bound of the optimum for the same points, the worst of all
    /// segments; absent where rows are paired as given.
    pub transport_cost_ratio: Option<f64>,
    /// How well its light holds together, the worst of all segments in each figure; absent where nothing moves.
    pub continuity: Option<Continuity>,
    /// Seconds of the matching of the first pass.
    pub match_seconds: f64,
    /// Seconds of the plans; 0 for methods without.
    pub plan_seconds: f64,
    /// Seconds of the fit; 0 for methods without.
    pub fit_seconds: f64,
    /// All numbers of its run.
    pub summary: Summary,
}

impl Engine {
    /// Renders the project by every method into folders of their names below `out`, and one sheet of all, `compare.png`. At
    /// most `frames` frames, evenly chosen from those of the project; all of them where that is absent.
    ///
    /// A run that is stopped still writes the sheet of the finished methods.
    ///
    /// # Errors
    /// As [`Engine::render`]; cancelled before the first method was finished.
    pub fn compare(
        &self,
        project: &Project,
        frames: Option<usize>,
        out: &Path,
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
    ) -> Result<Comparison> {
        let variants = variants(project, frames)?;
        let prepared = variants.iter().map(|(_, variant)| {
            let meter = Meter::default();
            self.prepare(variant, &meter, progress).map(|prepared| (prepared, meter))
        });
        let prepared = prepared.collect::<Result<Vec<_>>>()?;
        for (prepared, _) in &prepared {
            prepared.plan.require_memory()?;
            prepared.plan.require_space(out, 0)?;
        }
        progress.set_stages(stages_ahead(&prepared));
        let mut done: Vec<(MotionMethod, Rendered)> = Vec::new();
        let mut stopped = false;
        for ((method, _), (prepared, meter)) in variants.iter().zip(prepared) {
            let folder = out.join(method.name());
            std::fs::create_dir_all(&folder).map_err(Error::io("create the folder", &folder))?;
            let output = Output::new(&folder, progress, saved);
            let print = fingerprint(&prepared.project, &self.stages.assets, &prepared.mesh_files)?;
            let files = RunFiles::fresh(&folder, print);
            match self.render_prepared(prepared, &meter, &output, files) {
                Err(Error::Cancelled) if !done.is_empty() => stopped = true,
                rendered => {
                    let rendered = rendered?;
                    stopped = rendered.summary.is_stopped();
                    done.push((*method, rendered));
                }
            }
            if stopped {
                break;
            }
        }
        let comparison = Comparison::new(project, &done, stopped);
        let path = out.join("compare.png");
        comparison.write_sheet(&path, &active_constraints::drawn(project), &done)?;
        saved(&path);
        Ok(comparison)
    }
}

/// The project by each method that can do it, with the frames to be rendered.
fn variants(project: &Project, most: Option<usize>) -> Result<Vec<(MotionMethod, Project)>> {
    let frames = project.frames()?;
    let chosen = evenly_chosen(&frames, most.unwrap_or(frames.len()));
    let list = chosen.iter().map(i32::to_string).collect::<Vec<_>>().join(",");
    let variant = |method| {
        let mut variant = Project { method, ..project.clone() };
        variant.output.frames = Some(list.clone());
        (method, variant)
    };
    Ok(project.able_methods().map(variant).collect())
}

/// The stages ahead; camera and background are looked at once.
fn stages_ahead(prepared: &[(Prepared, Meter)]) -> Vec<(&'static str, f64)> {
    let stages = prepared.iter().enumerate().flat_map(|(i, (prepared, _))| {
        let once = |stage: &str| ["visible", "background", "still"].contains(&stage);
        prepared.plan.stages.iter().copied().filter(move |(stage, _)| i == 0 || !once(stage))
    });
    stages.collect()
}

impl Comparison {
    fn new(project: &Project, done: &[(MotionMethod, Rendered)], stopped: bool) -> Self {
        let methods = done.iter().map(|(method, rendered)| Compared::new(*method, rendered, done)).collect();
        let summary = done.first().map(|(_, rendered)| &rendered.summary);
        let shown: Vec<i32> =
            done.first().map_or(Vec::new(), |(_, r)| r.thumbnails.iter().map(|(n, _)| *n).collect());
        Self {
            project: project.name.clone(),
            software: summary.map_or(String::new(), |s| s.software.clone()),
            seed: project.seed,
            photons: summary.map_or(0, |s| s.photons),
            passes: summary.map_or(0, |s| s.passes),
            frames: evenly_chosen(&shown, COLUMNS),
            methods,
            stopped,
        }
    }

    /// Draws all methods on one page.
    fn write_sheet(
        &self,
        path: &Path,
        drawn: &[OverlayLine],
        done: &[(MotionMethod, Rendered)],
    ) -> Result<()> {
        let rows: Vec<MethodRow> =
            self.methods.iter().zip(done).map(|(m, (_, r))| m.row(&self.frames, r)).collect();
        let size = rows.iter().flat_map(|row| &row.pictures).next().map_or([1, 1], |p| [p.width, p.height]);
        let sheet = ComparisonSheet {
            heading: self.project.clone(),
            subheading: format!("{}, seed {}", self.photons_in_words(), self.seed),
            numbers: self.frames.clone(),
            rows,
        };
        let plane = done.first().map(|(_, rendered)| &rendered.plane);
        let pixel_from_plane = |point| plane.and_then(|plane| plane.pixel_from_plane(point, size));
        write_comparison(path, &sheet, Overlay { lines: drawn, pixel_from_plane: &pixel_from_plane })
    }

    fn photons_in_words(&self) -> String {
        let passes = if self.passes == 1 { "pass" } else { "passes" };
        format!("{} {passes} of {} photons", self.passes, self.photons)
    }

    /// Whether a frame holds values that were not finite and had to be replaced.
    pub fn has_bad_frames(&self) -> bool {
        self.methods.iter().any(|method| method.summary.has_bad_frames())
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers, strings and lists: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// As a few lines for people.
    pub fn to_text(&self) -> String {
        let mut text = format!("{}: {} by each method\n", self.project, self.photons_in_words());
        for method in &self.methods {
            let _ = write!(text, "  {:<10}", method.method.name());
            for (name, value) in method.lines() {
                let _ = write!(text, "{name} {value}  ");
            }
            text = text.trim_end().to_owned() + "\n";
        }
        text
    }
}

impl Compared {
    fn new(method: MotionMethod, rendered: &Rendered, all: &[(MotionMethod, Rendered)]) -> Self {
        let summary = rendered.summary.clone();
        let seconds = |stage: &str| {
            summary.stages.iter().find(|cost| cost.stage == stage).map_or(0.0, |cost| cost.seconds)
        };
        // All methods pair the same points, so that what one knows of their optimum holds for all.
        let bound = |segment: usize| {
            all.iter().find_map(|(_, other)| other.fitted.flow.segments.get(segment)?.cost.bound)
        };
        let segments = rendered.fitted.flow.segments.iter().enumerate();
        let ratios = segments.filter_map(|(i, segment)| segment.cost.ratio(bound(i)));
        Self {
            method,
            crossing_index: summary.flow.as_ref().map(|numbers| numbers.flow.crossing_index),
            transport_cost_ratio: ratios.reduce(f64::max),
            continuity: SegmentContinuity::worst(&summary.continuity),
            match_seconds: seconds("match"),
            plan_seconds: seconds("plan"),
            fit_seconds: seconds("fit"),
            summary,
        }
    }

    /// Names and values, for people.
    fn lines(&self) -> Vec<(String, String)> {
        let none = || "none".to_owned();
        let crossing = self.crossing_index.map_or_else(none, |c| c.map(|c| format!("{c:.4}")).join("  "));
        let cost = self.transport_cost_ratio.map_or_else(none, |ratio| format!("{ratio:.3} \u{d7} optimum"));
        let seconds = |s: f64| if s > 0.0 { format!("{s:.1} s") } else { none() };
        let mut lines = vec![("crossing index".into(), crossing)];
        lines.extend(self.continuity.iter().flat_map(continuity_lines));
        lines.extend([
            ("transport cost".into(), cost),
            ("match".into(), seconds(self.match_seconds)),
            ("plan".into(), seconds(self.plan_seconds)),
            ("fit".into(), seconds(self.fit_seconds)),
        ]);
        lines
    }

    /// Its row of the sheet.
    fn row(&self, frames: &[i32], rendered: &Rendered) -> MethodRow {
        let small =
            |picture: &Image| picture.resized(WIDTH, (WIDTH * picture.height).div_ceil(picture.width));
        let picture = |frame: &i32| rendered.thumbnails.iter().find(|(number, _)| number == frame);
        let mut lines = vec![(self.method.describe().to_owned(), String::new())];
        lines.extend(self.lines());
        MethodRow {
            title: self.method.name().to_owned(),
            lines,
            pictures: frames.iter().filter_map(picture).map(|(_, p)| small(p)).collect(),
        }
    }
}

/// The figures of a method in few lines.
fn continuity_lines(of: &Continuity) -> [(String, String); 4] {
    let torn = [of.torn_source, of.torn_target, of.torn_target_late].map(|torn| format!("{torn:.3}"));
    [
        ("cracks".into(), format!("{:.3}", of.cracks)),
        ("torn".into(), torn.join("  ")),
        ("bunch".into(), format!("{:.2}", of.bunch)),
        ("fastest, 99.9 %".into(), format!("{:.2}  {:.2}", of.fastest, of.fastest_999)),
    ]
}
