//! The operator of cells, and the displacement at points.

use std::sync::Arc;

use ndarray::{Array1, Array2};

use crate::body::HalfSpace;
use crate::convolution::Convolution;
use crate::ends::QuarterSpace;
use crate::ends::bodies::Ends;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::{CellInfluence, Method, influence_coefficients};
use crate::material::Elastic;
use crate::parallel::{Threads, dot};
use crate::response::Body;

/// The operator of all cells.
fn convolution(bodies: &[&Body], grid: &Grid) -> Result<Convolution> {
    let threads = Arc::new(Threads::new(Some(1))?);
    let mut coefficients = Array2::zeros(grid.shape());
    for body in bodies {
        coefficients += &influence_coefficients(*body, grid, Method::Exact)?;
    }
    let additions = Ends::of(bodies).additions(grid, &threads)?;
    Ok(Convolution::plan(&coefficients, Some(1))?.plus(additions))
}

/// The operator of all cells, as a matrix.
fn dense(bodies: &[&Body], grid: &Grid) -> Result<Array2<f64>> {
    let convolution = convolution(bodies, grid)?;
    let [nx, ny] = grid.shape();
    let mut matrix = Array2::zeros((nx * ny, nx * ny));
    for cell in 0..nx * ny {
        let mut unit = Array2::zeros((nx, ny));
        unit[[cell / ny, cell % ny]] = 1.0;
        let column = convolution.apply(&unit)?;
        matrix.column_mut(cell).assign(&column.flatten());
    }
    Ok(matrix)
}

/// Rows of L, whose product L Lᵀ is a symmetric matrix less `shift` on its diagonal; `None` unless that is positive
/// definite, that is where an eigenvalue is not above the shift.
fn cholesky(matrix: &Array2<f64>, shift: f64) -> Option<Vec<Vec<f64>>> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for i in 0..matrix.nrows() {
        let mut row = Vec::with_capacity(i + 1);
        for (j, other) in rows.iter().enumerate() {
            row.push((matrix[[i, j]] - dot(&row, &other[..j])) / other[j]);
        }
        let pivot = matrix[[i, i]] - shift - dot(&row, &row);
        if pivot <= 0.0 {
            return None;
        }
        row.push(pivot.sqrt());
        rows.push(row);
    }
    Some(rows)
}

/// Rayleigh's quotient after inverse iterations: not below the smallest eigenvalue, and [`OF_EIGENVALUE`] above it at
/// most, as the caller checks by a shift.
fn smallest_eigenvalue(matrix: &Array2<f64>) -> Option<f64> {
    let (rows, n) = (cholesky(matrix, 0.0)?, matrix.nrows());
    let mut v: Vec<f64> = (0..n).map(|i| ((i * i) as f64 * 0.618).sin()).collect();
    for _ in 0..300 {
        for (i, row) in rows.iter().enumerate() {
            v[i] = (v[i] - dot(&row[..i], &v[..i])) / row[i];
        }
        for (i, row) in rows.iter().enumerate().rev() {
            v[i] /= row[i];
            let solved = v[i];
            v.iter_mut()
                .zip(&row[..i])
                .for_each(|(v, l)| *v -= l * solved);
        }
        let norm = dot(&v, &v).sqrt();
        v.iter_mut().for_each(|v| *v /= norm);
    }
    let v = Array1::from(v);
    Some(v.dot(&matrix.dot(&v)))
}

/// Relative error of [`smallest_eigenvalue`].
const OF_EIGENVALUE: f64 = 1e-4;

const ENDS: [[Option<f64>; 2]; 4] = [
    [Some(-5.0), None],
    [None, Some(3.0)],
    [Some(-5.0), Some(5.0)],
    [Some(-6.3), Some(5.2)],
];

/// The operator of one body with one end, or two, and of two bodies is symmetric to rounding, and no eigenvalue is below
/// the smallest of the half-spaces: what an end adds is positive. What the plate adds to two quarter spaces need not be
/// positive, but is as smooth as a polynomial, and pressures of such eigenvalues change sign from cell to cell.
#[test]
fn operators_are_symmetric_and_positive() -> Result<()> {
    let grid = Grid::new([40, 14], [10.0, 3.5])?;
    for poisson in [0.0, 0.25, 0.3, 0.4, 0.5] {
        let whole = HalfSpace::from(Elastic::new(1.0, poisson)?);
        let half_space = Body::from(&whole);
        let matrix = dense(&[&half_space], &grid)?;
        let least = smallest_eigenvalue(&matrix).expect("K is positive definite");
        assert!(cholesky(&matrix, least * (1.0 - OF_EIGENVALUE)).is_some());
        let one = ENDS.map(|ends| Ok((vec![whole.clone().with_ends(ends)?], 1.0)));
        let two = [
            (ENDS[0], ENDS[0], 2.0),
            (ENDS[0], ENDS[2], 2.0),
            (ENDS[2], [None; 2], 2.0),
        ];
        let two = two.map(|(a, b, times)| {
            let bodies = [a, b].map(|ends| whole.clone().with_ends(ends));
            Ok((
                Vec::from_iter(bodies).into_iter().collect::<Result<_>>()?,
                times,
            ))
        });
        for case in one.into_iter().chain(two) {
            let (bodies, times): (Vec<HalfSpace>, f64) = case?;
            let name = format!(
                "{poisson} {:?}",
                bodies.iter().map(HalfSpace::ends).collect::<Vec<_>>()
            );
            let bodies: Vec<Body> = bodies.iter().map(Body::from).collect();
            let matrix = dense(&bodies.iter().collect::<Vec<_>>(), &grid)?;
            let largest = matrix.diag().fold(0.0_f64, |most, entry| most.max(*entry));
            let asymmetry = (&matrix - &matrix.t()).fold(0.0_f64, |most, d| most.max(d.abs()));
            assert!(asymmetry < 1e-12 * largest, "{name}: {asymmetry:e}");
            let bound = times * least * (1.0 - OF_EIGENVALUE);
            assert!(cholesky(&matrix, bound).is_some(), "{name}");
            if let Some(found) = smallest_eigenvalue(&matrix) {
                println!(
                    "{name}: {:e} {:e}",
                    asymmetry / largest,
                    found / (times * least) - 1.0
                );
            }
        }
    }
    Ok(())
}

/// Cells converge to the displacement at their centres under a rectangle of cells at the end: away from its rim, the
/// error falls with the square of the cells, from 1e-3 of the largest displacement.
#[test]
fn cells_converge() -> Result<()> {
    let material = Elastic::new(1.0, 0.3)?;
    let exact = QuarterSpace::new(material, 0.0, [2.0, 1.0])?;
    let body = Body::from(&HalfSpace::from(material).with_ends([Some(0.0), None])?);
    let mut errors = Vec::new();
    for n in [4, 8, 16] {
        let grid = Grid::new([3 * n, 3 * n], [3.0, 3.0])?.centered_at([1.5, 0.0])?;
        let threads = std::sync::Arc::new(Threads::new(Some(1))?);
        let coefficients = influence_coefficients(&body, &grid, Method::Exact)?;
        let additions = Ends::of(&[&body]).additions(&grid, &threads)?;
        let convolution = Convolution::plan(&coefficients, Some(1))?.plus(additions);
        let (x, y) = (grid.x(), grid.y());
        let loaded = |i: usize, j: usize| f64::from(u8::from(x[i] < 2.0 && y[j].abs() < 1.0));
        let u = convolution.apply(&Array2::from_shape_fn((3 * n, 3 * n), |(i, j)| {
            loaded(i, j)
        }))?;
        let mut worst = 0.0_f64;
        for (i, j) in [
            (0, 3 * n / 2),
            (n, 3 * n / 2),
            (n / 2, n),
            (2 * n + n / 2, 3 * n / 2),
        ] {
            let expected = exact.displacement([x[i], y[j]])?;
            worst = worst.max((u[[i, j]] / expected - 1.0).abs());
        }
        errors.push(worst);
    }
    assert!(errors[0] < 2e-3 && errors[2] < 1e-4, "{errors:?}");
    assert!(
        errors[1] < 0.4 * errors[0] && errors[2] < 0.4 * errors[1],
        "{errors:?}"
    );
    Ok(())
}

/// Entries for cells far apart along a long end, where rows are interpolated from nodes, are displacements at a point
/// under pressure on a cell: as a mean over the cell differs from its middle by (cell/distance)²/24, and rows by 6e-7.
#[test]
fn far_entries_are_those_of_points() -> Result<()> {
    let material = Elastic::new(1.0, 0.3)?;
    let grid = Grid::new([600, 6], [30.0, 0.6])?;
    let [dx, dy] = grid.spacing();
    let body = Body::from(&HalfSpace::from(material).with_ends([None, Some(15.0)])?);
    let convolution = convolution(&[&body], &grid)?;
    for [a, b] in [
        [3, 50],
        [30, 599],
        [47, 131],
        [64, 65],
        [127, 501],
        [222, 333],
    ] {
        let [here, there] = [a, b].map(|row| (row as f64 + 0.5) * dx);
        let point = QuarterSpace::new(material, there - 0.5 * dx, [dx, 0.5 * dy])?;
        let half_space = CellInfluence::plan(material, [dx, dy], 50.0)?;
        for l in [0, 1, 5] {
            let y = l as f64 * dy;
            let expected = point.displacement([here, y])? - half_space.at([here - there, y]);
            // The end is at the last row.
            let found = convolution.added([599 - a, 599 - b], l);
            let tolerance = 1e-6 + (dx / here).powi(2) / 24.0;
            println!("{a} {b} {l}: {:e} {tolerance:e}", found / expected - 1.0);
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{a} {b} {l}: {found} {expected}"
            );
        }
    }
    Ok(())
}
