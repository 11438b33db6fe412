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

/// Refuses a program that needs a newer glibc than the target says, such as `x86_64-unknown-linux-gnu.2.28`.
pub(crate) fn require(needed: Option<[u32; 2]>, target: Option<&str>) -> Result<(), String> {
    let Some((_, version)) = target.and_then(|target| target.split_once('.')) else { return Ok(()) };
    let mut numbers = version.split('.').map(str::parse);
    let (Some(Ok(major)), Some(Ok(minor)), None) = (numbers.next(), numbers.next(), numbers.next()) else {
        return Err(format!("--target: '{version}' is no version of glibc; write it as 2.28"));
    };
    match needed {
        Some([a, b]) if [a, b] > [major, minor] => Err(format!(
            "the program needs glibc {a}.{b}, but {major}.{minor} was asked for: it would not start there; build it with cargo zigbuild"
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn versions_are_compared_as_numbers() {
        assert_eq!(newest(b"\0GLIBC_2.9\0GLIBC_2.28\0GLIBC_2.2.5\0GLIBC_PRIVATE\0"), Some([2, 28]));
        assert_eq!(newest(b"static"), None);
    }

    #[test]
    fn a_program_that_needs_more_than_its_target_has_is_refused() {
        let target = Some("x86_64-unknown-linux-gnu.2.28");
        assert_eq!(
            [Some([2, 28]), Some([2, 9]), None].map(|needed| require(needed, target)),
            [Ok(()), Ok(()), Ok(())]
        );
        let refused = require(Some([2, 34]), target).unwrap_err();
        assert!(refused.contains("glibc 2.34") && refused.contains("2.28 was asked for"), "{refused}");
        assert!(require(Some([2, 34]), Some("x86_64-unknown-linux-gnu")).is_ok());
        assert!(require(None, Some("x86_64-unknown-linux-gnu.new")).is_err());
    }
}
