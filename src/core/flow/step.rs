//! One Runge-Kutta step: the velocity at its three times, and the cubic of each photon's guidance over it.

use std::array::from_fn;

use glam::Vec2;

use super::fade::ease;
use super::field::Field;
use super::guidance::position;

/// Photons per parallel task: fits the L1 cache beside the coefficients around them.
pub(super) const CHUNK: usize = 2048;

/// The step from `start` to `start + length`: field and fade at the three times of RK4. The fields are blended in time once
/// per step, so that a photon evaluates one field instead of two.
pub(super) struct Step {
    /// Number of the step, from 0.
    pub number: usize,
    /// Number of steps after this one.
    pub left: usize,
    /// Time at the begin.
    pub start: f64,
    /// Duration.
    pub length: f64,
    /// The velocities at begin, middle and end; none once the fade has ended and all photons go straight.
    pub velocities: Option<[StageVelocity; 3]>,
    /// (1-s)/(1-t) at those times, the weight in v' = rate (v - u).
    pub rates: [f32; 3],
}

/// The velocity at one of the three times of RK4.
pub(super) struct StageVelocity {
    /// The fitted field, extrapolated to this time.
    pub field: Field,
    /// The turbulence at this time, one field per noise grid.
    pub noise: Vec<Field>,
}

impl StageVelocity {
    /// The velocity u at `p`, in plane units per unit of t.
    #[inline(always)]
    pub(super) fn velocity(&self, p: Vec2) -> Vec2 {
        let [velocity] = self.velocities([p]);
        velocity
    }

    /// As [`Self::velocity`] at N points.
    #[inline(always)]
    pub(super) fn velocities<const N: usize>(&self, p: [Vec2; N]) -> [Vec2; N] {
        self.fitted_and_all(p).1
    }

    /// The velocities of the fitted field alone, and with the turbulence, at N points.
    #[inline(always)]
    pub(super) fn fitted_and_all<const N: usize>(&self, p: [Vec2; N]) -> ([Vec2; N], [Vec2; N]) {
        let fitted = self.field.velocities(p);
        let mut all = fitted;
        for noise in &self.noise {
            let swirls = noise.velocities(p);
            (0..N).for_each(|i| all[i] += swirls[i]);
        }
        (fitted, all)
    }
}

impl Step {
    /// Time at its end.
    pub(super) fn end(&self) -> f64 {
        self.start + self.length
    }

    /// The cubics v(x) = v + x (k0 + x (k1 + x k2)), x in 0..=1, of N photons with guidance `v`: the continuous extension of
    /// order 3 of classical RK4 (Hairer, Norsett, Wanner, *Solving Ordinary Differential Equations I*, II.6), without a
    /// fifth evaluation. `inverse_speed_limits` are one over the speeds at which the photons leave the field.
    #[inline(always)]
    pub(super) fn curves<const N: usize>(
        &self,
        targets: [Vec2; N],
        v: [Vec2; N],
        inverse_speed_limits: [f32; N],
    ) -> [[Vec2; 3]; N] {
        let Some([begin, middle, end]) = &self.velocities else {
            return [[Vec2::ZERO; 3]; N];
        };
        let (t, h) = (self.start as f32, self.length as f32);
        let slopes = |stage: &StageVelocity, rate: f32, v: [Vec2; N], t: f32| -> [Vec2; N] {
            let at: [Vec2; N] = from_fn(|i| position(targets[i], v[i], t));
            let (fitted, u) = stage.fitted_and_all(at);
            let speed = |i: usize| v[i].length_squared().max(fitted[i].length_squared()).sqrt();
            from_fn(|i| (v[i] - u[i]) * (h * rate * ease(speed(i) * inverse_speed_limits[i])))
        };
        let rates = self.rates;
        let k1 = slopes(begin, rates[0], v, t);
        let k2 = slopes(middle, rates[1], from_fn(|i| v[i] + 0.5 * k1[i]), t + 0.5 * h);
        let k3 = slopes(middle, rates[1], from_fn(|i| v[i] + 0.5 * k2[i]), t + 0.5 * h);
        let k4 = slopes(end, rates[2], from_fn(|i| v[i] + k3[i]), t + h);
        from_fn(|i| {
            let (k1, k2, k3, k4) = (k1[i], k2[i], k3[i], k4[i]);
            [k1, k2 + k3 - 1.5 * k1 - 0.5 * k4, (2.0 / 3.0) * (k1 - k2 - k3 + k4)]
        })
    }

    /// The cubic of one photon.
    #[inline(always)]
    pub(super) fn curve(&self, target: Vec2, v: Vec2, inverse_limit: f32) -> [Vec2; 3] {
        let [curve] = self.curves([target], [v], [inverse_limit]);
        curve
    }
}
