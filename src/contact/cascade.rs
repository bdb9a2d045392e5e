//! Nested grids and the contact window around preconditioned conjugate gradients.
//!
//! The problem is solved on a grid of a few cells first; each solution, interpolated, is where the
//! next finer grid starts. On each grid only a window around the contact is solved: its influence
//! coefficients are a corner of the grid's. What happens outside is seen afterwards, when the
//! displacement is computed on the whole grid: where something overlaps there, the window opens.

use std::ops::Range;

use ndarray::{Array2, ArrayRef2, ArrayView2, Axis, Slice};

use super::freedoms::Freedoms;
use super::preconditioned::Preconditioned;
use super::problem::{Limits, Outcome, Problem, Termination, Watch};
use super::slice_mut;
use crate::convolution::Convolution;

/// A direction with fewer cells is not halved.
const COARSEST: usize = 32;

/// Tolerance of all grids but the last: somewhat below their discretisation error.
const COARSE_TOLERANCE: f64 = 1e-4;

/// Cells around the contact in a window.
const MARGIN: usize = 4;

/// A window that covers more of the grid than this is not worth its planning.
const WORTH_WINDOW: f64 = 0.6;

/// Coefficients of a grid of cells twice as long in the directions of `halved`, from those of this
/// grid: pressure uniform over the coarse cells, displacement averaged over them.
///
/// ```text
/// C'[I] = C[2I] + (C[2I−1] + C[2I+1])/2       along each direction
/// ```
fn coarse_coefficients(fine: &Array2<f64>, halved: [bool; 2]) -> Array2<f64> {
    let half = |n: usize, halved: bool| if halved { n.div_ceil(2) } else { n };
    let (nx, ny) = fine.dim();
    let taps = |i: usize, n: usize, halved: bool| -> [(usize, f64); 3] {
        if halved {
            [
                ((2 * i).min(n - 1), 1.0),
                ((2 * i + 1).min(n - 1), 0.5),
                ((2 * i).abs_diff(1).min(n - 1), 0.5),
            ]
        } else {
            [(i, 1.0), (i, 0.0), (i, 0.0)]
        }
    };
    Array2::from_shape_fn((half(nx, halved[0]), half(ny, halved[1])), |(i, j)| {
        let (x, y) = (taps(i, nx, halved[0]), taps(j, ny, halved[1]));
        x.iter()
            .map(|(i, a)| y.iter().map(|(j, b)| a * b * fine[[*i, *j]]).sum::<f64>())
            .sum()
    })
}

/// Which directions of a grid are halved for the next coarser one; none at the coarsest.
fn halved(shape: [usize; 2]) -> [bool; 2] {
    shape.map(|n| n >= 2 * COARSEST)
}

/// Influence coefficients of a grid and of all coarser ones.
#[derive(Debug)]
pub(super) struct Levels {
    /// From the finest on.
    coefficients: Vec<Array2<f64>>,
    /// Of the coarser ones.
    convolutions: Vec<Convolution>,
}

impl Levels {
    pub(super) fn new(finest: Array2<f64>, convolution: &Convolution) -> Self {
        let mut coefficients = vec![finest];
        let mut convolutions = Vec::new();
        loop {
            let fine = &coefficients[coefficients.len() - 1];
            let halved = halved([fine.nrows(), fine.ncols()]);
            if halved == [false; 2] {
                return Self {
                    coefficients,
                    convolutions,
                };
            }
            let coarse = coarse_coefficients(fine, halved);
            convolutions.push(convolution.part(&coarse));
            coefficients.push(coarse);
        }
    }
}

/// Mean gap over coarse cells; of the fine cells that can touch.
fn coarse_gap(fine: &Array2<f64>, halved: [bool; 2]) -> Array2<f64> {
    let (nx, ny) = fine.dim();
    let span = |i: usize, n: usize, halved: bool| -> Range<usize> {
        if halved {
            2 * i..(2 * i + 2).min(n)
        } else {
            i..i + 1
        }
    };
    let half = |n: usize, halved: bool| if halved { n.div_ceil(2) } else { n };
    Array2::from_shape_fn((half(nx, halved[0]), half(ny, halved[1])), |(i, j)| {
        let (mut sum, mut count) = (0.0, 0);
        for h in block(fine, &[span(i, nx, halved[0]), span(j, ny, halved[1])]) {
            if h.is_finite() {
                sum += h;
                count += 1;
            }
        }
        if count > 0 {
            sum / f64::from(count)
        } else {
            f64::INFINITY
        }
    })
}

/// Linear interpolation of a coarse pressure between the centres of its cells, constant beyond the
/// outermost ones.
fn interpolate(coarse: &Array2<f64>, shape: [usize; 2], halved: [bool; 2]) -> Array2<f64> {
    let (cx, cy) = coarse.dim();
    let taps = |i: usize, n: usize, halved: bool| -> [(usize, f64); 2] {
        if !halved {
            return [(i, 1.0), (i, 0.0)];
        }
        let near = i / 2;
        let next = if i.is_multiple_of(2) {
            near.saturating_sub(1)
        } else {
            (near + 1).min(n - 1)
        };
        [(near, 0.75), (next, 0.25)]
    };
    Array2::from_shape_fn(shape, |(i, j)| {
        let (x, y) = (taps(i, cx, halved[0]), taps(j, cy, halved[1]));
        x.iter()
            .map(|(i, a)| y.iter().map(|(j, b)| a * b * coarse[[*i, *j]]).sum::<f64>())
            .sum()
    })
}

/// Cells i0..i1, j0..j1 of a grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Window([Range<usize>; 2]);

impl Window {
    pub(super) fn whole([nx, ny]: [usize; 2]) -> Self {
        Self([0..nx, 0..ny])
    }

    /// Around the cells of which `member` holds, with a margin; none without any.
    fn around(shape: [usize; 2], member: impl Fn(usize, usize) -> bool) -> Option<Self> {
        let mut found: Option<[Range<usize>; 2]> = None;
        for i in 0..shape[0] {
            for j in (0..shape[1]).filter(|&j| member(i, j)) {
                found = Some(match found {
                    Some([x, y]) => [x.start..i + 1, y.start.min(j)..y.end.max(j + 1)],
                    None => [i..i + 1, j..j + 1],
                });
            }
        }
        let [x, y] = found?;
        let widen =
            |r: Range<usize>, n: usize| r.start.saturating_sub(MARGIN)..(r.end + MARGIN).min(n);
        let window = Self([widen(x, shape[0]), widen(y, shape[1])]);
        let part = window.cells() as f64 / (shape[0] * shape[1]) as f64;
        Some(if part > WORTH_WINDOW {
            Self::whole(shape)
        } else {
            window
        })
    }

    /// Around the contact; the whole grid where there is none.
    fn of_contact(p: &Array2<f64>) -> Self {
        let shape = [p.nrows(), p.ncols()];
        Self::around(shape, |i, j| p[[i, j]] > 0.0).unwrap_or_else(|| Self::whole(shape))
    }

    fn cells(&self) -> usize {
        self.0[0].len() * self.0[1].len()
    }

    fn contains(&self, i: usize, j: usize) -> bool {
        self.0[0].contains(&i) && self.0[1].contains(&j)
    }

    fn cut(&self, array: &ArrayRef2<f64>) -> Vec<f64> {
        block(array, &self.0).iter().copied().collect()
    }

    /// Zero but for `values` inside.
    fn paste(&self, array: &mut Array2<f64>, values: &[f64]) {
        array.fill(0.0);
        let [x, y] = self.0.clone();
        let rows = array.outer_iter_mut().skip(x.start);
        for (mut row, values) in rows.zip(values.chunks_exact(y.len())) {
            for (to, from) in row.iter_mut().skip(y.start).zip(values) {
                *to = *from;
            }
        }
    }
}

/// Rows and columns of an array.
fn block<'a>(array: &'a ArrayRef2<f64>, [x, y]: &[Range<usize>; 2]) -> ArrayView2<'a, f64> {
    let mut view = array.view();
    view.slice_axis_inplace(Axis(0), Slice::from(x.clone()));
    view.slice_axis_inplace(Axis(1), Slice::from(y.clone()));
    view
}

/// One grid: its coefficients, and its problem.
struct Level<'a> {
    coefficients: &'a Array2<f64>,
    convolution: &'a Convolution,
    freedoms: Freedoms,
    gap: Array2<f64>,
}

impl Level<'_> {
    fn shape(&self) -> [usize; 2] {
        [self.gap.nrows(), self.gap.ncols()]
    }

    /// Solves in a window around the contact of `p`, which opens while the contact reaches its
    /// edge; `p` becomes the solution.
    fn solve(
        &self,
        p: &mut Array2<f64>,
        window: &mut Window,
        limits: Limits,
        work: &mut f64,
        watch: &mut Watch,
    ) -> Outcome {
        let shape = self.shape();
        let mut done = 0;
        loop {
            let whole = *window == Window::whole(shape);
            let [x, y] = &window.0;
            let corner = block(self.coefficients, &[0..x.len(), 0..y.len()]);
            let part = (!whole).then(|| self.convolution.part(&corner));
            let inverse = self.convolution.approximate_inverse(&corner);
            let freedoms = self.freedoms.part(window.0.clone());
            let problem = Problem {
                convolution: part.as_ref().unwrap_or(self.convolution),
                freedoms: &freedoms,
                gap: window.cut(&self.gap),
            };
            let mut inside = window.cut(p);
            freedoms.balance(&mut inside);
            let mut solver = Preconditioned::new(&problem, &inverse);
            let before = *work;
            let limits = Limits {
                max_iterations: limits.max_iterations - done,
                ..limits
            };
            let outcome = solver.solve(&mut inside, limits, &mut |iterations, spent, quality| {
                watch(done + iterations, before + spent, quality)
            });
            *work += solver.work;
            done += outcome.iterations;
            window.paste(p, &inside);
            let outcome = Outcome {
                iterations: done,
                ..outcome
            };
            let next = Window::around(shape, |i, j| p[[i, j]] > 0.0 || window.contains(i, j));
            let touches = |i: usize, j: usize| {
                p[[i, j]] > 0.0
                    && ((i == x.start && i > 0)
                        || (i + 1 == x.end && x.end < shape[0])
                        || (j == y.start && j > 0)
                        || (j + 1 == y.end && y.end < shape[1]))
            };
            let reached = x.clone().any(|i| y.clone().any(|j| touches(i, j)));
            match next {
                Some(next) if reached && outcome.termination == Termination::Converged => {
                    *window = next;
                }
                _ => return outcome,
            }
        }
    }
}

/// What the contact of a finer grid starts from.
pub(super) struct Cascade<'a> {
    finest: Level<'a>,
    window: Window,
    pub(super) work: f64,
}

impl<'a> Cascade<'a> {
    /// Solves on the coarser grids, and takes the interpolated pressure as `p`; with a given
    /// pressure there is nothing to solve for.
    ///
    /// The error is the outcome where the caller stopped it.
    pub(super) fn new(
        problem: &Problem<'a>,
        planned: &'a Levels,
        p: &mut Array2<f64>,
        given: bool,
        limits: Limits,
        watch: &mut Watch,
    ) -> Result<Self, Outcome> {
        let shape = [p.nrows(), p.ncols()];
        let gap = Array2::from_shape_fn(shape, |(i, j)| problem.gap[i * shape[1] + j]);
        let mut levels = vec![Level {
            coefficients: &planned.coefficients[0],
            convolution: problem.convolution,
            freedoms: problem.freedoms.clone(),
            gap,
        }];
        let coarser = planned.coefficients[1..].iter().zip(&planned.convolutions);
        for (coefficients, convolution) in coarser.filter(|_| !given) {
            let fine = &levels[levels.len() - 1];
            let halved = halved(fine.shape());
            let (freedoms, gap) = (fine.freedoms.coarse(halved), coarse_gap(&fine.gap, halved));
            levels.push(Level {
                coefficients,
                convolution,
                freedoms,
                gap,
            });
        }
        let mut work = 0.0;
        let mut coarse: Option<Array2<f64>> = None;
        let coarse_limits = Limits {
            tolerance: COARSE_TOLERANCE.max(limits.tolerance),
            ..limits
        };
        for (depth, level) in levels.iter().enumerate().rev() {
            let shape = level.shape();
            let mut start = match &coarse {
                Some(coarse) => interpolate(coarse, shape, halved(shape)),
                None if depth == 0 => break,
                None => Array2::from_elem(shape, level.freedoms.typical_pressure(level.gap.len())),
            };
            start.zip_mut_with(&level.gap, |p, h| {
                if !h.is_finite() {
                    *p = 0.0;
                }
            });
            if !level.freedoms.balance(slice_mut(&mut start)) {
                // Coarse cells cannot carry the moments; finer ones may.
                coarse = None;
                continue;
            }
            if depth == 0 {
                *p = start;
                break;
            }
            let mut window = Window::of_contact(&start);
            let outcome = level.solve(&mut start, &mut window, coarse_limits, &mut work, watch);
            if outcome.termination == Termination::Stopped {
                return Err(Outcome { work, ..outcome });
            }
            coarse = Some(start);
        }
        let window = Window::of_contact(p);
        Ok(Self {
            finest: levels.swap_remove(0),
            window,
            work,
        })
    }

    /// Solves on the finest grid from `p`.
    pub(super) fn solve(
        &mut self,
        p: &mut Array2<f64>,
        limits: Limits,
        watch: &mut Watch,
    ) -> Outcome {
        self.finest
            .solve(p, &mut self.window, limits, &mut self.work, watch)
    }

    /// Opens the window around the cells where the gap `g` is negative. False where there is none
    /// outside it.
    pub(super) fn open(&mut self, g: &[f64]) -> bool {
        let shape = self.finest.shape();
        let overlaps = |i: usize, j: usize| g[i * shape[1] + j] < 0.0;
        let outside = (0..shape[0])
            .any(|i| (0..shape[1]).any(|j| !self.window.contains(i, j) && overlaps(i, j)));
        if outside {
            let old = self.window.clone();
            let around = Window::around(shape, |i, j| old.contains(i, j) || overlaps(i, j));
            self.window = around.unwrap_or_else(|| Window::whole(shape));
        }
        outside
    }
}
