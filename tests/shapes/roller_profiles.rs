//! Axial profiles are those of Lundberg, Johns & Gohar and ISO/TS 16281; rollers with them load
//! their length as they were made to, wherever the cells of the grid fall.

use std::f64::consts::PI;

use approx::assert_relative_eq;
use nacre::surface::Profile;
use nacre::{
    Axis, Error, Grid, HalfSpace, LogarithmicProfile, Motion, Result, Roller, SampledProfile,
    Solution, Surface, Warning, hertz,
};

use crate::support::settings::{coated, converged, plan, pressed, steel, tolerance};

/// Rounding between two forms of one formula.
const ROUNDING: f64 = 1e-12;

/// Error of quadrature of the mean over a cell next to a logarithmic end.
const QUADRATURE: f64 = 1e-6;

/// Difference of the peak pressures of a logarithmic roller on 256 and 512 cells along the axis.
const AXIAL: f64 = 5e-3;

/// Change of the peak pressure, and of the force on the last 5 % at each end, when the grid is shifted by
/// part of a cell.
const MOVED: f64 = 1e-3;
const END: f64 = 1e-2;

/// Below this, what changes with the cells along the roller is how evenly they cut its ends.
const CONVERGED: f64 = 5e-6;

/// Line load of Lundberg's profile over the middle 80 % of the length: his profile is that of a
/// strip whose width is small compared with the length, b/L = 1/150.
const UNIFORM: f64 = 0.03;

const RADIUS: f64 = 5e-3;
const LENGTH: f64 = 20e-3;

/// Load at which a roller of infinite length has the peak pressure `peak`: p0² = W'E*/πR.
fn load(peak: f64) -> Result<f64> {
    Ok(LENGTH * PI * RADIUS * peak * peak / steel()?.plane_strain_modulus())
}

fn iso() -> Result<LogarithmicProfile> {
    LogarithmicProfile::iso16281(2.0 * RADIUS, LENGTH)
}

fn press(body: &HalfSpace, grid: Grid, profile: impl Into<Profile>, load: f64) -> Result<Solution> {
    let roller = &Roller::with_profile(RADIUS, profile)?;
    pressed(&plan(body, grid)?, roller, &Motion::load(load))
}

fn drop(profile: impl Into<Profile>, x: f64) -> f64 {
    profile.into().drop(x)
}

#[test]
fn iso_profile_has_the_values_of_the_standard() -> Result<()> {
    // L ≤ 2.5 D: 0.00035 D ln 1/[1 − (2x/L)²]; D = 10, L = 20: 3.5e-3 ln 4/3 and 3.5e-3 ln 100/19.
    let short = LogarithmicProfile::iso16281(10.0, 20.0)?;
    assert_relative_eq!(drop(short, 0.0), 0.0);
    near!(drop(short, 5.0), 1.006_887_25e-3, 1e-7);
    near!(drop(short, -9.0), 5.812_559e-3, 1e-6);
    // L > 2.5 D: straight over L − 2.5 D = 15, then 0.0005 D ln 1/[1 − ((2|x| − 15)/25)²].
    let long = LogarithmicProfile::iso16281(10.0, 40.0)?;
    assert_relative_eq!(drop(long, 7.5), 0.0);
    near!(drop(long, 13.75), 5e-3 * (4.0_f64 / 3.0).ln(), ROUNDING);
    assert_relative_eq!(drop(long, -13.75), drop(long, 13.75));
    // At L = 2.5 D, the formula for short rollers applies.
    let limit = LogarithmicProfile::iso16281(10.0, 25.0)?;
    assert_relative_eq!(limit.amplitude(), 3.5e-3);
    assert_relative_eq!(limit.flat_length(), 0.0);
    assert!(drop(short, 10.000_001).is_infinite() && drop(short, 10.0).is_infinite());
    Ok(())
}

#[test]
fn lundberg_makes_the_load_uniform() -> Result<()> {
    let (modulus, load) = (steel()?.plane_strain_modulus(), load(1.5e9)?);
    let profile = LogarithmicProfile::lundberg(LENGTH, load, modulus)?;
    let line_load = load / LENGTH;
    near!(profile.amplitude(), line_load / (PI * modulus), ROUNDING);
    let b = hertz::Line::new(RADIUS, modulus, line_load)?.half_width;
    let grid = Grid::new([256, 48], [LENGTH, 3.0 * b])?;
    let solution = press(&steel()?.into(), grid, profile, load)?;
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for (x, w) in solution.grid().x().iter().zip(&solution.line_load()) {
        if x.abs() < 0.4 * LENGTH {
            (low, high) = (low.min(w / line_load), high.max(w / line_load));
        }
    }
    assert!(low > 1.0 - UNIFORM && high < 1.0 + UNIFORM, "{low} {high}");
    // Without a profile, the pressure is lowest in the middle and has peaks at the ends.
    let straight = SampledProfile::new(&[-0.5 * LENGTH, 0.5 * LENGTH], &[0.0, 0.0])?;
    let sharp = press(&steel()?.into(), grid, straight, load)?;
    assert!(sharp.peak_pressure() > 1.5 * solution.peak_pressure());
    Ok(())
}

#[test]
fn johns_gohar_ends_with_a_finite_drop_and_a_sharp_end_under_load() -> Result<()> {
    // A ln 1/(0.3033 b/a) at the ends, a = L/2.
    let (modulus, load) = (steel()?.plane_strain_modulus(), load(1.5e9)?);
    let profile = LogarithmicProfile::johns_gohar(LENGTH, load, modulus, RADIUS)?;
    let b = hertz::Line::new(RADIUS, modulus, load / LENGTH)?.half_width;
    let end = load / (PI * LENGTH * modulus) * (0.5 * LENGTH / (0.3033 * b)).ln();
    near!(drop(profile, 0.5 * LENGTH), end, 1e-9);
    // Away from the ends, the profile is that of Lundberg.
    let lundberg = LogarithmicProfile::lundberg(LENGTH, load, modulus)?;
    let x = 0.25 * LENGTH;
    let cut = 2.0 * (1.0 - profile.end_factor());
    near!(drop(profile, x), drop(lundberg, x), cut);
    let grid = Grid::new([128, 32], [1.02 * LENGTH, 0.25e-3])?;
    let warnings = press(&steel()?.into(), grid, profile, load)?.report.warnings;
    assert!(warnings.contains(&Warning::SharpEnd { axis: Axis::X }));
    Ok(())
}

#[test]
fn a_fine_sampling_is_the_profile() -> Result<()> {
    let profile = LogarithmicProfile::new(2e-6, LENGTH, 0.3 * LENGTH, 0.999)?;
    let samples = 4001;
    let x: Vec<f64> =
        (0..samples).map(|k| LENGTH * (f64::from(k) / f64::from(samples - 1) - 0.5)).collect();
    let drops: Vec<f64> = x.iter().map(|x| drop(profile, *x)).collect();
    let sampled = SampledProfile::new(&x, &drops)?;
    for k in 0..1000 {
        // The curve has an error at the ends, where the slope grows without limit.
        let x = 0.499 * LENGTH * (f64::from(k) / 500.0 - 1.0);
        let error = (drop(sampled.clone(), x) - drop(profile, x)).abs() / profile.amplitude();
        below!(error, 2e-3, x / LENGTH);
    }
    // A measured profile need be neither symmetric nor centred at the origin.
    let lopsided = SampledProfile::new(&[-1.0, 0.0, 2.0], &[0.5, 0.0, 0.25])?.straight();
    assert_relative_eq!(drop(lopsided.clone(), 1.0), 0.125);
    assert_relative_eq!(drop(lopsided.clone(), -0.5), 0.25);
    assert!(drop(lopsided, 2.1).is_infinite());

    let body: HalfSpace = steel()?.into();
    let grid = Grid::new([100, 32], [1.02 * LENGTH, 0.25e-3])?;
    let smooth = press(&body, grid, profile, load(1.5e9)?)?;
    let rough = press(&body, grid, sampled, load(1.5e9)?)?;
    near!(smooth.peak_pressure(), rough.peak_pressure(), 1e-3);
    near!(smooth.approach, rough.approach, 1e-3);
    Ok(())
}

/// Mean of the profile from a to b, by a midpoint rule on a mesh that is fine towards both ends.
fn mean(profile: &Profile, a: f64, b: f64) -> f64 {
    // With x = a + (b − a) t² (3 − 2t), the weight 6t(1 − t) removes the singularity at the end.
    let steps = 4000;
    let sum: f64 = (0..steps)
        .map(|k| {
            let t = (f64::from(k) + 0.5) / f64::from(steps);
            6.0 * t * (1.0 - t) * profile.drop(a + (b - a) * t * t * (3.0 - 2.0 * t))
        })
        .sum();
    sum / f64::from(steps)
}

#[test]
fn cells_take_the_mean_of_the_profile() -> Result<()> {
    let bumps = SampledProfile::new(
        &[-0.5, -0.31, 0.02, 0.04, 0.5].map(|x| x * LENGTH),
        &[4e-6, 1e-6, 0.0, 3e-7, 5e-6],
    )?;
    let profiles: [Profile; 5] = [
        iso()?.into(),
        LogarithmicProfile::iso16281(0.5 * RADIUS, LENGTH)?.into(),
        LogarithmicProfile::new(1e-6, LENGTH, 0.0, 0.99)?.into(),
        bumps.clone().into(),
        bumps.straight().into(),
    ];
    for profile in profiles {
        let roller = Roller::with_profile(RADIUS, profile.clone())?;
        // A row of cells on the axis; the outer ones reach beyond the ends.
        let grid = Grid::new([37, 3], [1.07 * LENGTH, 1e-4])?;
        let gaps = roller.gaps(&grid)?;
        let half = 0.5 * grid.spacing()[0];
        for (x, gap) in grid.x().iter().zip(gaps.column(1)) {
            let [a, b] = [x - half, x + half].map(|x| x.clamp(-0.5 * LENGTH, 0.5 * LENGTH));
            if b - a < half {
                assert!(gap.is_infinite(), "{x}");
                continue;
            }
            let error = (gap - mean(&profile, a, b)) / 1e-6;
            below!(error.abs(), QUADRATURE * 10.0, x);
        }
    }
    Ok(())
}

/// Force on the end x > 0.45 L of a roller, including parts of cells.
fn end_force(solution: &Solution) -> f64 {
    let (x, line_load) = (solution.grid().x(), solution.line_load());
    let cell = solution.grid().spacing()[0];
    let beyond = |x: f64| (x + 0.5 * cell - 0.45 * LENGTH).clamp(0.0, cell);
    x.iter().zip(&line_load).map(|(x, w)| w * beyond(*x)).sum()
}

#[test]
fn ends_do_not_depend_on_where_cells_fall() -> Result<()> {
    // Contacts over 96 % of the length, and up to the ends, on cells of L/200 that are shifted by parts of
    // a cell.
    let body: HalfSpace = steel()?.into();
    let cell = LENGTH / 200.0;
    let lundberg =
        LogarithmicProfile::lundberg(LENGTH, load(1.5e9)?, steel()?.plane_strain_modulus())?;
    for (name, profile, factor) in [("ISO", iso()?, 4.0), ("Lundberg", lundberg, 0.5)] {
        let solve = |shift: f64| -> Result<Solution> {
            let grid = Grid::new([206, 32], [206.0 * cell, 0.3e-3])?;
            let grid = grid.centered_at([shift * cell, 0.0])?;
            press(&body, grid, profile, factor * load(1.5e9)?)
        };
        let still = solve(0.0)?;
        for shift in [0.125, 0.25, 0.375, 0.49] {
            let moved = solve(shift)?;
            near!(moved.peak_pressure(), still.peak_pressure(), MOVED, name, shift);
            near!(end_force(&moved), end_force(&still), END, name, shift);
            let [there, here] = [&moved, &still].map(|s| s.contact_extent()[0][1]);
            below!((there - here).abs(), cell, name, shift);
        }
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn the_peak_converges_along_the_roller() -> Result<()> {
    // A centred load, an off-centre load with a free tilt, and a contact that nearly reaches the ends.
    let body = coated(steel()?, 2.0, 2e-6)?;
    let (modulus, load) = (steel()?.plane_strain_modulus(), load(1.5e9)?);
    let b = hertz::Line::new(RADIUS, modulus, load / LENGTH)?.half_width;
    let lundberg = LogarithmicProfile::lundberg(LENGTH, load, modulus)?;
    let eccentric = |load: f64| Motion::load(load).with_eccentricity([Some(0.1 * LENGTH), None]);
    for (name, profile, motion) in [
        ("ISO", iso()?, Motion::load(load)),
        ("ISO, off-centre", iso()?, eccentric(load)),
        ("ISO, 4x", iso()?, Motion::load(4.0 * load)),
        ("Lundberg, 0.5x", lundberg, Motion::load(0.5 * load)),
    ] {
        let roller = Roller::with_profile(RADIUS, profile)?;
        let options = tolerance(1e-10);
        let peak = |cells: usize| -> Result<f64> {
            let contact = plan(&body, Grid::new([cells, 64], [LENGTH, 5.0 * b])?)?;
            Ok(converged(&contact, &roller, &motion, &options)?.peak_pressure())
        };
        let peaks = [peak(64)?, peak(128)?, peak(256)?, peak(512)?];
        let errors = [0, 1, 2].map(|k| (peaks[k] / peaks[3] - 1.0).abs());
        for pair in errors.windows(2) {
            below!(pair[1], pair[0].max(CONVERGED), name, errors);
        }
        below!(errors[2], AXIAL, name, errors);
    }
    Ok(())
}

#[test]
fn errors_name_what_is_wrong() {
    fn name<T>(result: Result<T>) -> &'static str {
        match result {
            Err(
                Error::Parameter { name, .. }
                | Error::Shape { name, .. }
                | Error::NonFinite { name, .. },
            ) => name,
            _ => "nothing",
        }
    }
    let log = LogarithmicProfile::new;
    let (lundberg, johns_gohar) = (LogarithmicProfile::lundberg, LogarithmicProfile::johns_gohar);
    let iso = LogarithmicProfile::iso16281;
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(name(log(bad, 1.0, 0.0, 1.0)), "amplitude");
        assert_eq!(name(log(1e-6, bad, 0.0, 1.0)), "length");
        assert_eq!(name(lundberg(1.0, bad, 1e9)), "load");
        assert_eq!(name(lundberg(1.0, 1e3, bad)), "contact_modulus");
        assert_eq!(name(johns_gohar(1.0, 1e3, 1e9, bad)), "radius");
        assert_eq!(name(iso(bad, 1.0)), "diameter");
        assert_eq!(name(iso(1.0, bad)), "length");
    }
    for bad in [-0.1, 1.0, 2.0, f64::NAN] {
        assert_eq!(name(log(1e-6, 1.0, bad, 1.0)), "flat_length");
    }
    for bad in [0.0, -0.5, 1.001, f64::NAN] {
        assert_eq!(name(log(1e-6, 1.0, 0.0, bad)), "end_factor");
    }
    // The contact would be wider than long: b = √(4W'R/πE*) = 3.6 for a length of 1.
    assert_eq!(name(johns_gohar(1.0, 1.0, 1.0, 10.0)), "end_factor");
    let sampled = |x: &[f64], drop: &[f64]| name(SampledProfile::new(x, drop));
    assert!(sampled(&[0.0, 1.0], &[0.0]).starts_with("profile"));
    assert!(sampled(&[0.0], &[0.0]).starts_with("profile"));
    assert_eq!(sampled(&[0.0, 1.0], &[0.0, f64::NAN]), "profile");
    assert_eq!(sampled(&[0.0, 0.0], &[0.0, 1.0]), "profile positions");
    assert_eq!(sampled(&[1.0, 0.0], &[0.0, 1.0]), "profile positions");
}
