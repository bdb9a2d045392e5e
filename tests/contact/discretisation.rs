//! Estimated discretisation errors have the size of the true errors.

use nacre::{
    Contact, Discretisation, Elastic, Error, FlatPunch, Grid, Motion, Options, Paraboloid, Result,
    Setup, Sphere, hertz,
};

/// Relative errors of peak pressure and approach compared with Hertz, and their estimates.
fn errors(cells: [usize; 2], radius: f64) -> Result<[[f64; 2]; 2]> {
    let (body, curvature) = (Elastic::new(1.0, 0.0)?, 100.0);
    let load = 4.0 / 3.0 * radius.powi(3) / curvature;
    let contact = Contact::plan(body, Grid::new(cells, [2.0, 2.0])?, Setup::default())?;
    let shape = Paraboloid::new(curvature, curvature)?;
    let solution = contact.solve(&shape, &Motion::load(load), &Options::default())?;
    let exact = hertz::Point::new(curvature, 1.0, load)?;
    let estimate = estimate(solution.report.discretisation)?;
    let relative = |value: f64, exact: f64| (value / exact - 1.0).abs();
    Ok([
        [
            relative(solution.peak_pressure(), exact.peak_pressure),
            estimate.peak_pressure / exact.peak_pressure,
        ],
        [
            relative(solution.approach, exact.approach),
            estimate.approach / exact.approach,
        ],
    ])
}

fn estimate(found: Option<Discretisation>) -> Result<Discretisation> {
    found.ok_or(Error::Inconsistent("coarser grids were solved"))
}

#[test]
fn estimates_are_of_the_size_of_the_errors() -> Result<()> {
    // The error depends on the position of the edge within a cell. In one contact, the error or its
    // estimate may be small by chance. The mean of the logarithm over many contacts must agree within a
    // factor of three, and no error may be much larger than its estimate.
    let mut cases = Vec::new();
    for n in [96, 128, 160, 200, 256, 320, 400, 512] {
        for radius in [0.21, 0.3, 0.45, 0.6] {
            cases.push(errors([n, n + n / 8], radius)?);
        }
    }
    for (figure, name) in ["peak pressure", "approach"].iter().enumerate() {
        let ratios = cases.iter().map(|case| {
            let [error, estimate] = case[figure];
            (estimate / error).ln()
        });
        let mean = (ratios.clone().sum::<f64>() / cases.len() as f64).exp();
        let lowest = ratios.fold(f64::INFINITY, f64::min).exp();
        assert!((0.7..5.0).contains(&mean), "{name}: {mean}");
        assert!(lowest > 0.2, "{name}: {lowest}");
    }
    Ok(())
}

#[test]
fn what_is_prescribed_has_no_error() -> Result<()> {
    let contact = Contact::plan(
        Elastic::new(1.0, 0.0)?,
        Grid::new([128, 100], [2.0, 2.0])?,
        Setup::default(),
    )?;
    let shape = Sphere::new(100.0)?;
    let loaded = contact.solve(&shape, &Motion::load(5e-4), &Options::default())?;
    let loaded = estimate(loaded.report.discretisation)?;
    // The difference is rounding of the sums.
    assert!(loaded.load < 1e-12 * 5e-4 && loaded.approach > 0.0);
    let moved = contact.solve(&shape, &Motion::approach(1e-3), &Options::default())?;
    let moved = estimate(moved.report.discretisation)?;
    assert!(moved.approach.abs() < f64::MIN_POSITIVE && moved.load > 0.0);
    Ok(())
}

#[test]
fn peak_at_a_sharp_edge_is_seen_not_to_converge() -> Result<()> {
    let contact = Contact::plan(
        Elastic::new(1.0, 0.0)?,
        Grid::new([256, 256], [2.5, 2.5])?,
        Setup::default(),
    )?;
    let solution = contact.solve(
        &FlatPunch::new(1.0)?,
        &Motion::load(1.0),
        &Options::default(),
    )?;
    let estimate = estimate(solution.report.discretisation)?;
    // With p ~ s^(−1/2), halving the cells raises the peak by √2: the change is 1 − 1/√2 = 0.29 of the
    // finer peak.
    assert!(estimate.peak_pressure > 0.25 * solution.peak_pressure());
    assert!(estimate.approach < 0.02 * solution.approach);
    Ok(())
}

#[test]
fn without_coarser_grids_there_is_no_estimate() -> Result<()> {
    let shape = Sphere::new(100.0)?;
    let body = Elastic::new(1.0, 0.0)?;
    for (cells, initial) in [([40, 40], false), ([100, 40], false), ([128, 128], true)] {
        let contact = Contact::plan(body, Grid::new(cells, [2.0, 2.0])?, Setup::default())?;
        let motion = Motion::load(5e-4);
        let mut solution = contact.solve(&shape, &motion, &Options::default())?;
        if initial {
            let options = Options {
                initial: Some(solution.pressure),
                ..Options::default()
            };
            solution = contact.solve(&shape, &motion, &options)?;
        }
        assert_eq!(solution.report.discretisation, None, "{cells:?}");
    }
    Ok(())
}
