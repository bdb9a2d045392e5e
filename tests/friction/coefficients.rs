//! Influence coefficients of tractions.

use std::f64::consts::PI;

use nacre::{Elastic, Grid, HalfSpace, Layer, Result, TractionCoefficients, traction_coefficients};
use ndarray::Array2;

use crate::support::bodies::body_by;
use crate::support::checks::apart;
use crate::support::reference::{list, number, read};
use crate::support::settings::stack;

/// All five coefficients agree with two independent computations of the reference, to 1e-10 of the self-coefficient.
#[test]
fn coefficients_are_those_of_the_reference() -> Result<()> {
    let reference = read("friction/tangential_coefficients.json");
    for stack in list(&reference, "stacks") {
        let (dx, dy) = (number(stack, "dx"), number(stack, "dy"));
        let grid = Grid::new([64, 32], [64.0 * dx, 32.0 * dy])?;
        let c = traction_coefficients(body_by(["E", "nu", "h"], stack, 1.0)?, &grid)?;
        let own = c.xx[[0, 0]];
        for row in list(stack, "rows") {
            let at = [number(row, "i") as usize, number(row, "j") as usize];
            for (found, name) in [(&c.xx, "ux"), (&c.xy, "uy"), (&c.zx, "uz")] {
                let error = (found[at] - number(row, name)).abs() / own;
                below!(error, 1e-10, stack["name"], at, name);
            }
        }
    }
    Ok(())
}

/// Cells of a bare body, and of one with a layer of the same material, which is integrated: near, and at 60 cells.
#[test]
fn bare_cells_are_in_closed_form() -> Result<()> {
    let (nu, g) = (0.3, 1.0);
    let bare = Elastic::new(2.0 * g * (1.0 + nu), nu)?;
    let (dx, dy) = (1.0, 0.25);
    let grid = Grid::new([64, 64], [64.0 * dx, 64.0 * dy])?;
    let c = traction_coefficients(bare, &grid)?;
    let coated = HalfSpace::new(bare, [Layer::new(bare, 0.5)?])?;
    let integrated = traction_coefficients(coated, &grid)?;
    let asinh = |y: f64, x: f64| {
        if y == 0.0 || x == 0.0 { 0.0 } else { (y / x.abs()).asinh() }
    };
    let own = c.xx[[0, 0]];
    for [i, j] in [[0, 0], [1, 0], [0, 1], [3, 2], [1, 20], [10, 7], [60, 11]] {
        let at = [i as f64 * dx, j as f64 * dy];
        let corners = |f: &dyn Fn(f64, f64) -> f64| {
            let (a, b) = (0.5 * dx, 0.5 * dy);
            f(at[0] + a, at[1] + b) - f(at[0] - a, at[1] + b) - f(at[0] + a, at[1] - b)
                + f(at[0] - a, at[1] - b)
        };
        let fa = |x: f64, y: f64| x * asinh(y, x) + y * asinh(x, y);
        let fxx = |x: f64, y: f64| y * asinh(x, y);
        let fxy = |x: f64, y: f64| -x.hypot(y);
        // Where a factor is 0, so is the product.
        let times = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * b };
        let fx = |x: f64, y: f64| times(y, x.hypot(y).ln()) + times(x, (y / x).atan());
        let exact = [
            ((1.0 - nu) * corners(&fa) + nu * corners(&fxx)) / (2.0 * PI * g),
            nu * corners(&fxy) / (2.0 * PI * g),
            (1.0 - 2.0 * nu) * corners(&fx) / (4.0 * PI * g),
        ];
        // Near the load, rounding; far from it, that of the differences of corners.
        let rounding = if i == 60 { 1e-11 } else { 1e-13 };
        let found = [&c.xx, &c.xy, &c.zx].map(|c| c[[i, j]]);
        let layered = [&integrated.xx, &integrated.xy, &integrated.zx].map(|c| c[[i, j]]);
        for ((found, layered), exact) in found.into_iter().zip(layered).zip(exact) {
            below!((found - exact).abs() / own, rounding, i, j, exact);
            below!((layered - exact).abs() / own, 1e-10, i, j, exact);
        }
    }
    Ok(())
}

/// Exchanging x and y exchanges the coefficients; two equal layers are none; ν = ½ alone is not coupled.
#[test]
fn coefficients_have_their_symmetries() -> Result<()> {
    let soft = Elastic::new(1.0, 0.3)?;
    let coated = stack(soft, [[4.0, 0.3, 0.4]])?;
    let grid = Grid::new([24, 16], [24.0, 8.0])?;
    let turned = Grid::new([16, 24], [8.0, 24.0])?;
    let close = |a: &TractionCoefficients, b: &TractionCoefficients, error: f64| {
        let ours = [&a.xx, &a.yy, &a.xy, &a.zx, &a.zy];
        for (a, b) in ours.into_iter().zip([&b.xx, &b.yy, &b.xy, &b.zx, &b.zy]) {
            below!(apart(a, b), error);
        }
    };
    // The coefficients of a grid with x and y exchanged, in the order of the first.
    let exchanged = |c: TractionCoefficients| {
        let turn = |a: Array2<f64>| a.reversed_axes();
        TractionCoefficients {
            xx: turn(c.yy),
            yy: turn(c.xx),
            xy: turn(c.xy),
            zx: turn(c.zy),
            zy: turn(c.zx),
        }
    };
    let c = traction_coefficients(&coated, &grid)?;
    close(&c, &exchanged(traction_coefficients(&coated, &turned)?), 1e-11);
    let split = stack(soft, [[4.0, 0.3, 0.1], [4.0, 0.3, 0.3]])?;
    close(&c, &traction_coefficients(&split, &grid)?, 1e-10);
    let bare = traction_coefficients(Elastic::new(3.0, 0.5)?, &grid)?;
    assert!(bare.zx.iter().chain(&bare.zy).all(|c| *c == 0.0));
    let own = c.xx[[0, 0]];
    assert!(c.zx[[1, 0]].abs() > 1e-3 * own && c.zx[[0, 3]] == 0.0 && c.xy[[3, 0]] == 0.0);
    Ok(())
}

/// Strips of line contact are columns of cells along x: sums of cells over a line, extrapolated to an endless one. What
/// a line of n cells lacks is of second order in 1/n, of first in u_z; the next order is (15/1024)⁴ and (15/1024)³.
#[test]
fn strips_are_rows_of_cells() -> Result<()> {
    let coated = stack(Elastic::new(1.0, 0.3)?, [[4.0, 0.3, 0.7]])?;
    let strips = traction_coefficients(&coated, &Grid::line(16, 16.0)?)?;
    let cells = |n: usize| traction_coefficients(&coated, &Grid::new([n, 16], [n as f64, 16.0])?);
    let (coarse, fine) = (cells(1024)?, cells(2048)?);
    let row = |c: &Array2<f64>, j: usize| c.column(j).sum() * 2.0 - c[[0, j]];
    for j in 1..16 {
        for (strip, coarse, fine) in
            [(&strips.xx, &coarse.xx, &fine.xx), (&strips.yy, &coarse.yy, &fine.yy)]
        {
            let [coarse, fine] = [coarse, fine].map(|c| row(c, j) - row(c, 0));
            let due = (4.0 * fine - coarse) / 3.0;
            near!(strip[[0, j]] - strip[[0, 0]], due, 1e-6, j);
        }
        let due = 2.0 * row(&fine.zy, j) - row(&coarse.zy, j);
        near!(strips.zy[[0, j]], due, 3e-5, j);
    }
    Ok(())
}
