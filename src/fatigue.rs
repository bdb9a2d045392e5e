//! Shakedown and multiaxial fatigue of a history of stresses.
//!
//! A point of a body that rolls or slides along y sees, one after the other, the stresses on the line through it along
//! y. A history is a list of such states, each with the components of [`Stress`](crate::Stress) in their order. It is
//! taken as it stands: the stress-free state far away belongs to it only if it is given.
//!
//! With the deviator s of a state and a basis of deviators that keeps |s|² = s:s,
//!
//! ```text
//! d = [(σyy + σxx − 2σzz)/√6, (σyy − σxx)/√2, √2 σyz, √2 σxz, √2 σxy]
//! ```
//!
//! one routine, the smallest ball that encloses points, serves all: in three dimensions [`shakedown()`], in five the
//! criteria of Dang Van and of Crossland, in two the amplitude of the shear stress on a plane, of Findley and Matake.

use crate::error::{Error, Result};
use crate::numerics::enclosing_ball::smallest_ball;

mod criterion;
mod planes;

pub use criterion::{Criterion, CriterionKind, Equivalent};

/// A state of stress: σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz \[Pa\].
pub type State = [f64; 6];

/// Condition of yield of a perfectly plastic material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum YieldRule {
    /// √J₂ ≤ k.
    #[default]
    VonMises,
    /// √{¼ (σ_yy − σ_zz)² + σ_yz²} ≤ k: Tresca's condition for the plane of rolling alone, behind the limit 1/μ at the
    /// surface of the classical map.
    InPlaneTresca,
}

/// What a perfectly plastic material needs to shake down under a history.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Shakedown {
    /// The smallest yield stress in shear k with which it does \[Pa\].
    pub shear_yield: f64,
    /// Residual stresses r_x, r_y that make it possible \[Pa\]; for [`YieldRule::InPlaneTresca`] r_x is 0.
    pub residual: [f64; 2],
    /// The smallest yield stress in shear with which nothing yields without them \[Pa\].
    pub first_yield: f64,
    /// Index of a state that decides the first, and of the one that decides the second.
    pub at: [usize; 2],
}

/// The smallest yield stress with which residual stresses r_x, r_y that do not change with time keep all states of
/// `history` elastic, by Melan's theorem.
///
/// ```text
/// k = min over (r_x, r_y) of max over t of √J₂(σ(t) + diag(r_x, r_y, 0))
/// ```
///
/// In a line contact these are all the residual stresses that are in equilibrium. r moves d₁ and d₂ freely, so
/// that k = R/√2 with the radius R of the smallest ball around the points (d₁, d₂, ±√(d₃² + d₄² + d₅²)), which
/// mirror each other (derived here). With [`YieldRule::InPlaneTresca`], k is the radius of the smallest circle around the points
/// (½(σ_yy − σ_zz), ±σ_yz). Melan, Ing.-Arch. 9 (1938) 116, doi:10.1007/BF02084409.
///
/// # Errors
/// No state, or one that is not finite.
///
/// ```
/// use nacre::fatigue::{YieldRule, shakedown};
/// // A shear stress that is reversed leaves nothing to residual stresses; a pull from 0 to 1 is halved by them.
/// let reversed = [[0.0, 0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0, -1.0, 0.0]];
/// assert!((shakedown(&reversed, YieldRule::VonMises)?.shear_yield - 1.0).abs() < 1e-15);
/// let pulled = [[0.0; 6], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]];
/// let found = shakedown(&pulled, YieldRule::VonMises)?;
/// assert!((found.first_yield / found.shear_yield - 2.0).abs() < 1e-15);
/// assert!((found.residual[1] + 0.5).abs() < 1e-15);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn shakedown(history: &[State], rule: YieldRule) -> Result<Shakedown> {
    check(history)?;
    Ok(match rule {
        YieldRule::VonMises => {
            let points: Vec<[f64; 3]> = history
                .iter()
                .map(|state| {
                    let [a, b, rest @ ..] = deviator(state);
                    [a, b, norm(&rest)]
                })
                .collect();
            let scale = std::f64::consts::FRAC_1_SQRT_2;
            let ball = mirrored_ball(&points, scale);
            let [a, b, _] = ball.centre;
            let [one, other] = [6.0_f64.sqrt() * a, 2.0_f64.sqrt() * b];
            ball.with([0.5 * (other - one), -0.5 * (one + other)])
        }
        YieldRule::InPlaneTresca => {
            let point = |state: &State| [0.5 * (state[1] - state[2]), state[4].abs()];
            let points: Vec<[f64; 2]> = history.iter().map(point).collect();
            let ball = mirrored_ball(&points, 1.0);
            ball.with([0.0, -2.0 * ball.centre[0]])
        }
    })
}

/// The smallest ball of points and their mirror images in the last coordinate.
struct MirroredBall<const N: usize> {
    centre: [f64; N],
    radius: f64,
    largest: f64,
    at: [usize; 2],
}

impl<const N: usize> MirroredBall<N> {
    fn with(&self, residual: [f64; 2]) -> Shakedown {
        Shakedown { shear_yield: self.radius, residual, first_yield: self.largest, at: self.at }
    }
}

fn mirrored_ball<const N: usize>(points: &[[f64; N]], scale: f64) -> MirroredBall<N> {
    let image = |point: &[f64; N]| {
        let mut image = *point;
        image[N - 1] = -image[N - 1];
        image
    };
    let both: Vec<[f64; N]> = points.iter().copied().chain(points.iter().map(image)).collect();
    let ball = smallest_ball(&both);
    let far = |at: &usize| norm(&points[*at]);
    let largest = |numbers: &mut dyn Iterator<Item = usize>| {
        numbers.fold(0, |best, next| if far(&next) > far(&best) { next } else { best })
    };
    let support = ball.support.iter().map(|k| k % points.len());
    let decides = support.reduce(|best, next| if far(&next) > far(&best) { next } else { best });
    let first = largest(&mut (0..points.len()));
    MirroredBall {
        centre: ball.centre,
        radius: scale * ball.radius,
        largest: scale * far(&first),
        at: [decides.unwrap_or(0), first],
    }
}

/// Coordinates of the deviator of a state, of the length √(s:s).
fn deviator([xx, yy, zz, xy, yz, xz]: &State) -> [f64; 5] {
    let root = 2.0_f64.sqrt();
    [(yy + xx - 2.0 * zz) / 6.0_f64.sqrt(), (yy - xx) / root, root * yz, root * xz, root * xy]
}

/// The deviator of these coordinates.
fn from_coordinates([a, b, yz, xz, xy]: &[f64; 5]) -> State {
    let (a, b, root) = (a / 6.0_f64.sqrt(), b / 2.0_f64.sqrt(), 2.0_f64.sqrt());
    [a - b, a + b, -2.0 * a, xy / root, yz / root, xz / root]
}

fn hydrostatic(state: &State) -> f64 {
    (state[0] + state[1] + state[2]) / 3.0
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Index and value of the largest number, the first of several.
fn largest(values: impl Iterator<Item = f64>) -> (usize, f64) {
    let first = (0, f64::NEG_INFINITY);
    values.enumerate().fold(first, |best, next| if next.1 > best.1 { next } else { best })
}

/// Refuses a history without states, and one that is not finite.
fn check(history: &[State]) -> Result<()> {
    if history.is_empty() {
        return Err(Error::Inconsistent("history must hold at least one state, got none"));
    }
    for (number, state) in history.iter().enumerate() {
        if let Some(component) = state.iter().position(|value| !value.is_finite()) {
            return Err(Error::NonFinite { name: "history", index: [number, component] });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{State, YieldRule, deviator, from_coordinates, norm, shakedown};

    const STATES: [State; 4] = [
        [1.0, -2.0, 0.5, 0.3, -0.7, 0.2],
        [0.1, 1.4, -0.6, -0.2, 0.9, 0.4],
        [-1.3, 0.2, 0.8, 0.5, 0.1, -0.6],
        [0.0; 6],
    ];

    /// The coordinates keep the norm, and give the deviator back.
    #[test]
    fn coordinates_of_deviators() {
        for state in &STATES {
            let d = deviator(state);
            let back = from_coordinates(&d);
            let mean = super::hydrostatic(state);
            for k in 0..6 {
                let own = state[k] - if k < 3 { mean } else { 0.0 };
                assert!((back[k] - own).abs() < 1e-15);
            }
            let twice: f64 =
                (0..6).map(|k| if k < 3 { 1.0 } else { 2.0 } * back[k] * back[k]).sum();
            assert!((twice.sqrt() - norm(&d)).abs() < 1e-15);
        }
    }

    /// With the residual stresses that were found, first yield is the limit, and no others are better.
    #[test]
    fn the_residual_stresses_are_the_best() -> crate::Result<()> {
        for rule in [YieldRule::VonMises, YieldRule::InPlaneTresca] {
            let limit = shakedown(&STATES, rule)?;
            let with = |[x, y]: [f64; 2]| {
                let moved = STATES.map(|s| [s[0] + x, s[1] + y, s[2], s[3], s[4], s[5]]);
                shakedown(&moved, rule)
            };
            let best = with(limit.residual)?;
            assert!((best.first_yield / limit.shear_yield - 1.0).abs() < 1e-14);
            assert!((best.shear_yield / limit.shear_yield - 1.0).abs() < 1e-14);
            for [x, y] in
                [[0.1, 0.0], [-0.1, 0.0], [0.0, 0.1], [0.0, -0.1], [0.1, 0.1], [0.1, -0.1]]
            {
                let other = with([limit.residual[0] + x, limit.residual[1] + y])?;
                assert!(other.first_yield > limit.shear_yield * (1.0 - 1e-14));
            }
        }
        Ok(())
    }
}
