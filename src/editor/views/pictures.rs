//! The workers' pictures as textures, each uploaded once.

use std::sync::Arc;

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use glam::Vec2;

use crate::editor::preview::LivePreview;

/// The newest pictures as textures: of this flow, and of its comparison.
#[derive(Default)]
pub(super) struct Pictures {
    pub(super) plane: [TextureSlot; 2],
    pub(super) shot: [TextureSlot; 2],
    pub(super) look: TextureSlot,
    target: TextureSlot,
    target_size: Option<Vec2>,
}

/// One texture, and the picture it holds.
#[derive(Default)]
pub(super) struct TextureSlot {
    of: Option<Arc<ColorImage>>,
    texture: Option<TextureHandle>,
}

impl Pictures {
    /// Uploads what the workers painted since the last time.
    pub(super) fn take(&mut self, ctx: &Context, preview: &LivePreview) {
        let painted = preview.painted();
        for side in 0..2 {
            self.plane[side].put(ctx, "plane", painted.plane[side].as_ref());
            self.shot[side].put(ctx, "shot", painted.shot[side].as_ref());
        }
        let target = preview.target();
        self.target.put(ctx, "target", target.as_ref().map(|target| &target.picture));
        self.target_size = target.map(|target| target.size);
        self.look.put(ctx, "orbit view", preview.look().picture.as_ref());
    }

    /// The target picture, with the size of its file in pixels.
    pub(super) fn target(&self) -> Option<(TextureId, Vec2)> {
        Some((self.target.texture()?.id(), self.target_size?))
    }
}

impl TextureSlot {
    /// Uploads a picture; keeps the last one while there is none.
    fn put(&mut self, ctx: &Context, name: &str, picture: Option<&Arc<ColorImage>>) {
        let Some(picture) = picture else { return };
        if self.of.as_ref().is_some_and(|of| Arc::ptr_eq(of, picture)) {
            return;
        }
        match &mut self.texture {
            Some(texture) => texture.set(picture.clone(), TextureOptions::LINEAR),
            None => self.texture = Some(ctx.load_texture(name, picture.clone(), TextureOptions::LINEAR)),
        }
        self.of = Some(picture.clone());
    }

    /// The texture; none before there was a picture.
    pub(super) fn texture(&self) -> Option<&TextureHandle> {
        self.texture.as_ref()
    }
}
