//! Makes the meshes and pictures in `assets/` from formulas: `cargo run --release -p lightloom_assets`.

fn main() {}
