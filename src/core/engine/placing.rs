//! Where a new picture lies: its light on that of the caustic which becomes it, as large, upright for the camera and in its
//! view. A picture as wide as a large table would be faint, and coarse as the cells of the flow.

use std::path::Path;

use glam::{Vec2, vec2};

use super::key_photons::{KeyPhotons, all_flux, all_positions};
use super::meter::Meter;
use super::walk::Walk;
use super::{Engine, Quality};
use crate::project::{KeyFrame, OutputSettings, Project, Shows};
use crate::render::RenderSettings;
use crate::scene::Receiver;
use crate::scene::camera::Camera;
use crate::targets::{ImageTarget, PictureSampler, Placement};
use crate::{Progress, Result};

/// Share of the light that lies below the box of a caustic along each axis, and above it: its bright part is what counts, so
/// that the picture is no fainter.
const STRAY: f32 = 0.15;
/// The same of a picture, which is to be seen to its tips.
const STRAY_PIXELS: f32 = 0.002;
/// Photons and points of the picture whose boxes are compared.
const QUALITY: Quality = Quality::Preview;
const POINTS: usize = 4_000;
/// The smallest box of light counted as such, plane units: a picture in the focus of a lens could not be seen.
const SMALLEST: f32 = 0.08;
/// Share of the frame's half width and height within which the picture lies.
const SAFE: f32 = 0.88;
/// Share of the soft border that stays free: beyond, little of the light flows.
const FREE: f32 = 0.5;
/// Steps of the search for a place in view, towards the middle of the view and towards a smaller picture.
const STEPS: usize = 24;

/// A box on the plane, around most of some light.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LitBox {
    centre: Vec2,
    size: Vec2,
}

impl Engine {
    /// The placement with which a picture that is new at a key frame, or for one caustic of it, suits the physical caustic
    /// nearest in time: the lit parts of both are as large and lie in the same place, as far as the camera sees it. That of
    /// `target` where no physical caustic is shown.
    ///
    /// # Errors
    /// As a render: the first thing that is wrong with the scene, its files or the picture; cancelled.
    pub fn placement(
        &self,
        project: &Project,
        (key, caustic): (usize, Option<&str>),
        (picture, target): (&Path, &ImageTarget),
        progress: &Progress,
    ) -> Result<Placement> {
        let is_physical = |key: &&KeyFrame| *key.shown_by(caustic) == Shows::PhysicalCaustic;
        let (before, after) = project.keys.split_at(key.min(project.keys.len()));
        let nearest = before.iter().rev().chain(after).find(is_physical);
        let Some(source) = nearest.filter(|_| project.scene.is_some()) else {
            return Ok(target.placement.clone());
        };
        let still = Project {
            keys: vec![source.clone()],
            constraints: Vec::new(),
            output: OutputSettings { frames: None, ..project.output.clone() },
            render: RenderSettings { plate: None, ..project.render.clone() },
            ..project.clone()
        };
        let meter = Meter::quick();
        let whole = self.prepare(&still, &meter, progress)?;
        let applied = QUALITY.apply(&whole.project);
        let sized = whole.limited(QUALITY, QUALITY.photons_of(&applied))?;
        let job = self.job(&sized, &meter, progress)?;
        let walk = Walk::start(&job, 0)?;
        let shares = walk.at();
        let light = match caustic.and_then(|name| sized.sources.grouping().group_named(name)) {
            Some(group) => LitBox::of_light(&shares[group..=group]),
            None => LitBox::of_light(shares),
        };
        let (Some(scene), Some(light)) = (&sized.scene, light) else {
            return Ok(target.placement.clone());
        };
        let view = View { camera: *scene.camera(), receiver: scene.receiver(), aspect: aspect(project) };
        let rotate = if target.placement.rotate == 0.0 { view.upright() } else { target.placement.rotate };
        let unit = Placement { centre: Some([0.0; 2]), width: Some(1.0), rotate };
        let unit = ImageTarget { placement: unit, ..target.clone() };
        let sampler = PictureSampler::load_cancellable(picture, &unit, (sized.extent, "picture"), progress)?;
        let points = sampler.sample(project.seed, 0, POINTS).positions;
        let Some(lit) = LitBox::of(&points, &vec![1.0; points.len()], STRAY_PIXELS) else {
            return Ok(target.placement.clone());
        };
        Ok(view.placed(light, lit, rotate))
    }
}

/// Width over height of the picture.
fn aspect(project: &Project) -> f32 {
    project.render.width as f32 / project.render.height.max(1) as f32
}

impl LitBox {
    fn of_light(groups: &[KeyPhotons]) -> Option<Self> {
        let positions: Vec<Vec2> = all_positions(groups).collect();
        let flux: Vec<f32> = all_flux(groups).map(|flux| flux.element_sum()).collect();
        let extent = Self::of(&positions, &flux, STRAY)?;
        Some(Self { size: extent.size.max(Vec2::splat(SMALLEST)), ..extent })
    }

    /// The box around all but the stray shares of points with weights; none without weight.
    fn of(points: &[Vec2], weights: &[f32], stray: f32) -> Option<Self> {
        let kept = f64::from(stray)..=1.0 - f64::from(stray);
        let total: f64 = weights.iter().map(|&weight| f64::from(weight)).sum();
        let range = |axis: usize| {
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|&a, &b| points[a][axis].total_cmp(&points[b][axis]));
            let mut sum = 0.0;
            let sums = order.iter().map(|&row| {
                sum += f64::from(weights[row]) / total;
                (sum, points[row][axis])
            });
            let within = sums.filter(|(sum, _)| kept.contains(sum));
            within
                .map(|(_, at)| at)
                .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
        };
        let ((left, right), (low, high)) = (range(0), range(1));
        let (lower, upper) = (vec2(left, low), vec2(right, high));
        (lower.cmple(upper).all()).then(|| Self { centre: (lower + upper) / 2.0, size: upper - lower })
    }
}

/// What the camera sees of the receiver.
struct View<'a> {
    camera: Camera,
    receiver: &'a Receiver,
    aspect: f32,
}

impl View<'_> {
    /// The quarter turn that makes a picture on the plane stand upright in the frame, degrees.
    fn upright(&self) -> f32 {
        let up = |scale: f32| self.receiver.plane_from_ray(&self.camera.ray(0.0, scale, self.aspect));
        let (Some(low), Some(high)) = (up(-0.1), up(0.1)) else { return 0.0 };
        let turn = Vec2::Y.angle_to(high - low).to_degrees();
        // A tie, as of a camera in a corner, leaves the picture as it is.
        if turn.abs() <= 50.0 { 0.0 } else { (turn / 90.0).round() * 90.0 }
    }

    /// The picture whose lit part, `lit` at width 1, is as large as `light` and lies there; moved into view, and smaller
    /// where there is no room.
    fn placed(&self, light: LitBox, lit: LitBox, rotate: f32) -> Placement {
        let area = |size: Vec2| (size.x * size.y).max(1e-6);
        let width = (area(light.size) / area(lit.size)).sqrt();
        let extent = self.receiver.extent();
        let middle = self.receiver.plane_from_ray(&self.camera.ray(0.0, 0.0, self.aspect));
        let middle = middle.unwrap_or(extent / 2.0).clamp(Vec2::ZERO, extent);
        let steps = (0..=STEPS).flat_map(|smaller| (0..=STEPS).map(move |moved| (smaller, moved)));
        let share = |step: usize| step as f32 / STEPS as f32;
        let tried = steps.map(|(smaller, moved)| {
            let size = width * 0.2_f32.powf(share(smaller));
            (size, light.centre.lerp(middle, share(moved)), smaller * smaller + moved * moved)
        });
        let fits = tried.filter(|(size, centre, _)| self.holds(*centre, lit.size * *size));
        let best = fits.min_by_key(|(.., cost)| *cost);
        let (size, centre) = best.map_or((width, light.centre), |(size, centre, _)| (size, centre));
        let centre = centre - lit.centre * size;
        let rounded = |value: f32| (value * 1e4).round() / 1e4;
        Placement {
            centre: Some([rounded(centre.x), rounded(centre.y)]),
            width: Some(Placement::WIDTH.clamped(rounded(size).max(1e-3))),
            rotate,
        }
    }

    /// Whether a box on the plane lies within what flows, and within the frame.
    fn holds(&self, centre: Vec2, size: Vec2) -> bool {
        let corners = [vec2(-0.5, -0.5), vec2(0.5, -0.5), vec2(0.5, 0.5), vec2(-0.5, 0.5)];
        corners.map(|corner| centre + corner * size).iter().all(|&corner| {
            let free = self.receiver.flowing_share(corner) >= FREE;
            let seen = self.camera.project(self.receiver.world_from_plane(corner), self.aspect);
            free && seen.is_some_and(|at| at.abs().max_element() <= SAFE)
        })
    }
}
