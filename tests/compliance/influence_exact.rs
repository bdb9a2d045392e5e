//! Exact influence coefficients equal Hankel quadrature for any stack, thickness and cell, and
//! their estimated error bounds the true one.

use std::f64::consts::PI;

use nacre::influence::{CellInfluence, Method, influence_coefficients};
use nacre::{Elastic, Grid, HalfSpace, Layer, Result, Substrate};
use serde_json::Value;

use crate::support::claims::claim;
use crate::support::reference::{cases, list, number};
use crate::support::settings::steel;

/// Error over the larger of |C| and the bare substrate's coefficient at that offset; on a rigid
/// base, 1e-3 of the bare coating's.
const EXACT: f64 = 1e-10;

/// Share of the bare coating's coefficient that errors on a rigid base are measured by.
const RIGID_SHARE: f64 = 1e-3;

/// Estimated over true error, in the median: the true one is taken at the few offsets that the data
/// have, and is often below rounding.
const PESSIMISM: f64 = 1e2;

/// Rounding of Love's closed form, whose corner terms cancel next to the cell.
const LOVE: f64 = 1e-12;

/// A point load and its quadrupole, a thousand cells away: terms of relative order 1e-14 are left.
const FAR: f64 = 1e-12;

/// The accuracy of `influence_coatings.json`.
const SECOND_PROGRAM: f64 = 3e-10;

/// Love (1929): displacement at (x, y) under unit pressure on a cell around the origin.
fn love(material: Elastic, [dx, dy]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    let corner = |x: f64, y: f64| {
        let term = |a: f64, b: f64| {
            if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() }
        };
        term(x, y) + term(y, x)
    };
    let [left, right] = [x - 0.5 * dx, x + 0.5 * dx];
    let [low, high] = [y - 0.5 * dy, y + 0.5 * dy];
    let sum = corner(right, high) - corner(left, high) - corner(right, low) + corner(left, low);
    sum / (PI * material.plane_strain_modulus())
}

/// Scale that the error of a coefficient is measured by: from Love's formula, or from the distance where
/// the formula has no digits left.
fn scale(body: &HalfSpace, cell: [f64; 2], offset: [f64; 2], c: f64) -> f64 {
    let bare = |material: Elastic| {
        let r = offset[0].hypot(offset[1]);
        if r < 1e3 * cell[0].max(cell[1]) {
            love(material, cell, offset)
        } else {
            cell[0] * cell[1] / (PI * material.plane_strain_modulus() * r)
        }
    };
    c.abs().max(match body.substrate() {
        Substrate::Elastic(material) => bare(material),
        Substrate::Rigid | Substrate::Free => RIGID_SHARE * bare(body.surface_material()),
    })
}

/// A case of the reference data: its body, its cell, and its plan.
fn planned(case: &Value) -> Result<(HalfSpace, [f64; 2], CellInfluence)> {
    let body = crate::support::bodies::body(case)?;
    let cell = [0, 1].map(|k| case["cell"][k].as_f64().unwrap_or(f64::NAN));
    let reach = rows(case, cell).fold(0.0_f64, |reach, row| reach.max(row.distance));
    let planned = CellInfluence::plan(&body, cell, reach.max(cell[0]))?;
    Ok((body, cell, planned))
}

struct Row {
    offset: [f64; 2],
    distance: f64,
    c: f64,
    /// Error of the reference value c.
    error: f64,
}

fn rows(case: &Value, [dx, dy]: [f64; 2]) -> impl Iterator<Item = Row> {
    list(case, "rows").iter().map(move |row| {
        let offset = [number(row, "i") * dx, number(row, "j") * dy];
        Row {
            offset,
            distance: offset[0].hypot(offset[1]),
            c: number(row, "c"),
            error: row["error"].as_f64().unwrap_or(0.0),
        }
    })
}

/// The largest error over all rows of `file`, and the number of rows.
fn largest_error(file: &str) -> Result<(f64, usize)> {
    let (mut worst, mut compared) = (0.0_f64, 0);
    for case in cases(file) {
        let (body, cell, planned) = planned(&case)?;
        for row in rows(&case, cell) {
            let error = planned.at(row.offset) - row.c;
            let error = (error.abs() - row.error).max(0.0);
            worst = worst.max(error / scale(&body, cell, row.offset, row.c));
            compared += 1;
        }
    }
    Ok((worst, compared))
}

#[test]
#[ignore = "slow"]
fn coefficients_of_random_bodies_equal_hankel_quadrature() -> Result<()> {
    let (worst, compared) = largest_error("influence_random.json")?;
    assert!(compared > 1000, "{compared}");
    claim("influence", worst);
    Ok(())
}

#[test]
fn coefficients_of_coatings_equal_those_of_a_second_program() -> Result<()> {
    let (worst, compared) = largest_error("influence_coatings.json")?;
    assert_eq!(compared, 48);
    below!(worst, SECOND_PROGRAM);
    Ok(())
}

#[test]
#[ignore = "slow"]
fn estimated_error_bounds_the_true_one_and_is_no_guess() -> Result<()> {
    // Errors of C r/(dx dy), as the estimate's description says.
    let mut ratios = Vec::new();
    for (number, case) in cases("influence_random.json").iter().enumerate() {
        let (body, cell, planned) = planned(case)?;
        let mut worst = 0.0_f64;
        for row in rows(case, cell) {
            let r = row.distance.max(0.5 * cell[0].min(cell[1]));
            let form = r / (cell[0] * cell[1]);
            let true_error = (planned.at(row.offset) - row.c).abs();
            // Less the reference's own error, and the rounding of the result.
            let known = row.error + 4.0 * f64::EPSILON * row.c.abs();
            worst = worst.max((true_error - known) * form);
        }
        let estimate = planned.error();
        assert!(worst <= estimate, "case {number}: {worst:e} > {estimate:e}");
        if worst > 0.0 {
            ratios.push(estimate / worst);
        }

        // The estimate meets what is asked: 1e-9 of the softer of surface and substrate.
        let softest = match body.substrate() {
            Substrate::Elastic(s) => {
                s.plane_strain_modulus().min(body.surface_material().plane_strain_modulus())
            }
            Substrate::Rigid | Substrate::Free => body.surface_material().plane_strain_modulus(),
        };
        let asked = 1e-9 / (PI * softest);
        assert!(estimate < asked, "case {number}: {estimate:e} > {asked:e}");
    }
    ratios.sort_by(f64::total_cmp);
    below!(ratios[ratios.len() / 2], PESSIMISM);
    Ok(())
}

#[test]
fn bare_body_equals_love() -> Result<()> {
    let steel = steel()?;
    for cell in [[1.0, 1.0], [2.0, 0.5], [1e-3, 1.0]] {
        let planned = CellInfluence::plan(steel, cell, 1e4)?;
        let at = |i: f64, j: f64| [i * cell[0], j * cell[1]];
        for [i, j] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [2.0, 3.0], [0.5, 0.5]] {
            let offset = at(i, j);
            let due = love(steel, cell, offset);
            near!(planned.at(offset), due, LOVE, cell, offset);
        }
        // Far away, a point load and its quadrupole, (dx²(2x²−y²) + dy²(2y²−x²))/24r⁴.
        let [x, y] = [3e3, 4e3];
        let r2 = 25e6;
        let [a, b] = [cell[0] * cell[0], cell[1] * cell[1]];
        let quadrupole = (a * (2.0 * x * x - y * y) + b * (2.0 * y * y - x * x)) / (24.0 * r2 * r2);
        let point = cell[0] * cell[1] / (PI * steel.plane_strain_modulus() * 5e3);
        near!(planned.at([x, y]), point * (1.0 + quadrupole), FAR, cell);
    }
    Ok(())
}

/// Layered bodies of all kinds, over cells of 1 µm.
fn some_bodies() -> Result<[HalfSpace; 3]> {
    let (steel, hard) = (steel()?, Elastic::new(800e9, 0.2)?);
    let soft = Elastic::new(3e9, 0.4)?;
    Ok([
        HalfSpace::new(steel, [Layer::new(hard, 2e-6)?])?,
        HalfSpace::new(steel, [Layer::new(hard, 1e-8)?, Layer::new(soft, 5e-6)?])?,
        HalfSpace::new(Substrate::Rigid, [Layer::new(soft, 1e-5)?])?,
    ])
}

#[test]
fn coefficients_of_a_grid_are_those_of_its_cell() -> Result<()> {
    let (nx, ny) = (12, 7);
    let grid = Grid::new([nx, ny], [12e-6, 14e-6])?;
    let [dx, dy] = grid.spacing();
    for body in some_bodies()? {
        let coefficients = influence_coefficients(&body, &grid, Method::Exact)?;
        assert_eq!(coefficients.dim(), (nx, ny));
        // Another reach: other tables, the same function.
        let planned = CellInfluence::plan(&body, [dx, dy], 1e-3)?;
        for ((i, j), c) in coefficients.indexed_iter() {
            let offset = [i as f64 * dx, j as f64 * dy];
            let difference = (c - planned.at(offset)).abs();
            let tolerance = EXACT * scale(&body, [dx, dy], offset, *c);
            below!(difference, tolerance, i, j);
        }
    }
    Ok(())
}

#[test]
fn displacement_is_continuous_across_the_rim_of_the_cell() -> Result<()> {
    for body in some_bodies()? {
        let cell = CellInfluence::plan(&body, [1e-6, 2e-6], 1e-5)?;
        for [x, y] in [[0.5, 0.0], [0.0, 1.0], [0.5, 1.0], [0.2, 1.0], [0.5, 2.0]] {
            let rim = [x * 1e-6, y * 1e-6];
            let inside = cell.at(rim.map(|x| x * (1.0 - 1e-12)));
            near!(cell.at(rim), inside, 1e-9, rim);
        }
    }
    Ok(())
}

#[test]
fn coefficients_are_even_and_turn_with_the_cell() -> Result<()> {
    for body in some_bodies()? {
        let cell = CellInfluence::plan(&body, [1e-6, 3e-6], 1e-4)?;
        let turned = CellInfluence::plan(&body, [3e-6, 1e-6], 1e-4)?;
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [0.0, 3.0], [2.0, 6.0], [40.0, 3.0]] {
            let offset = [x, y].map(|x| x * 1e-6);
            let [x, y] = offset;
            let c = cell.at(offset);
            for other in [cell.at([-x, y]), cell.at([x, -y]), turned.at([y, x])] {
                let tolerance = 1e-13 * scale(&body, [1e-6, 3e-6], offset, c);
                assert!((other - c).abs() <= tolerance, "{offset:?}: {c:e}");
            }
        }
    }
    Ok(())
}

#[test]
fn small_cells_sum_to_the_large_one() -> Result<()> {
    // Nine cells of a third: pressure is uniform over all of them.
    for body in some_bodies()? {
        let large = CellInfluence::plan(&body, [3e-6, 6e-6], 1e-4)?;
        let small = CellInfluence::plan(&body, [1e-6, 2e-6], 1e-4)?;
        for offset in [[0.0, 0.0], [3e-6, 0.0], [1e-6, 1e-6], [2e-5, 3e-5]] {
            let sum: f64 = (-1..=1)
                .flat_map(|i| (-1..=1).map(move |j| (f64::from(i), f64::from(j))))
                .map(|(i, j)| small.at([offset[0] + i * 1e-6, offset[1] + j * 2e-6]))
                .sum();
            let c = large.at(offset);
            let tolerance = EXACT * scale(&body, [3e-6, 6e-6], offset, c);
            below!((sum - c).abs(), tolerance, offset, c, sum);
        }
    }
    Ok(())
}
