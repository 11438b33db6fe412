//! The version of the C library that a program needs.

const PREFIX: &[u8] = b"GLIBC_";

/// The newest version of glibc whose symbols a program names, as major and minor number; none where it names none.
pub(crate) fn newest(program: &[u8]) -> Option<[u32; 2]> {
    let mut newest = None;
    let mut rest = program;
    while let Some(at) = rest.windows(PREFIX.len()).position(|bytes| bytes == PREFIX) {
        rest = &rest[at + PREFIX.len()..];
        let end = rest.iter().position(|byte| !matches!(byte, b'0'..=b'9' | b'.')).unwrap_or(rest.len());
        let text = String::from_utf8_lossy(&rest[..end]);
        let mut numbers = text.split('.').map(str::parse);
        if let (Some(Ok(major)), Some(Ok(minor))) = (numbers.next(), numbers.next()) {
            newest = newest.max(Some([major, minor]));
        }
    }
    newest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_as_numbers() {
        assert_eq!(newest(b"\0GLIBC_2.9\0GLIBC_2.28\0GLIBC_2.2.5\0GLIBC_PRIVATE\0"), Some([2, 28]));
        assert_eq!(newest(b"static"), None);
    }
}
