//! The null space of a matrix of potentials: constants, and linear functions whose velocities cancel.

use super::vector::{GridVector, Layout};

/// Linear functions of position, one per potential, on which a matrix is zero.
#[derive(Clone, Debug)]
pub struct NullSpace {
    components: usize,
    /// Of each function and potential: constant, slope along x, slope along y.
    functions: Vec<[[f64; 3]; 2]>,
}

impl NullSpace {
    /// The constants of each of `components` potentials (1 or 2), and `linear` functions besides.
    pub fn new(components: usize, linear: Vec<[[f64; 3]; 2]>) -> Self {
        let (one, none) = ([1.0, 0.0, 0.0], [0.0; 3]);
        let mut functions = [[one, none], [none, one]][..components].to_vec();
        functions.extend(linear);
        Self { components, functions }
    }

    /// Potentials.
    pub fn components(&self) -> usize {
        self.components
    }

    /// An orthonormal basis of the coefficients of these functions on a grid with such cells.
    pub fn vectors(&self, layout: Layout, cell: [f64; 2]) -> Vec<GridVector<f64>> {
        let [nx, ny] = layout.nodes;
        let mut vectors: Vec<GridVector<f64>> = Vec::new();
        for function in &self.functions {
            let mut vector = GridVector::zero(layout, self.components);
            for (component, [constant, along_x, along_y]) in function[..self.components].iter().enumerate() {
                for (y, x) in (0..ny).flat_map(|y| (0..nx).map(move |x| (y, x))) {
                    // The linear function x has the coefficients (i - 1) h.
                    let place = [(x as f64 - 1.0) * cell[0], (y as f64 - 1.0) * cell[1]];
                    vector.set(component, x, y, constant + along_x * place[0] + along_y * place[1]);
                }
            }
            for other in &vectors {
                let share = vector.dot(other);
                vector.combine(1.0, -share, other);
            }
            let norm = vector.dot(&vector).sqrt();
            vector.combine(1.0 / norm, 0.0, &vector.clone());
            vectors.push(vector);
        }
        vectors
    }
}
