//! NPY, NumPy's file format for one array (NumPy Enhancement Proposal 1): float32 in C order is written; float32 and float64
//! in either byte order are read, header versions 1.0 to 3.0.

use std::io::{self, Write};

/// First bytes of every NPY file.
pub const MAGIC: &[u8] = b"\x93NUMPY";

/// Bytes to which the data is aligned.
const ALIGNMENT: usize = 64;

/// Why an array cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum NpyError {
    /// The header is cut short or malformed.
    #[error("the NPY header cannot be read ({0})")]
    Header(&'static str),
    /// The elements are integers, text or records.
    #[error("the array does not hold f32 or f64 numbers; convert it")]
    Type,
    /// There is less data than the shape needs.
    #[error("the array is cut short ({found} of {needed} bytes)")]
    Short {
        /// Bytes of data in the file.
        found: usize,
        /// Bytes that the shape asks for.
        needed: u128,
    },
}

/// The header of an NPY file.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Elements along each axis.
    pub shape: Vec<u64>,
    /// Whether the first index varies fastest.
    pub fortran_order: bool,
    /// Type string, such as `<f4`; none for records.
    descr: Option<String>,
    /// Offset of the first element in bytes.
    data: usize,
}

/// The header and the elements of a file.
///
/// # Errors
/// [`NpyError`].
pub fn parse(file: &[u8]) -> Result<(Header, Vec<f32>), NpyError> {
    let header = Header::parse(file)?;
    let values = header.values(file)?;
    Ok((header, values))
}

impl Header {
    /// Reads the header of a whole file.
    ///
    /// # Errors
    /// [`NpyError::Header`].
    pub fn parse(file: &[u8]) -> Result<Self, NpyError> {
        let bad = NpyError::Header;
        let rest = file.strip_prefix(MAGIC).ok_or(bad("it does not begin as NPY does"))?;
        let cut = bad("it is cut short");
        let (length, start) = match rest {
            [1, 0, a, b, ..] => (u16::from_le_bytes([*a, *b]).into(), 10),
            [2 | 3, 0, a, b, c, d, ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, 12),
            [1, 0, ..] | [2 | 3, 0, ..] | [] | [_] => return Err(cut),
            _ => return Err(bad("its version is not 1.0, 2.0 or 3.0")),
        };
        let data = start + length;
        let text = std::str::from_utf8(file.get(start..data).ok_or(cut)?);
        let text = text.map_err(|_| bad("it is not UTF-8 text"))?;
        let fortran_order = match member(text, "fortran_order").ok_or(bad("it has no fortran_order"))? {
            order if order.starts_with("True") => true,
            order if order.starts_with("False") => false,
            _ => return Err(bad("its fortran_order is neither True nor False")),
        };
        let shape = member(text, "shape").and_then(tuple).ok_or(bad("it has no shape"))?;
        let descr = quoted(member(text, "descr").ok_or(bad("it has no descr"))?);
        Ok(Self { shape, fortran_order, descr: descr.map(str::to_owned), data })
    }

    /// The elements of the file that this header was read from, in its order.
    ///
    /// # Errors
    /// [`NpyError::Type`], [`NpyError::Short`].
    pub fn values(&self, file: &[u8]) -> Result<Vec<f32>, NpyError> {
        let data = file.get(self.data..).unwrap_or_default();
        match self.descr.as_deref() {
            Some("<f4") => self.elements(data, f32::from_le_bytes),
            Some(">f4") => self.elements(data, f32::from_be_bytes),
            Some("<f8") => self.elements(data, |bytes| f64::from_le_bytes(bytes) as f32),
            Some(">f8") => self.elements(data, |bytes| f64::from_be_bytes(bytes) as f32),
            _ => Err(NpyError::Type),
        }
    }

    fn elements<const N: usize>(
        &self,
        data: &[u8],
        number: impl Fn([u8; N]) -> f32,
    ) -> Result<Vec<f32>, NpyError> {
        let needed = self.shape.iter().fold(N as u128, |sum, &n| sum.saturating_mul(n.into()));
        let found = data.len();
        let data = usize::try_from(needed).ok().and_then(|needed| data.get(..needed));
        let (elements, _) = data.ok_or(NpyError::Short { found, needed })?.as_chunks();
        Ok(elements.iter().map(|&bytes| number(bytes)).collect())
    }
}

/// What stands after `'name':` in a Python dict.
fn member<'a>(dict: &'a str, name: &str) -> Option<&'a str> {
    dict.match_indices(name).find_map(|(at, _)| {
        let quote = dict[..at].chars().next_back().filter(|c| matches!(c, '\'' | '"'))?;
        let rest = dict[at + name.len()..].strip_prefix(quote)?;
        rest.trim_start().strip_prefix(':').map(str::trim_start)
    })
}

/// The content of a Python string without escapes.
fn quoted(text: &str) -> Option<&str> {
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text[1..].split_once(quote).map(|(content, _)| content)
}

/// A Python tuple or list of whole numbers.
fn tuple(text: &str) -> Option<Vec<u64>> {
    let close = if text.starts_with('(') { ')' } else { ']' };
    let (items, _) = text.strip_prefix(['(', '['])?.split_once(close)?;
    let items = items.trim().trim_end_matches(',');
    let items = items.split(',').filter(|_| !items.is_empty());
    items.map(|item| item.trim().parse().ok()).collect()
}

/// Writes an array of float32 in C order, element by element.
pub struct NpyWriter<W> {
    out: W,
    /// Elements that are still to come.
    missing: u64,
}

impl<W: Write> NpyWriter<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(mut out: W, shape: &[u64]) -> io::Result<Self> {
        let shape_text: String = shape.iter().map(|n| format!("{n}, ")).collect();
        let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({shape_text}), }}");
        // Magic, version, length, and the line end that closes the header.
        let before = MAGIC.len() + 4;
        let used = before + header.len() + 1;
        header.extend(std::iter::repeat_n(' ', used.next_multiple_of(ALIGNMENT) - used));
        header.push('\n');
        let length = u16::try_from(header.len()).map_err(io::Error::other)?;
        out.write_all(MAGIC)?;
        out.write_all(&[1, 0])?;
        out.write_all(&length.to_le_bytes())?;
        out.write_all(header.as_bytes())?;
        Ok(Self { out, missing: shape.iter().product() })
    }

    /// Writes the next elements.
    ///
    /// # Errors
    /// Those of `out`, and more elements than the shape has.
    pub fn extend(&mut self, values: impl IntoIterator<Item = f32>) -> io::Result<()> {
        for value in values {
            self.missing = self.missing.checked_sub(1).ok_or_else(wrong_count)?;
            self.out.write_all(&value.to_le_bytes())?;
        }
        Ok(())
    }

    /// Flushes the array.
    ///
    /// # Errors
    /// Those of `out`, and fewer elements than the shape has.
    pub fn finish(mut self) -> io::Result<()> {
        if self.missing > 0 {
            return Err(wrong_count());
        }
        self.out.flush()
    }
}

fn wrong_count() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the array has another number of elements than its shape")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A file as NumPy writes it, of header version 1.0.
    fn numpy(descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let header = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}");
        let mut file = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
        file.extend(format!("{header:117}\n").bytes());
        file.extend(data);
        file
    }

    #[test]
    fn both_byte_orders_and_both_widths_are_read() {
        let numbers = [1.5_f32, -0.25];
        let wide = numbers.map(f64::from);
        let files = [
            ("'<f4'", numbers.map(f32::to_le_bytes).concat()),
            ("'>f4'", numbers.map(f32::to_be_bytes).concat()),
            ("'<f8'", wide.map(f64::to_le_bytes).concat()),
            ("\">f8\"", wide.map(f64::to_be_bytes).concat()),
        ];
        for (descr, data) in files {
            let (header, values) = parse(&numpy(descr, "False", "(2,)", &data)).unwrap();
            assert_eq!((header.shape, values), (vec![2], numbers.to_vec()), "{descr}");
        }
        let (header, _) = parse(&numpy("'<f4'", "True", "(1, 2)", &[0; 8])).unwrap();
        assert!(header.fortran_order);
    }

    #[test]
    fn other_types_and_damaged_headers_are_refused() {
        for descr in ["'<i4'", "'<f2'", "'|S4'", "[('shape', '<f4')]"] {
            assert!(matches!(parse(&numpy(descr, "False", "(1,)", &[0; 4])), Err(NpyError::Type)), "{descr}");
        }
        for (order, shape) in [("0", "(1,)"), ("False", "1"), ("False", "(-1,)"), ("False", "(1")] {
            let file = numpy("'<f4'", order, shape, &[0; 4]);
            assert!(matches!(parse(&file), Err(NpyError::Header(_))), "{order} {shape}");
        }
        let huge = numpy("'<f4'", "False", "(18446744073709551615, 18446744073709551615)", &[0; 4]);
        assert!(matches!(parse(&huge), Err(NpyError::Short { .. })));
    }

    #[test]
    fn the_header_is_aligned_and_the_number_of_elements_is_watched() {
        let mut file = Vec::new();
        let mut npy = NpyWriter::new(&mut file, &[1, 2]).unwrap();
        npy.extend([1.0, 2.0]).unwrap();
        assert!(npy.extend([3.0]).is_err());
        npy.finish().unwrap();
        assert_eq!(file.len(), 2 * ALIGNMENT + 8);
        assert_eq!(parse(&file).unwrap().1, [1.0, 2.0]);
        assert!(NpyWriter::new(&mut file, &[1]).unwrap().finish().is_err());
    }
}
