//! Memory of an iteration.

use crate::numerics::parallel::Rows;

/// Memory of the arrays of an iteration; it may be larger than needed.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    u: Vec<f64>,
    r: Vec<f64>,
    r_before: Vec<f64>,
    z: Vec<f64>,
    direction: Vec<f64>,
    response: Vec<f64>,
    trial: Vec<f64>,
    images: [Vec<f64>; 3],
}

/// Arrays of an iteration, as long as there are cells.
pub(super) struct Arrays<'a> {
    /// Displacement K p.
    pub(super) u: &'a mut [f64],
    /// Residual −g on contact cells, 0 elsewhere.
    pub(super) r: &'a mut [f64],
    /// Residual of the iteration before.
    pub(super) r_before: &'a mut [f64],
    /// Preconditioned residual M r.
    pub(super) z: &'a mut [f64],
    /// Search direction.
    pub(super) direction: &'a mut [f64],
    /// K applied to the last direction, or to the last change of the pressure.
    pub(super) response: &'a mut [f64],
    /// Trial pressure of a step on which cells leave, and then the change to it.
    pub(super) trial: &'a mut [f64],
    /// M applied to each loaded degree of freedom on a contact; the others are not read.
    pub(super) images: [&'a mut [f64]; 3],
}

impl Memory {
    /// Makes the arrays long enough for the cells of `rows`. A new array gets room for `most` cells, the
    /// largest number that a solve may need, which the plan's memory was checked for; most systems hand
    /// memory out only as it is written.
    pub(crate) fn reserve(&mut self, rows: &Rows, most: usize, loaded: [bool; 3]) {
        let Self { u, r, r_before, z, direction, response, trial, images } = self;
        let arrays = [u, r, r_before, z, direction, response, trial];
        let images = images.iter_mut().zip(loaded);
        let images = images.filter_map(|(image, loaded)| loaded.then_some(image));
        let short = |array: &&mut Vec<f64>| array.len() < rows.cells();
        let mut short: Vec<_> = arrays.into_iter().chain(images).filter(short).collect();
        for array in &mut short {
            if array.capacity() < rows.cells() {
                **array = Vec::with_capacity(most.max(rows.cells()));
            }
        }
        rows.zero(&mut short);
    }

    /// The first `cells` elements of each array.
    pub(super) fn arrays(&mut self, cells: usize) -> Arrays<'_> {
        Arrays {
            u: &mut self.u[..cells],
            r: &mut self.r[..cells],
            r_before: &mut self.r_before[..cells],
            z: &mut self.z[..cells],
            direction: &mut self.direction[..cells],
            response: &mut self.response[..cells],
            trial: &mut self.trial[..cells],
            images: self.images.each_mut().map(|image| {
                let kept = cells.min(image.len());
                &mut image[..kept]
            }),
        }
    }

    /// Makes the residual that of the iteration before.
    pub(super) fn keep_residual(&mut self) {
        std::mem::swap(&mut self.r, &mut self.r_before);
    }
}
