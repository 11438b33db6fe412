//! The diagnosis of a scene without caustics: the first condition that fails, with the objects concerned.

use glam::{BVec3, Vec3};

use super::FluxBalance;
use super::lamp_light::power;
use crate::Error;
use crate::scene::material::Material;
use crate::scene::{LightDesc, Mesh, Ray, Scene};

/// The error that names the broken link of the chain light, caster, receiver.
pub(super) fn no_caustic(scene: &Scene, balances: &[FluxBalance]) -> Error {
    let casters: Vec<&str> = scene
        .meshes()
        .iter()
        .filter(|mesh| mesh.material.is_specular())
        .map(|mesh| mesh.name.as_str())
        .collect();
    let casting: Vec<(&LightDesc, &FluxBalance)> = casting(scene, balances).map(|(_, of)| of).collect();
    let lights: Vec<&str> = casting.iter().map(|(light, _)| light.name()).collect();
    let reason = if scene.lights().is_empty() {
        "there is no light; add one".to_owned()
    } else if lights.is_empty() {
        "all lights are off or have the role \"background\"; switch one on, or give it another role"
            .to_owned()
    } else if casters.is_empty() {
        format!("no mesh is of glass or a mirror: {}; give one such a material", taken(scene))
    } else {
        let each = casting.iter().map(|of| broken_link(scene, *of));
        each.collect::<Vec<_>>().join("; ")
    };
    let quoted = |names: &[&str]| list(names.iter().map(|name| format!("'{name}'")).collect());
    let receiver = scene.receiver();
    let [width, height] = (receiver.extent() * receiver.metres_per_plane_unit()).to_array();
    Error::value(
        "scene",
        format!(
            "no caustic falls on the receiver: {reason}. Lights: {}; glass and mirrors: {}; receiver: {width} x {height} m",
            quoted(&lights),
            quoted(&casters)
        ),
    )
}

/// The lights that are on and may cast caustics, by index.
fn casting<'a>(
    scene: &'a Scene,
    balances: &'a [FluxBalance],
) -> impl Iterator<Item = (usize, (&'a LightDesc, &'a FluxBalance))> {
    let all = scene.lights().iter().zip(balances).enumerate();
    all.filter(|(_, (light, _))| light.casts_caustics())
}

/// The lights, by index, of which no trial path reached the receiver, each with a note on the reason.
pub(super) fn idle_lights(scene: &Scene, balances: &[FluxBalance]) -> Vec<(usize, String)> {
    let idle = casting(scene, balances).filter(|(_, (_, balance))| balance.landed.element_sum() <= 0.0);
    idle.map(|(index, of)| (index, format!("no caustic of its own: {}", broken_link(scene, of)))).collect()
}

/// The first few of a list, and how many more there are.
fn list(items: Vec<String>) -> String {
    match items.len() {
        0 => "none".to_owned(),
        1..=8 => items.join(", "),
        more => format!("{} and {} more", items[..8].join(", "), more - 8),
    }
}

/// What each mesh was taken for.
fn taken(scene: &Scene) -> String {
    let of = |mesh: &Mesh| match mesh.material {
        Material::Diffuse(_) => format!("'{}' is matt", mesh.name),
        Material::Mirror(_) => format!("'{}' is a mirror", mesh.name),
        Material::Glass(_) => format!("'{}' is glass", mesh.name),
    };
    list(scene.meshes().iter().map(of).collect())
}

/// Why a light reaches no glass or mirror: what it stands around, or what stands between.
fn obstacle(scene: &Scene, light: &LightDesc) -> String {
    let specular = || scene.meshes().iter().filter(|mesh| mesh.material.is_specular());
    if let Some(mesh) = specular().find(|mesh| light.encloses_box(mesh.lower, mesh.upper)) {
        return format!("'{}' stands inside the ball, which shines outward only", mesh.name);
    }
    let is_lit = |mesh: &Mesh| {
        let corner =
            |i: u32| Vec3::select(BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), mesh.upper, mesh.lower);
        let points = (0..8).map(corner).chain([(mesh.lower + mesh.upper) / 2.0]);
        points.into_iter().any(|point| light.illuminate(point, [0.5; 2]).is_some())
    };
    if !specular().any(is_lit) {
        return "it shines past them; turn it to one of them".to_owned();
    }
    let before = |mesh: &Mesh| {
        let offset = (mesh.lower + mesh.upper) / 2.0 - light.position()?;
        let ray = Ray::new(light.position()?, offset.try_normalize()?);
        let met = scene.mesh_of(scene.intersect(&ray).filter(|hit| hit.t < offset.length())?.surface)?;
        let met = &scene.meshes()[usize::from(met)];
        (!met.material.is_specular()).then(|| format!("'{}' stands between it and '{}'", met.name, mesh.name))
    };
    specular()
        .find_map(before)
        .unwrap_or_else(|| "something matt stands between, or it shines past them".to_owned())
}

/// The fate of a light's photons, in the order of their path.
fn broken_link(scene: &Scene, (light, balance): (&LightDesc, &FluxBalance)) -> String {
    format!("light '{}' {}", light.name(), fate(scene, light, balance))
}

fn fate(scene: &Scene, light: &LightDesc, balance: &FluxBalance) -> String {
    let sum = |flux: glam::DVec3| flux.element_sum();
    let met = sum(balance.emitted - balance.direct);
    if !light.is_enabled() || power(light) == Some(0.0) {
        return "sends no light: it is off, or has no watts".to_owned();
    }
    if met <= 0.0 {
        return format!("reaches no glass or mirror: {}", obstacle(scene, light));
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
