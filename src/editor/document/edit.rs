//! All that can be changed in a project. `Edit::apply` is the only place that writes one.

use std::collections::BTreeSet;

use lightloom_core::Result;
use lightloom_core::constraint::Constraint;
use lightloom_core::flow::{FlowSettings, Movement};
use lightloom_core::matching::Method;
use lightloom_core::project::{CausticDesc, KeyFrame, OutputSettings, PlaneSettings, Project};
use lightloom_core::render::RenderSettings;
use lightloom_core::scene::SceneDesc;

/// One change of the project. A panel takes a copy of a part, changes it, and asks for the whole part.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The project's name.
    Name(String),
    /// The seed of all random numbers.
    Seed(u64),
    /// Glass, lights, camera, receiver; none for a bare plane.
    Scene(Option<Box<SceneDesc>>),
    /// The plane of a project without scene.
    Plane(PlaneSettings),
    /// The named caustics. Keys forget what they say of one that is gone.
    Caustics(Vec<CausticDesc>),
    /// Gives caustic number `.0` the name `.1`, also in the keys.
    RenameCaustic(usize, String),
    /// The key frames; brought into rising order.
    Keys(Vec<KeyFrame>),
    /// How points are paired.
    Matching(Method),
    /// How the photons get from key to key.
    Method(Movement),
    /// Adds what was drawn.
    Add(Vec<Constraint>),
    /// Removes constraints by index.
    Remove(BTreeSet<usize>),
    /// Puts others in place of constraints, by index.
    Change(Vec<(usize, Constraint)>),
    /// All constraints anew: joined, split, reordered.
    Constraints(Vec<Constraint>),
    /// The vector field and the way along it.
    Flow(FlowSettings),
    /// Photons, passes, picture.
    Render(RenderSettings),
    /// What is written.
    Output(OutputSettings),
}

impl Edit {
    /// What undo calls it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Name(_) => "name",
            Self::Seed(_) => "seed",
            Self::Scene(_) => "scene",
            Self::Plane(_) => "plane",
            Self::Caustics(_) | Self::RenameCaustic(..) => "caustics",
            Self::Keys(_) => "key frames",
            Self::Matching(_) => "matching",
            Self::Method(_) => "method",
            Self::Add(_) => "drawing",
            Self::Remove(_) => "deletion",
            Self::Change(_) | Self::Constraints(_) => "constraints",
            Self::Flow(_) => "flow",
            Self::Render(_) => "render settings",
            Self::Output(_) => "output settings",
        }
    }

    /// The project after this change.
    ///
    /// # Errors
    /// A value that cannot be used, by its path in the project.
    pub(super) fn apply(self, project: &Project) -> Result<Project> {
        let mut project = project.clone();
        self.write(&mut project);
        project.check()?;
        Ok(project)
    }

    fn write(self, project: &mut Project) {
        match self {
            Self::Name(name) => project.name = name,
            Self::Seed(seed) => project.seed = seed,
            Self::Scene(scene) => project.scene = scene.map(|scene| *scene),
            Self::Plane(plane) => project.plane = plane,
            Self::Caustics(caustics) => {
                project.caustics = caustics;
                let known: BTreeSet<&str> = project.caustics.iter().map(|c| c.name.as_str()).collect();
                for key in &mut project.keys {
                    key.caustics.retain(|name, _| known.contains(name.as_str()));
                }
            }
            Self::RenameCaustic(index, name) => rename(project, index, name),
            Self::Keys(mut keys) => {
                keys.sort_by_key(|key| key.frame);
                project.keys = keys;
            }
            Self::Matching(method) => project.matching = method,
            Self::Method(method) => project.method = method,
            Self::Add(constraints) => project.constraints.extend(constraints),
            Self::Remove(gone) => {
                let mut index = 0..;
                project.constraints.retain(|_| index.next().is_none_or(|i| !gone.contains(&i)));
            }
            Self::Change(changes) => {
                for (index, constraint) in changes {
                    if let Some(old) = project.constraints.get_mut(index) {
                        *old = constraint;
                    }
                }
            }
            Self::Constraints(constraints) => project.constraints = constraints,
            Self::Flow(flow) => project.flow = flow,
            Self::Render(render) => project.render = render,
            Self::Output(output) => project.output = output,
        }
    }
}

fn rename(project: &mut Project, index: usize, name: String) {
    let taken = project.caustics.iter().any(|caustic| caustic.name == name);
    let Some(caustic) = project.caustics.get_mut(index).filter(|_| !taken) else { return };
    let old = std::mem::replace(&mut caustic.name, name.clone());
    for key in &mut project.keys {
        if let Some(own) = key.caustics.remove(&old) {
            key.caustics.insert(name.clone(), own);
        }
    }
}
