//! Reads what `fit` writes, for the tests that judge it.

use std::fs::File;
use std::path::Path;

/// Step by step, then photon by photon.
pub(crate) fn read<T: From<[f32; N]>, const N: usize>(path: &Path) -> Vec<Vec<T>> {
    let file = npyz::NpyFile::new(File::open(path).unwrap()).unwrap();
    let photons = file.shape()[1] as usize;
    let numbers = file.into_vec::<f32>().unwrap();
    let (places, _) = numbers.as_chunks::<N>();
    places.chunks(photons).map(|step| step.iter().map(|numbers| T::from(*numbers)).collect()).collect()
}
