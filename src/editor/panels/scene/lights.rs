//! Lights: a kind is one line in [`KINDS`].

use egui::Ui;
use lightloom_core::project::CausticDesc;
use lightloom_core::scene::light::{
    Common, DirectionalLight, LightRole, PointLight, RectangleLight, SphereLight, SpotLight,
};
use lightloom_core::scene::{LightDesc, SceneDesc};
use lightloom_core::setting::format::number;

use super::objects;
use crate::editor::context::EditorContext;
use crate::editor::look::lamp::{enabled_of, name_of, role_of};
use crate::editor::look::object::SceneObject;
use crate::editor::panels::control::Control;
use crate::editor::panels::widgets::{XYZ, menu, remove_button, section};
use crate::editor::unique_name::unique_name;

/// The kinds of light, each with its defaults.
const KINDS: &[fn() -> LightDesc] = &[
    || LightDesc::Point(PointLight::default()),
    || LightDesc::Spot(SpotLight::default()),
    || LightDesc::Directional(DirectionalLight::default()),
    || LightDesc::Rectangle(RectangleLight::default()),
    || LightDesc::Sphere(SphereLight::default()),
];

const KIND: Control =
    Control::new("Kind", LightDesc::KIND).labels(&["Point", "Spot", "Directional", "Rectangle", "Sphere"]);
const NAME: Control = Control::new("Name", Common::NAME);
const ROLE: Control = Control::new("Role", Common::ROLE).labels(&["All", "Caustics", "Background"]);
const ENABLED: Control = Control::new("On", Common::ENABLED);
const WATTS: Control = Control::new("Power", Common::WATTS).log_slider(0.0, 1000.0);
const COLOUR: Control = Control::new("Colour", Common::COLOUR);
const POSITION: Control = Control::new("Position", Common::POSITION);
const TARGET: Control = Control::new("Looks at", Common::TARGET);
const ANGLE: Control = Control::new("Cone", SpotLight::ANGLE).log_slider(0.1, 180.0);
const EDGE: Control = Control::new("Soft edge", SpotLight::SOFT_EDGE);
const IRRADIANCE: Control = Control::new("Irradiance", DirectionalLight::IRRADIANCE).log_slider(0.0, 2000.0);
const DIRECTION: Control = Control::new("Direction", DirectionalLight::DIRECTION);
const DISK: Control = Control::new("Disk", DirectionalLight::ANGLE).slider(0.0, 10.0);
const SIZE: Control = Control::new("Size", RectangleLight::SIZE);
const RADIUS: Control = Control::new("Radius", SphereLight::RADIUS).log_slider(0.001, 10.0);

/// The settings of lights.
#[rustfmt::skip]
pub(super) const CONTROLS: &[Control] = &[
    KIND, NAME, ENABLED, ROLE, WATTS, COLOUR, POSITION, TARGET, ANGLE, EDGE, IRRADIANCE, DIRECTION, DISK, SIZE, RADIUS,
];

/// The light of a new scene.
pub(super) fn first() -> LightDesc {
    LightDesc::Spot(SpotLight::default())
}

fn kind(light: &LightDesc) -> usize {
    match light {
        LightDesc::Point(_) => 0,
        LightDesc::Spot(_) => 1,
        LightDesc::Directional(_) => 2,
        LightDesc::Rectangle(_) => 3,
        LightDesc::Sphere(_) => 4,
    }
}

/// The list of lights, and the values of the selected one. Caustics follow a renamed light.
pub(super) fn show(
    ui: &mut Ui,
    editor: &mut EditorContext,
    scene: &mut SceneDesc,
    caustics: &mut [CausticDesc],
) {
    let names = scene.lights.iter().map(|light| (light.name(), KIND.labels[kind(light)]));
    let names = names.map(|(name, kind)| (name.to_owned(), kind)).collect::<Vec<_>>();
    objects::list(ui, editor, scene, "Light", &names, SceneObject::Light);
    let is_there = |index: &usize| *index < scene.lights.len();
    let chosen = editor.session.focus.object.and_then(SceneObject::light).filter(is_there);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let kinds = KIND.labels.iter().zip(KIND.setting.choices).map(|(label, choice)| (*label, choice.help));
        if let Some(make) = menu(ui, "Add a light", kinds).and_then(|new| KINDS.get(new)) {
            let mut light = make();
            let name = unique_name("light", |name| scene.lights.iter().any(|other| other.name() == name));
            *name_of(&mut light) = name;
            editor.session.focus.object = Some(SceneObject::Light(scene.lights.len()));
            scene.lights.push(light);
        }
        ui.add_enabled_ui(chosen.is_some(), |ui| {
            if remove_button(ui, "Remove this light")
                && let Some(index) = chosen
            {
                scene.lights.remove(index);
                editor.session.focus.object = None;
            }
        });
    });
    let chosen = editor.session.focus.object.and_then(SceneObject::light);
    let Some(index) = chosen.filter(|index| *index < scene.lights.len()) else { return };
    let taken: Vec<String> = scene.lights.iter().map(|light| light.name().to_owned()).collect();
    let light = &mut scene.lights[index];
    section(ui, light.name());
    if let Some((_, words)) = lamp_words(editor) {
        ui.add(egui::Label::new(egui::RichText::new(words).small()).wrap());
    }
    if let Some(name) = NAME.text(ui, index, light.name()).filter(|name| !name.is_empty()) {
        let name = unique_name(&name, |name| taken.iter().any(|other| other == name));
        let of_light = caustics.iter_mut().filter_map(|caustic| caustic.light.as_mut());
        of_light.filter(|other| *other == light.name()).for_each(|other| other.clone_from(&name));
        *name_of(light) = name;
    }
    if let Some(make) = KIND.pick_another(ui, kind(light)).and_then(|new| KINDS.get(new)) {
        *light = changed(light, make());
    }
    ENABLED.toggle(ui, enabled_of(light));
    ROLE.choose(ui, role_of(light), &[LightRole::All, LightRole::Caustics, LightRole::Background]);
    values(ui, light);
}

/// The light `new` with the values of `old` that both kinds have. Angles differ in meaning: a cone is no disk.
fn changed(old: &LightDesc, new: LightDesc) -> LightDesc {
    let (Ok(old), Ok(mut values)) = (serde_json::to_value(old), serde_json::to_value(&new)) else {
        return new;
    };
    if let (Some(old), Some(values)) = (old.as_object(), values.as_object_mut()) {
        for (key, value) in old.iter().filter(|(key, _)| !["type", "angle_deg"].contains(&key.as_str())) {
            if let Some(slot) = values.get_mut(key) {
                slot.clone_from(value);
            }
        }
    }
    serde_json::from_value(values).unwrap_or(new)
}

/// Where the light of the selected lamp goes, in words, after its name: "12 % of its light meets glass, 0.8 W reach the receiver".
pub(in crate::editor) fn lamp_words(editor: &EditorContext) -> Option<(String, String)> {
    let index = editor.session.focus.object?.light()?;
    let scene = editor.document.project().scene.as_ref()?;
    let light = scene.lights.get(index)?;
    let name = light.name().to_owned();
    if light.role() == LightRole::Background {
        return Some((name, "casts no caustics, by its role".into()));
    }
    let light = editor.preview.lamp(index)?;
    let short = |watts: f64| {
        let watts = format!("{watts:.1e}").parse().unwrap_or(watts);
        number(watts, false)
    };
    let met = match light.power {
        Some(power) if power > 0.0 => format!("{} % of its light meets", short(100.0 * light.met / power)),
        Some(_) => return Some((name, "gives no light".into())),
        None => format!("{} W meet", short(light.met)),
    };
    Some((name, format!("{met} glass or mirrors, {} W reach the receiver through them", short(light.landed))))
}

fn values(ui: &mut Ui, light: &mut LightDesc) {
    match light {
        LightDesc::Point(light) => {
            shared(ui, &mut light.watts, &mut light.colour, &mut light.position);
        }
        LightDesc::Spot(light) => {
            shared(ui, &mut light.watts, &mut light.colour, &mut light.position);
            TARGET.numbers(ui, &mut light.target, XYZ);
            ANGLE.number(ui, &mut light.angle_deg);
            EDGE.number(ui, &mut light.soft_edge);
        }
        LightDesc::Directional(light) => {
            IRRADIANCE.number(ui, &mut light.irradiance);
            COLOUR.colour(ui, &mut light.colour);
            DIRECTION.numbers(ui, &mut light.direction, XYZ);
            DISK.number(ui, &mut light.angle_deg);
        }
        LightDesc::Rectangle(light) => {
            shared(ui, &mut light.watts, &mut light.colour, &mut light.position);
            TARGET.numbers(ui, &mut light.target, XYZ);
            SIZE.numbers(ui, &mut light.size, ["width", "height"]);
        }
        LightDesc::Sphere(light) => {
            shared(ui, &mut light.watts, &mut light.colour, &mut light.position);
            RADIUS.number(ui, &mut light.radius);
        }
    }
}

fn shared(ui: &mut Ui, watts: &mut f32, colour: &mut [f32; 3], position: &mut [f32; 3]) {
    WATTS.number(ui, watts);
    COLOUR.colour(ui, colour);
    POSITION.numbers(ui, position, XYZ);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_found_again_under_its_number() {
        assert_eq!(KINDS.len(), KIND.labels.len());
        for (i, make) in KINDS.iter().enumerate() {
            assert_eq!(kind(&make()), i);
        }
    }

    #[test]
    fn another_kind_keeps_name_power_colour_and_place() {
        let position = [1.0, 2.0, 3.0];
        let spot =
            SpotLight { name: "lamp".into(), watts: 3.0, position, angle_deg: 300.0, ..SpotLight::default() };
        let spot = LightDesc::Spot(spot);
        for make in KINDS {
            let light = changed(&spot, make());
            assert!(light.check("").is_ok());
            assert_eq!((light.name(), kind(&light)), ("lamp", kind(&make())));
            if let LightDesc::Sphere(ball) = light {
                assert_eq!((ball.watts, ball.position), (3.0, position));
            }
        }
    }
}
