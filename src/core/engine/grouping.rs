//! Groups of photons: one for each named caustic, and one for the others.

use std::collections::BTreeMap;

use glam::{DVec3, Vec2, Vec3};
use serde::Serialize;

use crate::flow::flux;
use crate::note::About;
use crate::photon::Photons;
use crate::project::{CausticDesc, Project, unknown_name};
use crate::scene::Scene;
use crate::{Error, Note, Result};

/// The groups of a project: its named caustics in their order, then the rest. One group where none is named.
#[derive(Clone)]
pub(super) struct Grouping {
    caustics: Vec<CausticDesc>,
    /// The members of each caustic.
    members: Vec<Members>,
}

/// The lights and meshes of the scene that belong to a caustic, by index.
#[derive(Clone)]
struct Members {
    lights: Vec<bool>,
    meshes: Vec<bool>,
}

/// The light of one caustic on the receiver.
#[derive(Clone, Debug, PartialEq, Serialize, serde::Deserialize)]
pub struct CausticFlux {
    /// Its name in the project; none for the rest.
    pub name: Option<String>,
    /// Photons of the first pass.
    pub photons: usize,
    /// Flux on the receiver, watts: the mean of the channels, as a lamp's power is that of each channel.
    pub watts: f64,
}

/// The traced photons of one group.
#[derive(Default)]
pub(super) struct Share {
    /// Plane coordinates.
    pub(super) positions: Vec<Vec2>,
    /// RGB flux in watts.
    pub(super) flux: Vec<Vec3>,
    /// Sum of the flux.
    pub(super) total: DVec3,
}

impl Grouping {
    /// # Errors
    /// A caustic of a light or mesh that the scene does not have, with the names of those it has.
    pub(super) fn resolve(project: &Project, scene: Option<&Scene>) -> Result<Self> {
        let caustics = project.caustics.clone();
        let Some(scene) = scene.filter(|_| !caustics.is_empty()) else {
            return Ok(Self { caustics: Vec::new(), members: Vec::new() });
        };
        let lights: Vec<&str> = scene.lights().iter().map(|light| light.name()).collect();
        let meshes: Vec<&str> = scene.meshes().iter().map(|mesh| mesh.name.as_str()).collect();
        let mut members = Vec::new();
        for (i, caustic) in caustics.iter().enumerate() {
            let of = Members {
                lights: lights.iter().map(|light| of_light(caustic, light)).collect(),
                meshes: meshes.iter().map(|mesh| of_mesh(caustic, mesh)).collect(),
            };
            require("light", i, caustic.light.as_deref(), &lights, &of.lights)?;
            if !caustic.mesh.as_deref().is_some_and(|mesh| is_off(project, mesh)) {
                require("mesh", i, caustic.mesh.as_deref(), &meshes, &of.meshes)?;
            }
            members.push(of);
        }
        Ok(Self { caustics, members })
    }

    /// The number of groups.
    pub(super) fn count(&self) -> usize {
        self.caustics.len() + 1
    }

    /// The name of a group; none for the rest.
    pub(super) fn name(&self, group: usize) -> Option<&str> {
        self.caustics.get(group).map(|caustic| caustic.name.as_str())
    }

    /// The group of the caustic of this name.
    pub(super) fn group_named(&self, name: &str) -> Option<usize> {
        self.caustics.iter().position(|caustic| caustic.name == name)
    }

    /// Whether a group flows by itself.
    pub(super) fn own_flow(&self, group: usize) -> bool {
        self.caustics.get(group).is_some_and(|caustic| caustic.own_flow)
    }

    /// The group of the photons of a light, by index, that met a mesh last, by index: the first caustic that takes both.
    pub(super) fn group_of(&self, light: u16, mesh: u16) -> usize {
        let takes = |of: &Members| of.lights[usize::from(light)] && of.meshes[usize::from(mesh)];
        self.members.iter().position(takes).unwrap_or(self.members.len())
    }

    /// The photons of each group, in their order.
    pub(super) fn split(&self, photons: Photons) -> Vec<Share> {
        if self.count() == 1 {
            let total = photons.total_flux();
            return vec![Share { positions: photons.positions, flux: photons.flux, total }];
        }
        let mut shares: Vec<Share> = (0..self.count()).map(|_| Share::default()).collect();
        for row in 0..photons.len() {
            let into = &mut shares[self.group_of(photons.light[row], photons.mesh[row])];
            into.positions.push(photons.positions[row]);
            into.flux.push(photons.flux[row]);
        }
        shares.iter_mut().for_each(|share| share.total = flux::total(&share.flux));
        shares
    }

    /// The flux of each group, from its number of photons and their flux; empty where no caustic is named.
    pub(super) fn lights(&self, groups: impl Iterator<Item = (usize, DVec3)>) -> Vec<CausticFlux> {
        if self.count() == 1 {
            return Vec::new();
        }
        let light = |(group, (photons, flux)): (usize, (usize, DVec3))| CausticFlux {
            name: self.name(group).map(str::to_owned),
            photons,
            watts: flux.element_sum() / 3.0,
        };
        groups.enumerate().map(light).collect()
    }

    /// Factor on the light of each group at key `key`.
    pub(super) fn gains(&self, project: &Project, key: usize) -> Vec<Vec3> {
        let of = |name: &str| project.keys[key].caustics.get(name).map_or(Vec3::ONE, |c| c.gain().into());
        (0..self.count()).map(|group| self.name(group).map_or(Vec3::ONE, of)).collect()
    }
}

/// Whether a name is that of a mesh that is switched off, or of a part of one: its caustic has no light, and is no mistake.
fn is_off(project: &Project, name: &str) -> bool {
    let mut off = project.scene.iter().flat_map(|scene| &scene.meshes).filter(|mesh| !mesh.enabled);
    off.any(|mesh| name.strip_prefix(&mesh.name).is_some_and(|rest| rest.is_empty() || rest.starts_with('/')))
}

/// Checks that caustic `i` has any light or mesh of the name it asks for.
fn require(kind: &str, i: usize, name: Option<&str>, known: &[&str], takes: &[bool]) -> Result<()> {
    match name {
        Some(name) if !takes.contains(&true) => Err(Error::value(
            format!("caustics[{i}].{kind}"),
            unknown_name(kind, name, known.iter().copied()),
        )),
        _ => Ok(()),
    }
}

fn of_light(caustic: &CausticDesc, light: &str) -> bool {
    caustic.light.as_deref().is_none_or(|name| name == light)
}

/// A file that was split by material bears the mesh's name before the slash.
fn of_mesh(caustic: &CausticDesc, mesh: &str) -> bool {
    let part_of = |name: &str| mesh.strip_prefix(name).is_some_and(|rest| rest.starts_with('/'));
    caustic.mesh.as_deref().is_none_or(|name| name == mesh || part_of(name))
}

/// Notes on names that several lights or meshes of a scene share.
pub(super) fn notes_on_names(scene: &Scene) -> Vec<Note> {
    let lights = scene.lights().iter().enumerate().map(|(i, light)| (light.name(), About::Light(i)));
    let meshes = scene.meshes().iter().map(|mesh| (mesh.name.as_str(), About::Mesh(mesh.desc)));
    let mut notes = notes_on_twins("lights", lights);
    notes.extend(notes_on_twins("meshes", meshes));
    notes
}

fn notes_on_twins<'a>(kind: &str, named: impl Iterator<Item = (&'a str, About)>) -> Vec<Note> {
    let mut by_name = BTreeMap::<&str, Vec<About>>::new();
    named.for_each(|(name, about)| by_name.entry(name).or_default().push(about));
    let twice = by_name.into_iter().filter(|(_, all)| all.len() > 1);
    let note = |(name, mut all): (&str, Vec<About>)| {
        let text = format!(
            "{} {kind} are called '{name}' and count as one; give each its own name to tell their caustics apart",
            all.len()
        );
        all.swap_remove(0).note(text)
    };
    twice.map(note).collect()
}

/// Notes on named caustics without a photon.
pub(super) fn notes_on_dark(caustics: &[CausticFlux]) -> Vec<Note> {
    let dark = caustics.iter().filter(|caustic| caustic.photons == 0);
    let note = |name: &String| {
        About::Caustic(name.clone()).note(format!(
            "caustic '{name}' has no photons: none of its light falls on the receiver by way of its mesh"
        ))
    };
    dark.filter_map(|caustic| caustic.name.as_ref()).map(note).collect()
}
