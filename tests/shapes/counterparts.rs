//! Sums of shapes are flat lists. Shapes on curved counterparts have the gap of two circles, and touch as Hertz found for their
//! equivalent radii; the closed forms agree with published tables.

use std::f64::consts::PI;

use approx::assert_relative_eq;
use nacre::hertz::{Ellipse, Line, Point, contact_modulus, equivalent_radius, relative_radii};
use nacre::surface::Extent;
use nacre::{
    Contact, Cylinder, Elastic, Error, Grid, HeightMap, LogarithmicProfile, Motion, Options,
    Paraboloid, Result, Roller, SampledProfile, Section, Sphere, StressOptions, Superposition,
    Surface, solve, stress,
};
use ndarray::Array2;

use crate::support::checks::kept;
use crate::support::settings::{against, plan, steel};

/// Rounding of a few operations, of which the differences of nearly equal circles lose two digits.
const ROUNDING: f64 = 1e-12;

/// Discretisation on cells of b/40: (dx/b)² = 6e-4 of the peak that is read beside the middle.
const ON_THE_GRID: f64 = 1e-3;

/// Gaps of a circle and of its parabola differ by (b/R)²/4 < 2e-5 in these contacts.
const PARABOLA: f64 = 1e-4;

/// Rounding of the two digits that are given; 0.3003 and 0.3100 are meant.
const PRINTED: f64 = 6e-4;

/// Rounding of depths that are given to two digits.
const READ: f64 = 0.011;

/// Depth of a circle below its highest point.
fn circle(radius: f64, x: f64) -> f64 {
    radius - (radius * radius - x * x).sqrt()
}

#[test]
fn a_roller_in_a_raceway_has_the_gap_of_two_circles() -> Result<()> {
    let (r, race, y) = (5e-3, 30e-3, 3e-3);
    let own = circle(r, y);
    let outer = Cylinder::new(r)?.with_counter_radius(-race)?;
    let inner = Cylinder::new(r)?.with_counter_radius(race)?;
    near!(outer.gap(1.0, y), own - circle(race, y), ROUNDING);
    near!(inner.gap(1.0, y), own + circle(race, y), ROUNDING);
    // The profile of a roller adds to it.
    let roller = Roller::new(r, 8e-3, 2.0)?;
    let x = 5e-3;
    let plane = roller.gap(x, y);
    let raceway = roller.clone().with_counter_radius(-race)?;
    near!(raceway.gap(x, y), plane - circle(race, y), ROUNDING);
    let grid = Grid::new([8, 6], [9e-3, 2e-3])?;
    let expected = roller.gaps(&grid)?;
    let y = grid.y();
    for ((i, j), gap) in raceway.gaps(&grid)?.indexed_iter() {
        let exact = expected[[i, j]] - circle(race, y[j]);
        near!(*gap, exact, ROUNDING);
    }
    // A convex raceway narrower than the roller ends before it.
    let thin = Cylinder::new(r)?.with_counter_radius(2e-3)?;
    assert!(thin.gap(0.0, 1.9e-3).is_finite() && thin.gap(0.0, 2.1e-3).is_infinite());
    assert_eq!(thin.extent()[1], Extent::Within([-2e-3, 2e-3]));
    Ok(())
}

#[test]
fn a_tapered_roller_has_the_gap_of_two_cones() -> Result<()> {
    // A cone of half angle β whose apex is t away touches a plane along a line. The normal height h of its surface at y is
    // the smaller root of h² cos 2β − 2 t h sin β cos β + y² cos²β = 0, which follows from its equation (p·a = |p| cos β).
    let height = |t: f64, tan: f64, y: f64| {
        let (cos2, sin2) = ((1.0 - tan * tan) / (1.0 + tan * tan), 2.0 * tan / (1.0 + tan * tan));
        let (b, c) = (0.5 * t * sin2, y * y / (1.0 + tan * tan));
        c / (b + (b * b - c * cos2).sqrt())
    };
    let (apex, roller, race) = (0.11, 0.05, 0.25);
    let profile = LogarithmicProfile::new(2e-6, 12e-3, 0.0, 1.0)?;
    for side in [1.0, -1.0] {
        let shape = Roller::with_profile(apex * roller, profile)?
            .with_counter_radius(side * apex * race)?
            .with_apex(apex)?;
        for (x, y) in [(0.0, 4e-4), (5e-3, 4e-4), (-5e-3, -2e-4)] {
            let t = apex - x;
            let exact = height(t, roller, y) + side * height(t, race, y);
            let drop = shape.gap(x, 0.0);
            near!(drop, -2e-6 * (1.0 - (x / 6e-3) * (x / 6e-3)).ln(), ROUNDING);
            // Circles in place of the cones' sections err by tan²β (y/2R)²: that of the raceway by 1e-6 of its own
            // height. The profile reduces the radius R of the roller by d/R, 1e-3.
            near!(shape.gap(x, y) - drop, exact, 1e-3);
            let bare = Roller::with_profile(
                apex * roller,
                SampledProfile::new(&[-6e-3, 6e-3], &[0.0; 2])?,
            )?
            .with_counter_radius(side * apex * race)?
            .with_apex(apex)?;
            near!(bare.gap(x, y), exact, 5e-6);
        }
        assert_eq!(shape.apex(), Some(apex));
    }
    // Roller and raceway end at the apex.
    let short = Roller::new(5e-3, 8e-3, 2.0)?.with_apex(6e-3)?;
    assert!(short.gap(6e-3, 0.0).is_infinite() && short.gap(5.9e-3, 0.0).is_finite());
    assert!(Roller::new(5e-3, 8e-3, 2.0)?.with_apex(0.0).is_err());
    let cut = Roller::new(5e-3, 8e-3, 2.0)?.with_length(10e-3)?.with_apex(50e-3)?;
    assert_eq!(cut.extent()[1], Extent::Within([-0.9 * 5e-3, 0.9 * 5e-3]));
    near!(cut.radii()[1], 4.5e-3, ROUNDING);
    Ok(())
}

#[test]
fn a_ball_in_a_socket_has_the_gap_of_two_spheres() -> Result<()> {
    let (r, socket) = (14e-3, 14.05e-3);
    let ball = Sphere::new(r)?.with_counter_radii([Some(-socket); 2])?;
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (3.0, -5.0), (8.0, 8.0), (0.0, 13.9)] {
        let (x, y): (f64, f64) = (1e-3 * x, 1e-3 * y);
        let distance = x.hypot(y);
        let exact = circle(r, distance) - circle(socket, distance);
        below!((ball.gap(x, y) - exact).abs(), 1e-15, x, y);
    }
    // A groove around the axis x: its section along x is the circle of the groove, and every other
    // section across the axis of the ring is a circle, too.
    let (groove, ring) = (5.2e-3, 20e-3);
    let ball = Sphere::new(5e-3)?.with_counter_radii([Some(-groove), Some(ring)])?;
    for (x, y) in [(2e-3, 0.0), (0.0, 2e-3), (2e-3, 1e-3)] {
        // Distance of the groove's surface from the axis at x, and its height there.
        let local = ring + circle(groove, x);
        let height = ring - (local * local - y * y).sqrt();
        let exact = circle(5e-3, f64::hypot(x, y)) + height;
        below!((ball.gap(x, y) - exact).abs(), 1e-15, x, y);
    }
    Ok(())
}

#[test]
fn equivalent_radii_are_those_of_the_sum_of_curvatures() -> Result<()> {
    near!(equivalent_radius(Some(5e-3), Some(20e-3))?, 4e-3, ROUNDING);
    near!(equivalent_radius(Some(-30e-3), Some(5e-3))?, 6e-3, ROUNDING);
    assert_relative_eq!(equivalent_radius(None, Some(5e-3))?, 5e-3);
    for (one, two) in [
        (Some(5e-3), Some(-5e-3)),
        (Some(5e-3), Some(-4e-3)),
        (Some(-5e-3), None),
        (None, None),
        (Some(-1.0), Some(-1.0)),
        (Some(0.0), None),
        (Some(f64::NAN), None),
        (Some(f64::INFINITY), Some(-1.0)),
    ] {
        assert!(equivalent_radius(one, two).is_err(), "{one:?} {two:?}");
    }
    let aluminium = Elastic::new(70e9, 0.33)?;
    let both = contact_modulus(&steel()?, Some(&aluminium));
    let due = 0.91 / 210e9 + (1.0 - 0.33 * 0.33) / 70e9;
    near!(1.0 / both, due, ROUNDING);
    Ok(())
}

#[test]
fn relative_radii_are_those_of_bodies_at_an_angle() -> Result<()> {
    // Semi-axes of equal cylinders crossed at an angle, over the contact radius of a ball of their radius, by the cosine of
    // the angle: Roark's Formulas for Stress and Strain, 7th ed. (2002), table 14.1, case 4.
    const HALF_A_DIGIT: f64 = 5e-4;
    let table = [
        (0.0, 1.0, 1.0),
        (0.1, 1.070, 0.936),
        (0.3, 1.242, 0.822),
        (0.5, 1.486, 0.717),
        (0.7, 1.905, 0.608),
        (0.8, 2.292, 0.544),
    ];
    let cylinder = [None, Some(8e-3)];
    let ball = Point::new(8e-3, 115e9, 100.0)?;
    for (cosine, alpha, beta) in table {
        let angle = f64::acos(cosine);
        let (radii, turn) = relative_radii(cylinder, cylinder, angle)?;
        let [a, b] = Ellipse::new(radii, 115e9, 100.0)?.semi_axes;
        below!((a / ball.radius - alpha).abs(), HALF_A_DIGIT, cosine);
        below!((b / ball.radius - beta).abs(), HALF_A_DIGIT, cosine);
        // The contact lies between the two axes; at right angles it is round.
        if cosine > 0.0 {
            below!((turn - 0.5 * angle).abs(), ROUNDING, cosine);
        }
    }
    // Aligned bodies, and bodies turned by a right angle.
    let (ball, groove) = ([Some(5e-3); 2], [Some(-5.2e-3), Some(20e-3)]);
    let aligned = [0, 1]
        .map(|axis| equivalent_radius(ball[axis], groove[axis]))
        .into_iter()
        .collect::<Result<Vec<_>>>()?;
    for (angle, turned) in [(0.0, 0.0), (0.5 * PI, 0.5 * PI), (-PI, 0.0)] {
        let (radii, turn) = relative_radii(ball, groove, angle)?;
        near!(radii[0], aligned[0], 1e-13, angle);
        near!(radii[1], aligned[1], ROUNDING, angle);
        below!((turn.abs() - turned).abs(), ROUNDING, angle);
    }
    // Gap of two bodies in any direction: that of the paraboloid, turned.
    let (one, two, angle) = ([Some(60e-3), Some(130e-3)], [Some(80e-3), Some(200e-3)], 1.1);
    let (radii, turn) = relative_radii(one, two, angle)?;
    let curvature = |radii: [Option<f64>; 2], direction: f64| {
        let [x, y] = radii.map(|radius| radius.map_or(0.0, f64::recip));
        x * direction.cos().powi(2) + y * direction.sin().powi(2)
    };
    for direction in [0.0, 0.7, 1.9, 3.0] {
        let both = curvature(one, direction) + curvature(two, direction - angle);
        near!(curvature(radii.map(Some), direction - turn), both, ROUNDING, direction);
    }
    // An axis along y is at π/2, and never at −π/2, whatever side rounding leaves it on.
    for n in 1..200 {
        let [a, b] = [n, 200 - n].map(|n| Some(1e-3 + 4e-5 * f64::from(n)));
        for angle in [0.5 * PI, -0.5 * PI, PI, -PI, 3.0 * PI] {
            let (_, turn) = relative_radii([a, b], [b, a], angle)?;
            assert!(-0.5 * PI < turn && turn <= 0.5 * PI, "{a:?} {b:?} {angle}: {turn}");
        }
    }
    // Nearly parallel cylinders keep their digits: R′ R″ = R²/sin²φ.
    let ([longer, shorter], _) = relative_radii(cylinder, cylinder, 1e-5)?;
    near!(longer * shorter, (8e-3 / f64::sin(1e-5)).powi(2), ROUNDING);
    for (one, two, angle) in [
        (cylinder, cylinder, 0.0),
        (cylinder, cylinder, PI),
        (cylinder, [None, Some(-9e-3)], 0.3),
        ([Some(0.0), None], cylinder, 0.3),
        (cylinder, cylinder, f64::NAN),
        (cylinder, [None, Some(f64::INFINITY)], 0.3),
        ([Some(1e-320); 2], cylinder, 0.3),
    ] {
        assert!(relative_radii(one, two, angle).is_err(), "{one:?} {two:?} {angle}");
    }
    Ok(())
}

#[test]
fn a_concave_counterpart_must_be_wider() -> Result<()> {
    for radius in [-5e-3, -4e-3, 0.0, f64::NAN] {
        let cylinder = Cylinder::new(5e-3)?.with_counter_radius(radius);
        assert!(cylinder.is_err(), "{radius}");
        let sphere = Sphere::new(5e-3)?.with_counter_radii([None, Some(radius)]);
        assert!(sphere.is_err_and(|error| error.to_string().contains("counter_radius_y")));
        let paraboloid = Paraboloid::new(5e-3, 1.0)?.with_counter_radii([Some(radius), None]);
        assert!(paraboloid.is_err_and(|error| error.to_string().contains("raceway or groove")));
    }
    let hint = Cylinder::new(-30e-3).err().map(|error| error.to_string());
    assert!(hint.is_some_and(|text| text.contains("counter_radius") && text.contains("raceway")));
    Ok(())
}

#[test]
fn a_line_contact_in_a_raceway_is_that_of_the_equivalent_radius() -> Result<()> {
    let steel = steel()?;
    let modulus = contact_modulus(&steel, Some(&steel));
    for race in [-30e-3, 20e-3] {
        let roller = Cylinder::new(5e-3)?.with_counter_radius(race)?;
        let exact = Line::new(roller.equivalent_radius(), modulus, 1e5)?;
        let grid = Grid::line(160, 4.0 * exact.half_width)?;
        let setup = against(steel);
        let contact = Contact::plan(steel, grid, setup)?;
        let solution = contact.solve(&roller, &Motion::load(1e5), &Options::default())?;
        let bar = ON_THE_GRID + PARABOLA;
        near!(solution.peak_pressure(), exact.peak_pressure, bar);
    }
    Ok(())
}

#[test]
fn a_ball_in_a_groove_is_the_ellipse_of_hertz() -> Result<()> {
    // The groove is three times as wide as the ball, so that the contact is small compared with both.
    let steel = steel()?;
    let ball = Sphere::new(5e-3)?.with_counter_radii([Some(-15e-3), Some(20e-3)])?;
    let exact = Ellipse::new(ball.equivalent_radii(), steel.plane_strain_modulus(), 50.0)?;
    let solution = solve(&ball, steel, &Motion::load(50.0))?;
    near!(solution.peak_pressure(), exact.peak_pressure, 2e-3);
    near!(solution.approach, exact.approach, ON_THE_GRID);
    let paraboloid =
        Paraboloid::new(5e-3, 5e-3)?.with_counter_radii([Some(-15e-3), Some(20e-3)])?;
    let [one, two] = [paraboloid.equivalent_radii(), ball.equivalent_radii()];
    assert_eq!(one.map(f64::to_bits), two.map(f64::to_bits));
    Ok(())
}

#[test]
fn ellipses_satisfy_the_equations_of_johnson() -> Result<()> {
    // Eqs (4.26) and (4.28) in Legendre's form for a = 3 b, p0 = E*/20: m = 8/9, K(8/9) and E(8/9).
    let (k, e) = (2.528_625_532_218_893_7, 1.113_741_101_712_938_2);
    let (a, b, m) = (3.0, 1.0, 8.0 / 9.0);
    let common = 0.05 * b / (m * a * a);
    let radii = [0.5 / (common * (k - e)), 0.5 / (common * (9.0 * e - k))];
    let load = 2.0 / 3.0 * PI * a * b * 0.05;
    for swapped in [false, true] {
        let radii = if swapped { [radii[1], radii[0]] } else { radii };
        let contact = Ellipse::new(radii, 1.0, load)?;
        let axes = if swapped { [b, a] } else { [a, b] };
        for (found, exact) in contact.semi_axes.into_iter().zip(axes) {
            near!(found, exact, 1e-6);
        }
        near!(contact.approach, 0.05 * b * k, 1e-6);
    }
    // A circle is a point contact.
    let round = Ellipse::new([2.0, 2.0], 3.0, 1e-3)?;
    let point = Point::new(2.0, 3.0, 1e-3)?;
    near!(round.semi_axes[0], point.radius, ROUNDING);
    near!(round.semi_axes[1], point.radius, ROUNDING);
    near!(round.approach, point.approach, ROUNDING);
    near!(round.peak_pressure, point.peak_pressure, ROUNDING);
    // A very long ellipse is a line contact of the load per length in the middle, 2/3 · 3W/2a · π/4 …
    // p0 = 2W'/πb and b² = 4W'R/πE*, which give p0 = b E*/2R.
    let long = Ellipse::new([1e9, 1.0], 1.0, 1e-3)?;
    let [_, b] = long.semi_axes;
    near!(long.peak_pressure, 0.5 * b, 1e-6);
    Ok(())
}

#[test]
fn extreme_ellipses_are_numbers_or_errors() -> Result<()> {
    for ratio in [1.0, 1e3, 1e12, 1e100, 1e300] {
        match Ellipse::new([ratio, 1.0], 1.0, 1.0) {
            Ok(contact) => {
                let numbers = [contact.semi_axes[0], contact.semi_axes[1], contact.approach];
                let is_number = |v: &f64| v.is_finite() && *v > 0.0;
                assert!(numbers.iter().all(is_number), "{contact:?}");
                let shear = contact.max_shear(0.3)?;
                assert!(shear.stress.is_finite() && shear.depth > 0.0, "{shear:?}");
            }
            Err(error) => {
                let is_named = error.to_string().contains("radii");
                assert!(ratio > 1e12 && is_named, "{error}");
            }
        }
    }
    Ok(())
}

/// Half-cells of uniform pressure at the rim, and the scan of depths: measured 2e-5 at b/a = 0.6.
const SUMMED: f64 = 2e-4;

#[test]
fn largest_shear_is_that_of_the_summed_pressure() -> Result<()> {
    let steel = steel()?;
    for (radii, poisson) in [([1.0, 1.0], 0.3), ([2.0, 1.0], 0.25), ([1.0, 5.0], 0.4)] {
        let body = Elastic::new(210e9, poisson)?;
        let contact = Ellipse::new(radii, steel.plane_strain_modulus(), 1e3)?;
        let found = contact.max_shear(poisson)?;
        let [a, b] = contact.semi_axes;
        let grid = Grid::new([97, 97], [2.05 * a, 2.05 * b])?;
        let (x, y) = (grid.x(), grid.y());
        let mut pressure = Array2::from_shape_fn((97, 97), |(i, j)| contact.pressure(x[i], y[j]));
        pressure *= 1e3 / (pressure.sum() * grid.cell_area());
        let depths: Vec<f64> =
            (-20..=20).map(|k| found.depth * (1.0 + 0.005 * f64::from(k))).collect();
        let options = StressOptions::default().with_section(Section::Axis([0.0; 2]));
        let field = stress(&body.into(), &grid, &pressure, &depths, &options)?;
        let shear: Vec<f64> = field.max_shear().into_iter().collect();
        let largest = shear.iter().fold(0.0_f64, |a, b| a.max(*b));
        near!(found.stress, largest, SUMMED);
        // A depth that is wrong by 10 % has less shear, on either side.
        for end in [shear[0], shear[40]] {
            below!(end, largest * (1.0 - 1e-3));
        }
    }
    Ok(())
}

#[test]
fn largest_shear_has_the_known_values() -> Result<()> {
    // Johnson (1985), §4.1 and §4.2(c): 0.30 p0 at 0.78 b below a line, 0.31 p0 at 0.48 a below a circle, for
    // ν = 0.3.
    let (line, point) = (Line::new(1.0, 1.0, 1.0)?, Point::new(1.0, 1.0, 1.0)?);
    let shear = line.max_shear(0.3)?;
    below!((shear.stress / line.peak_pressure - 0.30).abs(), PRINTED);
    below!((shear.depth / line.half_width - 0.78).abs(), READ);
    let shear = point.max_shear(0.3)?;
    let z = shear.depth / point.radius;
    below!((shear.stress / point.peak_pressure - 0.31).abs(), PRINTED);
    below!((z - 0.48).abs(), READ);
    // To all digits on the axis of a circle: the root of the closed form, Johnson (1985), eq. (3.45).
    let radial = |z: f64| -1.3 * (1.0 - z * (1.0 / z).atan()) + 0.5 / (1.0 + z * z);
    let exact = 0.5 * (1.0 / (1.0 + z * z) + radial(z));
    near!(shear.stress / point.peak_pressure, exact, 1e-12);
    // Where Poisson's ratio is 0, the surface of a line contact has half the pressure as shear.
    let shear = line.max_shear(0.0)?;
    assert_relative_eq!(shear.stress, 0.5 * line.peak_pressure);
    assert_relative_eq!(shear.depth, 0.0);
    assert!(line.max_shear(0.6).is_err());
    Ok(())
}

#[test]
fn a_logarithmic_profile_fits_a_raceway_by_its_equivalent_radius() -> Result<()> {
    // Johns & Gohar's end factor has the half-width of the contact on the raceway in it.
    let steel = steel()?;
    let modulus = contact_modulus(&steel, Some(&steel));
    let radius = equivalent_radius(Some(5e-3), Some(-30e-3))?;
    let profile = LogarithmicProfile::johns_gohar(20e-3, 20e3, modulus, radius)?;
    let b = Line::new(radius, modulus, 1e6)?.half_width;
    near!(profile.end_factor(), 1.0 - 0.3033 * b / 10e-3, ROUNDING);
    Ok(())
}

/// Rounding of a sum of n terms: √n ε, and n ε at most.
const MANY: usize = 100_000;

#[test]
fn a_hundred_thousand_shapes_are_one() -> Result<()> {
    let shapes = vec![Paraboloid::new(1e5, 2e5)?; MANY];
    let sum = Superposition::new(shapes)?;
    let one = Paraboloid::new(1e5 / MANY as f64, 2e5 / MANY as f64)?;
    let grid = Grid::new([8, 8], [1e-3, 1e-3])?;
    let rounding = MANY as f64 * f64::EPSILON;
    for (found, exact) in sum.gaps(&grid)?.iter().zip(&one.gaps(&grid)?) {
        near!(*found, *exact, rounding);
    }
    let contact = plan(Elastic::new(1e9, 0.3)?, grid)?;
    let press = |shape: &dyn Surface| contact.solve(shape, &Motion::load(1.0), &Options::default());
    let (many, single) = (press(&sum)?, press(&one)?);
    near!(many.approach, single.approach, 1e-6);
    Ok(())
}

#[test]
fn a_superposition_is_the_sum_of_its_shapes() -> Result<()> {
    let heights = Array2::from_shape_fn((6, 5), |(i, j)| (i * j) as f64 * 1e-9);
    let map = HeightMap::new(heights, [1e-4; 2])?;
    let sphere = Sphere::new(1e-2)?.shifted(1e-4, 0.0)?;
    let pair = sphere.clone().plus(map.clone());
    let list: Vec<Box<dyn Surface>> = vec![Box::new(sphere), Box::new(map.clone())];
    let list = Superposition::new(list)?;
    let grid = map.grid().ok_or(Error::Inconsistent("a map has a grid"))?;
    assert_eq!(list.gaps(&grid)?, pair.gaps(&grid)?);
    assert_eq!(list.extent(), pair.extent());
    let bits = |radii: [f64; 2]| radii.map(f64::to_bits);
    assert_eq!(bits(list.radii()), bits(pair.radii()));
    assert_eq!(list.grid(), pair.grid());
    let (one, other) = (Cylinder::new(1e-2)?, Cylinder::new(1e-2)?);
    let two: [Box<dyn Surface>; 3] = [Box::new(map.clone()), Box::new(one), Box::new(other)];
    let two = Superposition::new(two)?;
    assert!(two.rolling_direction().is_some());
    assert!(Superposition::new([map])?.rolling_direction().is_none());
    assert_relative_eq!(list.gap(1e-4, 2e-4), pair.gap(1e-4, 2e-4));
    let none = Superposition::<Sphere>::new([]);
    assert!(none.is_err_and(|error| error.to_string().contains("at least one shape")));
    Ok(())
}

#[test]
fn an_infinite_radius_is_flat() -> Result<()> {
    let (r, y) = (20e-3, 3e-3);
    let flat = Cylinder::new(f64::INFINITY)?;
    assert_eq!((flat.gap(1.0, 2.0), flat.equivalent_radius()), (0.0, f64::INFINITY));
    assert_eq!((flat.extent(), flat.parameters()), ([Extent::Endless; 2], vec![]));
    // On a convex raceway a plane has the gap of the raceway; a concave one is not wider.
    let on_a_ring = flat.with_counter_radius(r)?;
    near!(on_a_ring.gap(1.0, y), circle(r, y), ROUNDING);
    near!(on_a_ring.equivalent_radius(), r, ROUNDING);
    assert_eq!(on_a_ring.extent()[1], Extent::Within([-r, r]));
    assert!(flat.with_counter_radius(-r).is_err());
    for infinite in [f64::INFINITY, f64::NEG_INFINITY] {
        let counter = [Some(infinite), Some(-2.0 * r)];
        assert_eq!(Cylinder::new(r)?.with_counter_radius(infinite)?, Cylinder::new(r)?);
        assert_eq!(
            Sphere::new(r)?.with_counter_radii(counter)?,
            Sphere::new(r)?.with_counter_radii([None, Some(-2.0 * r)])?
        );
        assert_eq!(Paraboloid::new(r, r)?.with_counter_radii(counter)?.counter_radii()[0], None);
        near!(equivalent_radius(Some(infinite), Some(r))?, r, ROUNDING);
        assert_eq!(
            relative_radii([Some(infinite), Some(r)], [Some(r), Some(infinite)], 0.3)?,
            relative_radii([None, Some(r)], [Some(r), None], 0.3)?
        );
        assert!(equivalent_radius(Some(infinite), None).is_err());
    }
    for wrong in [f64::NEG_INFINITY, f64::NAN, 0.0] {
        assert!(Cylinder::new(wrong).is_err() && Paraboloid::new(wrong, r).is_err());
        assert!(equivalent_radius(Some(r), Some(wrong)).is_err() || wrong.is_infinite());
    }
    // A parabolic trough: x²/2R, and as long as the grid along y.
    let trough = Paraboloid::new(r, f64::INFINITY)?;
    near!(trough.gap(y, 7.0), y * y / (2.0 * r), ROUNDING);
    assert_eq!(trough.extent(), [Extent::Rising, Extent::Endless]);
    assert_eq!(trough.parameters(), [("radius_x".to_owned(), r)]);
    kept(&flat);
    kept(&on_a_ring);
    kept(&trough);
    Ok(())
}

#[test]
fn a_flat_shape_touches_where_the_grid_repeats_or_not_at_all() -> Result<()> {
    let (flat, trough) = (Cylinder::new(f64::INFINITY)?, Paraboloid::new(f64::INFINITY, 5e-3)?);
    let hertz = Line::new(5e-3, contact_modulus(&steel()?, None), 1e5)?;
    // 40 cells on a half-width.
    let line = Grid::line(120, 3.0 * hertz.half_width)?;
    let solved = |shape: &dyn Surface, grid: &Grid, load: f64| -> Result<f64> {
        let contact = plan(steel()?, *grid)?;
        let solution = contact.solve(shape, &Motion::load(load), &Options::default())?;
        Ok(solution.peak_pressure())
    };
    near!(solved(&trough, &line, 1e5)?, hertz.peak_pressure, ON_THE_GRID);
    for grid in [line, Grid::new([8, 8], [1e-3, 1e-3])?] {
        let error = solved(&flat, &grid, 1e3).map_err(|error| error.to_string());
        assert!(error.is_err_and(|text| text.contains("shape must be curved across the contact")));
    }
    let repeating = Grid::new([8, 8], [1e-3, 1e-3])?.periodic([true, true])?;
    near!(solved(&flat, &repeating, 1e3)?, 1e9, ROUNDING);
    Ok(())
}
