//! The check of a whole project.

use std::collections::BTreeSet;

use super::caustic::{CausticDesc, unknown_name};
use super::shows::Shows;
use super::{Project, VERSION, keyframe};
use crate::export::FrameLayer;
use crate::flow::MotionMethod;
use crate::matching::MatchingMethod;
use crate::{Error, Result};

/// Most caustics of a project.
const MAX_CAUSTICS: usize = 1000;

impl Project {
    /// Checks all values, singly and against each other.
    ///
    /// # Errors
    /// The first invalid value, by its path in the project.
    pub fn check(&self) -> Result<()> {
        // A later file that names no reader can be looked at, and kept as it is.
        let reader = self.minimum_reader.unwrap_or(VERSION);
        if self.lightloom < VERSION || reader > VERSION {
            let what = format!(
                "the file is of version {} and needs a program that reads version {reader}, this one reads up to \
                 {VERSION}; use a newer Lightloom",
                self.lightloom
            );
            return Err(Error::value("lightloom", what));
        }
        Self::SEED.check_at(self.seed, || "seed".to_owned())?;
        if let Some(scene) = &self.scene {
            scene.check("scene")?;
        }
        self.plane.check("plane")?;
        keyframe::check(&self.keys, self.scene.is_some())?;
        check_caustics(self)?;
        self.check_given()?;
        for (i, constraint) in self.constraints.iter().enumerate() {
            let checked = constraint.check(&format!("constraints[{i}]"));
            checked.map_err(|error| error.of(&constraint.called(i)))?;
        }
        self.flow.check("flow")?;
        self.render.check("render")?;
        self.output.check("output")?;
        if self.output.layers.contains(&FrameLayer::Caustics) && self.caustics.is_empty() {
            let what = "\"caustics\" asks for a layer of each named caustic, but the project names none; use \"caustic\"";
            return Err(Error::value("output.layers", what));
        }
        Ok(())
    }

    /// Checks that pairing row by row has point files at every key.
    fn check_given(&self) -> Result<()> {
        let all_points = self.shown().all(|shows| matches!(shows, Shows::Points(_)));
        if self.matching == MatchingMethod::Given && !all_points {
            let what =
                "\"given\" pairs the rows of point files, but a key shows something else; use \"transport\"";
            return Err(Error::value("matching", what));
        }
        if self.matching == MatchingMethod::Given && !self.caustics.is_empty() {
            let what = "\"given\" pairs the rows of point files, which know no caustics; use \"transport\"";
            return Err(Error::value("matching", what));
        }
        if self.matching == MatchingMethod::Given && self.method == MotionMethod::Stylized {
            let what =
                "\"stylized\" finds its own pairs, but matching is \"given\"; use \"flow\" or \"linear\"";
            return Err(Error::value("method", what));
        }
        Ok(())
    }
}

/// Checks the named caustics and the keys' values of them.
fn check_caustics(project: &Project) -> Result<()> {
    let caustics = &project.caustics;
    if caustics.len() > MAX_CAUSTICS {
        let what =
            format!("names {} caustics, at most {MAX_CAUSTICS} can be told apart; join some", caustics.len());
        return Err(Error::Limit { place: "caustics".into(), what });
    }
    if !caustics.is_empty() && project.scene.is_none() {
        return Err(Error::value(
            "caustics",
            "caustics are cast by the lights of a scene and this project has none; add \"scene\"",
        ));
    }
    let mut names = BTreeSet::new();
    for (i, CausticDesc { name, .. }) in caustics.iter().enumerate() {
        let place = || format!("caustics[{i}].name");
        if name.is_empty() {
            return Err(Error::value(place(), "is empty; give the caustic a name"));
        }
        if !names.insert(name.as_str()) {
            return Err(Error::value(place(), format!("'{name}' stands twice; give each its own name")));
        }
    }
    for (i, key) in project.keys.iter().enumerate() {
        for (name, caustic) in &key.caustics {
            let place = format!("keys[{i}].caustics.{name}");
            if !names.contains(name.as_str()) {
                return Err(Error::value(place, unknown_name("caustic", name, names.iter().copied())));
            }
            caustic.check(&place)?;
        }
    }
    Ok(())
}
