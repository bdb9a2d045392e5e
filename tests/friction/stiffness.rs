//! A circle that sticks, moved and twisted.

use nacre::friction::{FrictionOptions, Step};
use nacre::{Elastic, FlatPunch, Grid, HalfSpace, Layer, Motion, Result};
use serde_json::Value;

use crate::support::pairs::{coated, equal, slid};
use crate::support::reference::{cases, list, number};

/// The body of a case.
fn layers(case: &Value, radius: f64) -> Result<HalfSpace> {
    if case.get("layers").is_none() {
        return coated(
            number(case, "E1_over_E2"),
            number(case, "h_over_a") * radius,
        );
    }
    let elastic = |value: &Value| Elastic::new(number(value, "E"), number(value, "nu"));
    let layer = |layer: &Value| Layer::new(elastic(layer)?, number(layer, "h_over_a") * radius);
    let layers: Result<Vec<Layer>> = list(case, "layers").iter().map(layer).collect();
    HalfSpace::new(elastic(&case["substrate"])?, layers?)
}

/// Stiffnesses Q/δ and M/ω of two equal bodies under a circle with `cells` across, by powers of its radius.
/// The radius, of which the body is told, is that of the circle with the area of the cells.
fn stiffnesses(body: impl Fn(f64) -> Result<HalfSpace>, cells: usize) -> Result<[f64; 2]> {
    let n = cells + 2;
    let width = 2.0 * n as f64 / cells as f64;
    let grid = Grid::new([n, n], [width, width])?;
    let x = grid.x();
    let inside = x
        .iter()
        .flat_map(|x| grid.y().into_iter().map(move |y| x.hypot(y)));
    let count = inside.filter(|r| *r < 1.0).count();
    let radius = (count as f64 * grid.cell_area() / std::f64::consts::PI).sqrt();
    let contact = equal(body(radius)?, grid)?;
    let step = Step {
        force: [Some(1e-4), None],
        torque: Some(1e-4),
        ..Step::press(Motion::load(1.0), 1e3)
    };
    let options = FrictionOptions {
        tolerance: 1e-8,
        ..FrictionOptions::default()
    };
    let solution = &contact.slide(&FlatPunch::new(1.0)?, &[step], &options, None)?[0];
    assert!(solution.report.converged());
    let stuck = solution.stick().iter().filter(|stick| **stick).count();
    assert_eq!(stuck, count);
    let (shift, twist) = slid(solution);
    Ok([1e-4 / shift[0] / radius, 1e-4 / twist / radius.powi(3)])
}

/// Full stick: stiffness over that without layer on the same cells, as Galerkin's method and Nyström's have it to 1e-15.
/// Cells of the circle's rim leave an error that falls with their size.
#[test]
fn of_a_coated_circle() -> Result<()> {
    let cells = [64, 128];
    let without = |_: f64| Ok(Elastic::new(2.6, 0.3)?.into());
    let [bare_coarse, bare_fine] = cells.map(|cells| stiffnesses(without, cells));
    let (bare_coarse, bare_fine) = (bare_coarse?, bare_fine?);
    for case in cases("friction/stick_stiffness.json") {
        let body = |radius: f64| layers(&case, radius);
        let [coarse, fine] = cells.map(|cells| stiffnesses(body, cells));
        let (coarse, fine) = (coarse?, fine?);
        for (k, name) in ["stiffness_over_bare", "torsion_over_bare"]
            .into_iter()
            .enumerate()
        {
            let exact = number(&case, name);
            let (coarse, raw) = (coarse[k] / bare_coarse[k], fine[k] / bare_fine[k]);
            assert!((raw / exact - 1.0).abs() < 3e-3, "{name} {case}: {raw}");
            let found = 2.0 * raw - coarse;
            assert!((found / exact - 1.0).abs() < 3e-4, "{name} {case}: {found}");
        }
    }
    Ok(())
}

/// Mindlin's and Reissner's closed forms without layer: Q/δ = 8 G a/(2 − ν) and M/ω = 16 G a³/3 of one body, half of it
/// of two.
#[test]
fn of_a_circle_without_layer() -> Result<()> {
    let body = |_: f64| Ok(Elastic::new(2.6, 0.3)?.into());
    let (coarse, fine) = (stiffnesses(body, 128)?, stiffnesses(body, 256)?);
    for (k, exact) in [4.0 / 1.7, 8.0 / 3.0].into_iter().enumerate() {
        let found = 2.0 * fine[k] - coarse[k];
        assert!((found / exact - 1.0).abs() < 3e-4, "{found} {exact}");
    }
    Ok(())
}
