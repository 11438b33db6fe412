//! Damage to text files, the same on every machine.

/// Pieces that have meant trouble to readers of these formats.
const PIECES: [&str; 48] = [
    "f",
    "v",
    "vn",
    "vt",
    "usemtl",
    "mtllib",
    "newmtl",
    "o",
    "g",
    "l",
    "p",
    "#",
    "\\",
    "\\\n",
    "\r",
    "\r\n",
    "\n",
    "\t",
    " ",
    "0",
    "-1",
    "1",
    "99999999999999999999",
    "-9223372036854775808",
    "1e400",
    "nan",
    "-inf",
    "1,5",
    "0x1",
    "1.#IND",
    "//",
    "/",
    "1/",
    "1//1",
    "1/1/1/1",
    "f 1 2 3 4 5 6 7 8",
    "Kd",
    "Kd 0.5",
    "d -halo",
    "illum 6.0",
    "Tf",
    "map_Kd",
    "\u{feff}",
    "\u{a0}",
    "\u{2028}",
    "Gr\u{fc}n",
    "\0",
    "\"",
];

/// A small generator (xorshift): the same files on every machine.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % end.max(1)
    }

    /// Some of the bytes are changed, moved, doubled or left out.
    pub(crate) fn damage(&mut self, text: &[u8]) -> Vec<u8> {
        let mut text = text.to_vec();
        for _ in 0..1 + self.below(4) {
            let at = self.below(text.len());
            let most = if self.below(4) == 0 { 60 } else { 3 };
            let end = (at + 1 + self.below(most)).min(text.len());
            match self.below(8) {
                0 => drop(text.drain(at..end)),
                1 => text.truncate(at),
                2 => {
                    let piece = text[at..end].to_vec();
                    let to = self.below(text.len());
                    text.splice(to..to, piece);
                }
                3 if !text.is_empty() => text[at] = self.below(256) as u8,
                4 if !text.is_empty() => text[at] = b"0123456789-+.eE,/ \n"[self.below(19)],
                5 => {
                    let line =
                        text.iter().skip(at).position(|byte| *byte == b'\n').map_or(text.len(), |n| at + n);
                    drop(text.drain(at..line));
                }
                _ => {
                    let piece = PIECES[self.below(PIECES.len())].bytes();
                    text.splice(at..at, piece);
                }
            }
        }
        text
    }
}
