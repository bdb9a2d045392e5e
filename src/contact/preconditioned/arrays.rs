//! Memory of an iteration.

/// Arrays of an iteration, as long as there are cells.
#[derive(Debug, Default)]
pub(in crate::contact) struct Arrays {
    /// Displacement K p.
    pub(super) u: Vec<f64>,
    /// 1 on the cells that may have a pressure, 0 elsewhere.
    pub(super) contact: Vec<f64>,
    /// −g on the contact, 0 elsewhere.
    pub(super) r: Vec<f64>,
    pub(super) r_before: Vec<f64>,
    /// The inverse applied to the residual; once the direction is known, the change of the pressure.
    pub(super) z: Vec<f64>,
    pub(super) direction: Vec<f64>,
    /// K applied to the last direction or change.
    pub(super) response: Vec<f64>,
    /// The pressure before a step.
    pub(super) before: Vec<f64>,
    /// The inverse applied to the loaded freedoms on a contact; of the others nothing.
    pub(super) images: [Vec<f64>; 3],
}

impl Arrays {
    pub(super) fn fit(&mut self, cells: usize, loaded: [bool; 3]) {
        let Self {
            u,
            contact,
            r,
            r_before,
            z,
            direction,
            response,
            before,
            images,
        } = self;
        for array in [contact, u, r, r_before, z, direction, response, before] {
            array.resize(cells, 0.0);
        }
        for (image, loaded) in images.iter_mut().zip(loaded) {
            image.resize(if loaded { cells } else { 0 }, 0.0);
        }
    }
}
