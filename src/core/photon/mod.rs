//! Caustic photons (Sec. 2): traced from the lights, kept where they land on the receiver after a specular surface.

mod diagnosis;
mod domain;
mod emission_plan;
mod guide_learner;
mod lamp_light;
mod path;
mod thinning;
mod trace;
mod window;

use glam::{Vec2, Vec3};

pub use domain::EmissionGuiding;
pub use lamp_light::LampLight;
pub use path::{FluxBalance, LightPart};
pub use trace::{EmissionGuide, TraceReport, Tracer};

/// Caustic photons in columns of equal length, ordered so that the first n are an even sample of all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Photons {
    /// Positions on the receiver, plane units.
    pub positions: Vec<Vec2>,
    /// RGB flux (W), linear Rec.709. The mean of the channels is equal among the photons of a pass.
    pub flux: Vec<Vec3>,
    /// Index into `Scene::lights`.
    pub light: Vec<u16>,
    /// Index into `Scene::meshes`: the last specular mesh met.
    pub mesh: Vec<u16>,
}

impl Photons {
    /// Their number.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Total flux (W).
    pub fn total_flux(&self) -> glam::DVec3 {
        self.flux.iter().map(|f| f.as_dvec3()).sum()
    }

    fn with_capacity(count: usize) -> Self {
        Self {
            positions: Vec::with_capacity(count),
            flux: Vec::with_capacity(count),
            light: Vec::with_capacity(count),
            mesh: Vec::with_capacity(count),
        }
    }

    fn push(&mut self, position: Vec2, flux: Vec3, light: u16, mesh: u16) {
        self.positions.push(position);
        self.flux.push(flux);
        self.light.push(light);
        self.mesh.push(mesh);
    }
}
