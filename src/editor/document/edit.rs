//! Edits: all changes of a project. `Edit::apply` is the only place that modifies one.

use std::collections::BTreeSet;

use lightloom_core::Result;
use lightloom_core::constraint::Constraint;
use lightloom_core::flow::{FlowSettings, MotionMethod};
use lightloom_core::matching::MatchingMethod;
use lightloom_core::project::{CausticDesc, KeyFrame, OutputSettings, PlaneSettings, Project};
use lightloom_core::render::RenderSettings;
use lightloom_core::scene::SceneDesc;

/// One change of the project. A panel copies a part, changes the copy, and asks for the whole part.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The project's name.
    Name(String),
    /// The seed of the random numbers.
    Seed(u64),
    /// The scene; none for a bare plane.
    Scene(Option<Box<SceneDesc>>),
    /// The plane of a project without a scene.
    Plane(PlaneSettings),
    /// The named caustics. Key frames drop their entries for removed ones.
    Caustics(Vec<CausticDesc>),
    /// Renames the caustic of index `.0` to `.1`, in the key frames too.
    RenameCaustic(usize, String),
    /// The key frames; sorted by frame.
    Keys(Vec<KeyFrame>),
    /// The matching method.
    Matching(MatchingMethod),
    /// The method of movement.
    Method(MotionMethod),
    /// Adds constraints.
    Add(Vec<Constraint>),
    /// Removes constraints by index.
    Remove(BTreeSet<usize>),
    /// Replaces constraints, by index.
    Change(Vec<(usize, Constraint)>),
    /// Replaces all constraints: joined, split, reordered.
    Constraints(Vec<Constraint>),
    /// The flow settings.
    Flow(FlowSettings),
    /// The render settings.
    Render(RenderSettings),
    /// The output settings.
    Output(OutputSettings),
}

impl Edit {
    /// Name of the edit in the undo menu.
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
    /// An invalid value, with its path in the project.
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
