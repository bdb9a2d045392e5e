//! The grid that is chosen holds every part of the contact, and its cells resolve the peak pressure.

use nacre::contact::{choose_grid, solve_with};
use nacre::response::Body;
use nacre::{
    Algorithm, Discretisation, Error, FlatPunch, Grid, HalfSpace, LogarithmicProfile, Motion,
    Options, Paraboloid, Result, Roller, SampledProfile, Setup, Solution, Sphere, Surface, Warning,
    hertz, solve,
};
use ndarray::Array2;

use crate::support::random::uniform;
use crate::support::settings::{by, coated, plan, pressed, stack, steel};

/// Estimated errors are of the size of true errors: few of these are three times as large.
const ESTIMATES: f64 = 3.0;

/// Smallest permitted difference between two grids, relative, for estimates that are small by chance: far below the
/// change by a part of the contact that is missing.
const SMALL: f64 = 1e-3;

fn on_grid(shape: &dyn Surface, motion: &Motion, grid: Grid) -> Result<Solution> {
    pressed(&plan(steel()?, grid)?, shape, motion)
}

fn estimate(solution: &Solution) -> Result<Discretisation> {
    let found = solution.report.discretisation;
    found.ok_or(Error::Inconsistent("coarser grids were solved"))
}

/// Asserts that a solution on the grid that is chosen agrees with one on a `whole` grid, which holds
/// everything, within the estimated errors of both.
fn assert_whole(name: &str, shape: &dyn Surface, motion: &Motion, whole: Grid) -> Result<()> {
    let found = solve(shape, steel()?, motion)?;
    let expected = on_grid(shape, motion, whole)?;
    let (a, b) = (estimate(&found)?, estimate(&expected)?);
    let (found, expected, error) = match motion.load {
        Some(_) => (found.approach, expected.approach, a.approach + b.approach),
        None => (found.load(), expected.load(), a.load + b.load),
    };
    let bar = (ESTIMATES * error).max(SMALL * expected);
    assert!((found - expected).abs() <= bar, "{name}: {found} {expected}");
    Ok(())
}

/// A roller of 10 mm with flat lands at these drops, 10 µm high.
fn lands(ends: &[[f64; 2]], drops: &[f64]) -> Result<Roller> {
    let (mut x, mut drop) = (Vec::new(), Vec::new());
    for ([low, high], &d) in ends.iter().zip(drops) {
        let slope = 1e-4;
        x.extend([low - slope, *low, *high, high + slope]);
        drop.extend([1e-5, d, d, 1e-5]);
    }
    let inner = 1..x.len() - 1;
    Roller::with_profile(5e-3, SampledProfile::new(&x[inner.clone()], &drop[inner])?.straight())
}

#[test]
#[ignore = "slow"]
fn contacts_away_from_the_middle_of_the_shape_are_found() -> Result<()> {
    let tilted = |approach| Motion::approach(approach).with_tilt([Some(1e-3), None]);
    let crowned = Roller::new(5e-3, 10e-3, 1.0)?;
    // The contact ends 2.6 mm on either side of x = 6 mm.
    let grid = Grid::new([640, 64], [2e-2, 4e-4])?;
    assert_whole("tilted roller", &crowned, &tilted(-2e-6), grid)?;
    let grid = Grid::new([128, 128], [2.2e-3, 2.2e-3])?;
    assert_whole("tilted punch", &FlatPunch::new(1e-3)?, &tilted(-1e-7), grid)?;
    let sum = Sphere::new(1e-2)?.plus(Paraboloid::new(3e-2, 5e-3)?.shifted(1e-3, 0.0)?);
    let grid = Grid::new([128, 128], [2e-3, 2e-3])?;
    assert_whole("sum", &sum, &Motion::approach(1.4e-5), grid)?;
    let hollow = lands(&[[-5e-3, -3e-3], [3e-3, 5e-3]], &[0.0; 2])?;
    let grid = Grid::new([256, 64], [1.1e-2, 8e-4])?;
    assert_whole("two lands", &hollow, &Motion::approach(5e-6), grid)?;
    Ok(())
}

#[test]
#[ignore = "slow"]
fn lands_that_touch_later_are_found() -> Result<()> {
    let shape = lands(&[[-5e-3, -4e-3], [-0.9e-3, 0.9e-3], [4e-3, 5e-3]], &[5e-7, 0.0, 5e-7])?;
    let grid = Grid::new([512, 128], [1.02e-2, 6e-4])?;
    assert_whole("under a load", &shape, &Motion::load(1000.0), grid)?;
    assert_whole("at an approach", &shape, &Motion::approach(3.05e-6), grid)?;
    // Free to tilt, the load acts on the land at the right.
    let motion = Motion::load(1000.0).with_eccentricity([Some(4e-3), None]);
    assert_whole("off-centre", &shape, &motion, grid)
}

#[test]
#[ignore = "slow"]
fn a_thin_incompressible_layer_gets_a_grid_that_holds_the_contact() -> Result<()> {
    let body = stack(nacre::Substrate::Rigid, [[2e6, 0.5, 3e-6]])?;
    let solution = solve(&Sphere::new(0.5)?, &body, &Motion::load(1000.0))?;
    assert!(!solution.report.warnings.contains(&Warning::GridEdge));
    Ok(())
}

/// A plate with rings at 1 mm · 100ᵏ, higher and wider each, all at the level of its middle.
#[derive(Debug)]
struct Rings;

impl Surface for Rings {
    fn gap(&self, x: f64, y: f64) -> f64 {
        let decades = (x.hypot(y) / 1e-3).log10().max(0.0);
        1e-5 * (0.5 * std::f64::consts::PI * decades).sin().powi(2)
    }
}

/// Each grid that holds one ring more misses the next one. The search ends all the same, and says that part of
/// the contact is missing: the missing rings overlap by the approach less the displacement there.
#[test]
#[ignore = "slow"]
fn a_contact_without_end_is_warned_of() -> Result<()> {
    let approach = 1e-6;
    let solution = solve(&Rings, steel()?, &Motion::approach(approach))?;
    let depths: Vec<f64> = (solution.report.warnings.iter())
        .filter_map(|warning| match warning {
            Warning::OutsideGrid { depth } => Some(*depth),
            _ => None,
        })
        .collect();
    assert_eq!(depths.len(), 1, "{:?}", solution.report.warnings);
    assert!(depths[0] > 0.0 && depths[0] <= approach, "{depths:?}");
    Ok(())
}

#[test]
fn nothing_is_found_where_nothing_touches() -> Result<()> {
    let roller = Roller::new(5e-3, 10e-3, 1.0)?.with_length(16e-3)?;
    // At the end of the straight part the tilt of 1 mrad lowers the roller by 5 µm; the crown falls from
    // there on, by 0.5 µm where it is lowest, 1 mm further.
    for (approach, touches) in [(-5.6e-6, false), (-5.4e-6, true)] {
        let motion = Motion::approach(approach).with_tilt([Some(1e-3), None]);
        let solution = solve(&roller, steel()?, &motion)?;
        assert_eq!(solution.load() > 0.0, touches, "{approach}");
        assert!(solution.report.warnings.is_empty());
    }
    Ok(())
}

/// Cells of a grid that closes in on a place; odd, so that the axis of a roller is a line of centres.
const LOOKED_AT: [usize; 2] = [241, 241];

/// Heights of a tilted shape above the plane, and where they are, on a grid.
fn heights(shape: &dyn Surface, tilt: [f64; 2], grid: &Grid) -> Result<Vec<(f64, [f64; 2])>> {
    let (gaps, x, y) = (shape.gaps(grid)?, grid.x(), grid.y());
    let height = |((i, j), h): ((usize, usize), &f64)| {
        let at: [f64; 2] = [x[i], y[j]];
        (h - tilt[0] * at[0] - tilt[1] * at[1], at)
    };
    Ok(gaps.indexed_iter().map(height).collect())
}

/// Least gap of a tilted shape, by a grid that closes in on it.
fn lowest(shape: &dyn Surface, tilt: [f64; 2]) -> Result<f64> {
    let mut grid = Grid::new(LOOKED_AT, [0.012, 0.012])?;
    let mut least = (f64::INFINITY, grid.center());
    for _ in 0..10 {
        let all = heights(shape, tilt, &grid)?.into_iter();
        least = all.fold(least, |a, b| if b.0 < a.0 { b } else { a });
        grid = Grid::new(LOOKED_AT, grid.size().map(|side| 0.3 * side))?.centered_at(least.1)?;
    }
    Ok(least.0)
}

/// A rectangle around everything below `level`, with a margin, by a grid that closes in on it; `None` where
/// nothing is.
fn rectangle_below(shape: &dyn Surface, tilt: [f64; 2], level: f64) -> Result<Option<Grid>> {
    let mut grid = Grid::new(LOOKED_AT, [0.012, 0.012])?;
    for _ in 0..8 {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (_, at) in heights(shape, tilt, &grid)?.iter().filter(|(h, _)| *h < level) {
            low = [0, 1].map(|k| low[k].min(at[k]));
            high = [0, 1].map(|k| high[k].max(at[k]));
        }
        if low[0] > high[0] {
            return Ok(None);
        }
        let size = [0, 1].map(|k| high[k] - low[k] + 4.0 * grid.spacing()[k]);
        let center = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        grid = Grid::new(LOOKED_AT, size)?.centered_at(center)?;
    }
    Ok(Some(grid))
}

/// Rollers with two to four rounded lands of random places and heights, tilted, and sums of a roller or a sphere and
/// a paraboloid elsewhere, under loads and prescribed approaches.
#[test]
#[ignore = "slow"]
fn random_shapes_are_held_as_a_whole() -> Result<()> {
    let numbers = uniform([9, 16], 22);
    for (case, r) in numbers.outer_iter().enumerate() {
        let n = 2 + (3.0 * r[0]) as usize;
        let pitch = 10e-3 / n as f64;
        let (mut x, mut drop) = (Vec::new(), Vec::new());
        for k in 0..n {
            let middle = -5e-3 + pitch * (k as f64 + 0.4 + 0.2 * r[1 + k]);
            for u in (-100..=100).map(|u| f64::from(u) / 100.0) {
                x.push(middle + 0.35 * pitch * u);
                drop.push(1e-6 * r[5 + k] + 1e-5 * u * u);
            }
        }
        let lands = || Roller::with_profile(5e-3, SampledProfile::new(&x, &drop)?.straight());
        let away = Paraboloid::new(1e-2, 5e-3)?.shifted(1e-3 * r[9], 1e-3 * r[10] - 5e-4)?;
        let shape: Box<dyn Surface> = match case % 3 {
            0 => Box::new(Sphere::new(1e-2)?.plus(away)),
            1 => Box::new(lands()?),
            _ => Box::new(lands()?.plus(Paraboloid::new(1.0, 1.0)?)),
        };
        let tilt = [5e-4 * (r[11] - 0.5), 0.0];
        let motion = match r[12] < 0.5 {
            true => Motion::load(20.0 + 500.0 * r[13]),
            false => Motion::approach(lowest(&shape, tilt)? + 1e-7 + 5e-6 * r[13]),
        };
        let motion = motion.with_tilt([Some(tilt[0]), None]);
        let found = solve(&shape, steel()?, &motion)?;
        let Some(whole) = rectangle_below(&shape, tilt, found.approach)? else {
            assert!(found.load() <= 0.0);
            continue;
        };
        let cells = if case % 3 == 0 { [160, 160] } else { [512, 96] };
        let whole = Grid::new(cells, whole.size())?.centered_at(whole.center())?;
        assert_whole(&format!("case {case}"), &shape, &motion, whole)?;
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn cells_are_divided_until_the_peak_is_resolved() -> Result<()> {
    // A logarithmic profile whose contact nearly reaches the ends, with narrow peaks there.
    let profile = LogarithmicProfile::new(2.2336e-7, 6.5038e-3, 0.0, 1.0)?;
    let roller = Roller::with_profile(3.4312e-3, profile)?;
    let motion = Motion::load(1053.0);
    let solution = solve(&roller, steel()?, &motion)?;
    let (peak, grid) = (solution.peak_pressure(), solution.grid());
    let error = estimate(&solution)?.peak_pressure.unwrap_or(peak);
    assert!(error < 0.01 * peak && solution.report.warnings.is_empty());
    let [nx, ny] = grid.shape();
    assert!(nx > 1400, "{nx} cells");
    let finer = Grid::new([2 * nx, ny], grid.size())?.centered_at(grid.center())?;
    let finer = on_grid(&roller, &motion, finer)?.peak_pressure();
    // Of second order, half the cells have a quarter of the error left.
    assert!(4.0 / 3.0 * (peak - finer).abs() < ESTIMATES * error);
    Ok(())
}

#[test]
#[ignore = "slow"]
fn simple_contacts_keep_their_grids() -> Result<()> {
    let solution = solve(&Sphere::new(5e-3)?, steel()?, &Motion::load(10.0))?;
    assert_eq!(solution.grid().shape(), [104, 104]);
    assert!(solution.report.warnings.is_empty());
    let exact = hertz::Point::new(5e-3, steel()?.plane_strain_modulus(), 10.0)?;
    near!(solution.approach, exact.approach, 1e-3);
    let body = coated(steel()?, 2.0, 40e-6)?;
    let roller = Roller::new(5e-3, 1e-3, 1.0)?;
    let solution = solve(&roller, &body, &Motion::load(20.0))?;
    assert_eq!(solution.grid().shape(), [1536, 104]);
    assert!(solution.report.warnings.is_empty());
    Ok(())
}

/// A roller whose own grid has 160 000 cells: with fewer, results agree within the estimated errors of both, and where these
/// are above 1 % of the peak, a warning says so.
#[test]
#[ignore = "slow"]
fn a_cap_on_the_cells_is_kept() -> Result<()> {
    let body = Body::from(coated(steel()?, 2.0, 40e-6)?);
    let (roller, motion) = (Roller::new(5e-3, 1e-3, 1.0)?, Motion::load(20.0));
    let solve = |cells| {
        let options = Options::default().with_cells(cells);
        solve_with(&roller, &body, &Setup::default(), &motion, &options)
    };
    let own = solve(None)?;
    for most in [40_000, 10_000, 4096] {
        let found = solve(Some(most))?;
        let [nx, ny] = found.grid().shape();
        assert!(nx * ny <= most, "{nx} {ny}");
        let (a, b) = (estimate(&own)?, estimate(&found)?);
        let error = ESTIMATES * (a.approach + b.approach);
        below!((own.approach - found.approach).abs(), error, most);
        let peak = b.peak_pressure.map(|error| error / found.peak_pressure());
        let warned = found.report.warnings.iter().any(|w| matches!(w, Warning::PeakError { .. }));
        assert!(warned || peak.is_some_and(|error| error <= 0.01), "{most}: {peak:?}");
    }
    assert!(solve(Some(4095)).is_err());
    Ok(())
}

#[test]
fn other_options_solve_on_the_grid_of_the_default_ones() -> Result<()> {
    let (shape, body) = (Sphere::new(5e-3)?, Body::from(HalfSpace::from(steel()?)));
    let (setup, motion) = (Setup::default(), Motion::load(10.0));
    let default = Options::default();
    let grid = choose_grid(&shape, &body, &setup, &motion, &default)?;
    let solve = |options: &Options| solve_with(&shape, &body, &setup, &motion, options);
    let found = solve(&default)?;
    assert_eq!(*found.grid(), grid);
    let from = |initial| Options::default().with_initial(initial);
    let reference = by(Algorithm::PolonskyKeer, 1e-8);
    for options in [reference, from(found.pressure.clone())] {
        let other = solve(&options)?;
        assert_eq!(*other.grid(), grid);
        near!(other.approach, found.approach, 1e-6);
    }
    assert!(solve(&from(Array2::zeros((3, 4)))).is_err());
    Ok(())
}
