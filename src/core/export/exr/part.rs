//! A part of a file: with samples of its own, or compressed before and shared by many files.

use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::writer::ChunksWriter as _;
use exr::block::{self, UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::error::Result;
use exr::image::write::layers::{LayersWriter as _, WritableLayers as _};
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, ImageAttributes, IntegerBounds,
    Layer, LayerAttributes, LineOrder,
};
use std::io::Cursor;

/// The channels of a part.
pub(super) type Channels = Vec<AnyChannel<FlatSamples>>;
type Samples = Layer<AnyChannels<FlatSamples>>;

const ENCODING: Encoding =
    Encoding { compression: Compression::PIZ, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };

/// A part of a file.
pub(super) enum Part<'a> {
    /// With samples of its own.
    Fresh(Channels),
    /// Compressed before.
    Kept(&'a KeptPart),
}

/// The compressed blocks of a part; its attributes are those of each file.
#[derive(Debug)]
pub(super) struct KeptPart {
    header: Header,
    /// From the top.
    blocks: Vec<CompressedBlock>,
}

impl KeptPart {
    /// Compresses the channels of a part.
    pub(super) fn new(size: (usize, usize), channels: Channels) -> Result<Self> {
        let samples = samples(size, LayerAttributes::default(), channels, true);
        let header = header(&samples, &ImageAttributes::new(IntegerBounds::from_dimensions(size)));
        let headers = std::slice::from_ref(&header);
        let blocks = enumerate_ordered_header_block_indices(headers)
            .map(|(_, index)| Ok(compressed(&samples, headers, index)?.compressed_block))
            .collect::<Result<_>>()?;
        Ok(Self { header, blocks })
    }
}

/// The bytes of a file of parts of one size with their attributes; whether fresh ones are compressed.
pub(super) fn bytes(
    (parts, compresses): (Vec<(LayerAttributes, Part)>, bool),
    size: (usize, usize),
    shared: &ImageAttributes,
) -> Result<Vec<u8>> {
    enum Source<'a> {
        Samples(Box<Samples>),
        Kept(&'a KeptPart),
    }
    let parts: Vec<(Header, Source)> = parts
        .into_iter()
        .map(|(attributes, part)| match part {
            Part::Fresh(channels) => {
                let samples = samples(size, attributes, channels, compresses);
                (header(&samples, shared), Source::Samples(Box::new(samples)))
            }
            Part::Kept(kept) => {
                let (own_attributes, shared_attributes) = (attributes, shared.clone());
                let header = Header { own_attributes, shared_attributes, ..kept.header.clone() };
                (header, Source::Kept(kept))
            }
        })
        .collect();
    let headers = parts.iter().map(|(header, _)| header.clone()).collect();
    let mut bytes = Vec::new();
    block::write(Cursor::new(&mut bytes), headers, true, |meta, file| {
        for (number, index) in enumerate_ordered_header_block_indices(&meta.headers) {
            let layer_index = index.layer;
            let chunk = match &parts[layer_index].1 {
                Source::Samples(samples) => compressed(samples, &meta.headers, index)?,
                Source::Kept(kept) => Chunk { layer_index, compressed_block: kept.blocks[number].clone() },
            };
            file.write_chunk(number, chunk)?;
        }
        Ok(())
    })?;
    Ok(bytes)
}

fn samples(
    size: (usize, usize),
    attributes: LayerAttributes,
    channels: Channels,
    compresses: bool,
) -> Samples {
    let compression = if compresses { ENCODING.compression } else { Compression::Uncompressed };
    Layer::new(size, attributes, Encoding { compression, ..ENCODING }, AnyChannels::sort(channels.into()))
}

fn header(samples: &Samples, shared: &ImageAttributes) -> Header {
    samples.infer_headers(shared).remove(0)
}

/// A block of the part with these samples, compressed; `headers` are those of all parts.
fn compressed(samples: &Samples, headers: &[Header], index: block::BlockIndex) -> Result<Chunk> {
    let own = &headers[index.layer..=index.layer];
    let data = samples.create_writer(own).extract_uncompressed_block(own, index);
    UncompressedBlock { index, data }.compress_to_chunk(headers)
}
