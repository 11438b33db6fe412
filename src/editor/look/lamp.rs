//! The values that lights of several kinds have, to be changed.

use lightloom_core::scene::LightDesc;
use lightloom_core::scene::light::LightRole;

/// The name.
pub(in crate::editor) fn name_of(light: &mut LightDesc) -> &mut String {
    match light {
        LightDesc::Point(light) => &mut light.name,
        LightDesc::Spot(light) => &mut light.name,
        LightDesc::Directional(light) => &mut light.name,
        LightDesc::Rectangle(light) => &mut light.name,
        LightDesc::Sphere(light) => &mut light.name,
    }
}

/// What it does in the picture.
pub(in crate::editor) fn role_of(light: &mut LightDesc) -> &mut LightRole {
    match light {
        LightDesc::Point(light) => &mut light.role,
        LightDesc::Spot(light) => &mut light.role,
        LightDesc::Directional(light) => &mut light.role,
        LightDesc::Rectangle(light) => &mut light.role,
        LightDesc::Sphere(light) => &mut light.role,
    }
}

/// Whether it shines.
pub(in crate::editor) fn enabled_of(light: &mut LightDesc) -> &mut bool {
    match light {
        LightDesc::Point(light) => &mut light.enabled,
        LightDesc::Spot(light) => &mut light.enabled,
        LightDesc::Directional(light) => &mut light.enabled,
        LightDesc::Rectangle(light) => &mut light.enabled,
        LightDesc::Sphere(light) => &mut light.enabled,
    }
}

/// Where it stands; none for a directional one.
pub(super) fn position_of(light: &mut LightDesc) -> Option<&mut [f32; 3]> {
    match light {
        LightDesc::Point(light) => Some(&mut light.position),
        LightDesc::Spot(light) => Some(&mut light.position),
        LightDesc::Directional(_) => None,
        LightDesc::Rectangle(light) => Some(&mut light.position),
        LightDesc::Sphere(light) => Some(&mut light.position),
    }
}

/// The point it looks at; none where it looks at none.
pub(super) fn target_of(light: &mut LightDesc) -> Option<&mut [f32; 3]> {
    match light {
        LightDesc::Spot(light) => Some(&mut light.target),
        LightDesc::Rectangle(light) => Some(&mut light.target),
        LightDesc::Point(_) | LightDesc::Directional(_) | LightDesc::Sphere(_) => None,
    }
}

/// The point it looks at; none where it looks at none.
pub(super) fn target(light: &LightDesc) -> Option<glam::Vec3> {
    match light {
        LightDesc::Spot(light) => Some(light.target.into()),
        LightDesc::Rectangle(light) => Some(light.target.into()),
        LightDesc::Point(_) | LightDesc::Directional(_) | LightDesc::Sphere(_) => None,
    }
}
