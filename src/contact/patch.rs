//! Pressures in a window of a grid.

use std::ops::Range;

use ndarray::{Array2, ArrayRef2, ArrayView1, ArrayView2, Axis, Slice};

/// Cells around the contact in a window.
const MARGIN: usize = 6;

/// A window that covers more of the grid than this is not worth its planning.
const WORTH_WINDOW: f64 = 0.6;

/// Cells i0..i1, j0..j1 of a grid.
pub(super) type Window = [Range<usize>; 2];

/// A pressure that is zero outside a window.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    pub(super) window: Window,
    pub(super) values: Vec<f64>,
}

/// All cells of a grid of `shape`.
pub(super) fn whole(shape: [usize; 2]) -> Window {
    shape.map(|n| 0..n)
}

/// `cells` and a margin around them; the whole grid where that is not worth a window.
pub(super) fn widened(cells: &Window, shape: [usize; 2]) -> Window {
    let window = [0, 1]
        .map(|k| cells[k].start.saturating_sub(MARGIN)..(cells[k].end + MARGIN).min(shape[k]));
    let part = (window[0].len() * window[1].len()) as f64 / (shape[0] * shape[1]) as f64;
    if part > WORTH_WINDOW {
        whole(shape)
    } else {
        window
    }
}

/// The smallest window that holds both.
pub(super) fn hull(a: &Window, b: &Window) -> Window {
    [0, 1].map(|k| a[k].start.min(b[k].start)..a[k].end.max(b[k].end))
}

/// Rows and columns of an array.
pub(super) fn block<'a>(array: &'a ArrayRef2<f64>, [x, y]: &Window) -> ArrayView2<'a, f64> {
    let mut view = array.view();
    view.slice_axis_inplace(Axis(0), Slice::from(x.clone()));
    view.slice_axis_inplace(Axis(1), Slice::from(y.clone()));
    view
}

/// Its values, in C order.
pub(super) fn copied(array: &ArrayRef2<f64>, window: &Window) -> Vec<f64> {
    let mut values = Vec::with_capacity(window[0].len() * window[1].len());
    for row in block(array, window).rows() {
        values.extend(row);
    }
    values
}

/// The smallest window that holds all cells of which `member` holds; none without any.
pub(super) fn bounds(window: &Window, member: impl Fn(usize, usize) -> bool) -> Option<Window> {
    let mut found: Option<Window> = None;
    for i in window[0].clone() {
        let row = window[1].clone();
        let Some(first) = row.clone().find(|&j| member(i, j)) else {
            continue;
        };
        let last = row.rev().find(|&j| member(i, j)).unwrap_or(first);
        let line = [i..i + 1, first..last + 1];
        found = Some(found.map_or(line.clone(), |found| hull(&found, &line)));
    }
    found
}

impl Patch {
    /// All of a grid.
    pub(super) fn whole(pressure: &Array2<f64>) -> Self {
        let window = [0..pressure.nrows(), 0..pressure.ncols()];
        Self {
            window,
            values: pressure.iter().copied().collect(),
        }
    }

    pub(super) fn at(&self, i: usize, j: usize) -> f64 {
        let [x, y] = &self.window;
        if x.contains(&i) && y.contains(&j) {
            self.values[(i - x.start) * y.len() + j - y.start]
        } else {
            0.0
        }
    }

    /// The smallest window around its contact.
    pub(super) fn contact(&self) -> Option<Window> {
        bounds(&self.window, |i, j| self.at(i, j) > 0.0)
    }

    /// The same pressure in another window.
    pub(super) fn moved(&self, window: Window) -> Self {
        let [x, y] = window.clone();
        let values = x
            .flat_map(|i| y.clone().map(move |j| self.at(i, j)))
            .collect();
        Self { window, values }
    }

    /// Writes it into an array that is zero outside its window.
    pub(super) fn paste(&self, array: &mut Array2<f64>) {
        let [x, y] = &self.window;
        let rows = array.outer_iter_mut().skip(x.start);
        for (mut row, values) in rows.zip(self.values.chunks_exact(y.len())) {
            row.slice_axis_mut(Axis(0), Slice::from(y.clone()))
                .assign(&ArrayView1::from(values));
        }
    }

    /// Linear interpolation between the centres of its cells, on a grid of `shape` of which the
    /// directions of `halved` have half as many cells here; in a window around the contact.
    pub(super) fn interpolated(&self, shape: [usize; 2], halved: [bool; 2]) -> Self {
        let none = || [0..0, 0..0];
        let contact = self.contact().unwrap_or_else(none);
        let fine = [0, 1].map(|k| {
            let factor = if halved[k] { 2 } else { 1 };
            factor * contact[k].start..(factor * contact[k].end).min(shape[k])
        });
        let window = widened(&fine, shape);
        let taps = |k: usize, i: usize| -> [(usize, f64); 2] {
            if !halved[k] {
                return [(i, 1.0), (i, 0.0)];
            }
            let (near, last) = (i / 2, shape[k].div_ceil(2) - 1);
            let next = if i.is_multiple_of(2) {
                near.saturating_sub(1)
            } else {
                (near + 1).min(last)
            };
            [(near, 0.75), (next, 0.25)]
        };
        let [x, y] = &self.window;
        let line = |i: usize| {
            let inside = x.contains(&i);
            inside.then(|| &self.values[(i - x.start) * y.len()..][..y.len()])
        };
        let value = |line: Option<&[f64]>, j: usize| match line {
            Some(line) if y.contains(&j) => line[j - y.start],
            _ => 0.0,
        };
        let columns: Vec<_> = window[1].clone().map(|j| taps(1, j)).collect();
        let mut values = Vec::with_capacity(window[0].len() * window[1].len());
        for i in window[0].clone() {
            let [(near, wide), (next, narrow)] = taps(0, i).map(|(i, part)| (line(i), part));
            values.extend(columns.iter().map(|[(j, a), (k, b)]| {
                let here = value(near, *j);
                if here <= 0.0 {
                    // Interpolation would widen the contact by half a cell on every side.
                    return 0.0;
                }
                wide * (a * here + b * value(near, *k))
                    + narrow * (a * value(next, *j) + b * value(next, *k))
            }));
        }
        Self { window, values }
    }
}
