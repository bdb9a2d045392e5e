//! Stress on the face of a free end, beside it, and beyond it, where there is no material.

use nacre::stress::Strengths;
use nacre::{Elastic, Grid, HalfSpace, Layer, Result, Section, StressOptions, StressPlan};
use ndarray::{Array2, Array3, Axis};

use crate::support::stresses::{displaced, fields, on};

/// A smooth pressure of height 1 over lengths of 3, about `centre` along x and 0 along y.
fn smooth(grid: &Grid, centre: f64) -> Array2<f64> {
    let (x, y) = (grid.x(), grid.y());
    Array2::from_shape_fn((x.len(), y.len()), |(i, j)| {
        bell((x[i] - centre) / 1.5) * bell(y[j] / 1.5)
    })
}

fn bell(t: f64) -> f64 {
    (1.0 - t * t).max(0.0).powi(3)
}

fn largest(field: &Array3<f64>, depth: usize) -> f64 {
    let here = field.index_axis(Axis(0), depth);
    here.fold(0.0, |most: f64, value| most.max(value.abs()))
}

fn at(section: Section) -> StressOptions {
    displaced(on(section))
}

/// Where the first cells begin at the end, a section at the end is the face, not half a cell within the body, where
/// stresses are 0.1 to 0.3 of the peak. Bars from one cell down: 1e-3 of the peak where the pressure vanishes at the end,
/// 3e-3 where it reaches it with 0.6.
#[test]
#[ignore = "slow"]
fn sections_at_an_end_are_free_of_traction() -> Result<()> {
    const ROUNDING: f64 = 1e-13;
    for (poisson, n, centre, bar) in [
        (0.0, 4, 1.6, 1e-3),
        (0.3, 8, 1.6, 1e-3),
        (0.5, 16, 1.6, 1e-3),
        (0.0, 8, 0.6, 3e-3),
        (0.5, 8, 0.6, 3e-3),
        (0.3, 16, 0.6, 3e-3),
    ] {
        let body = HalfSpace::from(Elastic::new(1.0, poisson)?).with_ends([Some(0.0), None])?;
        let grid = Grid::new([4 * n, 4 * n], [4.0, 4.0])?.centered_at([2.0, 0.0])?;
        let plan = StressPlan::plan(&body, &grid, &smooth(&grid, centre), None)?;
        let depths = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0].map(|cells| cells / n as f64);
        let face = plan.stress(&depths, &at(Section::X(0.0)))?;
        let errors = face.uncertainty.as_ref().expect("ends have an estimate");
        for (k, error) in errors.iter().enumerate() {
            let bar = if k < 2 { *error } else { bar };
            let normal = largest(face.xx(), k);
            assert!(
                normal < bar.min(*error) && *error < 0.05,
                "{poisson} {n} {centre} {k}: {normal}"
            );
            assert!(largest(face.xy(), k) < ROUNDING && largest(face.xz(), k) < ROUNDING);
        }
        assert!(largest(face.zz(), 5) > 0.02);
    }
    Ok(())
}

/// For ν = 0, a pressure that is independent of x makes an end change nothing: the stress at the face and beside it is
/// that of a line contact. The load goes on for L = 30. What is missing beyond changes xx and yy of the surface by
/// F/πL = 0.0145, F = 1.5 · 32/35 the force per length, twice where the face answers it. The pressure on the face is
/// followed to three widths of the load: this leaves 4.6e-3 of zz, and 2.8e-3 of xx.
#[test]
#[ignore = "slow"]
fn a_pressure_uniform_along_x_makes_a_line_contact_at_the_face() -> Result<()> {
    const LENGTH: f64 = 30.0;
    let missing = 1.5 * 32.0 / 35.0 / std::f64::consts::PI / LENGTH;
    let body = HalfSpace::from(Elastic::new(1.0, 0.0)?);
    let grid = Grid::new([120, 32], [LENGTH, 4.0])?.centered_at([0.5 * LENGTH, 0.0])?;
    let along = |nx: usize| Array2::from_shape_fn((nx, 32), |(_, j)| bell(grid.y()[j] / 1.5));
    let depths = [0.0, 0.25, 0.5, 1.0];
    let line = StressPlan::plan(&body, &Grid::line(32, 4.0)?, &along(1), None)?;
    let line = line.stress(&depths, &StressOptions::default())?;
    let ended = body.with_ends([Some(0.0), None])?;
    let plan = StressPlan::plan(&ended, &grid, &along(120), None)?;
    for x in [0.0, 0.05, 0.125] {
        let field = plan.stress(&depths, &at(Section::X(x)))?;
        for (k, (found, exact)) in field.components.iter().zip(&line.components).enumerate() {
            let apart = (found - exact).fold(0.0, |most: f64, d| most.max(d.abs()));
            let bar = [3e-3, 2.0 * missing, 5e-3, 1e-3, 1e-3, 1e-3][k];
            assert!(apart < bar, "{x} {k}: {apart}");
        }
    }
    Ok(())
}

/// The kernels on a face are those of cells at half a cell: a block of 2 × 2 cells is one of 3 × 2 on cells ⅔ as long, of
/// which a row has its centre on the face. The end is too far from the block to add anything. Kernels err by 1e-8 of the
/// pressure, of which 1e-3 arrives; a cell more would change that by 6 %.
#[test]
fn the_load_is_seen_from_the_face_itself() -> Result<()> {
    const KERNELS: f64 = 1e-4;
    let steel = Elastic::new(1.0, 0.3)?;
    let coating = Layer::new(Elastic::new(3.0, 0.25)?, 0.8)?;
    let body = HalfSpace::new(steel, [coating])?;
    let block = |grid: &Grid| {
        let (x, y) = (grid.x(), grid.y());
        Array2::from_shape_fn((x.len(), y.len()), |(i, j)| {
            f64::from((31.0..33.0).contains(&x[i]) && y[j].abs() < 1.0)
        })
    };
    let shifted = Grid::new([60, 16], [40.0, 16.0])?.centered_at([20.0 - 1.0 / 3.0, 0.0])?;
    let grid = Grid::new([40, 16], [40.0, 16.0])?.centered_at([20.0, 0.0])?;
    let whole = StressPlan::plan(&body, &shifted, &block(&shifted), None)?;
    let ended = body.with_ends([Some(0.0), None])?;
    let ended = StressPlan::plan(&ended, &grid, &block(&grid), None)?;
    let sliding = at(Section::X(0.0)).with_friction(0.3).with_direction([1.0, 2.0]);
    let (expected, found) =
        (whole.stress(&[0.5, 3.0], &sliding)?, ended.stress(&[0.5, 3.0], &sliding)?);
    for (found, expected) in fields(&found).into_iter().zip(fields(&expected)) {
        let most = expected.fold(0.0, |most: f64, v| most.max(v.abs()));
        let apart = (found - expected).fold(0.0, |most: f64, d| most.max(d.abs()));
        assert!(apart < KERNELS * most, "{apart} {most}");
    }
    Ok(())
}

/// A plate from 0 to 2 on a grid from −1 to 4, with cells of a quarter.
fn plate() -> Result<StressPlan> {
    let layer = Layer::new(Elastic::new(2.0, 0.3)?, 0.4)?;
    let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, [layer])?;
    let body = body.with_ends([Some(0.0), Some(2.0)])?;
    let grid = Grid::new([20, 16], [5.0, 4.0])?.centered_at([1.5, 0.0])?;
    let mut pressure = smooth(&grid, 1.0);
    for ((i, _), p) in pressure.indexed_iter_mut() {
        if !(4..12).contains(&i) {
            *p = 0.0;
        }
    }
    StressPlan::plan(&body, &grid, &pressure, None)
}

/// Planes, sections and points are NaN beyond both ends, in all components, and nowhere else; peaks and summaries are
/// those of the body. So are they where an end is too far to add any stress.
#[test]
#[ignore = "slow"]
fn there_is_nothing_beyond_an_end() -> Result<()> {
    let plan = plate()?;
    let depths = [0.1, 0.5];
    for section in [Section::Plane, Section::Y(0.1)] {
        let field = plan.stress(&depths, &at(section))?;
        for component in fields(&field).into_iter().chain([&field.von_mises()]) {
            for ((_, i, _), value) in component.indexed_iter() {
                assert_eq!(value.is_nan(), !(4..12).contains(&i), "{section:?} {i}");
            }
        }
        let peak = field.peak(&field.max_shear()).expect("a body");
        assert!(peak.value > 0.0 && (0.0..2.0).contains(&peak.position[0]));
        assert_eq!(field, field.clone());
    }
    for (x, beyond) in [(-0.01, true), (0.0, false), (0.06, false), (2.0, false), (2.01, true)] {
        for section in [Section::X(x), Section::Axis([x, 0.1])] {
            let field = plan.stress(&depths, &at(section))?;
            let all = fields(&field).into_iter().flatten();
            let errors = field.uncertainty.iter().flatten();
            assert!(all.chain(errors).all(|value| value.is_nan() == beyond), "{section:?}");
            assert!(field.warnings().is_empty() || !beyond);
            assert_eq!(field.peak(field.zz()).is_none(), beyond);
        }
    }
    let summary = plan.summary(&Strengths::default(), &StressOptions::default())?;
    let peaks = summary.layers.iter().flat_map(|l| [l.von_mises, l.tension, l.shear]);
    let tractions = summary.interfaces.iter();
    let tractions =
        tractions.flat_map(|f| [f.tension, f.compression, f.shear].into_iter().chain(f.jump));
    for peak in peaks.chain(tractions) {
        assert!(peak.value.is_finite() && (0.0..2.0).contains(&peak.position[0]), "{peak:?}");
    }

    let body = HalfSpace::from(Elastic::new(1.0, 0.3)?).with_ends([None, Some(3.5)])?;
    let grid = Grid::new([16, 4], [4.0, 1.0])?.centered_at([2.0, 0.0])?;
    let mut pressure = Array2::zeros((16, 4));
    pressure[[0, 1]] = 1.0;
    let field =
        StressPlan::plan(&body, &grid, &pressure, None)?.stress(&[0.2], &at(Section::Y(0.0)))?;
    let found: Vec<bool> = field.zz().iter().map(|zz| zz.is_nan()).collect();
    assert_eq!(found, [vec![false; 14], vec![true; 2]].concat());
    Ok(())
}

/// Between a face and the centres of the cells beside it, values are between theirs; a point is one of its section.
#[test]
#[ignore = "slow"]
fn sections_near_an_end_come_from_its_side() -> Result<()> {
    const ROUNDING: f64 = 1e-12;
    let plan = plate()?;
    let line = |x: f64| plan.stress(&[0.3], &at(Section::X(x)));
    let plane = plan.stress(&[0.3], &at(Section::Plane))?;
    for (end, near, row, between) in [(0.0, 0.03, 4, 0.24), (2.0, 1.98, 11, 0.16)] {
        let (face, found) = (line(end)?, line(near)?);
        for ((face, found), plane) in fields(&face).iter().zip(fields(&found)).zip(fields(&plane)) {
            for j in 0..16 {
                let (a, b) = (face[[0, 0, j]], plane[[0, row, j]]);
                let expected = a + between * (b - a);
                assert!((found[[0, 0, j]] - expected).abs() < ROUNDING * (1.0 + b.abs()));
            }
        }
        let y = plan.stress(&[0.3], &at(Section::Plane))?.y[5];
        let point = plan.stress(&[0.3], &at(Section::Axis([end, y])))?;
        for (face, point) in fields(&face).iter().zip(fields(&point)) {
            assert!((face[[0, 0, 5]] - point[[0, 0, 0]]).abs() < ROUNDING);
        }
    }
    Ok(())
}

/// Sections at the border of a grid are not those half a cell within it.
#[test]
fn sections_at_the_border_go_on_beyond_the_last_centres() -> Result<()> {
    const ROUNDING: f64 = 1e-12;
    let body = HalfSpace::from(Elastic::new(1.0, 0.3)?);
    let grid = Grid::new([12, 16], [3.0, 4.0])?.centered_at([1.5, 0.0])?;
    for (periodic, [a, b], weights) in [(false, [0, 1], [1.5, -0.5]), (true, [0, 11], [0.5, 0.5])] {
        let grid = grid.periodic([periodic, false])?;
        let plan = StressPlan::plan(&body, &grid, &smooth(&grid, 1.0), None)?;
        let plane = plan.stress(&[0.3], &at(Section::Plane))?;
        let line = plan.stress(&[0.3], &at(Section::X(0.0)))?;
        let point = plan.stress(&[0.3], &at(Section::Axis([0.0, grid.y()[5]])))?;
        for ((plane, line), point) in fields(&plane).iter().zip(fields(&line)).zip(fields(&point)) {
            let expected = weights[0] * plane[[0, a, 5]] + weights[1] * plane[[0, b, 5]];
            assert!((line[[0, 0, 5]] - expected).abs() < ROUNDING);
            assert!((point[[0, 0, 0]] - expected).abs() < ROUNDING);
        }
    }
    Ok(())
}

/// What stresses near an end are not known for is refused.
#[test]
fn pressure_beyond_an_end_and_grids_that_repeat_are_refused() -> Result<()> {
    let body = HalfSpace::from(Elastic::new(1.0, 0.3)?).with_ends([Some(0.5), None])?;
    let grid = Grid::new([8, 8], [4.0, 4.0])?.centered_at([2.0, 0.0])?;
    let refused = |grid: &Grid, pressure: &Array2<f64>| {
        let plan = StressPlan::plan(&body, grid, pressure, None);
        plan.err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert!(refused(&grid, &Array2::ones((8, 8))).contains("beyond the free ends"));
    let zeros = Array2::zeros((8, 8));
    assert!(refused(&grid.periodic([false, true])?, &zeros).contains("periodic"));
    assert!(refused(&Grid::line(8, 4.0)?, &Array2::zeros((1, 8))).contains("cells along x"));
    assert_eq!(refused(&grid, &zeros), "");
    Ok(())
}
