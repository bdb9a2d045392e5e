//! Textbook form of the preconditioned iteration: the oracle of the fused one.
//!
//! [`Textbook`] makes the decisions of [`super::Preconditioned`] with plain loops, one formula a line, and
//! computes every displacement afresh. The two share the convolutions, the 3 × 3 solve and the balance of force
//! and moments, which have tests of their own.

use std::array;
use std::collections::HashSet;
use std::iter::zip;

use super::{Approximation, Step};
use crate::compliance::convolution::Convolution;
use crate::contact::problem::Problem;

/// A field over all cells.
pub(super) type Field = Vec<f64>;

/// Decisions, each of which the comparison must meet at least once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Branch {
    /// So many cells joined that the next direction is not conjugate.
    ManyJoined,
    /// Images were renewed, since the contact stayed.
    Renewed,
    /// Images were renewed, since they were old and the iteration was long.
    TooOld,
    /// The oblique projection did not descend.
    Orthogonal,
    /// The conjugate direction did not descend.
    Gradient,
    /// The change of a step with losses was shortened to its best length.
    Shortened,
    /// The best length was so large that an exact step follows.
    TooShort,
    /// A step with losses did not descend, and an exact one took its place.
    Repeated,
}

/// The unfused iteration of one problem.
pub(super) struct Textbook<'a> {
    pub(super) problem: &'a Problem<'a>,
    approximation: &'a Approximation,
    /// Columns of B: 1, x, y at each cell.
    b: [Field; 3],
    /// Contact C: cells that are pressed or overlap.
    contact: Vec<bool>,
    /// Residual −g on C, 0 elsewhere, and the residual one iteration before.
    r: Field,
    r_before: Field,
    direction: Field,
    /// MB_C, with the contact C of the time when the images were made.
    images: [Field; 3],
    /// Whether the contact changed in the last assessment.
    changed: bool,
    /// Changes of the contact since the images were made.
    age: usize,
    /// Whether the next direction is conjugate to the last.
    conjugate: bool,
    /// r · z of the last direction.
    descent: f64,
    curvature_ratio: f64,
    pub(super) seen: HashSet<Branch>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    zip(a, b).map(|(a, b)| a * b).sum()
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, b| a.max(b.abs()))
}

fn count(cells: &[bool]) -> f64 {
    cells.iter().filter(|&&member| member).count() as f64
}

/// Values `v` on the member cells, 0 elsewhere.
fn on(member: &[bool], v: &[f64]) -> Field {
    let cells = zip(member, v);
    cells.map(|(&m, &v)| if m { v } else { 0.0 }).collect()
}

/// a + factor b
pub(super) fn sum(a: &[f64], factor: f64, b: &[f64]) -> Field {
    zip(a, b).map(|(a, b)| a + factor * b).collect()
}

pub(super) fn convolved(convolution: &Convolution, v: &[f64]) -> Field {
    let mut out = vec![0.0; v.len()];
    convolution.apply_slices(v, &mut out, &mut convolution.workspace());
    out
}

fn best_length(slope: f64, curvature: f64) -> Option<f64> {
    (slope > 0.0 && curvature > 0.0).then_some(slope / curvature)
}

impl<'a> Textbook<'a> {
    pub(super) fn new(
        problem: &'a Problem<'a>,
        approximation: &'a Approximation,
        p: &[f64],
    ) -> Self {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let b = columns.map(|lambda| {
            let mut column = vec![0.0; p.len()];
            problem.freedoms.for_each(lambda, |k, b| column[k] = b);
            column
        });
        let zeros = vec![0.0; p.len()];
        let mut textbook = Self {
            problem,
            approximation,
            b,
            contact: p.iter().map(|&p| p > 0.0).collect(),
            r: zeros.clone(),
            r_before: zeros.clone(),
            direction: zeros,
            images: array::from_fn(|_| Vec::new()),
            changed: false,
            age: 0,
            conjugate: false,
            descent: 0.0,
            curvature_ratio: 1.0,
            seen: HashSet::new(),
        };
        textbook.invert_freedoms();
        textbook
    }

    /// MB_C
    fn invert_freedoms(&mut self) {
        let image = |b: &Field| convolved(&self.approximation.inverse, &on(&self.contact, b));
        self.images = self.b.each_ref().map(image);
    }

    /// Bᵀv
    pub(super) fn moments(&self, v: &[f64]) -> [f64; 3] {
        self.b.each_ref().map(|b| dot(b, v))
    }

    /// Bλ that is nearest to `v` on the member cells, by least squares; and λ.
    fn nearest(&self, v: &[f64], member: &[bool]) -> (Field, [f64; 3]) {
        let gram = self.b.each_ref().map(|b| self.moments(&on(member, b)));
        let right = self.moments(&on(member, v));
        let lambda = self.problem.freedoms.solve(&gram, right);
        let motion = |k: usize| (0..3).map(|f| lambda[f] * self.b[f][k]).sum();
        ((0..v.len()).map(motion).collect(), lambda)
    }

    /// λ from u + h ≈ Bλ over p > 0; C = {p > 0 or −g > 0}. Returns λ, Σ p|g| / Σ p u and max(−g) / max u, with
    /// the local displacement for u where that is less.
    pub(super) fn assess(&mut self, p: &[f64]) -> ([f64; 3], [f64; 2]) {
        let u = convolved(self.problem.convolution, p);
        let shape = sum(&u, 1.0, self.problem.gap);
        let pressed: Vec<bool> = p.iter().map(|&p| p > 0.0).collect();
        let (motion, lambda) = self.nearest(&shape, &pressed);
        let overlap = sum(&motion, -1.0, &shape);
        let contact: Vec<bool> = zip(&pressed, &overlap).map(|(&p, &o)| p || o > 0.0).collect();
        if 10.0 * (count(&contact) - count(&pressed)) > count(&pressed) {
            self.conjugate = false;
            self.seen.insert(Branch::ManyJoined);
        }
        self.changed = contact != pressed || self.contact != pressed;
        self.r_before = std::mem::replace(&mut self.r, on(&contact, &overlap));
        self.contact = contact;
        let mismatch: f64 = zip(p, &self.r).map(|(p, r)| p * r.abs()).sum();
        let touches: Vec<bool> = self.problem.gap.iter().map(|h| h.is_finite()).collect();
        let deepest = overlap.iter().fold(0.0_f64, |a, &b| a.max(b));
        let force = p.iter().sum();
        let local = self.problem.local.under(force, count(&pressed));
        let quality = [
            mismatch / dot(p, &u).min(local * force),
            deepest / largest(&on(&touches, &u)).min(local),
        ];
        (lambda, quality)
    }

    /// z = Mr − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ Mr on C; where that does not descend, r less its nearest Bλ.
    fn deflated(&mut self) -> Field {
        let z = on(&self.contact, &convolved(&self.approximation.inverse, &self.r));
        let images = self.images.each_ref().map(|i| on(&self.contact, i));
        let matrix = array::from_fn(|a| array::from_fn(|c| dot(&self.b[a], &images[c])));
        let factors = self.problem.freedoms.solve(&matrix, self.moments(&z));
        let z = (0..3).fold(z, |z, k| sum(&z, -factors[k], &images[k]));
        if dot(&self.r, &z) > 0.0 {
            return z;
        }
        self.conjugate = false;
        self.seen.insert(Branch::Orthogonal);
        let (mean, _) = self.nearest(&self.r, &self.contact);
        on(&self.contact, &sum(&self.r, -1.0, &mean))
    }

    /// d ← z + βd on C, β = max(0, z·(r − r_before) / z_before·r_before); returns d·r.
    fn turn(&mut self, iterations: usize) -> f64 {
        if self.age > 0 && !self.changed {
            self.invert_freedoms();
            self.conjugate = false;
            self.age = 0;
            self.seen.insert(Branch::Renewed);
        } else if self.age >= 3 && iterations >= 20 {
            self.invert_freedoms();
            self.age = 0;
            self.seen.insert(Branch::TooOld);
        } else if self.changed {
            self.age += 1;
        }
        let z = self.deflated();
        let descent = dot(&self.r, &z);
        let beta = ((descent - dot(&self.r_before, &z)) / self.descent).max(0.0);
        let beta = if self.conjugate { beta } else { 0.0 };
        (self.descent, self.conjugate) = (descent, true);
        self.direction = on(&self.contact, &sum(&z, beta, &self.direction));
        if dot(&self.r, &self.direction) <= 0.0 {
            self.direction = z;
            self.seen.insert(Branch::Gradient);
        }
        dot(&self.r, &self.direction)
    }

    /// An exact step; after a step that lost cells, one with losses first.
    pub(super) fn step(&mut self, p: &mut Field, last: Step, iterations: usize) -> Step {
        let slope = self.turn(iterations);
        if last == Step::Truncated {
            let step = self.step_with_losses(p, slope);
            if step != Step::Stalled {
                return step;
            }
            self.seen.insert(Branch::Repeated);
        }
        let curvature = dot(&self.direction, &convolved(self.problem.convolution, &self.direction));
        best_length(slope, curvature).map_or(Step::Stalled, |length| self.advance(p, length))
    }

    /// p ← [p + length d]₊, balanced.
    fn advance(&self, p: &mut Field, length: f64) -> Step {
        let moved = sum(p, length, &self.direction);
        *p = moved.iter().map(|p| p.max(0.0)).collect();
        let whole = moved.iter().all(|&p| p >= 0.0);
        if whole && self.problem.freedoms.on_target(self.moments(p)) {
            return Step::Whole;
        }
        self.problem.rebalance(p);
        Step::Truncated
    }

    /// Length by the periodic convolution; then the best length along the change that remains.
    fn step_with_losses(&mut self, p: &mut Field, slope: f64) -> Step {
        let periodic = convolved(&self.approximation.periodic, &self.direction);
        let curvature = dot(&self.direction, &periodic) * self.curvature_ratio;
        let Some(length) = best_length(slope, curvature) else {
            return Step::Stalled;
        };
        let mut next = p.clone();
        let done = self.advance(&mut next, length);
        let change = sum(&next, -1.0, p);
        let curvature = dot(&change, &convolved(self.problem.convolution, &change));
        let best = best_length(dot(&change, &self.r), curvature).unwrap_or(0.0);
        if best <= 0.0 {
            return Step::Stalled;
        }
        let ratio = self.curvature_ratio / best.clamp(0.8, 1.25);
        self.curvature_ratio = ratio.clamp(0.5, 2.0);
        if best < 0.6 {
            self.seen.insert(Branch::Shortened);
            *p = sum(p, best, &change);
            return Step::Whole;
        }
        *p = next;
        if best < 1.8 {
            return done;
        }
        self.seen.insert(Branch::TooShort);
        Step::Whole
    }
}
