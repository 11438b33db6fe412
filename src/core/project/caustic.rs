//! Named caustics: which light through which glass, and their values at a key frame.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use schemars::JsonSchema;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::{KeyFrame, Project, Shows};
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};
use crate::{Error, Result};

/// Most caustics of a project.
const MAX_CAUSTICS: usize = 1000;

/// One caustic: the light of one lamp that came over one piece of glass or one mirror last.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct CausticDesc {
    /// Its name; not empty, each name once.
    pub name: String,
    /// Name of the light that casts it; none: any light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light: Option<String>,
    /// Name of the mesh that the light met last; none: any mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<String>,
    /// Whether it flows by a field of its own ([`Self::OWN_FLOW`]).
    #[serde(default)]
    pub own_flow: bool,
}

settings! { CausticDesc {
    /// Name by which the key frames refer to the caustic; each name once.
    NAME = Setting::text("caustics[].name");
    /// Name of the light that casts it. Default: any light.
    LIGHT = Setting::part("caustics[].light");
    /// Name of the glass or mirror that the light met last: that of the mesh, or "mesh/material" for one part of a file of
    /// several materials. Default: any. What fits several caustics belongs to the first in the list.
    MESH = Setting::part("caustics[].mesh");
    /// Whether it flows by a field of its own and never mixes with the others; else all that move share one field.
    OWN_FLOW = Setting::switch("caustics[].own_flow", false);
} }

/// What one caustic does at a key frame, where it differs from the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct CausticKey {
    /// What it shows. Default: what the key shows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shows: Option<Shows>,
    /// Factor on each channel of its light, linear Rec.709.
    pub colour: [f32; 3],
    /// Factor on its light.
    pub brightness: f32,
}

settings! { CausticKey {
    /// What this caustic shows at the key frame. Default: what the key frame shows.
    SHOWS = Setting::part("keys[].caustics.NAME.shows");
    /// Factor on its light at this key frame, linear Rec.709. White leaves the light's own colour.
    COLOUR = Setting::colour("keys[].caustics.NAME.colour", [0.0, 1000.0], &[1.0, 1.0, 1.0]);
    /// Factor on its light at this key frame. 1 keeps the energy.
    BRIGHTNESS = Setting::real("keys[].caustics.NAME.brightness", [0.0, 1000.0], &[1.0]);
} }

impl Default for CausticKey {
    fn default() -> Self {
        Self { shows: None, colour: Self::COLOUR.value(), brightness: Self::BRIGHTNESS.value() }
    }
}

impl CausticKey {
    /// The factor per channel of its light.
    pub fn gain(&self) -> [f32; 3] {
        self.colour.map(|channel| channel * self.brightness)
    }

    fn check(&self, place: &str) -> Result<()> {
        Self::COLOUR.check(self.colour, place)?;
        Self::BRIGHTNESS.check(self.brightness, place)?;
        self.shows.as_ref().map_or(Ok(()), |shows| shows.check(&format!("{place}.shows")))
    }
}

impl KeyFrame {
    /// What a caustic shows at this key; without a name, or not mentioned by the key, what the key shows.
    pub fn shown_by(&self, caustic: Option<&str>) -> &Shows {
        let own = caustic.and_then(|name| self.caustics.get(name)?.shows.as_ref());
        own.unwrap_or(&self.shows)
    }
}

/// Reads a key's values of single caustics; a duplicate name is an error.
pub(super) fn by_name<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<BTreeMap<String, CausticKey>, D::Error> {
    struct ByName;
    impl<'de> Visitor<'de> for ByName {
        type Value = BTreeMap<String, CausticKey>;

        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("caustics by name")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut caustics = BTreeMap::new();
            while let Some((name, caustic)) = map.next_entry::<String, _>()? {
                if caustics.contains_key(&name) {
                    return Err(A::Error::custom(format!("duplicate caustic `{name}`")));
                }
                caustics.insert(name, caustic);
            }
            Ok(caustics)
        }
    }
    deserializer.deserialize_map(ByName)
}

/// Checks the named caustics and the keys' values of them.
pub(super) fn check(project: &Project) -> Result<()> {
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

/// The message on an unknown name.
pub(crate) fn unknown_name<'a>(kind: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<_> = known.map(|name| format!("'{name}'")).collect();
    if known.is_empty() {
        return format!("there is no {kind} '{name}', and no other");
    }
    format!("there is no {kind} '{name}'; there is {}", known.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_without_a_word_on_a_caustic_shows_the_same_by_all() {
        let text = r#"{ "frame": 1, "shows": "physical_caustic",
            "caustics": { "red": { "shows": { "points": { "file": "a.csv" } } }, "blue": { "brightness": 0.5 } } }"#;
        let key: KeyFrame = serde_json::from_str(text).expect("a good key");
        assert!(matches!(key.shown_by(Some("red")), Shows::Points(_)));
        for other in [Some("blue"), Some("green"), None] {
            assert_eq!(*key.shown_by(other), Shows::PhysicalCaustic);
        }
        assert_eq!(key.caustics["blue"].gain(), [0.5; 3]);
    }

    #[test]
    fn a_caustic_that_a_key_names_twice_is_refused() {
        let text = r#"{ "frame": 1, "shows": "physical_caustic", "caustics": { "red": {}, "red": { "brightness": 2 } } }"#;
        let error = serde_json::from_str::<KeyFrame>(text).expect_err("a name twice").to_string();
        assert!(error.contains("duplicate caustic `red`"), "{error}");
    }
}
