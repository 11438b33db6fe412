//! A sitting rabbit, cast in glass.

use glam::DVec3;

use crate::field::{Ellipsoid, carve, join};
use crate::mesh::Mesh;
use crate::polygonise::polygonise;

const METRES: f64 = 0.01;
const CELL: f64 = 0.135;

/// The mesh in metres, standing on y = 0 and looking along x.
pub(crate) fn mesh() -> Mesh {
    let rabbit = Rabbit::new();
    let mut mesh =
        polygonise(|p| rabbit.at(p), DVec3::new(-6.5, -0.5, -4.0), DVec3::new(6.5, 14.5, 4.0), CELL);
    mesh.positions.iter_mut().for_each(|p| *p *= METRES);
    mesh.standing()
}

/// The figure, in centimetres: a part is an ellipsoid and the radius over which it melts into the parts before it.
struct Rabbit {
    parts: Vec<(Ellipsoid, f64)>,
    hollows: Vec<(Ellipsoid, f64)>,
}

impl Rabbit {
    fn new() -> Self {
        let one = |centre, radii, turn, radius| vec![(Ellipsoid::new(centre, radii, turn), radius)];
        let pair = |centre, radii, turn, radius| {
            let left = Ellipsoid::new(centre, radii, turn);
            vec![(left, radius), (left.mirrored(), radius)]
        };
        let level = [0.0; 3];
        let parts = [
            one([-1.2, 3.4, 0.0], [3.6, 3.2, 2.9], [0.0, 0.0, 22.0], 0.3), // body
            one([1.1, 4.3, 0.0], [2.0, 2.9, 2.0], [0.0, 0.0, 12.0], 0.5),  // chest
            pair([-1.6, 2.25, 2.0], [2.5, 2.1, 1.25], [0.0, 0.0, 20.0], 0.13), // haunches
            pair([0.3, 0.55, 2.1], [1.9, 0.62, 0.8], [0.0, -8.0, 0.0], 0.22), // hind feet
            pair([2.15, 2.2, 0.85], [0.75, 2.2, 0.72], [0.0, 0.0, -4.0], 0.2), // forelegs
            pair([2.75, 0.5, 0.9], [1.05, 0.55, 0.66], [0.0, -6.0, 0.0], 0.16), // forepaws
            one([2.1, 7.7, 0.0], [2.2, 1.95, 1.9], [0.0, 0.0, -12.0], 0.26), // head
            pair([3.0, 6.95, 0.8], [1.15, 1.05, 1.0], level, 0.2),         // cheeks
            one([3.7, 7.05, 0.0], [0.9, 0.9, 0.95], [0.0, 0.0, -14.0], 0.2), // muzzle
            one([4.55, 7.42, 0.0], [0.26, 0.22, 0.34], level, 0.06),       // nose
            pair([3.1, 8.3, 1.5], [0.38, 0.4, 0.3], level, 0.05),          // eyes
            pair([0.6, 11.1, 1.32], [0.6, 2.75, 0.95], [15.0, -28.0, 17.0], 0.13), // ears
            one([-4.7, 2.5, 0.0], [1.25, 1.15, 1.2], level, 0.15),         // tail
        ];
        let hollows = pair([1.14, 11.35, 1.58], [0.5, 2.1, 0.54], [15.0, -28.0, 17.0], 0.1);
        Self { parts: parts.concat(), hollows }
    }

    /// Negative inside. The ground plane is cut off last, so that the figure stands on a flat base.
    fn at(&self, p: DVec3) -> f64 {
        let body = self.parts.iter().fold(f64::MAX, |body, (part, radius)| join(body, part.at(p), *radius));
        let open =
            self.hollows.iter().fold(body, |body, (hollow, radius)| carve(body, hollow.at(p), *radius));
        carve(open, p.y, 0.06)
    }
}
