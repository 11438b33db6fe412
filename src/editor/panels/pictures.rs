//! Example pictures of settings in tooltips, rendered by `assets/generate/tooltips.rs` from one of the examples.

use egui::{Color32, ColorImage, Id, Image, Rect, TextureHandle, TextureOptions, Ui, pos2, vec2};

/// An embedded picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Picture {
    name: &'static str,
    bytes: &'static [u8],
}

/// Pictures of a low, a middle and a high value, with captions.
#[derive(Clone, Copy, Debug)]
pub struct Trio {
    pictures: [Picture; 3],
    captions: [&'static str; 3],
}

/// The picture of this file name.
macro_rules! picture {
    ($name:literal) => {
        Picture {
            name: $name,
            bytes: include_bytes!(concat!("../../../assets/pictures/tooltips/", $name, ".png")),
        }
    };
}

/// gamma 0, 0.5 and 1.
pub(super) const GAMMA: Trio = Trio {
    pictures: [picture!("gamma_low"), picture!("gamma_middle"), picture!("gamma_high")],
    captions: ["0: liquid", "0.5", "1: gradient"],
};
/// alpha 1e-6, 1e-3 and 1.
pub(super) const ALPHA: Trio = Trio {
    pictures: [picture!("alpha_low"), picture!("alpha_middle"), picture!("alpha_high")],
    captions: ["1e-6", "0.001", "1"],
};
/// beta 0, 1 and 10.
pub(super) const BETA: Trio = Trio {
    pictures: [picture!("beta_low"), picture!("beta_middle"), picture!("beta_high")],
    captions: ["0", "1", "10"],
};
/// Turbulence of strength 0, 20 and 60.
pub(super) const TURBULENCE: Trio = Trio {
    pictures: [picture!("turbulence_low"), picture!("turbulence_middle"), picture!("turbulence_high")],
    captions: ["0", "20", "60"],
};
/// rho 0.3, 1 and 3.
pub(super) const RHO: Trio = Trio {
    pictures: [picture!("rho_low"), picture!("rho_middle"), picture!("rho_high")],
    captions: ["0.3: dims", "1", "3: brightens"],
};
/// tau 0.1, 0.4 and 0.85, half way.
pub(super) const TAU: Trio = Trio {
    pictures: [picture!("tau_low"), picture!("tau_middle"), picture!("tau_high")],
    captions: ["0.1: straight", "0.4", "0.85: field"],
};
/// The preset of a liquid.
pub(super) const LIQUID: Picture = picture!("preset_liquid");
/// The preset of a gradient.
pub(super) const GRADIENT: Picture = picture!("preset_gradient");
/// The preset of a smooth field.
pub(super) const SILK: Picture = picture!("preset_silk");
/// The preset of strong turbulence.
pub(super) const STORM: Picture = picture!("preset_storm");

/// Size of a picture of a trio, points.
const SIZE: egui::Vec2 = vec2(104.0, 65.0);

/// Three pictures side by side, with their captions.
pub(super) fn show(ui: &mut Ui, trio: &Trio) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (picture, caption) in trio.pictures.iter().zip(trio.captions) {
            ui.vertical(|ui| {
                if let Some(texture) = texture(ui, picture) {
                    ui.add(Image::new((texture.id(), SIZE)).corner_radius(3).alt_text(caption));
                }
                ui.small(caption);
            });
        }
    });
}

/// Paints a picture into a rectangle.
pub(super) fn paint(ui: &Ui, picture: &Picture, rect: Rect) {
    if let Some(texture) = texture(ui, picture) {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(texture.id(), rect, whole, Color32::WHITE);
    }
}

/// The texture, decoded and uploaded at first use.
fn texture(ui: &Ui, picture: &Picture) -> Option<TextureHandle> {
    let id = Id::unique(("picture", picture.name));
    if let Some(texture) = ui.data(|data| data.get_temp::<TextureHandle>(id)) {
        return Some(texture);
    }
    let texture = ui.ctx().load_texture(picture.name, decode(picture)?, TextureOptions::LINEAR);
    ui.data_mut(|data| data.insert_temp(id, texture.clone()));
    Some(texture)
}

fn decode(picture: &Picture) -> Option<ColorImage> {
    let image = image::load_from_memory(picture.bytes).ok()?.into_rgb8();
    let size = [image.width() as usize, image.height() as usize];
    Some(ColorImage::from_rgb(size, &image))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_small_and_can_be_read() {
        let trios = [GAMMA, ALPHA, BETA, TURBULENCE, RHO, TAU].into_iter().flat_map(|trio| trio.pictures);
        for picture in trios.chain([LIQUID, GRADIENT, SILK, STORM]) {
            assert!(picture.bytes.len() < 12_000, "{}: {} bytes", picture.name, picture.bytes.len());
            assert!(decode(&picture).is_some(), "{}", picture.name);
        }
    }
}
