//! Named caustics: which light through which glass, and their values at a key frame.

use std::collections::BTreeMap;
use std::fmt;

use schemars::JsonSchema;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::shows::Shows;
use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// One caustic: the light of one lamp that came over one piece of glass or one mirror last.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
    #[serde(default = "own_flow")]
    pub own_flow: bool,
}

fn own_flow() -> bool {
    CausticDesc::OWN_FLOW.is_on()
}

impl Default for CausticDesc {
    fn default() -> Self {
        Self { name: String::new(), light: None, mesh: None, own_flow: own_flow() }
    }
}

settings! { CausticDesc {
    /// Name by which the key frames refer to the caustic; each name once.
    NAME = Setting::text("caustics[].name");
    /// Name of the light that casts it. Default: any light.
    LIGHT = Setting::part("caustics[].light");
    /// Name of the glass or mirror that the light met last: that of the mesh, or "mesh/material" for one part of a file of
    /// several materials. Default: any. What fits several caustics belongs to the first in the list.
    MESH = Setting::part("caustics[].mesh");
    /// Whether it flows by a field of its own; else it shares one with all others that do, which tears where they cross.
    OWN_FLOW = Setting::switch("caustics[].own_flow", true);
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

    /// Refuses values out of range, naming their place under `place`.
    pub(super) fn check(&self, place: &str) -> Result<()> {
        Self::COLOUR.check(self.colour, place)?;
        Self::BRIGHTNESS.check(self.brightness, place)?;
        self.shows.as_ref().map_or(Ok(()), |shows| shows.check(&format!("{place}.shows")))
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

/// The message on an unknown name.
pub(crate) fn unknown_name<'a>(kind: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<_> = known.map(|name| format!("'{name}'")).collect();
    if known.is_empty() {
        return format!("there is no {kind} '{name}', and no other");
    }
    format!("there is no {kind} '{name}'; there is {}", known.join(", "))
}
