//! The decimal sign of a recording: a point, or a comma where no comma separates the columns.

use std::ops::Range;

/// A number with one of the signs. A file has one of the two, so that a comma between thousands is not taken for a
/// decimal one beside a point.
pub(super) fn number(field: &str, delimiter: char, sign: &mut Option<char>) -> Option<f64> {
    if let Some(found) = field.chars().find(|c| matches!(c, '.' | ','))
        && (found == delimiter || *sign.get_or_insert(found) != found)
    {
        return None;
    }
    field.replacen(',', ".", 1).parse().ok()
}

/// What a field that is no number was to be.
pub(super) fn expected(field: &str, sign: Option<char>) -> &'static str {
    let signs = field.chars().filter(|c| matches!(c, '.' | ',')).count();
    match sign {
        _ if signs > 1 => "a finite number, without a separator between thousands",
        Some(',') if field.contains('.') => "a finite number with a decimal comma, as those before it",
        Some('.') | None if field.contains(',') => "a finite number with a decimal point, not a comma",
        _ => "a finite number",
    }
}

/// The commas of a column, which may separate thousands: `1,000` after `999`.
#[derive(Default)]
pub(super) struct Commas {
    grouped: Option<Range<usize>>,
    hundreds: bool,
    plain: bool,
}

impl Commas {
    /// Takes a number in, with its place in the text.
    pub(super) fn take(&mut self, field: &str, place: impl FnOnce() -> Range<usize>) {
        let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        let field = field.trim_start_matches(['+', '-']);
        match field.split_once(',') {
            None if digits(field) => match field.len() {
                ..3 => {}
                3 => self.hundreds = true,
                // a thousand that is not grouped
                _ => self.plain = true,
            },
            None => {}
            Some((whole, rest)) => {
                let is_group = rest.len() == 3 && digits(rest) && (1..4).contains(&whole.len());
                if is_group && !whole.starts_with('0') {
                    self.grouped.get_or_insert_with(place);
                } else {
                    self.plain = true;
                }
            }
        }
    }

    /// The first comma that is as likely one between thousands: each has three digits behind it, whole numbers of
    /// hundreds stand beside them, and none of thousands without a comma.
    pub(super) fn doubtful(self) -> Option<Range<usize>> {
        self.grouped.filter(|_| self.hundreds && !self.plain)
    }
}
