//! The diagnosis of a scene without caustics: the first condition that fails, with the objects concerned.

use super::FluxBalance;
use crate::Error;
use crate::scene::Scene;
use crate::scene::light::LightRole;

/// The error that names the broken link of the chain light, caster, receiver.
pub(super) fn no_caustic(scene: &Scene, balances: &[FluxBalance]) -> Error {
    let casters: Vec<&str> = scene
        .meshes()
        .iter()
        .filter(|mesh| mesh.material.is_specular())
        .map(|mesh| mesh.name.as_str())
        .collect();
    let casting =
        scene.lights().iter().zip(balances).filter(|(light, _)| light.role() != LightRole::Background);
    let (lights, balances): (Vec<&str>, Vec<&FluxBalance>) =
        casting.map(|(light, balance)| (light.name(), balance)).unzip();
    let reason = if scene.lights().is_empty() {
        "there is no light; add one".to_owned()
    } else if lights.is_empty() {
        "all lights have the role \"background\"; give one another".to_owned()
    } else if casters.is_empty() {
        "no mesh is of glass or a mirror; give one such a material".to_owned()
    } else {
        let each = lights
            .iter()
            .zip(balances)
            .map(|(name, balance)| format!("light '{name}' {}", broken_link(balance)));
        each.collect::<Vec<_>>().join("; ")
    };
    let list = |names: &[&str]| {
        let shown = names.iter().take(8).map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ");
        match names.len() {
            0 => "none".to_owned(),
            1..=8 => shown,
            more => format!("{shown} and {} more", more - 8),
        }
    };
    let receiver = scene.receiver();
    let [width, height] = (receiver.extent() * receiver.metres_per_plane_unit()).to_array();
    Error::value(
        "scene",
        format!(
            "no caustic falls on the receiver: {reason}. Lights: {}; glass and mirrors: {}; receiver: {width} x {height} m",
            list(&lights),
            list(&casters)
        ),
    )
}

/// The fate of a light's photons, in the order of their path.
fn broken_link(balance: &FluxBalance) -> String {
    let sum = |flux: glam::DVec3| flux.element_sum();
    let met = sum(balance.emitted - balance.direct);
    if sum(balance.emitted) <= 0.0 {
        return "sends nothing towards glass or mirrors (is it on, and turned to them?)".to_owned();
    }
    if met <= 0.0 {
        return "reaches no glass or mirror: something matt stands between, or it shines past them"
            .to_owned();
    }
    let share = |flux| format!("{:.0} %", 100.0 * sum(flux) / met);
    format!(
        "reaches them, but none of that light comes to the lit side of the receiver: {} leaves the scene, {} falls \
         beside the receiver, {} ends on matt things or the receiver's back, {} is absorbed, {} stays in the glass; move \
         or enlarge the receiver, or turn its lit side to the glass",
        share(balance.escaped),
        share(balance.surround),
        share(balance.blocked),
        share(balance.absorbed),
        share(balance.capped)
    )
}
