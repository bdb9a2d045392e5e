//! Stresses on planes over a history, and the planes where they are largest.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{State, largest};
use crate::numerics::enclosing_ball::smallest_ball;

/// A plane, and its stresses over a history.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    pub(super) normal: [f64; 3],
    /// Amplitude τ_a: radius of the smallest circle around the path of the shear stress.
    pub(super) shear: f64,
    /// Largest normal stress, tension where it is positive.
    pub(super) tension: f64,
}

/// Number of planes that are tried at first, evenly spread: they are some 6° apart, as narrow as the maxima of histories
/// of contacts are wide at least (5° to 10° miss none of the reference's).
const TRIED: usize = 500;

/// Largest number of planes from which a search starts, and the angle between any two of them.
const STARTS: usize = 10;
const APART: f64 = 0.2;

/// Steps of a search [rad]: the distance of the planes tried; one at which maxima are told apart; and one whose square is
/// the rounding of a maximum.
const STEPS: [f64; 3] = [0.1, 1e-2, 3e-6];

/// Least gain of a step, over its square and the shear stress. The loss beside a maximum of cos 2θ is 2 θ², so that a search
/// goes on until the maximum is some half of a step away.
const GAIN: f64 = 0.1;

/// Largest number of times that a search looks around: it needs some 50 to a maximum. On a ridge that is flat, as two
/// principal stresses that are nearly equal make it, it may go on for long and gain nothing.
const POLLS: usize = 600;

/// Angle within which two maxima are one [rad]: some of the steps at which they are told apart.
const SAME: f64 = 0.05;

/// Part of the largest shear stress by which a maximum may be below the best one to be searched to the end. It is above
/// the gap that a warning tells.
const CLOSE: f64 = 0.03;

/// Part by which maxima of τ_a may differ to count as equal, as a plane and its conjugate do.
const TIE: f64 = 1e-6;

/// Number of equal maxima above which they lie on a curve: a plane, its conjugate and the mirror images of both are 4.
const ISOLATED: usize = 4;

/// A history, seen on planes.
pub(super) struct Planes<'a> {
    history: &'a [State],
    /// Shear stress that is rounding: 50 ε of the largest component.
    rounding: f64,
}

impl<'a> Planes<'a> {
    pub(super) fn new(history: &'a [State]) -> Self {
        let largest = history.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
        Self { history, rounding: 1e-14 * largest }
    }

    /// The plane of the largest τ_a + k σ_n.
    pub(super) fn findley(&self, factor: f64) -> Plane {
        let value = |plane: &Plane| plane.shear + factor * plane.tension;
        let maxima = self.maxima(&value);
        maxima
            .into_iter()
            .reduce(|a, b| if value(&b) > value(&a) { b } else { a })
            .unwrap_or(self.at(Z))
    }

    /// The plane of the largest τ_a, of equal ones that of the largest σ_n; and the part by which the next maximum of
    /// τ_a is below, 1 where there is none.
    pub(super) fn matake(&self) -> (Plane, f64) {
        let value = |plane: &Plane| plane.shear;
        let maxima = self.maxima(&value);
        let highest = maxima.iter().map(value).fold(0.0, f64::max);
        let least = highest * (1.0 - TIE) - self.rounding;
        let (equal, others): (Vec<Plane>, Vec<Plane>) =
            maxima.into_iter().partition(|plane| plane.shear >= least);
        let next = others.iter().map(value).fold(0.0, f64::max);
        let gap = if highest > self.rounding { 1.0 - next / highest } else { 1.0 };
        let is_curve = equal.len() > ISOLATED && highest > self.rounding;
        let greater = |a: Plane, b: Plane| if b.tension > a.tension { b } else { a };
        let best = equal.into_iter().reduce(greater).unwrap_or(self.at(Z));
        let best = if is_curve { self.slid(best, &|plane| plane.shear >= least) } else { best };
        (best, gap)
    }

    /// Index of the state with the largest normal stress on a plane.
    pub(super) fn largest_tension(&self, normal: &[f64; 3]) -> usize {
        largest(self.history.iter().map(|state| dot(&traction(state, normal), normal))).0
    }

    /// The plane with this normal.
    fn at(&self, normal: [f64; 3]) -> Plane {
        let [u, v] = tangents(&normal);
        let mut tension = f64::NEG_INFINITY;
        let path: Vec<[f64; 2]> = self
            .history
            .iter()
            .map(|state| {
                let traction = traction(state, &normal);
                tension = tension.max(dot(&traction, &normal));
                [dot(&traction, &u), dot(&traction, &v)]
            })
            .collect();
        Plane { normal, shear: smallest_ball(&path).radius, tension }
    }

    /// Local maxima of a value, from the best of the planes that are tried.
    fn maxima(&self, value: &impl Fn(&Plane) -> f64) -> Vec<Plane> {
        let mut tried: Vec<Plane> = (0..TRIED).map(|k| self.at(spread(k))).collect();
        tried.sort_by(|a, b| value(b).total_cmp(&value(a)));
        let mut starts: Vec<Plane> = Vec::new();
        for plane in tried {
            let near = |other: &Plane| dot(&other.normal, &plane.normal).abs() > APART.cos();
            if starts.len() < STARTS && !starts.iter().any(near) {
                starts.push(plane);
            }
        }
        let [first, second, last] = STEPS;
        let mut maxima: Vec<Plane> = Vec::new();
        for start in starts {
            let plane = self.climbed(start, [first, second], value);
            if !maxima.iter().any(|other| dot(&other.normal, &plane.normal).abs() > SAME.cos()) {
                maxima.push(plane);
            }
        }
        let highest = maxima.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
        let shear = maxima.iter().map(|plane| plane.shear).fold(0.0, f64::max);
        maxima.retain(|plane| value(plane) >= highest - CLOSE * shear - self.rounding);
        maxima.into_iter().map(|plane| self.climbed(plane, [second, last], value)).collect()
    }

    /// The maximum near a plane, by a search in directions that turn, which does not stop at a kink: six in turn, with
    /// a shorter step where none is better by [`GAIN`] times the square of the step, so that it does not creep along
    /// a ridge. Audet & Dennis (2006), doi:10.1137/040603371; Kolda, Lewis & Torczon (2003),
    /// doi:10.1137/S003614450242889, for the gain.
    fn climbed(
        &self,
        start: Plane,
        [mut step, end]: [f64; 2],
        value: &impl Fn(&Plane) -> f64,
    ) -> Plane {
        // The golden angle turns the directions evenly.
        let golden = PI * (3.0 - 5.0_f64.sqrt());
        let (mut best, mut turn) = (start, 0.0);
        for _ in 0..POLLS {
            if step <= end {
                break;
            }
            let beside =
                |k: u8| self.at(turned(&best.normal, step, turn + f64::from(k) * TAU / 6.0));
            let least = value(&best) + GAIN * step * step * start.shear + self.rounding;
            match (0..6).map(beside).find(|plane| value(plane) > least) {
                Some(better) => best = better,
                None => step *= 0.6,
            }
            turn += golden;
        }
        best
    }

    /// The plane of the largest tension among those that are connected with `best` and `count` as equal: it goes along
    /// their curve, back to the maximum of τ_a after each step.
    fn slid(&self, mut best: Plane, counts: &impl Fn(&Plane) -> bool) -> Plane {
        let mut step = APART;
        while step > STEPS[2].sqrt() {
            let beside = |k: u8| {
                let plane = self.at(turned(&best.normal, step, f64::from(k) * TAU / 12.0));
                self.climbed(plane, [0.3 * step, STEPS[2]], &|plane: &Plane| plane.shear)
            };
            let least = best.tension + GAIN * step * step * best.shear;
            let better = |plane: &Plane| counts(plane) && plane.tension > least;
            match (0..12).map(beside).find(better) {
                Some(better) => best = better,
                None => step *= 0.5,
            }
        }
        best
    }
}

const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Evenly spread unit vectors of a hemisphere, on a spiral of golden angles.
fn spread(k: usize) -> [f64; 3] {
    let z = (k as f64 + 0.5) / TRIED as f64;
    let angle = k as f64 * PI * (3.0 - 5.0_f64.sqrt());
    let r = (1.0 - z * z).sqrt();
    [r * angle.cos(), r * angle.sin(), z]
}

/// The stress vector on a plane.
fn traction([xx, yy, zz, xy, yz, xz]: &State, [x, y, z]: &[f64; 3]) -> [f64; 3] {
    [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
}

/// Two unit vectors that are normal to each other and to `normal`.
fn tangents(normal: &[f64; 3]) -> [[f64; 3]; 2] {
    let [x, y, z] = *normal;
    // The axis farthest from the normal.
    let axis = if x.abs() <= y.abs().min(z.abs()) {
        [1.0, 0.0, 0.0]
    } else if y.abs() <= z.abs() {
        [0.0, 1.0, 0.0]
    } else {
        Z
    };
    let u = unit(cross(normal, &axis));
    [u, cross(normal, &u)]
}

/// `normal` turned by an angle towards the tangent of the direction `towards`.
fn turned(normal: &[f64; 3], angle: f64, towards: f64) -> [f64; 3] {
    debug_assert!(angle < FRAC_PI_2);
    let [u, v] = tangents(normal);
    let (along, across) = (angle.sin() * towards.cos(), angle.sin() * towards.sin());
    unit(std::array::from_fn(|k| angle.cos() * normal[k] + along * u[k] + across * v[k]))
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = dot(&vector, &vector).sqrt();
    vector.map(|component| component / length)
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::{Planes, State, TRIED, spread};

    /// The planes that are tried leave no gap of more than 6° (0.105 rad).
    #[test]
    fn the_planes_are_spread_evenly() {
        for k in 0..2 * TRIED {
            let fine = super::turned(&spread(k % TRIED), 0.06, k as f64);
            let nearest =
                (0..TRIED).map(|l| super::dot(&spread(l), &fine).abs()).fold(0.0, f64::max);
            assert!(nearest > 0.105_f64.cos(), "{k} {}", nearest.acos());
        }
    }

    /// A reversed pull ties on all planes at 45° to it; a constant stress across chooses those that it pulls:
    /// σ_n = ½ + 0.3/2.
    #[test]
    fn equal_planes_on_a_curve_are_compared() {
        let pull = |yy: f64| -> State { [0.3, yy, 0.0, 0.0, 0.0, 0.0] };
        let history = [pull(1.0), pull(-1.0)];
        let (plane, gap) = Planes::new(&history).matake();
        assert!((plane.shear - 0.5).abs() < 1e-6);
        assert!((plane.tension - 0.65).abs() < 1e-4, "{plane:?}");
        assert!(gap > 1e-2);
    }
}
