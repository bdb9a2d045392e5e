//! Sums over images against waves in the layered body.

use std::f64::consts::PI;

use ndarray::Array2;

use crate::compliance::response::interior::{Column, InPlane, Place};
use crate::error::Result;
use crate::model::body::{HalfSpace, Interface, Layer, Substrate};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::stress::{Stress, StressOptions, stress};

const CELLS: [usize; 2] = [24, 15];

/// Bare, under a thin hard and a thick soft layer, two layers of which one slips, and a layer on a rigid base;
/// thicknesses in cells.
fn bodies() -> Result<Vec<HalfSpace>> {
    let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(5.0, 0.2)?);
    let slipping = Layer::new(soft, 2.0)?.with_interface(Interface::Frictionless);
    Ok(vec![
        soft.into(),
        HalfSpace::new(soft, [Layer::new(hard, 0.4)?])?,
        HalfSpace::new(hard, [Layer::new(soft, 30.0)?])?,
        HalfSpace::new(soft, [Layer::new(hard, 1.0)?, slipping])?,
        HalfSpace::new(Substrate::Rigid, [Layer::new(soft, 3.0)?])?,
    ])
}

/// Fields of pressures that are uniform over cells, 1 + cos(2πk x/L) cos(2πl y/L) at their centres.
fn waves(body: &HalfSpace, depth: f64, waves: [usize; 2]) -> Result<(Stress, Grid)> {
    let size = CELLS.map(|n| n as f64);
    let grid = Grid::new(CELLS, size)?.periodic([true; 2])?;
    let phase =
        |k: usize, i: usize| 2.0 * PI * (waves[k] * (2 * i + 1)) as f64 / (2 * CELLS[k]) as f64;
    let pressure =
        Array2::from_shape_fn(CELLS, |(i, j)| 1.0 + phase(0, i).cos() * phase(1, j).cos());
    let options = StressOptions { displacement: true, ..StressOptions::default() };
    Ok((stress(body, &grid, &pressure, &[depth], &options)?, grid))
}

/// Amplitudes of all waves that look like this one at the centres of the cells, with their wavenumbers.
fn aliases(wave: usize, cells: usize) -> Vec<(f64, f64)> {
    (-400..=400_i64)
        .map(|alias| {
            let number = wave as f64 + (alias * cells as i64) as f64;
            let at = PI * number / cells as f64;
            let mean = if at.abs() < 1e-12 { 1.0 } else { at.sin() / at };
            let sign = if alias % 2 == 0 { 1.0 } else { -1.0 };
            (sign * mean, 2.0 * PI * number / cells as f64)
        })
        .collect()
}

fn state(body: &HalfSpace, place: &Place, alpha: f64) -> InPlane {
    Column::new(body, alpha).at(body, place).pressure
}

/// Waves along x have the stress and displacement of the layered body, Σ over all that look alike; the mean has
/// none along the surface. Sums over images err by 1e-7 of the coefficient of the loaded cell, which is at most the
/// pressure; the sums of aliases end where e^{−αz} is 1e-12.
#[test]
fn waves_along_one_direction_are_those_of_the_body() -> Result<()> {
    for (number, body) in bodies()?.iter().enumerate() {
        let deepest = match body.substrate() {
            Substrate::Rigid => 2.9,
            Substrate::Elastic(_) => 6.0,
        };
        for depth in [0.3, 1.7, deepest] {
            let (found, _) = waves(body, depth, [3, 0])?;
            let place = place_at(body, depth);
            let nu = place.material.poisson();
            let i = 4;
            let x = i as f64 + 0.5;
            let mut due = [0.0; 5];
            for (amplitude, q) in aliases(3, CELLS[0]) {
                let alpha = q.abs();
                if alpha * depth > 40.0 {
                    continue;
                }
                let state = state(body, &place, alpha);
                let (along, across) = state.lateral_stress(place.material);
                let (sin, cos) = (alpha * x).sin_cos();
                due[0] += amplitude * along * cos;
                due[1] += amplitude * across * cos;
                due[2] -= amplitude * state.p * cos;
                due[3] += amplitude * state.tau * sin;
                due[4] += amplitude * state.w / alpha * cos;
            }
            let mean = [-nu / (1.0 - nu), -nu / (1.0 - nu), -1.0, 0.0];
            let stresses = [found.xx(), found.yy(), found.zz(), found.xz()];
            for ((stress, due), mean) in stresses.iter().zip(due).zip(mean) {
                for j in [0, 7] {
                    let error = stress[[0, i, j]] - due - mean;
                    assert!(error.abs() < 1e-6, "body {number}, z {depth}: {error:e}");
                }
            }
            // Shears across the wave are none.
            assert!(found.yz().iter().chain(found.xy()).all(|s| s.abs() < 1e-6));
            let uz = found.uz().expect("it was asked for");
            let waves = uz[[0, i, 0]] - uz[[0, i + 4, 0]];
            // Half a wave further the sign has changed; the mean drops out.
            assert!((waves - 2.0 * due[4]).abs() < 2e-6, "{number} {waves:e} {:e}", due[4]);
        }
    }
    Ok(())
}

/// Crossed waves are those of the body, too: σ_zz.
#[test]
fn crossed_waves_are_those_of_the_body() -> Result<()> {
    for body in &bodies()? {
        let depth = 1.3;
        let (found, _) = waves(body, depth, [2, 4])?;
        let place = place_at(body, depth);
        let (i, j) = (5, 6);
        let mut due = -1.0;
        for (a, qx) in aliases(2, CELLS[0]).into_iter().filter(|(_, q)| q.abs() < 25.0) {
            for (b, qy) in aliases(4, CELLS[1]).into_iter().filter(|(_, q)| q.abs() < 25.0) {
                let state = state(body, &place, qx.hypot(qy));
                let [x, y] = [qx * (i as f64 + 0.5), qy * (j as f64 + 0.5)];
                due -= a * b * state.p * x.cos() * y.cos();
            }
        }
        let error = found.zz()[[0, i, j]] - due;
        assert!(error.abs() < 1e-6, "{error:e}");
    }
    Ok(())
}

fn place_at(body: &HalfSpace, depth: f64) -> Place {
    let mut top = 0.0;
    for (number, layer) in body.layers().iter().enumerate() {
        if depth < top + layer.thickness() {
            return Place {
                layer: number,
                below_top: depth - top,
                depth,
                material: layer.material(),
            };
        }
        top += layer.thickness();
    }
    let Substrate::Elastic(material) = body.substrate() else {
        panic!("{depth} lies below the rigid base");
    };
    Place { layer: body.layers().len(), below_top: depth - top, depth, material }
}
