//! What the program asks of the processor, told in words before the first instruction that an older one would not know.

/// What this processor has not and the program needs; none where it has all.
#[cfg(target_arch = "x86_64")]
pub fn missing() -> Option<&'static str> {
    use std::arch::x86_64::__cpuid;
    // Bits of CPUID (Intel's and AMD's manuals); the compiler takes all of them for granted, so that std's own check says yes.
    const FMA: u32 = 1 << 12;
    const AVX: u32 = 1 << 28;
    const F16C: u32 = 1 << 29;
    const AVX2: u32 = 1 << 5;
    const BMI1: u32 = 1 << 3;
    const BMI2: u32 = 1 << 8;
    const LZCNT: u32 = 1 << 5;
    const EXTENDED: u32 = 0x8000_0000;
    let leaf = |number: u32| {
        let highest = __cpuid(number & EXTENDED).eax;
        (number <= highest).then(|| __cpuid(number))
    };
    let has = |register: Option<u32>, bits: u32| register.is_some_and(|value| value & bits == bits);
    let complete = has(leaf(1).map(|leaf| leaf.ecx), FMA | AVX | F16C)
        && has(leaf(7).map(|leaf| leaf.ebx), AVX2 | BMI1 | BMI2)
        && has(leaf(EXTENDED | 1).map(|leaf| leaf.ecx), LZCNT);
    (!complete).then_some("AVX2 and FMA (Intel since 2013, AMD since 2015)")
}

/// Nothing is asked for of other processors.
#[cfg(not(target_arch = "x86_64"))]
pub fn missing() -> Option<&'static str> {
    None
}
