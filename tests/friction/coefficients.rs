//! Influence coefficients of tractions.

use std::f64::consts::PI;

use nacre::{
    Elastic, Grid, HalfSpace, Interface, Layer, Result, TractionCoefficients, traction_coefficients,
};
use serde_json::Value;

use crate::support::reference::{list, number, read};

fn body(stack: &Value) -> Result<HalfSpace> {
    let elastic = |value: &Value| Elastic::new(number(value, "E"), number(value, "nu"));
    let layers = list(stack, "layers").iter();
    let layers = layers.map(|layer| Layer::new(elastic(layer)?, number(layer, "h")));
    HalfSpace::new(
        elastic(&stack["substrate"])?,
        layers.collect::<Result<Vec<_>>>()?,
    )
}

/// All five coefficients agree with two independent computations of the reference, to 1e-10 of the self-coefficient.
#[test]
fn coefficients_are_those_of_the_reference() -> Result<()> {
    let reference = read("friction/tangential_coefficients.json");
    for stack in list(&reference, "stacks") {
        let (dx, dy) = (number(stack, "dx"), number(stack, "dy"));
        let grid = Grid::new([64, 32], [64.0 * dx, 32.0 * dy])?;
        let c = traction_coefficients(body(stack)?, &grid)?;
        let own = c.xx[[0, 0]];
        for row in list(stack, "rows") {
            let at = [number(row, "i") as usize, number(row, "j") as usize];
            for (found, name) in [(&c.xx, "ux"), (&c.xy, "uy"), (&c.zx, "uz")] {
                let error = (found[at] - number(row, name)).abs() / own;
                println!("{} {at:?} {name}: {error:e}", stack["name"]);
                assert!(error < 1e-10, "{} {at:?} {name}: {error:e}", stack["name"]);
            }
        }
    }
    Ok(())
}

/// The closed form on a bare body: FRICTION's corner functions, near and at 60 cells.
#[test]
fn bare_cells_are_in_closed_form() -> Result<()> {
    let (nu, g) = (0.3, 1.0);
    let bare = Elastic::new(2.0 * g * (1.0 + nu), nu)?;
    let (dx, dy) = (1.0, 0.25);
    let c = traction_coefficients(bare, &Grid::new([64, 64], [64.0 * dx, 64.0 * dy])?)?;
    let asinh = |y: f64, x: f64| {
        if y == 0.0 || x == 0.0 {
            0.0
        } else {
            (y / x.abs()).asinh()
        }
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
        let fx = |x: f64, y: f64| {
            let log = if y == 0.0 {
                0.0
            } else {
                0.5 * y * (x * x + y * y).ln()
            };
            log + if x == 0.0 { 0.0 } else { x * (y / x).atan() }
        };
        let exact = [
            ((1.0 - nu) * corners(&fa) + nu * corners(&fxx)) / (2.0 * PI * g),
            nu * corners(&fxy) / (2.0 * PI * g),
            (1.0 - 2.0 * nu) * corners(&fx) / (4.0 * PI * g),
        ];
        // Near the load, rounding; far from it, that of the corners' differences, 1e-13 · 60².
        let rounding = if i == 60 { 1e-10 } else { 2e-13 };
        for (found, exact) in [&c.xx, &c.xy, &c.zx].into_iter().zip(exact) {
            let error = (found[[i, j]] - exact).abs() / own;
            assert!(
                error < rounding,
                "{i} {j}: {} {exact} {error:e}",
                found[[i, j]]
            );
        }
    }
    Ok(())
}

/// Exchanging x and y exchanges the coefficients; two equal layers are none; ν = ½ alone is not coupled.
#[test]
fn coefficients_have_their_symmetries() -> Result<()> {
    let (hard, soft) = (Elastic::new(4.0, 0.3)?, Elastic::new(1.0, 0.3)?);
    let coated = HalfSpace::new(soft, [Layer::new(hard, 0.4)?])?;
    let grid = Grid::new([24, 16], [24.0, 8.0])?;
    let turned = Grid::new([16, 24], [8.0, 24.0])?;
    let close = |a: &TractionCoefficients, b: &TractionCoefficients, exchange: bool, error: f64| {
        let pairs = if exchange {
            [
                (&a.xx, &b.yy),
                (&a.yy, &b.xx),
                (&a.xy, &b.xy),
                (&a.zx, &b.zy),
                (&a.zy, &b.zx),
            ]
        } else {
            [
                (&a.xx, &b.xx),
                (&a.yy, &b.yy),
                (&a.xy, &b.xy),
                (&a.zx, &b.zx),
                (&a.zy, &b.zy),
            ]
        };
        for (a, b) in pairs {
            for ((i, j), value) in a.indexed_iter() {
                let other = if exchange { b[[j, i]] } else { b[[i, j]] };
                assert!((value - other).abs() < error, "{i} {j}: {value} {other}");
            }
        }
    };
    let c = traction_coefficients(&coated, &grid)?;
    close(&c, &traction_coefficients(&coated, &turned)?, true, 1e-11);
    let split = HalfSpace::new(
        soft,
        [
            Layer::new(hard, 0.1)?,
            Layer::new(hard, 0.3)?.with_interface(Interface::Bonded),
        ],
    )?;
    close(&c, &traction_coefficients(&split, &grid)?, false, 1e-10);
    let bare = traction_coefficients(Elastic::new(3.0, 0.5)?, &grid)?;
    assert!(bare.zx.iter().chain(&bare.zy).all(|c| *c == 0.0));
    let own = c.xx[[0, 0]];
    assert!(c.zx[[1, 0]].abs() > 0.02 * own && c.zx[[0, 3]] == 0.0 && c.xy[[3, 0]] == 0.0);
    Ok(())
}

/// Strips of line contact are columns of cells along x: sums of cells over a long line, but for the datum.
#[test]
fn strips_are_rows_of_cells() -> Result<()> {
    let coated = HalfSpace::new(
        Elastic::new(1.0, 0.3)?,
        [Layer::new(Elastic::new(4.0, 0.3)?, 0.7)?],
    )?;
    let strips = traction_coefficients(&coated, &Grid::line(16, 16.0)?)?;
    let cells = traction_coefficients(&coated, &Grid::new([4096, 16], [4096.0, 16.0])?)?;
    let row = |c: &ndarray::Array2<f64>, j: usize| c.column(j).sum() * 2.0 - c[[0, j]];
    for (strip, cell, by) in [
        (&strips.xx, &cells.xx, true),
        (&strips.yy, &cells.yy, true),
        (&strips.zy, &cells.zy, false),
    ] {
        for j in 1..16 {
            let datum = if by {
                [strip[[0, 0]], row(cell, 0)]
            } else {
                [0.0; 2]
            };
            let (found, expected) = (strip[[0, j]] - datum[0], row(cell, j) - datum[1]);
            // The line ends at 4096: what is missing differs by (j/4096)².
            assert!(
                (found - expected).abs() < 2e-5 * expected.abs(),
                "{j}: {found} {expected}"
            );
        }
    }
    Ok(())
}
