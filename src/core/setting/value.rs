//! The types that hold a setting's value: a number, several, or one that may be absent.

use std::fmt::Display;

/// A number that a project may hold.
pub trait Number: Copy + Display {
    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
    /// The number; whole ones beyond 2^53 are rounded.
    fn to_f64(self) -> f64;
}

/// What holds a setting's value.
pub trait Value: Copy {
    /// Its components.
    type Number: Number;
    /// The value of these components.
    fn from_numbers(numbers: &[f64]) -> Self;
    /// Its components; none where it is absent.
    fn numbers(&self) -> &[Self::Number];
}

macro_rules! number {
    ($($number:ty),+) => {$(
        impl Number for $number {
            fn from_f64(value: f64) -> Self {
                value as Self
            }

            #[allow(clippy::cast_lossless, reason = "one macro for all numbers")]
            fn to_f64(self) -> f64 {
                self as f64
            }
        }

        impl Value for $number {
            type Number = Self;

            fn from_numbers(numbers: &[f64]) -> Self {
                Self::from_f64(numbers.first().copied().unwrap_or_default())
            }

            fn numbers(&self) -> &[Self] {
                std::slice::from_ref(self)
            }
        }
    )+};
}
number!(f32, f64, u8, u32, u64, i32);

impl<N: Number, const COUNT: usize> Value for [N; COUNT] {
    type Number = N;

    fn from_numbers(numbers: &[f64]) -> Self {
        std::array::from_fn(|i| N::from_f64(numbers.get(i).copied().unwrap_or_default()))
    }

    fn numbers(&self) -> &[N] {
        self
    }
}

impl<V: Value> Value for Option<V> {
    type Number = V::Number;

    fn from_numbers(numbers: &[f64]) -> Self {
        (!numbers.is_empty()).then(|| V::from_numbers(numbers))
    }

    fn numbers(&self) -> &[V::Number] {
        self.as_ref().map_or(&[], V::numbers)
    }
}
