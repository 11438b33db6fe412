//! Accessors: typed elements within buffers. Each range is checked with checked arithmetic before the first element is read.

use gltf_json::accessor::{ComponentType, Type};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Index, accessor, buffer};

use super::GltfFile;
use crate::Result;

/// Most elements of an accessor that has no data but zeros.
const MOST_ZEROS: u64 = 1 << 20;

/// The elements of an accessor.
pub(super) struct Elements<'a> {
    /// Empty where all are zero.
    bytes: &'a [u8],
    stride: usize,
    pub(super) count: usize,
    kind: ComponentType,
    normalized: bool,
    lanes: usize,
    /// Elements that stand elsewhere, ascending, and their bytes one after the other.
    sparse: Vec<u32>,
    sparse_bytes: &'a [u8],
}

impl GltfFile {
    /// The elements of an accessor of a kind; `place` names who asks for it.
    pub(super) fn elements(
        &self,
        index: Index<accessor::Accessor>,
        wanted: Type,
        place: &str,
    ) -> Result<Elements<'_>> {
        let at = format!("accessors[{}]", index.value());
        let Some(accessor) = self.root.accessors.get(index.value()) else {
            return Err(
                self.error(place, format!("names {at}, of {} that there are", self.root.accessors.len()))
            );
        };
        let (Checked::Valid(component), Checked::Valid(given)) = (accessor.component_type, accessor.type_)
        else {
            return Err(self.error(at, "is of a type that glTF does not know"));
        };
        if given != wanted {
            return Err(self.error(at, format!("is {given:?}, but {place} needs {wanted:?}")));
        }
        let (kind, lanes) = (component.0, given.multiplicity());
        let size = kind.size() * lanes;
        let too_many =
            || self.error(&at, format!("says that it has {} elements, beyond its data", accessor.count.0));
        let count = u32::try_from(accessor.count.0).map_err(|_| too_many())? as usize;
        let (bytes, stride) = match accessor.buffer_view {
            Some(view) => self.range(view, accessor.byte_offset, (count, size), &at)?,
            None if accessor.count.0 > MOST_ZEROS => return Err(too_many()),
            None => (&[][..], size),
        };
        let mut elements = Elements {
            bytes,
            stride,
            count,
            kind,
            normalized: accessor.normalized,
            lanes,
            sparse: Vec::new(),
            sparse_bytes: &[],
        };
        if let Some(sparse) = &accessor.sparse {
            (elements.sparse, elements.sparse_bytes) = self.sparse(sparse, count, size, &at)?;
        } else if accessor.buffer_view.is_none() {
            return Err(
                self.error(at, "has no data (bufferView); is the file compressed? Export it again without")
            );
        }
        Ok(elements)
    }

    /// The elements that stand elsewhere.
    fn sparse(
        &self,
        sparse: &accessor::sparse::Sparse,
        count: usize,
        size: usize,
        at: &str,
    ) -> Result<(Vec<u32>, &[u8])> {
        let place = format!("{at}.sparse");
        let replaced = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
        if replaced > count {
            return Err(self.error(place, format!("replaces {replaced} of {count} elements")));
        }
        let Checked::Valid(kind) = sparse.indices.component_type else {
            return Err(self.error(place, "has indices of a type that glTF does not know"));
        };
        let kind = kind.0;
        let indices = (replaced, kind.size());
        let (bytes, stride) =
            self.range(sparse.indices.buffer_view, Some(sparse.indices.byte_offset), indices, &place)?;
        let read = |i: usize| component(bytes.get(i * stride..).unwrap_or(&[]), kind) as u32;
        let indices: Vec<u32> = (0..replaced).map(read).collect();
        let rising = indices.windows(2).all(|pair| pair[0] < pair[1]);
        if !rising || indices.last().is_some_and(|last| *last as usize >= count) {
            return Err(
                self.error(place, format!("has indices that do not rise, or lie beyond {count} elements"))
            );
        }
        let values = (replaced, size);
        let (values, stride) =
            self.range(sparse.values.buffer_view, Some(sparse.values.byte_offset), values, &place)?;
        if stride != size {
            return Err(self.error(place, "has values with gaps (byteStride), which glTF does not allow"));
        }
        Ok((indices, values))
    }

    /// The bytes of `count` elements of `size` bytes in a view, and their distance.
    fn range(
        &self,
        view: Index<buffer::View>,
        offset: Option<USize64>,
        (count, size): (usize, usize),
        at: &str,
    ) -> Result<(&[u8], usize)> {
        let place = format!("bufferViews[{}]", view.value());
        let Some(view) = self.root.buffer_views.get(view.value()) else {
            return Err(
                self.error(at, format!("names {place}, of {} that there are", self.root.buffer_views.len()))
            );
        };
        let Some(buffer) = self.buffers.get(view.buffer.value()) else {
            return Err(
                self.error(place, format!("names buffers[{}], which is not there", view.buffer.value()))
            );
        };
        let start = view.byte_offset.unwrap_or_default().0;
        let end = start.checked_add(view.byte_length.0).filter(|end| *end <= buffer.len() as u64);
        let whole = end.and_then(|end| buffer.get(start as usize..end as usize)).ok_or_else(|| {
            let what = format!(
                "is {} bytes from byte {start} on, beyond the {} of its buffer; export it again",
                view.byte_length.0,
                buffer.len()
            );
            self.error(&place, what)
        })?;
        let stride = view.byte_stride.map_or(size, |stride| stride.0);
        if stride < size || stride > 252.max(size) {
            return Err(
                self.error(place, format!("has elements {stride} bytes apart that have {size} bytes"))
            );
        }
        let offset = offset.unwrap_or_default().0;
        let needed = (count as u64)
            .checked_sub(1)
            .map_or(Some(0), |gaps| gaps.checked_mul(stride as u64)?.checked_add(size as u64));
        let end =
            needed.and_then(|needed| offset.checked_add(needed)).filter(|end| *end <= whole.len() as u64);
        let bytes = end.and_then(|end| whole.get(offset as usize..end as usize)).ok_or_else(|| {
            let what = format!(
                "has {count} elements of {size} bytes from byte {offset} on, beyond the {} of {place}; export it again",
                whole.len()
            );
            self.error(at, what)
        })?;
        Ok((bytes, stride))
    }
}

impl Elements<'_> {
    /// The three numbers of an element; those of integers as they are meant.
    pub(super) fn vector(&self, index: u32) -> [f64; 3] {
        [0, 1, 2].map(|lane| self.number(index, lane))
    }

    /// An element as an index.
    pub(super) fn index(&self, index: usize) -> u32 {
        self.number(index as u32, 0) as u32
    }

    /// How many elements stand elsewhere.
    pub(super) fn elsewhere(&self) -> usize {
        self.sparse.len()
    }

    /// Whether the elements are whole numbers that can be indices.
    pub(super) fn are_indices(&self) -> bool {
        matches!(self.kind, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) && !self.normalized
    }

    fn number(&self, index: u32, lane: usize) -> f64 {
        let size = self.kind.size();
        let (bytes, start) = match self.sparse.binary_search(&index) {
            Ok(at) => (self.sparse_bytes, at * self.lanes * size),
            Err(_) => (self.bytes, index as usize * self.stride),
        };
        let value = component(bytes.get(start + lane * size..).unwrap_or(&[]), self.kind);
        match (self.normalized, self.kind) {
            (true, ComponentType::I8) => (value / 127.0).max(-1.0),
            (true, ComponentType::U8) => value / 255.0,
            (true, ComponentType::I16) => (value / 32_767.0).max(-1.0),
            (true, ComponentType::U16) => value / 65_535.0,
            _ => value,
        }
    }
}

/// The number that the bytes begin with; 0 where they are too few.
fn component(bytes: &[u8], kind: ComponentType) -> f64 {
    fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
        bytes.first_chunk().copied().unwrap_or([0; N])
    }
    match kind {
        ComponentType::I8 => i8::from_le_bytes(first(bytes)).into(),
        ComponentType::U8 => u8::from_le_bytes(first(bytes)).into(),
        ComponentType::I16 => i16::from_le_bytes(first(bytes)).into(),
        ComponentType::U16 => u16::from_le_bytes(first(bytes)).into(),
        ComponentType::U32 => u32::from_le_bytes(first(bytes)).into(),
        ComponentType::F32 => f32::from_le_bytes(first(bytes)).into(),
    }
}
