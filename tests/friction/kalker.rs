//! Kalker's coefficients.

use nacre::Result;
use nacre::friction::{CreepCoefficients, creep_coefficients};

use crate::support::pairs::{coated, material};
use crate::support::reference::{cases, list, number, read};

/// Coefficients of two equal bodies without layers.
fn bare(poisson: f64, semi_axes: [f64; 2], cells: usize) -> Result<CreepCoefficients> {
    let steel = material(poisson)?;
    creep_coefficients(steel, Some(steel.into()), semi_axes, Some(cells), None)
}

/// Kalker's table E3 with three digits, as CONTACT has it, for ν = ¼; the last digit of slender ellipses is in doubt.
#[test]
fn of_kalkers_table() -> Result<()> {
    let table = read("friction/kalker_table_E3.json");
    for row in list(&table, "rows") {
        let value = number(row, "value");
        let semi_axes = match row["ratio"].as_str() {
            Some("a/b") => [value, 1.0],
            Some("b/a") => [1.0, value],
            other => panic!("{other:?}"),
        };
        let found = bare(0.25, semi_axes, 64)?;
        for (name, found) in [("C11", found.c11), ("C22", found.c22), ("C23", found.c23)] {
            let printed = list(row, name)[1].as_f64().expect("a number");
            assert!(
                (found / printed - 1.0).abs() < 1.5e-2,
                "{name} {row}: {found}"
            );
        }
    }
    Ok(())
}

/// A circle, extrapolated from up to 256 cells by another program: four digits.
#[test]
fn of_a_circle() -> Result<()> {
    for case in list(&read("friction/kalker_coated.json"), "bare_circle") {
        let found = bare(number(case, "nu"), [1.0, 1.0], 64)?;
        for (name, found) in [("C11", found.c11), ("C22", found.c22), ("C23", found.c23)] {
            let exact = number(case, name);
            assert!((found / exact - 1.0).abs() < 3e-3, "{name} {case}: {found}");
        }
    }
    Ok(())
}

/// Coated circles over bare ones.
#[test]
fn of_coated_bodies() -> Result<()> {
    let without = bare(0.3, [1.0, 1.0], 64)?;
    for case in cases("friction/kalker_coated.json") {
        let body = coated(number(&case, "E1_over_E2"), number(&case, "h_over_a"))?;
        let with = creep_coefficients(body.clone(), Some(body.into()), [1.0, 1.0], Some(64), None)?;
        let ratios = [
            ("C11", with.c11 / without.c11),
            ("C22", with.c22 / without.c22),
            ("C23", with.c23 / without.c23),
        ];
        for (name, found) in ratios {
            let exact = number(&case, name);
            assert!((found / exact - 1.0).abs() < 3e-3, "{name} {case}: {found}");
        }
    }
    Ok(())
}
