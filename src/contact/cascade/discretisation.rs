//! Discretisation error of a solution, estimated from the cascade's coarser grids: a method of nacre's own.

/// Estimated discretisation errors: differences from the limit of ever finer cells.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Discretisation {
    /// Error of the peak pressure \[Pa\].
    pub peak_pressure: f64,
    /// Error of the approach \[m\]; 0 where the approach is prescribed.
    pub approach: f64,
    /// Error of the load \[N\]; 0 where the load is prescribed.
    pub load: f64,
}

/// Results on one grid that are compared with those on other grids.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GridResult {
    pub(crate) peak_pressure: f64,
    pub(crate) approach: f64,
    pub(crate) load: f64,
}

/// Number of changes from grid to grid that are looked at; chosen by trial.
const CHANGES: i32 = 3;

/// The error of the last of `results`; each result is from cells half as long as the one before. `None`
/// where there are fewer than two results.
///
/// With errors that fall as dx^q, f(dx) − f(0) = (f(2dx) − f(dx))/(2^q − 1). The rate q is observed, and
/// limited to 1 … 2: a smooth contact has 2; the approach of a contact with sharp edges has 1, while its
/// peak grows without end. The edge of the contact jumps from cell to cell, so that a change may be small
/// by chance: the last three changes are taken, each scaled to the finest grid, and the largest counts.
pub(crate) fn estimate(results: &[GridResult]) -> Option<Discretisation> {
    let error = |value: fn(&GridResult) -> f64| -> Option<f64> {
        let changes: Vec<f64> = results
            .windows(2)
            .rev()
            .map(|pair| (value(&pair[1]) - value(&pair[0])).abs())
            .collect();
        let last = *changes.first()?;
        let rate = match changes.get(1) {
            Some(before) if last > 0.0 => (before / last).log2().clamp(1.0, 2.0),
            Some(_) => 2.0,
            None => 1.0,
        };
        let growth = rate.exp2();
        let scaled = changes
            .iter()
            .zip(0..CHANGES)
            .map(|(c, k)| c / growth.powi(k));
        Some(scaled.fold(0.0, f64::max) / (growth - 1.0))
    };
    Some(Discretisation {
        peak_pressure: error(|f| f.peak_pressure)?,
        approach: error(|f| f.approach)?,
        load: error(|f| f.load)?,
    })
}
