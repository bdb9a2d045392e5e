//! Memory of an iteration.

use crate::parallel::Passes;

/// Memory of the arrays of an iteration; it may be larger than needed.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    u: Vec<f64>,
    r: Vec<f64>,
    r_before: Vec<f64>,
    z: Vec<f64>,
    direction: Vec<f64>,
    response: Vec<f64>,
    images: [Vec<f64>; 3],
}

/// Arrays of an iteration, as long as there are cells.
pub(crate) struct Arrays<'a> {
    /// Displacement K p.
    pub(crate) u: &'a mut [f64],
    /// −g on the contact, which are the cells that may have a pressure, and not 0 there; 0 elsewhere.
    pub(crate) r: &'a mut [f64],
    /// That of the iteration before.
    pub(crate) r_before: &'a mut [f64],
    /// The inverse applied to the residual; once the direction is known, the next pressure, and then how far
    /// that is from the last.
    pub(crate) z: &'a mut [f64],
    pub(crate) direction: &'a mut [f64],
    /// K applied to the last direction or change.
    pub(crate) response: &'a mut [f64],
    /// The inverse applied to the loaded freedoms on a contact; of the others whatever there is.
    pub(crate) images: [&'a mut [f64]; 3],
}

impl Memory {
    /// Makes it large enough for the cells of `passes`. Whatever a solve may need, up to `most` cells, is
    /// asked for at once, as the plan's memory was checked for; most systems hand it out as it is written.
    pub(crate) fn fit(&mut self, passes: &Passes, most: usize, loaded: [bool; 3]) {
        let Self {
            u,
            r,
            r_before,
            z,
            direction,
            response,
            images,
        } = self;
        let arrays = [u, r, r_before, z, direction, response];
        let images = images.iter_mut().zip(loaded);
        let images = images.filter_map(|(image, loaded)| loaded.then_some(image));
        let short = |array: &&mut Vec<f64>| array.len() < passes.cells();
        let mut short: Vec<_> = arrays.into_iter().chain(images).filter(short).collect();
        for array in &mut short {
            if array.capacity() < passes.cells() {
                **array = Vec::with_capacity(most.max(passes.cells()));
            }
        }
        passes.zero(&mut short);
    }

    pub(crate) fn arrays(&mut self, cells: usize) -> Arrays<'_> {
        Arrays {
            u: &mut self.u[..cells],
            r: &mut self.r[..cells],
            r_before: &mut self.r_before[..cells],
            z: &mut self.z[..cells],
            direction: &mut self.direction[..cells],
            response: &mut self.response[..cells],
            images: self.images.each_mut().map(|image| {
                let kept = cells.min(image.len());
                &mut image[..kept]
            }),
        }
    }

    /// The residual becomes that of the iteration before.
    pub(crate) fn keep_residual(&mut self) {
        std::mem::swap(&mut self.r, &mut self.r_before);
    }
}
