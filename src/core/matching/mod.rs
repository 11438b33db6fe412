//! The bijection between source and target (Sec. 3).
