//! Textbook form of the preconditioned iteration: the oracle of the fused one.
//!
//! [`Textbook`] makes the decisions of [`super::Preconditioned`] with plain loops, one formula a line, and
//! computes every displacement afresh. The two share the convolutions, the 3 × 3 solve and the balance of force
//! and moments, which have tests of their own.

use std::array;
use std::collections::HashSet;
use std::iter::zip;

use ndarray::Array2;

use crate::compliance::convolution::Convolution;
use crate::compliance::influence::{Method, influence_coefficients};
use crate::compliance::response::Body;
use crate::contact::options::Motion;
use crate::contact::problem::bounds::Bounds;
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::{LocalDisplacement, Problem};
use crate::contact::solver::preconditioned::{
    Approximation, Assessment, Memory, PATIENCE, Preconditioned, StepOutcome,
};
use crate::error::Result;
use crate::model::body::{HalfSpace, Layer};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::parallel::Pool;

/// A field over all cells.
pub(super) type Field = Vec<f64>;

/// Decisions, each of which the comparison must meet at least once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Decision {
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
    pub(super) seen: HashSet<Decision>,
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
            self.seen.insert(Decision::ManyJoined);
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
        self.seen.insert(Decision::Orthogonal);
        let (mean, _) = self.nearest(&self.r, &self.contact);
        on(&self.contact, &sum(&self.r, -1.0, &mean))
    }

    /// d ← z + βd on C, β = max(0, z·(r − r_before) / z_before·r_before); returns d·r.
    fn turn(&mut self, iterations: usize) -> f64 {
        if self.age > 0 && !self.changed {
            self.invert_freedoms();
            self.conjugate = false;
            self.age = 0;
            self.seen.insert(Decision::Renewed);
        } else if self.age >= 3 && iterations >= 20 {
            self.invert_freedoms();
            self.age = 0;
            self.seen.insert(Decision::TooOld);
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
            self.seen.insert(Decision::Gradient);
        }
        dot(&self.r, &self.direction)
    }

    /// An exact step; after a step that lost cells, one with losses first.
    pub(super) fn step(
        &mut self,
        p: &mut Field,
        last: StepOutcome,
        iterations: usize,
    ) -> StepOutcome {
        let slope = self.turn(iterations);
        if last == StepOutcome::Truncated {
            let step = self.step_with_losses(p, slope);
            if step != StepOutcome::Stalled {
                return step;
            }
            self.seen.insert(Decision::Repeated);
        }
        let curvature = dot(&self.direction, &convolved(self.problem.convolution, &self.direction));
        best_length(slope, curvature).map_or(StepOutcome::Stalled, |length| self.advance(p, length))
    }

    /// p ← [p + length d]₊, balanced.
    fn advance(&self, p: &mut Field, length: f64) -> StepOutcome {
        let moved = sum(p, length, &self.direction);
        *p = moved.iter().map(|p| p.max(0.0)).collect();
        let whole = moved.iter().all(|&p| p >= 0.0);
        if whole && self.problem.freedoms.on_target(self.moments(p)) {
            return StepOutcome::Whole;
        }
        self.problem.rebalance(p);
        StepOutcome::Truncated
    }

    /// Length by the periodic convolution; then the best length along the change that remains.
    fn step_with_losses(&mut self, p: &mut Field, slope: f64) -> StepOutcome {
        let periodic = convolved(&self.approximation.periodic, &self.direction);
        let curvature = dot(&self.direction, &periodic) * self.curvature_ratio;
        let Some(length) = best_length(slope, curvature) else {
            return StepOutcome::Stalled;
        };
        let mut next = p.clone();
        let done = self.advance(&mut next, length);
        let change = sum(&next, -1.0, p);
        let curvature = dot(&change, &convolved(self.problem.convolution, &change));
        let best = best_length(dot(&change, &self.r), curvature).unwrap_or(0.0);
        if best <= 0.0 {
            return StepOutcome::Stalled;
        }
        let ratio = self.curvature_ratio / best.clamp(0.8, 1.25);
        self.curvature_ratio = ratio.clamp(0.5, 2.0);
        if best < 0.6 {
            self.seen.insert(Decision::Shortened);
            *p = sum(p, best, &change);
            return StepOutcome::Whole;
        }
        *p = next;
        if best < 1.8 {
            return done;
        }
        self.seen.insert(Decision::TooShort);
        StepOutcome::Whole
    }
}

/// A problem of the comparison; lengths and moduli are of order 1.
struct ComparedProblem {
    name: &'static str,
    body: Body,
    grid: Grid,
    motion: Motion,
    gap: fn(f64, f64) -> f64,
    /// Radius around the origin within which cells are pressed at first.
    start: f64,
}

fn cases() -> Result<[ComparedProblem; 6]> {
    let bare = Elastic::new(1.0, 0.0)?;
    let hard = Layer::new(Elastic::new(4.0, 0.2)?, 0.4)?;
    let coated = HalfSpace::new(Elastic::new(1.0, 0.3)?, [hard])?;
    let (load, light) = (Motion::load(1e-3), Motion::load(1e-4));
    // Bodies without layers, pressed everywhere.
    let plain = |name, grid, motion, gap| ComparedProblem {
        name,
        body: bare.into(),
        grid,
        motion,
        gap,
        start: f64::INFINITY,
    };
    let tilting = Motion { eccentricity: [Some(0.31), Some(-0.02)], ..load };
    let turned = Motion { moment: [Some(3e-5), Some(-5e-6)], ..light };
    let tilted = Motion { tilt: [Some(2e-4), Some(-1e-4)], ..Motion::approach(5e-4) };
    let off_centre = Motion { eccentricity: [None, Some(0.3)], ..light };
    let rough_grid = Grid::new([60, 55], [3.0, 2.5])?.centered_at([0.3, -0.2])?;
    Ok([
        plain("paraboloid", Grid::new([53, 64], [3.0, 4.2])?, load, |x, y| {
            5e-4 * x * x + 4e-4 * y * y
        }),
        ComparedProblem {
            body: coated.into(),
            ..plain("coated", Grid::new([66, 49], [3.4, 3.1])?, load, |x, y| {
                5e-4 * ((x - 0.1).powi(2) + y * y)
            })
        },
        plain("crowned roller, both moments", Grid::new([71, 50], [6.0, 1.6])?, tilting, |x, y| {
            1e-3 * y * y + 2e-4 * (x.abs() - 0.5).max(0.0).powi(2)
        }),
        ComparedProblem {
            start: 0.4,
            ..plain("rough, of finite extent", rough_grid, turned, |x, y| {
                let height = ((127.1 * x + 311.7 * y).sin() * 43758.5).fract();
                let smooth = 3e-4 * (x * x + y * y);
                if x.hypot(y) > 1.3 { f64::INFINITY } else { smooth + 1e-4 * height }
            })
        },
        plain("approach and tilt", Grid::new([48, 57], [4.0, 3.6])?, tilted, |x, y| {
            5e-4 * x * x + 6e-4 * y * y
        }),
        plain("line", Grid::line(71, 3.3)?, off_centre, |_, y| {
            5e-4 * y * y + 2e-5 * (9.0 * y).cos()
        }),
    ])
}

/// Calls `work` with the fused iteration of `case`, its textbook form, and the pressure that both start from:
/// uniform on all cells that can touch within the radius of the start, and balanced.
fn with_both<R>(
    case: &ComparedProblem,
    work: impl FnOnce(Preconditioned, Textbook, Field) -> R,
) -> Result<R> {
    let coefficients = influence_coefficients(case.body.clone(), &case.grid, Method::Exact)?;
    let convolution = Convolution::plan(&coefficients, Some(1))?;
    let [periodic, inverse] = convolution.preconditioner(&coefficients, [false; 2]);
    let approximation = Approximation { inverse, periodic };
    let freedoms = Freedoms::new(&case.motion, &case.grid)?;
    let (x, y) = (case.grid.x(), case.grid.y());
    let mut gap = Array2::from_shape_fn(coefficients.dim(), |(i, j)| (case.gap)(x[i], y[j]));
    freedoms.prescribe(&mut gap);
    let gap = gap.into_raw_vec_and_offset().0;
    let problem = Problem {
        convolution: &convolution,
        freedoms: &freedoms,
        gap: &gap,
        local: &LocalDisplacement::new(&[&case.body], &case.grid),
        bounds: &Bounds::none(case.grid.shape()[1]),
    };
    let pressed = |(i, j): (usize, usize)| x[i].hypot(y[j]) < case.start;
    let pressed = Array2::from_shape_fn(coefficients.dim(), pressed);
    let mut p: Field = (pressed.iter().zip(&gap))
        .map(|(&pressed, h)| if pressed && h.is_finite() { 1e-3 } else { 0.0 })
        .collect();
    assert!(freedoms.balance(&mut p, problem.bounds));
    let mut memory = Pool::<Memory>::default().lease();
    memory.reserve(&problem.rows(), gap.len(), freedoms.loaded);
    let mut fused = Preconditioned::new(&problem, &approximation, memory);
    fused.start(&p);
    Ok(work(fused, Textbook::new(&problem, &approximation, &p), p))
}

/// Pressures of both agree to 1e-12 of the peak after every iteration, down to a tolerance far below the usual
/// one; so do λ and the quality, relative to the displacement, and the steps are of the same kind. Each problem is
/// solved twice, the second time with the images of a long iteration.
///
/// Measured: 2e-13 (coated), 1e-13 or less elsewhere. Rounding grows most where the contact has become so much
/// smaller than the one of the images that the oblique projection is nearly singular.
#[test]
fn fused_iteration_is_the_textbook_one() -> Result<()> {
    const ROUNDING: f64 = 1e-12;
    let mut seen = HashSet::new();
    let cases = cases()?;
    let runs = cases.iter().flat_map(|case| [(case, 0), (case, PATIENCE)]);
    for (case, before) in runs {
        with_both(case, |mut fused, mut textbook, start| {
            let (mut p, mut q) = (start.clone(), start);
            let (mut last, mut step) = (StepOutcome::Truncated, StepOutcome::Truncated);
            for iteration in 0..=100 {
                let at = format!("{}, iteration {iteration} after {before}", case.name);
                assert!(iteration < 100, "{at}: not converged");
                let Assessment { lambda, quality, contact_changed } = fused.assess(&p);
                let (expected, [residual, overlap]) = textbook.assess(&q);
                let u = largest(&convolved(textbook.problem.convolution, &q));
                for k in 0..3 {
                    let change = (lambda[k] - expected[k]).abs();
                    assert!(change <= ROUNDING * u, "{at}: λ[{k}] {change:e}");
                }
                assert!((quality.residual - residual).abs() <= ROUNDING, "{at}: residual");
                assert!(
                    (quality.overlap - overlap).abs() <= ROUNDING * overlap.max(1.0),
                    "{at}: overlap"
                );
                if quality.meets(1e-11) {
                    break;
                }
                fused.prepare_images(&p, contact_changed, before + iteration);
                last = fused.step(&mut p, last);
                step = textbook.step(&mut q, step, before + iteration);
                assert_eq!(last, step, "{at}");
                let apart = largest(&sum(&p, -1.0, &q)) / largest(&q);
                assert!(apart <= ROUNDING, "{at}: {apart:e}");
            }
            seen.extend(textbook.seen);
        })?;
    }
    assert_eq!(seen.len(), 8, "{seen:?}");
    Ok(())
}

/// A direction changes neither force nor moments, whichever contact the images are of: Bᵀd = 0 for the loaded
/// freedoms. The first two directions have fresh and stale images, and lost no cells.
#[test]
fn directions_are_balanced() -> Result<()> {
    for case in cases()? {
        with_both(&case, |mut fused, textbook, mut p| {
            let loaded = textbook.problem.freedoms.loaded;
            let mut changed = fused.assess(&p).contact_changed;
            for _ in 0..2 {
                fused.prepare_images(&p, changed, 0);
                let slope = fused.search_direction(&p, textbook.problem.convolution);
                let arrays = fused.memory.arrays(p.len());
                let d = &*arrays.direction;
                assert!(slope > 0.0 && largest(d) > 0.0);
                let size: f64 = d.iter().map(|d| d.abs()).sum();
                let moments = textbook.moments(d);
                for k in (0..3).filter(|&k| loaded[k]) {
                    assert!(moments[k].abs() <= 1e-14 * size, "{} {k}", case.name);
                }
                // Fewer cells, with the images of all.
                p = (p.iter().enumerate())
                    .map(|(k, p)| if k % 3 == 0 { 0.0 } else { *p })
                    .collect();
                fused.displace(&p);
                changed = fused.assess(&p).contact_changed;
                fused.conjugacy.restart();
            }
        })?;
    }
    Ok(())
}
