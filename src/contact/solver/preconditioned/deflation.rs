//! Search directions that leave force and moments as they are.

use super::arrays::Arrays;
use super::{Images, PATIENCE, Preconditioned};
use crate::compliance::convolution::Convolution;
use crate::contact::problem::bounds::in_contact;
use crate::contact::problem::fit::Products;
use crate::numerics::parallel::{ONE, Total, all, dot, update, where_positive};

/// A preconditioned residual that is orthogonal to the loaded degrees of freedom: z − Σ `factors` images.
struct Deflated {
    factors: [f64; 3],
    /// Product with the residual.
    descent: f64,
    /// Product with the residual of the iteration before.
    with_last: f64,
}

impl Preconditioned<'_> {
    /// Computes the images M B of the loaded degrees of freedom anew where they must belong to the contact.
    ///
    /// The projection is symmetric only if the images belong to the contact. While the contact changes
    /// they need not; once it stays, they must. Where it still changes after so many `iterations` that most
    /// contacts have converged, old images may be the reason: they grow old no more.
    pub(super) fn prepare_images(&mut self, p: &[f64], contact_changed: bool, iterations: usize) {
        // Age of the oldest images after [`PATIENCE`] iterations; chosen by trial.
        const OLDEST: usize = 3;
        self.images = match self.images {
            Images::Current if !contact_changed => return,
            Images::Current => Images::Stale(1),
            Images::Stale(age) if contact_changed && (age < OLDEST || iterations < PATIENCE) => {
                Images::Stale(age + 1)
            }
            Images::Stale(_) => {
                self.invert_freedoms(p);
                if !contact_changed {
                    self.conjugacy.restart();
                }
                Images::Current
            }
        };
    }

    /// Applies M to the loaded degrees of freedom, restricted to the contact.
    pub(super) fn invert_freedoms(&mut self, p: &[f64]) {
        let inverse = &self.approximation.inverse;
        let Arrays { r, z, images, .. } = self.memory.arrays(p.len());
        let (loaded, bounds) = (self.problem.freedoms.loaded, self.problem.bounds);
        for (freedom, image) in images.into_iter().enumerate().filter(|(k, _)| loaded[*k]) {
            self.rows.each([p, r], [&mut *z], |row, [p, r], [z]| {
                let inputs = [p, bounds.row(row.number), r, row.y];
                update(inputs, [z], |[p, limit, r, y], _| {
                    let column = [ONE, all(row.x), y][freedom];
                    ([in_contact(p, limit, r) & column], [])
                })
            });
            inverse.apply_slices(z, image, &mut self.workspace);
            self.work += inverse.work();
        }
    }

    /// Makes the direction of the next step and hands its rows to `convolution`; returns its product with
    /// the residual.
    pub(super) fn search_direction(&mut self, p: &[f64], convolution: &Convolution) -> f64 {
        let Deflated { factors, descent, with_last } = self.deflate(p);
        let beta = self.conjugacy.beta(descent, with_last);
        let slope = self.turn(p, convolution, factors, beta);
        if slope > 0.0 {
            return slope;
        }
        // The direction lost too many cells: start again along the gradient.
        self.turn(p, convolution, factors, 0.0)
    }

    /// Preconditions the residual, z = M r, and finds the multiples of the images that must be subtracted
    /// from z so that, on the contact C, it changes neither force nor moments.
    ///
    /// ```text
    /// z ← z − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ z
    /// ```
    fn deflate(&mut self, p: &[f64]) -> Deflated {
        let (freedoms, bounds) = (self.problem.freedoms, self.problem.bounds);
        let Arrays { r, r_before, z, images, .. } = self.memory.arrays(p.len());
        let inverse = &self.approximation.inverse;
        let rows = || 0..inverse.shape()[0];
        inverse.rows_in(r, rows(), &mut self.workspace);
        let outwards = inverse.outwards(r, rows(), &mut self.workspace);
        self.work += inverse.work();
        let [i0, i1, i2] = loaded_images(freedoms.loaded, images, r);
        let inputs = [p, &*r, r_before, i0, i1, i2];
        // Products of z and of each image.
        let [of_z, of_images @ ..] = self.rows.blocks(inputs, [&mut *z], |block, inputs, [z]| {
            outwards.rows(block.first, z);
            let [p, r, before, i0, i1, i2] = inputs;
            let inputs = [p, r, before, z, i0, i1, i2];
            block.each(inputs, [], |row, [p, r, before, z, images @ ..], []| {
                let mut products: [Products; 4] = Total::ZERO;
                let fields = [p, bounds.row(row.number), r, before];
                products[0] = freedoms.products(row, fields, z);
                for (k, image) in images.into_iter().enumerate() {
                    if freedoms.loaded[k] {
                        products[k + 1] = freedoms.products(row, fields, image);
                    }
                }
                products
            })
        });
        let matrix = [0, 1, 2].map(|row| of_images.map(|image| image.moments[row]));
        let factors = freedoms.solve(&matrix, of_z.moments);
        let remains = |product: fn(&Products) -> f64| {
            let removed = factors.iter().zip(&of_images).map(|(f, image)| f * product(image));
            product(&of_z) - removed.sum::<f64>()
        };
        let descent = remains(|products| products.with_residual);
        if descent <= 0.0 {
            // The oblique projection failed: steepest descent, projected orthogonally.
            z.copy_from_slice(r);
            freedoms.project(z, p, r, bounds);
            self.conjugacy.restart();
            return Deflated { factors: [0.0; 3], descent: dot(r, z), with_last: 0.0 };
        }
        Deflated { factors, descent, with_last: remains(|products| products.with_last) }
    }

    /// Direction d ← z − Σ `factors` images + `beta` d on the contact, 0 elsewhere; returns r · d.
    fn turn(&mut self, p: &[f64], convolution: &Convolution, factors: [f64; 3], beta: f64) -> f64 {
        let Arrays { r, z, direction, images, .. } = self.memory.arrays(p.len());
        let [i0, i1, i2] = loaded_images(self.problem.freedoms.loaded, images, r);
        let ([f0, f1, f2], beta) = (factors.map(all), all(beta));
        let bounds = self.problem.bounds;
        let (inwards, halves) = convolution.inwards(&mut self.workspace);
        let (inputs, outputs) = ([p, &*r, z, i0, i1, i2], ([direction], halves));
        let [slope] = self.rows.blocks(inputs, outputs, |block, inputs, ([direction], halves)| {
            let slope = block.each(inputs, [&mut *direction], |row, inputs, [direction]| {
                let [p, r, z, i0, i1, i2] = inputs;
                let inputs = [p, bounds.row(row.number), r, z, i0, i1, i2];
                update(inputs, [direction], |[p, limit, r, z, a, b, c], [d]| {
                    let z = z - f0 * a - f1 * b - f2 * c;
                    // At a β of 0 the last direction may hold anything.
                    let last = where_positive(beta, beta * d);
                    let d = in_contact(p, limit, r) & (z + last);
                    ([d], [r * d])
                })
            });
            inwards.rows(direction, halves);
            slope
        });
        slope
    }
}

/// Images of the loaded degrees of freedom; the others get `other`, which has no weight.
fn loaded_images<'a>(
    loaded: [bool; 3],
    images: [&'a mut [f64]; 3],
    other: &'a [f64],
) -> [&'a [f64]; 3] {
    let mut loaded = loaded.into_iter();
    images.map(|image| match loaded.next() {
        Some(true) => &*image,
        _ => other,
    })
}
