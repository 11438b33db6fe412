//! The objects of the scene drawn over its picture: lamps with name, cone and size, the receiver, the camera, the box of the
//! selected mesh.

use egui::{Align2, Color32, FontId, Painter, Pos2, Shape, Stroke, vec2};
use glam::{Vec2, Vec3};
use lightloom_core::scene::light::{RectangleLight, SphereLight, SpotLight};
use lightloom_core::scene::{CameraDesc, LightDesc, SceneDesc};

use super::bounds::{Loaded, lamp_place, pivot};
use super::lamp;
use super::object::SceneObject;
use super::pick::handles;
use super::viewpoint::Viewpoint;
use crate::editor::theme;

/// Colour of what is not selected.
const QUIET: Color32 = Color32::from_gray(150);
/// Corners of a circle.
const CORNERS: usize = 40;
/// Widest cone that is drawn, degrees.
const WIDEST: f32 = 170.0;

/// The drawing of one scene.
pub struct SceneOverlay<'a> {
    /// Where to.
    pub painter: &'a Painter,
    /// From where it is seen.
    pub view: &'a Viewpoint,
    /// The scene.
    pub scene: &'a SceneDesc,
    /// The last scene that was loaded.
    pub loaded: Option<Loaded<'a>>,
    /// What is selected.
    pub selected: Option<SceneObject>,
    /// What is under the pointer.
    pub over: Option<SceneObject>,
    /// Width over height of the rendered pictures.
    pub aspect: f32,
    /// Whether the camera is looked through.
    pub through_camera: bool,
}

impl SceneOverlay<'_> {
    /// Draws everything.
    pub fn draw(&self) {
        self.receiver();
        for object in [self.over, self.selected].into_iter().flatten() {
            self.mesh_box(object);
        }
        if !self.through_camera {
            self.camera();
        }
        for (index, light) in self.scene.lights.iter().enumerate() {
            self.light(index, light);
        }
        for (object, place) in handles(self.scene, self.selected) {
            self.handle(object, place);
        }
    }

    fn stroke(&self, object: SceneObject, colour: Color32) -> Stroke {
        if self.selected == Some(object) {
            Stroke::new(2.0, theme::ACCENT)
        } else if self.over == Some(object) {
            Stroke::new(1.6, Color32::WHITE)
        } else {
            Stroke::new(1.0, colour)
        }
    }

    fn line(&self, a: Vec3, b: Vec3, stroke: Stroke) {
        self.view.segment(a, b).into_iter().for_each(|line| {
            self.painter.line_segment(line, stroke);
        });
    }

    fn closed(&self, corners: &[Vec3], stroke: Stroke) {
        for (i, corner) in corners.iter().enumerate() {
            self.line(*corner, corners[(i + 1) % corners.len()], stroke);
        }
    }

    fn dashed(&self, a: Vec3, b: Vec3, colour: Color32) {
        if let Some(line) = self.view.segment(a, b) {
            self.painter.extend(Shape::dashed_line(&line, Stroke::new(1.0, colour), 5.0, 4.0));
        }
    }

    fn circle(&self, centre: Vec3, [x, y]: [Vec3; 2], stroke: Stroke) {
        let corner = |i: usize| {
            let around = Vec2::from_angle(std::f32::consts::TAU * i as f32 / CORNERS as f32);
            centre + x * around.x + y * around.y
        };
        self.closed(&(0..CORNERS).map(corner).collect::<Vec<_>>(), stroke);
    }

    fn receiver(&self) {
        let Ok((_, receiver)) = self.scene.camera_and_receiver() else { return };
        let far = receiver.extent();
        let corners = [Vec2::ZERO, far.with_y(0.0), far, far.with_x(0.0)];
        let corners = corners.map(|corner| receiver.world_from_plane(corner));
        self.closed(&corners, self.stroke(SceneObject::Receiver, QUIET));
    }

    /// The box around a mesh.
    fn mesh_box(&self, object: SceneObject) {
        let Some(index) = object.mesh() else { return };
        let Some(corners) = self.loaded.and_then(|loaded| loaded.corners(self.scene, index)) else { return };
        let stroke = self.stroke(object, QUIET);
        for i in 0..8_usize {
            for bit in [1, 2, 4] {
                if i & bit == 0 {
                    self.line(corners[i], corners[i | bit], stroke);
                }
            }
        }
        if self.selected == Some(object) {
            let top = corners.into_iter().filter_map(|corner| self.view.screen(corner));
            if let Some(top) = top.min_by(|a, b| a.y.total_cmp(&b.y)) {
                self.name(
                    top + vec2(0.0, -6.0),
                    &object.name(self.scene),
                    Align2::CENTER_BOTTOM,
                    stroke.color,
                );
            }
        }
    }

    /// The frustum of the camera.
    fn camera(&self) {
        let Ok((camera, _)) = self.scene.camera_and_receiver() else { return };
        let desc: &CameraDesc = &self.scene.camera;
        let stroke = self.stroke(SceneObject::Camera, QUIET);
        let away = Vec3::from(desc.position).distance(desc.look_at.into());
        let corner = |x: f32, y: f32| {
            let ray = camera.ray(x, y, self.aspect);
            ray.origin + ray.direction * (0.22 * away / ray.direction.dot(camera.forward))
        };
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        self.closed(&corners, stroke);
        corners.into_iter().for_each(|corner| self.line(camera.position, corner, stroke));
        // Which side is up.
        let [left, right] = [corner(-0.4, 1.08), corner(0.4, 1.08)];
        self.closed(&[left, right, corner(0.0, 1.4)], stroke);
    }

    fn light(&self, index: usize, light: &LightDesc) {
        let object = SceneObject::Light(index);
        let colour = if light.is_enabled() { theme::WARN } else { QUIET.gamma_multiply(0.6) };
        let stroke = self.stroke(object, colour.gamma_multiply(0.8));
        match light {
            LightDesc::Point(_) => (),
            LightDesc::Spot(spot) => self.cone(spot, stroke),
            LightDesc::Directional(_) => {
                self.line(lamp_place(self.scene, light), self.scene.receiver.centre.into(), stroke);
            }
            LightDesc::Rectangle(panel) => self.panel(panel, stroke),
            LightDesc::Sphere(ball) => self.ball(ball, stroke),
        }
    }

    /// The cone of a spot light, as far as what it looks at.
    fn cone(&self, spot: &SpotLight, stroke: Stroke) {
        let (from, to) = (Vec3::from(spot.position), Vec3::from(spot.target));
        let Some(axis) = (to - from).try_normalize() else { return };
        self.dashed(from, to, stroke.color.gamma_multiply(0.6));
        if spot.angle_deg > WIDEST {
            return;
        }
        let radius = from.distance(to) * (spot.angle_deg.to_radians() / 2.0).tan();
        let (x, y) = axis.any_orthonormal_pair();
        self.circle(to, [x * radius, y * radius], stroke);
        for edge in [x, -x, y, -y] {
            self.line(from, to + edge * radius, stroke);
        }
    }

    fn panel(&self, panel: &RectangleLight, stroke: Stroke) {
        let corners = panel.corners();
        self.closed(&corners, stroke);
        self.dashed(panel.position.into(), panel.target.into(), stroke.color.gamma_multiply(0.6));
    }

    fn ball(&self, ball: &SphereLight, stroke: Stroke) {
        let camera = &self.view.camera;
        self.circle(ball.position.into(), [camera.right * ball.radius, camera.up * ball.radius], stroke);
    }

    /// The handle of a lamp, the camera or a target, with its name.
    fn handle(&self, object: SceneObject, place: Vec3) {
        if object == SceneObject::Camera && self.through_camera {
            return;
        }
        let Some(at) = self.view.screen(place) else { return };
        match object {
            SceneObject::LightTarget(_) | SceneObject::CameraTarget => {
                let stroke = self.stroke(object, theme::ACCENT);
                let owner = match object {
                    SceneObject::LightTarget(index) => SceneObject::Light(index),
                    _ => SceneObject::Camera,
                };
                if let Some(owner) = pivot(self.scene, owner, self.loaded) {
                    self.dashed(owner, place, theme::ACCENT.gamma_multiply(0.7));
                }
                for arm in [vec2(6.0, 6.0), vec2(6.0, -6.0)] {
                    self.painter.line_segment([at - arm, at + arm], stroke);
                }
            }
            SceneObject::Light(index) => {
                let light = &self.scene.lights[index];
                let colour = if light.is_enabled() { theme::WARN } else { QUIET };
                let stroke = Stroke { width: 1.6, ..self.stroke(object, colour) };
                let fill = if light.is_enabled() { colour.gamma_multiply(0.5) } else { Color32::TRANSPARENT };
                self.painter.circle(at, 6.0, fill, stroke);
                let off = if light.is_enabled() { "" } else { " (off)" };
                let name = format!("{}{off}", light.name());
                self.name(at + vec2(10.0, -4.0), &name, Align2::LEFT_CENTER, stroke.color);
            }
            _ => {
                let stroke = Stroke { width: 1.6, ..self.stroke(object, QUIET) };
                self.painter.circle(at, 5.0, stroke.color.gamma_multiply(0.4), stroke);
                self.name(at + vec2(10.0, -4.0), "camera", Align2::LEFT_CENTER, stroke.color);
            }
        }
    }

    /// A name, readable over any picture.
    fn name(&self, at: Pos2, name: &str, align: Align2, colour: Color32) {
        let font = FontId::proportional(12.0);
        self.painter.text(at + vec2(1.0, 1.0), align, name, font.clone(), Color32::from_black_alpha(200));
        self.painter.text(at, align, name, font, colour);
    }
}

/// Whether a light can be turned.
pub fn turns(light: &LightDesc) -> bool {
    lamp::target(light).is_some() || matches!(light, LightDesc::Directional(_))
}
