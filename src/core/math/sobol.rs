//! A scrambled low-discrepancy sequence in the unit square.

/// Point `index` of the first two dimensions of Sobol's sequence, Owen-scrambled by hashing with `seed`, in [0, 1)^2.
///
/// Every 2^k consecutive points from a multiple of 2^k are a (0, k, 2)-net: one in each of the 2^k boxes of any
/// dyadic shape. Burley, *Practical Hash-based Owen Scrambling*, JCGT 9(4), 2020.
pub fn scrambled(index: u32, seed: u32) -> [f64; 2] {
    let first = index.reverse_bits();
    let mut second = 0;
    let (mut rest, mut direction) = (index, 1_u32 << 31);
    while rest != 0 {
        second ^= direction * (rest & 1);
        direction ^= direction >> 1;
        rest >>= 1;
    }
    let unit = |x: u32| f64::from(x) / 4_294_967_296.0;
    [unit(scramble(first, hash(seed))), unit(scramble(second, hash(seed ^ 0x5bd1_e995)))]
}

/// Nested uniform scrambling: each bit is flipped or not by a hash of the bits above it.
fn scramble(x: u32, seed: u32) -> u32 {
    // Laine and Karras 2011, constants of Burley: lower bits influence higher ones only, hence the reversals.
    let mut x = x.reverse_bits().wrapping_add(seed);
    for factor in [0x6c50_b47c_u32, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6] {
        x ^= x.wrapping_mul(factor);
    }
    x.reverse_bits()
}

/// Finalizer of MurmurHash3.
fn hash(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
    x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dyadic_box_holds_one_point() {
        for (seed, first) in [(0, 0), (1, 256), (77, 1 << 20)] {
            for columns in [1_u32, 4, 16, 64, 256] {
                let rows = 256 / columns;
                let mut held = [0; 256];
                for i in 0..256 {
                    let [x, y] = scrambled(first + i, seed);
                    held[((y * f64::from(rows)) as u32 * columns + (x * f64::from(columns)) as u32)
                        as usize] += 1;
                }
                assert_eq!(held, [1; 256], "{columns} columns");
            }
        }
    }
}
