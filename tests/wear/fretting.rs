//! The end of fretting: where a zone sticks and the rest wears until it carries nothing.
//!
//! `tests/data/wear/fretting_limit.json`, closed forms.

use std::sync::Arc;

use nacre::wear::{Slip, Wear, WearScheme, WearSession, WearState, WearSteps};
use nacre::{Contact, Elastic, Grid, Motion, Options, Paraboloid, Result, Setup};
use ndarray::Array2;
use serde_json::Value;

use super::waves::states;
use crate::support::reference::{list, number, read};

/// So large that a circle is a parabola. Pressures, loads and depths of the reference are divided by it.
const RADIUS: f64 = 1e3;

/// The worn contact on a grid, where cells within `stick` do not slip.
fn worn(grid: Grid, stick: f64, motion: Motion) -> Result<WearState> {
    let (x, y) = (grid.x(), grid.y());
    let slip = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let along = if grid.is_line() { 0.0 } else { x[i] };
        f64::from(along.hypot(y[j]) > stick)
    });
    let plan = Arc::new(Contact::plan(Elastic::new(1.0, 0.0)?, grid, Setup::default())?);
    // What is left of the pressure outside is a part 1/κΔs each time.
    let ends = [1.0, 10.0, 1e2, 1e3, 1e4, 2e4];
    let wear = Wear {
        slip: Slip::Cells(slip),
        steps: WearSteps::Ends(ends.to_vec()),
        scheme: WearScheme::Euler,
        options: Options { tolerance: 1e-12, ..Options::default() },
        ..Wear::sliding([vec![1.0], vec![0.0]], 2e4)
    };
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let mut states = states(WearSession::new(plan, shape, motion, wear, false)?)?;
    Ok(states.pop().expect("a state"))
}

/// Change of the logarithm of the worn volume with c, from the next row, or from the one before. The stick zone of cells ends
/// within half a cell of c, so that half a cell of it is the error.
fn slope(rows: &Value, row: &Value) -> f64 {
    let alike = |other: &&Value| {
        other["shape"] == row["shape"]
            && (number(other, "c") - number(row, "c")).abs() > 0.1
            && (other["shape"] == "cylinder" || (number(other, "approach") - 1.0).abs() < 1e-9)
    };
    let near = |other: &&Value| (number(other, "c") - number(row, "c") - 0.15).abs();
    let others = list(rows, "rows").iter().filter(alike);
    let other = others.min_by(|a, b| near(a).total_cmp(&near(b))).expect("another row");
    let change = |key: &str| number(other, key) - number(row, key);
    ((number(other, "worn") / number(row, "worn")).ln() / change("c")).abs()
}

#[test]
fn cylinders_end_on_their_stick_zone() -> Result<()> {
    let rows = read("wear/fretting_limit.json");
    for row in list(&rows, "rows").iter().filter(|row| row["shape"] == "cylinder") {
        let number = |key| number(row, key);
        let grid = Grid::line(256, 3.2)?;
        let state = worn(grid, number("c"), Motion::load(number("load") / RADIUS))?;
        let pressure = &state.solution.pressure;
        let (middle, peak) = (pressure[[0, 128]], state.solution.peak_pressure());
        let bar = 0.5 * grid.spacing()[1];
        near!(middle * RADIUS, number("p_centre"), bar / number("c"), row);
        near!(
            state.depth[0].sum() * grid.cell_area() * RADIUS,
            number("worn"),
            bar * slope(&rows, row),
            row
        );
        let y = grid.y();
        for ((_, j), p) in pressure.indexed_iter() {
            assert!(y[j].abs() < number("c") || *p < 1e-8 * peak, "{p:e}");
        }
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn balls_end_on_their_stick_zone() -> Result<()> {
    let rows = read("wear/fretting_limit.json");
    for row in list(&rows, "rows").iter().filter(|row| row["shape"] == "ball") {
        let number = |key| number(row, key);
        if (number("approach") - 1.0).abs() > 1e-9 {
            continue;
        }
        let grid = Grid::new([128, 128], [2.8, 2.8])?;
        let state = worn(grid, number("c"), Motion::approach(1.0 / RADIUS))?;
        let (middle, area) = (state.solution.pressure[[64, 64]], grid.cell_area());
        let bar = 0.5 * grid.spacing()[0];
        near!(middle * RADIUS, number("p_centre"), bar / number("c"), row);
        near!(state.depth[0].sum() * area * RADIUS, number("worn"), bar * slope(&rows, row), row);
    }
    Ok(())
}
