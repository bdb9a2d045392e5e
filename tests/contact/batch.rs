//! Cases solved in parallel have the same solutions as each case alone, in the given order; a batch that is
//! stopped keeps the finished solutions.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use nacre::{
    Case, Contact, Elastic, Error, Grid, Motion, Options, Result, Solution, Sphere, Surface,
};
use ndarray::Array2;

use crate::support::settings::{self, stack};

fn contact(threads: usize) -> Result<Contact> {
    let body = stack(Elastic::new(1.0, 0.25)?, [[4.0, 0.3, 0.1]])?;
    let grid = Grid::new([96, 112], [2.4, 2.8])?;
    Contact::plan(&body, grid, settings::threads(threads))
}

#[test]
#[ignore = "slow"]
fn cases_side_by_side_are_those_alone_in_their_order() -> Result<()> {
    let spheres = [Sphere::new(50.0)?, Sphere::new(80.0)?];
    // Four cases of one sphere are adjacent. One of them has a prescribed approach, which
    // changes what the solver takes for the undeformed gap.
    let cases: Vec<Case> = (0..24)
        .map(|k| {
            let motion = if k % 4 == 1 {
                Motion::approach(0.001 * (k + 1) as f64).with_tilt([Some(1e-3), None])
            } else {
                Motion::load(0.02 / (k + 1) as f64)
                    .with_eccentricity([Some(0.01 * (k % 12) as f64), None])
            };
            Case::new(&spheres[k / 4 % 2], motion)
        })
        .collect();
    let options = Options::default();
    let one = contact(1)?;
    let alone: Vec<_> = cases
        .iter()
        .map(|case| one.solve(case.shape, &case.motion, &options))
        .collect::<Result<_>>()?;
    for threads in [1, 2, 5, 32] {
        let mut told = Vec::new();
        let solved = contact(threads)?.solve_many(&cases, &options, &mut |done| {
            told.push(done);
            ControlFlow::Continue(())
        })?;
        assert!(told.is_sorted() && told.last() == Some(&cases.len()));
        for (solved, alone) in solved.into_iter().zip(&alone) {
            let solved = solved.ok_or(Error::Inconsistent("every case is finished"))??;
            assert_eq!(solved.pressure, alone.pressure);
            assert_eq!(solved.gap(), alone.gap());
            assert_eq!(solved.approach.to_bits(), alone.approach.to_bits());
        }
    }
    Ok(())
}

#[test]
fn a_bad_case_is_its_own_result_and_none_are_none() -> Result<()> {
    let sphere = Sphere::new(50.0)?;
    let cases = [0.02, -1.0, 0.01].map(|load| Case::new(&sphere, Motion::load(load)));
    let go_on = &mut |_| ControlFlow::Continue(());
    let contact = contact(2)?;
    let solved = contact.solve_many(&cases, &Options::default(), go_on)?;
    assert!(matches!(solved[0], Some(Ok(_))) && matches!(solved[2], Some(Ok(_))));
    assert!(matches!(solved[1], Some(Err(Error::Parameter { name: "load", .. }))));
    let none = contact.solve_many(&[], &Options::default(), go_on)?;
    assert!(none.is_empty());
    Ok(())
}

#[test]
fn what_is_stopped_keeps_what_is_finished() -> Result<()> {
    let sphere = Sphere::new(50.0)?;
    let cases = [0.02; 2000].map(|load| Case::new(&sphere, Motion::load(load)));
    let mut last = 0;
    let solved = contact(2)?.solve_many(&cases, &Options::default(), &mut |done| {
        last = done;
        if done < 5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    })?;
    let finished: Vec<_> = solved.into_iter().flatten().collect();
    assert!((5..2000).contains(&finished.len()) && finished.len() == last);
    for solution in finished {
        assert!(solution?.report.converged());
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn each_solution_is_given_away_once() -> Result<()> {
    let (sphere, contact) = (Sphere::new(50.0)?, contact(2)?);
    let cases: Vec<Case> =
        (1..=200).map(|k| Case::new(&sphere, Motion::load(1e-5 * f64::from(k)))).collect();
    for stop in [false, true] {
        let given = Mutex::new(vec![0; cases.len()]);
        let take = |number: usize, solved: Result<Solution>| {
            let load = solved.map(|solution| solution.load() / (1e-5 * (number + 1) as f64));
            assert!(load.is_ok_and(|ratio| (ratio - 1.0).abs() < 1e-9));
            if let Ok(mut given) = given.lock() {
                given[number] += 1;
            }
        };
        contact.solve_each(&cases, &Options::default(), &take, &mut || match stop {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        })?;
        let given = given.into_inner().unwrap_or_default();
        assert!(given.iter().all(|count| *count <= 1), "{given:?}");
        assert_eq!(given.contains(&0), stop, "{given:?}");
    }
    Ok(())
}

/// A sphere that counts how often its gaps are sampled on the grid.
#[derive(Debug)]
struct Counted {
    sphere: Sphere,
    sampled: AtomicUsize,
}

impl Surface for Counted {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.sphere.gap(x, y)
    }
    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        if grid.shape() == [96, 112] {
            self.sampled.fetch_add(1, Ordering::Relaxed);
        }
        self.sphere.gaps(grid)
    }
}

#[test]
fn cases_of_one_shape_share_its_undeformed_gap() -> Result<()> {
    let counted = |sphere| Counted { sphere, sampled: AtomicUsize::new(0) };
    let shapes = [counted(Sphere::new(50.0)?), counted(Sphere::new(80.0)?)];
    let cases: Vec<Case> =
        (0..12).map(|k| Case::new(&shapes[k / 6], Motion::load(1e-3 * (k + 1) as f64))).collect();
    let go_on = &mut |_| ControlFlow::Continue(());
    let solved = contact(1)?.solve_many(&cases, &Options::default(), go_on)?;
    assert_eq!(solved.len(), cases.len());
    for shape in &shapes {
        assert_eq!(shape.sampled.load(Ordering::Relaxed), 1);
    }
    Ok(())
}
