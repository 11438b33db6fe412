//! How numbers are written and read.

/// Digits that are shown: an artist's eye is no finer.
const DIGITS: i32 = 5;

/// The number as it is shown: whole numbers in groups of three, others with five digits that count.
pub fn number(value: f64, whole: bool) -> String {
    if whole { grouped(value) } else { with_digits(value, DIGITS) }
}

/// The number as it is shown where there is room for so many characters, with fewer digits if need be.
pub fn number_within(value: f64, whole: bool, room: usize) -> String {
    let text = number(value, whole);
    if whole || text.len() <= room {
        return text;
    }
    let shorter = (2..DIGITS).rev().map(|digits| with_digits(value, digits));
    shorter.into_iter().find(|text| text.len() <= room).unwrap_or(text)
}

/// With so many digits that count.
fn with_digits(value: f64, digits: i32) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) {
        return scientific(value, digits);
    }
    let before = if size < 1.0 { 0 } else { size.log10().floor() as i32 + 1 };
    // Leading zeros behind the point do not count as digits.
    let leading = if size > 0.0 && size < 1.0 { (-size.log10()).floor() as i32 } else { 0 };
    let decimals = (digits - before + leading).max(0) as usize;
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

/// "1.5e-9"
fn scientific(value: f64, digits: i32) -> String {
    let text = format!("{value:.prec$e}", prec = digits as usize - 1);
    match text.split_once('e') {
        Some((digits, power)) => format!("{}e{power}", trimmed(digits)),
        None => text,
    }
}

/// Without zeros that end it.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// "1 000 000"
fn grouped(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i) % 3 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    if value < 0.0 { format!("-{text}") } else { text }
}

/// The number that somebody typed: blanks, a comma for the point and the unit do not matter.
pub fn parse(text: &str, unit: &str) -> Option<f64> {
    let text: String = text.trim().trim_end_matches(unit).split_whitespace().collect();
    let text = text.replace(',', ".").replace('−', "-");
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_lead_back_to_themselves() {
        let shown = [
            (0.5, "0.5"),
            (f64::from(1e-3_f32), "0.001"),
            (f64::from(1e-6_f32), "1e-6"),
            (-5.0 / 3.0, "-1.6667"),
            (0.0, "0"),
            (1e6, "1e6"),
            (40.0, "40"),
            (0.023_437_5, "0.023438"),
        ];
        for (value, text) in shown {
            assert_eq!(number(value, false), text);
            // Half a unit of the fifth digit.
            assert!((parse(text, "").unwrap_or(f64::NAN) - value).abs() <= 5e-5 * value.abs());
        }
    }

    #[test]
    fn numbers_lose_digits_where_there_is_little_room() {
        let shown =
            [(-0.003_571_152_7, "-0.00357"), (0.109_546_36, "0.10955"), (-1234.567, "-1234.6"), (0.5, "0.5")];
        for (value, text) in shown {
            assert_eq!(number_within(value, false, 8), text);
        }
        assert_eq!(number_within(1_000_000.0, true, 3), "1 000 000");
    }

    #[test]
    fn whole_numbers_come_in_groups_and_are_read_so() {
        assert_eq!(number(1_000_000.0, true), "1 000 000");
        assert_eq!(number(-1234.0, true), "-1 234");
        assert_eq!(parse("1 000 000 W", "W"), Some(1e6));
    }

    #[test]
    fn what_is_no_number_is_not_read() {
        for text in ["", "nan", "inf", "1..2", "ten"] {
            assert_eq!(parse(text, "m"), None, "{text}");
        }
        assert_eq!(parse("0,5", ""), Some(0.5));
    }
}
