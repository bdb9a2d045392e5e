//! Derivatives of contacts of coated paraboloids approach those of the continuum.

use nacre::gradient::{LinearOptions, Linearisation, Output};
use nacre::{Elastic, Grid, Motion, Options, Paraboloid, Result};
use serde_json::Value;

use crate::support::reference::{cases, number};
use crate::support::settings::{plan, stack};

/// Cells along the contact radius.
const CELLS: f64 = 64.0;

/// Parts of a cell by which grids are moved; the number of cells in contact differs from each to the next.
const SHIFTS: [[f64; 2]; 5] = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.23, 0.11], [0.35, 0.71]];

/// Errors of ∂ ln δ and ∂ ln p0 at 64 cells a radius: each, their mean square over the shifts, and their mean. They are
/// those of a fixed number of cells in contact, not of the linear solves.
const BARS: [f64; 3] = [1e-3, 4e-4, 2e-4];

/// [`BARS`] for Poisson's ratio of a coating that is nearly incompressible, ν = 0.45: there a change of area counts 1/(1−2ν)
/// times as much.
const INCOMPRESSIBLE: [f64; 3] = [1.5e-3, 9e-4, 2e-4];

/// Paths of the parameters, their names in the data, and their values there.
const PATHS: [[&str; 3]; 6] = [
    ["body.layers[0].material.young", "d/dlnE1", "E1"],
    ["body.layers[0].material.poisson", "d/dnu1", "nu1"],
    ["body.substrate.young", "d/dlnE2", "E2"],
    ["body.substrate.poisson", "d/dnu2", "nu2"],
    ["body.layers[0].thickness", "d/dlnh", "h"],
    ["load", "d/dlnW", "W"],
];

/// Errors of all derivatives with one shift: of ln δ, then of ln p0.
fn errors(case: &Value, shift: [f64; 2]) -> Result<Vec<f64>> {
    let of = |key: &str| number(case, key);
    let body = stack(Elastic::new(of("E2"), of("nu2"))?, [[of("E1"), of("nu1"), of("h")]])?;
    let cell = of("a") / CELLS;
    let cells = (2.0 * CELLS) as usize + 12;
    let grid = Grid::new([cells; 2], [cells as f64 * cell; 2])?;
    let grid = grid.centered_at(shift.map(|part| part * cell))?;
    let shape = Paraboloid::new(of("R"), of("R"))?;
    let contact = plan(&body, grid)?;
    let solution = contact.solve(&shape, &Motion::load(of("W")), &Options::default())?;
    let plan = Linearisation::plan(&solution, Some(&shape), &LinearOptions::default())?;
    let outputs = [Output::Approach, Output::Pressure([0.0, 0.0])];
    let mut found = Vec::new();
    for (gradient, name) in plan.gradients(&outputs, None)?.iter().zip(["ln_delta", "ln_p0"]) {
        assert!(gradient.warnings.is_empty(), "{:?}", gradient.warnings);
        // With respect to logarithms; the data has the derivative with respect to a Poisson's ratio itself.
        let mut compare = |slope: f64, key: &str| {
            let factor = match key {
                "d/dnu1" => of("nu1"),
                "d/dnu2" => of("nu2"),
                _ => 1.0,
            };
            let expected = factor * number(&case["derivatives"][key], name);
            found.push(slope / gradient.value - expected);
        };
        for [path, key, value] in PATHS {
            compare(gradient.get(path).unwrap_or(f64::NAN) * of(value), key);
        }
        let radii = ["shape.radius_x", "shape.radius_y"];
        let sum: f64 = radii.iter().filter_map(|path| gradient.get(path)).sum();
        compare(sum * of("R"), "d/dlnR");
    }
    Ok(found)
}

#[test]
#[ignore = "slow"]
fn derivatives_of_coated_paraboloids_equal_those_of_the_continuum() -> Result<()> {
    // Central pressures below the peak belong to rubber on a hard base, whose error is that of its values.
    let compared =
        |case: &&Value| case["tip"] == "paraboloid" && number(case, "peak_over_p0") < 1.0 + 1e-12;
    let mut count = 0;
    for case in cases("sphere_derivatives.json").iter().filter(compared) {
        let found: Result<Vec<Vec<f64>>> = SHIFTS.iter().map(|at| errors(case, *at)).collect();
        let found = found?;
        for k in 0..found[0].len() {
            let at = || found.iter().map(move |errors| errors[k]);
            let of = |power: i32| at().map(|e| e.powi(power)).sum::<f64>() / SHIFTS.len() as f64;
            let most = at().fold(0.0, |a: f64, e| a.max(e.abs()));
            let is_rubber = k % 7 == 1 && number(case, "nu1") > 0.44;
            let bars = if is_rubber { INCOMPRESSIBLE } else { BARS };
            for (found, bar) in [most, of(2).sqrt(), of(1).abs()].into_iter().zip(bars) {
                below!(found, bar, k, case);
            }
        }
        count += 1;
    }
    assert!(count >= 4);
    Ok(())
}
