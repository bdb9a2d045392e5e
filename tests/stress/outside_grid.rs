//! Extremes that lie beyond the grid: those of a summary on a narrow grid are those on a grid four times as wide.

use ndarray::Array2;

use crate::support::stresses::sliding;
use nacre::stress::{Peak, Strengths, StressSummary};
use nacre::{Elastic, Grid, HalfSpace, Layer, Result, StressOptions, StressPlan};

/// The wider grids of a summary end where a peak grows by less than 1e-3 from one to the next. Growth falls at least by half
/// from grid to grid, since stress falls off at least as the distance: what is left is at most as much again.
const REST: f64 = 2e-3;

/// A thick stiff coating on a soft body.
fn body() -> Result<HalfSpace> {
    HalfSpace::new(Elastic::new(1.0, 0.4)?, [Layer::new(Elastic::new(60.0, 0.3)?, 0.6)?])
}

/// √(1 − r²) in the unit circle, or strip, around a point.
fn pressure(grid: &Grid, [x0, y0]: [f64; 2]) -> Array2<f64> {
    let (x, y) = (grid.x(), grid.y());
    Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let x = if grid.is_line() { 0.0 } else { x[i] - x0 };
        (1.0 - x * x - (y[j] - y0).powi(2)).max(0.0).sqrt()
    })
}

/// `grid`, with cells added to each side along the `axes`.
fn wider(grid: &Grid, axes: [bool; 2], added: usize) -> Result<Grid> {
    let added = axes.map(|wide| if wide { 2 * added } else { 0 });
    let shape = [0, 1].map(|axis| grid.shape()[axis] + added[axis]);
    let size = [0, 1].map(|axis| shape[axis] as f64 * grid.spacing()[axis]);
    let wide =
        if grid.is_line() { Grid::line(shape[1], size[1])? } else { Grid::new(shape, size)? };
    wide.periodic(grid.is_periodic())?.centered_at(grid.center())
}

fn peaks(summary: &StressSummary) -> Vec<Peak> {
    let layers = summary.layers.iter().flat_map(|l| [l.von_mises, l.tension, l.shear]);
    let interfaces = summary.interfaces.iter();
    let interfaces =
        interfaces.flat_map(|f| [Some(f.tension), Some(f.compression), Some(f.shear), f.jump]);
    layers.chain(interfaces.flatten()).collect()
}

/// Compares both grids; returns how many peaks lie beyond the narrow one.
fn check(
    body: &HalfSpace,
    (grid, axes, added): (Grid, [bool; 2], usize),
    options: &StressOptions,
) -> Result<usize> {
    let wide = wider(&grid, axes, added)?;
    let summary = |grid: &Grid, pressure: Array2<f64>| -> Result<_> {
        let plan = StressPlan::plan(body, grid, &pressure, None)?;
        Ok(peaks(&plan.summary(&Strengths::default(), options)?))
    };
    let centre = grid.center();
    let (found, expected) =
        (summary(&grid, pressure(&grid, centre))?, summary(&wide, pressure(&wide, centre))?);
    let mut beyond = 0;
    for (found, expected) in found.iter().zip(&expected) {
        let error = found.value / expected.value - 1.0;
        assert!(error.abs() < REST, "{found:?} {expected:?}: {error:.1e}");
        let far =
            |axis: usize| (found.position[axis] - centre[axis]).abs() > 0.5 * grid.size()[axis];
        beyond += usize::from(far(0) || far(1));
    }
    Ok(beyond)
}

/// Without friction and with it, on even and odd numbers of cells, in a line contact, and where the grid repeats along x.
#[test]
#[ignore = "slow"]
fn extremes_beyond_the_grid_are_those_of_a_wide_grid() -> Result<()> {
    let still = StressOptions::default();
    let rough = sliding(0.3, [0.6, 0.8]);
    let (body, both) = (body()?, [true, true]);
    for (shape, size) in [([40, 40], [2.5, 2.5]), ([41, 52], [2.5, 3.2])] {
        let grid = Grid::new(shape, size)?.centered_at([0.3, -0.2])?;
        for options in [&still, &rough] {
            assert!(check(&body, (grid, both, 120), options)? >= 2);
        }
    }
    let line = Grid::line(50, 2.5)?;
    assert!(check(&body, (line, [false, true], 120), &sliding(0.3, [0.0, 1.0]))? >= 1);
    let repeated = Grid::new([48, 40], [3.0, 2.5])?.periodic([true, false])?;
    assert!(check(&body, (repeated, [false, true], 120), &still)? >= 1);
    Ok(())
}

/// The stress below the load is a local maximum within the grid, and where layers bend the other way, beyond it, is a larger one.
#[test]
#[ignore = "slow"]
fn a_local_maximum_within_the_grid_does_not_hide_one_beyond() -> Result<()> {
    let soft = Elastic::new(1.0, 0.3)?;
    let stacks: [&[(f64, f64, f64)]; 3] = [
        &[(1.2, 38.0, 0.41)],
        &[(0.7, 16.0, 0.02), (2.9, 0.07, 0.42), (0.1, 64.0, 0.45)],
        &[(2.75, 0.38, 0.21)],
    ];
    for stack in stacks {
        let layer = |(h, e, nu): &(f64, f64, f64)| Layer::new(Elastic::new(*e, *nu)?, *h);
        let body = HalfSpace::new(soft, stack.iter().map(layer).collect::<Result<Vec<_>>>()?)?;
        let grid = Grid::new([24, 24], [2.6, 2.6])?;
        assert!(check(&body, (grid, [true; 2], 90), &StressOptions::default())? >= 1);
    }
    Ok(())
}

/// Below layers, tractions pull far behind themselves: on a grid that ends before, the tension is that of a wide one.
#[test]
#[ignore = "slow"]
fn the_tension_behind_a_traction_is_found() -> Result<()> {
    let soft = Elastic::new(1.0, 0.3)?;
    for (young, friction) in [(1.5, 0.3), (0.3, 0.1)] {
        let body = HalfSpace::new(soft, [Layer::new(Elastic::new(young, 0.3)?, 2.0)?])?;
        let grid = Grid::line(64, 3.2)?;
        let options = sliding(friction, [0.0, 1.0]);
        assert!(check(&body, (grid, [false, true], 1000), &options)? >= 1);
    }
    Ok(())
}

/// Layers of any thickness and stiffness end the search, and so does a body that ends on one side of the load.
#[test]
#[ignore = "slow"]
fn the_search_ends() -> Result<()> {
    let base = Elastic::new(1.0, 0.3)?;
    let grid = Grid::new([16, 16], [2.5, 2.5])?;
    let summary = |body: HalfSpace, options: &StressOptions| -> Result<StressSummary> {
        let plan = StressPlan::plan(&body, &grid, &pressure(&grid, [0.0; 2]), None)?;
        plan.summary(&Strengths::default(), options)
    };
    let still = StressOptions::default();
    for (thickness, young) in [(1e9, 1e9), (1e20, 1e-9), (1e-20, 1e20)] {
        let layer = Layer::new(Elastic::new(young, 0.3)?, thickness)?;
        let summary = summary(HalfSpace::new(base, [layer])?, &still)?;
        assert!(summary.finished);
        assert!(peaks(&summary).iter().all(|peak| peak.value.is_finite()));
    }
    let ended = HalfSpace::from(base).with_ends([Some(-1.25), None])?;
    assert!(summary(ended, &still)?.finished);
    Ok(())
}
