//! The picture of the receiver alone, seen straight on: one pixel per texel, without the margin.

use glam::{Vec2, Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::image::Image;
use super::texture::ReceiverTexture;
use crate::scene::{Receiver, material::Material};

/// The reflection of a matt plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneMaterial {
    /// BRDF: albedo / pi [1/sr].
    pub brdf: Vec3,
    /// Metres per plane unit.
    pub metres: f32,
}

impl PlaneMaterial {
    /// Perfectly white, one metre per plane unit: the plane of a project without scene.
    pub const WHITE: Self = Self { brdf: Vec3::splat(1.0 / std::f32::consts::PI), metres: 1.0 };

    /// In place of the reflected light the light itself: irradiance [W/m^2], with `metres` per plane unit.
    pub fn irradiance(metres: f32) -> Self {
        Self { brdf: Vec3::ONE, metres }
    }

    /// The material of a receiver.
    pub fn of(receiver: &Receiver) -> Self {
        let albedo = match receiver.material() {
            Material::Diffuse(diffuse) => Vec3::from(diffuse.albedo),
            Material::Glass(_) | Material::Mirror(_) => Vec3::ZERO,
        };
        Self { brdf: albedo / std::f32::consts::PI, metres: receiver.metres_per_plane_unit() }
    }

    /// Radiance [W/(sr m^2)] per watt in a texel of side `texel`, plane units.
    pub fn radiance_per_watt(&self, texel: f32) -> Vec3 {
        self.brdf / (texel * self.metres).powi(2)
    }
}

/// The radiance of the texels whose centre lies on the plane of `extent`; the top row is the upper edge of the plane.
pub fn plane_image(texture: &ReceiverTexture, extent: Vec2, material: PlaneMaterial) -> Image {
    let layout = texture.layout();
    let border = (-layout.origin / layout.texel).round().as_uvec2();
    let size = (extent / layout.texel).round().as_uvec2();
    let [width, height] = [size.x as usize, size.y as usize].map(|n| n.max(1));
    let [width, height] =
        [width.min(layout.columns - border.x as usize), height.min(layout.rows - border.y as usize)];
    let gain = material.radiance_per_watt(layout.texel);
    let mut image = Image::new(width, height);
    image.pixels.par_chunks_mut(width).enumerate().for_each(|(row, pixels)| {
        let first = (border.y as usize + height - 1 - row) * layout.columns + border.x as usize;
        for (pixel, texel) in pixels.iter_mut().zip(&texture.texels()[first..first + width]) {
            *pixel = texel.xyz() * gain;
        }
    });
    image
}

#[cfg(test)]
mod tests {
    use glam::vec2;

    use super::*;
    use crate::render::TextureLayout;
    use crate::render::splat::Splatter;

    #[test]
    fn light_stands_upright_in_the_picture_and_keeps_its_flux() {
        let extent = vec2(1.0, 0.5);
        let mut texture = ReceiverTexture::new(TextureLayout::new(extent, 64, 0.1));
        // One watt near the upper left corner of the plane.
        Splatter::default().splat(&[vec2(0.25, 0.4)], &[Vec3::ONE], &mut texture);
        let picture = plane_image(&texture, extent, PlaneMaterial::WHITE);
        assert_eq!((picture.width, picture.height), (64, 32));
        let brightest = picture.pixels.iter().enumerate().max_by(|a, b| a.1.x.total_cmp(&b.1.x));
        let (x, y) = brightest.map_or((0, 0), |(i, _)| (i % 64, i / 64));
        assert!((15..=16).contains(&x) && (5..=7).contains(&y), "seen at ({x}, {y})");
        // Radiance times pi times the area of a pixel is the flux, to the rounding of f32.
        let flux: f32 =
            picture.pixels.iter().map(|p| p.x).sum::<f32>() * std::f32::consts::PI / 64.0_f32.powi(2);
        assert!((flux - 1.0).abs() < 1e-5, "{flux} W");
    }
}
