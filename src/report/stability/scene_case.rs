//! Small scenes of glass, traced, moved and rendered by the whole engine.

use std::path::Path;

use glam::{DVec3, Vec3};
use serde_json::json;
use tempfile::TempDir;

use super::case::{EnergyOf, Input, Limits, Measured};
use super::flow_case::ITERATIONS;
use super::glass::{GlassObject, Shape};
use crate::effort::Effort;
use lightloom_core::engine::{Engine, Summary};
use lightloom_core::photon::{Photons, TraceReport, Tracer};
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::scene::light::PointLight;
use lightloom_core::scene::material::{Glass, Material};
use lightloom_core::scene::{LightDesc, MeshDesc, Scene, SceneDesc};
use lightloom_core::{Error, Progress, Result};

/// Glass and a lamp over a receiver of a square metre; the caustic becomes a white square in its middle.
#[derive(Clone)]
pub(super) struct SceneCase {
    pub(super) objects: Vec<GlassObject>,
    pub(super) light: LightDesc,
    /// Factor on all lengths.
    pub(super) scale: f32,
    pub(super) photons: usize,
    /// Number of photons by which the flux is compared with that of the scene in metres; none to measure the energy of
    /// the render.
    pub(super) compared: Option<usize>,
}

/// Relative error of the flux: single precision numbers rounded once each when they are scaled, and some hundred times in a
/// texel to which many photons add up, 6e-8 at a time.
pub(super) const FLUX: f64 = 1e-5;

/// The limits of a render.
pub(super) fn limits() -> Limits {
    Limits {
        endpoint_error: Some(0.0),
        solver_error: Some(1e-4),
        iterations: Some(ITERATIONS),
        energy: Some(FLUX),
        ..Limits::FINITE
    }
}

impl SceneCase {
    /// The plain case: a ball of glass of index 1.5 below a point light.
    pub(super) fn new(effort: Effort) -> Self {
        let shape = Shape::Ball { centre: Vec3::new(0.0, 0.2, 0.0), radius: 0.12 };
        Self {
            objects: vec![GlassObject { shape, ior: 1.5, priority: 0 }],
            light: lamp([0.0, 1.0, 0.0]),
            scale: 1.0,
            photons: effort.pick(1000, 30_000),
            compared: None,
        }
    }

    fn trace(&self, count: usize, progress: &Progress) -> Result<(Photons, TraceReport)> {
        let folder = folder()?;
        let root = folder.path().to_owned();
        let (scene, _) = Scene::load(&self.scene(&root)?, &move |path: &str, _: &str| Ok(root.join(path)))?;
        Tracer::new(&scene, 1, progress)?.trace(0, count, progress)
    }

    /// The description of the scene; its mesh files are written into `folder`.
    fn scene(&self, folder: &Path) -> Result<SceneDesc> {
        let long = |v: [f32; 3]| v.map(|x| x * self.scale);
        let mut desc = SceneDesc::default();
        for (i, GlassObject { shape, ior, priority }) in self.objects.iter().enumerate() {
            let file = format!("solid{i}.obj");
            write(folder, &file, shape.obj(self.scale).as_bytes())?;
            desc.meshes.push(MeshDesc {
                material: Some(Material::Glass(Glass { ior: *ior, ..Glass::default() })),
                smooth: matches!(shape, Shape::Ball { .. }),
                enabled: true,
                priority: *priority,
                ..MeshDesc::new(format!("solid {i}"), file)
            });
        }
        let mut light = self.light.clone();
        if let LightDesc::Point(lamp) = &mut light {
            lamp.position = long(lamp.position);
        }
        desc.lights.push(light);
        desc.receiver.size = desc.receiver.size.map(|side| side * self.scale);
        desc.camera.position = long(desc.camera.position);
        Ok(desc)
    }

    fn project(&self, folder: &Path) -> Result<Project> {
        let mut white = Vec::new();
        image::GrayImage::from_pixel(8, 8, image::Luma([255]))
            .write_to(&mut std::io::Cursor::new(&mut white), image::ImageFormat::Png)
            .map_err(|error| Error::Numeric { stage: "report", what: error.to_string() })?;
        write(folder, "white.png", &white)?;
        let keys = json!([
            { "frame": 1, "shows": "physical_caustic" },
            { "frame": 3, "shows": { "image": { "file": "white.png", "placement": { "width": 0.3 } } } },
        ]);
        small(keys, Some(self.scene(folder)?), self.photons)
    }
}

impl Input for SceneCase {
    fn limits(&self) -> Limits {
        limits()
    }

    fn run(&self, progress: &Progress) -> Result<Measured> {
        let folder = folder()?;
        let project = self.project(folder.path())?;
        let measured = render(&project, folder.path(), progress)?;
        let (_, traced) = self.trace(self.photons, progress)?;
        let energy = measured.energy.map(|flux| flux.max(imbalance(&traced)));
        let Some(count) = self.compared else { return Ok(Measured { energy, ..measured }) };
        let landed = |scene: &Self| -> Result<f64> {
            let (photons, _) = scene.trace(count, progress)?;
            Ok(photons.total_flux().element_sum())
        };
        let metres = landed(&Self { scale: 1.0, ..self.clone() })?;
        let energy = Some((landed(self)? / metres - 1.0).abs());
        Ok(Measured { energy, energy_of: EnergyOf::Scale, ..measured })
    }
}

/// A small project of these key frames.
///
/// # Errors
/// A value that the format refuses.
pub(super) fn small(keys: serde_json::Value, scene: Option<SceneDesc>, photons: usize) -> Result<Project> {
    let project = json!({
        "lightloom": 1,
        "scene": scene,
        "keys": keys,
        "flow": { "grid": 24, "steps": 6 },
        "render": { "width": 32, "height": 32, "photons": photons, "passes": 2, "background_samples": 1 },
    });
    Project::parse(project.to_string().as_bytes(), Path::new("project.json"))
}

/// Renders a project whose files are in `folder`.
pub(super) fn render(project: &Project, folder: &Path, progress: &Progress) -> Result<Measured> {
    let out = folder.join("out");
    std::fs::create_dir_all(&out).map_err(Error::io("create the folder", &out))?;
    let assets = AssetFolder::new(&folder.join("project.json"), false)?;
    let summary = Engine::new(assets).render(project, &out, progress, &|_| {})?;
    Ok(measure(&summary))
}

fn measure(summary: &Summary) -> Measured {
    let ratios = [summary.flow.as_ref().map(|flow| flow.flux_ratio), summary.energy.texture_ratio];
    let energy = ratios.into_iter().flatten().map(|ratio| (ratio - 1.0).abs()).reduce(f64::max);
    let mut measured = Measured {
        finite: summary.bad_values.nonfinite_replaced == 0,
        energy,
        energy_of: EnergyOf::Flux,
        ..Measured::default()
    };
    if let Some(numbers) = &summary.flow {
        let flow = &numbers.flow;
        measured.endpoint_error = Some(flow.endpoint_error);
        measured.solver_error = Some(flow.solver_error);
        measured.iterations = Some(flow.solver_iterations);
        measured.condition = Some(flow.solver_condition).filter(|condition| *condition > 0.0);
    }
    measured
}

/// Relative difference of the emitted flux and the sum over all its ends.
fn imbalance(report: &TraceReport) -> f64 {
    let balance = &report.balance;
    let ends: DVec3 = [
        balance.landed,
        balance.surround,
        balance.escaped,
        balance.blocked,
        balance.absorbed,
        balance.capped,
        balance.ended,
        balance.direct,
    ]
    .into_iter()
    .sum();
    ((ends - balance.emitted) / balance.emitted).abs().max_element()
}

/// A point light of one watt.
pub(super) fn lamp(position: [f32; 3]) -> LightDesc {
    LightDesc::Point(PointLight { watts: 1.0, position, ..PointLight::default() })
}

/// A temporary folder.
pub(super) fn folder() -> Result<TempDir> {
    tempfile::tempdir().map_err(Error::io("make a folder in", std::env::temp_dir()))
}

/// Writes a file of a project.
pub(super) fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    let path = folder.join(name);
    std::fs::write(&path, bytes).map_err(Error::io("write", &path))
}
