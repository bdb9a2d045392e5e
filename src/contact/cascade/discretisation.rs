//! How far a solution is from that of ever finer cells, from the cascade's own grids.

/// Estimated errors that the size of the cells leaves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Discretisation {
    /// Of the peak pressure \[Pa\].
    pub peak_pressure: f64,
    /// Of the approach \[m\]; 0 where it is prescribed.
    pub approach: f64,
    /// Of the load \[N\]; 0 where it is prescribed.
    pub load: f64,
}

/// What a grid gives.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Figures {
    pub(crate) peak_pressure: f64,
    pub(crate) approach: f64,
    pub(crate) load: f64,
}

/// The error of the last of `figures`, each from cells half as long as those before; none where there
/// are fewer than two.
///
/// With errors that fall as dx^q, f(dx) − f(0) = (f(2dx) − f(dx))/(2^q − 1). The rate is observed, and
/// taken between 1 and 2: a smooth contact has 2, the approach of one with sharp edges 1 (its peak grows
/// without end). Since the edge of
/// the contact jumps from cell to cell, a change may be small by chance: those of the last three grids
/// are taken, each scaled to the finest, and the largest counts.
pub(crate) fn estimate(figures: &[Figures]) -> Option<Discretisation> {
    let error = |value: fn(&Figures) -> f64| -> Option<f64> {
        let changes: Vec<f64> = figures
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
            .zip(0..GRIDS)
            .map(|(c, k)| c / growth.powi(k));
        Some(scaled.fold(0.0, f64::max) / (growth - 1.0))
    };
    Some(Discretisation {
        peak_pressure: error(|f| f.peak_pressure)?,
        approach: error(|f| f.approach)?,
        load: error(|f| f.load)?,
    })
}

/// How many changes are looked at.
const GRIDS: i32 = 3;
