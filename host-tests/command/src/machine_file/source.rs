//! Positions in a text: byte offsets to lines and columns, and the line shown with a caret.

use std::ops::Range;

/// Longest piece of a source line that is shown, in characters: a terminal's width less the margin.
const SHOWN: usize = 96;

/// A text and the name it goes by in messages.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// Name of the file as the user typed it.
    pub name: &'a str,
    /// The whole text.
    pub text: &'a str,
}

/// A place in a text as an editor counts: both from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl<'a> Source<'a> {
    /// The nearest character boundary at or before a byte offset; offsets past the end are the end.
    fn boundary(&self, offset: usize) -> usize {
        let mut at = offset.min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        at
    }

    /// The line and column of a byte offset.
    pub fn position(&self, offset: usize) -> Position {
        let before = &self.text[..self.boundary(offset)];
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Position { line: before.matches('\n').count() + 1, column: before[start..].chars().count() + 1 }
    }

    /// The line that holds a byte offset, without its end.
    pub fn line(&self, offset: usize) -> &'a str {
        let at = self.boundary(offset);
        let start = self.text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let end = self.text[at..].find('\n').map_or(self.text.len(), |newline| at + newline);
        self.text[start..end].trim_end_matches('\r')
    }

    /// The text of a span, at most a line's worth, control characters made visible.
    pub fn excerpt(&self, span: Range<usize>) -> String {
        let (start, end) = (self.boundary(span.start), self.boundary(span.end.max(span.start)));
        let line = self.text[start..end].lines().next().unwrap_or("");
        printable(line, SHOWN)
    }

    /// The source line under its number with a caret below the span: three lines.
    pub fn snippet(&self, span: Range<usize>) -> String {
        let Position { line, column } = self.position(span.start);
        let text = self.line(span.start);
        // A long line is shown from a little before the caret, so that the caret is on the screen.
        let first = if column > SHOWN * 3 / 4 { column - SHOWN / 2 } else { 1 };
        let shown: String = text.chars().skip(first - 1).collect();
        let shown = printable(&shown, SHOWN);
        let end = self.boundary(span.end.max(span.start));
        let start = self.boundary(span.start);
        let marked = self.text[start..end].lines().next().map_or(0, |marked| marked.chars().count());
        let carets = "^".repeat(marked.clamp(1, (SHOWN + first).saturating_sub(column).max(1)));
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        let indent = " ".repeat(column - first);
        format!("{margin} |\n{number} | {shown}\n{margin} | {indent}{carets}")
    }
}

/// A name as part of a file name: lower case, `-` for everything but letters and digits.
pub fn slug(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect()
}

/// A text fit for a terminal: each control character as one `?`-like mark, cut with an ellipsis at `longest`
/// characters.
pub fn printable(text: &str, longest: usize) -> String {
    let visible = |c: char| match c {
        '\t' => ' ',
        c if c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}') => '\u{fffd}',
        c => c,
    };
    let mut shown: String = text.chars().take(longest).map(visible).collect();
    if text.chars().nth(longest).is_some() {
        shown.push('…');
    }
    shown
}

#[cfg(test)]
mod tests {
    use crate::machine_file::source::*;

    #[test]
    fn positions_count_characters_not_bytes() {
        let source = Source { name: "m.toml", text: "a = 1\nµ² = x\n" };
        let offset = source.text.find('x').unwrap();
        assert_eq!(source.position(offset), Position { line: 2, column: 6 });
        assert_eq!(source.line(offset), "µ² = x");
        assert_eq!(source.snippet(offset..offset + 1), "  |\n2 | µ² = x\n  |      ^");
    }

    #[test]
    fn any_offset_has_a_position_and_a_snippet() {
        let source = Source { name: "m.toml", text: "é\r\n\tü" };
        for start in 0..12 {
            for end in 0..12 {
                source.position(start);
                source.excerpt(start..end);
                assert_eq!(source.snippet(start..end).lines().count(), 3);
            }
        }
    }

    #[test]
    fn a_long_line_is_cut_round_the_caret() {
        let text = format!("{}x{}", " ".repeat(5_000), "y".repeat(5_000));
        let source = Source { name: "m.toml", text: &text };
        let snippet = source.snippet(5_000..5_001);
        assert!(snippet.lines().all(|line| line.chars().count() < 120), "{snippet}");
        let lines: Vec<Vec<char>> = snippet.lines().map(|line| line.chars().collect()).collect();
        let caret = lines[2].iter().position(|&c| c == '^').unwrap();
        assert_eq!(lines[1][caret], 'x');
    }
}
