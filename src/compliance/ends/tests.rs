//! The quarter space at one wavenumber, the operator of its cells, and the displacement at points.

use std::f64::consts::PI;
use std::sync::Arc;

use ndarray::Array2;
use spec_math::cephes64::k0;

use super::VANISHED;
use super::bodies::Ends;
use super::quarter_space::QuarterSpace;
use super::reduction::Reduction;
use crate::compliance::convolution::Convolution;
use crate::compliance::influence::{CellInfluence, Method, influence_coefficients};
use crate::compliance::response::Body;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::dense::{Factors, cholesky};
use crate::numerics::parallel::Threads;
use crate::numerics::quadrature::Rule;

/// What the face adds at ξ under pressure from 0 to `end`, with the mirror image.
fn added(reduction: &Reduction, xi: f64, end: f64) -> f64 {
    let modes = &reduction.displacement;
    modes.at(xi).dot(&modes.integrals([0.0, end], 1.0))
}

/// ∫ K0(|ξ−η|) dη from a to b, on intervals that halve towards ξ.
fn potential(xi: f64, [a, b]: [f64; 2]) -> f64 {
    let rule = Rule::gauss_legendre(12);
    if xi < a - 2.0 * (b - a) || xi > b + 2.0 * (b - a) {
        return rule.around(0.5 * (a + b), 0.5 * (b - a), |eta| k0((eta - xi).abs()));
    }
    let mut cuts = vec![a, b, xi];
    let span = (b - a).max((xi - a).abs()).max((b - xi).abs());
    for halving in 0..40 {
        let distance = span * 0.5_f64.powi(halving);
        cuts.extend([xi - distance, xi + distance]);
    }
    cuts.retain(|cut| *cut >= a && *cut <= b);
    cuts.sort_by(f64::total_cmp);
    let parts = cuts.windows(2).map(|pair| {
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        rule.around(middle, half, |eta| k0((eta - xi).abs().max(1e-300)))
    });
    parts.sum()
}

/// Pressure cos ky on all x ≥ 0: u k G/(1−ν) at kx, by Nyström's method on panels from 1e-14 on, to 3e-9. Here the
/// panels begin at 1e-11, and end at 45.
#[test]
fn waves_along_the_end() {
    let reference = [
        (0.0, [(0.05, 1.0), (0.5, 1.0), (2.0, 1.0)]),
        (0.3, [(0.05, 1.220_957_396_7), (0.5, 1.120_291_750_4), (2.0, 1.016_493_582_8)]),
        (0.5, [(0.05, 1.643_250_694_9), (0.5, 1.382_950_631_4), (2.0, 1.071_528_488_2)]),
    ];
    for (poisson, values) in reference {
        let reduction = Reduction::of(poisson);
        for (xi, expected) in values {
            // The load and its image are a wave on all x, for which u = 1.
            let u = 1.0 + added(&reduction, xi, VANISHED) / PI;
            assert!((u - expected).abs() < 1e-6, "{poisson} {xi}: {u} {expected}");
        }
    }
    let edge = 1.0 + added(&Reduction::of(0.5), 0.0, VANISHED) / PI;
    let exact = PI * PI / (PI * PI - 4.0);
    assert!((edge / exact - 1.0).abs() < 1e-5, "{edge} {exact}");
}

/// The strip 0 ≤ kx ≤ 1, against finite elements, whose error is 1e-7 at the edge and 1e-8 on the strip.
#[test]
fn strips_against_finite_elements() {
    let reference = [
        (0.0, [(0.0, 0.858_413_35), (0.4, 0.771_561_23), (1.0, 0.462_382_95)]),
        (0.3, [(0.0, 1.033_744_93), (0.4, 0.872_408_97), (1.0, 0.507_385_13)]),
        (0.45, [(0.0, 1.232_675_4), (0.4, 0.999_786_3), (1.0, 0.573_558_04)]),
    ];
    for (poisson, values) in reference {
        let reduction = Reduction::of(poisson);
        for (xi, expected) in values {
            let images = potential(xi, [0.0, 1.0]) + potential(xi, [-1.0, 0.0]);
            let u = (images + added(&reduction, xi, 1.0)) / PI;
            assert!((u - expected).abs() < 1e-5, "{poisson} {xi}: {u} {expected}");
        }
    }
}

/// Pressure of a sharp end on a wider body of the same material at one wavenumber, as x^−s: cot πs =
/// sin πs/(2[cos²(πs/2) − (1−s)²]) has s = 0.2259869 for any ν. It is fitted between kx = 1e-6 and 1e-3,
/// where the next term of the pressure still changes it by 2e-4.
#[test]
#[ignore = "slow"]
fn the_exponent_of_a_sharp_end() {
    const RATIO: f64 = 1.1;
    for poisson in [0.0, 0.3] {
        let reduction = Reduction::of(poisson);
        let mut edges = vec![0.0, 1e-9];
        while edges[edges.len() - 1] < 6.0 {
            edges.push(edges[edges.len() - 1] * RATIO);
        }
        let n = edges.len() - 1;
        let middle = |i: usize| {
            if i == 0 { 0.5 * edges[1] } else { (edges[i] * edges[i + 1]).sqrt() }
        };
        let modes = &reduction.displacement;
        let mut means = Array2::zeros((n, modes.count()));
        let mut values = Array2::zeros((n, modes.count()));
        for i in 0..n {
            means.row_mut(i).assign(&modes.integrals([edges[i], edges[i + 1]], 1.0));
            values.row_mut(i).assign(&modes.at(middle(i)));
        }
        let mut matrix = values.dot(&means.t());
        for i in 0..n {
            for j in 0..n {
                let cell = [edges[j], edges[j + 1]];
                let image = [-edges[j + 1], -edges[j]];
                matrix[[i, j]] += 2.0 * potential(middle(i), cell) + potential(middle(i), image);
            }
        }
        let pressure = Factors::new(matrix).solve(Array2::ones((n, 1)));
        let at = |x: f64| (0..n).find(|&i| edges[i + 1] > x).unwrap_or(0);
        let [near, far] = [at(1e-6), at(1e-3)];
        let slope =
            (pressure[[far, 0]] / pressure[[near, 0]]).ln() / (middle(far) / middle(near)).ln();
        assert!((slope + 0.225_987).abs() < 1e-3, "{poisson}: {slope}");
    }
}

/// The operator of all cells.
fn convolution(bodies: &[&Body], grid: &Grid) -> Result<Convolution> {
    let threads = Arc::new(Threads::new(Some(1))?);
    let mut coefficients = Array2::zeros(grid.shape());
    for body in bodies {
        coefficients += &influence_coefficients(*body, grid, Method::Exact)?;
    }
    let additions = Ends::of(bodies).additions(grid, grid, &threads)?;
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

/// Cholesky's factor of a symmetric matrix less `shift` on its diagonal; `None` where an eigenvalue is not above the shift.
fn shifted(matrix: &Array2<f64>, shift: f64) -> Option<Vec<Vec<f64>>> {
    cholesky(matrix.nrows(), 0.0, |i, j| matrix[[i, j]] - if i == j { shift } else { 0.0 })
}

/// Relative error of [`smallest_eigenvalue`].
const OF_EIGENVALUE: f64 = 1e-6;

/// The smallest eigenvalue, from below: the largest shift that leaves a matrix positive definite.
fn smallest_eigenvalue(matrix: &Array2<f64>) -> f64 {
    let (mut below, mut above) = (0.0, matrix[[0, 0]]);
    while above - below > OF_EIGENVALUE * above {
        let middle = 0.5 * (below + above);
        match shifted(matrix, middle) {
            Some(_) => below = middle,
            None => above = middle,
        }
    }
    below
}

const ENDS: [[Option<f64>; 2]; 4] =
    [[Some(-5.0), None], [None, Some(3.0)], [Some(-5.0), Some(5.0)], [Some(-6.3), Some(5.2)]];

/// The operator of one body with one end, or two, and of two bodies is symmetric to rounding, and no eigenvalue is below
/// the smallest of the half-spaces: what an end adds is positive. What the plate adds to two quarter spaces need not be
/// positive, but is as smooth as a polynomial, and pressures of the smallest eigenvalues change sign from cell to cell.
#[test]
#[ignore = "slow"]
fn operators_are_symmetric_and_positive() -> Result<()> {
    let grid = Grid::new([40, 14], [10.0, 3.5])?;
    let body = |poisson: f64, ends: [Option<f64>; 2]| {
        HalfSpace::from(Elastic::new(1.0 - poisson * poisson, poisson)?).with_ends(ends)
    };
    let half_space = Body::from(&body(0.0, [None; 2])?);
    let least = smallest_eigenvalue(&dense(&[&half_space], &grid)?);
    for poisson in [0.0, 0.3, 0.5] {
        let [low, high, flush, beyond] = ENDS;
        let cases = [
            vec![low],
            vec![high],
            vec![flush],
            vec![beyond],
            vec![low, low],
            vec![low, flush],
            vec![flush, [None; 2]],
        ];
        for ends in cases {
            let name = format!("{poisson} {ends:?}");
            let bodies = ends.iter().map(|ends| Ok(Body::from(&body(poisson, *ends)?)));
            let bodies = bodies.collect::<Result<Vec<Body>>>()?;
            let matrix = dense(&bodies.iter().collect::<Vec<_>>(), &grid)?;
            let largest = matrix.diag().fold(0.0_f64, |most, entry| most.max(*entry));
            let asymmetry = (&matrix - &matrix.t()).fold(0.0_f64, |most, d| most.max(d.abs()));
            assert!(asymmetry < 1e-12 * largest, "{name}: {asymmetry:e}");
            let bound = least * bodies.len() as f64 * (1.0 - OF_EIGENVALUE);
            assert!(shifted(&matrix, bound).is_some(), "{name}");
        }
    }
    Ok(())
}

/// Cells converge to the displacement at their centres under a rectangle of cells at the end: away from its rim, the
/// error falls as the cells to the power 2.1, from 3.4e-4 of the displacement to 1.7e-5.
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
        let additions = Ends::of(&[&body]).additions(&grid, &grid, &threads)?;
        let convolution = Convolution::plan(&coefficients, Some(1))?.plus(additions);
        let (x, y) = (grid.x(), grid.y());
        let loaded = |i: usize, j: usize| f64::from(u8::from(x[i] < 2.0 && y[j].abs() < 1.0));
        let u = convolution.apply(&Array2::from_shape_fn((3 * n, 3 * n), |(i, j)| loaded(i, j)))?;
        let mut worst = 0.0_f64;
        for (i, j) in [(0, 3 * n / 2), (n, 3 * n / 2), (n / 2, n), (2 * n + n / 2, 3 * n / 2)] {
            let expected = exact.displacement([x[i], y[j]])?;
            worst = worst.max((u[[i, j]] / expected - 1.0).abs());
        }
        errors.push(worst);
    }
    assert!(errors[0] < 5e-4 && errors[2] < 3e-5, "{errors:?}");
    assert!(errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1], "{errors:?}");
    Ok(())
}

/// Entries for cells far apart along a long end, where rows are interpolated from nodes, are displacements at a point
/// under pressure on a cell. The mean over the cell differs from its middle by (cell/distance)²/24; integrals over
/// waves that are much longer than the grid is wide err by 1.4e-5 of an entry.
#[test]
fn far_entries_are_those_of_points() -> Result<()> {
    let material = Elastic::new(1.0, 0.3)?;
    let grid = Grid::new([600, 6], [30.0, 0.6])?;
    let [dx, dy] = grid.spacing();
    let body = Body::from(&HalfSpace::from(material).with_ends([None, Some(15.0)])?);
    let convolution = convolution(&[&body], &grid)?;
    for [a, b] in [[3, 50], [30, 599], [47, 131], [64, 65], [127, 501], [222, 333]] {
        let [here, there] = [a, b].map(|row| (row as f64 + 0.5) * dx);
        let point = QuarterSpace::new(material, there - 0.5 * dx, [dx, 0.5 * dy])?;
        let half_space = CellInfluence::plan(material, [dx, dy], 50.0)?;
        for l in [0, 1, 5] {
            let y = l as f64 * dy;
            let expected = point.displacement([here, y])? - half_space.at([here - there, y]);
            // The end is at the last row.
            let influence = convolution.added([599 - a, 0], [599 - b, l]);
            let tolerance = 2e-5 + (dx / here).powi(2) / 24.0;
            assert!(
                (influence / expected - 1.0).abs() < tolerance,
                "{a} {b} {l}: {influence} {expected}"
            );
        }
    }
    Ok(())
}
