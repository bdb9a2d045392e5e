//! The smallest ball that encloses points.

use super::dense::eliminate;

/// A ball in N dimensions.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ball<const N: usize> {
    pub(crate) centre: [f64; N],
    pub(crate) radius: f64,
    /// Points on its surface that determine it, at most N + 1 of them, by their indices.
    pub(crate) support: Vec<usize>,
}

/// Part of the radius by which a point may lie outside: some 50 ε, the rounding of a centre.
const OUTSIDE: f64 = 1e-14;

/// Of many points, every so many-th alone is enclosed first: states on a curve are eight times denser than is seen of it.
const STRIDE: usize = 8;

/// The smallest ball that encloses `points`; a ball about 0 of radius 0 without any.
///
/// It is unique, and the smallest one of the few points on its surface, its support. The support is exchanged
/// until no point is outside: the farthest one enters, and the smallest ball of the N + 2 points or fewer is the
/// one of their subsets' circumscribed balls whose centre is least far from all of them. The radius grows with every
/// exchange, so that no support returns. It begins with that of a part of the points, from which few exchanges are left.
/// Welzl (1991), doi:10.1007/BFb0038202, for the support; derived here is that
/// the choice by the largest distance needs no tolerance where points are nearly in a plane or equal.
pub(crate) fn smallest_ball<const N: usize>(points: &[[f64; N]]) -> Ball<N> {
    let Some(first) = points.first() else {
        return Ball { centre: [0.0; N], radius: 0.0, support: Vec::new() };
    };
    let mut ball = Ball { centre: *first, radius: 0.0, support: vec![0] };
    if points.len() > STRIDE * STRIDE {
        let part: Vec<[f64; N]> = points.iter().step_by(STRIDE).copied().collect();
        ball = smallest_ball(&part);
        ball.support.iter_mut().for_each(|place| *place *= STRIDE);
    }
    loop {
        let (far, distance) = farthest(&ball.centre, points.iter().copied());
        let is_enclosed = distance <= ball.radius * (1.0 + OUTSIDE);
        if is_enclosed || ball.support.contains(&far) {
            return Ball { radius: distance.max(ball.radius), ..ball };
        }
        let larger = exchanged(points, &ball.support, far);
        // Rounding alone: no support is better.
        if larger.radius <= ball.radius {
            return Ball { radius: distance, ..ball };
        }
        ball = larger;
    }
}

/// The smallest ball of the points `support` and `enters`, which is on its surface.
fn exchanged<const N: usize>(points: &[[f64; N]], support: &[usize], enters: usize) -> Ball<N> {
    let all = || support.iter().chain([&enters]).map(|&k| points[k]);
    let (mut best, mut chosen) = ((points[enters], f64::INFINITY), 0);
    for subset in 0..1_usize << support.len() {
        let (mut sides, mut count) = ([[0.0; N]; N], 0);
        if subset.count_ones() as usize > N {
            continue;
        }
        for (_, &other) in support.iter().enumerate().filter(|(k, _)| subset >> k & 1 == 1) {
            sides[count] = std::array::from_fn(|k| points[other][k] - points[enters][k]);
            count += 1;
        }
        let centre = circumcentre(&points[enters], &sides[..count]);
        let (_, radius) = farthest(&centre, all());
        if radius < best.1 {
            (best, chosen) = ((centre, radius), subset);
        }
    }
    let kept = support.iter().enumerate().filter(|(k, _)| chosen >> k & 1 == 1);
    let support = kept.map(|(_, &point)| point).chain([enters]).collect();
    Ball { centre: best.0, radius: best.1, support }
}

/// The point that is equally far from `first` and the ends of `sides` from there, in their hull:
/// c = a + Σ λ_k v_k with the sides v and Σ_l (v_k · v_l) λ_l = |v_k|²/2.
fn circumcentre<const N: usize>(first: &[f64; N], sides: &[[f64; N]]) -> [f64; N] {
    let (mut matrix, mut weights) = ([[0.0; N]; N], [0.0; N]);
    for (k, side) in sides.iter().enumerate() {
        for (l, other) in sides.iter().enumerate() {
            matrix[k][l] = dot(side, other);
        }
        weights[k] = 0.5 * matrix[k][k];
    }
    let used = sides.len();
    eliminate(&mut matrix[..used], &mut weights[..used], |_, pivot| pivot > 0.0);
    std::array::from_fn(|k| {
        first[k] + weights.iter().zip(sides).map(|(weight, side)| weight * side[k]).sum::<f64>()
    })
}

/// Index and distance of the point that is farthest from `centre`, the first of several.
fn farthest<const N: usize>(
    centre: &[f64; N],
    points: impl Iterator<Item = [f64; N]>,
) -> (usize, f64) {
    let mut outermost = (0, -1.0);
    for (k, point) in points.enumerate() {
        let away: [f64; N] = std::array::from_fn(|axis| point[axis] - centre[axis]);
        let square = dot(&away, &away);
        if square > outermost.1 {
            outermost = (k, square);
        }
    }
    (outermost.0, outermost.1.max(0.0).sqrt())
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|k| a[k] * b[k]).sum()
}

#[cfg(test)]
mod tests {
    use super::{farthest, smallest_ball};

    /// Numbers between −1 and 1 that look random.
    fn scattered(seed: usize) -> impl FnMut() -> f64 {
        let mut state = seed as u64 * 2 + 1;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// The corners of a cube, of a regular simplex, and points that are one or lie on a line.
    #[test]
    fn closed_forms() {
        let cube: Vec<[f64; 3]> =
            (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|bit| bit as f64)).collect();
        let ball = smallest_ball(&cube);
        assert!((ball.radius - 0.75_f64.sqrt()).abs() < 1e-15);
        assert!(ball.centre.iter().all(|c| (c - 0.5).abs() < 1e-15));
        // Unit vectors of five axes: R² = 1 − 1/5.
        let simplex: Vec<[f64; 5]> =
            (0..5).map(|k| std::array::from_fn(|axis| f64::from(u8::from(axis == k)))).collect();
        assert!((smallest_ball(&simplex).radius - 0.8_f64.sqrt()).abs() < 1e-15);
        assert!(smallest_ball(&[[3.0, 4.0]; 4]).radius <= 0.0);
        let line: Vec<[f64; 2]> = (0..9).map(|k| [k as f64, 2.0 * k as f64]).collect();
        assert!((smallest_ball(&line).radius - 4.0 * 5.0_f64.sqrt()).abs() < 1e-14);
        assert!(smallest_ball::<3>(&[]).radius <= 0.0);
    }

    /// No centre nearby has a smaller ball; the largest distance is convex, so that none has. Clouds, and closed
    /// curves, whose points are close together and nearly in a plane.
    #[test]
    fn no_other_ball_is_smaller() {
        for seed in 0..60 {
            let mut next = scattered(seed);
            let points: Vec<[f64; 5]> = (0..200)
                .map(|k| {
                    let angle = std::f64::consts::TAU * k as f64 / 200.0;
                    let curve =
                        [angle.cos(), 0.9 * angle.sin(), (2.0 * angle).sin(), 0.1, 1e-9 * angle];
                    std::array::from_fn(|axis| match seed % 2 {
                        0 => next(),
                        _ => curve[axis] + 0.2 * (seed as f64) * (3.0 * angle).cos() * axis as f64,
                    })
                })
                .collect();
            let ball = smallest_ball(&points);
            let (_, distance) = farthest(&ball.centre, points.iter().copied());
            assert!((distance / ball.radius - 1.0).abs() < 1e-13);
            assert!((2..=6).contains(&ball.support.len()));
            for step in [1e-2, 1e-4] {
                for _ in 0..40 {
                    let moved = ball.centre.map(|c| c + step * ball.radius * next());
                    let (_, other) = farthest(&moved, points.iter().copied());
                    assert!(other > ball.radius * (1.0 - 1e-13), "{seed}");
                }
            }
        }
    }
}
