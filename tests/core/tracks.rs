//! Reads what `fit` writes, for the tests that judge it.

use std::path::Path;

use lightloom_core::files::npy;

/// Step by step, then photon by photon.
pub(crate) fn read<T: From<[f32; N]>, const N: usize>(path: &Path) -> Vec<Vec<T>> {
    let (header, numbers) = npy::parse(&std::fs::read(path).unwrap()).unwrap();
    let photons = header.shape[1] as usize;
    let (places, _) = numbers.as_chunks::<N>();
    places.chunks(photons).map(|step| step.iter().map(|numbers| T::from(*numbers)).collect()).collect()
}
