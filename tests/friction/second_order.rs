//! Rolling to second order in the length of a cell, against limits of two other programs and closed forms, and its stated
//! error.

use std::f64::consts::PI;

use nacre::friction::{
    FrictionOptions, FrictionSolution, Rolling, RollingDirection, TangentialMotion,
};
use nacre::influence::influence_coefficients;
use nacre::{
    Contact, Cylinder, Elastic, FlatPunch, Grid, Method, Motion, Paraboloid, Result, Warning,
};
use serde_json::Value;

use crate::support::pairs::{
    ball, coated, creepage, equal, load, material, pair, precise, rolled, rolling, unlike,
};
use crate::support::reference::{cases, list, number};
use crate::support::settings::one_thread;

/// Rolling on an elliptic contact of the reference, 2.2 times as wide as it.
struct Ellipse {
    case: Value,
    contact: Contact,
    shape: Paraboloid,
    rolling: Rolling,
    /// μW and √(ab).
    bears: f64,
    length: f64,
}

impl Ellipse {
    fn of(case: Value, cells: usize) -> Result<Self> {
        let pair = |name: &str| [0, 1].map(|k| list(&case, name)[k].as_f64().expect("a number"));
        let [a, b] = pair("semi_axes_along_and_across_rolling");
        let [along, across] = pair("relative_radii_along_and_across");
        let poisson = number(&case, "poisson");
        let body = Elastic::new(2.0 * (1.0 + poisson) * number(&case, "shear"), poisson)?;
        let contact = equal(body, Grid::new([cells; 2], [2.2 * a, 2.2 * b])?)?;
        let (load, friction) = (number(&case, "load"), number(&case, "friction"));
        let motion = Motion::load(load);
        Ok(Self {
            contact,
            shape: Paraboloid::new(along, across)?,
            rolling: Rolling::new(motion, friction, RollingDirection::PlusX)
                .with_creepage(pair("creepage").map(Some))
                .with_spin(number(&case, "spin")),
            bears: friction * load,
            length: (a * b).sqrt(),
            case,
        })
    }

    fn all(cells: usize) -> impl Iterator<Item = Result<Self>> {
        let cases = cases("friction/rolling.json").into_iter();
        cases.filter(|case| case["shear"].is_number()).map(move |case| Self::of(case, cells))
    }

    fn roll(&self) -> Result<FrictionSolution> {
        rolled(&self.contact, &self.shape, &self.rolling, &precise(1e-6))
    }

    /// Errors of force along and across, torque and power, over μW, μW√(ab) and the power.
    fn errors(&self, solution: &FrictionSolution) -> [f64; 4] {
        let limit = |name: &str| number(&self.case["results"][name], "value");
        let [x, y] = solution.force().map(|force| force / self.bears);
        let power = limit("power_over_muW_V");
        [
            x - limit("force_along_over_muW"),
            y - limit("force_across_over_muW"),
            solution.torque() / (self.bears * self.length) - limit("torque_over_muW_sqrt_ab"),
            solution.dissipated() / self.bears / power - 1.0,
        ]
    }
}

/// 58 cells across have errors of .1 % of forces and torques and .3 % of the power, 116 cells a third of it, where second
/// order leaves a quarter. First order has ten times as much.
#[test]
#[ignore = "slow"]
fn limits_of_two_programs() -> Result<()> {
    for (cells, part) in [(64, 1.0), (128, 1.0 / 3.0)] {
        for ellipse in Ellipse::all(cells) {
            let ellipse = ellipse?;
            let solution = ellipse.roll()?;
            let errors = ellipse.errors(&solution);
            let bars = [1e-3, 1e-3, 1e-3, 3e-3].map(|bar| part * bar);
            for (error, bar) in errors.into_iter().zip(bars) {
                below!(error.abs(), bar, cells, errors, ellipse.case["name"]);
            }
            // The map of the dissipation lacks the cells in which the stick zone ends.
            let sum = solution.dissipation().sum() * solution.grid().cell_area();
            near!(sum, solution.dissipated(), 2.0 * bars[3], ellipse.case["name"]);
        }
    }
    Ok(())
}

/// The stated errors hold for all limits, and are below 2 % of what friction can carry.
#[test]
fn stated_errors_of_the_limits() -> Result<()> {
    for ellipse in Ellipse::all(64) {
        let ellipse = ellipse?;
        let solution = ellipse.roll()?;
        let [x, y, torque, power] = ellipse.errors(&solution);
        let stated = solution.report.discretisation.expect("an estimate");
        let name = &ellipse.case["name"];
        below!(x.hypot(y) * ellipse.bears, stated.force, name);
        below!(torque.abs() * ellipse.bears * ellipse.length, stated.torque, name);
        below!(power.abs() * solution.dissipated(), stated.dissipated, name);
        assert_eq!(stated.creepage, Some(0.0), "given creepages are exact");
        below!(stated.force, 0.02 * ellipse.bears, name);
    }
    Ok(())
}

/// Creepage of Carter's problem under 0.6 μW on 25 cells across, wherever the grid lies: the edge may be at any place of its
/// cell. Measured: an rms of 5e-4 over 24 places, twice that at the worst. First order is up to 9 % off.
#[test]
fn carter_wherever_the_grid_lies() -> Result<()> {
    let carter = cases("friction/rolling.json").remove(0);
    let [radius, load, friction] =
        ["relative_radius", "load_per_length", "friction"].map(|name| number(&carter, name));
    let steel = Elastic::new(number(&carter, "young"), number(&carter, "poisson"))?;
    let half = (8.0 * load * radius / (PI * steel.plane_strain_modulus())).sqrt();
    let exact = friction * half / radius * (1.0 - 0.4_f64.sqrt());
    near!(number(&carter["results"]["creepage"], "value"), exact, 1e-9);
    let d = 2.0 * half / 25.0;
    for place in 0..8 {
        let grid = Grid::line(36, 36.0 * d)?.centered_at([0.0, d * f64::from(place) / 8.0])?;
        let force = [None, Some(0.6 * friction * load)];
        let pulled = rolling(load, friction, RollingDirection::PlusY, force);
        let contact = equal(steel, grid)?;
        let solution = rolled(&contact, &Cylinder::new(radius)?, &pulled, &precise(1e-8))?;
        near!(creepage(&solution)[0], exact, 1e-3, place);
        let stated = solution.report.discretisation.expect("an estimate");
        below!((creepage(&solution)[0] - exact).abs(), stated.creepage.unwrap_or(0.0), place);
    }
    Ok(())
}

/// Creepage of coated cylinders as two programs have it to 1e-10, on 22 cells across: first order is 5 % off.
#[test]
fn coated_cylinders_on_few_cells() -> Result<()> {
    let case = cases("friction/rolling.json").remove(1);
    let [radius, load, friction, share] =
        ["relative_radius", "load_per_length", "friction", "force_along_over_muW"]
            .map(|name| number(&case, name));
    let exact = number(&case["results"]["creepage"], "value");
    for (cells, bar) in [(22, 2e-3), (88, 4e-4)] {
        let grid = Grid::line(cells + 12, 2.0 * (cells + 12) as f64 / cells as f64)?;
        let body = coated(4.0, 0.1)?;
        let pulled =
            rolling(load, friction, RollingDirection::PlusY, [None, Some(share * friction * load)]);
        let solution =
            rolled(&equal(body, grid)?, &Cylinder::new(radius)?, &pulled, &precise(1e-8))?;
        near!(creepage(&solution)[0], exact, bar, cells);
    }
    Ok(())
}

/// The work of the motion, Q · v over the cells.
fn work(solution: &FrictionSolution) -> f64 {
    let TangentialMotion::Roll { creepage, spin, direction } = solution.motion else {
        panic!("it slides")
    };
    let ([ex, ey], [fx, fy]) = (direction.vector(), solution.force());
    let along = fx * ex + fy * ey;
    let across = fy * ex - fx * ey;
    creepage[0] * along + creepage[1] * across + spin * solution.torque()
}

/// The power is that of the formula on the cells: for equal bodies the work of the creepages and the spin, and for others
/// less that of what the pressure spreads. Between both, the tractions' own displacements do none.
#[test]
fn power_of_the_cells() -> Result<()> {
    let unit = 0.3 * load(0.3);
    for (contact, equal) in [(pair(0.3, 48)?, true), (unlike(48, 2.8)?, false)] {
        for direction in [RollingDirection::PlusX, RollingDirection::MinusY] {
            let rolling = Rolling::new(Motion::load(load(0.3)), 0.3, direction)
                .with_creepage([Some(0.2 * unit), Some(-0.1 * unit)])
                .with_spin(0.1 * unit);
            let solution = rolled(&contact, &ball()?, &rolling, &precise(1e-9))?;
            let (grid, axis) = (contact.grid(), usize::from(direction == RollingDirection::MinusY));
            let sign = direction.vector()[axis];
            let (x, y) = (grid.x(), grid.y());
            let [ex, ey] = direction.vector();
            let d = grid.spacing()[axis];
            let mut sum = 0.0;
            for ((i, j), _) in solution.normal.pressure.indexed_iter().filter(|(_, p)| **p > 0.0) {
                let [xi, eta] = [0.2 * unit, -0.1 * unit];
                let motion = [xi * ex - eta * ey, xi * ey + eta * ex];
                let spin = [-0.1 * unit * y[j], 0.1 * unit * x[i]];
                for k in 0..2 {
                    let u = &solution.displacement[k];
                    let [low, high] = match axis {
                        0 => [u[[i - 1, j]], u[[i + 1, j]]],
                        _ => [u[[i, j - 1]], u[[i, j + 1]]],
                    };
                    let slope = sign * (low - high) / (2.0 * d);
                    sum += solution.traction[k][[i, j]] * (motion[k] + spin[k] - slope);
                }
            }
            let power = sum * grid.cell_area();
            near!(solution.dissipated(), power, 1e-11, equal, direction);
            if equal {
                near!(solution.dissipated(), work(&solution), 1e-13);
            } else {
                below!(1e-3, (solution.dissipated() / work(&solution) - 1.0).abs());
            }
        }
    }
    Ok(())
}

/// A flat punch that sticks, in the plane: force over creepage of the tractions q = C √((1 + x)/(1 − x)) at the leading edge
/// is π G a/(2(1 − ν)), exactly: the displacement under them is linear.
#[test]
fn sharp_leading_edges() -> Result<()> {
    let (half, friction, slip) = (1.0, 1e6, 1e-6);
    let steel = material(0.3)?;
    for cells in [40, 80, 160] {
        let all = cells + 16;
        let grid = Grid::line(all, 2.0 * half * all as f64 / f64::from(cells as u32))?;
        let shape = FlatPunch::new(half)?;
        let creeping = rolling(1e-3, friction, RollingDirection::PlusY, [Some(slip), None]);
        let solution = rolled(&equal(steel, grid)?, &shape, &creeping, &precise(1e-9))?;
        let exact = PI * half / (2.0 * 0.7) * slip;
        // 40 cells leave 2e-5; first order has 4e-3.
        near!(solution.force()[1], exact, 1e-4, cells);
    }
    Ok(())
}

/// Without enough cells, on given coefficients, and with a contact that fills the grid, a warning takes the place of the
/// stated error; first order states none.
#[test]
fn where_no_error_is_stated() -> Result<()> {
    let options = precise(1e-6);
    let creeping = rolling(load(0.3), 0.3, RollingDirection::PlusX, [Some(1e-3), None]);
    let unestimated = |solution: &FrictionSolution| {
        let warnings = &solution.normal.report.warnings;
        warnings.iter().filter(|one| matches!(one, Warning::Unestimated { .. })).count()
    };
    let solution = rolled(&pair(0.3, 40)?, &ball()?, &creeping, &options)?;
    assert!(solution.report.discretisation.is_some() && unestimated(&solution) == 0);
    let first = options.with_order(1);
    let solution = rolled(&pair(0.3, 40)?, &ball()?, &creeping, &first)?;
    assert!(solution.report.discretisation.is_none() && unestimated(&solution) == 0);
    for cells in [12, 16] {
        let solution = rolled(&pair(0.3, cells)?, &ball()?, &creeping, &options)?;
        assert!(solution.report.discretisation.is_none() && unestimated(&solution) == 1);
    }
    let grid = *pair(0.3, 40)?.grid();
    let known = influence_coefficients(material(0.3)?, &grid, Method::Exact)? * 2.0;
    let setup = one_thread(material(0.3)?).with_coefficients(known.into_shared());
    let contact = Contact::plan(material(0.3)?, grid, setup)?;
    let solution = rolled(&contact, &ball()?, &creeping, &options)?;
    assert!(solution.report.discretisation.is_none() && unestimated(&solution) == 1);
    Ok(())
}

/// Orders are 1 and 2.
#[test]
fn other_orders_are_refused() -> Result<()> {
    let creeping = rolling(load(0.3), 0.3, RollingDirection::PlusX, [Some(1e-3), None]);
    for order in [0, 3] {
        let options = FrictionOptions::default().with_order(order);
        let error = pair(0.3, 16)?.roll(&ball()?, &creeping, &options).expect_err("refused");
        assert_eq!(error.to_string(), format!("order must be 1 or 2, got {order}"));
    }
    Ok(())
}

/// Convolutions to 1e-6 of the ellipse whose creepage works against its spin, with which the pole of the motion lies in the
/// contact: hardly more on finer grids, as each starts from half the cells. Measured: 35, 37 and 52, and 10 % for
/// rounding; first order takes 188, 642 and 1407 to 1e-8.
#[test]
#[ignore = "slow"]
fn convolutions_hardly_grow() -> Result<()> {
    for (cells, most) in [(44, 38), (88, 41), (176, 57)] {
        let case = cases("friction/rolling.json").remove(2);
        let solution = Ellipse::of(case, cells)?.roll()?;
        assert!(solution.report.convolutions <= most, "{cells}: {:?}", solution.report);
    }
    Ok(())
}

/// Convolutions to 1e-6 of two coated bodies that slip almost everywhere: no more on finer grids. Measured: 18, 22 and 23,
/// and 10 % for rounding; with sums that do not decay where cells slip, 21, 34 and 57.
#[test]
#[ignore = "slow"]
fn convolutions_do_not_grow_where_coated_bodies_slip() -> Result<()> {
    for (cells, most) in [(64, 20), (128, 25), (256, 26)] {
        let width = 2.0 / 0.83;
        let contact = equal(coated(4.0, 0.3)?, Grid::new([cells, cells], [width, width])?)?;
        let creeping = rolling(load(0.3), 0.4, RollingDirection::PlusX, [Some(3e-3), None]);
        let solution = rolled(&contact, &ball()?, &creeping, &precise(1e-6))?;
        assert!(solution.report.convolutions <= most, "{cells}: {:?}", solution.report);
    }
    Ok(())
}
