//! The report of `check`: the work ahead, before any of it is done.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;

use super::Engine;
use super::grouping::notes_on_dark;
use super::meter::Meter;
use super::plan::{LeftOut, Plan};
use super::prepare::Prepared;
use crate::note::About;
use crate::photon::Tracer;
use crate::project::{Project, Shows};
use crate::{Note, Progress, Result};

/// Photons by which caustics are found; one with a thousandth of the light is not missed.
const PILOT: usize = 20_000;

/// The work ahead, the parts that are left out and why, and the expected cost.
#[derive(Clone, Debug, Serialize)]
pub struct CheckReport {
    /// The project's name.
    pub project: String,
    /// The source of light at each key frame, in words.
    pub keys: Vec<String>,
    /// The caustics that the scene casts, the brightest first; empty where nothing is traced.
    pub caustics: Vec<CastCaustic>,
    /// The planned work in numbers.
    #[serde(flatten)]
    pub plan: Plan,
    /// Expected seconds of all stages.
    pub seconds: f64,
    /// Notes on the project and its files.
    pub notes: Vec<Note>,
}

/// One caustic of the scene: the light of one lamp whose last specular mesh was one.
#[derive(Clone, Debug, Serialize)]
pub struct CastCaustic {
    /// The lamp.
    pub light: String,
    /// The mesh.
    pub mesh: String,
    /// Its name in the project; none for unnamed ones.
    pub name: Option<String>,
    /// Share of the flux of all caustics, 0..=1.
    pub share: f64,
    /// Flux on the receiver, watts: the mean of the channels, as a lamp's power is that of each channel.
    pub watts: f64,
}

impl Engine {
    /// Reports the work ahead and its cost. Opens every file the project names, and traces a few photons to see which
    /// caustics there are.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn check(&self, project: &Project) -> Result<CheckReport> {
        let (meter, progress) = (Meter::quick(), Progress::new());
        let prepared = self.prepare(project, &meter, &progress)?;
        let job = self.job(&prepared, &meter, &progress)?;
        CheckReport::new(&prepared, job.tracer().as_ref(), &progress)
    }
}

impl CheckReport {
    fn new(prepared: &Prepared, tracer: Option<&Tracer>, progress: &Progress) -> Result<Self> {
        let project = &prepared.project;
        let key = |key: &crate::project::KeyFrame| {
            let mut text = format!("frame {}: {}", key.frame, describe(&key.shows));
            for (name, caustic) in &key.caustics {
                if let Some(shows) = &caustic.shows {
                    let _ = write!(text, "; '{name}' {}", describe(shows));
                }
            }
            text
        };
        let mut notes = prepared.notes.clone();
        let caustics = match tracer {
            Some(tracer) => cast(prepared, tracer, &mut notes, progress)?,
            None => Vec::new(),
        };
        Ok(Self {
            project: project.name.clone(),
            keys: project.keys.iter().map(key).collect(),
            caustics,
            seconds: prepared.plan.seconds(),
            plan: prepared.plan.clone(),
            notes,
        })
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers, strings and lists: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// As lines for people.
    pub fn to_text(&self) -> String {
        let Plan { photons, passes, frames, left_out, stages, memory_mib, scratch_mib, output_mib, .. } =
            &self.plan;
        let mut text = format!("{}: {frames} frames, {passes} passes of {photons} photons\n", self.project);
        for key in &self.keys {
            let _ = writeln!(text, "  {key}");
        }
        for CastCaustic { light, mesh, name, share, watts } in &self.caustics {
            let name = name.as_ref().map_or(String::new(), |name| format!(", named '{name}'"));
            let _ = writeln!(
                text,
                "  caustic of light '{light}' by mesh '{mesh}': {:.1} % of the light, {watts:.3e} W{name}",
                100.0 * share
            );
        }
        for (stage, seconds) in stages {
            let _ = writeln!(text, "  will {stage}: about {seconds:.1} seconds");
        }
        let _ = writeln!(
            text,
            "  in all about {:.0} seconds on two cores, {memory_mib:.0} MiB of memory, {scratch_mib:.0} MiB of scratch file, {output_mib:.0} MiB of frames",
            self.seconds
        );
        for LeftOut { what, why } in left_out {
            let _ = writeln!(text, "  left out: {what} ({why})");
        }
        for note in &self.notes {
            let _ = writeln!(text, "  note: {note}");
        }
        text
    }
}

fn describe(shows: &Shows) -> String {
    match shows {
        Shows::PhysicalCaustic => "the physical caustic".to_owned(),
        Shows::Image(image) => format!("the picture {}", image.file),
        Shows::Points(points) => format!("the points of {}", points.file),
    }
}

/// The caustics that a few photons show, and a note on each named one of which there is none.
fn cast(
    prepared: &Prepared,
    tracer: &Tracer,
    notes: &mut Vec<Note>,
    progress: &Progress,
) -> Result<Vec<CastCaustic>> {
    let Some(scene) = &prepared.scene else { return Ok(Vec::new()) };
    let grouping = prepared.sources.grouping();
    let (photons, _) = tracer.trace(0, PILOT, progress)?;
    let total = photons.total_flux().element_sum() / 3.0;
    let mut watts = BTreeMap::<(u16, u16), f64>::new();
    for ((&light, &mesh), flux) in photons.light.iter().zip(&photons.mesh).zip(&photons.flux) {
        *watts.entry((light, mesh)).or_default() += flux.as_dvec3().element_sum() / 3.0;
    }
    let caustic = |((light, mesh), watts): ((u16, u16), f64)| CastCaustic {
        light: scene.lights()[usize::from(light)].name().to_owned(),
        mesh: scene.meshes()[usize::from(mesh)].name.clone(),
        name: grouping.name(grouping.group_of(light, mesh)).map(str::to_owned),
        share: watts / total,
        watts,
    };
    let mut caustics: Vec<_> = watts.into_iter().map(caustic).collect();
    caustics.sort_by(|a, b| b.watts.total_cmp(&a.watts));
    let shares = grouping.split(photons);
    let lights = shares.iter().map(|share| (share.positions.len(), share.total));
    notes.extend(notes_on_dark(&grouping.lights(lights)));
    let lit = |light: usize| caustics.iter().any(|caustic| caustic.light == scene.lights()[light].name());
    let idle = tracer.idle_lights().into_iter().filter(|(light, _)| !lit(*light));
    notes.extend(idle.map(|(light, text)| About::Light(light).note(text)));
    Ok(caustics)
}
