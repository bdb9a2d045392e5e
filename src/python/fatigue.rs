//! Shakedown and fatigue of histories, for `nacre.fatigue`.

use ndarray::{Array1, Array2, ArrayD, Ix3};
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::arguments::{Real, real_array, word};
use super::background;
use crate::fatigue::{Criterion, State, shakedown as shaken};
use crate::numerics::parallel::{Threads, each_chunk};

/// A value for each history.
type Row<'py, T> = Bound<'py, PyArray1<T>>;

/// Values of each history.
type Table<'py, T> = Bound<'py, PyArray2<T>>;

/// Constants of a criterion: factor and limit.
#[pyfunction]
pub(super) fn fatigue_constants(kind: &str, bending: Real, torsion: Real) -> PyResult<(f64, f64)> {
    let criterion = Criterion::new(word("kind", kind)?, bending.0, torsion.0)?;
    Ok((criterion.factor(), criterion.limit()))
}

/// Equivalent stress, deciding state and gap (NaN where there is none) of each history (n, times, 6).
#[pyfunction]
pub(super) fn fatigue_stress<'py>(
    py: Python<'py>,
    kind: &str,
    bending: Real,
    torsion: Real,
    history: &Bound<'py, PyAny>,
) -> PyResult<(Row<'py, f64>, Row<'py, usize>, Row<'py, f64>)> {
    let criterion = Criterion::new(word("kind", kind)?, bending.0, torsion.0)?;
    let equivalents = each(py, history, move |states| criterion.stress(states))?;
    let numbers = |of: fn(&crate::fatigue::Equivalent) -> f64| {
        equivalents.iter().map(of).collect::<Array1<f64>>().into_pyarray(py)
    };
    let at: Array1<usize> = equivalents.iter().map(|equivalent| equivalent.at).collect();
    let stresses = numbers(|equivalent| equivalent.stress);
    Ok((stresses, at.into_pyarray(py), numbers(|equivalent| equivalent.gap.unwrap_or(f64::NAN))))
}

/// Yield stress in shear and residual stresses (x, y) of the shakedown of each history (n, times, 6), its first yield,
/// and the states that decide both.
#[pyfunction]
pub(super) fn shakedown<'py>(
    py: Python<'py>,
    history: &Bound<'py, PyAny>,
    rule: &str,
) -> PyResult<(Table<'py, f64>, Table<'py, usize>)> {
    let rule = word("rule", rule)?;
    let limits = each(py, history, move |states| shaken(states, rule))?;
    let rows = limits.iter().map(|one| {
        let [x, y] = one.residual;
        [one.shear_yield, x, y, one.first_yield]
    });
    let values = Array2::from(rows.collect::<Vec<_>>());
    let at = Array2::from(limits.iter().map(|one| one.at).collect::<Vec<_>>());
    Ok((values.into_pyarray(py), at.into_pyarray(py)))
}

/// What `work` makes of each history, in parallel, on a thread of its own.
fn each<T: Send + 'static>(
    py: Python<'_>,
    history: &Bound<'_, PyAny>,
    work: impl Fn(&[State]) -> crate::Result<T> + Send + Sync + 'static,
) -> PyResult<Vec<T>> {
    let stresses: ArrayD<f64> = real_array("history", history)?;
    let shape = stresses.shape().to_vec();
    let stresses = stresses.into_dimensionality::<Ix3>().ok().filter(|all| all.dim().2 == 6);
    let stresses = stresses.ok_or_else(|| {
        PyValueError::new_err(format!("history must have the shape (…, times, 6), got {shape:?}"))
    })?;
    let histories: Vec<Vec<State>> = stresses
        .outer_iter()
        .map(|one| {
            one.rows().into_iter().map(|state| [0, 1, 2, 3, 4, 5].map(|k| state[k])).collect()
        })
        .collect();
    let threads = Threads::new(None)?;
    let outcomes = background::run(py, None, move |caller: &mut background::Caller<(f64,)>| {
        let mut outcomes: Vec<Option<crate::Result<T>>> = histories.iter().map(|_| None).collect();
        let several = 4 * threads.count();
        for (results, histories) in outcomes.chunks_mut(several).zip(histories.chunks(several)) {
            if caller.go_on().is_break() {
                break;
            }
            threads.run(|| {
                each_chunk(results, 1, 0, &|number, result| {
                    result[0] = Some(work(&histories[number]));
                });
            });
        }
        outcomes.into_iter().flatten().collect::<crate::Result<Vec<T>>>()
    })?;
    Ok(outcomes?)
}
