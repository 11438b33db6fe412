//! What the light shows at a key frame.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting};
use crate::targets::{ImageTarget, PointsTarget};

/// What the light shows at a key frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(Self::CHOICE))]
pub enum Shows {
    /// The caustic that the scene casts.
    PhysicalCaustic,
    /// A picture.
    Image(ImageTarget),
    /// A file of points.
    Points(PointsTarget),
}

impl Shows {
    /// The choice, without help: the key frame adds its own.
    pub(super) const CHOICE: Setting = Setting::choice(
        "keys[].shows",
        &[
            Choice { value: "physical_caustic", help: "what the scene's glass and mirrors really cast" },
            Choice { value: "image", help: "a picture: its bright parts attract the light" },
            Choice { value: "points", help: "a file of points, one for each photon or fewer" },
            Choice { value: "", help: "what the key frame shows by all light" },
        ],
    )
    .required();

    /// Refuses what is out of range, naming its place under `place`.
    pub(super) fn check(&self, place: &str) -> Result<()> {
        match self {
            Self::PhysicalCaustic => Ok(()),
            Self::Image(image) => image.check(&format!("{place}.image")),
            Self::Points(points) => points.check(&format!("{place}.points")),
        }
    }
}
