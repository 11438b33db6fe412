//! All settings of a project.

use super::{CausticDesc, CausticKey, KeyFrame, OutputSettings, PlaneSettings, Project};
use crate::constraint::{Common, DirectedLine, Span, Wall};
use crate::flow::{Fade, FlowSettings, MotionMethod, TurbulenceSettings};
use crate::matching::MatchingMethod;
use crate::render::view::ViewSettings;
use crate::render::{PlateSettings, RenderSettings};
use crate::scene::camera::CameraDesc;
use crate::scene::environment::EnvironmentDesc;
use crate::scene::light::{self, DirectionalLight, LightDesc, RectangleLight, SphereLight, SpotLight};
use crate::scene::material::{Diffuse, Glass, Material, Mirror};
use crate::scene::mesh::{MeshDesc, Transform};
use crate::scene::receiver::ReceiverDesc;
use crate::setting::Setting;
use crate::targets::{ImageTarget, Placement, PointsTarget};

/// All settings of a project, in the order of the README's table.
#[rustfmt::skip]
pub fn settings() -> impl Iterator<Item = &'static Setting> {
    [
        FlowSettings::SETTINGS, Fade::SETTINGS, TurbulenceSettings::SETTINGS, MotionMethod::SETTINGS, MatchingMethod::SETTINGS,
        Common::SETTINGS, DirectedLine::SETTINGS, Wall::SETTINGS, Span::SETTINGS,
        KeyFrame::SETTINGS, ImageTarget::SETTINGS, Placement::SETTINGS, PointsTarget::SETTINGS,
        CausticDesc::SETTINGS, CausticKey::SETTINGS,
        RenderSettings::SETTINGS, PlateSettings::SETTINGS, ViewSettings::SETTINGS, OutputSettings::SETTINGS, Project::SETTINGS,
        MeshDesc::SETTINGS, Transform::SETTINGS, Material::SETTINGS, Diffuse::SETTINGS, Mirror::SETTINGS, Glass::SETTINGS,
        LightDesc::SETTINGS, light::Common::SETTINGS, SpotLight::SETTINGS, DirectionalLight::SETTINGS, RectangleLight::SETTINGS, SphereLight::SETTINGS,
        CameraDesc::SETTINGS, ReceiverDesc::SETTINGS, EnvironmentDesc::SETTINGS, PlaneSettings::SETTINGS,
    ].into_iter().flatten()
}

#[cfg(test)]
mod tests;
