//! Lines of JSON without the formatting machinery, which could panic.

/// A line of JSON under construction: one object, at most [`Line::LONGEST`] bytes, then cut off.
pub struct Line {
    bytes: [u8; Line::LONGEST],
    length: usize,
}

impl Line {
    /// Bytes that a line can hold.
    pub const LONGEST: usize = 320;

    /// An object without members.
    pub const fn new() -> Self {
        let mut bytes = [0; Line::LONGEST];
        bytes[0] = b'{';
        Line { bytes, length: 1 }
    }

    /// Adds a member of text; the text may hold neither quotes nor backslashes.
    pub fn text(mut self, key: &str, value: &str) -> Self {
        self.key(key);
        self.push(b"\"");
        self.push(value.as_bytes());
        self.push(b"\"");
        self
    }

    /// Adds a member that is a number.
    pub fn number(mut self, key: &str, value: u32) -> Self {
        self.key(key);
        let mut divisor = 1_000_000_000_u32;
        let mut started = false;
        while divisor > 0 {
            let digit = value / divisor % 10;
            started |= digit != 0 || divisor == 1;
            if started {
                self.push(&[b'0' + digit as u8]);
            }
            divisor /= 10;
        }
        self
    }

    /// Adds a member that is a 64-bit number, as text of 16 hexadecimal digits.
    pub fn hex(mut self, key: &str, value: u64) -> Self {
        self.key(key);
        self.push(b"\"");
        for place in (0..16).rev() {
            let digit = (value >> (4 * place)) as u8 & 15;
            self.push(&[if digit < 10 { b'0' + digit } else { b'a' + digit - 10 }]);
        }
        self.push(b"\"");
        self
    }

    /// Closes the object; the bytes of the line with its end.
    pub fn finish(&mut self) -> &[u8] {
        self.push(b"}\n");
        self.bytes.get(..self.length).unwrap_or(&[])
    }

    #[inline(never)]
    fn key(&mut self, key: &str) {
        if self.length > 1 {
            self.push(b",");
        }
        self.push(b"\"");
        self.push(key.as_bytes());
        self.push(b"\":");
    }

    #[inline(never)]
    fn push(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(place) = self.bytes.get_mut(self.length) {
                *place = byte;
                self.length += 1;
            }
        }
    }
}

impl Default for Line {
    fn default() -> Self {
        Self::new()
    }
}
