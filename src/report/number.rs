//! Numbers as a reader sees them.

/// A number with three significant digits, as `1234`, `0.0123` or `1.23e-7`.
pub(crate) fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => "not finite".to_owned(),
        0.0 => "0".to_owned(),
        1e6.. => format!("{value:.2e}"),
        100.0.. => format!("{value:.0}"),
        1e-3.. => {
            let digits = (2.0 - size.log10().floor()).max(0.0) as usize;
            let text = format!("{value:.digits$}");
            // Whole numbers stay whole.
            if value.fract() == 0.0 { format!("{value}") } else { text }
        }
        _ => format!("{value:.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_significant_digits() {
        let cases = [
            (0.0, "0"),
            (1234.4, "1234"),
            (12.345, "12.3"),
            (3.0, "3"),
            (0.012345, "0.0123"),
            (1.2345e-7, "1.23e-7"),
            (-2.5e7, "-2.50e7"),
            (f64::NAN, "not finite"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
    }
}
