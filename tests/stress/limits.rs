//! Depths and lengths at the ends of what numbers hold: a result that is right, or an error.

use nacre::stress::{Strengths, StressSummary};
use nacre::{
    Contact, Elastic, Grid, HalfSpace, Layer, Member, Motion, Options, Result, Section, Setup,
    Solution, Sphere, StressOptions, Substrate, stress,
};
use ndarray::Array2;

fn press(body: &HalfSpace, grid: Grid) -> Result<Solution> {
    let contact = Contact::plan(body, grid, Setup::default())?;
    contact.solve(&Sphere::new(5.0)?, &Motion::load(1e-4), &Options::default())
}

fn coated() -> Result<HalfSpace> {
    let layer = Layer::new(Elastic::new(3.0, 0.3)?, 0.1)?;
    HalfSpace::new(Elastic::new(1.0, 0.3)?, [layer])
}

/// Far below, stresses are those of a force F: σ_zz = −3F/2πz² on the axis (Johnson, Contact Mechanics,
/// eq. 3.19), whatever the layers are. The contact is 1e-4 z wide. Beyond 1e60, depths are refused.
#[test]
fn deep_planes_are_those_of_a_point_force() -> Result<()> {
    for body in [coated()?, Elastic::new(1.0, 0.3)?.into()] {
        for grid in [Grid::new([16, 16], [0.5, 0.5])?, Grid::line(16, 0.5)?] {
            let solution = press(&body, grid)?;
            for section in [Section::Plane, Section::Axis([0.0, 0.0])] {
                let options = StressOptions::default()
                    .with_section(section)
                    .with_friction(0.1)
                    .with_direction([1.0, 1.0])
                    .with_displacement(true);
                let depths = [1e4, 1e20, 1e40, 1e60];
                let field = solution.stress(&depths, Member::Body, &options)?;
                let displacement = field.displacement.iter().flatten();
                let mut all = field.components.iter().chain(displacement).flatten();
                assert!(all.all(|value| value.is_finite()), "{grid:?}");
                for (k, z) in depths.into_iter().enumerate() {
                    let middle = field.zz().dim();
                    let zz = field.zz()[[k, middle.1 / 2, middle.2 / 2]];
                    let per_area = match grid.is_line() {
                        true => 2.0 * solution.load() / (std::f64::consts::PI * z),
                        false => 1.5 * solution.load() / (std::f64::consts::PI * z * z),
                    };
                    assert!((zz / per_area + 1.0).abs() < 1e-3, "{z:e}: {zz:e} {per_area:e}");
                }
                for z in [1e61, 1e154, 1e155, 1e300] {
                    let refused = solution.stress(&[z], Member::Body, &options);
                    let message = refused.err().map(|error| error.to_string());
                    assert!(message.is_some_and(|text| text.starts_with("z must be at most")));
                }
            }
        }
    }
    Ok(())
}

/// A depth far below rounding is the surface: components at the centres of cells differ by z over the cell.
#[test]
fn shallow_planes_are_the_surface() -> Result<()> {
    let body = coated()?;
    let grid = Grid::new([16, 16], [0.5, 0.5])?;
    let pressure = press(&body, grid)?.pressure;
    let depths = [0.0, 5e-324, 1e-300, 1e-160, 1e-60];
    let field = stress(&body, &grid, &pressure, &depths, &StressOptions::default())?;
    for component in &field.components {
        for k in 1..depths.len() {
            for (at, surface) in component.index_axis(ndarray::Axis(0), 0).indexed_iter() {
                let error = component[[k, at.0, at.1]] - surface;
                assert!(error.abs() < 1e-9, "{k} {at:?}: {error:e}");
            }
        }
    }
    Ok(())
}

/// Squares and fifth powers of these lengths overflow or vanish.
#[test]
fn lengths_and_moduli_out_of_range_are_refused() -> Result<()> {
    let material = Elastic::new(1.0, 0.3)?;
    let refused = |body: &HalfSpace, side: f64| -> Result<String> {
        let grid = Grid::new([4, 4], [side, side])?;
        let pressure = Array2::ones((4, 4));
        let found = stress(body, &grid, &pressure, &[0.0], &StressOptions::default());
        Ok(found.err().map(|error| error.to_string()).unwrap_or_default())
    };
    for side in [1e-99, 1e-80, 1e80, 1e99] {
        assert!(refused(&material.into(), side)?.contains("between 1e-60 and 1e60"));
    }
    for (young, thickness) in [(1e-200, 1.0), (1e200, 1.0), (1.0, 1e-300), (1.0, 1e300)] {
        let layer = Layer::new(Elastic::new(young, 0.3)?, thickness)?;
        let body = HalfSpace::new(material, [layer])?;
        assert!(refused(&body, 1.0)?.contains("between 1e-60 and 1e60"));
    }
    Ok(())
}

/// A layer that is thinner than the rounding of its depth has its own extremes, at finite places, and
/// refinement between its depths does not leave it.
#[test]
#[ignore = "slow"]
fn layers_thinner_than_rounding_have_a_summary() -> Result<()> {
    let material = Elastic::new(1.0, 0.3)?;
    let thicknesses = [0.1, 0.1, 1e-18];
    for substrate in [Substrate::Rigid, material.into()] {
        let layers = thicknesses.map(|h| Layer::new(material, h));
        let layers = layers.into_iter().collect::<Result<Vec<_>>>()?;
        let body = HalfSpace::new(substrate, layers)?;
        let solution = press(&body, Grid::new([16, 16], [0.4, 0.4])?)?;
        let (strengths, options) = (Strengths::default(), StressOptions::default());
        let StressSummary { layers, interfaces, .. } =
            solution.stress_summary(Member::Body, &strengths, &options)?;
        for (number, layer) in layers.iter().enumerate() {
            assert_eq!(layer.layer, number);
            for peak in [&layer.von_mises, &layer.tension, &layer.shear] {
                assert!(peak.value.is_finite());
                let z = peak.position[2];
                assert!((layer.depths[0]..=layer.depths[1]).contains(&z), "{layer:?}");
            }
        }
        assert_eq!(interfaces.len(), 3);
        for face in &interfaces {
            assert!(face.shear.value.is_finite() && face.compression.value < 0.0);
        }
        // The two faces of the thin layer are at one depth, and carry one traction.
        let [_, upper, lower] = &interfaces[..] else { panic!("three interfaces") };
        assert!((upper.shear.value / lower.shear.value - 1.0).abs() < 1e-6);
        assert_eq!(interfaces[2].jump.is_none(), substrate == Substrate::Rigid);
    }
    Ok(())
}
