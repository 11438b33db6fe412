//! The layers of EXR files. A new layer is a variant here and a part in `exr`; the plane has files of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The layers that a frame can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FrameLayer {
    /// Background + caustic, with the coverage of the background as alpha: `R`, `G`, `B`, `A`.
    Beauty,
    /// All caustics, to be added: `caustic.R` and so on.
    Caustic,
    /// One layer for each named caustic and one for the rest; their sum is the caustic: `caustic_NAME.R` and so on.
    Caustics,
    /// The picture without caustics, with its coverage: `background.R`, ..., `background.A`.
    Background,
    /// Depth of the first surface along the view (m): `depth.Z`. A project without scene has none.
    Depth,
    /// The irradiance of the caustics on the receiver, without its albedo (W/m²): a texture for any renderer, in files of its
    /// own, `NAME_plane.0001.exr`, with `R`, `G`, `B` in 32 bits.
    Plane,
}

impl FrameLayer {
    /// All layers, in the order of the parts of a file.
    pub const ALL: [Self; 6] =
        [Self::Beauty, Self::Caustic, Self::Caustics, Self::Background, Self::Depth, Self::Plane];

    /// The layers of a project that names none.
    pub const DEFAULT: [Self; 4] = [Self::Beauty, Self::Caustic, Self::Background, Self::Depth];

    /// The name of the layer in settings and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Beauty => "beauty",
            Self::Caustic => "caustic",
            Self::Caustics => "caustics",
            Self::Background => "background",
            Self::Depth => "depth",
            Self::Plane => "plane",
        }
    }

    /// What the layer holds, for people.
    pub fn help(self) -> &'static str {
        match self {
            Self::Beauty => "background and caustic together, with alpha",
            Self::Caustic => "all caustics, to be added in compositing; alone, no background is traced",
            Self::Caustics => "one layer for each named caustic, and one for the rest",
            Self::Background => "the picture without caustics, with alpha",
            Self::Depth => "distance of the first surface along the view, in metres",
            Self::Plane => "light on the receiver in W/m², in files of its own: a texture for any renderer",
        }
    }

    /// Whether it is a part of the frames through the camera.
    pub fn is_in_frame(self) -> bool {
        self != Self::Plane
    }

    /// Whether the picture without caustics is part of the layer.
    pub fn shows_background(self) -> bool {
        matches!(self, Self::Beauty | Self::Background)
    }
}

/// The names of the layers of single caustics, from the caustics' names; the last is that of the rest. Letters, digits and
/// underscores only, each name once: compositing programs part names at dots and refuse spaces.
pub fn caustic_layer_names<'a>(caustics: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in caustics.chain(["rest"]) {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let plain = format!("caustic_{}", name.chars().map(plain).collect::<String>());
        let mut unique = plain.clone();
        let mut number = 2;
        while names.contains(&unique) {
            unique = format!("{plain}_{number}");
            number += 1;
        }
        names.push(unique);
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layer_names_are_plain_and_each_stands_once() {
        let names = caustic_layer_names(["Blüte 1", "a.b", "a b", "rest"].into_iter());
        assert_eq!(
            names,
            ["caustic_Bl_te_1", "caustic_a_b", "caustic_a_b_2", "caustic_rest", "caustic_rest_2"]
        );
    }
}
