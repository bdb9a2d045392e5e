//! The free ends of the bodies of a contact, on a grid.

use std::collections::BTreeMap;

use ndarray::Array2;

use super::quarter_space::{Nodes, coefficients};
use super::waves::Along;
use super::{contrast, model_error, plate};
use crate::compliance::convolution::{Addition, RowWeights};
use crate::compliance::response::Body;
use crate::error::{Error, Result};
use crate::model::body::{HalfSpace, Substrate};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::model::surface::{Extent, ShapeInRange, Surface};
use crate::numerics::parallel::Threads;

/// Distance between an end and the edge of a cell, in cells, or the end of a shape, relative to its length, that is
/// rounding.
const ROUNDED_PLACE: f64 = 1e-6;

#[derive(Debug, Clone)]
struct End {
    /// 0 where the body ends at its lowest x, 1 at its highest.
    side: usize,
    x: f64,
    ending: Ending,
}

/// What ends: a body, without its ends, and the material of its substrate.
#[derive(Debug, Clone, PartialEq)]
struct Ending {
    body: HalfSpace,
    material: Elastic,
}

/// How the free ends of a contact's bodies are counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeEnds {
    /// Whether a body has two free ends, and is taken as a plate; else each end is that of a quarter space.
    pub plates: bool,
    /// Largest error that was measured: of the displacement, relative to it, 1e-5 for a quarter space; for a plate 1e-3,
    /// of the pressure as well, relative to its peak; 3e-3 for a plate shorter than a quarter of the grid's width, which may be
    /// shorter than half of the contact's half-width.
    /// A body with layers is a model: 0.04 where moduli differ by a factor of 4 at most, 0.09 at 10; `None` beyond.
    pub error: Option<f64>,
}

#[derive(Debug, Clone)]
struct Plate {
    ends: [f64; 2],
    ending: Ending,
}

/// The free ends of all bodies of a contact.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ends {
    ends: Vec<End>,
    plates: Vec<Plate>,
    /// Number of bodies that are not rigid.
    bodies: usize,
    /// Whether a body with a free end has layers.
    pub(crate) layered: bool,
}

impl Ends {
    pub(crate) fn of(bodies: &[&Body]) -> Self {
        let (mut ends, mut plates) = (Vec::new(), Vec::new());
        let mut layered = false;
        for half_space in bodies.iter().filter_map(|body| body.half_space()) {
            let Substrate::Elastic(material) = half_space.substrate() else {
                continue;
            };
            let (layers, has_layers) = (half_space.layers(), !half_space.layers().is_empty());
            // Layers on a substrate that is not rigid make a body.
            let Ok(body) = HalfSpace::new(material, layers.iter().cloned()) else {
                continue;
            };
            let ending = Ending { body, material };
            for (side, x) in half_space.ends().into_iter().enumerate() {
                if let Some(x) = x {
                    let ending = ending.clone();
                    ends.push(End { side, x, ending });
                    layered |= has_layers;
                }
            }
            if let [Some(low), Some(high)] = half_space.ends() {
                let ends = [low, high];
                plates.push(Plate { ends, ending });
            }
        }
        Self { ends, plates, bodies: bodies.len(), layered }
    }

    /// How the ends are counted on a grid of this `width` along y; `None` where there are none.
    pub(crate) fn form(&self, width: f64) -> Option<FreeEnds> {
        let plates = !self.plates.is_empty();
        let is_short = |plate: &Plate| plate.ends[1] - plate.ends[0] < 0.25 * width;
        let exact = match plates {
            true if self.plates.iter().any(is_short) => 3e-3,
            true => 1e-3,
            false => 1e-5,
        };
        let bodies = self.ends.iter().map(|end| &end.ending.body);
        let contrast = bodies.map(contrast).reduce(f64::max)?;
        let error = if contrast > 1.0 { model_error(contrast) } else { Some(exact) };
        Some(FreeEnds { plates, error })
    }

    pub(crate) fn any(&self) -> bool {
        !self.ends.is_empty()
    }

    /// Range of x in which all bodies extend.
    pub(crate) fn range(&self) -> [f64; 2] {
        let on = |side: usize| self.ends.iter().filter(move |end| end.side == side);
        [
            on(0).fold(f64::NEG_INFINITY, |x, end| x.max(end.x)),
            on(1).fold(f64::INFINITY, |x, end| x.min(end.x)),
        ]
    }

    /// Number of bodies that end on side `k` at x, or before, and whether these are all.
    pub(crate) fn at(&self, k: usize, x: f64, tolerance: f64) -> (usize, bool) {
        let before = |end: &&End| match end.side {
            0 => end.x >= x - tolerance,
            _ => end.x <= x + tolerance,
        };
        let count = self.ends.iter().filter(|end| end.side == k).filter(before).count();
        (count, count >= self.bodies)
    }

    /// `shape`, which cannot touch beyond the ends.
    pub(crate) fn limit<'a>(&self, shape: &'a dyn Surface) -> ShapeInRange<'a> {
        ShapeInRange::new(shape, self.range())
    }

    /// Checks that the ends lie on edges of the cells of `grid`, or outside them.
    ///
    /// # Errors
    /// Where one does not; where fewer than two rows of cells are left; in line contact; where the grid repeats along y,
    /// [`Error::ThickEnd`].
    pub(crate) fn check(&self, grid: &Grid) -> Result<()> {
        if !self.any() {
            return Ok(());
        }
        if grid.is_line() {
            return Err(Error::Inconsistent(
                "ends must not be given in line contact, whose strips extend along x",
            ));
        }
        // A pressure that is uniform over the period has the factor of the bare substrate, though layers that are thick
        // compared with the period carry it.
        let thicknesses = self.ends.iter().map(|end| end.ending.body.thickness());
        let (thickness, period) = (thicknesses.fold(0.0, f64::max), grid.size()[1]);
        if grid.is_periodic()[1] && thickness > period {
            return Err(Error::ThickEnd { thickness, period });
        }
        let (count, spacing) = (grid.shape()[0] as f64, grid.spacing()[0]);
        let place = |x: f64| (x - start(grid)) / spacing;
        for end in &self.ends {
            let at = place(end.x);
            let off = (at - at.round()).abs() > ROUNDED_PLACE;
            if at > ROUNDED_PLACE && at < count - ROUNDED_PLACE && off {
                return Err(Error::EndOffGrid {
                    end: end.x,
                    edges: [at.floor(), at.ceil()].map(|k| start(grid) + k * spacing),
                });
            }
        }
        let [low, high] = self.range().map(|x| place(x).clamp(0.0, count).round());
        if high - low < 2.0 {
            return Err(Error::Inconsistent(
                "ends must leave at least two rows of cells of the grid along x between them",
            ));
        }
        Ok(())
    }

    /// What the ends add to the influence coefficients of all bodies together on `grid`; ends within a cell are
    /// moved to its edge. `finest` is the grid of a contact that this one belongs to.
    ///
    /// Where the grid repeats, an end adds nothing to the displacement at twice the distance of the farthest cell, or at
    /// the width of the grid if that is more.
    pub(crate) fn additions(
        &self,
        grid: &Grid,
        finest: &Grid,
        threads: &Threads,
    ) -> Result<Vec<Addition>> {
        let nx = grid.shape()[0];
        let dx = grid.spacing()[0];
        let length = Along::of(grid).length;
        let [low, high] = [0.0, finest.size()[0]].map(|part| start(finest) + part);
        let mut groups: BTreeMap<(usize, u64), Vec<&End>> = BTreeMap::new();
        for end in &self.ends {
            groups.entry((end.side, end.x.to_bits())).or_default().push(end);
        }
        // Rollers end alike on both sides.
        let mut known: Vec<(Nodes, f64, Vec<&Ending>, Array2<f64>)> = Vec::new();
        let mut additions = Vec::new();
        for ends in groups.values() {
            let &End { side, x, .. } = ends[0];
            let from_end = |row: usize| {
                let center = start(grid) + (row as f64 + 0.5) * dx;
                if side == 0 { center - x } else { x - center }
            };
            let rows: Vec<usize> =
                if side == 0 { (0..nx).collect() } else { (0..nx).rev().collect() };
            let beyond = rows.iter().take_while(|row| from_end(**row) < 0.0).count();
            let Some(&first) = rows.get(beyond) else {
                continue;
            };
            let nearest = from_end(first);
            // The end is on an edge of this row, within it or the row before, or outside the grid.
            let inside = beyond > 0 || nearest < 0.5 * dx;
            let nearest = if inside { 0.5 * dx } else { nearest };
            let nodes = Nodes::new(nearest, dx, nx - beyond);
            let endings: Vec<&Ending> = ends.iter().map(|end| &end.ending).collect();
            let datum = (high - low).max(2.0 * (x - low).abs().max((high - x).abs()));
            let entry = known.iter().find(|(n, d, e, _)| {
                *n == nodes && d.to_bits() == datum.to_bits() && *e == endings
            });
            let coefficients = match entry {
                Some((.., coefficients)) => coefficients.clone(),
                None => threads.run(|| total(&endings, &nodes, (grid, datum), threads))?,
            };
            let mut weights = vec![RowWeights::default(); nx];
            for (row, node) in rows[beyond..].iter().zip(&nodes.rows) {
                weights[*row] = node.clone();
            }
            additions.push(Addition::new(weights, length, &coefficients));
            known.push((nodes, datum, endings, coefficients));
        }
        for Plate { ends, ending } in &self.plates {
            let plate = ends[1] - ends[0];
            let from_start = (0..nx).map(|row| start(grid) + (row as f64 + 0.5) * dx - ends[0]);
            let coefficients =
                plate::coefficients((&ending.body, ending.material), plate, grid, finest.size());
            let rows = plate::rows(from_start, dx, plate);
            additions.push(Addition::new(rows, length, &coefficients));
        }
        Ok(additions)
    }
}

/// Checks that the body which carries a `shape` extends as far as the shape does.
///
/// # Errors
/// [`Error::EndWithinShape`].
pub(crate) fn check_carried(counterbody: Option<&Body>, shape: &dyn Surface) -> Result<()> {
    let Extent::CutOff([low, high]) = shape.extent()[0] else {
        return Ok(());
    };
    let [from, to] = Ends::of(&Vec::from_iter(counterbody)).range();
    let within = ROUNDED_PLACE * (high - low);
    for (end, shape, inside) in [(from, low, from > low + within), (to, high, to < high - within)] {
        if inside {
            return Err(Error::EndWithinShape { end, shape });
        }
    }
    Ok(())
}

/// Coefficients of bodies that end at the same place on a grid, with a datum.
fn total(
    endings: &[&Ending],
    nodes: &Nodes,
    on: (&Grid, f64),
    threads: &Threads,
) -> Result<Array2<f64>> {
    let of = |ending: &Ending| coefficients((&ending.body, ending.material), nodes, on, threads);
    let mut sum = of(endings[0])?;
    for ending in &endings[1..] {
        sum += &of(ending)?;
    }
    Ok(sum)
}

/// Lowest x of a grid.
fn start(grid: &Grid) -> f64 {
    grid.center()[0] - 0.5 * grid.size()[0]
}
