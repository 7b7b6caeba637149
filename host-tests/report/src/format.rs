//! Numbers as people read them: in tables, on axes, in labels. A value that is not finite has a word, never `NaN`.

/// Text of a number that is not finite.
pub const DIVERGED: &str = "diverged";

/// A number to three significant digits: plain between 1e-3 and 1e6, with a power of ten elsewhere.
pub fn significant(value: f64) -> String {
    if !value.is_finite() {
        return DIVERGED.to_owned();
    }
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let decimals = (2 - size.log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{value:.decimals$}");
        if decimals == 0 { grouped(text.parse().unwrap_or(0)) } else { text }
    } else {
        format!("{value:.2e}")
    }
}

/// A number of one significant digit or a few, as on a logarithmic axis: `0.05`, `200`.
pub fn significant_short(value: f64) -> String {
    if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        format!("{}", (value * 1e6).round() / 1e6)
    } else {
        format!("{value:.0e}")
    }
}

/// A fraction in percent: `0.84 %`.
pub fn percent(fraction: f64) -> String {
    if !fraction.is_finite() {
        DIVERGED.to_owned()
    } else if fraction != 0.0 && fraction.abs() < 1e-5 {
        format!("{:.1e} %", fraction * 100.0)
    } else {
        let percent = fraction * 100.0;
        let decimals = if percent.abs() < 0.1 {
            3
        } else if percent.abs() < 10.0 {
            2
        } else {
            1
        };
        if percent.abs() >= 1e5 { format!("{percent:.1e} %") } else { format!("{percent:.decimals$} %") }
    }
}

/// An angle from 0 to below 360 degrees.
pub fn turned(angle: f64, decimals: i32) -> String {
    let parts = 10f64.powi(decimals);
    // without the sign of a zero
    let rounded = (angle * parts).round().rem_euclid(360.0 * parts) / parts + 0.0;
    format!("{rounded:.*}", decimals as usize)
}

/// A whole number with a thin space between thousands.
pub fn grouped(value: i64) -> String {
    let digits = value.unsigned_abs().to_string();
    let mut text = String::from(if value < 0 { "-" } else { "" });
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Least and most: `239 to 294`.
pub fn interval(bounds: Option<[u64; 2]>) -> String {
    bounds.map_or("none".into(), |[least, most]| format!("{} to {}", grouped(least as i64), grouped(most as i64)))
}

/// A number of things: `1 draw`, `60 draws`.
pub fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A rate: `10 kHz`, `500 Hz`.
pub fn rate(hz: u32) -> String {
    if hz >= 1_000 { format!("{} kHz", f64::from(hz) / 1e3) } else { format!("{hz} Hz") }
}

/// A label of an axis: as few digits as separate neighbours `step` apart.
pub fn tick(value: f64, step: f64) -> String {
    if value == 0.0 || value.abs() < step * 1e-6 {
        return "0".to_owned();
    }
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    // in a power of ten where the digits would fill the margin
    let size = value.abs();
    let text = if size >= 1e7 || step < 1e-4 { format!("{size:.1e}") } else { format!("{size:.decimals$}") };
    if value < 0.0 { format!("−{text}") } else { text }
}

/// A power of ten with a raised exponent: `10⁻⁶`; small powers plain.
pub fn power(exponent: i32) -> String {
    match exponent {
        -2..=3 => format!("{}", 10f64.powi(exponent)),
        _ => format!("10{}", exponent.to_string().chars().map(raised).collect::<String>()),
    }
}

fn raised(digit: char) -> char {
    match digit {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        _ => '⁹',
    }
}

#[cfg(test)]
mod tests {
    use crate::format::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(significant(0.012_34), "0.0123");
        assert_eq!(significant(123_456.0), "123\u{202f}456");
        assert_eq!(significant(1.5e-9), "1.50e-9");
        assert_eq!(significant(f64::NAN), "diverged");
        assert_eq!(percent(0.0084), "0.84 %");
        assert_eq!(percent(0.000_912), "0.091 %");
        assert_eq!(rate(10_000), "10 kHz");
        assert_eq!(power(-12), "10⁻¹²");
        assert_eq!(power(2), "100");
        assert_eq!([tick(-0.25, 0.05), tick(-5e-6, 5e-6), tick(-2e7, 1e7)], ["−0.25", "−5.0e-6", "−2.0e7"]);
        assert_eq!([turned(359.96, 1), turned(359.94, 1), turned(-90.4, 0)], ["0.0", "359.9", "270"]);
        assert_eq!([turned(-0.04, 1), turned(-0.3, 0), turned(-360.0, 1)], ["0.0", "0", "0.0"]);
        // in tables beside numbers that are not grouped
        assert_eq!(grouped(-1_234_567), "-1\u{202f}234\u{202f}567");
        assert_eq!([counted(1, "draw"), counted(60, "draw")], ["1 draw", "60 draws"]);
    }
}
