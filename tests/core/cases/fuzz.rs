//! Damaged OBJ and MTL files: each gives a scene or an error that names the file. `LIGHTLOOM_FUZZ=100000` sets how many
//! are tried; the slowest is printed.

use std::time::{Duration, Instant};

use super::{GLASS, ball};
use crate::scenes::Stage;

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
    fn damage(&mut self, text: &[u8]) -> Vec<u8> {
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

#[test]
fn damaged_meshes_and_materials_are_read_or_refused() {
    let rounds = std::env::var("LIGHTLOOM_FUZZ").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(1000);
    let seeds = [
        format!("mtllib a.mtl\nusemtl Glass\n{}", ball().lines().take(340).collect::<Vec<_>>().join("\n")),
        "mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv .2 0 .8\nv 0 0 1\nvn 0 1 0\nvt 0 0\nusemtl Glass\nf 1//1 2//1 3//1 4 \\\n5//1\nusemtl M #2\nf -1/1 -2/1 -3/1/1\nf 1 2 3 4\n".into(),
        format!("o all\n{}f {}\n", (0..60).map(|i| format!("v {} 0 {}\n", i % 7, i % 11)).collect::<String>(), (1..=60).map(|i| format!("{i} ")).collect::<String>()),
    ];
    let library = format!(
        "# a\n{GLASS}newmtl M #2\nKd 0.5\nTf 0.5 0.5 0.5\nd -halo 0.2\nTr 0.8\nNi 1.5\nmap_Kd a.png\n"
    );
    let mut stage = Stage::new();
    stage.mesh("mesh", "", None);
    let mut random = Random::new(0x9e37_79b9_7f4a_7c15);
    let (mut read, mut slowest) = (0, (Duration::ZERO, 0));
    for round in 0..rounds {
        let seed = random.below(seeds.len());
        let mesh = random.damage(seeds[seed].as_bytes());
        stage.file("mesh.obj", &mesh);
        stage.file("a.mtl", random.damage(library.as_bytes()));
        let start = Instant::now();
        match stage.try_load() {
            Ok(_) => read += 1,
            Err(error) => assert!(error.to_string().contains("mesh.obj"), "round {round}: {error}"),
        }
        slowest = slowest.max((start.elapsed(), round));
    }
    println!(
        "{rounds} files: {read} read, {} refused; the slowest, of round {}, took {:?}",
        rounds - read,
        slowest.1,
        slowest.0
    );
    // Neither all damage nor none is fatal.
    assert!(read > rounds / 20 && read < rounds, "{read} of {rounds}");
}
