//! Random histories: every one converges or says that it did not, and keeps Coulomb's law. `make fuzz` tries many more.

use nacre::friction::{Rolling, RollingDirection, Step, TangentialMotion};
use nacre::{Contact, Elastic, Error, Grid, Motion, Options, Result, Setup};
use ndarray::Array2;
use proptest::prelude::*;

use crate::support::checks::seeded;
use crate::support::pairs::{RADIUS, ball, precise};
use crate::support::settings::{against, stack};

/// Numbers from which a history is made.
#[derive(Debug, Clone)]
pub(super) struct Case {
    /// Moduli over the substrate's, Poisson's ratios, thicknesses over the radius of the contact.
    layers: Vec<(f64, f64, f64)>,
    /// Rigid, equal, or a body without layers of this modulus.
    counterbody: Option<Option<f64>>,
    friction: [f64; 2],
    /// Forces over what friction can carry, and their directions.
    pulls: Vec<(f64, f64)>,
    /// Approach of each pull over that of a contact without layers with a radius of 1.
    approaches: [f64; 3],
    twist: f64,
    creepage: [f64; 2],
    spin: f64,
    direction: RollingDirection,
}

fn power(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|power| 10.0_f64.powf(power))
}

pub(super) fn case() -> impl Strategy<Value = Case> {
    let layer = (power(-1.0, 1.0), 0.0..0.49, power(-1.5, 0.3));
    let pull = (prop_oneof![0.0..0.9, 0.9..0.999], 0.0..std::f64::consts::TAU);
    let directions = prop_oneof![
        Just(RollingDirection::PlusX),
        Just(RollingDirection::MinusX),
        Just(RollingDirection::PlusY),
        Just(RollingDirection::MinusY)
    ];
    (
        (
            prop::collection::vec(layer, 0..3),
            prop::option::of(prop::option::of(power(-1.0, 1.0))),
            [power(-2.0, 0.3), power(-2.0, 0.3)],
            prop::collection::vec(pull, 3),
            [0.3..1.0, 0.3..1.0, 0.3..1.0],
        ),
        -1.0..1.0,
        [-2.0..2.0, -2.0..2.0],
        -1.0..1.0,
        directions,
    )
        .prop_map(|(first, twist, creepage, spin, direction)| Case {
            layers: first.0,
            counterbody: first.1,
            friction: first.2,
            pulls: first.3,
            approaches: first.4,
            twist,
            creepage,
            spin,
            direction,
        })
}

impl Case {
    fn contact(&self) -> Result<Contact> {
        self.contact_on(24)
    }

    /// A grid 3.2 radii of the largest contact without layers wide, with so many cells along both axes.
    pub(super) fn contact_on(&self, cells: usize) -> Result<Contact> {
        let layers = self.layers.iter().map(|(ratio, nu, h)| [2.6 * ratio, *nu, *h]);
        let body = stack(Elastic::new(2.6, 0.3)?, layers)?;
        let setup = match self.counterbody {
            None => Setup::default(),
            Some(None) => against(body.clone()),
            Some(Some(ratio)) => against(Elastic::new(2.6 * ratio, 0.2)?),
        };
        let setup = setup.with_threads(1);
        Contact::plan(body, Grid::new([cells, cells], [3.2, 3.2])?, setup)
    }

    /// Loads of the approaches on 24 cells.
    pub(super) fn loads(&self) -> Result<[f64; 3]> {
        let contact = self.contact()?;
        let load = |part: f64| -> Result<f64> {
            let motion = Motion::approach(part / RADIUS);
            Ok(contact.solve(&ball()?, &motion, &Options::default())?.load())
        };
        let [a, b, c] = self.approaches;
        Ok([load(a)?, load(b)?, load(c)?])
    }

    /// Pulls, each with a load, and the friction of the second different from the first; the last also twists.
    pub(super) fn steps(&self, loads: [f64; 3]) -> Vec<Step> {
        let each = self.pulls.iter().zip(loads).enumerate();
        each.map(|(k, ((share, angle), load))| {
            let friction = self.friction[k.min(1)];
            let force = share * friction * load;
            Step::press(Motion::load(load), friction)
                .with_force([Some(force * angle.cos()), Some(force * angle.sin())])
                .with_twist((k == 2).then_some(self.twist * friction * load))
        })
        .collect()
    }

    fn rolling(&self, load: f64) -> Rolling {
        let friction = self.friction[0];
        let unit = friction * load;
        Rolling::new(Motion::load(load), friction, self.direction)
            .with_creepage(self.creepage.map(|creepage| Some(creepage * unit)))
            .with_spin(self.spin * unit)
    }
}

/// Cases: those of `NACRE_FUZZ`, or 40.
fn cases_to_try() -> u32 {
    asked().unwrap_or(40)
}

/// Cases that `NACRE_FUZZ` asks for.
pub(super) fn asked() -> Option<u32> {
    std::env::var("NACRE_FUZZ").ok()?.parse().ok()
}

proptest! {
    #![proptest_config(seeded(cases_to_try()))]

    #[test]
    #[ignore = "slow"]
    fn fuzz_histories_keep_the_law(case in case()) {
        let contact = case.contact().expect("a contact");
        let options = precise(1e-7);
        let shape = ball().expect("a ball");
        let loads = case.loads().expect("loads");
        let slid = contact.slide(&shape, &case.steps(loads), &options, None);
        let rolled = contact.roll(&shape, &case.rolling(loads[0]), &options).map(|solution| vec![solution]);
        for solutions in [slid, rolled] {
            let solutions = match solutions {
                Ok(solutions) => solutions,
                // The first pressure of a coupled contact may be more than the last.
                Err(Error::FullSlip { .. }) => continue,
                Err(error) => return Err(TestCaseError::fail(format!("{error}"))),
            };
            for solution in solutions {
                let report = &solution.report;
                prop_assert!(report.converged(), "{report:?}");
                prop_assert!(report.violation <= 1.001e-7 && report.excess <= 1e-12, "{report:?}");
                let (bound, size) = (solution.bound(), solution.traction_size());
                for (bound, size) in bound.iter().zip(&size) {
                    prop_assert!(*size <= bound * (1.0 + 1e-12));
                }
                let fields = solution.slip.iter().chain(&solution.displacement).flatten();
                prop_assert!(fields.chain([&solution.dissipated()]).all(|value| value.is_finite()));
                // A cell slips by the violation of the largest displacement where it sticks, and across the traction where it
                // does not: in rolling over the length of a cell. Vectors are up to √2 times as long as their components.
                let length = match solution.motion {
                    TangentialMotion::Slide { .. } => 1.0,
                    TangentialMotion::Roll { direction, .. } => {
                        solution.grid().spacing()[usize::from(direction.vector()[0] == 0.0)]
                    }
                };
                let largest = |fields: &[Array2<f64>; 2]| {
                    fields.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()))
                };
                let slip = report.violation * largest(&solution.displacement) / length;
                let noise = 2.0 * slip * largest(&solution.traction);
                prop_assert!(solution.dissipation().iter().all(|lost| *lost >= -noise));
            }
        }
    }
}
