//! Damage to files: bytes, digits, lines and numbers, from a fixed seed.

/// A generator of numbers (xorshift*).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11
    }

    /// A number from 0 to below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

const BYTES: &[u8] = b"0123456789,;-+.DEH SGPT\n";
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1",
    "2",
    "3",
    "7",
    "1E300",
    "-1D-300",
    "99999999",
    "2147483647",
    "1H",
    "nan",
    "144",
    "128",
    "126",
    "124",
    "102",
    "120",
    "118",
    "402",
    "1E9",
    "0.5",
];

/// The file with one to six places damaged.
pub fn mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(6) {
        if bytes.is_empty() {
            break;
        }
        let at = random.below(bytes.len());
        match random.below(12) {
            0 => bytes[at] = random.below(256) as u8,
            1..=3 => bytes[at] = BYTES[random.below(BYTES.len())],
            4 if random.below(4) == 0 => bytes.truncate(at),
            4..=7 => bytes = lines(&bytes, random),
            _ => number(&mut bytes, at, random),
        }
    }
    bytes
}

fn lines(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<Vec<u8>> = bytes.split(|c| *c == b'\n').map(<[u8]>::to_vec).collect();
    let (a, b) = (random.below(lines.len()), random.below(lines.len()));
    let column = random.below(lines[a].len() + 1);
    match random.below(5) {
        0 => drop(lines.remove(a)),
        1 => lines.insert(b, lines[a].clone()),
        2 => lines.swap(a, b),
        3 => lines[a].truncate(column),
        _ => lines[a].insert(column, b" 9,;"[random.below(4)]),
    }
    lines.join(&b'\n')
}

/// Replaces the next number; its columns are kept half of the time.
fn number(bytes: &mut Vec<u8>, at: usize, random: &mut Random) {
    let Some(from) = bytes[at..].iter().position(u8::is_ascii_digit).map(|n| at + n) else { return };
    let len = bytes[from..].iter().take_while(|c| c.is_ascii_digit() || **c == b'.').count();
    let mut new = NUMBERS[random.below(NUMBERS.len())].as_bytes().to_vec();
    if random.below(2) == 0 && new.len() < len {
        new.resize(len, b' ');
    }
    bytes.splice(from..from + len, new);
}
