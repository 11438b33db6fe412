//! The input of the photon renderer.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use lightloom_core::render::{ViewSettings, ViewTransform};

/// The photons of one frame, in the layout of the graphics card.
#[derive(Debug, Default)]
pub struct PhotonColumns {
    /// Plane x, plane y, red, green and blue flux (W) of each photon.
    pub columns: Vec<[f32; 5]>,
    /// Radius of the kernel, plane units.
    pub radius: f32,
}

/// One drawing of photons: their data, transform and view settings.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The photons; the same pointer is uploaded once.
    pub photons: Arc<PhotonColumns>,
    /// Upper left corner of the picture in the window, and its size, pixels.
    pub corner: [f32; 2],
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Pixel of the plane's origin within the picture.
    pub origin: Vec2,
    /// Pixels per plane unit.
    pub scale: f32,
    /// Extent of the plane.
    pub extent: Vec2,
    /// Radiance [W/(sr m^2)] of one watt spread over a square of one plane unit.
    pub radiance: Vec3,
    /// Exposure and view transform.
    pub view: ViewSettings,
}

impl PhotonColumns {
    /// The photons of a moment.
    ///
    /// # Panics
    /// If the columns differ in length.
    pub fn new(positions: &[Vec2], flux: &[Vec3], radius: f32) -> Self {
        assert_eq!(positions.len(), flux.len(), "one flux per photon");
        let row = |(p, f): (&Vec2, &Vec3)| [p.x, p.y, f.x, f.y, f.z];
        Self { columns: positions.iter().zip(flux).map(row).collect(), radius }
    }
}

impl Drawing {
    /// What the shader multiplies watts per pixel by.
    pub(super) fn gain(&self) -> Vec3 {
        // A pixel is 1 / scale plane units wide.
        self.radiance * self.scale.powi(2) * self.view.exposure.exp2()
    }

    pub(super) fn transform(&self) -> ViewTransform {
        self.view.transform
    }
}
