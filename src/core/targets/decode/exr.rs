//! OpenEXR: the layer that is shown, composed into its display window.

use std::path::Path;

use exr::prelude::{
    IntegerBounds, MetaData, ReadChannels, ReadLayers, ReadSpecificChannel, SpecificChannels, Vec2,
};

use super::decoded::{Picture, Pixels, damaged, require_size};
use super::source::Source;
use crate::{Error, Progress, Result};

/// Words in the names of layers that hold the whole picture.
const WHOLE: [&str; 5] = ["combined", "beauty", "rgb", "composite", "image"];

/// A layer that can be shown: the names of its channels R, G, B (or three times Y) and A.
struct Layer {
    name: String,
    channels: [String; 4],
    /// The smallest is shown.
    rank: usize,
}

pub(super) fn read(path: &Path, bytes: &[u8], progress: &Progress) -> Result<Picture> {
    let meta = MetaData::read_from_buffered(Source::new(bytes, progress), false)
        .map_err(|error| damaged(path, error))?;
    let mut layers = Vec::new();
    let mut names = Vec::new();
    for header in &meta.headers {
        let (width, height) = (header.layer_size.x(), header.layer_size.y());
        require_size(path, width, height, 16 * width as u64 * height as u64)?;
        let channels: Vec<String> =
            header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
        if !header.deep {
            layers.extend(layers_of(&channels));
        }
        names.extend(channels);
    }
    if meta.headers.iter().all(|header| header.deep) {
        return Err(Error::format(path, "", "this OpenEXR file holds deep pixels; save it flattened"));
    }
    let Some(shown) = layers.iter().min_by_key(|layer| layer.rank) else {
        let what = format!(
            "holds no RGB picture, only the channels {}; save it with R, G and B, or with Y",
            list(&names)
        );
        return Err(Error::format(path, "", what));
    };
    let source = Source::new(bytes, progress);
    let mut picture = if shown.channels[0] == shown.channels[1] {
        read_grey(path, source, shown)
    } else {
        read_colour(path, source, shown)
    }?;
    let mut others: Vec<String> = layers.iter().map(|layer| called(&layer.name)).collect();
    others.retain(|name| *name != called(&shown.name));
    if !others.is_empty() {
        let what = format!("of its layers {} is shown, not {}", called(&shown.name), list(&others));
        picture.notes.push(format!("'{}': {what}", path.display()));
    }
    Ok(picture)
}

/// A layer by its name; that of channels called R, G, B alone has none.
fn called(layer: &str) -> String {
    if layer.is_empty() { "the one without name".to_owned() } else { format!("'{layer}'") }
}

/// The names of a list, the first few.
fn list(names: &[String]) -> String {
    const MOST: usize = 12;
    let shown = names[..names.len().min(MOST)].join(", ");
    if names.len() > MOST { format!("{shown} and {} more", names.len() - MOST) } else { shown }
}

/// The layers of a part, by what stands before the last dot of its channels' names.
fn layers_of(channels: &[String]) -> Vec<Layer> {
    let split = |channel: &str| {
        let (layer, own) = channel.rsplit_once('.').unwrap_or(("", channel));
        (layer.to_owned(), own.to_ascii_uppercase())
    };
    let mut names: Vec<String> = channels.iter().map(|channel| split(channel).0).collect();
    names.dedup();
    let layer = |name: String| {
        let find =
            |wanted: &str| channels.iter().find(|channel| split(channel) == (name.clone(), wanted.into()));
        let alpha = find("A").cloned().unwrap_or_else(|| joined(&name, "A"));
        let colours =
            [["R", "RED"], ["G", "GREEN"], ["B", "BLUE"]].map(|names| names.into_iter().find_map(find));
        let grey = find("Y").filter(|_| find("X").is_none() && find("Z").is_none());
        let (rgb, is_grey) = match (colours, grey) {
            ([Some(r), Some(g), Some(b)], _) => ([r, g, b], false),
            (_, Some(y)) => ([y; 3], true),
            _ => return None,
        };
        let [r, g, b] = rgb.map(String::clone);
        let rank = 2 * rank(&name) + usize::from(is_grey);
        Some(Layer { name, channels: [r, g, b, alpha], rank })
    };
    names.into_iter().filter_map(layer).collect()
}

fn joined(layer: &str, channel: &str) -> String {
    if layer.is_empty() { channel.to_owned() } else { format!("{layer}.{channel}") }
}

/// How far a layer is from the whole picture: 0 where its channels have no layer, then the words of [`WHOLE`].
fn rank(layer: &str) -> usize {
    let last = layer.rsplit('.').next().unwrap_or_default().to_lowercase();
    let named = WHOLE.iter().position(|word| last.contains(word)).unwrap_or(WHOLE.len());
    if layer.is_empty() { 0 } else { 1 + named }
}

fn read_colour(path: &Path, source: Source<'_>, layer: &Layer) -> Result<Picture> {
    let [r, g, b, a] = layer.channels.each_ref().map(|name| &**name);
    let layer = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required::<f32>(r)
        .required::<f32>(g)
        .required::<f32>(b)
        .optional::<f32>(a, 1.0)
        .collect_pixels(blank, |(width, pixels), at, (r, g, b, a): (f32, f32, f32, f32)| {
            pixels[at.y() * *width + at.x()] = [r, g, b, a];
        })
        .first_valid_layer();
    read_pixels(path, source, layer)
}

fn read_grey(path: &Path, source: Source<'_>, layer: &Layer) -> Result<Picture> {
    let [y, _, _, a] = layer.channels.each_ref().map(|name| &**name);
    let layer = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required::<f32>(y)
        .optional::<f32>(a, 1.0)
        .collect_pixels(blank, |(width, pixels), at, (y, a): (f32, f32)| {
            pixels[at.y() * *width + at.x()] = [y, y, y, a];
        })
        .first_valid_layer();
    read_pixels(path, source, layer)
}

/// The picture of the first layer that has the channels asked for.
fn read_pixels<R, Channels>(path: &Path, source: Source<'_>, layer: R) -> Result<Picture>
where
    for<'s> R: ReadLayers<'s, Layers = exr::image::Layer<SpecificChannels<Stored, Channels>>>,
{
    let image =
        layer.all_attributes().non_parallel().from_buffered(source).map_err(|error| damaged(path, error))?;
    let data = IntegerBounds::new(image.layer_data.attributes.layer_position, image.layer_data.size);
    compose(path, data, &image.attributes, image.layer_data.channel_data.pixels.1)
}

/// The width of a picture and its pixels.
type Stored = (usize, Vec<[f32; 4]>);

/// A black picture.
fn blank<Channels>(size: Vec2<usize>, _: &Channels) -> Stored {
    (size.x(), vec![[0.0; 4]; size.x() * size.y()])
}

/// The display window with the pixels of the data window in it; what was not stored is transparent.
fn compose(
    path: &Path,
    data: IntegerBounds,
    attributes: &exr::meta::header::ImageAttributes,
    pixels: Vec<[f32; 4]>,
) -> Result<Picture> {
    let aspect = Some(attributes.pixel_aspect).filter(|aspect| (0.01..100.0).contains(aspect)).unwrap_or(1.0);
    let display = attributes.display_window;
    let picture = |size: Vec2<usize>, pixels| Picture {
        width: size.x(),
        height: size.y(),
        aspect,
        notes: Vec::new(),
        pixels: Pixels::Float(pixels),
    };
    if display == data {
        return Ok(picture(data.size, pixels));
    }
    let (width, height) = (display.size.x(), display.size.y());
    require_size(path, width, height, 16 * width as u64 * height as u64)?;
    // Columns and rows of the data window that the display window shows, and where its first one lies there.
    let shown = |at: i32, length: usize, from: i32, size: usize| {
        let offset = i64::from(at) - i64::from(from);
        let first = (-offset).clamp(0, length as i64);
        let last = (size as i64 - offset).clamp(first, length as i64);
        (first as usize..last as usize, (first + offset) as usize)
    };
    let (columns, left) = shown(data.position.x(), data.size.x(), display.position.x(), width);
    let (rows, top) = shown(data.position.y(), data.size.y(), display.position.y(), height);
    if columns.is_empty() || rows.is_empty() {
        let what = "its pixels lie outside its display window; save it with a display window around them";
        return Err(Error::format(path, "", what));
    }
    let mut canvas = vec![[0.0; 4]; width * height];
    for (row, target) in rows.zip(top..) {
        let from = row * data.size.x();
        let target = target * width + left;
        canvas[target..target + columns.len()]
            .copy_from_slice(&pixels[from + columns.start..from + columns.end]);
    }
    Ok(picture(display.size, canvas))
}
